//! Energy balance of a closed scene: all light that is given off must be absorbed somewhere.
//!
//! Absorbed flux is Σ (1 − ρ)·E·A over both sides of every surface. Fronts that have texels are summed from the
//! texels; the rest (backs, and surfaces without a lightmap) from points spread evenly over it. Whether a scene is
//! closed is found by following light forwards: if a walk from a source ever misses everything, light escapes and
//! there is no balance to draw.

use super::BakeError;
use super::gather::{Estimate, KeyKind, Paths, key};
use super::sites::Site;
use super::workers::Workers;
use crate::math::Discrete;
use crate::math::{combine, luminance, square_to_triangle};
use crate::trace::{Dimensions, Sampler, Sobol, Tracer, Transport};
use glam::{DVec3, Vec2, Vec3};

/// Walks from sources that look for a way out.
const WALKS: u64 = 4096;

/// Points on what has no texels.
const POINTS: usize = 1024;

/// Paths from each of them.
const PATHS_PER_POINT: u32 = 64;

/// Absorbed over emitted flux, by luminance; `None` for an open scene, one under a sky, with a cap on bounces
/// or with lights that are drawn in real time.
pub(super) fn energy_balance(
    tracer: &Tracer,
    sites: &[Site],
    estimates: &[Estimate],
    transport: &Transport,
    workers: &Workers<'_>,
) -> Result<Option<f64>, BakeError> {
    let Some(emitted) = tracer.emitted_flux() else {
        return Ok(None);
    };
    let loses_light =
        transport.max_bounces.is_some() || transport.clamp.is_some() || tracer.leaves_direct_light_to_others();
    if loses_light || !tracer.is_diffuse() || !tracer.is_closed(WALKS, transport.seed) {
        return Ok(None);
    }
    let mut measured_area = vec![0.0; tracer.triangle_count()];
    let mut absorbed = DVec3::ZERO;
    for (site, estimate) in sites.iter().zip(estimates) {
        let texel = &site.covered.texel;
        for &(triangle, area) in &texel.areas {
            measured_area[triangle as usize] += area;
        }
        // What is refused lies in the dark, or is measured by another texel.
        let area: f64 = texel.areas.iter().map(|(_, area)| area * estimate.accepted).sum();
        let absorption = (Vec3::ONE - texel.albedo(tracer)).as_dvec3();
        absorbed += absorption * estimate.mean * std::f64::consts::PI * area;
    }
    absorbed += unmeasured_absorption(tracer, &measured_area, transport, workers)?;
    Ok(Some(luminance(absorbed) / luminance(emitted)))
}

/// Flux that sides without texels absorb [lm].
fn unmeasured_absorption(
    tracer: &Tracer,
    measured_area: &[f64],
    transport: &Transport,
    workers: &Workers<'_>,
) -> Result<DVec3, BakeError> {
    // Fronts, then backs. What little of a front its texels miss is too small to measure and too small to matter.
    let fronts = measured_area.iter().enumerate().map(|(triangle, &measured)| {
        let area = tracer.area(triangle as u32);
        if measured > 0.5 * area { 0.0 } else { area }
    });
    let backs = (0..measured_area.len()).map(|triangle| tracer.area(triangle as u32));
    let areas: Vec<f64> = fronts.chain(backs).collect();
    let total: f64 = areas.iter().sum();
    let Ok(choice) = Discrete::new(areas.iter().copied()) else {
        return Ok(DVec3::ZERO);
    };
    let points: Vec<u64> = (0..POINTS as u64).collect();
    let point_key = key(KeyKind::Balance, transport.seed, 0, 0);
    let work = workers.gather_quietly(&points, |&point, cancel| {
        let [u, v, u_choice, _] = Sobol::new(point_key, point).draw(Dimensions::Start);
        let side = choice.sample(f64::from(u_choice)).index;
        let triangle = (side % measured_area.len()) as u32;
        let normal = if side < measured_area.len() { tracer.normal(triangle) } else { -tracer.normal(triangle) };
        let weights = square_to_triangle(Vec2::new(u, v));
        let absorption = Vec3::ONE - tracer.diffuse_albedo(triangle, weights.to_array());
        if absorption == Vec3::ZERO {
            // Nor may one follow light there: the inside of a white box keeps it.
            return Some(DVec3::ZERO);
        }
        let start = tracer.start_on_triangle(triangle, weights.to_array(), normal);
        let paths = Paths { key: combine(point_key, point), count: PATHS_PER_POINT, clamp: None };
        let estimate =
            Estimate::gather(paths, cancel, |sobol, tally| tracer.diffuse_radiance(&start, sobol, transport, tally))?;
        Some(absorption.as_dvec3() * estimate.mean)
    })?;
    let mean = work.iter().sum::<DVec3>() / POINTS as f64;
    Ok(mean * std::f64::consts::PI * total)
}

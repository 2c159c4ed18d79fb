//! Looks at a surface: through a camera of one pixel, and in a furnace, where what loses no light cannot be seen.
//!
//! They are judges, as those of [`crate::judge`] are, which knows readings and bakes.

use crate::case::Verdict;
use crate::common::meter::on_walls;
use crate::common::scenes::{SceneBuilder, furnace, grey};
use crate::judge::{ensure, light_at, light_by, mean_reads, no_path_was_lost};
use crate::things::{level, with_box};
use crate::worlds::room_of_radiance_one;
use bevy_kiln::bake::{CancelToken, MeterPoint, PictureSettings, render_picture};
use bevy_kiln::scene::{Camera, Material, Scene};
use bevy_kiln::trace::{Estimator, Transport};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// What one pixel sees, and its standard error; an error if it is no light, or a path was lost.
pub fn seen(scene: &Scene, [eye, target]: [Vec3; 2], samples_per_pixel: u32) -> Result<(DVec3, DVec3), String> {
    let camera = Camera::look_at("eye", eye, target, 1e-6);
    let transport = Transport::default();
    let settings = PictureSettings { transport, width: 1, height: 1, samples_per_pixel, threads: None };
    let picture = render_picture(scene, &camera, &settings, &(), &CancelToken::default());
    let picture = picture.map_err(|error| error.to_string())?;
    no_path_was_lost(&picture.report)?;
    let (radiance, stderr) = (picture.radiance[0], picture.stderr[0]);
    if radiance.is_finite() && stderr.is_finite() && radiance.min_element() >= 0.0 {
        return Ok((radiance.as_dvec3(), stderr.as_dvec3()));
    }
    Err(format!("a pixel of {radiance} ± {stderr}"))
}

/// Whether one pixel sees `truth` [cd/m²] to the absolute `tolerance`, its own noise counted in.
pub fn sees(scene: &Scene, look: [Vec3; 2], samples: u32, truth: f64, tolerance: f64) -> Verdict {
    let (radiance, stderr) = seen(scene, look, samples)?;
    let off = (radiance - truth).abs() + 4.0 * stderr;
    ensure(off.max_element() <= tolerance, || format!("seen {radiance} ± {stderr}, not {truth:.5} ± {tolerance}"))
}

/// Whether a flat surface shows these albedos at 0°, 60° and 80°: by reciprocity, what it shows of a white sky.
pub fn shows_albedos(material: Material, albedos: [f64; 3], tolerance: f64) -> Verdict {
    let scene = level(SceneBuilder::default(), "plate", 0.0, [10.0, 1.0], material).sky(Vec3::ONE).build();
    for (degrees, albedo) in [0.0_f32, 60.0, 80.0].into_iter().zip(albedos) {
        let (sin, cos) = degrees.to_radians().sin_cos();
        sees(&scene, [Vec3::new(sin, cos, 0.0), Vec3::ZERO], 1 << 16, albedo, tolerance)
            .map_err(|error| format!("{degrees}°: {error}"))?;
    }
    Ok(())
}

/// Whether E = π on the walls of a furnace of radiance 1, seen by surface samples, which have the least noise there.
pub fn furnace_of_one(scene: &Scene, samples: u32, tolerance: f64) -> Verdict {
    let transport = Transport { estimator: Estimator::Bsdf, ..Transport::default() };
    let readings = light_by(scene, &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), samples, transport)?;
    mean_reads(&readings, PI, tolerance)
}

/// What [`furnace_of_0_8`] asks for.
pub const FURNACE_HOLDS: &str = "E = π/(1 − ρ) within 0.3 %, ρ = 0.8";

/// Whether E = π/(1 − ρ) at points on the walls of a furnace of albedo 0.8, wherever it is and whatever its shape.
pub fn furnace_of_0_8(scene: &Scene, points: &[MeterPoint]) -> Verdict {
    mean_reads(&light_at(scene, points, 1 << 11)?, PI / 0.2, 3e-3)
}

/// Whether a box of a material that loses no light cannot be seen in a furnace of radiance 1, half of which it fills.
pub fn vanishes(material: &Material, samples: u32, tolerance: f64) -> Verdict {
    let corners = [Vec3::new(-0.8, -0.6, -0.7), Vec3::new(0.7, 0.8, 0.8)];
    furnace_of_one(&with_box(room_of_radiance_one(), "thing", corners, material).build(), samples, tolerance)
}

/// Looks reject what is wrong: another radiance, a body and walls that absorb.
pub fn rejects_what_is_wrong() -> Verdict {
    let (sky, up) = (SceneBuilder::default().sky(Vec3::ONE).build(), [Vec3::ZERO, Vec3::Y]);
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    sees(&sky, up, 16, 1.0, 1e-3)?;
    let wrong = [
        sees(&sky, up, 16, 1.01, 1e-3),
        shows_albedos(grey(0.99), [1.0; 3], 2e-3),
        vanishes(&grey(0.9), 1 << 10, 3e-3),
        furnace_of_one(&furnace(0.5), 16, 3e-3),
        furnace_of_0_8(&furnace(0.79), &points),
    ];
    match wrong.iter().position(Result::is_ok) {
        Some(index) => Err(format!("wrong number {index} passed")),
        None => Ok(()),
    }
}

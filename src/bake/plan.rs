//! What a bake would do, and what it would cost, before it is done.

use super::atlas::Atlas;
use super::gather::{Estimate, relative_error};
use super::lightmap::refuse_what_cannot_be_baked;
use super::sites::{Site, sites};
use super::workers::Workers;
use super::{BakeError, BakeSettings, BakeWarning, CancelToken};
use crate::scene::Scene;
use crate::trace::{Compiled, Dimensions, Sampler, Tracer};
use glam::{Vec2, Vec3};
use std::time::Instant;

/// Texels that the pilot traces.
const PILOT_TEXELS: usize = 256;

/// Paths from each of them.
const PILOT_SAMPLES: u32 = 64;

/// Errors that a price is given for: half-widths of the 95 % interval over the value.
const PRICED_ERRORS: [f64; 5] = [0.10, 0.05, 0.02, 0.01, 0.005];

/// A kind of light transport that a scene may call for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Effect {
    /// Light straight from glowing meshes and rectangular lights, with soft shadows.
    AreaLights,
    /// Light from a sky that is the same in every direction.
    ConstantSky,
    /// Light that surfaces pass on to each other, without a last bounce.
    DiffuseInterreflection,
}

impl Effect {
    const ALL: [Self; 3] = [Self::AreaLights, Self::ConstantSky, Self::DiffuseInterreflection];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::AreaLights => "area-lights",
            Self::ConstantSky => "constant-sky",
            Self::DiffuseInterreflection => "diffuse-interreflection",
        }
    }

    fn plan(self, scene: &Scene, tracer: &Tracer, settings: &BakeSettings) -> PlannedEffect {
        let (on, reason) = match self {
            Self::AreaLights => match tracer.emitter_count() {
                0 => (false, "nothing glows".to_owned()),
                count => (true, area_light_reason(count, tracer)),
            },
            Self::ConstantSky if tracer.sky_radiance() == Vec3::ZERO => (false, "no sky was given".to_owned()),
            Self::ConstantSky => {
                let [r, g, b] = tracer.sky_radiance().to_array();
                (true, format!("radiance {r}, {g}, {b} cd/m²"))
            }
            Self::DiffuseInterreflection => interreflection(scene, settings),
        };
        PlannedEffect { effect: self, on, reason }
    }
}

impl std::fmt::Display for Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Whether an effect is simulated, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlannedEffect {
    /// The effect.
    pub effect: Effect,
    /// Whether it is simulated.
    pub on: bool,
    /// Why, in words and numbers.
    pub reason: String,
}

/// The price of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// Mean over the texels of the half-width of the 95 % interval, over the value.
    pub error: f64,
    /// Time that tracing to it would take [s].
    pub seconds: f64,
}

/// What a bake would do.
#[derive(Clone, Debug, PartialEq)]
pub struct BakePlan {
    /// Every effect that this baker knows, on or off.
    pub effects: Vec<PlannedEffect>,
    /// Covered texels.
    pub texels: u64,
    /// Textures.
    pub pages: u32,
    /// Memory that the bake would hold at once [bytes].
    pub memory_bytes: u64,
    /// Prices of a few errors, from a short pilot.
    pub predicted: Vec<Prediction>,
    /// What would be left out.
    pub warnings: Vec<BakeWarning>,
}

impl BakePlan {
    /// Plans the bake of a scene. Lays out the texels and traces a few of them: seconds at most for a scene of
    /// ordinary size.
    ///
    /// # Errors
    ///
    /// What [`bake_lightmap`](super::bake_lightmap) would refuse.
    pub fn for_scene(scene: &Scene, settings: &BakeSettings) -> Result<Self, BakeError> {
        settings.validate()?;
        let cancel = CancelToken::default();
        let workers = Workers::new(settings.threads, &(), &cancel)?;
        let Compiled { tracer, faults } = Compiled::new(scene);
        refuse_what_cannot_be_baked(&tracer, &faults)?;
        let atlas = Atlas::new(scene, &tracer, settings)?;
        let (sites, overlaps) = sites(scene, &tracer, &atlas, settings);
        let mut warnings: Vec<BakeWarning> = faults.into_iter().map(BakeWarning::from).collect();
        warnings.extend(overlaps);
        Ok(Self {
            effects: Effect::ALL.into_iter().map(|effect| effect.plan(scene, &tracer, settings)).collect(),
            texels: sites.len() as u64,
            pages: atlas.pages.len() as u32,
            memory_bytes: memory_bytes(&tracer, &atlas, &sites),
            predicted: predict(&tracer, &sites, settings, &workers)?,
            warnings,
        })
    }
}

fn area_light_reason(count: usize, tracer: &Tracer) -> String {
    let shapes = if count == 1 { "shape glows" } else { "shapes glow" };
    match tracer.emitted_flux() {
        Some(flux) => format!("{count} {shapes}, {:.4} lm in all", crate::math::luminance(flux)),
        None => format!("{count} {shapes}"),
    }
}

fn interreflection(scene: &Scene, settings: &BakeSettings) -> (bool, String) {
    if settings.transport.max_bounces == Some(0) {
        return (false, "direct light only was asked for".to_owned());
    }
    let brightest = scene
        .instances
        .iter()
        .filter_map(|instance| scene.materials.get(instance.material))
        .map(|material| material.base_colour.truncate().max_element())
        .fold(0.0, f32::max);
    if brightest == 0.0 {
        return (false, "every surface is black".to_owned());
    }
    let end = settings
        .transport
        .max_bounces
        .map_or_else(|| "no cap on bounces".to_owned(), |cap| format!("cut after {cap} bounces, which loses light"));
    (true, format!("albedo up to {brightest}, {end}"))
}

fn memory_bytes(tracer: &Tracer, atlas: &Atlas<'_>, sites: &[Site]) -> u64 {
    // A page's layers; the triangles with their tree (measured: about 60 bytes of nodes each); texels and their work.
    let layers: u64 = atlas.pages.iter().map(|[width, height]| u64::from(*width) * u64::from(*height) * 40).sum();
    let triangles = tracer.triangle_count() as u64 * 160;
    let texels: usize = sites.iter().map(Site::memory_bytes).sum();
    layers + triangles + texels as u64
}

/// Traces a few texels, spread evenly over all, and scales their error and their time.
fn predict(
    tracer: &Tracer,
    sites: &[Site],
    settings: &BakeSettings,
    workers: &Workers<'_>,
) -> Result<Vec<Prediction>, BakeError> {
    let step = (sites.len() / PILOT_TEXELS).max(1);
    let pilot: Vec<&Site> = sites.iter().step_by(step).collect();
    let clock = Instant::now();
    let estimates = workers.gather_quietly(&pilot, |site, cancel| {
        Estimate::gather(site.key, PILOT_SAMPLES, cancel, |sobol, rays| {
            let [u, v, ..] = sobol.draw(Dimensions::Start);
            let start = site.texel.start(tracer, Vec2::new(u, v));
            tracer.diffuse_radiance(&start, sobol, &settings.transport, rays)
        })
    })?;
    let seconds = clock.elapsed().as_secs_f64() * sites.len() as f64 / pilot.len().max(1) as f64;
    let half_width = 1.96 * relative_error(&estimates).mean;
    let price = |error: f64| Prediction { error, seconds: seconds * (half_width / error).powi(2) };
    Ok(PRICED_ERRORS.into_iter().map(price).collect())
}

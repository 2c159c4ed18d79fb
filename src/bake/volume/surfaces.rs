//! What surfaces show, measured before the probes: a coarse lightmap at which their paths end.
//!
//! A probe sees every place of a room from afar, most of it again and again. So each texel of a coarse map is measured by
//! a few hundred whole paths first, as in the fast mode of lightmaps ([`LaterBounces::Reused`]), and a probe's path ends
//! on it: light by way of a patch of sun that one path in a hundred finds costs no noise any more. The bias is that of
//! the map: what a texel is coarse by, and its noise, which the many texels that a probe sees even out.

use super::VolumeSettings;
use crate::bake::atlas::Atlas;
use crate::bake::reuse::{FirstPass, Place};
use crate::bake::sites::Sites;
use crate::bake::unwrap::LaidOut;
use crate::bake::workers::Workers;
use crate::bake::{BakeError, BakeSettings, CancelToken, LaterBounces};
use crate::scene::{Instance, Scene};
use crate::trace::Tracer;
use glam::Vec3;
use std::borrow::Cow;

/// Paths from each texel.
const PATHS: u32 = 256;

/// The most texels, but for what charts add around them.
const MOST_TEXELS: f64 = 65_536.0;

impl VolumeSettings {
    /// How the coarse map of a scene is laid out.
    pub(super) fn surfaces(&self, scene: &Scene) -> BakeSettings {
        let affordable = (MOST_TEXELS / area(scene).max(f64::MIN_POSITIVE)).sqrt() as f32;
        BakeSettings {
            transport: self.transport,
            later_bounces: self.later_bounces,
            density: self.density.min(affordable),
            threads: self.threads,
            ..BakeSettings::default()
        }
    }

    /// Whether there is to be one.
    pub(super) fn asks_for_surfaces(&self) -> bool {
        self.later_bounces == LaterBounces::Reused && self.transport.max_bounces.is_none()
    }
}

/// The same scene without what single objects ask for: the coarse map treats all alike.
pub(super) fn all_alike(scene: &Scene) -> Cow<'_, Scene> {
    let asks = |instance: &Instance| instance.lightmap.is_some_and(|request| request.density.is_some());
    if !scene.instances.iter().any(asks) {
        return Cow::Borrowed(scene);
    }
    let mut scene = scene.clone();
    for request in scene.instances.iter_mut().filter_map(|instance| instance.lightmap.as_mut()) {
        request.density = None;
    }
    Cow::Owned(scene)
}

/// Area of all that receives a lightmap [m²].
fn area(scene: &Scene) -> f64 {
    let receivers = scene.instances.iter().filter(|instance| instance.lightmap.is_some());
    let of_instance = |instance: &Instance| -> f64 {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { return 0.0 };
        let corner = |vertex: u32| {
            let position = mesh.positions.get(vertex as usize).copied().unwrap_or_default();
            instance.world_from_local.transform_point3(position)
        };
        let of_triangle = |[a, b, c]: [Vec3; 3]| 0.5 * f64::from((b - a).cross(c - a).length());
        mesh.triangles().map(|triangle| of_triangle(triangle.map(corner))).filter(|area| area.is_finite()).sum()
    };
    receivers.map(of_instance).sum()
}

/// Measures a coarse lightmap and tells the tracer of the same scene.
pub(super) fn teach(
    tracer: &Tracer,
    laid_out: &LaidOut<'_>,
    settings: &BakeSettings,
    workers: &Workers<'_>,
    cancel: &CancelToken,
) -> Result<Option<FirstPass>, BakeError> {
    if tracer.receivers().is_empty() {
        return Ok(None);
    }
    let atlas = Atlas::new(laid_out, tracer, settings, cancel)?;
    let sites = Sites::new(&laid_out.scene, tracer, &atlas, settings, workers)?;
    Place { tracer, atlas: &atlas, sites: &sites.seen }.first_pass(PATHS, settings, workers)
}

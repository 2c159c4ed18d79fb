//! The way to share written a second time, with a fault.

use super::{Found, Shared, Whence};
use crate::trace::Tracer;
use crate::trace::path::PathStart;
use glam::Vec3;

/// What may be wrong with a way to share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    None,
    /// The cosine at the receiver.
    NoCosineHere,
    /// The cosine where the light comes from, which differs between receivers.
    NoCosineThere,
    /// The square of the distance.
    NoFalloff,
    /// What hides the place from some.
    NoVisibility,
    /// How the place looks from elsewhere.
    NoAngle,
    /// What lets light pass hides nothing.
    ThroughTheVeil,
}

/// What each receiver gets of a path.
pub(super) fn second_opinion(
    tracer: &Tracer,
    starts: &[PathStart],
    own: usize,
    found: &Found,
    fault: Fault,
) -> Vec<Vec3> {
    let mut light = vec![Vec3::ZERO; starts.len()];
    light[own] = found.alone;
    let Some(Shared { whence, radiance, own: own_look }) = found.shared else { return light };
    let is_hidden = |start: &PathStart, target: Result<Vec3, Vec3>| {
        let hides = |triangle: u32| fault != Fault::ThroughTheVeil || !tracer.surface(triangle).passes;
        match target {
            Ok(point) => tracer.accel.meets(start.origin, point, |hit| hides(hit.triangle)),
            Err(direction) => tracer.accel.meets_towards(start.origin, direction, |hit| hides(hit.triangle)),
        }
    };
    let of_one = |number: usize| {
        let start = &starts[number];
        let (wi, geometry, is_blocked, look) = match whence {
            Whence::Sky(wi) => (wi, 1.0, is_hidden(start, Err(wi)), Vec3::ONE),
            Whence::Surface { point, normal, shading, look } => {
                let (wi, distance) = (point - start.origin).normalize_and_length();
                let cosine = if fault == Fault::NoCosineThere { 1.0 } else { normal.dot(-wi) };
                let falloff = if fault == Fault::NoFalloff { 1.0 } else { distance * distance };
                let is_before = normal.dot(-wi) > 0.0 && shading.dot(-wi) > 0.0;
                let geometry = if is_before { cosine / falloff } else { 0.0 };
                (wi, geometry, is_hidden(start, Ok(point)), look.from(shading.dot(-wi)))
            }
        };
        let is_for = matches!(whence, Whence::Surface { .. }) || start.normal == starts[own].normal;
        let is_seen = number == own || fault == Fault::NoVisibility || !is_blocked;
        let cosine = start.normal.dot(wi);
        let is_before = cosine > 0.0 && geometry > 0.0;
        let cosine = if fault == Fault::NoCosineHere { 1.0 } else { cosine };
        let density = if is_for && is_before && is_seen { cosine * geometry } else { 0.0 };
        (density, if fault == Fault::NoAngle { own_look } else { look })
    };
    let all: Vec<(f32, Vec3)> = (0..starts.len()).map(of_one).collect();
    let sum: f32 = all.iter().map(|one| one.0).sum();
    for (light, (density, look)) in light.iter_mut().zip(all) {
        *light += radiance * look * (density / sum);
    }
    light
}

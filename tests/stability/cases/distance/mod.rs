//! Where a receiver is, seen from a light: near, far, on it, beside it, behind it, at a grazing angle.

mod bulbs;
mod ends;
mod horizon;
mod panels;
mod rectangles;
mod suns;

use crate::case::Case;
use crate::common::meter::at;
use crate::judge::light_by;
use bevy_kiln::bake::{MeterPoint, MeterReading};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::{Estimator, Transport};
use glam::Vec3;

pub const CASES: &[&[Case]] =
    &[rectangles::CASES, panels::CASES, bulbs::CASES, suns::CASES, horizon::CASES, ends::CASES];

const AREA_NEAR: &str = "area sampling: the variance grows as 1/d² (55.6 million samples for 2 %, 0.5 mm under Cornell's \
                         lamp)";
const NEAR_2: &str = "E = π·F (Howell B-3) within 2 %: no sample counts for more than radiance times solid angle, \
                      by light sampling alone";
const GRAZING: &str = "shadow terminators and acne at low suns; biases long enough to hide them detach shadows";

/// The light at points by samples on lamps alone: surface rays would find a near lamp, and hide how it is sampled.
fn by_light_at(scene: &Scene, points: &[MeterPoint], samples: u32) -> Result<Vec<MeterReading>, String> {
    light_by(scene, points, samples, Transport { estimator: Estimator::Light, ..Transport::default() })
}

/// The same at the world's origin, facing up.
fn by_light(scene: &Scene, samples: u32) -> Result<MeterReading, String> {
    Ok(by_light_at(scene, &[at(Vec3::ZERO, Vec3::Y)], samples)?[0])
}

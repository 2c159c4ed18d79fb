//! Lobes at their limits: roughness that vanishes, indices that are equal or far apart, angles along the surface.

mod angles;
mod bodies;
mod refraction;
mod smooth;

use crate::case::Case;

pub const CASES: &[&[Case]] = &[smooth::CASES, refraction::CASES, bodies::CASES, angles::CASES];

const UNSEEN: &str = "what loses no light cannot be seen in a furnace: E = π within 0.3 %";

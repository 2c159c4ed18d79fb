//! Size and place of the world: light does not know how large a scene is, where it stands or how bright it is.

mod moved;
mod power;
mod scale;

use crate::case::Case;

pub const CASES: &[&[Case]] = &[scale::CASES, moved::CASES, power::CASES];

const FURNACE: &str = "rays that start in a corner of a closed room lie within rounding of the next wall; no wall lies \
                       along an axis, so that every point has an error off its plane";
const FURNACE_HOLDS: &str = "E = π/(1 − ρ) within 0.3 % (ρ = 0.8), noise counted in";
const LARGE_BIAS: &str = "an absolute ray bias is lost in rounding: surfaces meet their own rays";
const SELF_SHADOW: &str = "walls meet the rays that leave them";

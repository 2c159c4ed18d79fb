//! What happens to texels once they are measured, so that texture filtering shows the light of the surface and
//! nothing else. Each step reads measured texels only, and never a hidden or an empty one as if it were light:
//!
//! 1. `barrier` keeps light from crossing walls that stand on a chart;
//! 2. `dilate` fills the texels beside the charts that filtering also reads.
//!
//! `field` is what the steps work on: a page's texels with all that is known of each.

mod barrier;
mod dilate;
mod field;

pub(super) use field::Field;
pub use field::TexelState;

use super::workers::Workers;
use super::{BakeError, BakeSettings};

/// Repairs the pages of a lightmap, in place.
pub(super) fn repair(fields: &mut [Field], _settings: &BakeSettings, _workers: &Workers<'_>) -> Result<(), BakeError> {
    for field in fields {
        barrier::stop_light_at_walls(field);
        dilate::dilate(field);
    }
    Ok(())
}

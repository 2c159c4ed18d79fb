//! What happens to texels once they are measured, so that texture filtering shows the light of the surface and
//! nothing else. Each step reads measured texels only, and never a hidden or an empty one as if it were light:
//!
//! 1. `denoise` replaces each texel by what it and the texels like it say;
//! 2. `barrier` keeps light from crossing walls that stand on a chart;
//! 3. `dilate` fills the texels beside the charts that filtering also reads.
//!
//! `field` is what the steps work on: a page's texels with all that is known of each.

mod barrier;
mod denoise;
mod dilate;
mod field;

pub(super) use field::Field;
pub use field::TexelState;

use super::report::Denoised;
use super::settings::Denoise;
use super::workers::Workers;
use super::{BakeError, BakeSettings};

/// Repairs the pages of a lightmap, in place. Says what was denoised, if anything was.
pub(super) fn repair(
    fields: &mut [Field],
    settings: &BakeSettings,
    workers: &Workers<'_>,
) -> Result<Option<Denoised>, BakeError> {
    let denoised = match settings.denoise {
        Denoise::Off => None,
        Denoise::BuiltIn => Some(denoise::denoise(fields, workers)?),
    };
    for field in fields {
        barrier::stop_light_at_walls(field);
        dilate::dilate(field);
    }
    Ok(denoised)
}

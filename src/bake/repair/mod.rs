//! What happens to texels once they are measured, so that texture filtering shows the light of the surface and
//! nothing else. Each step reads measured texels only, and never a hidden or an empty one as if it were light:
//!
//! 1. `denoise` replaces each texel by what it and the texels like it say;
//! 2. `barrier` keeps light from crossing walls that stand on a chart;
//! 3. `dilate` fills the texels beside the charts that filtering also reads;
//! 4. `seams` makes lookups on both sides of the charts' edges agree.
//!
//! `field` is what the steps work on: a page's texels with all that is known of each. `lookup` is what a texture unit
//! makes of them.

mod barrier;
mod denoise;
mod dilate;
mod field;
mod lookup;
mod seams;

pub(super) use field::Field;
pub use field::TexelState;
pub(super) use lookup::DisplayedRect;
pub use lookup::Filtering;

use super::atlas::Atlas;
use super::report::Denoised;
use super::settings::Denoise;
use super::sites::Site;
use super::workers::Workers;
use super::{BakeError, BakeSettings, SeamReport};
use crate::scene::Scene;
use crate::trace::Tracer;

/// What the texels are part of.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a> {
    pub(super) scene: &'a Scene,
    pub(super) tracer: &'a Tracer,
    pub(super) atlas: &'a Atlas<'a>,
    /// The measured texels.
    pub(super) sites: &'a [Site],
}

impl Surroundings<'_> {
    /// A receiver's rectangle as displayed.
    pub(in crate::bake) fn rect(&self, receiver: u32) -> DisplayedRect {
        let chart = &self.atlas.charts[receiver as usize];
        let page = self.atlas.pages[chart.page as usize];
        let [uv_min, uv_max] = super::layout::corners(chart, page);
        DisplayedRect::new(uv_min, uv_max, page)
    }
}

/// What repair did.
#[derive(Clone, Debug, Default)]
pub(super) struct Repairs {
    /// Of noise; `None` where that was not asked for.
    pub(super) denoised: Option<Denoised>,
    /// Of seams; `None` where no charts meet.
    pub(super) seams: Option<SeamReport>,
}

/// Repairs the pages of a lightmap, in place.
pub(super) fn repair(
    fields: &mut [Field],
    place: &Surroundings<'_>,
    settings: &BakeSettings,
    workers: &Workers<'_>,
) -> Result<Repairs, BakeError> {
    let (denoised, owners) = repair_pages(fields, settings, workers)?;
    let seams = seams::mend(fields, &owners, place, workers)?;
    Ok(Repairs { denoised, seams })
}

/// All of that but for seams: what a preview needs.
pub(super) fn repair_for_preview(
    fields: &mut [Field],
    settings: &BakeSettings,
    workers: &Workers<'_>,
) -> Result<(), BakeError> {
    repair_pages(fields, settings, workers).map(drop)
}

/// Repairs each page by itself; gives what the denoiser did, and who filled each texel.
fn repair_pages(
    fields: &mut [Field],
    settings: &BakeSettings,
    workers: &Workers<'_>,
) -> Result<(Option<Denoised>, Vec<dilate::Owners>), BakeError> {
    let denoised = match settings.denoise {
        Denoise::Off => None,
        Denoise::BuiltIn => Some(denoise::denoise(fields, workers)?),
    };
    let mut owners = Vec::with_capacity(fields.len());
    for field in fields.iter_mut() {
        barrier::stop_light_at_walls(field);
        let owner = dilate::dilate(field, workers)?;
        barrier::stop_light_in_walls(field, &owner);
        owners.push(owner);
    }
    Ok((denoised, owners))
}

//! What happens to texels once they are measured, so that texture filtering shows the light of the surface and
//! nothing else. Each step reads measured texels only, and never a hidden or an empty one as if it were light:
//!
//! 1. `dilate` fills the texels beside the charts that filtering also reads;
//! 2. `seams` makes lookups on both sides of the charts' edges agree.
//!
//! `field` is what the steps work on: a page's texels with all that is known of each. `lookup` is what a texture unit
//! makes of them.

mod dilate;
mod field;
mod lookup;
mod seams;

pub(super) use dilate::PASSES;
pub(super) use field::Field;
pub use field::TexelState;
pub(super) use lookup::DisplayedRect;
pub use lookup::Filtering;

use super::atlas::Atlas;
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
        let [uv_min, uv_max] = super::lightmap::corners(chart, page);
        DisplayedRect::new(uv_min, uv_max, page)
    }
}

/// What repair did.
#[derive(Clone, Debug, Default)]
pub(super) struct Repairs {
    /// Of seams; `None` where no charts meet.
    pub(super) seams: Option<SeamReport>,
}

/// Repairs the pages of a lightmap, in place.
pub(super) fn repair(
    fields: &mut [Field],
    place: &Surroundings<'_>,
    _settings: &BakeSettings,
    workers: &Workers<'_>,
) -> Result<Repairs, BakeError> {
    let owners = fields.iter_mut().map(|field| dilate::dilate(field, workers)).collect::<Result<Vec<_>, _>>()?;
    let seams = seams::mend(fields, &owners, place, workers)?;
    Ok(Repairs { seams })
}

//! What a bake is asked for.

use super::{BakeError, Goal};
use crate::trace::Transport;
use std::num::NonZeroUsize;

/// Largest shared map that may be asked for [texels].
const MAX_SHARED_SIZE: u32 = 8192;

/// Sizes that a page of a packed atlas may be limited to [texels]. On a larger one the 16 bits per coordinate that
/// Bevy keeps of a lightmap's rectangle would be off by more than a sixteenth of a texel.
const PAGE_SIZES: std::ops::RangeInclusive<u32> = 64..=4096;

/// Where the texels of a lightmap go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// Each object has a rectangle of its own at the asked density; its unit square of UV1 fills it.
    #[default]
    Packed,
    /// UV1 is one atlas for the whole scene, laid out by its artist; one map of `size` × `size` texels.
    Shared {
        /// Width and height of the map [texels].
        size: u32,
    },
}

/// Whether noise is taken out of texels, and by what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Denoise {
    /// Texels stay as measured.
    Off,
    /// The built-in denoiser: blurs only what error bars allow.
    #[default]
    BuiltIn,
}

/// How light is found that has met more than one surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum LaterBounces {
    /// Every path is followed to its end: no bias.
    #[default]
    Traced,
    /// The fast mode: a first pass measures every texel by a few whole paths; those of the bake proper end where they
    /// meet one, on the front of a diffuse surface, and take its light. Biased by what a texel is coarse and by the
    /// first pass's noise: below 1 % as measured in `docs/accuracy.md`. Where a lightmap has no say (on glossy
    /// surfaces, backs, near corners, what has no texels, and all paths that [`Transport::max_bounces`] cuts) paths go
    /// on.
    Reused,
}

/// What a lightmap bake is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeSettings {
    /// How light is followed.
    pub transport: Transport,
    /// When a texel has been sampled enough.
    pub goal: Goal,
    /// How light is found that has met more than one surface.
    pub later_bounces: LaterBounces,
    /// Texels per metre of surface where an object asks for nothing else; for [`Layout::Packed`].
    pub density: f32,
    /// Where the texels go.
    pub layout: Layout,
    /// Largest width and height of a page, 64 to 4096 [texels]; for [`Layout::Packed`]. An object that needs a larger
    /// one gets fewer texels per metre, and a warning.
    pub max_page_size: u32,
    /// Whether noise is taken out.
    pub denoise: Denoise,
    /// Threads that trace; `None` for all cores.
    pub threads: Option<NonZeroUsize>,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            transport: Transport::default(),
            goal: Goal::default(),
            later_bounces: LaterBounces::default(),
            density: 16.0,
            layout: Layout::default(),
            max_page_size: *PAGE_SIZES.end(),
            denoise: Denoise::default(),
            threads: None,
        }
    }
}

impl BakeSettings {
    /// Refuses settings that cannot be met.
    pub fn validate(&self) -> Result<(), BakeError> {
        let refuse = |setting, reason: &str| Err(BakeError::Settings { setting, reason: reason.to_owned() });
        self.goal.validate()?;
        if !(self.density.is_finite() && self.density > 0.0) {
            return refuse("density", "it must be a positive number of texels per metre");
        }
        if !PAGE_SIZES.contains(&self.max_page_size) {
            return refuse("page size", "a page is 64 to 4096 texels wide");
        }
        match self.layout {
            Layout::Shared { size } if size == 0 || size > MAX_SHARED_SIZE => {
                refuse("size", "a shared map is 1 to 8192 texels wide")
            }
            _ => Ok(()),
        }
    }

    /// Largest side of a page in whole blocks of 4 × 4 [texels].
    pub(super) fn page_limit(&self) -> u32 {
        self.max_page_size / super::atlas::BLOCK * super::atlas::BLOCK
    }
}

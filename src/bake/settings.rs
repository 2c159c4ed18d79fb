//! What a bake is asked for.

use super::BakeError;
use crate::trace::Transport;
use std::num::NonZeroUsize;

/// Largest shared map that may be asked for [texels].
const MAX_SHARED_SIZE: u32 = 8192;

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

/// What a lightmap bake is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeSettings {
    /// How light is followed.
    pub transport: Transport,
    /// Paths that start in each texel; rounded up to a multiple of [`REPLICATES`](super::REPLICATES).
    pub samples_per_texel: u32,
    /// Texels per metre of surface where an object asks for nothing else; for [`Layout::Packed`].
    pub density: f32,
    /// Where the texels go.
    pub layout: Layout,
    /// Whether noise is taken out.
    pub denoise: Denoise,
    /// Threads that trace; `None` for all cores.
    pub threads: Option<NonZeroUsize>,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            transport: Transport::default(),
            samples_per_texel: 256,
            density: 16.0,
            layout: Layout::default(),
            denoise: Denoise::default(),
            threads: None,
        }
    }
}

impl BakeSettings {
    /// Refuses settings that cannot be met.
    pub fn validate(&self) -> Result<(), BakeError> {
        let refuse = |setting, reason: &str| Err(BakeError::Settings { setting, reason: reason.to_owned() });
        if self.samples_per_texel == 0 {
            return refuse("spp", "a texel needs at least one path; ask for 1 or more");
        }
        if !(self.density.is_finite() && self.density > 0.0) {
            return refuse("density", "it must be a positive number of texels per metre");
        }
        match self.layout {
            Layout::Shared { size } if size == 0 || size > MAX_SHARED_SIZE => {
                refuse("size", "a shared map is 1 to 8192 texels wide")
            }
            _ => Ok(()),
        }
    }
}

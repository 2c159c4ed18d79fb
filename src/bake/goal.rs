//! When a texel has been sampled enough.

use super::BakeError;
use std::time::Duration;

/// Largest error that may be asked for.
const MOST_ERROR: f64 = 1.0;

/// Smallest, which a texel of ordinary noise reaches only by as many paths as one may have.
const LEAST_ERROR: f64 = 1e-4;

/// When a texel has been sampled enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// When the truth lies, in 95 of 100 cases, no farther from it than this share of its value, by luminance: 0.02
    /// is 2 %. Of a texel that is darker than [`DARK`] of the mean over all, that floor is the value. Before denoising.
    Error(f64),
    /// When so many paths have started from it; rounded up to a multiple of [`REPLICATES`](super::REPLICATES).
    Samples(u32),
    /// The smallest error that a short pilot says can be had in this time, for all texels alike. The report says which
    /// it was: asked for by itself it gives the same texels again.
    Time(Duration),
}

/// The share of the mean luminance of all texels below which an error is no longer relative.
///
/// On a screen where that mean is middle grey (18 % of white), 2 % of this floor is 3.6e-4 of white, and the finest
/// step of an 8-bit sRGB picture, that of its darkest greys, 1 / (255 · 12.92) or 3.0e-4 of white: below the floor 2 %
/// is one step of what can be shown.
pub const DARK: f64 = 0.1;

impl Default for Goal {
    fn default() -> Self {
        Self::Error(0.02)
    }
}

impl Goal {
    /// Refuses what cannot be met.
    pub(super) fn validate(self) -> Result<(), BakeError> {
        let refuse = |setting, reason: &str| Err(BakeError::Settings { setting, reason: reason.to_owned() });
        match self {
            Self::Error(error) if !(LEAST_ERROR..=MOST_ERROR).contains(&error) => {
                refuse("error", "ask for 0.01 % to 100 %, such as 2 %")
            }
            Self::Samples(0) => refuse("spp", "a texel needs at least one path; ask for 1 or more"),
            Self::Time(time) if time.is_zero() => refuse("time", "a bake takes some time; ask for a second or more"),
            _ => Ok(()),
        }
    }
}

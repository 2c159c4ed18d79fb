//! The Owen-scrambled, shuffled Sobol sequence (Burley 2020), by the crate `sobol_burley`.
//!
//! Every group of four dimensions is the *first four* of the sequence under a seed of its own ("padding", Burley
//! 2020, § 6): low Sobol dimensions have the best two-dimensional projections, and independent seeds leave no
//! correlation between groups. The sequence ends at 2¹⁶ samples; later ones start it again under another seed.

use super::{Dimensions, Sampler};
use crate::math::{combine, seed32};

/// Sets the keys of later blocks apart from all that a caller derives from the same key by a small number.
const BLOCKS: u64 = 0x626c_6f63_6b73;

/// One path's numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sobol {
    key: u64,
    index: u32,
}

impl Sobol {
    /// Sample `index` of the sequence that belongs to `key`.
    #[inline]
    pub(crate) fn new(key: u64, index: u64) -> Self {
        let block = index >> 16;
        let key = if block == 0 { key } else { combine(combine(key, BLOCKS), block) };
        Self { key, index: (index & 0xffff) as u32 }
    }
}

impl Sampler for Sobol {
    #[inline]
    fn draw(&self, dimensions: Dimensions) -> [f32; 4] {
        let seed = seed32(combine(self.key, u64::from(dimensions.group())));
        sobol_burley::sample_4d(self.index, 0, seed)
    }
}

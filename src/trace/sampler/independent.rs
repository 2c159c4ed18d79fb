//! Independent uniform numbers: the plain Monte Carlo that the others are measured against.

use super::{Dimensions, Sampler};
use crate::math::combine;

/// One path's numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Independent {
    key: u64,
}

impl Independent {
    /// Sample `index` of the numbers that belong to `key`.
    pub(crate) fn new(key: u64, index: u64) -> Self {
        Self { key: combine(key, index) }
    }
}

impl Sampler for Independent {
    fn draw(&self, dimensions: Dimensions) -> [f32; 4] {
        let key = combine(self.key, u64::from(dimensions.group()));
        [0, 1, 2, 3].map(|number| (combine(key, number) >> 40) as f32 / (1_u32 << 24) as f32)
    }
}

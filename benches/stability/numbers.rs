//! Random numbers for the naive methods, as good as the product's own: Owen-scrambled Sobol points, so that what
//! separates two curves is never the quality of the points.

use bevy_kiln::math::{combine, seed32};

/// Dimensions that come from the Sobol sequence, in fours; beyond them numbers are hashed.
const SOBOL_SETS: u32 = 64;

/// Points of one scrambled sequence. Where it ends, another one begins.
const SEQUENCE: u64 = 1 << 16;

/// The numbers of one sample.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    key: u64,
    index: u64,
}

impl Numbers {
    /// Those of sample `index` of the estimate that `key` stands for.
    pub fn new(key: u64, index: u64) -> Self {
        Self { key, index }
    }

    /// Four numbers in [0, 1) for each `set`.
    pub fn draw(&self, set: u32) -> [f32; 4] {
        let key = combine(self.key, self.index / SEQUENCE);
        if set < SOBOL_SETS {
            return sobol_burley::sample_4d((self.index % SEQUENCE) as u32, set, seed32(key));
        }
        let bits = combine(combine(key, self.index), u64::from(set));
        [0, 1, 2, 3].map(|part| (seed32(combine(bits, part)) >> 8) as f32 / 16_777_216.0)
    }
}

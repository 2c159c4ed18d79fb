//! Random numbers for the naive methods, as good as the product's own and dealt alike: Owen-scrambled Sobol points, in
//! as many independently scrambled runs, so that what separates two curves is never the quality of the points.

use bevy_kiln::bake::REPLICATES;
use bevy_kiln::math::{combine, seed32};

/// Dimensions that come from the Sobol sequence, in fours; beyond them numbers are hashed.
const SOBOL_SETS: u32 = 64;

/// The numbers of one sample.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    key: u64,
    index: u64,
}

impl Numbers {
    /// Those of sample `index` of the estimate at one point that `key` stands for.
    pub fn new(key: u64, index: u64) -> Self {
        let runs = u64::from(REPLICATES);
        Self { key: combine(key, index % runs), index: index / runs }
    }

    /// Four numbers in [0, 1) for each `set`.
    pub fn draw(&self, set: u32) -> [f32; 4] {
        if set < SOBOL_SETS {
            return sobol_burley::sample_4d(self.index as u32, set, seed32(self.key));
        }
        let bits = combine(combine(self.key, self.index), u64::from(set));
        [0, 1, 2, 3].map(|part| (seed32(combine(bits, part)) >> 8) as f32 / 16_777_216.0)
    }
}

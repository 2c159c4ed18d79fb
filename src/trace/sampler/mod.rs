//! Where the numbers in [0, 1) come from: pure functions of (key; replicate; sample; dimension), without state.

mod independent;
mod sobol;

pub(crate) use independent::Independent;
pub(crate) use sobol::Sobol;

/// What a group of four numbers is for. Groups do not share a dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dimensions {
    /// Where a path starts: two for the place in the texel or the pixel, the last for what a camera's ray passes.
    Start,
    /// The way on from a vertex: two for the direction, one for roulette, one for the lobe.
    Scatter {
        /// Number of the vertex along the path.
        vertex: u32,
    },
    /// A point on a light, seen from a vertex: two for the point, one for the choice of light; the last for what the
    /// way on from the vertex passes.
    Light {
        /// Number of the vertex along the path.
        vertex: u32,
    },
}

impl Dimensions {
    /// A number for the group; the first ones are the best distributed.
    #[inline]
    fn group(self) -> u32 {
        match self {
            Self::Scatter { vertex: 0 } => 0,
            Self::Start => 1,
            Self::Light { vertex } => 2 * vertex + 2,
            Self::Scatter { vertex } => 2 * vertex + 1,
        }
    }
}

/// A source of numbers for one path.
pub(crate) trait Sampler {
    /// Four numbers in [0, 1).
    fn draw(&self, dimensions: Dimensions) -> [f32; 4];
}

#[cfg(test)]
mod tests;

//! How light moves: a scene compiled for rays and the estimators on it. Has never heard of lightmaps.
//!
//! [`Transport`] says how light is followed; what asks for it lies to the right.

mod accel;
mod aim;
mod around;
mod attributes;
mod bsdf;
mod census;
mod closed;
mod compile;
mod effects;
mod kernel;
mod known;
mod light;
mod material;
mod mis;
mod path;
mod sampler;
mod shade;
mod surface;
mod surroundings;
mod tangents;
#[cfg(test)]
mod testing;
mod texture;
mod traced;
mod tracer;
mod transport;
mod triangle;

pub use aim::Aim;
pub(crate) use census::{Census, effect_of};
pub(crate) use compile::Compiled;
pub use effects::{Effect, EffectSet, ForcedEffects};
pub(crate) use known::{KnownCell, KnownGrid, KnownLight, Unfolded};
pub(crate) use path::{Arrived, MAX_VERTICES, MOST_RECEIVERS, PathStart, Tally};
pub(crate) use sampler::{Dimensions, Independent, Sampler, Sobol};
pub(crate) use surroundings::Surroundings;
pub(crate) use tracer::Receiver;
pub use tracer::{RayHit, Tracer};
pub use transport::{Estimator, Sharing, Transport};

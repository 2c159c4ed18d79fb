//! How light moves: a scene compiled for rays and the estimators on it. Has never heard of lightmaps.

mod transport;

pub use transport::{Estimator, Transport};

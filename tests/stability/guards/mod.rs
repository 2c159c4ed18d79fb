//! Every guard of the catalogue, by the part of the source that it stands in.

pub mod bake;
pub mod bsdf;
pub mod crossings;
pub mod light;
pub mod output;
pub mod path;
pub mod rays;
pub mod sampler;
pub mod scene;
pub mod texture;

//! Results as files: what a game displays (KTX2 and the manifest), what a person looks at (PNG) and what is
//! measured with (EXR).
//!
//! It owns the encodings and that nothing which was on disk is lost. It neither changes a value, save to clamp it
//! to what a format holds, nor knows how a value came about.

mod bc6h;
mod compression;
mod cost;
mod error;
mod exr;
mod format;
mod ktx2;
mod lightmap;
mod overview;
mod picture;
mod png;
mod reference;
mod rgb9e5;
mod safe_write;
#[cfg(feature = "study")]
mod study;
#[cfg(test)]
mod test_pages;
mod texels;
mod tone;
mod volume;

pub use compression::CompressionError;
pub use error::OutputError;
pub use format::{OutputFormat, TexelFormat, UnknownFormat};
pub use ktx2::ktx2_bytes;
pub use lightmap::{WrittenLightmap, write_bake, write_lightmap};
pub use picture::write_picture;
pub use reference::{ReferenceError, ReferenceFault, compare_with_reference};
#[cfg(feature = "study")]
pub use study::{study_answer, write_study};
pub use texels::{Encoded, texel_bytes};
pub use tone::{Look, ToneCurve};
pub use volume::{VolumeTexture, volume_format};

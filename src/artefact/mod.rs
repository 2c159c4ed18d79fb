//! What a bake leaves behind, as plain data that a shipped game reads without the tracer.

mod manifest;
mod stable_id;

pub use manifest::{BakedLight, MANIFEST_FILE, MANIFEST_VERSION, Manifest, ManifestError, Page, Placement};
pub use stable_id::StableId;

//! What a bake leaves behind, as plain data that a shipped game reads without the tracer.

mod fingerprint;
mod manifest;
mod mesh_hash;
mod mesh_layout;
mod mixing;
mod stable_id;

pub use fingerprint::{Change, Fingerprint};
pub use manifest::{BakedLight, MANIFEST_FILE, MANIFEST_VERSION, Manifest, ManifestError, Page, Placement, Volume};
pub use mesh_hash::MeshHash;
pub use mesh_layout::{MESHES_FILE, MESHES_VERSION, MeshLayout, MeshLayoutError};
pub use stable_id::StableId;

//! What exists: a scene as plain data, in physical terms.
//!
//! A [`Scene`] is a snapshot. It owns its meshes, materials and lights, knows nothing of rays or of Bevy, and may
//! be built by hand, from a file or from a running game. [`Scene::validate`] names every fault in it; what is at
//! fault is left out of a bake with a warning, never silently.
//!
//! Lengths are metres, Y is up, colours are linear Rec. 709.

mod camera;
mod change;
mod environment;
mod fault;
mod id;
mod light;
mod material;
mod mesh;
mod texture;
mod validate;

pub use camera::Camera;
pub(crate) use change::Change;
pub use environment::EnvironmentMap;
pub use fault::{Fault, FaultKind, Subject};
pub use id::unique_ids;
pub use light::{DirectionalLight, Light, PointLight, RectLight, SpotLight};
pub use material::{Alpha, Interior, Material, NormalEncoding, NormalMap, Scattering, Standard};
pub use mesh::{Indices, Instance, LightmapRequest, Mesh, Topology};
pub use texture::{Filter, Texels, Texture, TextureRef, UvChannel, Wrap};

use crate::artefact::{Fingerprint, StableId};
use glam::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// Everything that light meets, and everything that gives light.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Shapes in their own frames, shared by instances.
    pub meshes: Vec<Mesh>,
    /// Surface descriptions, shared by instances.
    pub materials: Vec<Material>,
    /// Pictures that materials refer to.
    pub textures: Vec<Texture>,
    /// Placed meshes.
    pub instances: Vec<Instance>,
    /// Light sources that are no meshes.
    pub lights: Vec<Light>,
    /// Ids of those whose direct light is drawn in real time: lightmaps hold only what surfaces send on of it.
    pub indirect_only: BTreeSet<StableId>,
    /// Ids of those that are off in real time: irradiance volumes hold their direct light too.
    pub off_in_real_time: BTreeSet<StableId>,
    /// What its owner wants to know its instances and lights by later: a bake passes it on and looks at none of it.
    pub fingerprints: BTreeMap<StableId, Fingerprint>,
    /// Radiance of a sky that is the same in every direction [cd/m²]. Black is no sky.
    pub sky_radiance: Vec3,
    /// A picture of the sky, on top of `sky_radiance`.
    pub environment: Option<EnvironmentMap>,
    /// Views into the scene, for pictures.
    pub cameras: Vec<Camera>,
}

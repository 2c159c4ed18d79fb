//! Light sources that are no meshes. A glowing mesh is an [`Instance`](super::Instance) whose material emits.

use crate::artefact::StableId;
use glam::{Affine3A, Vec3};

/// A light source that is no mesh.
#[derive(Clone, Debug)]
pub enum Light {
    /// A glowing rectangle that blocks nothing.
    Rect(RectLight),
}

impl Light {
    /// The id that the light's random numbers and its records go by.
    pub fn id(&self) -> &StableId {
        match self {
            Self::Rect(light) => &light.id,
        }
    }

    /// The name by which a person knows it.
    pub fn name(&self) -> &str {
        match self {
            Self::Rect(light) => &light.name,
        }
    }
}

/// A rectangle in the local XY plane that shines along local −Z and blocks nothing, as Bevy's `RectLight`.
#[derive(Clone, Debug)]
pub struct RectLight {
    /// Stable from bake to bake.
    pub id: StableId,
    /// The name by which a person knows it.
    pub name: String,
    /// Light frame to world: a rotation and a translation; scale belongs in `width` and `height`.
    pub world_from_local: Affine3A,
    /// Extent along local X [m].
    pub width: f32,
    /// Extent along local Y [m].
    pub height: f32,
    /// Radiance of the front, before the range window [cd/m²].
    pub radiance: Vec3,
    /// Distance from its centre at which Bevy's window (1 − (d/range)⁴)² has taken all light [m]; `None` for none.
    pub range: Option<f32>,
}

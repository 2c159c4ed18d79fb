//! Light sources that are no meshes. A glowing mesh is an [`Instance`](super::Instance) whose material emits.
//!
//! All of them block nothing and are seen by no camera, as in Bevy; mirrors and glass show those that have a size.

use crate::artefact::StableId;
use glam::{Affine3A, Vec3};

/// A light source that is no mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum Light {
    /// A glowing rectangle.
    Rect(RectLight),
    /// A glowing sphere, or a point.
    Point(PointLight),
    /// A glowing sphere, or a point, that shines into a cone.
    Spot(SpotLight),
    /// A disc in the sky, or a single direction.
    Directional(DirectionalLight),
}

impl Light {
    /// The id that the light's random numbers and its records go by.
    pub fn id(&self) -> &StableId {
        match self {
            Self::Rect(light) => &light.id,
            Self::Point(light) => &light.id,
            Self::Spot(light) => &light.bulb.id,
            Self::Directional(light) => &light.id,
        }
    }

    /// The name by which a person knows it.
    pub fn name(&self) -> &str {
        match self {
            Self::Rect(light) => &light.name,
            Self::Point(light) => &light.name,
            Self::Spot(light) => &light.bulb.name,
            Self::Directional(light) => &light.name,
        }
    }

    /// The same, to be changed.
    pub(crate) fn name_mut(&mut self) -> &mut String {
        match self {
            Self::Rect(light) => &mut light.name,
            Self::Point(light) => &mut light.name,
            Self::Spot(light) => &mut light.bulb.name,
            Self::Directional(light) => &mut light.name,
        }
    }
}

/// A rectangle in the local XY plane that shines along local −Z and blocks nothing, as Bevy's `RectLight`.
#[derive(Clone, Debug, PartialEq)]
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

/// A sphere of the same radiance all over that blocks nothing, as Bevy's `PointLight`; a point where it has no radius.
/// A receiver inside the sphere sees it shrunk until it touches the receiver, at the same intensity.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLight {
    /// Stable from bake to bake.
    pub id: StableId,
    /// The name by which a person knows it.
    pub name: String,
    /// Its centre [m].
    pub position: Vec3,
    /// Intensity in every direction, before the range window [cd].
    pub intensity: Vec3,
    /// Its radius [m], at least 0.
    pub radius: f32,
    /// Distance from its centre at which Bevy's window (1 − (d/range)⁴)² has taken all light [m]; `None` for none.
    pub range: Option<f32>,
}

/// A [`PointLight`] behind a cone, as Bevy's `SpotLight`: all of the sphere is dimmed by where the receiver lies,
/// by saturate((cos θ − cos outer) / (cos inner − cos outer))², θ between the axis and the way from the centre to the
/// receiver.
#[derive(Clone, Debug, PartialEq)]
pub struct SpotLight {
    /// The lamp; its intensity is that on the axis.
    pub bulb: PointLight,
    /// Unit direction in which it shines.
    pub direction: Vec3,
    /// Angle from the axis within which it is not dimmed [rad].
    pub inner_angle: f32,
    /// Angle from the axis beyond which it is dark [rad].
    pub outer_angle: f32,
}

/// A disc of the same radiance all over, infinitely far away, as Bevy's `DirectionalLight` with its `SunDisk`; a
/// single direction where it has no diameter.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Stable from bake to bake.
    pub id: StableId,
    /// The name by which a person knows it.
    pub name: String,
    /// Unit direction in which its light travels.
    pub direction: Vec3,
    /// Illuminance on a surface that faces it [lx].
    pub illuminance: Vec3,
    /// Whole angle across the disc [rad], in [0, π].
    pub angular_diameter: f32,
}

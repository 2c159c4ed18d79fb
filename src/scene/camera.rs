//! A pinhole camera: where a picture is taken from.

use glam::{Affine3A, Vec3};

/// A pinhole camera that looks along its local −Z with +Y up.
#[derive(Clone, Debug)]
pub struct Camera {
    /// The name by which a person asks for it.
    pub name: String,
    /// Camera frame to world; a rotation and a translation.
    pub world_from_camera: Affine3A,
    /// Whole vertical opening angle [rad].
    pub vertical_fov: f32,
}

impl Camera {
    /// A camera at `eye` that looks at `target`, with world +Y up (or +Z where it looks straight up or down).
    pub fn look_at(name: impl Into<String>, eye: Vec3, target: Vec3, vertical_fov: f32) -> Self {
        let forward = (target - eye).normalize_or(Vec3::NEG_Z);
        let up = if forward.cross(Vec3::Y).length_squared() < 1e-12 { Vec3::Z } else { Vec3::Y };
        Self { name: name.into(), world_from_camera: Affine3A::look_to_rh(eye, forward, up).inverse(), vertical_fov }
    }
}

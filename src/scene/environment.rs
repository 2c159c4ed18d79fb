//! What shines from infinitely far away in all directions: a picture of the whole sphere.

use crate::math::Portable;
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::{PI, TAU};
use std::sync::Arc;

/// An equirectangular picture of the sky, constant over each of its pixels. Row 0 is up (+Y); in its own frame, a
/// unit direction lies at u = ½ + atan2(z, x)/2π, v = arccos(y)/π, so that +X is in the middle and −Z a quarter from
/// the left, as in Blender and in three.js.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// The name by which a person knows it.
    pub name: String,
    /// Width [pixels].
    pub width: u32,
    /// Height [pixels].
    pub height: u32,
    /// Radiance that arrives from each pixel, row by row [cd/m²].
    pub radiance: Arc<[Vec3]>,
    /// The picture's frame to world: a rotation.
    pub world_from_map: Quat,
}

impl EnvironmentMap {
    /// Place on the picture, in the unit square, of a unit direction in the picture's frame.
    #[inline]
    pub fn place_of(direction: Vec3) -> Vec2 {
        let u = 0.5 + Portable::atan2(direction.z, direction.x) / TAU;
        // By the sine near the poles, where the cosine says little.
        let v = Portable::atan2(Portable::hypot(direction.x, direction.z), direction.y) / PI;
        Vec2::new(u, v)
    }

    /// Unit direction, in the picture's frame, of a place on the picture.
    #[inline]
    pub fn direction_of(place: Vec2) -> Vec3 {
        let (sin_phi, cos_phi) = Portable::sin_cos((place.x - 0.5) * TAU);
        let (sin_theta, cos_theta) = Portable::sin_cos(place.y * PI);
        Vec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_is_x_and_a_quarter_from_the_left_is_minus_z() {
        let near = |place: Vec2, direction: Vec3| {
            assert!((EnvironmentMap::direction_of(place) - direction).length() < 1e-6, "{place}");
            assert!((EnvironmentMap::place_of(direction) - place).length() < 1e-6, "{direction}");
        };
        near(Vec2::new(0.5, 0.5), Vec3::X);
        near(Vec2::new(0.25, 0.5), Vec3::NEG_Z);
        near(Vec2::new(0.75, 0.5), Vec3::Z);
        near(Vec2::new(0.5, 0.25), Vec3::new(1.0, 1.0, 0.0).normalize());
        assert!((EnvironmentMap::direction_of(Vec2::new(0.3, 0.0)) - Vec3::Y).length() < 1e-6);
    }
}

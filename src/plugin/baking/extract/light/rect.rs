//! `RectLight`: one-sided, of radiance Φ/(π·w·h), its extent scaled by the lengths of its axes.

use super::Reader;
use crate::plugin::display::MutedLight;
use crate::scene;
use bevy::light::RectLight;
use bevy::math::{Affine3A, Mat3A};
use bevy::prelude::*;
use std::f32::consts::PI;

impl Reader<'_> {
    pub(super) fn rect(&self) -> Option<scene::Light> {
        let light = self.world.get::<RectLight>(self.thing.entity)?;
        let power = MutedLight::rect_power(self.muted(), light.intensity);
        let affine = self.affine();
        let width = light.width * affine.matrix3.x_axis.length();
        let height = light.height * affine.matrix3.y_axis.length();
        let area = width * height;
        // A light without area is named as such by the scene's own check; infinite radiance would only hide that.
        let radiance = if area > 0.0 { power / (PI * area) } else { 0.0 };
        Some(scene::Light::Rect(scene::RectLight {
            id: self.thing.id.clone(),
            name: self.thing.name.clone(),
            world_from_local: frame(&affine),
            width,
            height,
            radiance: light.color.to_linear().to_vec3() * radiance,
            range: self.range(light.range),
        }))
    }
}

/// The right-handed frame that Bevy makes of a light's right and up, whatever scale, shear or mirror is in its
/// transform.
fn frame(affine: &Affine3A) -> Affine3A {
    let right = affine.matrix3.x_axis.normalize_or(Vec3::X.into());
    let up = affine.matrix3.y_axis - right * right.dot(affine.matrix3.y_axis);
    let up = up.normalize_or(right.any_orthonormal_vector());
    Affine3A { matrix3: Mat3A::from_cols(right, up, right.cross(up)), translation: affine.translation }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirrored_light_keeps_a_right_handed_frame() {
        let affine = Affine3A::from_scale_rotation_translation(
            Vec3::new(-2.0, 3.0, 1.0),
            Quat::from_rotation_y(0.3),
            Vec3::new(1.0, 2.0, 3.0),
        );
        let frame = frame(&affine);
        assert!((frame.matrix3.determinant() - 1.0).abs() < 1e-5);
        assert!((frame.matrix3.x_axis - affine.matrix3.x_axis / 2.0).length() < 1e-6);
        assert_eq!(frame.translation, affine.translation);
    }
}

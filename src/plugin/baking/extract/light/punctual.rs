//! `PointLight` and `SpotLight`: both Φ/4π cd, whatever the cone.

use super::{Reader, is_from_gltf};
use crate::math::Portable;
use crate::plugin::display::MutedLight;
use crate::scene;
use bevy::light::{PointLight, SpotLight};
use bevy::prelude::*;
use std::f32::consts::{FRAC_PI_2, PI};

/// How far below a right angle Bevy keeps a cone [rad].
const WIDEST: f32 = FRAC_PI_2 - 1e-4;

/// Least difference of the cosines of the two angles of a cone.
const STEEPEST: f32 = 1e-4;

impl Reader<'_> {
    pub(super) fn point(&self) -> Option<scene::Light> {
        let light = self.world.get::<PointLight>(self.thing.entity)?;
        let power = MutedLight::point_power(self.muted(), light.intensity);
        let intensity = light.color.to_linear().to_vec3() * (power / (4.0 * PI));
        Some(scene::Light::Point(self.bulb(intensity, light.radius, light.range)))
    }

    pub(super) fn spot(&self) -> Option<scene::Light> {
        let light = self.world.get::<SpotLight>(self.thing.entity)?;
        let power = MutedLight::spot_power(self.muted(), light.intensity);
        let intensity = light.color.to_linear().to_vec3() * (power / (4.0 * PI));
        // The glTF loader puts the range into the radius as well.
        let is_loaders = light.radius == light.range && is_from_gltf(self.world, self.thing.entity);
        let radius = if is_loaders { 0.0 } else { light.radius };
        let [inner_angle, outer_angle] = cone(light.inner_angle, light.outer_angle);
        Some(scene::Light::Spot(scene::SpotLight {
            bulb: self.bulb(intensity, radius, light.range),
            direction: self.forward(),
            inner_angle,
            outer_angle,
        }))
    }

    /// A transform's scale changes neither radius nor range.
    fn bulb(&self, intensity: Vec3, radius: f32, range: f32) -> scene::PointLight {
        scene::PointLight {
            id: self.thing.id.clone(),
            name: self.thing.name.clone(),
            position: self.affine().translation.into(),
            intensity,
            radius,
            range: self.range(range),
        }
    }
}

/// Inner and outer angle as Bevy has them: below a right angle, and a little apart in their cosines.
fn cone(inner: f32, outer: f32) -> [f32; 2] {
    let outer = if outer >= FRAC_PI_2 { WIDEST } else { outer };
    let apart = Portable::acos((Portable::cos(outer) + STEEPEST).min(1.0));
    [inner.min(apart), outer]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_is_kept_as_bevy_keeps_it() {
        assert_eq!(cone(0.2, 0.5), [0.2, 0.5]);
        assert_eq!(cone(0.2, 3.0), [0.2, WIDEST]);
        let [inner, outer] = cone(0.5, 0.5);
        assert!(outer == 0.5 && (inner.cos() - outer.cos() - STEEPEST).abs() < 1e-6, "{inner}");
        assert!(cone(0.1, f32::NAN)[1].is_nan(), "to be named by the scene's own check");
    }
}

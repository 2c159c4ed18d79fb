//! `RectLight` into lights; the other kinds are named as not baked yet.

use super::{Extraction, ExtractionWarning, Kind, Thing, is_visible};
use crate::plugin::baking::{RangeWindow, SceneSettings};
use crate::plugin::display::MutedLight;
use crate::plugin::stable_id;
use crate::scene;
use bevy::light::{PointLight, RectLight, SpotLight};
use bevy::math::{Affine3A, Mat3A};
use bevy::prelude::*;
use std::f32::consts::PI;

/// The lights that take part, and a warning for each that does not.
pub(super) fn find(world: &mut World, warnings: &mut Vec<ExtractionWarning>) -> Vec<Thing> {
    let mut not_baked = Vec::new();
    let mut kinds = world.query::<(Entity, Has<PointLight>, Has<SpotLight>, Has<DirectionalLight>)>();
    for (entity, point, spot, directional) in kinds.iter(world) {
        let kinds = [(point, "point light"), (spot, "spot light"), (directional, "directional light")];
        not_baked.extend(kinds.into_iter().filter(|(has, _)| *has).map(|(_, kind)| (entity, kind)));
    }
    let mut rects = world.query_filtered::<Entity, With<RectLight>>();
    let rects: Vec<Entity> = rects.iter(world).collect();
    let world = &*world;
    let mut named: Vec<(String, &'static str)> = not_baked
        .into_iter()
        .filter(|&(entity, _)| is_visible(world, entity))
        .map(|(entity, kind)| (stable_id(world, entity).as_str().to_owned(), kind))
        .collect();
    named.sort();
    warnings.extend(named.into_iter().map(|(name, kind)| ExtractionWarning::LightNotBaked { name, kind }));
    let visible = rects.into_iter().filter(|&entity| is_visible(world, entity));
    visible.map(|entity| Thing::new(world, entity, Kind::RectLight)).collect()
}

/// Adds one rectangular light with Bevy's own radiometry (bevy_pbr 0.19, render/light.rs): one-sided, of radiance
/// Φ/(π·w·h), its extent scaled by the lengths of its axes.
pub(super) fn extract(world: &World, thing: &Thing, settings: &SceneSettings, out: &mut Extraction) {
    let Some(light) = world.get::<RectLight>(thing.entity) else { return };
    let muted = world.get::<MutedLight>(thing.entity).and_then(|muted| muted.rect_intensity);
    let power = if light.intensity == 0.0 { muted.unwrap_or(0.0) } else { light.intensity };
    let affine = world.get::<GlobalTransform>(thing.entity).copied().unwrap_or_default().affine();
    let width = light.width * affine.matrix3.x_axis.length();
    let height = light.height * affine.matrix3.y_axis.length();
    let area = width * height;
    // A light without area is named as such by the scene's own check; infinite radiance would only hide that.
    let radiance = if area > 0.0 { power / (PI * area) } else { 0.0 };
    out.scene.lights.push(scene::Light::Rect(scene::RectLight {
        id: thing.id.clone(),
        name: thing.name.clone(),
        world_from_local: frame(&affine),
        width,
        height,
        radiance: light.color.to_linear().to_vec3() * radiance,
        range: match settings.range {
            RangeWindow::AsDisplayed => Some(light.range),
            RangeWindow::Ignore => None,
        },
    }));
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

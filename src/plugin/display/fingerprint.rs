//! What a mesh or a light is like, for the baker to write down and for a shipped game to compare: where it is in its
//! file, and its material or what it shines. Nothing of it needs the renderer, the vertices or the pictures.

use super::LightBaking;
use super::mute::MutedLight;
use crate::artefact::Fingerprint;
use bevy::light::RectLight;
use bevy::math::Affine3A;
use bevy::prelude::*;
use bevy::world_serialization::{DynamicWorldRoot, WorldAssetRoot};
use std::fmt::Write;

/// The fingerprint of an entity as it stands; `None` while its material is not loaded.
pub(crate) fn fingerprint(world: &World, entity: Entity) -> Option<Fingerprint> {
    let place = place(world, entity).to_cols_array();
    let mut look = String::new();
    if let Some(handle) = world.get::<MeshMaterial3d<StandardMaterial>>(entity) {
        write_material(world.get_resource::<Assets<StandardMaterial>>()?.get(&handle.0)?, &mut look).ok()?;
    }
    write_lights(world, entity, &mut look).ok()?;
    Some(Fingerprint::new(place, &look))
}

/// From an entity's frame to that of its file, which a game may put wherever it likes.
fn place(world: &World, entity: Entity) -> Affine3A {
    let mut place = Affine3A::IDENTITY;
    let mut next = Some(entity);
    while let Some(entity) = next {
        if world.get::<WorldAssetRoot>(entity).is_some() || world.get::<DynamicWorldRoot>(entity).is_some() {
            break;
        }
        place = world.get::<Transform>(entity).copied().unwrap_or_default().compute_affine() * place;
        next = world.get::<ChildOf>(entity).map(ChildOf::parent);
    }
    place
}

/// Numbers to their last digit, which are alike on every machine as long as nothing is worked out from them.
fn write_material(of: &StandardMaterial, look: &mut String) -> std::fmt::Result {
    let numbers = (of.base_color, of.emissive, of.metallic, of.perceptual_roughness, of.reflectance, of.alpha_mode);
    let light = (of.specular_transmission, of.diffuse_transmission, of.thickness, of.ior, of.attenuation_color);
    let switches = (of.attenuation_distance, of.unlit, of.double_sided, of.emissive_exposure_weight);
    write!(look, "{numbers:?} {light:?} {switches:?}")?;
    let pictures =
        [&of.base_color_texture, &of.emissive_texture, &of.metallic_roughness_texture, &of.normal_map_texture];
    for path in pictures.into_iter().map(|picture| picture.as_ref().and_then(Handle::path)) {
        // The command line has assets elsewhere.
        let file = path.and_then(|path| path.path().file_name()).map(|file| file.to_string_lossy());
        write!(look, " {file:?} {:?}", path.and_then(|path| path.label()))?;
    }
    Ok(())
}

/// What lights are by themselves, whatever is turned down for the sake of a bake.
fn write_lights(world: &World, entity: Entity, look: &mut String) -> std::fmt::Result {
    let muted = world.get::<MutedLight>(entity);
    let mode = LightBaking::of(world, entity);
    if let Some(of) = world.get::<RectLight>(entity) {
        let power = MutedLight::rect_power(muted, of.intensity);
        write!(look, "rect {mode:?} {:?}", (of.color, power, of.range, of.width, of.height))?;
    }
    if let Some(of) = world.get::<PointLight>(entity) {
        let power = MutedLight::point_power(muted, of.intensity);
        write!(look, "point {mode:?} {:?}", (of.color, power, of.range, of.radius))?;
    }
    if let Some(of) = world.get::<SpotLight>(entity) {
        let power = MutedLight::spot_power(muted, of.intensity);
        let cone = (of.inner_angle, of.outer_angle);
        write!(look, "spot {mode:?} {:?} {cone:?}", (of.color, power, of.range, of.radius))?;
    }
    if let Some(of) = world.get::<DirectionalLight>(entity) {
        let illuminance = MutedLight::illuminance(muted, of.illuminance);
        write!(look, "sun {mode:?} {:?}", (of.color, illuminance))?;
    }
    Ok(())
}

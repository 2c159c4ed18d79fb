//! Keeping a light whose direct light is in the lightmaps from being added again, and giving it back as it was.

use bevy::light::RectLight;
use bevy::prelude::*;

/// What a light was before its direct light went into the lightmaps.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct MutedLight {
    /// A rectangular light's own power [lm]. Bevy 0.19 has no flag for it, so it is turned down to nothing; hiding
    /// it would hide what is below it as well.
    pub(crate) rect_intensity: Option<f32>,
    point: Option<bool>,
    spot: Option<bool>,
    directional: Option<bool>,
}

/// Keeps a light from being added to lightmapped meshes. Does nothing to one that is muted already.
pub(crate) fn mute_light(entity: &mut EntityWorldMut) {
    if entity.contains::<MutedLight>() {
        return;
    }
    let mut before = MutedLight::default();
    if let Some(mut light) = entity.get_mut::<RectLight>() {
        before.rect_intensity = Some(std::mem::replace(&mut light.intensity, 0.0));
    }
    if let Some(mut light) = entity.get_mut::<PointLight>() {
        before.point = Some(std::mem::replace(&mut light.affects_lightmapped_mesh_diffuse, false));
    }
    if let Some(mut light) = entity.get_mut::<SpotLight>() {
        before.spot = Some(std::mem::replace(&mut light.affects_lightmapped_mesh_diffuse, false));
    }
    if let Some(mut light) = entity.get_mut::<DirectionalLight>() {
        before.directional = Some(std::mem::replace(&mut light.affects_lightmapped_mesh_diffuse, false));
    }
    entity.insert(before);
}

/// Gives a muted light back as it was.
pub(crate) fn unmute_light(entity: &mut EntityWorldMut) {
    let Some(before) = entity.take::<MutedLight>() else { return };
    if let (Some(intensity), Some(mut light)) = (before.rect_intensity, entity.get_mut::<RectLight>()) {
        light.intensity = intensity;
    }
    if let (Some(flag), Some(mut light)) = (before.point, entity.get_mut::<PointLight>()) {
        light.affects_lightmapped_mesh_diffuse = flag;
    }
    if let (Some(flag), Some(mut light)) = (before.spot, entity.get_mut::<SpotLight>()) {
        light.affects_lightmapped_mesh_diffuse = flag;
    }
    if let (Some(flag), Some(mut light)) = (before.directional, entity.get_mut::<DirectionalLight>()) {
        light.affects_lightmapped_mesh_diffuse = flag;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn muting_twice_and_unmuting_gives_the_light_back() {
        let mut world = World::new();
        let lamp = world.spawn((RectLight { intensity: 700.0, ..default() }, PointLight::default())).id();
        let mut entity = world.entity_mut(lamp);
        mute_light(&mut entity);
        mute_light(&mut entity);
        assert_eq!(entity.get::<RectLight>().map(|light| light.intensity), Some(0.0));
        assert_eq!(entity.get::<PointLight>().map(|light| light.affects_lightmapped_mesh_diffuse), Some(false));
        unmute_light(&mut entity);
        assert_eq!(entity.get::<RectLight>().map(|light| light.intensity), Some(700.0));
        assert_eq!(entity.get::<PointLight>().map(|light| light.affects_lightmapped_mesh_diffuse), Some(true));
        assert!(!entity.contains::<MutedLight>());
    }
}

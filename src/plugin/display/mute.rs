//! Keeping a light whose direct light is in the lightmaps from being added again, and giving it back as it was.

use super::LightBaking;
use bevy::light::RectLight;
use bevy::prelude::*;

/// What a light was before its direct light went into the lightmaps.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct MutedLight {
    rect: Option<Before>,
    point: Option<Before>,
    spot: Option<Before>,
    directional: Option<Before>,
}

/// One of an entity's lights before.
#[derive(Clone, Copy, Debug)]
struct Before {
    /// Its power [lm], or its illuminance [lx]. Turned down to nothing where nothing is to be lit in real time, and for
    /// rectangular lights, for which Bevy 0.19 has no flag. Hiding a light would hide what is below it as well.
    power: f32,
    /// Whether it lit what has a lightmap.
    lit_lightmapped: bool,
}

impl MutedLight {
    /// A rectangular light's own power, which is this now [lm].
    pub(crate) fn rect_power(muted: Option<&Self>, now: f32) -> f32 {
        own(muted.and_then(|muted| muted.rect), now)
    }

    /// The same for a point light [lm].
    pub(crate) fn point_power(muted: Option<&Self>, now: f32) -> f32 {
        own(muted.and_then(|muted| muted.point), now)
    }

    /// The same for a spot light [lm].
    pub(crate) fn spot_power(muted: Option<&Self>, now: f32) -> f32 {
        own(muted.and_then(|muted| muted.spot), now)
    }

    /// A directional light's own illuminance, which is this now [lx].
    pub(crate) fn illuminance(muted: Option<&Self>, now: f32) -> f32 {
        own(muted.and_then(|muted| muted.directional), now)
    }
}

/// A game that has turned a light up since has the last word.
fn own(before: Option<Before>, now: f32) -> f32 {
    if now == 0.0 { before.map_or(0.0, |before| before.power) } else { now }
}

/// Keeps a light from being added to lightmapped meshes, or from lighting anything, as its [`LightBaking`] says. Does
/// nothing to one that is muted already.
pub(crate) fn mute_light(entity: &mut EntityWorldMut) {
    if entity.contains::<MutedLight>() {
        return;
    }
    let is_off = LightBaking::of(entity.world(), entity.id()) == LightBaking::Baked;
    let mute = |power: &mut f32, lights_lightmapped: &mut bool| {
        let before = Before { power: *power, lit_lightmapped: *lights_lightmapped };
        *lights_lightmapped = false;
        if is_off {
            *power = 0.0;
        }
        before
    };
    let mut before = MutedLight::default();
    if let Some(mut light) = entity.get_mut::<RectLight>() {
        let power = std::mem::replace(&mut light.intensity, 0.0);
        before.rect = Some(Before { power, lit_lightmapped: true });
    }
    if let Some(mut light) = entity.get_mut::<PointLight>() {
        let PointLight { intensity, affects_lightmapped_mesh_diffuse, .. } = &mut *light;
        before.point = Some(mute(intensity, affects_lightmapped_mesh_diffuse));
    }
    if let Some(mut light) = entity.get_mut::<SpotLight>() {
        let SpotLight { intensity, affects_lightmapped_mesh_diffuse, .. } = &mut *light;
        before.spot = Some(mute(intensity, affects_lightmapped_mesh_diffuse));
    }
    if let Some(mut light) = entity.get_mut::<DirectionalLight>() {
        let DirectionalLight { illuminance, affects_lightmapped_mesh_diffuse, .. } = &mut *light;
        before.directional = Some(mute(illuminance, affects_lightmapped_mesh_diffuse));
    }
    entity.insert(before);
}

/// Gives a muted light back as it was.
pub(crate) fn unmute_light(entity: &mut EntityWorldMut) {
    let Some(before) = entity.take::<MutedLight>() else { return };
    if let (Some(before), Some(mut light)) = (before.rect, entity.get_mut::<RectLight>()) {
        light.intensity = own(Some(before), light.intensity);
    }
    if let (Some(before), Some(mut light)) = (before.point, entity.get_mut::<PointLight>()) {
        light.intensity = own(Some(before), light.intensity);
        light.affects_lightmapped_mesh_diffuse = before.lit_lightmapped;
    }
    if let (Some(before), Some(mut light)) = (before.spot, entity.get_mut::<SpotLight>()) {
        light.intensity = own(Some(before), light.intensity);
        light.affects_lightmapped_mesh_diffuse = before.lit_lightmapped;
    }
    if let (Some(before), Some(mut light)) = (before.directional, entity.get_mut::<DirectionalLight>()) {
        light.illuminance = own(Some(before), light.illuminance);
        light.affects_lightmapped_mesh_diffuse = before.lit_lightmapped;
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
        let point = |entity: &EntityWorldMut| {
            entity.get::<PointLight>().map(|light| (light.intensity, light.affects_lightmapped_mesh_diffuse))
        };
        assert_eq!(point(&entity), Some((PointLight::default().intensity, false)), "still lights what moves");
        let muted = entity.get::<MutedLight>();
        assert_eq!(MutedLight::rect_power(muted, 0.0), 700.0);
        assert_eq!(MutedLight::rect_power(muted, 5.0), 5.0);
        unmute_light(&mut entity);
        assert_eq!(entity.get::<RectLight>().map(|light| light.intensity), Some(700.0));
        assert_eq!(point(&entity), Some((PointLight::default().intensity, true)));
        assert!(!entity.contains::<MutedLight>());
    }

    #[test]
    fn a_light_that_is_only_baked_is_off_until_it_is_given_back() {
        let mut world = World::new();
        let above = world.spawn(LightBaking::Baked).id();
        let sun = world.spawn((DirectionalLight { illuminance: 900.0, ..default() }, ChildOf(above))).id();
        let mut entity = world.entity_mut(sun);
        mute_light(&mut entity);
        let illuminance = |entity: &EntityWorldMut| entity.get::<DirectionalLight>().map(|light| light.illuminance);
        assert_eq!(illuminance(&entity), Some(0.0));
        assert_eq!(MutedLight::illuminance(entity.get::<MutedLight>(), 0.0), 900.0);
        unmute_light(&mut entity);
        assert_eq!(illuminance(&entity), Some(900.0));
    }
}

//! `DirectionalLight`: its illuminance [lx] from one direction, or from the disc of a `SunDisk`.
//!
//! Without a `SunDisk` Bevy's shading and its shadows are those of a single direction; the earth's sun, which is that
//! component's default, is only what the atmosphere draws. So a disc, and its soft shadow, is what one asks for.

use super::Reader;
use crate::plugin::display::MutedLight;
use crate::scene;
use bevy::light::SunDisk;
use bevy::prelude::*;

impl Reader<'_> {
    pub(super) fn directional(&self) -> Option<scene::Light> {
        let light = self.world.get::<DirectionalLight>(self.thing.entity)?;
        let disc = self.world.get::<SunDisk>(self.thing.entity);
        Some(scene::Light::Directional(scene::DirectionalLight {
            id: self.thing.id.clone(),
            name: self.thing.name.clone(),
            direction: self.forward(),
            illuminance: light.color.to_linear().to_vec3() * MutedLight::illuminance(self.muted(), light.illuminance),
            angular_diameter: disc.map_or(0.0, |disc| disc.angular_size),
        }))
    }
}

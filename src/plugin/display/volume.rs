//! Baked irradiance volumes as entities: Bevy's `IrradianceVolume` in its box.

use bevy::light::{IrradianceVolume, LightProbe};
use bevy::prelude::*;

/// An irradiance volume that a bake has put into the world. Bevy lights with it whatever has no lightmap.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct BakedVolume;

/// A volume and where it is.
pub(crate) struct ShownVolume {
    pub(crate) name: String,
    /// Texels of E/π [cd/m²], which is what Bevy takes at an intensity of 1.
    pub(crate) voxels: Handle<Image>,
    pub(crate) centre: Vec3,
    pub(crate) rotation: Quat,
    pub(crate) size: Vec3,
    pub(crate) falloff: f32,
}

/// Puts a volume into the world.
pub(crate) fn spawn_volume(world: &mut World, volume: ShownVolume) -> Entity {
    if cfg!(target_arch = "wasm32") {
        warn_once!("Bevy 0.19 does not draw irradiance volumes in a browser, so what moves gets no baked light there");
    }
    let ShownVolume { name, voxels, centre, rotation, size, falloff } = volume;
    let bundle = (
        BakedVolume,
        Name::new(name),
        IrradianceVolume { voxels, intensity: 1.0, affects_lightmapped_meshes: false },
        LightProbe { falloff: Vec3::splat(falloff) },
        Transform { translation: centre, rotation, scale: size },
        Visibility::default(),
    );
    world.spawn(bundle).id()
}

/// Takes volumes out of the world again.
pub(crate) fn despawn_volumes(world: &mut World, volumes: &mut Vec<Entity>) {
    for volume in volumes.drain(..) {
        if let Ok(entity) = world.get_entity_mut(volume) {
            entity.despawn();
        }
    }
}

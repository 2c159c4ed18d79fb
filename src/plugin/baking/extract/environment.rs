//! What shines from all around: the asked sky and Bevy's ambient light; environment maps are named as not baked yet.

use super::{Extraction, ExtractionWarning};
use crate::plugin::baking::{AmbientMode, SceneSettings};
use crate::plugin::stable_id;
use bevy::light::{AtmosphereEnvironmentMapLight, EnvironmentMapLight, GeneratedEnvironmentMapLight};
use bevy::prelude::*;

pub(super) fn extract(world: &mut World, settings: &SceneSettings, out: &mut Extraction) {
    out.scene.sky_radiance = settings.sky_radiance;
    if let Some(ambient) = world.get_resource::<GlobalAmbientLight>() {
        match settings.ambient {
            AmbientMode::Bake => out.scene.sky_radiance += ambient.color.to_linear().to_vec3() * ambient.brightness,
            AmbientMode::Ignore if ambient.brightness > 0.0 && ambient.affects_lightmapped_meshes => {
                out.warnings.push(ExtractionWarning::AmbientStays { brightness: ambient.brightness });
            }
            AmbientMode::Ignore => {}
        }
    }
    let mut maps = world.query::<(
        Entity,
        Has<EnvironmentMapLight>,
        Has<GeneratedEnvironmentMapLight>,
        Has<AtmosphereEnvironmentMapLight>,
    )>();
    let found: Vec<(Entity, bool)> =
        maps.iter(world).map(|(entity, map, generated, sky)| (entity, map || generated || sky)).collect();
    let named = found.into_iter().filter(|(_, has)| *has).map(|(entity, _)| stable_id(world, entity));
    let mut named: Vec<String> = named.map(|id| id.as_str().to_owned()).collect();
    named.sort();
    let kind = "the environment map";
    out.warnings.extend(named.into_iter().map(|name| ExtractionWarning::EnvironmentNotBaked { name, kind }));
}

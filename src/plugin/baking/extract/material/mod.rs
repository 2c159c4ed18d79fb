//! `StandardMaterial` into materials. What a scene cannot hold is named, and only where it is really used.

mod optional;
mod standard;
mod unsimulated;

use super::{Extraction, ExtractionWarning, Thing};
use crate::plugin::baking::SceneSettings;
use crate::plugin::display::{FoundMaterial, find_described};
use crate::scene::Material;
use bevy::prelude::*;

/// What stands in for a material that is not understood.
const MID_GREY: f32 = 0.5;

/// A material's place in the scene.
#[derive(Clone, Copy)]
pub(super) struct Placed {
    pub(super) index: usize,
    /// Whether Bevy can show a lightmap with it.
    pub(super) shows_lightmaps: bool,
}

/// The place of an entity's material in the scene; reads it at its first use.
pub(super) fn place(world: &World, thing: &Thing, settings: &SceneSettings, out: &mut Extraction) -> Placed {
    let Some(FoundMaterial { id, material }) = find(world, thing.entity) else {
        out.warnings.push(ExtractionWarning::NoStandardMaterial { name: thing.name.clone() });
        return Placed { index: add(mid_grey(&thing.name), out), shows_lightmaps: false };
    };
    if let Some(&index) = out.seen.materials.get(&id) {
        return Placed { index, shows_lightmaps: true };
    }
    let material = match &material {
        Some(material) => {
            let what = unsimulated::of(material);
            if !what.is_empty() {
                out.warnings.push(ExtractionWarning::NotSimulated { name: thing.name.clone(), what });
            }
            standard::Reader { world, name: &thing.name, material, settings }.read(out)
        }
        None => {
            out.warnings.push(ExtractionWarning::MaterialNotLoaded { name: thing.name.clone() });
            mid_grey(&thing.name)
        }
    };
    let index = add(material, out);
    out.seen.materials.insert(id, index);
    Placed { index, shows_lightmaps: true }
}

/// Bevy's own material on an entity, or one that the game has described.
fn find(world: &World, entity: Entity) -> Option<FoundMaterial> {
    let Some(handle) = world.get::<MeshMaterial3d<StandardMaterial>>(entity) else {
        return find_described(world, entity);
    };
    let material = world.get_resource::<Assets<StandardMaterial>>().and_then(|materials| materials.get(&handle.0));
    Some(FoundMaterial { id: handle.id().untyped(), material: material.cloned() })
}

fn add(material: Material, out: &mut Extraction) -> usize {
    out.scene.materials.push(material);
    out.scene.materials.len() - 1
}

fn mid_grey(name: &str) -> Material {
    Material::diffuse(name, Vec3::splat(MID_GREY))
}

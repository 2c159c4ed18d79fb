//! `StandardMaterial` into materials: its diffuse part and its glow, for now.

use super::{Extraction, ExtractionWarning, Thing, Unsimulated};
use crate::plugin::baking::SceneSettings;
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
    let Some(handle) = world.get::<MeshMaterial3d<StandardMaterial>>(thing.entity) else {
        out.warnings.push(ExtractionWarning::NoStandardMaterial { name: thing.name.clone() });
        return Placed { index: add(mid_grey(&thing.name), out), shows_lightmaps: false };
    };
    if let Some(&index) = out.seen.materials.get(&handle.id()) {
        return Placed { index, shows_lightmaps: true };
    }
    let materials = world.get_resource::<Assets<StandardMaterial>>();
    let material = match materials.and_then(|materials| materials.get(&handle.0)) {
        Some(material) => {
            warn(&thing.name, material, &mut out.warnings);
            read(&thing.name, material, settings)
        }
        None => {
            out.warnings.push(ExtractionWarning::MaterialNotLoaded { name: thing.name.clone() });
            mid_grey(&thing.name)
        }
    };
    let index = add(material, out);
    out.seen.materials.insert(handle.id(), index);
    Placed { index, shows_lightmaps: true }
}

/// Makes one warning of those about specular reflection, which nearly every Bevy material has.
pub(super) fn summarise(warnings: &mut Vec<ExtractionWarning>) {
    let mut count = 0;
    let mut first = None;
    warnings.retain(|warning| match warning {
        ExtractionWarning::Specular { first: name, .. } => {
            count += 1;
            first.get_or_insert_with(|| name.clone());
            false
        }
        _ => true,
    });
    if let Some(first) = first {
        warnings.push(ExtractionWarning::Specular { count, first });
    }
}

fn add(material: Material, out: &mut Extraction) -> usize {
    out.scene.materials.push(material);
    out.scene.materials.len() - 1
}

fn mid_grey(name: &str) -> Material {
    Material::diffuse(name, Vec3::splat(MID_GREY))
}

fn read(name: &str, material: &StandardMaterial, settings: &SceneSettings) -> Material {
    // As pbr_functions.wgsl has it: what the metal and both transmissions leave to diffuse reflection.
    let diffuse_share =
        (1.0 - material.metallic) * (1.0 - material.specular_transmission) * (1.0 - material.diffuse_transmission);
    let emissive = material.emissive.to_vec3();
    Material {
        name: name.to_owned(),
        base_colour: (material.base_color.to_linear().to_vec3() * diffuse_share).extend(1.0),
        emitted_radiance: emissive * settings.emissive.nits(material.emissive_exposure_weight),
        double_sided: material.double_sided,
        ..Material::default()
    }
}

fn warn(name: &str, material: &StandardMaterial, warnings: &mut Vec<ExtractionWarning>) {
    let metallic = material.metallic > 0.0;
    let checks = [
        (material.base_color_texture.is_some(), Unsimulated::BaseColourTexture),
        (material.emissive_texture.is_some(), Unsimulated::EmissiveTexture),
        (metallic, Unsimulated::Metallic),
        (material.normal_map_texture.is_some(), Unsimulated::NormalMap),
        (material.depth_map.is_some(), Unsimulated::DepthMap),
        (material.specular_transmission > 0.0, Unsimulated::SpecularTransmission),
        (material.diffuse_transmission > 0.0, Unsimulated::DiffuseTransmission),
        (material.clearcoat > 0.0, Unsimulated::Clearcoat),
        (material.alpha_mode != AlphaMode::Opaque, Unsimulated::Alpha),
        (material.unlit, Unsimulated::Unlit),
    ];
    let what: Vec<Unsimulated> = checks.into_iter().filter(|(is, _)| *is).map(|(_, what)| what).collect();
    if !what.is_empty() {
        warnings.push(ExtractionWarning::NotSimulated { name: name.to_owned(), what });
    }
    if material.reflectance > 0.0 && !metallic {
        warnings.push(ExtractionWarning::Specular { count: 1, first: name.to_owned() });
    }
}

//! What a `StandardMaterial` asks for and a scene cannot hold.

use super::optional::image;
use crate::plugin::baking::Unsimulated;
use bevy::prelude::*;

/// What of a material is left out, so far as it would be seen.
pub(super) fn of(material: &StandardMaterial) -> Vec<Unsimulated> {
    if material.unlit {
        return Vec::new();
    }
    let dielectric = material.metallic < 1.0 && material.reflectance > 0.0;
    let specular = image(material, "specular_texture").is_some() || image(material, "specular_tint_texture").is_some();
    let coat_relief = image(material, "clearcoat_normal_texture").is_some();
    let checks = [
        (material.depth_map.is_some() && material.parallax_depth_scale != 0.0, Unsimulated::DepthMap),
        (material.anisotropy_strength != 0.0, Unsimulated::Anisotropy),
        (material.clearcoat > 0.0 && coat_relief, Unsimulated::ClearcoatNormalMap),
        (dielectric && specular, Unsimulated::SpecularTextures),
    ];
    checks.into_iter().filter(|(is, _)| *is).map(|(_, what)| what).collect()
}

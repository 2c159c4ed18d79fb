//! Texels that are baked and never seen: Bevy multiplies a lightmap by the diffuse colour, of which metal and what
//! lets all light through have none (`calculate_diffuse_color` in its `pbr_functions.wgsl`). Owns the warning and from where on it is
//! worth one. They are baked all the same, since a game may change its materials.

use super::BakeWarning;
use super::sites::Site;
use crate::scene::{Material, Scattering, Scene};
use crate::trace::Tracer;
use std::collections::BTreeSet;

/// The warning is worth it where more than this share of all texels is concerned. A scene may well have metal and
/// glass; one that is little else was exported without its materials, or without the number that says that they are no
/// metal.
const SHARE: f64 = 0.5;

/// Materials that a warning names.
const NAMED: usize = 3;

/// The warning of texels that nobody will see, if they are many.
pub(super) fn unseen(scene: &Scene, tracer: &Tracer, sites: &[Site]) -> Option<BakeWarning> {
    let mut hidden_by: Vec<Option<usize>> = vec![None; tracer.triangle_count()];
    for receiver in tracer.receivers() {
        let material = scene.instances[receiver.instance].material;
        if !shows_diffuse_light(&scene.materials[material]) {
            let first = receiver.first_triangle as usize;
            hidden_by[first..first + receiver.vertices.len()].fill(Some(material));
        }
    }
    let of_site =
        |site: &Site| site.covered.texel.areas.first().and_then(|&(triangle, _)| hidden_by[triangle as usize]);
    let materials: Vec<usize> = sites.iter().filter_map(of_site).collect();
    let (texels, all) = (materials.len() as u64, sites.len() as u64);
    (texels as f64 > SHARE * all as f64).then(|| {
        let names: BTreeSet<&str> = materials.iter().map(|&material| scene.materials[material].name.as_str()).collect();
        BakeWarning::Unseen { texels, all, materials: few(&names) }
    })
}

/// Whether Bevy may show diffuse light somewhere on a surface. What a texture says is not looked into, and what is not
/// Bevy's is not judged.
fn shows_diffuse_light(material: &Material) -> bool {
    let Scattering::Standard(standard) = &material.scattering else { return true };
    let is_whole = |share: f32, has_texture: bool| share >= 1.0 && !has_texture;
    !is_whole(standard.metallic, standard.metallic_roughness_texture.is_some())
        && !is_whole(standard.specular_transmission, standard.specular_transmission_texture.is_some())
        && !is_whole(standard.diffuse_transmission, standard.diffuse_transmission_texture.is_some())
}

/// A few names in quotes, and how many there are beside them.
fn few(names: &BTreeSet<&str>) -> String {
    let quoted: Vec<String> = names.iter().take(NAMED).map(|name| format!("\"{name}\"")).collect();
    match names.len().saturating_sub(NAMED) {
        0 => quoted.join(", "),
        more => format!("{} and {more} more", quoted.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Standard, TextureRef, UvChannel};
    use glam::Vec3;

    fn standard(standard: Standard) -> Material {
        let scattering = Scattering::Standard(Box::new(standard));
        Material { scattering, ..Material::diffuse("a", Vec3::ONE) }
    }

    #[test]
    fn metal_and_clear_glass_show_nothing_unless_a_texture_may_say_otherwise() {
        let texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv0 });
        let metal = Standard { metallic: 1.0, ..Standard::default() };
        let rusty = Standard { metallic_roughness_texture: texture, ..metal.clone() };
        let glass = Standard { specular_transmission: 1.0, ..Standard::default() };
        let leaf = Standard { diffuse_transmission: 0.9, ..Standard::default() };
        assert!([metal, glass].into_iter().all(|of| !shows_diffuse_light(&standard(of))));
        assert!([rusty, leaf, Standard::default()].into_iter().all(|of| shows_diffuse_light(&standard(of))));
    }

    #[test]
    fn a_few_names_stand_for_many() {
        assert_eq!(few(&BTreeSet::from(["b", "a"])), "\"a\", \"b\"");
        assert_eq!(few(&BTreeSet::from(["a", "b", "c", "d", "e"])), "\"a\", \"b\", \"c\" and 2 more");
    }
}

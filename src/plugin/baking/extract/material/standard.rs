//! One `StandardMaterial`, field by field (bevy_pbr 0.19, pbr_material.rs and render/pbr_fragment.wgsl).

use super::optional;
use crate::plugin::baking::SceneSettings;
use crate::plugin::baking::extract::Extraction;
use crate::plugin::baking::extract::texture::{self, Slot};
use crate::scene::{Alpha, Interior, Material, NormalEncoding, NormalMap, Scattering, Standard, TextureRef, UvChannel};
use bevy::prelude::*;

/// A material that is being read.
pub(super) struct Reader<'a> {
    pub(super) world: &'a World,
    pub(super) name: &'a str,
    pub(super) material: &'a StandardMaterial,
    pub(super) settings: &'a SceneSettings,
}

impl Reader<'_> {
    pub(super) fn read(&self, out: &mut Extraction) -> Material {
        let of = self.material;
        let base = of.base_color.to_linear();
        let base_channel = optional::channel(&of.base_color_channel);
        let plain = Material {
            name: self.name.to_owned(),
            base_colour: base.to_vec3().extend(unit(base.alpha)),
            base_colour_texture: self.place("base colour texture", of.base_color_texture.as_ref(), base_channel, out),
            alpha: alpha(of),
            double_sided: of.double_sided,
            uv_transform: of.uv_transform,
            ..Material::default()
        };
        if of.unlit {
            return self.unlit(plain);
        }
        let emissive_channel = optional::channel(&of.emissive_channel);
        Material {
            emitted_radiance: of.emissive.to_vec3() * self.settings.emissive.nits(of.emissive_exposure_weight),
            emission_texture: self.place("emissive texture", of.emissive_texture.as_ref(), emissive_channel, out),
            normal_map: self.normal_map(out),
            scattering: Scattering::Standard(Box::new(self.standard(out))),
            ..plain
        }
    }

    /// A surface that shows its colour whatever shines on it: it reflects nothing, and what glows on the screen
    /// lights the room. Bevy adds it after the exposure, as it does `emissive` with an exposure weight of 0. One
    /// that multiplies what is behind it does not glow, it is a filter.
    fn unlit(&self, plain: Material) -> Material {
        let plain = Material { scattering: Scattering::None, ..plain };
        if plain.alpha == Alpha::Multiply {
            return plain;
        }
        Material {
            emitted_radiance: plain.base_colour.truncate() * self.settings.emissive.nits(0.0),
            emission_texture: plain.base_colour_texture,
            // Nothing reflects, so that alpha alone counts; the colour may be brighter than any albedo.
            base_colour: Vec3::ZERO.extend(plain.base_colour.w),
            base_colour_texture: plain.base_colour_texture.filter(|_| plain.alpha != Alpha::Opaque),
            ..plain
        }
    }

    fn standard(&self, out: &mut Extraction) -> Standard {
        let of = self.material;
        let metal_channel = optional::channel(&of.metallic_roughness_channel);
        let metal = of.metallic_roughness_texture.as_ref();
        // The shader squares reflectance and tint together, the scene squares reflectance alone.
        let tint = of.specular_tint.to_linear().to_vec3();
        Standard {
            metallic: unit(of.metallic),
            perceptual_roughness: unit(of.perceptual_roughness),
            metallic_roughness_texture: self.place("metallic and roughness texture", metal, metal_channel, out),
            reflectance: unit(of.reflectance),
            specular_tint: units(tint * tint),
            specular_transmission: unit(of.specular_transmission),
            specular_transmission_texture: self.optional(of.specular_transmission, "specular_transmission", out),
            interior: self.interior(),
            ior: of.ior,
            diffuse_transmission: unit(of.diffuse_transmission),
            diffuse_transmission_texture: self.optional(of.diffuse_transmission, "diffuse_transmission", out),
            clearcoat: unit(of.clearcoat),
            clearcoat_texture: self.optional(of.clearcoat, "clearcoat", out),
            clearcoat_perceptual_roughness: unit(of.clearcoat_perceptual_roughness),
            clearcoat_roughness_texture: self.optional(of.clearcoat, "clearcoat_roughness", out),
        }
    }

    fn interior(&self) -> Interior {
        let of = self.material;
        let is_body = of.thickness > 0.0;
        if is_body {
            Interior::Volume {
                attenuation_colour: units(of.attenuation_color.to_linear().to_vec3()),
                attenuation_distance: of.attenuation_distance,
            }
        } else {
            Interior::ThinWalled
        }
    }

    fn normal_map(&self, out: &mut Extraction) -> Option<NormalMap> {
        let of = self.material;
        let handle = of.normal_map_texture.as_ref()?;
        let texture = self.place("normal map", Some(handle), optional::channel(&of.normal_map_channel), out)?;
        let encoding = match (texture::has_two_channels(self.world, handle), of.flip_normal_map_y) {
            (false, false) => NormalEncoding::OpenGl,
            (false, true) => NormalEncoding::DirectX,
            (true, false) => NormalEncoding::TwoChannel,
            (true, true) => NormalEncoding::TwoChannelDirectX,
        };
        Some(NormalMap { texture, encoding })
    }

    /// A picture in a field of any build of Bevy, unless what it multiplies is nothing.
    fn optional(&self, multiplied: f32, field: &'static str, out: &mut Extraction) -> Option<TextureRef> {
        let image = optional::image(self.material, &format!("{field}_texture")).filter(|_| multiplied != 0.0);
        self.place(field, image, optional::uv(self.material, &format!("{field}_channel")), out)
    }

    fn place(
        &self,
        what: &'static str,
        image: Option<&Handle<Image>>,
        uv: UvChannel,
        out: &mut Extraction,
    ) -> Option<TextureRef> {
        texture::place(self.world, Slot { owner: self.name, what, image, uv }, out)
    }
}

fn alpha(material: &StandardMaterial) -> Alpha {
    match material.alpha_mode {
        AlphaMode::Opaque => Alpha::Opaque,
        AlphaMode::Mask(cutoff) => Alpha::Mask { cutoff },
        // The shader sharpens a texture's edge until it is a mask's, at ½.
        AlphaMode::AlphaToCoverage if material.base_color_texture.is_some() => Alpha::Mask { cutoff: 0.5 },
        AlphaMode::Blend | AlphaMode::Premultiplied | AlphaMode::AlphaToCoverage => Alpha::Blend,
        AlphaMode::Multiply => Alpha::Multiply,
        AlphaMode::Add => Alpha::Add,
    }
}

/// Into [0, 1], as a shader's consumers take it; what is no number stays so, to be named.
fn unit(number: f32) -> f32 {
    number.clamp(0.0, 1.0)
}

fn units(colour: Vec3) -> Vec3 {
    Vec3::from_array(colour.to_array().map(unit))
}

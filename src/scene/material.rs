//! What a surface does with light, in physical terms and in the words of glTF and of Bevy's `StandardMaterial`.
//!
//! For light every triangle blocks and reflects from both sides with the same material, whatever the display culls.

use super::texture::TextureRef;
use glam::{Affine2, Vec3, Vec4};

/// A surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name by which a person knows it.
    pub name: String,
    /// Linear colour in [0, 1] and coverage (alpha). What the colour stands for is up to [`Scattering`].
    pub base_colour: Vec4,
    /// Multiplies the base colour, alpha included. The mesh's own colours do too; the product is held to [0, 1], since
    /// a surface brighter than that would make light.
    pub base_colour_texture: Option<TextureRef>,
    /// How arriving light leaves again.
    pub scattering: Scattering,
    /// What alpha means.
    pub alpha: Alpha,
    /// Radiance that the surface gives off [cd/m²].
    pub emitted_radiance: Vec3,
    /// Multiplies the emitted radiance.
    pub emission_texture: Option<TextureRef>,
    /// Whether the back gives off light too. For all else every triangle has the same two sides.
    pub double_sided: bool,
    /// Small relief.
    pub normal_map: Option<NormalMap>,
    /// Maps the mesh's texture coordinates, of either channel, before any lookup.
    pub uv_transform: Affine2,
}

/// How light that arrives leaves again.
#[derive(Clone, Debug, PartialEq)]
pub enum Scattering {
    /// Not at all: everything is absorbed.
    None,
    /// Lambert's ideal diffuse surface, whose albedo is the base colour.
    Diffuse,
    /// Bevy's `StandardMaterial`: a microfacet coat over metal, over glass, or over a diffuse base.
    Standard(Box<Standard>),
    /// A perfect mirror, whose reflectance is the base colour.
    Mirror,
    /// A perfectly smooth interface of glass, whose transmission is tinted by the base colour.
    Refraction {
        /// Index of refraction of the side behind the surface over that before it.
        ior: f32,
    },
    /// The modified Phong model (Lafortune and Willems 1994), whose diffuse albedo is the base colour.
    Phong {
        /// Largest albedo of the glossy lobe; with the base colour at most 1 per channel.
        specular: Vec3,
        /// Exponent of the cosine lobe, at least 0.
        exponent: f32,
    },
}

/// Bevy's `StandardMaterial` as far as light is concerned. Numbers are in [0, 1] if nothing else is said.
#[derive(Clone, Debug, PartialEq)]
pub struct Standard {
    /// How much of the surface is metal, whose reflectance is the base colour.
    pub metallic: f32,
    /// Square root of the microfacet roughness α.
    pub perceptual_roughness: f32,
    /// Blue multiplies `metallic`, green `perceptual_roughness`.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Reflectance of what is no metal: at normal incidence it reflects 0.16 · reflectance².
    pub reflectance: f32,
    /// Tints that reflection.
    pub specular_tint: Vec3,
    /// Share of what is no metal that is clear glass.
    pub specular_transmission: f32,
    /// Red multiplies `specular_transmission`.
    pub specular_transmission_texture: Option<TextureRef>,
    /// What lies behind a clear surface.
    pub interior: Interior,
    /// Index of refraction behind a clear surface over that before it, above 0.
    pub ior: f32,
    /// Share of the diffuse light that leaves on the other side.
    pub diffuse_transmission: f32,
    /// Alpha multiplies `diffuse_transmission`.
    pub diffuse_transmission_texture: Option<TextureRef>,
    /// Strength of a clear coat on top of everything.
    pub clearcoat: f32,
    /// Red multiplies `clearcoat`.
    pub clearcoat_texture: Option<TextureRef>,
    /// Square root of the coat's microfacet roughness.
    pub clearcoat_perceptual_roughness: f32,
    /// Green multiplies `clearcoat_perceptual_roughness`.
    pub clearcoat_roughness_texture: Option<TextureRef>,
}

/// What lies behind a clear surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interior {
    /// Nothing: the surface is a whole pane of no thickness, which light crosses without being bent.
    ThinWalled,
    /// A body that absorbs by Beer and Lambert's law.
    Volume {
        /// What is left of white light after `attenuation_distance`, per channel.
        attenuation_colour: Vec3,
        /// That distance [m]; infinite for a clear body.
        attenuation_distance: f32,
    },
}

/// What a base colour's alpha means for light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Alpha {
    /// Nothing.
    #[default]
    Opaque,
    /// Below the cutoff there is a hole.
    Mask {
        /// The cutoff.
        cutoff: f32,
    },
    /// The share of the surface that is there; the rest lets light pass straight.
    Blend,
    /// Light passes straight, multiplied by 1 − alpha · (1 − colour); nothing is reflected, nothing glows.
    Multiply,
    /// Light passes straight as if nothing were there, and nothing is reflected; of the glow, alpha is added.
    Add,
}

/// Relief as normals in the tangent frame: x along the tangent, y along the bitangent, z along the normal, each
/// stored as ½ + ½·component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalMap {
    /// Where the normals are.
    pub texture: TextureRef,
    /// Where y points and what becomes of z.
    pub encoding: NormalEncoding,
}

/// How a normal map stores its normals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalEncoding {
    /// Three channels, y up, as in glTF.
    #[default]
    OpenGl,
    /// Three channels, y down.
    DirectX,
    /// Two channels, y up; z from unit length.
    TwoChannel,
    /// Two channels, y down; z from unit length.
    TwoChannelDirectX,
}

impl Default for Material {
    /// A black surface.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_colour: Vec4::W,
            base_colour_texture: None,
            scattering: Scattering::Diffuse,
            alpha: Alpha::Opaque,
            emitted_radiance: Vec3::ZERO,
            emission_texture: None,
            double_sided: false,
            normal_map: None,
            uv_transform: Affine2::IDENTITY,
        }
    }
}

impl Material {
    /// A diffuse surface that does not glow.
    pub fn diffuse(name: impl Into<String>, albedo: Vec3) -> Self {
        Self { name: name.into(), base_colour: albedo.extend(1.0), ..Self::default() }
    }

    /// A surface that glows from its front and reflects nothing.
    pub fn emissive(name: impl Into<String>, emitted_radiance: Vec3) -> Self {
        Self { name: name.into(), emitted_radiance, scattering: Scattering::None, ..Self::default() }
    }

    /// A surface that scatters in some way.
    pub fn scattering(name: impl Into<String>, colour: Vec3, scattering: Scattering) -> Self {
        Self { name: name.into(), base_colour: colour.extend(1.0), scattering, ..Self::default() }
    }
}

impl Default for Standard {
    /// Bevy's defaults: half rough, half reflective, neither metal nor glass.
    fn default() -> Self {
        Self {
            metallic: 0.0,
            perceptual_roughness: 0.5,
            metallic_roughness_texture: None,
            reflectance: 0.5,
            specular_tint: Vec3::ONE,
            specular_transmission: 0.0,
            specular_transmission_texture: None,
            interior: Interior::ThinWalled,
            ior: 1.5,
            diffuse_transmission: 0.0,
            diffuse_transmission_texture: None,
            clearcoat: 0.0,
            clearcoat_texture: None,
            clearcoat_perceptual_roughness: 0.5,
            clearcoat_roughness_texture: None,
        }
    }
}

//! The faults of materials and of the textures that they refer to.

use super::emission_fault;
use crate::scene::{Alpha, FaultKind, Interior, Material, Scattering, Scene, Standard, Texels, Texture, TextureRef};
use glam::Vec3;

impl Material {
    /// What keeps this material from being used.
    pub(crate) fn faults(&self) -> Vec<FaultKind> {
        let mut kinds = Vec::new();
        if !(is_share(self.base_colour.truncate()) && (0.0..=1.0).contains(&self.base_colour.w)) {
            kinds.push(FaultKind::ColourOutOfRange);
        }
        kinds.extend(emission_fault(self.emitted_radiance));
        if !self.uv_transform.is_finite() {
            kinds.push(FaultKind::BadUvTransform);
        }
        if let Alpha::Mask { cutoff } = self.alpha {
            kinds.extend(out_of_range("an alpha cutoff", cutoff, 0.0, f32::MAX));
        }
        kinds.extend(self.scattering.faults(self.base_colour.truncate()));
        kinds
    }

    /// Every texture that it refers to.
    pub(crate) fn textures(&self) -> impl Iterator<Item = TextureRef> + '_ {
        let standard = match &self.scattering {
            Scattering::Standard(standard) => Some(standard.textures()),
            _ => None,
        };
        let own = [self.base_colour_texture, self.emission_texture, self.normal_map.map(|map| map.texture)];
        own.into_iter().chain(standard.into_iter().flatten()).flatten()
    }
}

impl Material {
    /// The same, to be changed, in the same order.
    pub(crate) fn textures_mut(&mut self) -> Vec<&mut TextureRef> {
        let standard = match &mut self.scattering {
            Scattering::Standard(standard) => Some(standard.textures_mut()),
            _ => None,
        };
        let normal_map = self.normal_map.as_mut().map(|map| &mut map.texture);
        let own = [self.base_colour_texture.as_mut(), self.emission_texture.as_mut(), normal_map];
        own.into_iter().chain(standard.into_iter().flatten()).flatten().collect()
    }
}

impl Scattering {
    fn faults(&self, base_colour: Vec3) -> Vec<FaultKind> {
        match self {
            Self::None | Self::Diffuse | Self::Mirror => Vec::new(),
            Self::Standard(standard) => standard.faults(),
            Self::Refraction { ior } => out_of_range("an index of refraction", *ior, 0.01, 100.0).into_iter().collect(),
            Self::Phong { specular, exponent } => {
                let too_bright = !is_share(*specular) || (base_colour + *specular).max_element() > 1.0 + 1e-6;
                let exponent = out_of_range("a Phong exponent", *exponent, 0.0, 1e6);
                too_bright.then_some(FaultKind::ColourOutOfRange).into_iter().chain(exponent).collect()
            }
        }
    }
}

impl Standard {
    fn faults(&self) -> Vec<FaultKind> {
        let mut kinds: Vec<FaultKind> = [
            ("a metallic share", self.metallic),
            ("a roughness", self.perceptual_roughness),
            ("a reflectance", self.reflectance),
            ("a specular transmission", self.specular_transmission),
            ("a diffuse transmission", self.diffuse_transmission),
            ("a clear coat", self.clearcoat),
            ("a clear coat's roughness", self.clearcoat_perceptual_roughness),
        ]
        .into_iter()
        .filter_map(|(what, value)| out_of_range(what, value, 0.0, 1.0))
        .collect();
        kinds.extend(out_of_range("an index of refraction", self.ior, 0.01, 100.0));
        if !is_share(self.specular_tint) {
            kinds.push(FaultKind::ColourOutOfRange);
        }
        if let Interior::Volume { attenuation_colour, attenuation_distance } = self.interior {
            if !is_share(attenuation_colour) {
                kinds.push(FaultKind::ColourOutOfRange);
            }
            if attenuation_distance.is_nan() || attenuation_distance <= 0.0 {
                let what = "an attenuation distance";
                kinds.push(FaultKind::OutOfRange { what, value: attenuation_distance, low: 0.0, high: f32::INFINITY });
            }
        }
        kinds
    }

    /// Every texture that it may refer to.
    pub(crate) fn textures(&self) -> [Option<TextureRef>; 5] {
        [
            self.metallic_roughness_texture,
            self.specular_transmission_texture,
            self.diffuse_transmission_texture,
            self.clearcoat_texture,
            self.clearcoat_roughness_texture,
        ]
    }

    fn textures_mut(&mut self) -> [Option<&mut TextureRef>; 5] {
        [
            self.metallic_roughness_texture.as_mut(),
            self.specular_transmission_texture.as_mut(),
            self.diffuse_transmission_texture.as_mut(),
            self.clearcoat_texture.as_mut(),
            self.clearcoat_roughness_texture.as_mut(),
        ]
    }
}

impl Texture {
    /// What keeps this texture from being looked up.
    pub(crate) fn faults(&self) -> Vec<FaultKind> {
        let (width, height, texels) = (self.width, self.height, self.texels.len());
        let expected = u64::from(width) * u64::from(height);
        if expected == 0 || expected != texels as u64 || width.max(height) > 1 << 20 {
            return vec![FaultKind::TexelCount { width, height, texels }];
        }
        if let Texels::Float(texels) = &self.texels
            && let Some(texel) = texels.iter().position(|texel| texel.iter().any(|channel| !channel.is_finite()))
        {
            return vec![FaultKind::NonFiniteTexel { x: texel as u32 % width, y: texel as u32 / width }];
        }
        Vec::new()
    }
}

impl Scene {
    /// The first texture that a material refers to and that is not there.
    pub(super) fn missing_texture(&self, material: &Material) -> Option<FaultKind> {
        let missing = material.textures().find(|reference| reference.texture >= self.textures.len())?;
        Some(FaultKind::MissingTexture { index: missing.texture })
    }
}

fn is_share(colour: Vec3) -> bool {
    colour.is_finite() && colour.min_element() >= 0.0 && colour.max_element() <= 1.0
}

fn out_of_range(what: &'static str, value: f32, low: f32, high: f32) -> Option<FaultKind> {
    (!(low..=high).contains(&value)).then_some(FaultKind::OutOfRange { what, value, low, high })
}

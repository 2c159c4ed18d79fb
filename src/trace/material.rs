//! A material compiled for light transport: what the plan leaves out is taken out of it, so that the kernels never
//! ask. Which is also how the scene's call for effects is told: by what the compiled material still holds.

use super::attributes::Needs;
use super::bsdf::is_perfectly_smooth;
use super::effects::{Effect, EffectSet};
use super::surface::TriangleShape;
use crate::math::Portable;
use crate::scene::{Alpha, Interior, Material, Mesh, NormalMap, Scattering, Standard, TextureRef};
use glam::{Affine2, Vec3, Vec4};

/// What a material is compiled for.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) effects: EffectSet,
    /// Whether a camera looks at it, to which a diffuse surface shows its smooth normals, as its lightmap has them.
    pub(super) has_camera: bool,
}

/// A compiled material.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) base_colour: Vec4,
    pub(super) base_colour_texture: Option<TextureRef>,
    pub(super) scattering: Scattering,
    pub(super) alpha: Alpha,
    /// Radiance that it gives off where its texture is white [cd/m²].
    pub(super) emitted_radiance: Vec3,
    pub(super) emission_texture: Option<TextureRef>,
    pub(super) double_sided: bool,
    pub(super) normal_map: Option<NormalMap>,
    pub(super) uv_transform: Affine2,
    /// Whether light may pass straight.
    pub(super) passes: bool,
    /// Whether it is clear and thin, so that some of what is there lets light pass straight.
    pub(super) is_pane: bool,
    /// How much the body behind it absorbs [1/m]; `None` where there is no body.
    pub(super) body: Option<Vec3>,
}

impl Surface {
    /// What of a material is simulated.
    pub(super) fn new(material: &Material, effects: EffectSet) -> Self {
        let keep = |effect: Effect, texture: Option<TextureRef>| texture.filter(|_| effects.has(effect));
        let alpha = match material.alpha {
            Alpha::Mask { .. } if !effects.has(Effect::CutOuts) => Alpha::Opaque,
            Alpha::Blend | Alpha::Multiply | Alpha::Add if !effects.has(Effect::Transparency) => Alpha::Opaque,
            alpha => alpha,
        };
        let scattering = scattering(material, effects);
        let is_pane = matches!(&scattering, Scattering::Standard(standard)
            if standard.interior == Interior::ThinWalled && standard.specular_transmission > 0.0);
        let emits = effects.has(Effect::AreaLights);
        Self {
            base_colour: material.base_colour,
            base_colour_texture: keep(Effect::Textures, material.base_colour_texture),
            passes: is_pane || alpha != Alpha::Opaque,
            is_pane,
            body: body(&scattering),
            scattering,
            alpha,
            emitted_radiance: if emits { material.emitted_radiance } else { Vec3::ZERO },
            emission_texture: keep(Effect::TexturedEmission, material.emission_texture),
            double_sided: material.double_sided,
            normal_map: material.normal_map.filter(|_| effects.has(Effect::NormalMaps)),
            uv_transform: material.uv_transform,
        }
    }

    /// Whether it gives off light against `direction`, that of a ray that arrives.
    #[inline]
    pub(super) fn shines(&self, shape: &TriangleShape, direction: Vec3) -> bool {
        self.emitted_radiance != Vec3::ZERO && (self.double_sided || shape.normal.dot(direction) < 0.0)
    }

    /// Every texture that it looks up.
    pub(super) fn textures(&self) -> impl Iterator<Item = TextureRef> + '_ {
        let standard = match &self.scattering {
            Scattering::Standard(standard) => Some(standard.textures()),
            _ => None,
        };
        let own = [self.base_colour_texture, self.emission_texture, self.normal_map.map(|map| map.texture)];
        own.into_iter().chain(standard.into_iter().flatten()).flatten()
    }

    /// Whether shading normals change the light that it sends on: a diffuse surface spreads it evenly whatever they
    /// are, and the flat normal then loses none.
    pub(super) fn is_shaded(&self) -> bool {
        !matches!(self.scattering, Scattering::None | Scattering::Diffuse) || self.normal_map.is_some()
    }

    /// What it needs of the vertices of a mesh.
    pub(super) fn needs(&self, mesh: &Mesh, view: View) -> Needs {
        let View { effects, has_camera } = view;
        let needs = Needs {
            colours: mesh.colours.is_some() && effects.has(Effect::Textures),
            normals: (has_camera || self.is_shaded()) && mesh.normals.is_some(),
            tangents: self.normal_map.map(|map| map.texture.uv),
            ..Needs::default()
        };
        self.textures().fold(needs, |needs, texture| needs.coordinates(texture.uv))
    }
}

/// What of a material's scattering is simulated.
fn scattering(material: &Material, effects: EffectSet) -> Scattering {
    match &material.scattering {
        Scattering::Standard(standard) => standard_scattering(standard, effects),
        Scattering::Mirror | Scattering::Phong { .. } if !effects.has(Effect::SpecularReflection) => {
            Scattering::Diffuse
        }
        Scattering::Refraction { .. } if !effects.has(Effect::Refraction) => Scattering::Diffuse,
        Scattering::Phong { specular: Vec3::ZERO, .. } => Scattering::Diffuse,
        other => other.clone(),
    }
}

fn standard_scattering(standard: &Standard, effects: EffectSet) -> Scattering {
    let keep = |effect: Effect, texture: Option<TextureRef>| texture.filter(|_| effects.has(effect));
    let share = |effect: Effect, share: f32| if effects.has(effect) { share } else { 0.0 };
    let clear = match standard.interior {
        Interior::ThinWalled => Effect::ClearPanes,
        Interior::Volume { .. } => Effect::Refraction,
    };
    let mut kept = Standard {
        metallic_roughness_texture: keep(Effect::Textures, standard.metallic_roughness_texture),
        specular_transmission: share(clear, standard.specular_transmission),
        specular_transmission_texture: keep(Effect::Textures, standard.specular_transmission_texture),
        diffuse_transmission: share(Effect::DiffuseTransmission, standard.diffuse_transmission),
        diffuse_transmission_texture: keep(Effect::Textures, standard.diffuse_transmission_texture),
        clearcoat: share(Effect::Clearcoat, standard.clearcoat),
        clearcoat_texture: keep(Effect::Textures, standard.clearcoat_texture),
        clearcoat_roughness_texture: keep(Effect::Textures, standard.clearcoat_roughness_texture),
        ..standard.clone()
    };
    if !effects.has(Effect::SpecularReflection) {
        // Without gloss a metal is a diffuse surface of its own colour, not a black one.
        kept.metallic = 0.0;
        kept.reflectance = 0.0;
    }
    let is_glossy = kept.metallic > 0.0 || (kept.reflectance > 0.0 && kept.specular_tint != Vec3::ZERO);
    let is_lambertian =
        !is_glossy && kept.specular_transmission == 0.0 && kept.diffuse_transmission == 0.0 && kept.clearcoat == 0.0;
    if is_lambertian { Scattering::Diffuse } else { Scattering::Standard(Box::new(kept)) }
}

fn body(scattering: &Scattering) -> Option<Vec3> {
    match scattering {
        Scattering::Refraction { .. } => Some(Vec3::ZERO),
        Scattering::Standard(standard) if standard.specular_transmission > 0.0 => match standard.interior {
            Interior::ThinWalled => None,
            Interior::Volume { attenuation_colour, attenuation_distance } => {
                Some(absorption(attenuation_colour, attenuation_distance))
            }
        },
        _ => None,
    }
}

/// Beer and Lambert's coefficient of what leaves `colour` of white light after `distance` [1/m].
fn absorption(colour: Vec3, distance: f32) -> Vec3 {
    // The smallest number that has a logarithm stands for black, so that nothing is 0 · ∞.
    let depth = -Vec3::from_array(colour.to_array().map(|channel| Portable::ln(channel.max(f32::MIN_POSITIVE))));
    (depth / distance).max(Vec3::ZERO)
}

/// Whether a material mirrors or bends much of the light in single directions, which no light sample finds.
pub(super) fn is_smooth(material: &Material) -> bool {
    match &material.scattering {
        Scattering::Mirror | Scattering::Refraction { .. } => true,
        Scattering::Standard(standard) => {
            let is_body = standard.specular_transmission > 0.0 && standard.interior != Interior::ThinWalled;
            is_perfectly_smooth(standard.perceptual_roughness) && (is_body || standard.metallic > 0.5)
        }
        Scattering::None | Scattering::Diffuse | Scattering::Phong { .. } => false,
    }
}

/// The effects that a material on a mesh calls for, light sources aside.
pub(super) fn called_by(material: &Material, mesh: &Mesh) -> EffectSet {
    let everything: EffectSet = Effect::ALL.into_iter().collect();
    let surface = Surface::new(material, everything);
    let has_colours = mesh.colours.is_some();
    let is_textured = surface.base_colour_texture.is_some() || has_colours;
    let glows = surface.emitted_radiance != Vec3::ZERO;
    let mut calls = EffectSet::NONE;
    let mut call = |effect, is_called| {
        if is_called {
            calls = calls.with(effect);
        }
    };
    let standard = match &surface.scattering {
        Scattering::Standard(standard) => Some(standard.as_ref()),
        _ => None,
    };
    let standard_has = |has: fn(&Standard) -> bool| standard.is_some_and(has);
    let uses_maps = standard.is_some_and(|standard| standard.textures().into_iter().any(|map| map.is_some()));
    let has_looks = surface.scattering != Scattering::None || surface.alpha != Alpha::Opaque;
    call(Effect::AreaLights, glows);
    call(Effect::Textures, has_looks && is_textured || uses_maps);
    call(Effect::TexturedEmission, glows && surface.emission_texture.is_some());
    call(Effect::NormalMaps, surface.normal_map.is_some());
    call(
        Effect::SpecularReflection,
        matches!(surface.scattering, Scattering::Mirror | Scattering::Phong { .. })
            || standard_has(|s| s.metallic > 0.0 || s.reflectance > 0.0 && s.specular_tint != Vec3::ZERO),
    );
    call(Effect::Clearcoat, standard_has(|s| s.clearcoat > 0.0));
    call(Effect::Refraction, surface.body.is_some());
    let is_thin = |s: &Standard| s.specular_transmission > 0.0 && s.interior == Interior::ThinWalled;
    call(Effect::ClearPanes, standard_has(is_thin));
    call(Effect::DiffuseTransmission, standard_has(|s| s.diffuse_transmission > 0.0));
    let opacity = material.base_colour.w;
    match material.alpha {
        Alpha::Opaque => {}
        Alpha::Mask { cutoff } => call(Effect::CutOuts, opacity < cutoff || is_textured),
        Alpha::Blend => call(Effect::Transparency, opacity < 1.0 || is_textured),
        Alpha::Multiply | Alpha::Add => call(Effect::Transparency, true),
    }
    calls
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::UvChannel;

    fn calls(material: &Material) -> Vec<Effect> {
        called_by(material, &Mesh::default()).iter().collect()
    }

    fn standard(standard: Standard) -> Material {
        Material::scattering("s", Vec3::splat(0.5), Scattering::Standard(Box::new(standard)))
    }

    #[test]
    fn a_material_calls_for_what_it_has() {
        let map = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
        assert_eq!(calls(&Material::diffuse("d", Vec3::ONE)), []);
        assert_eq!(calls(&standard(Standard { reflectance: 0.0, ..Standard::default() })), []);
        assert_eq!(calls(&standard(Standard::default())), [Effect::SpecularReflection]);
        assert_eq!(calls(&Material::emissive("e", Vec3::X)), [Effect::AreaLights]);
        let glass = Standard { specular_transmission: 1.0, reflectance: 0.0, ..Standard::default() };
        assert_eq!(calls(&standard(glass.clone())), [Effect::ClearPanes]);
        let interior = Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: f32::INFINITY };
        assert_eq!(calls(&standard(Standard { interior, ..glass })), [Effect::Refraction]);
        let masked = Material { alpha: Alpha::Mask { cutoff: 0.5 }, ..Material::diffuse("leaf", Vec3::ONE) };
        assert_eq!(calls(&masked), []);
        let cut = Material { base_colour_texture: map, ..masked };
        assert_eq!(calls(&cut), [Effect::Textures, Effect::CutOuts]);
        assert_eq!(calls(&Material { alpha: Alpha::Blend, ..cut.clone() }), [Effect::Textures, Effect::Transparency]);
        let painted = Mesh { colours: Some(vec![]), ..Mesh::default() };
        assert_eq!(called_by(&Material::diffuse("d", Vec3::ONE), &painted), EffectSet::NONE.with(Effect::Textures));
    }

    #[test]
    fn what_is_off_is_taken_out() {
        let metal = standard(Standard { metallic: 1.0, ..Standard::default() });
        let surface = Surface::new(&metal, EffectSet::NONE);
        assert_eq!(surface.scattering, Scattering::Diffuse);
        let map = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
        let cut = Material {
            alpha: Alpha::Mask { cutoff: 0.5 },
            base_colour_texture: map,
            ..Material::diffuse("l", Vec3::ONE)
        };
        let effects = EffectSet::NONE.with(Effect::Textures);
        let surface = Surface::new(&cut, effects);
        assert!(!surface.passes && surface.base_colour_texture == map);
        assert!(surface.needs(&Mesh::default(), View { effects, has_camera: false }).uv1);
        assert!(Surface::new(&cut, EffectSet::NONE).textures().next().is_none());
    }

    #[test]
    fn absorption_leaves_the_colour_after_the_distance() {
        let colour = Vec3::new(0.5, 0.1, 1.0);
        let sigma = absorption(colour, 3.0);
        assert!(((-sigma * 3.0).exp() - colour).length() < 1e-6, "{sigma}");
        assert_eq!(absorption(colour, f32::INFINITY), Vec3::ZERO);
        assert!(absorption(Vec3::ZERO, 1e-6).is_finite());
    }
}

//! The Cornell box, changed so that it calls for one effect more.

use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{
    Alpha, DirectionalLight, EnvironmentMap, Filter, Interior, Light, Material, NormalEncoding, NormalMap, PointLight,
    Scattering, Scene, Standard, Texels, Texture, TextureRef, UvChannel, Wrap,
};
use bevy_kiln::trace::Effect;
use glam::{Quat, Vec3};

/// The box for each effect that it does not call for by itself.
pub fn changed(cornell: &Scene) -> Vec<(&'static str, Scene)> {
    let change = |effect: Effect| {
        let mut scene = cornell.clone();
        apply(effect, &mut scene).then(|| (effect.name(), scene))
    };
    Effect::ALL.into_iter().filter_map(change).collect()
}

/// Whether the box had to be changed.
fn apply(effect: Effect, scene: &mut Scene) -> bool {
    match effect {
        Effect::AreaLights | Effect::Interreflection => return false,
        Effect::PointLights => scene.lights.push(Light::Point(PointLight {
            id: StableId::new("bulb"),
            name: "bulb".into(),
            position: Vec3::new(0.3, 0.6, 0.4),
            intensity: Vec3::splat(0.2),
            radius: 0.02,
            range: None,
        })),
        Effect::DirectionalLights => scene.lights.push(Light::Directional(DirectionalLight {
            id: StableId::new("sun"),
            name: "sun".into(),
            direction: Vec3::new(0.3, -0.4, -1.0).normalize(),
            illuminance: Vec3::splat(2.0),
            angular_diameter: 0.0093,
        })),
        Effect::ConstantSky => scene.sky_radiance = Vec3::splat(0.5),
        Effect::EnvironmentMap => scene.environment = Some(sky()),
        Effect::Textures => paint(scene, |material, picture| material.base_colour_texture = Some(picture)),
        Effect::TexturedEmission => paint(scene, |material, picture| material.emission_texture = Some(picture)),
        Effect::NormalMaps => paint(scene, |material, picture| {
            material.normal_map = Some(NormalMap { texture: picture, encoding: NormalEncoding::OpenGl });
        }),
        Effect::SpecularReflection => make(scene, &Standard::default()),
        Effect::Clearcoat => make(scene, &Standard { reflectance: 0.0, clearcoat: 1.0, ..Standard::default() }),
        Effect::Refraction => {
            make(scene, &glass(Interior::Volume { attenuation_colour: Vec3::splat(0.9), attenuation_distance: 1.0 }))
        }
        Effect::ClearPanes => make(scene, &glass(Interior::ThinWalled)),
        Effect::DiffuseTransmission => {
            make(scene, &Standard { reflectance: 0.0, diffuse_transmission: 0.5, ..Standard::default() });
        }
        Effect::CutOuts => paint(scene, |material, picture| {
            material.base_colour_texture = Some(picture);
            material.alpha = Alpha::Mask { cutoff: 0.5 };
        }),
        Effect::Transparency => walls(scene).for_each(|material| {
            material.alpha = Alpha::Blend;
            material.base_colour.w = 0.5;
        }),
        _ => return false,
    }
    true
}

/// Every material that does not glow.
fn walls(scene: &mut Scene) -> impl Iterator<Item = &mut Material> {
    scene.materials.iter_mut().filter(|material| material.emitted_radiance == Vec3::ZERO)
}

fn make(scene: &mut Scene, standard: &Standard) {
    for material in walls(scene) {
        material.scattering = Scattering::Standard(Box::new(standard.clone()));
    }
}

fn glass(interior: Interior) -> Standard {
    // Half of it, so that walls still gather light.
    Standard { specular_transmission: 0.5, perceptual_roughness: 0.0, interior, ..Standard::default() }
}

/// Puts a picture on every material; alpha 1 and 0 in stripes, normals about straight.
fn paint(scene: &mut Scene, use_it: impl Fn(&mut Material, TextureRef)) {
    let texel =
        |i: u32| [118 + (i * 7 % 20) as u8, 118 + (i * 3 % 20) as u8, 250, if i.is_multiple_of(4) { 255 } else { 0 }];
    scene.textures = vec![Texture {
        name: "stripes".into(),
        width: 64,
        height: 64,
        texels: Texels::Linear8((0..64 * 64).map(texel).collect()),
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Linear,
    }];
    for material in &mut scene.materials {
        use_it(material, TextureRef { texture: 0, uv: UvChannel::Uv1 });
    }
}

/// A sky with a bright patch.
fn sky() -> EnvironmentMap {
    let (width, height) = (256, 128);
    let bright = |pixel: u32| if (pixel / width, pixel % width) == (50, 190) { 200.0 } else { 0.3 };
    EnvironmentMap {
        name: "sky".into(),
        width,
        height,
        radiance: (0..width * height).map(|pixel| Vec3::splat(bright(pixel))).collect(),
        world_from_map: Quat::IDENTITY,
    }
}

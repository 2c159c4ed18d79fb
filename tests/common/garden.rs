//! A scene that calls for something of nearly every effect.

use super::scenes::{SceneBuilder, glowing};
use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{
    Alpha, DirectionalLight, EnvironmentMap, Filter, Interior, Light, Material, NormalEncoding, NormalMap, PointLight,
    Scattering, Scene, Standard, Texels, Texture, TextureRef, UvChannel, Wrap,
};
use glam::{Quat, Vec3, Vec4};

/// A scene with something of nearly everything.
pub fn garden() -> Scene {
    let texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
    let standard = |standard: Standard| Scattering::Standard(Box::new(standard));
    let leaves = Material {
        alpha: Alpha::Mask { cutoff: 0.5 },
        base_colour_texture: texture,
        ..Material::scattering(
            "leaves",
            Vec3::ONE,
            standard(Standard { diffuse_transmission: 0.4, ..Standard::default() }),
        )
    };
    let path = Material {
        normal_map: texture.map(|texture| NormalMap { texture, encoding: NormalEncoding::OpenGl }),
        ..Material::diffuse("path", Vec3::splat(0.4))
    };
    let interior = Interior::Volume { attenuation_colour: Vec3::new(0.7, 0.9, 1.0), attenuation_distance: 1.0 };
    let pond = Standard { specular_transmission: 1.0, ior: 1.33, interior, ..Standard::default() };
    let sign = Material { emission_texture: texture, ..glowing(0.2, 5.0) };
    let car = Standard { clearcoat: 1.0, metallic: 0.5, ..Standard::default() };
    let mist = Material { alpha: Alpha::Blend, base_colour: Vec4::splat(0.5), ..Material::default() };
    let materials = [
        leaves,
        path,
        Material::scattering("pond", Vec3::ONE, standard(pond)),
        sign,
        Material::scattering("car", Vec3::X, standard(car)),
        mist,
    ];
    let mut builder = SceneBuilder::default();
    for (index, material) in materials.iter().enumerate() {
        let corner = Vec3::new(2.0 * index as f32, 0.0, 0.0);
        let plain =
            Material { base_colour_texture: None, emission_texture: None, normal_map: None, ..material.clone() };
        builder = builder.quad(&format!("thing {index}"), corner, [Vec3::Z, Vec3::X], plain);
    }
    let mut scene = builder.build();
    scene.materials = materials.to_vec();
    scene.textures.push(Texture {
        name: "picture".into(),
        width: 1,
        height: 1,
        texels: Texels::Srgb8([[128, 128, 255, 255]].into()),
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Linear,
    });
    let bulb = |name: &str, radius: f32| PointLight {
        id: StableId::new(name),
        name: name.into(),
        position: Vec3::new(1.0, 2.0, 0.0),
        intensity: Vec3::splat(10.0),
        radius,
        range: None,
    };
    scene.lights = vec![
        Light::Point(bulb("lantern", 0.05)),
        Light::Point(bulb("spark", 0.0)),
        Light::Directional(DirectionalLight {
            id: StableId::new("sun"),
            name: "sun".into(),
            direction: Vec3::NEG_Y,
            illuminance: Vec3::splat(50_000.0),
            angular_diameter: 0.0093,
        }),
    ];
    scene.environment = Some(EnvironmentMap {
        name: "sky".into(),
        width: 4,
        height: 2,
        radiance: vec![Vec3::new(0.3, 0.6, 1.0); 8].into(),
        world_from_map: Quat::IDENTITY,
    });
    assert_eq!(scene.validate(), []);
    scene
}

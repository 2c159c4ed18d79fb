//! Glass, metal and a sky: a scene whose light goes through nearly every formula that has a sine, a power or a
//! logarithm in it. Its own numbers come from sums, products and quotients only, which are the same on every machine.

use crate::common::scenes::{SceneBuilder, grey};
use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{
    DirectionalLight, EnvironmentMap, Filter, Interior, Light, Material, NormalEncoding, NormalMap, PointLight,
    Scattering, Scene, SpotLight, Standard, Texels, Texture, TextureRef, UvChannel, Wrap,
};
use glam::{Quat, Vec2, Vec3};

/// A floor with relief, a wall of each kind of gloss, a block of green glass, five lamps and a sky.
pub fn vitrine() -> Scene {
    let standard = |standard: Standard| Scattering::Standard(Box::new(standard));
    let interior = Interior::Volume { attenuation_colour: Vec3::new(0.3, 0.9, 0.5), attenuation_distance: 0.4 };
    let glass = Standard { specular_transmission: 1.0, perceptual_roughness: 0.3, interior, ..Standard::default() };
    let metal = Standard { metallic: 1.0, perceptual_roughness: 0.4, ..Standard::default() };
    let paint = Standard { clearcoat: 0.8, clearcoat_perceptual_roughness: 0.2, ..Standard::default() };
    let phong = Scattering::Phong { specular: Vec3::splat(0.4), exponent: 17.0 };
    let picture = TextureRef { texture: 0, uv: UvChannel::Uv1 };
    let relief = NormalMap { texture: TextureRef { texture: 1, uv: UvChannel::Uv1 }, encoding: NormalEncoding::OpenGl };
    let floor =
        Material { base_colour_texture: Some(picture), normal_map: Some(relief), ..Material::diffuse("", Vec3::ONE) };
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|corner| 0.6 * corner + Vec3::new(-0.3, 0.1, -0.3));
    let outwards = vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
    let wall = |builder: SceneBuilder, name: &str, corner: Vec3, edges: [Vec3; 2], scattering: Scattering| {
        builder.quad(name, corner, edges, Material::scattering(name, Vec3::new(0.5, 0.4, 0.3), scattering))
    };
    let builder = SceneBuilder::default()
        .quad("floor", Vec3::new(-1.0, 0.0, -1.0), [2.0 * Vec3::Z, 2.0 * Vec3::X], grey(0.5))
        .mesh("glass", corners.to_vec(), outwards, None, Material::scattering("glass", Vec3::ONE, standard(glass)));
    let builder = wall(builder, "metal", Vec3::NEG_ONE, [2.0 * Vec3::Y, 2.0 * Vec3::Z], standard(metal));
    let builder = wall(builder, "paint", Vec3::new(1.0, 0.0, -1.0), [Vec3::Z, Vec3::Y], standard(paint));
    let builder = wall(builder, "phong", Vec3::new(-1.0, 0.0, -1.0), [Vec3::X, Vec3::Y], phong);
    let builder = wall(builder, "mirror", Vec3::new(0.0, 0.0, -1.0), [Vec3::X, Vec3::Y], Scattering::Mirror);
    let lamp = Vec3::new(0.0, 1.4, 0.2);
    let mut scene = builder.rect_light("panel", lamp, Vec3::NEG_Y, Vec2::new(0.3, 0.2), Vec3::splat(20.0)).build();
    scene.textures = vec![texture(40), texture(7)];
    scene.materials[0] = floor;
    // So that the relief gets its tangents by the algorithm.
    scene.meshes[0].normals = Some(vec![Vec3::Y; 4]);
    scene.lights.extend(lamps());
    scene.environment = Some(sky());
    assert_eq!(scene.validate(), []);
    scene
}

fn lamps() -> [Light; 4] {
    let bulb = |name: &str, position: Vec3, radius: f32| PointLight {
        id: StableId::new(name),
        name: name.into(),
        position,
        intensity: Vec3::new(3.0, 2.0, 1.0),
        radius,
        range: Some(6.0),
    };
    let spot = SpotLight {
        bulb: bulb("spot", Vec3::new(0.5, 1.2, 0.5), 0.0),
        direction: Vec3::new(-0.48, -0.6, -0.64),
        inner_angle: 0.3,
        outer_angle: 0.7,
    };
    let sun = DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction: Vec3::new(0.36, -0.8, 0.48),
        illuminance: Vec3::splat(2.0),
        angular_diameter: 0.05,
    };
    let (direction, illuminance) = (Vec3::new(-0.48, -0.8, 0.36), Vec3::new(0.1, 0.2, 0.4));
    let moon =
        DirectionalLight { id: StableId::new("moon"), name: "moon".into(), direction, illuminance, ..sun.clone() };
    let ball = bulb("ball", Vec3::new(-0.5, 0.8, 0.6), 0.1);
    [Light::Point(ball), Light::Spot(spot), Light::Directional(sun), Light::Directional(moon)]
}

fn sky() -> EnvironmentMap {
    let pixel = |index: u32| {
        let step = (index * 37 % 101) as f32 / 101.0;
        Vec3::new(step, 0.5 + 0.5 * step * step, 1.0 - 0.3 * step)
    };
    EnvironmentMap {
        name: "sky".into(),
        width: 16,
        height: 8,
        radiance: (0..128).map(pixel).collect::<Vec<_>>().into(),
        world_from_map: Quat::from_xyzw(0.0, 0.6, 0.0, 0.8),
    }
}

fn texture(step: u32) -> Texture {
    let byte = |index: u32| (96 + index * step * 13 % 97) as u8;
    let texels = (0..16).map(|index| [byte(3 * index), byte(3 * index + 1), 200 + byte(index) / 8, 255]);
    Texture {
        name: format!("texture {step}"),
        width: 4,
        height: 4,
        texels: if step > 10 { Texels::Srgb8(texels.collect()) } else { Texels::Linear8(texels.collect()) },
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Linear,
    }
}

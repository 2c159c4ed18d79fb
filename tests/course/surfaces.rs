//! Normal maps against their closed form, mirrors and glass that vanish in a furnace, a caustic.

use crate::common::meter::{at, read};
use crate::common::statistics::mean_within;
use crate::film::{Shot, mean_luminance};
use crate::scenes::{caustic, glass, grey};
use crate::stage::Stage;
use bevy_kiln::artefact::StableId;
use bevy_kiln::math::luminance;
use bevy_kiln::scene::{
    Camera, DirectionalLight, Filter, Indices, Light, Material, Mesh, NormalEncoding, NormalMap, Scattering, Scene,
    Standard, Texels, Texture, TextureRef, UvChannel, Wrap,
};
use bevy_kiln::trace::Transport;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

const ALBEDO: f32 = 0.8;
const TO_SUN: Vec3 = Vec3::new(-0.48, 0.6, 0.64);

/// A square that faces +Z, all of one mapped normal, with this tangent at each vertex.
fn mapped_square(local_normal: Vec3, tangent: Vec3, sign: f32) -> Scene {
    let mesh = Mesh {
        indices: Indices::U16(vec![0, 1, 2, 0, 2, 3]),
        positions: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        normals: Some(vec![Vec3::Z; 4]),
        uv0: Some(vec![Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO]),
        tangents: Some(vec![tangent.extend(sign); 4]),
        ..Mesh::default()
    };
    let texel = (local_normal * 0.5 + 0.5).extend(1.0).to_array();
    let texture = Texture {
        name: "one normal".into(),
        width: 1,
        height: 1,
        texels: Texels::Float([texel].into()),
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Linear,
    };
    let texture_ref = TextureRef { texture: 0, uv: UvChannel::Uv0 };
    let map = NormalMap { texture: texture_ref, encoding: NormalEncoding::OpenGl };
    let sun = DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction: -TO_SUN,
        illuminance: Vec3::ONE,
        angular_diameter: 0.0,
    };
    Stage::default()
        .texture(texture)
        .mesh("wall", mesh, Material { normal_map: Some(map), ..grey(ALBEDO) })
        .light(Light::Directional(sun))
        .build()
}

/// Mean radiance of what fills a narrow view of the origin, and its standard error.
fn seen(scene: &Scene, samples: u32) -> (f64, f64) {
    let camera = Camera::look_at("eye", Vec3::Z * 5.0, Vec3::ZERO, 0.1);
    let picture = Shot { scene, camera: &camera, size: [8; 2], samples }.take();
    let squares: f64 = picture.stderr.iter().map(|&error| luminance(error).powi(2)).sum();
    (mean_luminance(&picture), squares.sqrt() / picture.stderr.len() as f64)
}

/// A tangent that leans out of the surface and is not of unit length: Gram and Schmidt's step straightens it.
#[test]
fn a_normal_map_is_turned_into_the_world_by_its_tangents() {
    let local = Vec3::new(0.48, 0.36, 0.8);
    for angle in [0.0_f32, 1.0, 2.5, 4.0] {
        let tangent = Vec3::new(angle.cos(), angle.sin(), 0.0);
        for sign in [1.0, -1.0] {
            let bitangent = sign * Vec3::Z.cross(tangent);
            let normal = tangent * local.x + bitangent * local.y + Vec3::Z * local.z;
            let truth = f64::from(ALBEDO / PI * normal.dot(TO_SUN).max(0.0));
            let (radiance, _) = seen(&mapped_square(local, (tangent + Vec3::Z * 0.7) * 1.3, sign), 16);
            assert!((radiance - truth).abs() < 1e-4, "{angle} {sign}: {radiance} for {truth}");
            let (other, _) = seen(&mapped_square(local, tangent, -sign), 16);
            assert!((other - truth).abs() > 0.01, "{angle}: the bitangent's sign went unseen");
        }
    }
}

/// A sphere of some material under a sky of radiance 1.
fn under_a_sky(material: Material) -> Scene {
    Stage::default().sky(1.0).sphere("ball", Vec3::ZERO, 1.0, material).build()
}

#[test]
fn what_absorbs_nothing_vanishes_under_an_even_sky() {
    let white = [glass(), Material::scattering("mirror", Vec3::ONE, Scattering::Mirror), grey(1.0)];
    for material in white {
        let name = material.name.clone();
        let (radiance, error) = seen(&under_a_sky(material), 256);
        mean_within(radiance, error, 1.0, 5e-3).unwrap_or_else(|reason| panic!("{name}: {reason}"));
    }
    let dim = Material::scattering("dim mirror", Vec3::splat(0.9), Scattering::Mirror);
    let (radiance, error) = seen(&under_a_sky(dim), 256);
    mean_within(radiance, error, 1.0, 5e-3).expect_err("a tenth of the light went unseen");
}

#[test]
fn gloss_takes_no_more_than_arrives() {
    let phong = Scattering::Phong { specular: Vec3::splat(0.4), exponent: 60.0 };
    let gold = Standard { metallic: 1.0, perceptual_roughness: 0.45, ..Standard::default() };
    let cases = [
        (Material::scattering("phong", Vec3::splat(0.3), phong), 0.6..0.7),
        (Material::scattering("metal", Vec3::splat(0.9), Scattering::Standard(Box::new(gold))), 0.8..1.0),
    ];
    for (material, range) in cases {
        let name = material.name.clone();
        let (radiance, error) = seen(&under_a_sky(material), 256);
        assert!(range.contains(&radiance) && error < 0.01, "{name}: {radiance} ± {error}");
    }
}

#[test]
fn a_ball_of_glass_gathers_light_behind_it() {
    // Where the line from the lamp through the ball's middle meets the floor, and beside it in the ball's shadow.
    let points = [at(Vec3::new(0.57, 0.0, 0.0), Vec3::Y), at(Vec3::new(0.57, 0.0, 0.42), Vec3::Y)];
    let direct = Transport { max_bounces: Some(8), ..Transport::default() };
    let with = read(&caustic(Some(glass())), &points, 1 << 14, direct);
    let without = read(&caustic(None), &points, 1 << 12, direct);
    let [focus, shadow] = [0, 1].map(|index: usize| with[index].irradiance.y / without[index].irradiance.y);
    assert!(with[0].stderr.y < 0.05 * with[0].irradiance.y, "too noisy: {:?}", with[0]);
    assert!(focus > 3.0 && shadow < 0.7, "focus {focus}, shadow {shadow}");
}

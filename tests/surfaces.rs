//! What surfaces do to light, seen from outside: mirrors and glass against images and Fresnel's equations, bodies that
//! absorb against an integral, lossless things in furnaces, pictures on surfaces, normal maps.

mod common;

use bevy_kiln::bake::{CancelToken, PictureSettings, render_picture};
use bevy_kiln::math::polygon_irradiance;
use bevy_kiln::scene::{
    Camera, EnvironmentMap, Filter, Interior, Material, NormalEncoding, NormalMap, Scattering, Standard, Texels,
    Texture, TextureRef, UvChannel, Wrap,
};
use bevy_kiln::trace::{Estimator, Transport};
use common::fresnel::fresnel;
use common::meter::{at, by, mean, on_walls, read};
use common::scenes::{SceneBuilder, glowing, grey};
use common::statistics::mean_within;
use glam::{DVec3, Quat, Vec2, Vec3, Vec4};
use std::f64::consts::{FRAC_PI_2, PI};

const ESTIMATORS: [Estimator; 3] = [Estimator::Mis, Estimator::Light, Estimator::Bsdf];

fn of(scattering: Scattering) -> Material {
    Material::scattering("thing", Vec3::ONE, scattering)
}

fn standard(standard: Standard) -> Scattering {
    Scattering::Standard(Box::new(standard))
}

/// Integral of a smooth function over [0, 1] by the midpoint rule.
fn integrate(f: impl Fn(f64) -> f64) -> f64 {
    let steps = 100_000;
    (0..steps).map(|i| f((f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps)
}

/// A wall that is a perfect mirror shows the lamp a second time, as far behind it: light by a path E D S L.
#[test]
fn a_mirror_doubles_the_lamp() {
    let lamp =
        [Vec3::new(1.0, 2.0, -0.5), Vec3::new(2.0, 2.0, -0.5), Vec3::new(2.0, 2.0, 0.5), Vec3::new(1.0, 2.0, 0.5)];
    let wall = [Vec3::Y * 200.0, Vec3::Z * 200.0];
    let scene = SceneBuilder::default()
        .quad("lamp", lamp[0], [lamp[1] - lamp[0], lamp[3] - lamp[0]], glowing(0.0, 1.0))
        .quad("mirror", Vec3::new(0.0, -100.0, -100.0), wall, of(Scattering::Mirror))
        .build();
    let image = lamp.map(|corner| Vec3::new(-corner.x, corner.y, corner.z));
    let point = Vec3::new(0.7, 0.0, 0.2);
    let seen =
        |corners: [Vec3; 4]| polygon_irradiance(&corners.map(|corner| (corner - point).as_dvec3()), DVec3::Y).abs();
    let truth = seen(lamp) + seen(image);
    for estimator in ESTIMATORS {
        let reading = read(&scene, &[at(point, Vec3::Y)], 1 << 17, by(estimator))[0];
        mean_within(reading.irradiance.x, reading.stderr.x, truth, 0.02 * truth)
            .unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
    }
}

/// Under a still surface of glass or water the light of the whole sky is gathered within the critical angle; the
/// surface lets through what it does not reflect: E = π·L·(1 − F̄).
#[test]
fn under_water() {
    let water = standard(Standard {
        specular_transmission: 1.0,
        perceptual_roughness: 0.0,
        ior: 1.5,
        interior: Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: f32::INFINITY },
        ..Standard::default()
    });
    for scattering in [Scattering::Refraction { ior: 1.5 }, water] {
        let mut scene = SceneBuilder::default()
            .quad("water", Vec3::new(-200.0, 0.0, -200.0), [400.0 * Vec3::Z, 400.0 * Vec3::X], of(scattering))
            .quad("ground", Vec3::new(-200.0, -0.5, -200.0), [400.0 * Vec3::Z, 400.0 * Vec3::X], grey(0.0))
            .build();
        scene.sky_radiance = Vec3::ONE;
        let reflected = integrate(|cosine| 2.0 * cosine * fresnel(cosine, 1.5));
        assert!((reflected - 0.0918).abs() < 1e-4, "{reflected}");
        let reading = read(&scene, &[at(Vec3::new(0.0, -0.5, 0.0), Vec3::Y)], 1 << 16, Transport::default())[0];
        let truth = PI * (1.0 - reflected);
        mean_within(reading.irradiance.x, reading.stderr.x, truth, 0.01 * truth).unwrap();
    }
}

/// A slab that bends nothing and absorbs: E = 2π·L·E₃(σ·d), the exponential integral, by Beer and Lambert's law along
/// every slant.
#[test]
fn behind_an_absorbing_slab() {
    let (thickness, attenuation) = (0.5_f32, Vec3::new(0.8, 0.4, 0.1));
    let slab = || {
        of(standard(Standard {
            specular_transmission: 1.0,
            perceptual_roughness: 0.0,
            ior: 1.0,
            reflectance: 0.0,
            interior: Interior::Volume { attenuation_colour: attenuation, attenuation_distance: 1.0 },
            ..Standard::default()
        }))
    };
    let [x, z] = [400.0 * Vec3::X, 400.0 * Vec3::Z];
    let low = Vec3::new(-200.0, 0.5, -200.0);
    let mut scene = SceneBuilder::default()
        .quad("top", low + thickness * Vec3::Y, [z, x], slab())
        .quad("bottom", low, [x, z], slab())
        .build();
    scene.sky_radiance = Vec3::ONE;
    let reading = read(&scene, &[at(Vec3::ZERO, Vec3::Y)], 1 << 16, Transport::default())[0];
    for channel in 0..3 {
        let depth = -f64::from(attenuation[channel]).ln() * f64::from(thickness);
        let truth = 2.0 * PI * integrate(|cosine| cosine * (-depth / cosine).exp());
        mean_within(reading.irradiance[channel], reading.stderr[channel], truth, 0.01 * truth).unwrap();
    }
}

/// Whatever loses no light cannot be seen in a furnace: radiance 1 everywhere, whichever way it scatters.
#[test]
fn lossless_things_vanish_in_a_furnace() {
    let clear = Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: f32::INFINITY };
    let glass = |perceptual_roughness: f32, interior: Interior| {
        standard(Standard { specular_transmission: 1.0, perceptual_roughness, interior, ..Standard::default() })
    };
    let metal =
        |perceptual_roughness: f32| standard(Standard { metallic: 1.0, perceptual_roughness, ..Standard::default() });
    let cases = [
        ("mirror", Scattering::Mirror, 0.01),
        ("perfect glass", Scattering::Refraction { ior: 1.5 }, 0.01),
        ("smooth glass", glass(0.0, clear), 0.01),
        ("smooth pane", glass(0.0, Interior::ThinWalled), 0.01),
        ("smooth metal", metal(0.0), 0.01),
        ("rough metal", metal(0.7), 0.01),
        ("white plastic", standard(Standard::default()), 0.02),
        ("coated plastic", standard(Standard { clearcoat: 1.0, ..Standard::default() }), 0.02),
        ("paper lamp", standard(Standard { diffuse_transmission: 0.5, ..Standard::default() }), 0.02),
    ];
    let side = || glowing(0.5, 0.5);
    for (name, scattering, tolerance) in cases {
        // A box in the room, all but as large as it, so that most light meets it.
        let thing = of(scattering);
        let mut builder =
            SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()]);
        let (low, high) = (Vec3::new(-0.8, -0.6, -0.7), Vec3::new(0.7, 0.8, 0.8));
        let size = high - low;
        let [x, y, z] = [Vec3::X * size, Vec3::Y * size, Vec3::Z * size];
        let sides =
            [(low, [z, y]), (low + x, [y, z]), (low, [x, z]), (low + y, [z, x]), (low, [y, x]), (low + z, [x, y])];
        for (index, (corner, edges)) in sides.into_iter().enumerate() {
            builder = builder.quad(&format!("thing {index}"), corner, edges, thing.clone());
        }
        let scene = builder.build();
        let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
        let readings = read(&scene, &points, 1 << 11, Transport::default());
        let (found, error) = mean(&readings, 1);
        mean_within(found, error, PI, tolerance * PI).unwrap_or_else(|reason| panic!("{name}: {reason}"));
    }
}

fn texture(width: u32, texels: Vec<[f32; 4]>) -> Texture {
    Texture {
        name: "picture".into(),
        width,
        height: texels.len() as u32 / width,
        texels: Texels::Float(texels.into()),
        wrap: [Wrap::Clamp; 2],
        filter: Filter::Linear,
    }
}

/// A furnace whose walls change from place to place, dark where they glow: Le(x) = L·(1 − ρ(x)) gives L everywhere.
#[test]
fn a_furnace_with_pictures_on_its_walls() {
    let albedo: Vec<f32> = (0..16).map(|i| 0.05 + 0.9 * ((i * 7) % 16) as f32 / 15.0).collect();
    let colour = |value: f32| [value, value * 0.5, 1.0 - value, 1.0];
    let reflected: Vec<[f32; 4]> = albedo.iter().map(|&a| colour(a)).collect();
    let emitted: Vec<[f32; 4]> =
        albedo.iter().map(|&a| [1.0 - colour(a)[0], 1.0 - colour(a)[1], 1.0 - colour(a)[2], 1.0]).collect();
    let mut scene = {
        let side = || glowing(1.0, 1.0);
        SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()]).build()
    };
    scene.textures = vec![texture(4, reflected), texture(4, emitted)];
    for material in &mut scene.materials {
        material.base_colour_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
        material.emission_texture = Some(TextureRef { texture: 1, uv: UvChannel::Uv1 });
    }
    assert_eq!(scene.validate(), []);
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    for estimator in ESTIMATORS {
        let readings = read(&scene, &points, 1 << 13, by(estimator));
        for channel in 0..3 {
            let (found, error) = mean(&readings, channel);
            mean_within(found, error, PI, 0.01 * PI)
                .unwrap_or_else(|reason| panic!("{estimator:?}, channel {channel}: {reason}"));
        }
    }
}

/// Colours of vertices are those of a material: the same light to the last bit but for rounding.
#[test]
fn vertex_colours_are_colours() {
    let with = |colour: Vec3, vertex: Option<Vec4>| {
        let side = || Material { emitted_radiance: Vec3::ONE, ..Material::diffuse("side", colour) };
        let mut scene = SceneBuilder::default()
            .room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()])
            .build();
        for mesh in &mut scene.meshes {
            mesh.colours = vertex.map(|colour| vec![colour; mesh.positions.len()]);
        }
        read(&scene, &[at(Vec3::NEG_Y, Vec3::Y)], 1 << 10, Transport::default())[0].irradiance
    };
    let colour = Vec3::new(0.5, 0.25, 0.125);
    let [by_material, by_vertex] = [with(colour, None), with(Vec3::ONE, Some(colour.extend(1.0)))];
    assert!((by_material - by_vertex).abs().max_element() < 1e-4, "{by_material} {by_vertex}");
}

/// A mirror with a map that leans all its normals the same way looks another way: there, the sky's picture says which.
#[test]
fn a_normal_map_leans_the_mirror() {
    // The normal (sin 20°, 0, cos 20°) in the tangent frame, in a picture of one texel.
    let (sin, cos) = 20.0_f32.to_radians().sin_cos();
    let lean = [0.5 + 0.5 * sin, 0.5, 0.5 + 0.5 * cos, 1.0];
    let mut scene = SceneBuilder::default()
        .quad("mirror", Vec3::new(-1.0, 0.0, -1.0), [2.0 * Vec3::Z, 2.0 * Vec3::X], of(Scattering::Mirror))
        .build();
    scene.textures = vec![texture(1, vec![lean])];
    scene.meshes[0].normals = Some(vec![Vec3::Y; 4]);
    let (width, height) = (256, 128);
    let radiance = (0..width * height).map(|pixel| {
        let place = Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
        // A sky that says its own direction.
        0.5 + 0.5 * EnvironmentMap::direction_of(place / Vec2::new(width as f32, height as f32))
    });
    scene.environment = Some(EnvironmentMap {
        name: "directions".into(),
        width,
        height,
        radiance: radiance.collect(),
        world_from_map: Quat::IDENTITY,
    });
    // u runs along +Z on this quad, so that the tangent is +Z.
    for (encoding, expected_normal) in [
        (None, Vec3::Y),
        (Some(NormalEncoding::OpenGl), Vec3::new(0.0, cos, sin)),
        (Some(NormalEncoding::TwoChannel), Vec3::new(0.0, cos, sin)),
    ] {
        scene.materials[0].normal_map =
            encoding.map(|encoding| NormalMap { texture: TextureRef { texture: 0, uv: UvChannel::Uv1 }, encoding });
        assert_eq!(scene.validate(), []);
        let eye = Vec3::new(0.3, 3.0, -0.5);
        let camera = Camera::look_at("eye", eye, Vec3::ZERO, 0.01);
        let settings = PictureSettings {
            transport: Transport::default(),
            width: 1,
            height: 1,
            samples_per_pixel: 64,
            threads: None,
        };
        let picture = render_picture(&scene, &camera, &settings, &(), &CancelToken::default()).unwrap();
        let incoming = -eye.normalize();
        let reflected = incoming - 2.0 * incoming.dot(expected_normal) * expected_normal;
        let seen = (picture.radiance[0] - 0.5) * 2.0;
        assert!((seen - reflected).length() < 0.05, "{encoding:?}: {seen} for {reflected}");
    }
}

/// Bevy's default material over a wall of light: all that it reflects, diffuse and glossy together, in a furnace that
/// would show one per cent too much. And gloss without interreflection is a matter of the camera alone.
#[test]
fn a_glossy_floor_gives_back_no_more_than_it_gets() {
    let sides = |scattering: &Scattering| {
        let side = || Material { emitted_radiance: Vec3::splat(0.1), ..of(scattering.clone()) };
        SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()]).build()
    };
    // White walls that glow a little would fill with light without end if an albedo passed 1; roulette's end of paths
    // after some five hundred bounces bounds it here.
    let dim = Standard { perceptual_roughness: 0.4, ..Standard::default() };
    let mut scene = sides(&standard(dim));
    for material in &mut scene.materials {
        material.base_colour = Vec4::new(0.8, 0.8, 0.8, 1.0);
    }
    let readings = read(&scene, &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), 1 << 10, Transport::default());
    let (found, error) = mean(&readings, 0);
    // Albedo at least that of the diffuse part under the gloss, at most 0.8 + 0.2 · what gloss adds.
    let (least, most) = (0.1 * PI / (1.0 - 0.70), 0.1 * PI / (1.0 - 0.86));
    assert!(found - 4.0 * error > least && found + 4.0 * error < most, "{found} ± {error}: {least} to {most}");
}

#[test]
fn quadrature_is_what_it_says() {
    assert!((integrate(|x| (FRAC_PI_2 * x).sin()) - 2.0 / PI).abs() < 1e-9);
    assert!((fresnel(1.0, 1.5) - 0.04).abs() < 1e-12);
    assert_eq!(fresnel(0.1, 1.0 / 1.5), 1.0);
}

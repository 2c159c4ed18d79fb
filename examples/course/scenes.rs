//! The course's scenes. Lengths in metres, radiance in cd/m².

use crate::stage::Stage;
use crate::teacher::Patch;
use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{
    Camera, DirectionalLight, EnvironmentMap, Filter, Indices, Light, Material, Mesh, NormalEncoding, NormalMap,
    PointLight, Scattering, Scene, Standard, Texels, Texture, TextureRef, UvChannel, Wrap,
};
use glam::{Quat, Vec2, Vec3};

/// The Cornell box's lamp: Cornell University's measured data, as all of the box.
const LAMP: Vec3 = Vec3::new(18.387, 13.9873, 6.75357);
const LAMP_LOW: Vec3 = Vec3::new(2.13, 5.48, 2.27);
const LAMP_SIZE: Vec2 = Vec2::new(1.3, 1.05);
const BOX: Vec3 = Vec3::new(5.528, 5.488, 5.592);
const WHITE: Vec3 = Vec3::new(0.885_809, 0.698_859, 0.666_422);
const GREEN: Vec3 = Vec3::new(0.105_421, 0.377_98, 0.076_425);
const RED: Vec3 = Vec3::new(0.570_068, 0.043_013_5, 0.044_370_6);
const LAMP_ALBEDO: f32 = 0.78;

/// The sun's pixel in the picture of the sky, and its radiance.
const SUN_PIXEL: [u32; 2] = [44, 14];
const SUN: Vec3 = Vec3::new(2600.0, 2300.0, 1900.0);

/// A grey that only reflects.
pub fn grey(albedo: f32) -> Material {
    Material::diffuse("grey", Vec3::splat(albedo))
}

/// A grey that reflects and glows from its front.
pub fn glowing(albedo: f32, radiance: f32) -> Material {
    Material { emitted_radiance: Vec3::splat(radiance), ..grey(albedo) }
}

/// The Cornell box, 1 unit of its data as 1 cm; the lamp hangs 8 mm below the ceiling.
pub fn cornell() -> Scene {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * BOX);
    let white = Material::diffuse("white", WHITE);
    let lamp = Material { emitted_radiance: LAMP, ..grey(LAMP_ALBEDO) };
    let base = |corners: [(f32, f32); 4]| corners.map(|(x, z)| Vec2::new(x, z) / 100.0);
    Stage::default()
        .quad("floor", Vec3::ZERO, [z, x], white.clone())
        .quad("ceiling", y, [x, z], white.clone())
        .quad("back", z, [y, x], white.clone())
        .quad("green", Vec3::ZERO, [y, z], Material::diffuse("green", GREEN))
        .quad("red", x, [z, y], Material::diffuse("red", RED))
        .block("short", base([(130.0, 65.0), (82.0, 225.0), (240.0, 272.0), (290.0, 114.0)]), 1.65, &white)
        .block("tall", base([(423.0, 247.0), (265.0, 296.0), (314.0, 456.0), (472.0, 406.0)]), 3.3, &white)
        .quad("lamp", LAMP_LOW, [Vec3::X * LAMP_SIZE.x, Vec3::Z * LAMP_SIZE.y], lamp)
        .build()
}

/// The surface at a point of the Cornell box, for the teacher.
pub fn cornell_patch(point: Vec3) -> Patch {
    let near = 1e-3;
    let on_lamp = (point - LAMP_LOW).abs().y < near
        && (LAMP_LOW.x..LAMP_LOW.x + LAMP_SIZE.x).contains(&point.x)
        && (LAMP_LOW.z..LAMP_LOW.z + LAMP_SIZE.y).contains(&point.z);
    if on_lamp {
        return Patch { albedo: Vec3::splat(LAMP_ALBEDO), radiance: LAMP };
    }
    let albedo = if point.x < near {
        GREEN
    } else if point.x > BOX.x - near {
        RED
    } else {
        WHITE
    };
    Patch { albedo, radiance: Vec3::ZERO }
}

/// Cornell's own camera.
pub fn cornell_camera() -> Camera {
    Camera::look_at(
        "cornell",
        Vec3::new(2.78, 2.73, -8.0),
        Vec3::new(2.78, 2.73, 0.0),
        2.0 * (0.0125_f32 / 0.035).atan(),
    )
}

/// The box without its lamp's own pixels, whose brightness would drown every other error.
pub fn cornell_low_camera() -> Camera {
    Camera::look_at("low", Vec3::new(2.78, 2.73, -8.0), Vec3::new(2.78, 1.9, 0.0), 0.42)
}

/// A lamp over a floor with a ball between.
pub fn lamp_and_ball() -> Scene {
    Stage::default()
        .quad("floor", Vec3::new(-3.0, 0.0, -3.0), [Vec3::Z * 6.0, Vec3::X * 6.0], grey(0.7))
        .sphere("ball", Vec3::new(0.0, 0.6, 0.0), 0.6, Material::diffuse("ball", Vec3::new(0.7, 0.3, 0.2)))
        .quad("lamp", Vec3::new(-1.6, 2.2, -1.0), [Vec3::X * 1.6, Vec3::Z * 1.6], glowing(0.0, 4.0))
        .build()
}

/// A camera that looks down at the origin.
pub fn above() -> Camera {
    Camera::look_at("above", Vec3::new(0.0, 2.0, 4.5), Vec3::new(0.0, 0.4, 0.0), 0.7)
}

/// Balls of these albedos that touch each other under a sky, each glowing so that it gives off and reflects together
/// as much as the sky: seen from anywhere, there is nothing (Szirmay-Kalos 2001).
pub fn balls_in_a_furnace(sky: f32) -> Scene {
    let mut stage = Stage::default().sky(sky);
    for (index, (centre, albedo)) in FURNACE_BALLS.into_iter().enumerate() {
        stage = stage.sphere(&format!("ball {index}"), centre, 1.0, glowing(albedo, sky * (1.0 - albedo)));
    }
    stage.build()
}

const FURNACE_BALLS: [(Vec3, f32); 3] =
    [(Vec3::new(-1.0, -0.6, 0.0), 0.3), (Vec3::new(1.0, -0.6, 0.0), 0.6), (Vec3::new(0.0, 1.132, 0.0), 0.9)];

/// The surface at a point of [`balls_in_a_furnace`], for the teacher.
pub fn furnace_ball_patch(sky: f32) -> impl Fn(Vec3) -> Patch + Sync {
    move |point| {
        let nearest = |a: &&(Vec3, f32), b: &&(Vec3, f32)| a.0.distance(point).total_cmp(&b.0.distance(point));
        let albedo = FURNACE_BALLS.iter().min_by(nearest).map_or(0.0, |(_, albedo)| *albedo);
        Patch { albedo: Vec3::splat(albedo), radiance: Vec3::splat(sky * (1.0 - albedo)) }
    }
}

/// A closed cube of this albedo that glows: L = Le/(1 − ρ) everywhere and in every direction.
pub fn furnace(albedo: f32, radiance: f32) -> Scene {
    Stage::default().room(Vec3::NEG_ONE, Vec3::ONE, &glowing(albedo, radiance)).build()
}

/// Grey balls on a floor, to be lit by the sky.
pub fn balls_under_a_sky() -> Scene {
    Stage::default()
        .sky(1.0)
        .quad("floor", Vec3::new(-20.0, 0.0, -20.0), [Vec3::Z * 40.0, Vec3::X * 40.0], grey(0.5))
        .sphere("left", Vec3::new(-0.85, 0.8, 0.0), 0.8, grey(0.5))
        .sphere("right", Vec3::new(0.85, 0.8, 0.3), 0.8, grey(0.5))
        .build()
}

/// Five balls in a room, one for each way to scatter.
pub fn materials() -> Scene {
    let gold = Standard { metallic: 1.0, perceptual_roughness: 0.45, ..Standard::default() };
    let phong = Scattering::Phong { specular: Vec3::splat(0.4), exponent: 60.0 };
    let kinds = [
        Material::diffuse("Lambert", Vec3::new(0.7, 0.25, 0.2)),
        Material::scattering("Mirror", Vec3::splat(0.95), Scattering::Mirror),
        Material::scattering("Phong", Vec3::new(0.15, 0.3, 0.55), phong),
        Material::scattering("Refraction", Vec3::ONE, Scattering::Refraction { ior: 1.5 }),
        Material::scattering("Standard", Vec3::new(0.95, 0.7, 0.3), Scattering::Standard(Box::new(gold))),
    ];
    let mut stage = Stage::default()
        .quad("floor", Vec3::new(-4.0, 0.0, -1.5), [Vec3::Z * 5.0, Vec3::X * 8.0], grey(0.6))
        .quad("back", Vec3::new(-4.0, 0.0, -1.5), [Vec3::X * 8.0, Vec3::Y * 3.5], grey(0.6))
        .quad("left", Vec3::new(-4.0, 0.0, -1.5), [Vec3::Y * 3.5, Vec3::Z * 5.0], Material::diffuse("left", GREEN))
        .quad("right", Vec3::new(4.0, 0.0, -1.5), [Vec3::Z * 5.0, Vec3::Y * 3.5], Material::diffuse("right", RED))
        .quad("lamp", Vec3::new(-2.5, 3.4, -0.5), [Vec3::X * 5.0, Vec3::Z * 1.5], glowing(0.0, 6.0));
    for (index, material) in kinds.into_iter().enumerate() {
        let name = material.name.clone();
        stage = stage.sphere(&name, Vec3::new(1.3 * (index as f32 - 2.0), 0.6, 0.0), 0.6, material);
    }
    stage.build()
}

/// The view of [`materials`].
pub fn materials_camera() -> Camera {
    Camera::look_at("materials", Vec3::new(0.0, 1.6, 6.2), Vec3::new(0.0, 0.75, 0.0), 0.52)
}

/// Clear glass.
pub fn glass() -> Material {
    Material::scattering("glass", Vec3::ONE, Scattering::Refraction { ior: 1.5 })
}

/// A ball of some material, or none, over a floor, lit by a small sphere.
pub fn caustic(ball: Option<Material>) -> Scene {
    let lamp = PointLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        position: Vec3::new(-1.4, 2.6, 0.0),
        intensity: Vec3::splat(10.0),
        radius: 0.4,
        range: None,
    };
    let mut stage = Stage::default()
        .quad("floor", Vec3::new(-3.0, 0.0, -3.0), [Vec3::Z * 6.0, Vec3::X * 6.0], grey(0.7))
        .quad("back", Vec3::new(-3.0, 0.0, -1.6), [Vec3::X * 6.0, Vec3::Y * 4.0], grey(0.5))
        .light(Light::Point(lamp));
    if let Some(material) = ball {
        stage = stage.sphere("ball", Vec3::new(0.0, 0.75, 0.0), 0.5, material);
    }
    stage.build()
}

/// Balls on a floor under a picture of the sky whose sun is a single pixel.
pub fn sunny() -> Scene {
    let mut scene = Stage::default()
        .quad("floor", Vec3::new(-20.0, 0.0, -20.0), [Vec3::Z * 40.0, Vec3::X * 40.0], grey(0.5))
        .sphere("left", Vec3::new(-0.85, 0.8, 0.0), 0.8, Material::diffuse("left", Vec3::new(0.7, 0.3, 0.2)))
        .sphere("right", Vec3::new(0.85, 0.8, 0.3), 0.8, grey(0.7))
        .build();
    scene.environment = Some(sky_with_sun());
    scene
}

/// A blue sky of 128 × 64 pixels, one of which is the sun.
pub fn sky_with_sun() -> EnvironmentMap {
    let (width, height) = (128, 64);
    let pixel = |index: u32| {
        let (column, row) = (index % width, index / width);
        if [column, row] == SUN_PIXEL {
            return SUN;
        }
        let up = 1.0 - row as f32 / (0.5 * height as f32);
        if up > 0.0 { Vec3::new(1.0, 1.1, 1.2).lerp(Vec3::new(0.25, 0.45, 0.9), up) } else { Vec3::splat(0.3) }
    };
    let radiance = (0..width * height).map(pixel).collect();
    EnvironmentMap { name: "sky".into(), width, height, radiance, world_from_map: Quat::IDENTITY }
}

/// A wall of relief: a square that faces +Z, lit from the left; `turns` turns its texture by quarters. Without a map
/// it is flat.
pub fn relief(turns: Option<usize>) -> Scene {
    let uv = [Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO];
    let mut corners = uv;
    corners.rotate_left(turns.unwrap_or(0));
    let mesh = Mesh {
        positions: [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        indices: Indices::U16(vec![0, 1, 2, 0, 2, 3]),
        normals: Some(vec![Vec3::Z; 4]),
        uv0: Some(corners.to_vec()),
        ..Mesh::default()
    };
    let texture = TextureRef { texture: 0, uv: UvChannel::Uv0 };
    let map = turns.map(|_| NormalMap { texture, encoding: NormalEncoding::OpenGl });
    let material = Material { normal_map: map, ..grey(0.8) };
    let sun = DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction: Vec3::new(1.0, -0.4, -0.8).normalize(),
        illuminance: Vec3::splat(4.0),
        angular_diameter: 0.0,
    };
    Stage::default().texture(domes()).mesh("wall", mesh, material).light(Light::Directional(sun)).build()
}

/// Normals of a grid of domes, one corner of each cut off so that one sees which way it is turned.
fn domes() -> Texture {
    let (size, cells) = (128_u32, 4_u32);
    let normal = |index: u32| {
        let place = Vec2::new((index % size) as f32 + 0.5, (index / size) as f32 + 0.5) / size as f32;
        let cell = (place * cells as f32).fract() * 2.0 - 1.0;
        // Rows run downwards, y of the normal upwards.
        let slope = Vec2::new(cell.x, -cell.y) * 1.1;
        let is_dome = slope.length_squared() < 0.9 && slope.x + slope.y < 0.8;
        let normal = if is_dome { slope.extend((1.0 - slope.length_squared()).sqrt()) } else { Vec3::Z };
        (normal * 0.5 + 0.5).extend(1.0).to_array()
    };
    Texture {
        name: "domes".into(),
        width: size,
        height: size,
        texels: Texels::Float((0..size * size).map(normal).collect()),
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Linear,
    }
}

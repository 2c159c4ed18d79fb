//! Scenes thrown together by chance: shapes, materials, textures, lights and skies of every kind.

use crate::common::meter::{at, on_walls};
use crate::common::scenes::SceneBuilder;
use crate::common::statistics::Random;
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{
    Alpha, DirectionalLight, EnvironmentMap, Filter, Indices, Instance, Interior, Light, Material, Mesh,
    NormalEncoding, NormalMap, PointLight, RectLight, Scattering, Scene, SpotLight, Standard, Texels, Texture,
    TextureRef, Topology, UvChannel, Wrap,
};
use glam::{Affine2, Affine3A, Mat3A, Quat, Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Numbers by chance, as scenes need them.
pub struct Chance(Random);

impl Chance {
    pub fn new(seed: u64) -> Self {
        Self(Random::new(seed))
    }

    pub fn unit(&mut self) -> f32 {
        self.0.unit()
    }

    pub fn says(&mut self, chance: f32) -> bool {
        self.unit() < chance
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f32) as usize
    }

    pub fn one<T: Clone>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())].clone()
    }

    /// A share, often at an end.
    pub fn share(&mut self) -> f32 {
        match self.below(4) {
            0 => 0.0,
            1 => 1.0,
            _ => self.unit(),
        }
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit())
    }

    pub fn colour(&mut self) -> Vec3 {
        let (white, colour) = (Vec3::splat(self.unit()), self.vector());
        self.one(&[Vec3::ZERO, Vec3::ONE, white, colour, colour])
    }

    pub fn direction(&mut self) -> Vec3 {
        self.0.direction()
    }

    /// A power of ten.
    pub fn size(&mut self, low: f32, high: f32) -> f32 {
        10.0_f32.powf(low + (high - low) * self.unit())
    }

    pub fn texture(&mut self) -> Option<TextureRef> {
        let uv = self.one(&[UvChannel::Uv0, UvChannel::Uv1]);
        self.says(0.4).then(|| TextureRef { texture: self.below(TEXTURES), uv })
    }
}

/// Textures of each scene.
pub const TEXTURES: usize = 3;

pub fn texture(chance: &mut Chance) -> Texture {
    let (width, height) = (1 + chance.below(4) as u32, 1 + chance.below(4) as u32);
    let count = width * height;
    let bytes: Vec<[u8; 4]> = (0..count).map(|_| std::array::from_fn(|_| (255.0 * chance.share()) as u8)).collect();
    // Beyond 0 to 1 too, as a picture of floats may be.
    let floats: Vec<[f32; 4]> = (0..count).map(|_| std::array::from_fn(|_| 1.5 * chance.share() - 0.2)).collect();
    let texels = [Texels::Srgb8(bytes.clone().into()), Texels::Linear8(bytes.into()), Texels::Float(floats.into())];
    let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    Texture {
        name: "texture".into(),
        width,
        height,
        texels: chance.one(&texels),
        wrap: [chance.one(&wraps), chance.one(&wraps)],
        filter: chance.one(&[Filter::Linear, Filter::Nearest]),
    }
}

pub fn scattering(chance: &mut Chance) -> Scattering {
    match chance.below(8) {
        0 => Scattering::None,
        1 => Scattering::Diffuse,
        2 => Scattering::Mirror,
        3 => Scattering::Refraction { ior: chance.one(&[0.5, 1.0, 1.0001, 1.33, 1.5, 4.0]) },
        4 => Scattering::Phong { specular: Vec3::splat(0.5), exponent: chance.size(-1.0, 4.0) },
        _ => Scattering::Standard(Box::new(standard(chance))),
    }
}

pub fn standard(chance: &mut Chance) -> Standard {
    let body = Interior::Volume {
        attenuation_colour: chance.colour(),
        attenuation_distance: chance.one(&[0.01, 1.0, f32::INFINITY]),
    };
    Standard {
        metallic: chance.share(),
        perceptual_roughness: chance.share(),
        metallic_roughness_texture: chance.texture(),
        reflectance: chance.share(),
        specular_tint: chance.colour(),
        specular_transmission: chance.share(),
        specular_transmission_texture: chance.texture(),
        interior: chance.one(&[Interior::ThinWalled, body]),
        ior: chance.one(&[0.7, 1.0, 1.5, 2.4]),
        diffuse_transmission: chance.share(),
        diffuse_transmission_texture: chance.texture(),
        clearcoat: chance.share(),
        clearcoat_texture: chance.texture(),
        clearcoat_perceptual_roughness: chance.share(),
        clearcoat_roughness_texture: chance.texture(),
    }
}

pub fn alpha(chance: &mut Chance) -> Alpha {
    chance.one(&[
        Alpha::Opaque,
        Alpha::Opaque,
        Alpha::Opaque,
        Alpha::Mask { cutoff: 0.5 },
        Alpha::Blend,
        Alpha::Multiply,
        Alpha::Add,
    ])
}

pub fn material(chance: &mut Chance) -> Material {
    let encodings = [NormalEncoding::OpenGl, NormalEncoding::DirectX, NormalEncoding::TwoChannel];
    let scattering = scattering(chance);
    let colour = match scattering {
        Scattering::Phong { .. } => 0.5 * chance.colour(),
        _ => chance.colour(),
    };
    Material {
        name: "material".into(),
        base_colour: colour.extend(chance.share()),
        base_colour_texture: chance.texture().filter(|_| !matches!(scattering, Scattering::Phong { .. })),
        scattering,
        alpha: alpha(chance),
        emitted_radiance: Vec3::ZERO,
        emission_texture: chance.texture(),
        double_sided: chance.says(0.5),
        normal_map: chance.texture().map(|texture| NormalMap { texture, encoding: chance.one(&encodings) }),
        uv_transform: Affine2::from_scale_angle_translation(
            Vec2::splat(chance.size(-1.0, 1.0)),
            chance.unit(),
            Vec2::ONE,
        ),
    }
}

/// A diamond as a list or a zigzag as a strip, with any of what vertices may carry.
pub fn mesh(chance: &mut Chance) -> Mesh {
    let (topology, positions, indices) = if chance.says(0.6) {
        let positions = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]).collect::<Vec<_>>();
        let faces: [u16; 24] = [0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5];
        (Topology::TriangleList, positions, Indices::U16(faces.to_vec()))
    } else {
        let positions = (0..6).map(|i| Vec3::new((i % 2) as f32, 0.1 * (i % 3) as f32, 0.5 * (i / 2) as f32));
        let indices = chance.one(&[Indices::None, Indices::U32(vec![0, 1, 2, 3, 3, 4, 5])]);
        (Topology::TriangleStrip, positions.collect(), indices)
    };
    let count = positions.len();
    let has = [0.6, 0.6, 0.6, 0.3, 0.3].map(|share| chance.says(share));
    let uv = |chance: &mut Chance| (0..count).map(|_| 2.0 * chance.0.square()).collect::<Vec<_>>();
    let tangent = |chance: &mut Chance| chance.direction().extend(chance.one(&[-1.0, 1.0]));
    Mesh {
        name: "mesh".into(),
        topology,
        indices,
        normals: has[0].then(|| positions.iter().map(|p| p.normalize_or(Vec3::Y)).collect()),
        positions,
        uv0: has[1].then(|| uv(chance)),
        uv1: has[2].then(|| uv(chance)),
        colours: has[3].then(|| (0..count).map(|_| chance.vector().extend(chance.unit())).collect::<Vec<Vec4>>()),
        tangents: has[4].then(|| (0..count).map(|_| tangent(chance)).collect()),
    }
}

/// A closed room of side 2 around the origin, its walls of this material.
pub fn room(wall: &Material) -> Scene {
    let walls = std::array::from_fn(|_| wall.clone());
    let mut scene = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, walls).build();
    scene.instances.iter_mut().for_each(|instance| instance.lightmap = None);
    scene
}

/// Puts a thing into a scene, turned, sheared or mirrored.
pub fn put(scene: &mut Scene, mesh: Mesh, material: Material, chance: &mut Chance) {
    let name = format!("thing {}", scene.instances.len());
    let mut size = 0.1 + 0.3 * chance.vector();
    if chance.says(0.5) {
        size.x = -size.x;
    }
    let turn = Mat3A::from_quat(Quat::from_rotation_arc(Vec3::Y, chance.direction()));
    let world_from_local = Affine3A::from_mat3_translation((turn * Mat3A::from_diagonal(size)).into(), {
        1.2 * chance.vector() - Vec3::splat(0.6)
    });
    scene.instances.push(Instance {
        id: StableId::new(&name),
        name,
        mesh: scene.meshes.len(),
        material: scene.materials.len(),
        world_from_local,
        lightmap: None,
    });
    scene.meshes.push(mesh);
    scene.materials.push(material);
}

pub fn lamp(number: usize, scale: f32, radius: f32, chance: &mut Chance) -> Light {
    let id = StableId::new(format!("lamp {number}"));
    let name = "lamp".to_owned();
    let position = 1.6 * chance.vector() - Vec3::splat(0.8);
    let range = chance.one(&[None, None, Some(1.5)]);
    let bulb = PointLight { id, name, position, intensity: scale * chance.vector(), radius, range };
    let direction = chance.direction();
    match chance.below(4) {
        0 => Light::Point(bulb),
        1 => Light::Spot(SpotLight { bulb, direction, inner_angle: 0.5, outer_angle: 0.5 + chance.unit() }),
        2 => Light::Directional(DirectionalLight {
            id: bulb.id,
            name: bulb.name,
            direction,
            illuminance: bulb.intensity,
            angular_diameter: 2.0 * radius.min(1.0),
        }),
        _ => Light::Rect(RectLight {
            id: bulb.id,
            name: bulb.name,
            world_from_local: Affine3A::from_rotation_translation(
                Quat::from_rotation_arc(Vec3::NEG_Z, direction),
                position,
            ),
            width: radius.max(1e-6),
            height: 2.0 * radius.max(1e-6),
            radiance: bulb.intensity,
            range,
        }),
    }
}

pub fn sky(chance: &mut Chance) -> EnvironmentMap {
    let radiance: Arc<[Vec3]> = (0..8).map(|_| chance.colour()).collect();
    EnvironmentMap {
        name: "sky".into(),
        width: 4,
        height: 2,
        radiance,
        world_from_map: Quat::from_rotation_arc(Vec3::Y, chance.direction()),
    }
}

/// A room of anything with anything in it, without a wall in half of all cases.
pub fn anything(seed: u64) -> Scene {
    let chance = &mut Chance::new(seed);
    let mut scene = room(&Material::default());
    scene.materials.iter_mut().for_each(|wall| *wall = material(chance));
    scene.textures = (0..TEXTURES).map(|_| texture(chance)).collect();
    if chance.says(0.5) {
        scene.instances.remove(chance.below(6));
        scene.sky_radiance = chance.colour();
        scene.environment = chance.says(0.5).then(|| sky(chance));
    }
    for _ in 0..1 + chance.below(4) {
        let (mesh, mut material) = (mesh(chance), material(chance));
        if chance.says(0.4) {
            material.emitted_radiance = chance.colour();
        }
        put(&mut scene, mesh, material, chance);
    }
    scene
}

pub fn points() -> Vec<MeterPoint> {
    let mut points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 1);
    points.extend([at(Vec3::new(0.11, 0.07, -0.13), Vec3::Y), at(Vec3::new(-0.3, 0.2, 0.1), Vec3::NEG_ONE)]);
    points
}

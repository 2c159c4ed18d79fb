//! A place to share paths in: a box open at its top under a white sky, a lamp in a corner and a ball in the middle, of
//! which each receiver sees another part; of different materials, and with something to see through.

use crate::artefact::StableId;
use crate::scene::{Alpha, Instance, Light, Material, PointLight, Scattering, Scene, Standard};
use crate::trace::Tracer;
use crate::trace::path::PathStart;
use crate::trace::testing::Shape;
use glam::{Affine3A, Quat, Vec3};

/// What the yard is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Yard {
    /// Lambert's surfaces.
    Matt,
    /// Bevy's material as it comes, a little smoother.
    Glossy,
    /// Half of it a metal.
    Metallic,
    /// Varnished, and so reflecting that the matt part looks different from every side.
    Varnished,
    /// Phong's model.
    Phong,
    /// A ball whose normals are not those of its facets.
    Smooth,
    /// A mirror on the ball.
    Mirror,
    /// Gauze over most of the floor.
    Veiled,
    /// Dusty glass over most of the floor, and gloss.
    Clear,
}

pub(super) const YARDS: [Yard; 9] = [
    Yard::Matt,
    Yard::Glossy,
    Yard::Metallic,
    Yard::Varnished,
    Yard::Phong,
    Yard::Smooth,
    Yard::Mirror,
    Yard::Veiled,
    Yard::Clear,
];

impl Yard {
    pub(super) fn tracer(self) -> Tracer {
        let mut open = Shape::cube();
        open.triangles.drain(6..8);
        let wall = Material::scattering("wall", Vec3::new(0.3, 0.5, 0.7), self.scattering());
        let mut scene = open.scene(wall, Affine3A::IDENTITY);
        let ball = match self {
            Self::Matt => Material::diffuse("ball", Vec3::splat(0.02)),
            Self::Mirror => Material::scattering("ball", Vec3::splat(0.9), Scattering::Mirror),
            _ => Material::scattering("ball", Vec3::splat(0.3), self.scattering()),
        };
        let place =
            Affine3A::from_scale_rotation_translation(Vec3::splat(0.3), Quat::IDENTITY, Vec3::new(0.5, 0.4, 0.5));
        // As in any game, it faces outwards.
        let mut outwards = Shape::icosphere(1);
        outwards.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        add(&mut scene, "the ball, after the shape", &outwards, ball, place);
        if self == Self::Smooth {
            let ball = &mut scene.meshes[1];
            ball.normals = Some(ball.positions.clone());
        }
        if let Some(sheet) = self.sheet() {
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.7], [0.0, 0.7]].map(|[x, z]| Vec3::new(x, 0.22, z));
            let shape = Shape { positions: corners.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]] };
            add(&mut scene, "the sheet", &shape, sheet, Affine3A::IDENTITY);
        }
        // Which has no look, and is to hide none.
        scene.sky_radiance = Vec3::splat(if self == Self::Varnished { 0.02 } else { 0.2 });
        scene.lights.push(Light::Point(PointLight {
            id: StableId::new("lamp"),
            name: "lamp".into(),
            position: Vec3::new(0.1, 0.7, 0.15),
            intensity: Vec3::splat(0.5),
            // That gloss does not show it as specks.
            radius: if self == Self::Matt { 0.0 } else { 0.08 },
            range: None,
        }));
        Tracer::new(&scene)
    }

    fn scattering(self) -> Scattering {
        let standard = |standard: Standard| Scattering::Standard(Box::new(standard));
        let glossy = Standard { perceptual_roughness: 0.4, ..Standard::default() };
        match self {
            Self::Matt | Self::Veiled | Self::Mirror => Scattering::Diffuse,
            Self::Glossy | Self::Smooth | Self::Clear => standard(glossy),
            Self::Metallic => standard(Standard { metallic: 0.5, ..glossy }),
            Self::Varnished => standard(Standard {
                reflectance: 1.0,
                perceptual_roughness: 0.4,
                clearcoat: 1.0,
                clearcoat_perceptual_roughness: 0.4,
                ..Standard::default()
            }),
            Self::Phong => Scattering::Phong { specular: Vec3::splat(0.2), exponent: 20.0 },
        }
    }

    fn sheet(self) -> Option<Material> {
        match self {
            Self::Veiled => {
                let gauze = Material::diffuse("gauze", Vec3::new(0.8, 0.5, 0.4));
                Some(Material { alpha: Alpha::Blend, base_colour: gauze.base_colour.with_w(0.3), ..gauze })
            }
            Self::Clear => {
                let dusty = Standard { specular_transmission: 0.7, perceptual_roughness: 0.0, ..Standard::default() };
                let colour = Vec3::new(0.9, 0.8, 0.7);
                Some(Material::scattering("pane", colour, Scattering::Standard(Box::new(dusty))))
            }
            _ => None,
        }
    }
}

fn add(scene: &mut Scene, name: &str, shape: &Shape, material: Material, world_from_local: Affine3A) {
    let mut other = shape.scene(material, world_from_local);
    let (mesh, material) = (scene.meshes.len(), scene.materials.len());
    let instance = other.instances.remove(0);
    scene.instances.push(Instance { id: StableId::new(name), mesh, material, ..instance });
    scene.meshes.append(&mut other.meshes);
    scene.materials.append(&mut other.materials);
}

/// Some near each other, some near an edge, some on other walls.
pub(super) fn receivers(tracer: &Tracer) -> Vec<PathStart> {
    let on = |triangle: u32, at: [f32; 2]| tracer.start_on_triangle(triangle, at, tracer.normal(triangle));
    let floor = [[0.3, 0.3], [0.35, 0.3], [0.6, 0.2], [0.01, 0.4]].map(|at| on(4, at));
    let walls = [on(0, [0.3, 0.02]), on(0, [0.2, 0.4]), on(2, [0.5, 0.3]), on(7, [0.4, 0.4])];
    floor.into_iter().chain(walls).collect()
}

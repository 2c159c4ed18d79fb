//! Three scenes of different difficulty, each on one shared page whose UV1 is laid out here, so that their texels stay
//! where they are whatever becomes of the packing.

use crate::common::glb;
use crate::common::scenes::grey;
use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{
    DirectionalLight, Indices, Instance, Light, LightmapRequest, Material, Mesh, PointLight, Scene, Topology,
};
use glam::{Affine3A, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Empty texels between two cells.
const GUTTER: u32 = 3;

/// A scene, and the page that its UV1 is made for.
pub struct Case {
    pub name: &'static str,
    pub scene: Scene,
    /// Width and height of the page [texels].
    pub size: u32,
}

/// All three.
pub fn all() -> [Case; 3] {
    [cornell(), sunlit(), lamps()]
}

/// The Cornell box: an area light, colour that bleeds, two boxes.
pub fn cornell() -> Case {
    Case { name: "cornell", scene: glb::load("cornell"), size: 128 }
}

/// A room lit by the sky and the sun through one window; a table stands with two legs in the patch of sun.
pub fn sunlit() -> Case {
    let mut builder = Builder::new(192, 16.0);
    let (x, y, z) = (Vec3::X * 3.5, Vec3::Y * 2.375, Vec3::Z * 3.0);
    let paint = |r, g, b| Material::diffuse(format!("paint {r} {g} {b}"), Vec3::new(r, g, b));
    builder.quad("floor", Vec3::ZERO, [z, x], paint(0.5, 0.4, 0.3));
    builder.quad("ceiling", y, [x, z], grey(0.8));
    builder.quad("left", Vec3::ZERO, [x, y], paint(0.6, 0.65, 0.7));
    builder.quad("right", z, [y, x], paint(0.7, 0.6, 0.55));
    builder.quad("back", x, [z, y], grey(0.7));
    // The wall with the window in it: below, above, and on either side.
    let (low, high, from, to) = (0.9375, 2.0, 0.875, 2.125);
    let wall = |y, z| Vec3::new(0.0, y, z);
    builder.quad("below", wall(0.0, 0.0), [Vec3::Y * low, z], grey(0.7));
    builder.quad("above", wall(high, 0.0), [Vec3::Y * (2.375 - high), z], grey(0.7));
    builder.quad("near", wall(low, 0.0), [Vec3::Y * (high - low), Vec3::Z * from], grey(0.7));
    builder.quad("far", wall(low, to), [Vec3::Y * (high - low), Vec3::Z * (3.0 - to)], grey(0.7));
    let wood = || paint(0.45, 0.25, 0.12);
    builder.block("top", Vec3::new(1.2, 0.65, 1.0), Vec3::new(2.4, 0.7, 1.7), wood());
    for (leg, corner) in [(1.25, 1.05), (2.27, 1.05), (1.25, 1.57), (2.27, 1.57)].into_iter().enumerate() {
        let low = Vec3::new(corner.0, 0.0, corner.1);
        builder.block(&format!("leg {leg}"), low, low + Vec3::new(0.08, 0.65, 0.08), wood());
    }
    let mut scene = builder.scene;
    scene.sky_radiance = Vec3::new(2.4, 3.2, 4.4);
    scene.lights.push(Light::Directional(DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction: Vec3::new(0.75, -0.6, 0.12).normalize(),
        illuminance: Vec3::new(24.0, 21.0, 17.0),
        angular_diameter: 0.0093,
    }));
    finished("sunlit", scene, builder.size)
}

/// A ball, a pillar and a block in a corner, under many small lamps of different sizes and colours. The pillar has a
/// lid, or its inside would be a lit room, and the floor on both sides of its wall no test of a denoiser.
pub fn lamps() -> Case {
    let mut builder = Builder::new(144, 18.0);
    builder.quad("floor", Vec3::ZERO, [Vec3::Z * 3.0, Vec3::X * 3.0], grey(0.6));
    builder.quad("wall", Vec3::ZERO, [Vec3::X * 3.0, Vec3::Y * 2.0], grey(0.7));
    let red = Material::diffuse("red", Vec3::new(0.7, 0.2, 0.15));
    builder.quad("side", Vec3::ZERO, [Vec3::Y * 2.0, Vec3::Z * 3.0], red);
    builder.ball("ball", Vec3::new(0.9, 0.45, 1.2), 0.45);
    builder.pillar("pillar", Vec3::new(2.1, 0.0, 0.8), 0.25, 1.0);
    builder.lid("lid", Vec3::new(2.1, 1.0, 0.8), 0.25);
    builder.block("block", Vec3::new(1.6, 0.0, 1.9), Vec3::new(2.2, 0.5, 2.5), grey(0.5));
    let mut scene = builder.scene;
    for lamp in 0..48_u8 {
        // A sunflower's seeds, from the middle outwards.
        let (turn, distance) = (2.4 * f32::from(lamp), 0.2 * f32::from(lamp).sqrt());
        let place = Vec3::new(1.6 + distance * turn.cos(), 1.8 + 0.3 * (3.0 * turn).sin(), 1.6 + distance * turn.sin());
        scene.lights.push(Light::Point(PointLight {
            id: StableId::new(format!("lamp {lamp}")),
            name: format!("lamp {lamp}"),
            position: place,
            intensity: Vec3::new(1.0 + turn.sin(), 1.2, 1.0 - turn.sin()),
            radius: [0.06, 0.1, 0.16][usize::from(lamp % 3)],
            range: None,
        }));
    }
    finished("lamps", scene, builder.size)
}

fn finished(name: &'static str, scene: Scene, size: u32) -> Case {
    assert_eq!(scene.validate(), []);
    Case { name, scene, size }
}

/// Takes one mesh after the other and gives each a cell of the page, aligned to texels.
struct Builder {
    scene: Scene,
    size: u32,
    /// Texels per metre.
    density: f32,
    /// Where the next cell goes, and how high its row is [texels].
    next: [u32; 2],
    row: u32,
}

impl Builder {
    fn new(size: u32, density: f32) -> Self {
        Self { scene: Scene::default(), size, density, next: [GUTTER; 2], row: 0 }
    }

    /// A cell for so many metres, in UV1: its corner and its extent.
    fn cell(&mut self, metres: Vec2) -> (Vec2, Vec2) {
        let [width, height] = (metres * self.density).round().max(Vec2::ONE).to_array().map(|texels| texels as u32);
        if self.next[0] + width + GUTTER > self.size {
            self.next = [GUTTER, self.next[1] + self.row + GUTTER];
            self.row = 0;
        }
        let [x, y] = self.next;
        assert!(y + height + GUTTER <= self.size, "the page is full at {x}, {y}");
        self.next[0] += width + GUTTER;
        self.row = self.row.max(height);
        let texel = 1.0 / self.size as f32;
        (Vec2::new(x as f32, y as f32) * texel, Vec2::new(width as f32, height as f32) * texel)
    }

    /// A rectangle from a corner along two edges; its front is the side of `u` × `v`.
    fn quad(&mut self, name: &str, corner: Vec3, [u, v]: [Vec3; 2], material: Material) {
        let (low, extent) = self.cell(Vec2::new(u.length(), v.length()));
        let uv1 = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(|place| low + place * extent);
        let positions = vec![corner, corner + u, corner + u + v, corner + v];
        self.mesh(
            name,
            material,
            Shape { positions, normals: None, uv1: uv1.to_vec(), indices: vec![0, 1, 2, 0, 2, 3] },
        );
    }

    /// The outside of a box, each side a chart; the lower one only if it hovers.
    fn block(&mut self, name: &str, low: Vec3, high: Vec3, material: Material) {
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * (high - low));
        let sides = [
            ("-x", low, [z, y]),
            ("+x", low + x, [y, z]),
            ("+y", low + y, [z, x]),
            ("-z", low, [y, x]),
            ("+z", low + z, [x, y]),
        ];
        for (side, corner, edges) in sides.into_iter().chain((low.y > 0.0).then_some(("-y", low, [x, z]))) {
            self.quad(&format!("{name} {side}"), corner, edges, material.clone());
        }
    }

    /// A sphere, unrolled by longitude and latitude.
    fn ball(&mut self, name: &str, centre: Vec3, radius: f32) {
        let (low, extent) = self.cell(Vec2::new(TAU, PI) * radius);
        self.revolved(name, [48, 24], (low, extent), |u, v| {
            let (longitude, latitude) = (TAU * u, PI * (v - 0.5));
            let normal = Vec3::new(latitude.cos() * longitude.sin(), latitude.sin(), latitude.cos() * longitude.cos());
            (centre + radius * normal, normal)
        });
    }

    /// An upright cylinder without its ends.
    fn pillar(&mut self, name: &str, foot: Vec3, radius: f32, height: f32) {
        let (low, extent) = self.cell(Vec2::new(TAU * radius, height));
        self.revolved(name, [48, 1], (low, extent), |u, v| {
            let normal = Vec3::new((TAU * u).sin(), 0.0, (TAU * u).cos());
            (foot + radius * normal + Vec3::Y * height * v, normal)
        });
    }

    /// The end of a pillar, without a lightmap. No wider than the pillar: it is to cast no shadow of its own.
    fn lid(&mut self, name: &str, centre: Vec3, radius: f32) {
        const SIDES: u32 = 48;
        let turn = |side: u32| TAU * side as f32 / SIDES as f32;
        let rim = (0..SIDES).map(|side| centre + radius * Vec3::new(turn(side).sin(), 0.0, turn(side).cos()));
        let positions = std::iter::once(centre).chain(rim).collect();
        let indices = (0..SIDES).flat_map(|side| [0, 1 + side, 1 + (side + 1) % SIDES]).collect();
        self.mesh(name, grey(0.5), Shape { positions, indices, ..Shape::default() });
        if let Some(lid) = self.scene.instances.last_mut() {
            lid.lightmap = None;
        }
    }

    fn revolved(
        &mut self,
        name: &str,
        [columns, rows]: [u32; 2],
        (low, extent): (Vec2, Vec2),
        point: impl Fn(f32, f32) -> (Vec3, Vec3),
    ) {
        let mut shape = Shape { normals: Some(Vec::new()), ..Shape::default() };
        for index in 0..(columns + 1) * (rows + 1) {
            let [column, row] = [index % (columns + 1), index / (columns + 1)];
            let place = Vec2::new(column as f32 / columns as f32, row as f32 / rows as f32);
            let (position, normal) = point(place.x, place.y);
            shape.positions.push(position);
            shape.normals.get_or_insert_default().push(normal);
            shape.uv1.push(low + place * extent);
            if column < columns && row < rows {
                let above = index + columns + 1;
                shape.indices.extend([index, index + 1, above + 1, index, above + 1, above]);
            }
        }
        self.mesh(name, grey(0.5), shape);
    }

    fn mesh(&mut self, name: &str, material: Material, shape: Shape) {
        self.scene.instances.push(Instance {
            id: StableId::new(name),
            name: name.into(),
            mesh: self.scene.meshes.len(),
            material: self.scene.materials.len(),
            world_from_local: Affine3A::IDENTITY,
            lightmap: Some(LightmapRequest::default()),
        });
        self.scene.materials.push(material);
        self.scene.meshes.push(Mesh {
            name: name.into(),
            topology: Topology::TriangleList,
            indices: Indices::U32(shape.indices),
            positions: shape.positions,
            normals: shape.normals,
            uv1: (!shape.uv1.is_empty()).then_some(shape.uv1),
            ..Mesh::default()
        });
    }
}

#[derive(Default)]
struct Shape {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    uv1: Vec<Vec2>,
    indices: Vec<u32>,
}

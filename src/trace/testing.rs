//! Shapes and scenes for the tests of the tracer.

use super::tracer::Tracer;
use crate::artefact::StableId;
use crate::math::testing::Random;
use crate::math::{Frame, square_to_cosine_hemisphere};
use crate::scene::{Indices, Instance, Material, Mesh, Scene, Topology};
use glam::{Affine3A, Vec3};
use std::collections::HashMap;

/// Vertices and triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    pub(super) positions: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// One triangle.
    pub(super) fn triangle(vertices: [Vec3; 3]) -> Self {
        Self { positions: vertices.to_vec(), triangles: vec![[0, 1, 2]] }
    }

    /// The cube [0, 1]³, 12 triangles that face inwards.
    pub(super) fn cube() -> Self {
        let positions =
            (0..8).map(|corner| Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32));
        let quads = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Self { positions: positions.collect(), triangles }
    }

    /// A sphere of radius 1 about the origin that faces inwards: an icosahedron, each triangle cut in four `levels`
    /// times.
    pub(super) fn icosphere(levels: u32) -> Self {
        let g = 0.5 + 1.25_f32.sqrt();
        let ring = |axis: usize| {
            [(-1.0, -g), (1.0, -g), (-1.0, g), (1.0, g)].map(|(x, y)| {
                let mut vertex = [0.0; 3];
                vertex[axis] = x;
                vertex[(axis + 1) % 3] = y;
                Vec3::from(vertex)
            })
        };
        let positions: Vec<Vec3> = (0..3).flat_map(ring).collect();
        // An icosahedron's faces are the triples of vertices at the distance of an edge, here 2.
        let is_edge = |a: usize, b: usize| (positions[a].distance(positions[b]) - 2.0).abs() < 1e-3;
        let mut triangles = Vec::new();
        for a in 0..12 {
            for b in a + 1..12 {
                for c in b + 1..12 {
                    if is_edge(a, b) && is_edge(b, c) && is_edge(a, c) {
                        triangles.push([a as u32, b as u32, c as u32]);
                    }
                }
            }
        }
        let mut shape = Self { positions, triangles };
        for _ in 0..levels {
            shape.subdivide();
        }
        shape.positions.iter_mut().for_each(|vertex| *vertex = vertex.normalize());
        for ([a, b, c], triangle) in shape.corners().into_iter().zip(&mut shape.triangles) {
            if (b - a).cross(c - a).dot(a) > 0.0 {
                triangle.swap(1, 2);
            }
        }
        shape
    }

    fn subdivide(&mut self) {
        let mut middles = HashMap::new();
        let positions = &mut self.positions;
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push(0.5 * (positions[a as usize] + positions[b as usize]));
                positions.len() as u32 - 1
            })
        };
        let cut = |&[a, b, c]: &[u32; 3]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        self.triangles = self.triangles.iter().flat_map(cut).collect();
    }

    /// The same shape elsewhere.
    pub(super) fn moved(&self, map: impl Fn(Vec3) -> Vec3) -> Self {
        Self {
            positions: self.positions.iter().map(|&vertex| map(vertex)).collect(),
            triangles: self.triangles.clone(),
        }
    }

    /// The corners of each triangle.
    pub(super) fn corners(&self) -> Vec<[Vec3; 3]> {
        self.triangles.iter().map(|triangle| triangle.map(|vertex| self.positions[vertex as usize])).collect()
    }

    /// A scene of this shape alone.
    pub(super) fn scene(&self, material: Material, world_from_local: Affine3A) -> Scene {
        let mesh = Mesh {
            name: "shape".into(),
            topology: Topology::TriangleList,
            indices: Indices::U32(self.triangles.concat()),
            positions: self.positions.clone(),
            ..Mesh::default()
        };
        let instance = Instance {
            id: StableId::new("shape"),
            name: "shape".into(),
            mesh: 0,
            material: 0,
            world_from_local,
            lightmap: None,
        };
        Scene { meshes: vec![mesh], materials: vec![material], instances: vec![instance], ..Scene::default() }
    }

    /// The tracer of a white scene of this shape alone.
    pub(super) fn tracer(&self, world_from_local: Affine3A) -> Tracer {
        Tracer::new(&self.scene(Material::diffuse("white", Vec3::ONE), world_from_local))
    }
}

/// Walks from wall to wall inside a closed shape whose triangles face inwards, `bounces` times, and counts how often
/// a ray finds no wall. After such an escape the walk begins anew.
pub(super) fn escapes(tracer: &Tracer, bounces: u32, seed: u64) -> u32 {
    let mut random = Random::new(seed);
    let start = || tracer.start_on_triangle(0, [0.3, 0.4], tracer.normal(0));
    let mut vertex = start();
    let mut escapes = 0;
    for _ in 0..bounces {
        let direction = Frame::new(vertex.normal()).world_from_local(square_to_cosine_hemisphere(random.square()));
        vertex = match tracer.accel.closest(vertex.origin(), direction, f32::INFINITY) {
            Some(hit) => {
                let normal = tracer.normal(hit.triangle);
                let side = if normal.dot(direction) > 0.0 { -normal } else { normal };
                tracer.start_on_triangle(hit.triangle, hit.barycentric, side)
            }
            None => {
                escapes += 1;
                start()
            }
        };
    }
    escapes
}

/// A number whose logarithm is uniform between those of the two powers of ten.
pub(super) fn of_any_size(random: &mut Random, low: f32, high: f32) -> f32 {
    10.0_f32.powf(low + (high - low) * random.unit())
}

#[test]
fn shapes_are_closed() {
    for shape in [Shape::cube(), Shape::icosphere(0), Shape::icosphere(2)] {
        let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
        for [a, b, c] in &shape.triangles {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*a.min(b), *a.max(b))).or_default() += 1;
            }
        }
        assert!(edges.values().all(|&count| count == 2), "{} triangles", shape.triangles.len());
    }
}

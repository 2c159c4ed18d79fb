//! A mesh with the UV1 that it was given: which vertices of the source it copies, and how they make triangles.

use super::charts::UnwrapMethod;
use super::pack::{Boxed, Packed};
use super::surface::Surface;
use crate::artefact::{MeshHash, MeshLayout};
use crate::scene::{Indices, Mesh, Topology};
use glam::Vec2;

/// A mesh with a UV1 of its own. Its triangles are those of the source, in the source's order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaidOutMesh {
    /// Index into [`Scene::meshes`](crate::scene::Scene::meshes) of the scene that was baked.
    pub source: usize,
    /// What that mesh is known by when a game is to show this one in its place.
    pub hash: MeshHash,
    /// Per vertex: the vertex of the source that it copies. Ascending, but for triangles without area.
    pub vertices: Vec<u32>,
    /// Per vertex: lightmap coordinates in the unit square; v grows downwards as in glTF.
    pub uv1: Vec<Vec2>,
    /// A triangle list.
    pub indices: Vec<u32>,
    /// How many charts it has.
    pub charts: u32,
    /// How they were made.
    pub method: UnwrapMethod,
}

impl LaidOutMesh {
    /// Puts a mesh together from charts in their places.
    pub(super) fn new(source: &Mesh, surface: &Surface, charts: &[Boxed], packed: &Packed) -> Self {
        let triangles: Vec<[u32; 3]> = source.triangles().collect();
        let mut corners: Vec<Corner> = Vec::with_capacity(3 * surface.len());
        let mut places: Vec<Vec2> = Vec::new();
        for (index, Boxed { chart, .. }) in charts.iter().enumerate() {
            let first = places.len() as u32;
            places.extend(packed.uv1(index, chart));
            for (&triangle, points) in chart.triangles.iter().zip(&chart.corners) {
                let number = surface.source[triangle as usize];
                for corner in 0..3 {
                    let vertex = triangles[number as usize][corner];
                    corners.push(Corner { vertex, place: first + points[corner], slot: 3 * number + corner as u32 });
                }
            }
        }
        corners.sort_unstable();
        let mut mesh = Self {
            hash: source.hash(),
            indices: vec![u32::MAX; 3 * triangles.len()],
            charts: charts.len() as u32,
            ..Self::default()
        };
        let mut last = None;
        for corner in corners {
            if last != Some((corner.vertex, corner.place)) {
                last = Some((corner.vertex, corner.place));
                mesh.vertices.push(corner.vertex);
                mesh.uv1.push(places[corner.place as usize]);
            }
            mesh.indices[corner.slot as usize] = mesh.vertices.len() as u32 - 1;
        }
        mesh.add_flat(&triangles);
        mesh
    }

    /// Adds the triangles without area: each in one point of UV1, so that it covers no texel of anything else.
    fn add_flat(&mut self, triangles: &[[u32; 3]]) {
        let ordered = self.vertices.len();
        for (number, corners) in triangles.iter().enumerate() {
            if self.indices[3 * number] != u32::MAX {
                continue;
            }
            let known = corners.map(|vertex| self.vertices[..ordered].binary_search(&vertex).ok());
            let place = known.into_iter().flatten().next().map_or(Vec2::ZERO, |index| self.uv1[index]);
            for corner in 0..3 {
                let index = known[corner].filter(|&index| self.uv1[index] == place).unwrap_or_else(|| {
                    self.vertices.push(corners[corner]);
                    self.uv1.push(place);
                    self.vertices.len() - 1
                });
                self.indices[3 * number + corner] = index as u32;
            }
        }
    }

    /// The mesh, from its source.
    pub(super) fn build(&self, source: &Mesh) -> Mesh {
        fn taken<T: Copy>(vertices: &[u32], from: &[T]) -> Vec<T> {
            vertices.iter().map(|&vertex| from[vertex as usize]).collect()
        }
        let vertices = &self.vertices;
        Mesh {
            name: source.name.clone(),
            topology: Topology::TriangleList,
            indices: Indices::U32(self.indices.clone()),
            positions: taken(vertices, &source.positions),
            normals: source.normals.as_ref().map(|normals| taken(vertices, normals)),
            uv0: source.uv0.as_ref().map(|uv0| taken(vertices, uv0)),
            uv1: Some(self.uv1.clone()),
            colours: source.colours.as_ref().map(|colours| taken(vertices, colours)),
            tangents: source.tangents.as_ref().map(|tangents| taken(vertices, tangents)),
        }
    }
}

impl From<&LaidOutMesh> for MeshLayout {
    fn from(mesh: &LaidOutMesh) -> Self {
        Self {
            hash: mesh.hash,
            vertices: mesh.vertices.clone(),
            uv1: mesh.uv1.iter().map(Vec2::to_array).collect(),
            indices: mesh.indices.clone(),
        }
    }
}

/// A corner of a triangle, ordered by what makes it a vertex of its own.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Corner {
    vertex: u32,
    /// Its point among those of all charts.
    place: u32,
    /// Where its index goes.
    slot: u32,
}

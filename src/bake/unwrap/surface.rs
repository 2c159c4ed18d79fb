//! A mesh as the unwrap sees it: its triangles with an area, in the shape that they have in the world, and which of
//! them go on across an edge.
//!
//! Vertices are told apart by place, not by number: exporters split them for normals and textures. An edge joins two
//! triangles that run along it in opposite directions and do not crease there. Where more than two meet, those whose
//! normals agree best are joined, so that the front of a thin sheet never goes on to its back, and of copies each
//! keeps to itself.

use super::shape::Shape;
use crate::scene::Mesh;
use glam::DVec3;
use std::collections::BTreeMap;

/// No half-edge.
pub(super) const NONE: u32 = u32::MAX;

/// Cosine of the largest angle between the normals of two triangles of one chart: 60°.
const CREASE: f64 = 0.5;

/// The same where the source has different shading normals on both sides: 40°.
const SPLIT_CREASE: f64 = 0.766;

/// Triangles along an edge in one direction beyond which none of them is joined.
const MOST_AT_EDGE: usize = 8;

/// The triangles of a mesh and how they hang together. Half-edge 3·t + k runs from corner k of triangle t to the next.
pub(super) struct Surface {
    /// Vertices of the source.
    pub(super) corners: Vec<[u32; 3]>,
    /// Number of each triangle in the source.
    pub(super) source: Vec<u32>,
    /// By vertex of the source: in the shape of the world, up to rotation and [`Shape::unit`].
    pub(super) points: Vec<DVec3>,
    /// Unit normals.
    pub(super) normals: Vec<DVec3>,
    /// In squares of the unit.
    pub(super) areas: Vec<f64>,
    /// The half-edge on the other side, or [`NONE`].
    pub(super) across: Vec<u32>,
}

impl Surface {
    pub(super) fn new(mesh: &Mesh, shape: &Shape) -> Self {
        let points: Vec<DVec3> = mesh.positions.iter().map(|&position| shape.apply(position)).collect();
        let mut surface =
            Self { corners: vec![], source: vec![], points, normals: vec![], areas: vec![], across: vec![] };
        for (number, corners) in mesh.triangles().enumerate() {
            let [a, b, c] = corners.map(|vertex| surface.points[vertex as usize]);
            let cross = (b - a).cross(c - a);
            let Some(normal) = cross.try_normalize() else {
                continue;
            };
            surface.corners.push(corners);
            surface.source.push(number as u32);
            surface.normals.push(normal);
            surface.areas.push(0.5 * cross.length());
        }
        surface.across = surface.joined(mesh);
        surface
    }

    /// Number of triangles.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Corners of a triangle.
    pub(super) fn triangle(&self, triangle: u32) -> [DVec3; 3] {
        self.corners[triangle as usize].map(|vertex| self.points[vertex as usize])
    }

    /// The middle of a triangle.
    pub(super) fn centre(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.triangle(triangle);
        (a + b + c) / 3.0
    }

    fn joined(&self, mesh: &Mesh) -> Vec<u32> {
        let places = places(mesh);
        let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * self.len());
        for (triangle, corners) in self.corners.iter().enumerate() {
            for corner in 0..3 {
                let [from, to] = [corner, (corner + 1) % 3].map(|corner| places[corners[corner] as usize]);
                edges.push((from.min(to), from.max(to), (3 * triangle + corner) as u32));
            }
        }
        edges.sort_unstable();
        let mut across = vec![NONE; edges.len()];
        for group in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|group| group.len() > 1) {
            self.join(mesh, &places, group, &mut across);
        }
        across
    }

    /// Joins the half-edges between two places.
    fn join(&self, mesh: &Mesh, places: &[u32], group: &[(u32, u32, u32)], across: &mut [u32]) {
        let runs_up = |half: u32| places[self.from(half) as usize] == group[0].0;
        let (up, down): (Vec<u32>, Vec<u32>) = group.iter().map(|edge| edge.2).partition(|&half| runs_up(half));
        if group[0].0 == group[0].1 || up.len().max(down.len()) > MOST_AT_EDGE {
            return;
        }
        let mut pairs = Vec::new();
        for &first in &up {
            for &second in &down {
                let cosine = self.normals[first as usize / 3].dot(self.normals[second as usize / 3]);
                if cosine > self.crease(mesh, first, second) {
                    pairs.push((cosine, first, second));
                }
            }
        }
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, first, second) in pairs {
            if across[first as usize] == NONE && across[second as usize] == NONE {
                across[first as usize] = second;
                across[second as usize] = first;
            }
        }
    }

    fn crease(&self, mesh: &Mesh, first: u32, second: u32) -> f64 {
        let is_split = mesh.normals.as_ref().is_none_or(|normals| {
            let same = |a: u32, b: u32| normals[a as usize].to_array() == normals[b as usize].to_array();
            !(same(self.from(first), self.to(second)) && same(self.to(first), self.from(second)))
        });
        if is_split { SPLIT_CREASE } else { CREASE }
    }

    /// The vertex at which a half-edge starts.
    pub(super) fn from(&self, half: u32) -> u32 {
        self.corners[half as usize / 3][half as usize % 3]
    }

    /// The vertex at which it ends.
    fn to(&self, half: u32) -> u32 {
        self.corners[half as usize / 3][(half as usize + 1) % 3]
    }
}

/// The place of each vertex, as a number that vertices in one place share.
fn places(mesh: &Mesh) -> Vec<u32> {
    let mut first = BTreeMap::new();
    let place = |(vertex, position): (usize, &glam::Vec3)| {
        // + 0 makes −0 the same place as 0.
        let bits = position.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
        *first.entry(bits).or_insert(vertex as u32)
    };
    mesh.positions.iter().enumerate().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Indices;
    use glam::{Affine3A, Vec3};

    fn joined(positions: Vec<Vec3>, indices: Vec<u32>) -> usize {
        let mesh = Mesh { positions, indices: Indices::U32(indices), ..Mesh::default() };
        let surface = Surface::new(&mesh, &Shape::new(&Affine3A::IDENTITY));
        surface.across.iter().filter(|&&half| half != NONE).count() / 2
    }

    #[test]
    fn edges_join_by_place_and_not_across_creases() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y].to_vec();
        assert_eq!(joined(square.clone(), vec![0, 1, 2, 0, 2, 3]), 1);
        let twice: Vec<Vec3> = square.iter().chain(&square).copied().collect();
        assert_eq!(joined(twice, vec![0, 1, 2, 4, 6, 7]), 1, "vertices in one place are one");
        assert_eq!(joined(square.clone(), vec![0, 1, 2, 0, 3, 2]), 0, "turned the other way");
        let mut bent = square.clone();
        bent[3] = Vec3::new(0.5, 0.5, 0.8);
        assert_eq!(joined(bent, vec![0, 1, 2, 0, 2, 3]), 0, "a right angle");
        assert_eq!(joined(square, vec![0, 1, 2, 0, 2, 3, 0, 2, 1, 0, 3, 2]), 2, "front and back by themselves");
    }
}

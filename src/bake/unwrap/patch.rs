//! Connected triangles that may become a chart, and a chart: the same triangles in the plane.

use super::surface::{NONE, Surface};
use glam::{DVec2, DVec3};

/// Triangles of a surface, and which of them go on into each other.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    /// Numbers in the surface, ascending.
    pub(super) triangles: Vec<u32>,
    /// By half-edge of the patch: the half-edge on the other side, or [`NONE`].
    pub(super) across: Vec<u32>,
}

/// A patch laid out in the plane, without flips and without overlaps. Lengths are those of the surface.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    /// Numbers in the surface.
    pub(super) triangles: Vec<u32>,
    /// By triangle and corner: which point it is.
    pub(super) corners: Vec<[u32; 3]>,
    pub(super) points: Vec<DVec2>,
}

impl Patch {
    /// The connected parts of a surface, by their first triangle.
    pub(super) fn whole(surface: &Surface) -> Vec<Self> {
        let all = Self { triangles: (0..surface.len() as u32).collect(), across: surface.across.clone() };
        let labels = all.connected(|_, _| true);
        all.split_by(&labels)
    }

    pub(super) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Triangles across the edges of one.
    pub(super) fn neighbours(&self, triangle: u32) -> impl Iterator<Item = u32> + '_ {
        let first = 3 * triangle as usize;
        self.across[first..first + 3].iter().filter(|&&half| half != NONE).map(|half| half / 3)
    }

    /// A label for each triangle: those that hang together by edges for which `joins` holds share one. Labels ascend
    /// with the first triangle.
    pub(super) fn connected(&self, joins: impl Fn(u32, u32) -> bool) -> Vec<u32> {
        let mut labels = vec![NONE; self.len()];
        let mut next = 0;
        let mut stack = Vec::new();
        for seed in 0..self.len() as u32 {
            if labels[seed as usize] != NONE {
                continue;
            }
            labels[seed as usize] = next;
            stack.push(seed);
            while let Some(triangle) = stack.pop() {
                for neighbour in self.neighbours(triangle) {
                    if labels[neighbour as usize] == NONE && joins(triangle, neighbour) {
                        labels[neighbour as usize] = next;
                        stack.push(neighbour);
                    }
                }
            }
            next += 1;
        }
        labels
    }

    /// Parts by label, in the order of the labels. Edges between parts are cut.
    pub(super) fn split_by(&self, labels: &[u32]) -> Vec<Self> {
        let count = labels.iter().map(|label| label + 1).max().unwrap_or(0) as usize;
        let mut parts = vec![Self { triangles: vec![], across: vec![] }; count];
        let mut places = Vec::with_capacity(self.len());
        for (&label, &triangle) in labels.iter().zip(&self.triangles) {
            let part = &mut parts[label as usize];
            places.push(part.triangles.len() as u32);
            part.triangles.push(triangle);
        }
        for (half, &other) in self.across.iter().enumerate() {
            let label = labels[half / 3];
            let joined = other != NONE && labels[other as usize / 3] == label;
            let moved = if joined { 3 * places[other as usize / 3] + other % 3 } else { NONE };
            parts[label as usize].across.push(moved);
        }
        parts.retain(|part| part.len() > 0);
        parts
    }

    /// Numbers for the corners, shared by those that meet across the edges for which `is_open` holds; and how many.
    pub(super) fn corners(&self, is_open: impl Fn(u32) -> bool) -> (Vec<[u32; 3]>, usize) {
        let mut parents: Vec<u32> = (0..3 * self.len() as u32).collect();
        for (half, &other) in self.across.iter().enumerate() {
            let half = half as u32;
            if other != NONE && half < other && is_open(half) {
                unite(&mut parents, half, after(other));
                unite(&mut parents, after(half), other);
            }
        }
        let mut numbers = vec![NONE; parents.len()];
        let mut count = 0;
        let mut corners = vec![[0; 3]; self.len()];
        for corner in 0..parents.len() as u32 {
            let root = find(&mut parents, corner) as usize;
            if numbers[root] == NONE {
                numbers[root] = count;
                count += 1;
            }
            corners[corner as usize / 3][corner as usize % 3] = numbers[root];
        }
        (corners, count as usize)
    }

    /// The sum of the normals by area, as a unit vector; and the smallest cosine with it.
    pub(super) fn cone(&self, surface: &Surface) -> (DVec3, f64) {
        let weighted = |&triangle: &u32| surface.areas[triangle as usize] * surface.normals[triangle as usize];
        let axis = self.triangles.iter().map(weighted).sum::<DVec3>().normalize_or_zero();
        let cosines = self.triangles.iter().map(|&triangle| surface.normals[triangle as usize].dot(axis));
        (axis, cosines.fold(1.0, f64::min))
    }
}

/// The next half-edge of the same triangle.
pub(super) fn after(half: u32) -> u32 {
    if half % 3 == 2 { half - 2 } else { half + 1 }
}

fn find(parents: &mut [u32], mut of: u32) -> u32 {
    while parents[of as usize] != of {
        let above = parents[parents[of as usize] as usize];
        parents[of as usize] = above;
        of = above;
    }
    of
}

fn unite(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parents, a), find(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}

impl Chart {
    /// Corners of each triangle in the plane.
    pub(super) fn flat(&self) -> impl Iterator<Item = [DVec2; 3]> + '_ {
        self.corners.iter().map(|corners| corners.map(|point| self.points[point as usize]))
    }
}

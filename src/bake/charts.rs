//! The charts of a lightmap: the pieces of an object that hang together in UV1. Texture filtering is right within a
//! chart and knows nothing of what lies beyond its border; so does every step that repairs texels.
//!
//! Two triangles belong to one chart if they share an edge, that is two corners whose places in the world and in UV1
//! are the same bits.

use super::atlas::Chart as Rectangle;
use crate::trace::Tracer;
use glam::{DVec2, Vec3};
use std::collections::HashMap;

/// Which chart each triangle of each receiver belongs to.
#[derive(Clone, Debug, Default)]
pub(super) struct Charts {
    /// By receiver and its triangle; numbers run through the whole bake.
    of: Vec<Vec<u32>>,
    /// How many there are.
    count: u32,
}

impl Charts {
    pub(super) fn new(tracer: &Tracer, rectangles: &[Rectangle<'_>]) -> Self {
        let mut charts = Self::default();
        for rectangle in rectangles {
            charts.add(tracer, rectangle);
        }
        charts
    }

    /// The chart of a receiver's triangle.
    pub(super) fn of(&self, receiver: u32, triangle: u32) -> u32 {
        self.of[receiver as usize][triangle as usize]
    }

    fn add(&mut self, tracer: &Tracer, rectangle: &Rectangle<'_>) {
        let triangles = rectangle.triangle_count();
        let mut corners = HashMap::new();
        let mut edges = HashMap::new();
        let mut sets = DisjointSets::new(triangles);
        for triangle in 0..triangles {
            let world = tracer.vertices(rectangle.receiver.first_triangle + triangle);
            let uv = rectangle.triangle(triangle);
            let corner = [0, 1, 2].map(|corner| {
                let next = corners.len() as u32;
                *corners.entry(corner_bits(world[corner], uv[corner])).or_insert(next)
            });
            for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(from, to)| (corner[from], corner[to])) {
                let first = *edges.entry((from.min(to), from.max(to))).or_insert(triangle);
                sets.join(first, triangle);
            }
        }
        let mut numbers = HashMap::new();
        let number = |triangle| {
            let next = self.count + numbers.len() as u32;
            *numbers.entry(sets.root(triangle)).or_insert(next)
        };
        let of = (0..triangles).map(number).collect();
        self.count += numbers.len() as u32;
        self.of.push(of);
    }
}

/// A corner's place in the world and in UV1.
fn corner_bits(position: Vec3, uv: DVec2) -> ([u32; 3], [u64; 2]) {
    // −0 and 0 are the same place.
    let [x, y, z] = (position + Vec3::ZERO).to_array().map(f32::to_bits);
    ([x, y, z], (uv + DVec2::ZERO).to_array().map(f64::to_bits))
}

/// Sets of numbers that are joined until they stand for the charts (Tarjan 1975, with path halving).
pub(super) struct DisjointSets(Vec<u32>);

impl DisjointSets {
    pub(super) fn new(count: u32) -> Self {
        Self((0..count).collect())
    }

    pub(super) fn root(&mut self, mut of: u32) -> u32 {
        while self.0[of as usize] != of {
            let parent = self.0[of as usize];
            self.0[of as usize] = self.0[parent as usize];
            of = self.0[of as usize];
        }
        of
    }

    pub(super) fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        // The smaller number stays, so that the outcome does not hang on the order.
        self.0[a.max(b) as usize] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_join_whatever_the_order() {
        for pairs in [[(0, 1), (2, 3), (1, 3)], [(3, 1), (1, 0), (3, 2)]] {
            let mut sets = DisjointSets::new(6);
            for (a, b) in pairs {
                sets.join(a, b);
            }
            let roots: Vec<u32> = (0..6).map(|number| sets.root(number)).collect();
            assert_eq!(roots, [0, 0, 0, 0, 4, 5]);
        }
    }
}

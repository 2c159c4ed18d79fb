//! The edges at which charts end, and where two of them meet in the world. Owns which edges are the same line in space;
//! does not ask whether the surface is smooth there, nor what stands on it.
//!
//! Pieces of a modular wall meet along parts of edges, in places that transforms have rounded differently. So every
//! edge is compared with those whose boxes a tree of boxes finds near it, and two make a joint where they run along
//! each other within a tolerance: the rounding of their coordinates, or a thousandth of a texel where that is more.

use super::super::lookup::DisplayedRect;
use super::tree::SegmentTree;
use crate::bake::BakeError;
use crate::bake::atlas::Chart as Rectangle;
use crate::bake::repair::Surroundings;
use crate::bake::workers::Workers;
use crate::scene::Instance;
use glam::{DVec2, DVec3, Vec3};
use std::collections::HashMap;

/// Share of a texel by which two edges may miss each other.
const TOLERANCE: f64 = 1e-3;

/// Roundings of a coordinate, in units of its last place, by which two edges may miss each other.
const ROUNDINGS: f64 = 4.0;

/// Edges that run along each other for less than this many tolerances only touch.
const LEAST_OVERLAP: f64 = 4.0;

/// An edge at which a chart ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Border {
    /// The object, as its place in the list of receivers.
    pub(super) receiver: u32,
    /// The triangle within the object.
    pub(super) triangle: u32,
    /// The corner at which the edge starts; it ends at the next.
    pub(super) corner: usize,
    /// Its ends in the traced frame [m].
    pub(super) ends: [DVec3; 2],
    /// Its ends on the page, as displayed [texels].
    pub(super) places: [DVec2; 2],
    /// Side of a texel in the world [m].
    pub(super) texel: f64,
    /// How far off the true edge it may lie [m].
    pub(super) tolerance: f64,
}

/// A stretch along which two edges meet: by their numbers, in parts of the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub(super) edges: [u32; 2],
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Border {
    fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// Texels that the edge is long on its page.
    pub(super) fn texels(&self) -> f64 {
        self.places[0].distance(self.places[1])
    }

    /// The point of the edge nearest to another, in parts of the edge.
    pub(super) fn parameter(&self, point: DVec3) -> f64 {
        let along = self.ends[1] - self.ends[0];
        (point - self.ends[0]).dot(along) / along.length_squared()
    }

    /// The stretch along which another edge runs, in parts of this one.
    fn overlap(&self, other: &Self) -> Option<(f64, f64)> {
        let length = self.length();
        let [a, b] = other.ends.map(|end| self.parameter(end));
        let (from, to) = (a.min(b).max(0.0), a.max(b).min(1.0));
        let tolerance = self.tolerance.max(other.tolerance);
        let overlap = (to - from) * length;
        if overlap.is_nan() || overlap <= LEAST_OVERLAP * tolerance {
            return None;
        }
        let is_near = [from, to].iter().all(|&at| {
            let here = self.ends[0].lerp(self.ends[1], at);
            let there = other.ends[0].lerp(other.ends[1], other.parameter(here).clamp(0.0, 1.0));
            here.distance(there) <= tolerance
        });
        is_near.then_some((from, to))
    }
}

/// The edges at which charts end, object by object and triangle by triangle.
pub(super) fn borders(place: &Surroundings<'_>, workers: &Workers<'_>) -> Result<Vec<Border>, BakeError> {
    let receivers: Vec<u32> = (0..place.atlas.charts.len() as u32).collect();
    let of_each = workers.gather_quietly(&receivers, |&receiver, cancel| {
        (!cancel.is_cancelled()).then(|| borders_of(place, receiver))
    })?;
    Ok(of_each.into_iter().flatten().collect())
}

/// The edges of one object that no second triangle shares in the world and on the page.
fn borders_of(place: &Surroundings<'_>, receiver: u32) -> Vec<Border> {
    let rectangle = &place.atlas.charts[receiver as usize];
    let rounding = rounding(place, rectangle);
    let mut count: HashMap<[u32; 2], u32> = HashMap::new();
    let mut numbers = HashMap::new();
    let corners: Vec<[u32; 3]> = (0..rectangle.triangle_count())
        .map(|triangle| {
            let uv = rectangle.triangle(triangle);
            let world = place.tracer.vertices(rectangle.receiver.first_triangle + triangle);
            [0, 1, 2].map(|corner| {
                let next = numbers.len() as u32;
                *numbers.entry(bits(world[corner], uv[corner])).or_insert(next)
            })
        })
        .collect();
    let edge = |corners: &[u32; 3], corner: usize| {
        let (a, b) = (corners[corner], corners[(corner + 1) % 3]);
        [a.min(b), a.max(b)]
    };
    for corners in &corners {
        for corner in 0..3 {
            *count.entry(edge(corners, corner)).or_default() += 1;
        }
    }
    let rect = place.rect(receiver);
    let mut borders = Vec::new();
    for (triangle, corners) in corners.iter().enumerate() {
        for corner in (0..3).filter(|&corner| count[&edge(corners, corner)] == 1) {
            borders.extend(border(place, &rect, [receiver, triangle as u32], corner, rounding));
        }
    }
    borders
}

/// One edge; `None` where it has no length in the world or its triangle no area on the page.
fn border(
    place: &Surroundings<'_>,
    rect: &DisplayedRect,
    [receiver, triangle]: [u32; 2],
    corner: usize,
    rounding: f64,
) -> Option<Border> {
    let rectangle = &place.atlas.charts[receiver as usize];
    let number = rectangle.receiver.first_triangle + triangle;
    let world = place.tracer.vertices(number).map(Vec3::as_dvec3);
    let texels = rectangle.triangle(triangle);
    let area = 0.5 * (texels[1] - texels[0]).perp_dot(texels[2] - texels[0]).abs();
    let texel = (place.tracer.area(number) / area).sqrt();
    let next = (corner + 1) % 3;
    let is_sound = texel.is_finite() && world[corner] != world[next];
    let size = DVec2::new(rectangle.size[0].into(), rectangle.size[1].into());
    is_sound.then(|| Border {
        receiver,
        triangle,
        corner,
        ends: [world[corner], world[next]],
        places: [texels[corner], texels[next]].map(|texel| rect.point(texel / size)),
        texel,
        tolerance: rounding.max(TOLERANCE * texel),
    })
}

/// How far the world's f32 may have moved an object's vertices [m].
fn rounding(place: &Surroundings<'_>, rectangle: &Rectangle<'_>) -> f64 {
    let Instance { mesh, world_from_local, .. } = &place.scene.instances[rectangle.receiver.instance];
    let farthest = place.scene.meshes[*mesh].positions.iter().fold(0.0_f32, |farthest, &position| {
        // What is not finite belongs to no triangle.
        farthest.max(world_from_local.transform_point3(position).abs().max_element())
    });
    let farthest = if farthest.is_finite() { farthest } else { 0.0 };
    ROUNDINGS * f64::from(f32::EPSILON) * f64::from(farthest)
}

/// A corner's place in the world and on the page.
fn bits(position: Vec3, uv: DVec2) -> ([u32; 3], [u64; 2]) {
    // −0 and 0 are the same place.
    ((position + Vec3::ZERO).to_array().map(f32::to_bits), (uv + DVec2::ZERO).to_array().map(f64::to_bits))
}

/// All stretches along which two edges meet, in the order of the edges.
pub(super) fn joints(borders: &[Border], workers: &Workers<'_>) -> Result<Vec<Joint>, BakeError> {
    let segments: Vec<[DVec3; 2]> = borders.iter().map(|border| border.ends).collect();
    let tree = SegmentTree::new(&segments);
    let farthest = borders.iter().map(|border| border.tolerance).fold(0.0, f64::max);
    let numbers: Vec<u32> = (0..borders.len() as u32).collect();
    let of_each = workers.gather_quietly(&numbers, |&number, cancel| {
        let border = &borders[number as usize];
        let mut found = Vec::new();
        tree.near(border.ends, farthest, |other| {
            if other <= number {
                return;
            }
            if let Some((from, to)) = border.overlap(&borders[other as usize]) {
                found.push(Joint { edges: [number, other], from, to });
            }
        });
        found.sort_unstable_by_key(|joint: &Joint| joint.edges);
        (!cancel.is_cancelled()).then_some(found)
    })?;
    Ok(of_each.into_iter().flatten().collect())
}

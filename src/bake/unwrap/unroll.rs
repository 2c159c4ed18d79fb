//! Surfaces that bend without stretching, as the sides of cylinders and cones, unrolled into the plane.
//!
//! Triangle by triangle, each across an edge of one that lies there, nearest to the first one first. Where two that
//! meet on the surface come to lie apart, the sheet is cut: a tube becomes a strip.

use super::flatten::isometric;
use super::patch::{Chart, Patch, after};
use super::surface::{NONE, Surface};
use super::work::Work;
use glam::DVec2;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::TAU;

/// How far the angles around all inner points together may be from whole turns [rad]: a sheet that bends both ways can
/// be unrolled only in gores. It is rounding for one that bends one way.
const DEFECT: f64 = 0.3;

/// How far apart two copies of a point may come to lie and still be one, over the size of the chart.
const APART: f64 = 2e-4;

/// A cut that opens by less than this is a slit [rad]: its two sides are so near each other on the page that there is
/// no room between them for what lies beyond either. A tube's ends, on the far sides of the strip, are none.
const NARROW: f64 = 0.5;

/// Unrolls a patch; `None` if it bends both ways, if it would have a slit, or if there is no work left.
pub(super) fn unroll(surface: &Surface, patch: &Patch, work: &mut Work<'_>) -> Option<Chart> {
    if !work.takes(8 * patch.len() as u64) || !bends_one_way(surface, patch) {
        return None;
    }
    let (flat, is_tree) = unfolded(surface, patch);
    let (low, high) = flat
        .iter()
        .flatten()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &point| (low.min(point), high.max(point)));
    let slack = APART * (high - low).max_element();
    let place = |half: u32| flat[half as usize / 3][half as usize % 3];
    let is_joined = |half: u32| {
        let other = patch.across[half as usize];
        let is_near = |a: u32, b: u32| (place(a) - place(b)).length() <= slack;
        is_tree[half as usize] || (is_near(half, after(other)) && is_near(after(half), other))
    };
    let is_slit = |half: u32| {
        let other = patch.across[half as usize];
        let edge = |half: u32| [place(half), place(after(half))];
        other != NONE && !is_joined(half) && is_slit(edge(half), edge(other))
    };
    if (0..3 * patch.len() as u32).any(is_slit) {
        return None;
    }
    let (corners, count) = patch.corners(is_joined);
    let mut points = vec![DVec2::ZERO; count];
    for (corners, flat) in corners.iter().zip(&flat).rev() {
        for corner in 0..3 {
            points[corners[corner] as usize] = flat[corner];
        }
    }
    Some(Chart { triangles: patch.triangles.clone(), corners, points })
}

/// Whether the two copies of an edge, each with its triangle on the left, have a narrow gap between them.
fn is_slit(first: [DVec2; 2], second: [DVec2; 2]) -> bool {
    let along = first[1] - first[0];
    let back = second[0] - second[1];
    let aside = 0.5 * (second[0] + second[1] - first[0] - first[1]);
    along.perp_dot(aside) < 0.0 && crate::math::Portable::atan2(along.perp_dot(back).abs(), along.dot(back)) < NARROW
}

/// Whether the angles around the inner points make whole turns.
fn bends_one_way(surface: &Surface, patch: &Patch) -> bool {
    let (corners, count) = patch.corners(|_| true);
    let mut is_inner = vec![true; count];
    let mut angles = vec![0.0; count];
    for (triangle, corners) in corners.iter().enumerate() {
        let flat = isometric(surface.triangle(patch.triangles[triangle]));
        for corner in 0..3 {
            let [next, last] = [1, 2].map(|step| flat[(corner + step) % 3] - flat[corner]);
            angles[corners[corner] as usize] += crate::math::Portable::atan2(next.perp_dot(last), next.dot(last));
            if patch.across[3 * triangle + corner] == NONE {
                is_inner[corners[corner] as usize] = false;
                is_inner[corners[(corner + 1) % 3] as usize] = false;
            }
        }
    }
    let defects = angles.iter().zip(&is_inner).filter(|(_, inner)| **inner).map(|(angle, _)| (angle - TAU).abs());
    let (sum, most) = defects.fold((0.0, 0.0_f64), |(sum, most), defect| (sum + defect, most.max(defect)));
    // One point may be the tip of a cone.
    sum - most <= DEFECT
}

/// Every triangle in the plane, and the half-edges across which they were laid.
fn unfolded(surface: &Surface, patch: &Patch) -> (Vec<[DVec2; 3]>, Vec<bool>) {
    let count = patch.len();
    let mut flat = vec![[DVec2::ZERO; 3]; count];
    let mut is_laid = vec![false; count];
    let mut is_tree = vec![false; 3 * count];
    let centre = |triangle: u32| surface.centre(patch.triangles[triangle as usize]);
    // By distance along the surface, whose bits order like itself, from the triangle that is laid first.
    let mut queue = BinaryHeap::from([(Reverse(0_u64), 0_u32, NONE)]);
    while let Some((Reverse(distance), triangle, half)) = queue.pop() {
        if std::mem::replace(&mut is_laid[triangle as usize], true) {
            continue;
        }
        let own = isometric(surface.triangle(patch.triangles[triangle as usize]));
        flat[triangle as usize] = own;
        if half != NONE {
            let other = patch.across[half as usize];
            let place = |half: u32| flat[half as usize / 3][half as usize % 3];
            let ends = [place(after(half)), place(half)];
            flat[triangle as usize] = laid(own, other as usize % 3, ends);
            is_tree[half as usize] = true;
            is_tree[other as usize] = true;
        }
        for side in 3 * triangle..3 * triangle + 3 {
            let other = patch.across[side as usize];
            if other != NONE && !is_laid[other as usize / 3] {
                let way = f64::from_bits(distance) + (centre(other / 3) - centre(triangle)).length();
                queue.push((Reverse(way.to_bits()), other / 3, side));
            }
        }
    }
    (flat, is_tree)
}

/// A triangle moved so that its edge from a corner to the next lies on two ends.
pub(super) fn laid(own: [DVec2; 3], corner: usize, [from, to]: [DVec2; 2]) -> [DVec2; 3] {
    let along = own[(corner + 1) % 3] - own[corner];
    let wanted = to - from;
    let turn = DVec2::new(along.dot(wanted), along.perp_dot(wanted)).normalize_or(DVec2::X);
    let mut moved = own.map(|point| from + turn.rotate(point - own[corner]));
    moved[corner] = from;
    moved[(corner + 1) % 3] = to;
    moved
}

#[cfg(test)]
mod tests {
    use super::super::flatten::stretch;
    use super::super::shape::Shape;
    use super::*;
    use crate::bake::CancelToken;
    use crate::math::Portable;
    use crate::scene::{Indices, Mesh};
    use glam::{Affine3A, Vec3};

    /// Two rings of vertices around an axis.
    fn rings(count: u32, [lower, upper]: [f64; 2]) -> Surface {
        let point = |index: u32| {
            let (radius, height) = if index < count { (lower, 0.0) } else { (upper, 1.0) };
            let (sin, cos) = Portable::sin_cos(TAU * f64::from(index % count) / f64::from(count));
            Vec3::new((radius * cos) as f32, height, (-radius * sin) as f32)
        };
        let side = |index: u32| {
            let next = (index + 1) % count;
            [index, next, count + next, index, count + next, count + index]
        };
        let mesh = Mesh {
            positions: (0..2 * count).map(point).collect(),
            indices: Indices::U32((0..count).flat_map(side).collect()),
            ..Mesh::default()
        };
        Surface::new(&mesh, &Shape::new(&Affine3A::IDENTITY))
    }

    /// A flat cone opens by too little to be cut, a steep one does not.
    #[test]
    fn a_flat_cone_is_not_slit() {
        for (radius, is_unrolled) in [(5.0, false), (1.0, true)] {
            let surface = rings(24, [radius, 0.0]);
            let patches = Patch::whole(&surface);
            let cancel = CancelToken::default();
            let chart = unroll(&surface, &patches[0], &mut Work::new(surface.len(), &cancel));
            assert_eq!(chart.is_some(), is_unrolled, "{radius}");
        }
    }

    #[test]
    fn tubes_and_cones_come_off_in_one_piece() {
        for radii in [[0.5, 0.5], [1.0, 0.3], [1.0, 0.0]] {
            let surface = rings(24, radii);
            let patches = Patch::whole(&surface);
            assert_eq!(patches.len(), 1);
            let cancel = CancelToken::default();
            let chart = unroll(&surface, &patches[0], &mut Work::new(surface.len(), &cancel)).unwrap();
            for (&triangle, flat) in chart.triangles.iter().zip(chart.flat()) {
                let stretch = stretch(isometric(surface.triangle(triangle)), flat);
                assert!(stretch < 1.0 + 1e-3, "{radii:?}: {stretch}");
            }
            let count = if radii[1] == 0.0 { 26 } else { 50 };
            assert_eq!(chart.points.len(), count, "cut once, {radii:?}");
        }
    }
}

//! The simple unwrap, which holds for every mesh and takes a few visits of each triangle: a chart for each planar
//! region, one for every two triangles that are left beside each other, and one for each that is left alone.
//!
//! Two triangles on both sides of a straight line never lie over each other, and keep their lengths. The longest edges
//! find their pairs first, so that the right triangles of a quad come to lie in one rectangle.

use super::flatten::{Limits, alone, along, is_sound, isometric};
use super::patch::{Chart, Patch, after};
use super::surface::{NONE, Surface};
use super::unroll::laid;
use super::work::Work;
use crate::bake::CancelToken;
use std::cmp::Reverse;

/// Cosine within which neighbours lie in one plane.
const PLANAR: f64 = 1.0 - 1e-8;

/// Cosine with their mean within which the normals of a planar region lie.
const LEVEL: f64 = 0.999;

/// The charts of a patch; `None` once cancelled.
pub(super) fn simple(surface: &Surface, patch: &Patch, cancel: &CancelToken) -> Option<Vec<Chart>> {
    let normal = |triangle: u32| surface.normals[patch.triangles[triangle as usize] as usize];
    let labels = patch.connected(|a, b| normal(a).dot(normal(b)) > PLANAR);
    let mut charts = Vec::new();
    let mut is_left = Vec::new();
    for region in patch.split_by(&labels) {
        if cancel.is_cancelled() {
            return None;
        }
        let chart = planar(surface, &region, cancel);
        is_left.push(chart.is_none());
        charts.extend(chart);
    }
    charts.extend(in_pairs(surface, patch, |triangle| is_left[labels[triangle as usize] as usize]));
    (!cancel.is_cancelled()).then_some(charts)
}

/// A region as it is seen against its normal, if it is flat and lies nowhere over itself.
fn planar(surface: &Surface, region: &Patch, cancel: &CancelToken) -> Option<Chart> {
    let (axis, least) = region.cone(surface);
    if region.len() == 1 || least < LEVEL {
        return None;
    }
    let seen = along(surface, region, axis);
    is_sound(surface, &seen, &Limits::ALONE, &mut Work::new(region.len(), cancel)).then_some(seen)
}

/// The triangles of a patch for which `is_left` holds, by two where that can be.
fn in_pairs(surface: &Surface, patch: &Patch, is_left: impl Fn(u32) -> bool) -> Vec<Chart> {
    let mut is_left: Vec<bool> = (0..patch.len() as u32).map(is_left).collect();
    let length = |half: u32| {
        let corners = surface.triangle(patch.triangles[half as usize / 3]);
        (corners[after(half) as usize % 3] - corners[half as usize % 3]).length()
    };
    let is_open = |&half: &u32| {
        let other = patch.across[half as usize];
        other != NONE && half < other && is_left[half as usize / 3] && is_left[other as usize / 3]
    };
    let halves = (0..patch.across.len() as u32).filter(is_open);
    let mut edges: Vec<(Reverse<u64>, u32)> = halves.map(|half| (Reverse(length(half).to_bits()), half)).collect();
    edges.sort_unstable();
    let mut charts = Vec::new();
    for (_, half) in edges {
        let pair = [half, patch.across[half as usize]];
        if pair.iter().all(|&half| is_left[half as usize / 3]) {
            pair.iter().for_each(|&half| is_left[half as usize / 3] = false);
            charts.push(hinged(surface, patch, pair));
        }
    }
    let rest = patch.triangles.iter().zip(is_left).filter(|(_, is_left)| *is_left);
    charts.extend(rest.map(|(&triangle, _)| alone(surface, triangle)));
    charts
}

/// Two triangles on both sides of an edge, laid into one plane.
fn hinged(surface: &Surface, patch: &Patch, [half, other]: [u32; 2]) -> Chart {
    let triangles = [half, other].map(|half| patch.triangles[half as usize / 3]);
    let [first, second] = triangles.map(|triangle| isometric(surface.triangle(triangle)));
    let [from, to] = [half, after(half)].map(|half| half as usize % 3);
    let corner = other as usize % 3;
    let second = laid(second, corner, [first[to], first[from]]);
    let mut numbers = [3; 3];
    numbers[corner] = to as u32;
    numbers[(corner + 1) % 3] = from as u32;
    let mut points = first.to_vec();
    points.push(second[(corner + 2) % 3]);
    Chart { triangles: triangles.to_vec(), corners: vec![[0, 1, 2], numbers], points }
}

#[cfg(test)]
mod tests {
    use super::super::flatten::stretch;
    use super::super::overlap::Overlaps;
    use super::super::shape::Shape;
    use super::super::shapes;
    use super::*;
    use crate::scene::{Indices, Mesh};
    use glam::{Affine3A, DVec2, Vec3};

    /// The simple charts of a mesh, each triangle in one of them, flat, and over no other.
    fn charts(mesh: &Mesh) -> Vec<Chart> {
        let surface = Surface::new(mesh, &Shape::new(&Affine3A::IDENTITY));
        let cancel = CancelToken::default();
        let charts: Vec<Chart> =
            Patch::whole(&surface).iter().flat_map(|patch| simple(&surface, patch, &cancel).unwrap()).collect();
        let mut triangles: Vec<u32> = charts.iter().flat_map(|chart| chart.triangles.iter().copied()).collect();
        triangles.sort_unstable();
        assert!(triangles.into_iter().eq(0..surface.len() as u32), "{}: every triangle once", mesh.name);
        for chart in &charts {
            let flat: Vec<[DVec2; 3]> = chart.flat().collect();
            let reach = chart.points.iter().map(|point| point.length()).fold(0.0, f64::max);
            assert!(Overlaps::find(&flat, 1e-7 * reach, &cancel).is_empty(), "{}", mesh.name);
            for (&triangle, flat) in chart.triangles.iter().zip(flat) {
                let stretch = stretch(isometric(surface.triangle(triangle)), flat);
                assert!(stretch < 1.01, "{}: {stretch}", mesh.name);
            }
        }
        charts
    }

    #[test]
    fn meshes_of_every_kind_come_apart_into_few_charts() {
        let cases = [
            (shapes::chair(), 36),
            (shapes::stairs(10), 60),
            (shapes::tube(32), 32),
            (shapes::arch(), 2 + 2 * 24),
            (shapes::cuboid("box", Vec3::ZERO, Vec3::ONE, 8), 6),
            (shapes::clutter(100), 100),
            (shapes::crates(4, 3), 24),
            // Quads of which none is quite flat, in two triangles each; and those at the poles.
            (shapes::sphere(32, 16), 32 * 16),
            (shapes::torus(48, 24), 48 * 24 + 48),
            (shapes::moebius(48), 48 * 3),
            (shapes::terrain(20), 20 * 20 + 20),
            (shapes::bumpy(64, 32), 64 * 32 + 200),
            (shapes::needles(300), 1),
        ];
        for (mesh, most) in cases {
            let charts = charts(&mesh);
            println!("{} {} of {most}", mesh.name, charts.len());
            assert!(charts.len() <= most, "{}: {}", mesh.name, charts.len());
        }
    }

    #[test]
    fn a_bent_quad_is_two_triangles_in_one_rectangle() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 0.2)];
        let mesh = Mesh { positions, indices: Indices::U32(vec![0, 1, 2, 0, 2, 3]), ..Mesh::default() };
        let charts = charts(&mesh);
        assert_eq!(charts.len(), 1);
        assert_eq!((charts[0].points.len(), &charts[0].corners), (4, &vec![[0, 1, 2], [0, 2, 3]]));
    }
}

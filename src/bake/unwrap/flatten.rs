//! A patch laid out in the plane, if it can be: seen along its normals, unrolled, or relaxed.
//!
//! A layout counts only if no triangle is turned over, no two lie over each other and none is stretched much. What
//! fails is for `split` to part.

use super::overlap::Overlaps;
use super::patch::{Chart, Patch};
use super::relax::relax;
use super::surface::Surface;
use super::unroll::unroll;
use super::work::Work;
use crate::bake::CancelToken;
use glam::{DVec2, DVec3};

/// Stretch up to which a layout is taken: 1 where lengths are kept, and the larger of the factor and its inverse where
/// they are not.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Mean over the area.
    mean: f64,
    /// The worst triangle that counts.
    worst: f64,
    /// Cosine between a normal and the mean up to which relaxing is tried.
    open: f64,
}

impl Limits {
    /// Of a patch that would be parted otherwise.
    pub(super) const ALONE: Self = Self { mean: 1.2, worst: 1.7, open: 0.2 };
    /// Of two charts put together, which are sound without each other.
    pub(super) const MERGED: Self = Self { mean: 1.1, worst: 1.5, open: 0.3 };
}

/// Share of the area that may be stretched more: slivers, and the tip of a cone.
const BAD_SHARE: f64 = 1e-3;

/// Cosine between a normal and the mean up to which a patch is seen along the mean without being relaxed: 15°.
const FLAT: f64 = 0.966;

/// Triangles beyond which a patch is parted rather than relaxed.
const MOST_RELAXED: usize = 400_000;

/// Lays a patch out; `None` if it must be parted.
pub(super) fn flatten(surface: &Surface, patch: &Patch, limits: &Limits, work: &mut Work<'_>) -> Option<Chart> {
    if !work.takes(2 * patch.len() as u64) {
        return None;
    }
    let (axis, least) = patch.cone(surface);
    if least > FLAT {
        let seen = along(surface, patch, axis);
        if is_sound(surface, &seen, limits, work) {
            return Some(seen);
        }
    }
    if let Some(unrolled) = unroll(surface, patch, work)
        && is_sound(surface, &unrolled, limits, work)
    {
        return Some(unrolled);
    }
    if least < limits.open || patch.len() > MOST_RELAXED {
        return None;
    }
    let relaxed = relax(surface, along(surface, patch, axis), work)?;
    is_sound(surface, &relaxed, limits, work).then_some(relaxed)
}

/// A triangle by itself, lengths kept.
pub(super) fn alone(surface: &Surface, triangle: u32) -> Chart {
    let points = isometric(surface.triangle(triangle)).to_vec();
    Chart { triangles: vec![triangle], corners: vec![[0, 1, 2]], points }
}

/// A triangle in the plane: its first corner at the origin, the second on the first axis.
pub(super) fn isometric([a, b, c]: [DVec3; 3]) -> [DVec2; 3] {
    let along = b - a;
    let length = along.length();
    let x = along.dot(c - a) / length;
    [DVec2::ZERO, DVec2::new(length, 0.0), DVec2::new(x, along.cross(c - a).length() / length)]
}

/// A patch as seen against an axis.
pub(super) fn along(surface: &Surface, patch: &Patch, axis: DVec3) -> Chart {
    let (corners, count) = patch.corners(|_| true);
    let right = axis.any_orthonormal_vector();
    let up = axis.cross(right);
    let mut points = vec![DVec2::ZERO; count];
    for (corners, &triangle) in corners.iter().zip(&patch.triangles) {
        for (&corner, point) in corners.iter().zip(surface.triangle(triangle)) {
            points[corner as usize] = DVec2::new(right.dot(point), up.dot(point));
        }
    }
    scaled(surface, Chart { triangles: patch.triangles.clone(), corners, points })
}

/// The chart with the area of its surface.
pub(super) fn scaled(surface: &Surface, mut chart: Chart) -> Chart {
    let area: f64 = chart.triangles.iter().map(|&triangle| surface.areas[triangle as usize]).sum();
    let flat: f64 = chart.flat().map(double_area).sum::<f64>() / 2.0;
    if flat > 0.0 {
        let scale = (area / flat).sqrt();
        chart.points.iter_mut().for_each(|point| *point *= scale);
    }
    chart
}

fn double_area([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Whether nothing is turned over, stretched much, or over each other.
pub(super) fn is_sound(surface: &Surface, chart: &Chart, limits: &Limits, work: &mut Work<'_>) -> bool {
    if !chart.points.iter().all(|point| point.is_finite()) {
        return false;
    }
    let (mut sum, mut bad, mut area) = (0.0, 0.0, 0.0);
    for (&triangle, flat) in chart.triangles.iter().zip(chart.flat()) {
        let stretch = stretch(isometric(surface.triangle(triangle)), flat);
        let weight = surface.areas[triangle as usize];
        // A sliver's angles are rounding; it must only not be turned over by more than that.
        let is_lost = stretch.is_infinite() && double_area(flat) < -1e-12 * weight.max(surface_scale(flat));
        if is_lost {
            return false;
        }
        area += weight;
        sum += weight * stretch.min(10.0);
        bad += if stretch > limits.worst { weight } else { 0.0 };
    }
    if sum > limits.mean * area || bad > BAD_SHARE * area {
        return false;
    }
    work.takes(4 * chart.triangles.len() as u64) && !folds(chart, work.token())
}

fn surface_scale([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).length_squared().max((c - a).length_squared())
}

/// Whether triangles of a chart lie over each other.
fn folds(chart: &Chart, cancel: &CancelToken) -> bool {
    if chart.triangles.len() == 1 {
        return false;
    }
    let (low, high) = chart
        .points
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &point| (low.min(point), high.max(point)));
    let flat: Vec<[DVec2; 3]> = chart.flat().collect();
    !Overlaps::find(&flat, 1e-7 * (high - low).max_element(), cancel).is_empty()
}

/// By how much lengths change between two layouts of a triangle: the largest factor or inverse. Infinite where the
/// second is turned over.
pub(super) fn stretch(from: [DVec2; 3], to: [DVec2; 3]) -> f64 {
    let [p, q] = [from[1] - from[0], from[2] - from[0]];
    let [r, s] = [to[1] - to[0], to[2] - to[0]];
    let determinant = p.perp_dot(q);
    let along_x = (r * q.y - s * p.y) / determinant;
    let along_y = (s * p.x - r * q.x) / determinant;
    let turned = along_x.perp_dot(along_y);
    if turned.is_nan() || turned <= 0.0 {
        return f64::INFINITY;
    }
    // Singular values from their squares' sum and product.
    let sum = along_x.length_squared() + along_y.length_squared();
    let largest = (0.5 * (sum + (sum * sum - 4.0 * turned * turned).max(0.0).sqrt())).sqrt();
    largest.max(largest / turned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_of_known_maps() {
        let from = [DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(0.5, 1.0)];
        assert!((stretch(from, from) - 1.0).abs() < 1e-12);
        assert!((stretch(from, from.map(|point| 1.5 * point)) - 1.5).abs() < 1e-12);
        assert!((stretch(from, from.map(|point| point * DVec2::new(1.0, 0.25))) - 4.0).abs() < 1e-12);
        assert!(stretch(from, from.map(|point| point * DVec2::new(-1.0, 1.0))).is_infinite());
    }
}

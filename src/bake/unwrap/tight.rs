//! Charts turned into their tightest box, and boxes made whole texels.
//!
//! The tightest box of a convex hull (Andrew 1979) has a side on one of its edges (Freeman and Shapira 1975).

use super::patch::Chart;
use glam::DVec2;

/// Share of its box from which a chart counts as a rectangle.
const RECTANGLE: f64 = 0.97;

/// Edges of a hull that are tried: more differ by less than a degree.
const MOST_EDGES: usize = 360;

/// By how much more than whole texels a box may be and still get no further texel.
const ROUNDING: f64 = 1e-3;

/// Turns a chart so that its box is smallest and stands on its shorter side, with its corner at the origin. Gives the
/// box's size.
pub(super) fn tighten(chart: &mut Chart) -> DVec2 {
    let hull = hull(&chart.points);
    let step = hull.len().div_ceil(MOST_EDGES).max(1);
    let mut best = (f64::INFINITY, DVec2::X);
    for index in (0..hull.len()).step_by(step) {
        let Some(along) = (hull[(index + 1) % hull.len()] - hull[index]).try_normalize() else {
            continue;
        };
        let (low, high) = bounds(hull.iter().map(|&point| turned(along, point)));
        let area = (high - low).element_product();
        // The first of those that are the same but for rounding.
        if area < best.0 * (1.0 - 1e-9) {
            best = (area, along);
        }
    }
    chart.points.iter_mut().for_each(|point| *point = turned(best.1, *point));
    let (low, high) = bounds(chart.points.iter().copied());
    chart.points.iter_mut().for_each(|point| *point -= low);
    let size = high - low;
    if size.x <= size.y {
        return size;
    }
    // A quarter turn, which keeps the handedness.
    chart.points.iter_mut().for_each(|point| *point = DVec2::new(size.y - point.y, point.x));
    DVec2::new(size.y, size.x)
}

fn turned(along: DVec2, point: DVec2) -> DVec2 {
    DVec2::new(along.dot(point), along.perp_dot(point))
}

fn bounds(points: impl Iterator<Item = DVec2>) -> (DVec2, DVec2) {
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)))
}

/// The corners of the convex hull, counter-clockwise.
fn hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull: Vec<DVec2> = Vec::new();
    let half = |hull: &mut Vec<DVec2>, points: &mut dyn Iterator<Item = DVec2>| {
        let start = hull.len();
        for point in points {
            while hull.len() >= start + 2 {
                let [a, b] = [hull[hull.len() - 2], hull[hull.len() - 1]];
                if (b - a).perp_dot(point - a) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
    };
    half(&mut hull, &mut sorted.iter().copied());
    half(&mut hull, &mut sorted.iter().rev().copied());
    hull
}

/// A chart's box in whole texels, and the texels per unit along both axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TexelBox {
    /// Width and height [texels].
    pub(super) size: [u32; 2],
    /// Texels per unit of the chart.
    pub(super) scale: DVec2,
}

impl TexelBox {
    /// The box of a chart of this size and area, at so many texels per unit.
    ///
    /// A rectangle is stretched to whole texels, so that all four edges lie on the borders of texels; any other chart
    /// keeps its shape. No box is thinner than a texel: a chart that would be is stretched to one, so that whatever is
    /// looked up on it was measured on it.
    pub(super) fn new(size: DVec2, area: f64, density: f64) -> Self {
        let is_rectangle = area > RECTANGLE * size.element_product();
        let exact = size * density;
        let whole = (exact * (1.0 - ROUNDING)).ceil().max(DVec2::ONE);
        let scale = |axis: usize| {
            let is_stretched = is_rectangle || exact[axis] < 1.0 || exact[axis] > whole[axis];
            if is_stretched && size[axis] > 0.0 { whole[axis] / size[axis] } else { density }
        };
        Self { size: [whole.x as u32, whole.y as u32], scale: DVec2::new(scale(0), scale(1)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_rectangle_comes_to_stand() {
        let along = DVec2::new(0.6, 0.8);
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
        let points = corners.map(|[x, y]| DVec2::splat(7.0) + along.rotate(DVec2::new(x, y))).to_vec();
        let mut chart = Chart { triangles: vec![0], corners: vec![[0, 1, 2]], points };
        let size = tighten(&mut chart);
        assert!((size - DVec2::new(2.0, 3.0)).length() < 1e-9, "{size}");
        let [a, b, c] = chart.flat().next().unwrap();
        assert!((b - a).perp_dot(c - a) > 0.0, "not mirrored");
        let (low, high) = bounds(chart.points.iter().copied());
        assert!(low.length() < 1e-12 && (high - size).length() < 1e-12);
    }

    #[test]
    fn boxes_are_whole_texels() {
        let of = |x, y, area| TexelBox::new(DVec2::new(x, y), area, 10.0);
        assert_eq!(of(0.30001, 1.0, 0.30001).size, [3, 10]);
        assert_eq!(of(0.33, 1.0, 0.33).size, [4, 10]);
        assert!((of(0.33, 1.0, 0.33).scale.x * 0.33 - 4.0).abs() < 1e-12);
        assert_eq!(of(0.33, 1.0, 0.1).scale, DVec2::splat(10.0));
        let tiny = of(1e-5, 0.5, 2e-6);
        assert_eq!(tiny.size, [1, 5]);
        assert!((tiny.scale.x * 1e-5 - 1.0).abs() < 1e-12);
    }
}

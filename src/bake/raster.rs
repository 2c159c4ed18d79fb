//! Which triangles cover which texels, and how much of them.
//!
//! Conservative: a texel belongs to every triangle whose UV1 image has any area in it. Triangles are clipped to the
//! texel's square (Sutherland and Hodgman 1974) in f64, so that the share that is covered is exact and sample points
//! can be spread over just that share.

use glam::DVec2;

/// Texels of which less than this share is covered count as empty: UV1 that should end at a texel's border ends a
/// rounding error beyond it.
pub(super) const MIN_COVERAGE: f64 = 1e-3;

/// A triangle's part of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Fragment {
    /// Row by row within the page.
    pub(super) texel: u32,
    /// The chart.
    pub(super) chart: u32,
    /// The object, as its place in the list of receivers.
    pub(super) receiver: u32,
    /// The triangle within the object.
    pub(super) triangle: u32,
}

/// A convex polygon of at most seven corners: a triangle cut by four lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Polygon {
    corners: [DVec2; 8],
    count: usize,
}

impl Polygon {
    /// The part of a triangle that lies in the square of texel (`x`, `y`). All in texels.
    pub(super) fn clip(triangle: [DVec2; 3], x: u32, y: u32) -> Self {
        let mut polygon = Self { corners: [DVec2::ZERO; 8], count: 3 };
        polygon.corners[..3].copy_from_slice(&triangle);
        let (x, y) = (f64::from(x), f64::from(y));
        polygon
            .cut(|corner| corner.x - x)
            .cut(|corner| x + 1.0 - corner.x)
            .cut(|corner| corner.y - y)
            .cut(|corner| y + 1.0 - corner.y)
    }

    pub(super) fn corners(&self) -> &[DVec2] {
        &self.corners[..self.count]
    }

    /// Area [texels²].
    pub(super) fn area(&self) -> f64 {
        self.fan().map(|[a, b, c]| triangle_area(a, b, c)).sum()
    }

    /// The polygon as triangles around its first corner.
    pub(super) fn fan(&self) -> impl Iterator<Item = [DVec2; 3]> + '_ {
        (2..self.count).map(|corner| [self.corners[0], self.corners[corner - 1], self.corners[corner]])
    }

    /// The half where `inside` is not negative; it must be linear.
    fn cut(self, inside: impl Fn(DVec2) -> f64) -> Self {
        let mut kept = Self { corners: [DVec2::ZERO; 8], count: 0 };
        for index in 0..self.count {
            let (from, to) = (self.corners[index], self.corners[(index + 1) % self.count]);
            let (from_inside, to_inside) = (inside(from), inside(to));
            if from_inside >= 0.0 {
                kept.push(from);
            }
            if (from_inside >= 0.0) != (to_inside >= 0.0) {
                kept.push(from.lerp(to, from_inside / (from_inside - to_inside)));
            }
        }
        kept
    }

    fn push(&mut self, corner: DVec2) {
        // Rounding at a corner of the square can add a ninth; it has no area to lose.
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

/// Area of a triangle, whichever way it turns [texels²].
pub(super) fn triangle_area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    0.5 * (b - a).perp_dot(c - a).abs()
}

/// Every texel of a `width` × `height` rectangle that a triangle has area in. All in texels.
pub(super) fn covered_texels(triangle: [DVec2; 3], [width, height]: [u32; 2], mut visit: impl FnMut(u32, u32)) {
    let [a, b, c] = triangle;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let first = |low: f64| low.floor().max(0.0) as u32;
    let end = |high: f64, size: u32| high.ceil().clamp(0.0, f64::from(size)) as u32;
    for y in first(low.y)..end(high.y, height) {
        for x in first(low.x)..end(high.x, width) {
            if Polygon::clip(triangle, x, y).area() > 0.0 {
                visit(x, y);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::combine;

    fn random(key: u64) -> f64 {
        (combine(0x7e57, key) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The parts of a triangle add up to the triangle, and none is missed.
    #[test]
    fn parts_add_up_to_the_whole() {
        for key in 0..300 {
            let corner = |index: u64| {
                let scale = if key % 3 == 0 { 1.5 } else { 12.0 };
                DVec2::new(2.0 + scale * random(6 * key + 2 * index), 2.0 + scale * random(6 * key + 2 * index + 1))
            };
            let triangle = [corner(0), corner(1), corner(2)];
            let mut sum = 0.0;
            covered_texels(triangle, [16, 16], |x, y| {
                let area = Polygon::clip(triangle, x, y).area();
                assert!(area <= 1.0 + 1e-12);
                sum += area;
            });
            let whole = triangle_area(triangle[0], triangle[1], triangle[2]);
            assert!((sum - whole).abs() < 1e-9 * whole.max(1.0), "{sum} {whole}");
        }
    }

    #[test]
    fn a_needle_between_texel_centres_is_found() {
        let needle = [DVec2::new(0.1, 0.95), DVec2::new(7.9, 0.95), DVec2::new(7.9, 0.96)];
        let mut count = 0;
        covered_texels(needle, [8, 8], |_, y| {
            assert_eq!(y, 0);
            count += 1;
        });
        assert_eq!(count, 8);
    }

    #[test]
    fn what_lies_outside_the_page_is_left_out() {
        let triangle = [DVec2::new(-3.0, -3.0), DVec2::new(20.0, -3.0), DVec2::new(-3.0, 20.0)];
        let mut count = 0;
        covered_texels(triangle, [4, 4], |x, y| {
            assert!(x < 4 && y < 4);
            count += 1;
        });
        assert_eq!(count, 16);
    }
}

//! What a texture unit reads of a page: which texels, with which weights. Owns the two lookups that Bevy's shader knows
//! and the rectangle as it reaches that shader; holds no texels itself, so that pictures of a map and the equations of
//! its seams are made of the same numbers.
//!
//! Method: texel centres lie at halves, indices are clamped to the page (`clamp to edge`), the bilinear weights are
//! those of the Vulkan and WebGPU specifications. The bicubic lookup is the cubic B-spline by four bilinear taps
//! (Sigg and Hadwiger 2005, GPU Gems 2, chapter 20), with the places of the taps by Patry's polynomials (Advances in
//! Real-Time Rendering 2021), since that approximation is what Bevy 0.19 draws.

use glam::DVec2;

/// Most texels that one lookup reads.
const MOST: usize = 16;

/// Steps of a coordinate of a lightmap's rectangle: Bevy packs each into 16 bits.
const RECT_STEPS: f64 = 65535.0;

/// How a map is read between its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filtering {
    /// Between the four nearest texels.
    #[default]
    Bilinear,
    /// A cubic B-spline over 4 × 4 texels: Bevy's `bicubic_sampling`.
    Bicubic,
}

impl Filtering {
    /// Both.
    pub(in crate::bake) const ALL: [Self; 2] = [Self::Bilinear, Self::Bicubic];

    /// What a lookup at a point of a page reads [texels, from the page's corner].
    pub(in crate::bake) fn taps(self, [width, height]: [u32; 2], point: DVec2) -> Taps {
        let (columns, rows) = (self.axis(width, point.x), self.axis(height, point.y));
        let mut taps = Taps { list: [(0, 0.0); MOST], count: 0 };
        for &(row, weight_y) in rows.read() {
            for &(column, weight_x) in columns.read() {
                taps.list[taps.count] = (row * width + column, weight_x * weight_y);
                taps.count += 1;
            }
        }
        taps
    }

    /// Along one axis. Both lookups are products of two such.
    fn axis(self, size: u32, at: f64) -> Axis {
        let mut axis = Axis { list: [(0, 0.0); 4], count: 0 };
        match self {
            Self::Bilinear => axis.add_bilinear(size, at, 1.0),
            Self::Bicubic => {
                let knot = (at + 0.5).floor();
                let a = at + 0.5 - knot;
                let low = (a * (a * (3.0 - a) - 3.0) + 1.0 + a * a * (3.0 * a - 6.0) + 4.0) / 6.0;
                let before = -0.2 - a * (0.24 * a - 0.44);
                let after = 1.0 + a * (0.24 * a - 0.04);
                axis.add_bilinear(size, knot + before - 0.5, low);
                axis.add_bilinear(size, knot + after - 0.5, 1.0 - low);
            }
        }
        axis
    }
}

/// The texels along one axis, none twice but by clamping.
struct Axis {
    list: [(u32, f64); 4],
    count: usize,
}

impl Axis {
    fn read(&self) -> &[(u32, f64)] {
        &self.list[..self.count]
    }

    fn add_bilinear(&mut self, size: u32, at: f64, share: f64) {
        let first = (at - 0.5).floor();
        let second = at - 0.5 - first;
        let last = f64::from(size) - 1.0;
        for (place, weight) in [(first, 1.0 - second), (first + 1.0, second)] {
            let texel = place.clamp(0.0, last) as u32;
            match self.list[..self.count].iter_mut().find(|(known, _)| *known == texel) {
                Some((_, known)) => *known += share * weight,
                None => {
                    self.list[self.count] = (texel, share * weight);
                    self.count += 1;
                }
            }
        }
    }
}

/// The texels that a lookup reads, row by row within the page, and their weights, which add up to one.
#[derive(Clone, Copy, Debug)]
pub(in crate::bake) struct Taps {
    list: [(u32, f64); MOST],
    count: usize,
}

impl Taps {
    pub(in crate::bake) fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.list[..self.count].iter().map(|&(texel, weight)| (texel as usize, weight))
    }
}

/// An object's rectangle as the shader gets it.
#[derive(Clone, Copy, Debug)]
pub(in crate::bake) struct DisplayedRect {
    min: DVec2,
    size: DVec2,
}

impl DisplayedRect {
    /// The rectangle between two corners in the unit square of a page of `width` × `height` texels.
    pub(in crate::bake) fn new(uv_min: [f32; 2], uv_max: [f32; 2], [width, height]: [u32; 2]) -> Self {
        let page = DVec2::new(width.into(), height.into());
        // In f32, as Bevy rounds it.
        let kept = |uv: [f32; 2]| {
            let steps = uv.map(|uv| f64::from((uv * RECT_STEPS as f32).round().clamp(0.0, RECT_STEPS as f32)));
            DVec2::from(steps) / RECT_STEPS * page
        };
        let min = kept(uv_min);
        Self { min, size: kept(uv_max) - min }
    }

    /// Where a point of the object's UV1 is read [texels, from the page's corner].
    pub(in crate::bake) fn point(&self, uv1: DVec2) -> DVec2 {
        self.min + self.size * uv1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [9, 7];

    fn read(filtering: Filtering, point: DVec2, value: impl Fn(DVec2) -> f64) -> f64 {
        let centre = |texel: usize| DVec2::new((texel % 9) as f64 + 0.5, (texel / 9) as f64 + 0.5);
        filtering.taps(SIZE, point).iter().map(|(texel, weight)| weight * value(centre(texel))).sum()
    }

    fn points() -> impl Iterator<Item = DVec2> {
        (0..400).map(|key| DVec2::new(f64::from(key % 20) * 0.51 - 0.4, f64::from(key / 20) * 0.41 - 0.3))
    }

    #[test]
    fn weights_add_up_to_one_on_the_page_and_off_it() {
        for filtering in Filtering::ALL {
            for point in points() {
                let taps = filtering.taps(SIZE, point);
                let sum: f64 = taps.iter().map(|(_, weight)| weight).sum();
                assert!((sum - 1.0).abs() < 1e-12, "{filtering:?} {point}: {sum}");
                assert!(taps.iter().all(|(texel, weight)| texel < 63 && weight > -1e-12));
            }
        }
    }

    #[test]
    fn bilinear_lookups_have_what_is_linear_and_the_texel_at_its_centre() {
        let value = |centre: DVec2| 3.0 + 2.0 * centre.x - centre.y;
        for point in points() {
            let inside = point.clamp(DVec2::splat(0.5), DVec2::new(8.5, 6.5));
            assert!((read(Filtering::Bilinear, point, value) - value(inside)).abs() < 1e-12, "{point}");
        }
        let at_centre = Filtering::Bilinear.taps(SIZE, DVec2::new(4.5, 3.5));
        let of_centre = at_centre.iter().filter(|&(texel, _)| texel == 31).map(|(_, weight)| weight);
        assert!((of_centre.sum::<f64>() - 1.0).abs() < 1e-12);
    }

    /// The cubic B-spline, whose weights are exact at knots, where the polynomials that place the taps are off by what
    /// their author states: less than a hundredth.
    #[test]
    fn bicubic_weights_are_about_those_of_the_cubic_b_spline() {
        let spline = |distance: f64| {
            let d = distance.abs();
            if d < 1.0 {
                2.0 / 3.0 - d * d + d * d * d / 2.0
            } else if d < 2.0 {
                (2.0 - d) * (2.0 - d) * (2.0 - d) / 6.0
            } else {
                0.0
            }
        };
        let mut worst = 0.0_f64;
        for point in points().filter(|point| point.x > 2.5 && point.x < 6.5 && point.y > 2.5 && point.y < 4.5) {
            for (texel, weight) in Filtering::Bicubic.taps(SIZE, point).iter() {
                let centre = DVec2::new((texel % 9) as f64 + 0.5, (texel / 9) as f64 + 0.5);
                worst = worst.max((weight - spline(point.x - centre.x) * spline(point.y - centre.y)).abs());
            }
        }
        assert!(worst < 0.01, "{worst}");
        assert!(worst > 1e-6, "the shader's approximation is not the spline itself");
    }

    #[test]
    fn rectangles_are_kept_in_sixteen_bits() {
        let rect = DisplayedRect::new([0.25, 0.5], [0.75, 1.0], [4096, 64]);
        let (low, high) = (rect.point(DVec2::ZERO), rect.point(DVec2::ONE));
        assert!((low.x - 1024.0).abs() > 1e-3 && (low.x - 1024.0).abs() <= 0.5 / 65535.0 * 4096.0, "{low}");
        assert!((high - DVec2::new(3072.0, 64.0)).abs().max_element() <= 0.04, "{high}");
    }
}

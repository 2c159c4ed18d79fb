//! Charts put into the rectangle of their mesh, on its texels.
//!
//! Every chart has a cell of whole blocks of 4 × 4 texels to itself, in which it starts two texels from the smallest
//! corner and ends at least two from the largest: what bicubic filtering reads beyond it, and no block that a texture
//! format compresses holds texels of two charts. The rectangle itself starts where the first chart does, two texels
//! into a block of the page.

use super::patch::Chart;
use super::tight::TexelBox;
use crate::bake::CancelToken;
use crate::bake::atlas::{BLOCK, smallest};
use glam::{DVec2, Vec2};

/// A chart in its tightest box, in units of the shape.
pub(super) struct Boxed {
    pub(super) chart: Chart,
    pub(super) size: DVec2,
    pub(super) area: f64,
}

/// How charts are packed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packing {
    /// Texels per unit of the shape.
    pub(super) density: f64,
    /// Empty texels between two charts, at least 4.
    pub(super) gap: u32,
    /// Largest side of the rectangle with its border [texels], a whole number of blocks.
    pub(super) limit: u32,
}

/// Charts in a rectangle.
#[derive(Clone, Debug)]
pub(super) struct Packed {
    /// Width and height [texels].
    pub(super) size: [u32; 2],
    /// Smallest corner of each chart [texels].
    pub(super) origins: Vec<[u32; 2]>,
    pub(super) boxes: Vec<TexelBox>,
}

impl Packed {
    /// Packs charts; gives the share of the density that might do where there is no room, and any once cancelled.
    pub(super) fn new(charts: &[Boxed], packing: &Packing, cancel: &CancelToken) -> Result<Self, f64> {
        let boxes: Vec<TexelBox> =
            charts.iter().map(|chart| TexelBox::new(chart.size, chart.area, packing.density)).collect();
        // In f64: a plain of kilometres at many texels has more than 32 bits.
        let needed = |chart: &Boxed| (chart.size * packing.density + f64::from(packing.gap) + 3.0).max_element();
        let longest = charts.iter().map(needed).fold(0.0, f64::max);
        if longest > f64::from(packing.limit) {
            let overhead = f64::from(packing.gap) + 8.0;
            return Err((f64::from(packing.limit) - overhead) / (longest - f64::from(packing.gap)));
        }
        let cells: Vec<[u32; 2]> =
            boxes.iter().map(|texels| texels.size.map(|side| (side + packing.gap).div_ceil(BLOCK))).collect();
        let blocks = f64::from(packing.limit / BLOCK);
        let area: f64 = cells.iter().map(|[width, height]| f64::from(*width) * f64::from(*height)).sum();
        if area > blocks * blocks {
            return Err((0.9 * blocks * blocks / area).sqrt());
        }
        let placed = smallest(&cells, packing.limit / BLOCK, cancel).ok_or(0.93)?;
        let mut size = [1; 2];
        let mut origins = Vec::with_capacity(charts.len());
        for (corner, texels) in placed.into_iter().zip(&boxes) {
            let origin = corner.map(|blocks| blocks * BLOCK);
            for axis in 0..2 {
                size[axis] = size[axis].max(origin[axis] + texels.size[axis]);
            }
            origins.push(origin);
        }
        Ok(Self { size, origins, boxes })
    }

    /// UV1 of every point of a chart.
    pub(super) fn uv1(&self, index: usize, chart: &Chart) -> impl Iterator<Item = Vec2> {
        let texels = self.boxes[index];
        let [origin, size] = [self.origins[index], self.size].map(|[x, y]| DVec2::new(x.into(), y.into()));
        let most = DVec2::from(texels.size.map(f64::from));
        let uv = move |point: &DVec2| ((origin + (*point * texels.scale).min(most)) / size).as_vec2();
        chart.points.iter().map(uv)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tight::tighten;
    use super::*;
    use crate::math::combine;

    /// Rectangles of chance sizes.
    fn rectangles(count: u64) -> Vec<Boxed> {
        let side = |key: u64| 0.05 + 2.0 * (combine(5, key) >> 11) as f64 / (1_u64 << 53) as f64;
        let rectangle = |key: u64| {
            let [width, height] = [side(2 * key), side(2 * key + 1)];
            let points = vec![DVec2::ZERO, DVec2::new(width, 0.0), DVec2::new(width, height), DVec2::new(0.0, height)];
            let corners = vec![[0, 1, 2], [0, 2, 3]];
            let mut chart = Chart { triangles: vec![0, 1], corners, points };
            let size = tighten(&mut chart);
            Boxed { chart, size, area: width * height }
        };
        (0..count).map(rectangle).collect()
    }

    #[test]
    fn cells_are_whole_blocks_and_apart() {
        let charts = rectangles(200);
        for gap in [4, 9] {
            let packed =
                Packed::new(&charts, &Packing { density: 16.0, gap, limit: 4096 }, &CancelToken::default()).unwrap();
            let area: u32 = packed.boxes.iter().map(|texels| texels.size[0] * texels.size[1]).sum();
            let fill = f64::from(area) / f64::from(packed.size[0] * packed.size[1]);
            assert!(fill > 0.35, "{fill}");
            for (index, origin) in packed.origins.iter().enumerate() {
                assert!(origin.iter().all(|texel| texel % BLOCK == 0));
                let size = packed.boxes[index].size;
                for axis in 0..2 {
                    assert!(origin[axis] + size[axis] <= packed.size[axis]);
                }
                for (other, other_origin) in packed.origins.iter().enumerate().take(index) {
                    let other_size = packed.boxes[other].size;
                    let apart = (0..2).any(|axis| {
                        origin[axis] >= other_origin[axis] + other_size[axis] + gap
                            || other_origin[axis] >= origin[axis] + size[axis] + gap
                    });
                    assert!(apart, "{index} and {other}");
                }
                let texels = DVec2::new(packed.size[0].into(), packed.size[1].into());
                let is_whole = |uv: Vec2| {
                    let place = uv.as_dvec2() * texels;
                    (place - place.round()).abs().max_element() < 1e-3
                };
                assert!(packed.uv1(index, &charts[index].chart).all(is_whole), "edges lie on the borders of texels");
            }
        }
    }

    #[test]
    fn what_has_no_room_says_what_share_of_the_density_might_do() {
        let charts = rectangles(200);
        let mut packing = Packing { density: 1000.0, gap: 4, limit: 256 };
        let packed = (0..60).find_map(|_| match Packed::new(&charts, &packing, &CancelToken::default()) {
            Ok(packed) => Some(packed),
            Err(share) => {
                assert!(share > 0.0 && share < 1.0, "{share}");
                packing.density *= share;
                None
            }
        });
        let size = packed.unwrap().size;
        assert!(size.iter().all(|&side| side <= 252) && packing.density > 2.0, "{size:?} {packing:?}");
    }
}

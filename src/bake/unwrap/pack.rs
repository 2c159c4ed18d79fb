//! Charts put into the rectangle of their mesh, on its texels.
//!
//! Every chart has a cell of whole blocks of 4 × 4 texels to itself, in which it starts two texels from the smallest
//! corner and ends at least two from the largest: what bicubic filtering reads beyond it, and no block that a texture
//! format compresses holds texels of two charts. The rectangle itself starts where the first chart does, two texels
//! into a block of the page.

use super::patch::Chart;
use super::tight::TexelBox;
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
    /// Packs charts; gives the share of the density that might do where there is no room.
    pub(super) fn new(charts: &[Boxed], packing: &Packing) -> Result<Self, f64> {
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
        let placed = smallest(&cells, packing.limit / BLOCK).ok_or(0.93)?;
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

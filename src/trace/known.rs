//! Light that is known beforehand: a table of E/π over the fronts of triangles, at which a path may end instead of
//! going on. Owns the table and how a place is looked up in it; who fills it, and how well, is not its business.
//!
//! A path that meets a Lambert surface from its front needs the irradiance there and nothing else, since such a surface
//! shows the same from all sides. Ward, Rubinstein and Clear (1988) kept it where it had been computed; here it lies on
//! grids over the surfaces, cell by cell, each the mean over its area. A lookup takes the cell that a place is in:
//! summed over an area that is the area's own irradiance, and nothing of it comes from the other side of a wall that
//! stands where two cells meet, as it would between the middles of cells.

use super::accel::Hit;
use super::kernel::LAYERED;
use super::tracer::Tracer;
use glam::{Vec2, Vec3};

/// No chart.
pub(super) const NO_CHART: u32 = u32::MAX;

/// E/π over the fronts of triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct KnownLight {
    /// Per triangle.
    pub(crate) unfolded: Vec<Unfolded>,
    pub(crate) grids: Vec<KnownGrid>,
}

/// A triangle on a grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unfolded {
    pub(crate) grid: u32,
    /// Whose cells it may look at; [`NO_CHART`] where nothing is known of it.
    pub(crate) chart: u32,
    /// Its first vertex [cells].
    pub(crate) corner: Vec2,
    /// From there to the second and the third.
    pub(crate) edges: [Vec2; 2],
    /// What a ray must have come from at least as far as this to take a cell for the place that it met [m].
    pub(crate) least_distance: f32,
}

impl Unfolded {
    /// Nothing is known of it.
    pub(crate) const UNKNOWN: Self =
        Self { grid: 0, chart: NO_CHART, corner: Vec2::ZERO, edges: [Vec2::ZERO; 2], least_distance: 0.0 };
}

/// Cells, row by row.
#[derive(Clone, Debug)]
pub(crate) struct KnownGrid {
    pub(crate) width: u32,
    pub(crate) cells: Vec<KnownCell>,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KnownCell {
    /// Mean E/π [cd/m²].
    pub(crate) radiance: Vec3,
    /// On which chart; [`NO_CHART`] where it is not known.
    pub(crate) chart: u32,
}

impl KnownCell {
    /// Nothing is known there.
    pub(crate) const UNKNOWN: Self = Self { radiance: Vec3::ZERO, chart: NO_CHART };
}

impl KnownLight {
    /// E/π at weights of a triangle's second and third vertex, for a ray from so far away.
    fn look_up(&self, triangle: u32, [second, third]: [f32; 2], distance: f32) -> Option<Vec3> {
        let unfolded = self.unfolded.get(triangle as usize).filter(|unfolded| unfolded.chart != NO_CHART)?;
        if distance < unfolded.least_distance {
            return None;
        }
        let place = unfolded.corner + unfolded.edges[0] * second + unfolded.edges[1] * third;
        let grid = self.grids.get(unfolded.grid as usize)?;
        let [x, y] = place.max(Vec2::ZERO).to_array().map(|along| along as usize);
        if x >= grid.width as usize {
            return None;
        }
        let cell = grid.cells.get(y * grid.width as usize + x)?;
        (cell.chart == unfolded.chart).then_some(cell.radiance)
    }

    /// Memory that it holds [bytes].
    pub(crate) fn memory_bytes(&self) -> u64 {
        let cells: usize = self.grids.iter().map(|grid| grid.cells.len()).sum();
        (self.unfolded.len() * size_of::<Unfolded>() + cells * size_of::<KnownCell>()) as u64
    }
}

impl Tracer {
    /// Makes paths from now on end where light is known. Only the first call counts: what is known stays as it is for
    /// all that is traced.
    pub(crate) fn learn(&self, known: KnownLight) {
        // A second table would make what was traced so far another thing than what follows.
        let _ = self.known.set(known);
    }

    /// E/π where a ray meets a surface, after a way of so many metres; `None` where it must go on to find out.
    #[inline]
    pub(super) fn known_light<const K: u32>(&self, hit: Hit, direction: Vec3, distance: f32) -> Option<Vec3> {
        let known = self.known.get()?;
        if self.triangles[hit.triangle as usize].normal.dot(direction) >= 0.0
            || (K & LAYERED != 0 && self.surface(hit.triangle).is_shaded())
        {
            return None;
        }
        known.look_up(hit.triangle, hit.barycentric, distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two cells beside each other, of two charts, and a triangle over the first and a half of the second.
    fn known(charts: [u32; 2]) -> KnownLight {
        let cell = |chart| KnownCell { radiance: Vec3::splat(1.0 + chart as f32), chart };
        KnownLight {
            unfolded: vec![
                Unfolded {
                    grid: 0,
                    chart: 0,
                    corner: Vec2::ZERO,
                    edges: [Vec2::new(1.5, 0.0), Vec2::new(0.0, 1.0)],
                    least_distance: 0.5,
                },
                Unfolded::UNKNOWN,
            ],
            grids: vec![KnownGrid { width: 2, cells: charts.map(cell).to_vec() }],
        }
    }

    #[test]
    fn a_place_has_the_light_of_its_cell() {
        let known = known([0, 0]);
        for weights in [[0.0, 0.0], [0.6, 0.3], [0.9, 0.0]] {
            assert_eq!(known.look_up(0, weights, 1.0), Some(Vec3::ONE), "{weights:?}");
        }
        assert_eq!(known.look_up(0, [0.1, 0.1], 0.49), None, "too near");
        assert_eq!(known.look_up(1, [0.1, 0.1], 1.0), None, "an unknown triangle");
        assert_eq!(known.look_up(7, [0.1, 0.1], 1.0), None, "no such triangle");
    }

    /// Neither the cell of another chart nor one that is not known, nor what lies beyond the grid, is read as light.
    #[test]
    fn what_is_not_its_own_is_not_read() {
        for other in [1, NO_CHART] {
            let known = known([0, other]);
            assert_eq!(known.look_up(0, [0.6, 0.0], 1.0), Some(Vec3::ONE));
            assert_eq!(known.look_up(0, [0.7, 0.0], 1.0), None);
        }
        let known = known([0, 0]);
        assert_eq!(known.look_up(0, [0.0, 1.0], 1.0), None, "below the last row");
        assert_eq!(known.look_up(0, [2.0, 0.0], 1.0), None, "beside the last column");
    }
}

//! Choosing one cell of a table in proportion to weights: first its row by the rows' sums, then its column by the
//! weights within the row (Pharr, Jakob and Humphreys 2023, section A.5). Does not know what the cells are, and does
//! not keep their weights: whoever made the table gives them again.
//!
//! A cumulative sum per cell costs as much as the picture that the weights come from, and in `f32` it drowns the dark
//! cells of a row that holds the sun. So sums are kept, in `f64`, at every sixteenth column only, half a byte per cell;
//! the last step adds up the weights of at most sixteen neighbours.

use super::distribution::{Discrete, DistributionError};
use glam::{UVec2, Vec2};

/// Columns between two sums that are kept.
const BLOCK: usize = 16;

/// The largest `f32` below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// A distribution over the cells of a table, by weights that are not kept. `weight` must give the same numbers in
/// every call.
#[derive(Clone, Debug, PartialEq)]
pub struct Discrete2d {
    size: [usize; 2],
    rows: Discrete,
    /// Row by row and block by block, the sum of the row's weights up to and with the block.
    ends: Vec<f64>,
    blocks_per_row: usize,
}

/// A cell that was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Column and row; its weight is above zero.
    pub place: UVec2,
    /// With what probability.
    pub probability: f64,
    /// Where in the cell the variates fell, in [0, 1)²: uniform again, with the digits that the choice left over.
    pub remapped: Vec2,
}

impl Discrete2d {
    /// From weights in any unit, by column and row; `size` is how many of each. Fails on a weight that is negative or
    /// not finite (of which it names the row), and if none is above zero.
    pub fn new(size: UVec2, weight: impl Fn(UVec2) -> f64) -> Result<Self, DistributionError> {
        let [columns, rows] = size.to_array().map(|count| count as usize);
        let blocks_per_row = columns.div_ceil(BLOCK);
        let mut ends = Vec::with_capacity(blocks_per_row * rows);
        let mut sums = Vec::with_capacity(rows);
        for row in 0..rows {
            let mut sum = 0.0;
            for column in 0..columns {
                let weight = weight(UVec2::new(column as u32, row as u32));
                if !(weight.is_finite() && weight >= 0.0) {
                    return Err(DistributionError::Weight { index: row, weight });
                }
                sum += weight;
                if (column + 1).is_multiple_of(BLOCK) || column + 1 == columns {
                    ends.push(sum);
                }
            }
            sums.push(sum);
        }
        Ok(Self { size: [columns, rows], rows: Discrete::new(sums)?, ends, blocks_per_row })
    }

    /// The sum of the weights.
    pub fn total(&self) -> f64 {
        self.rows.total()
    }

    /// The cell that belongs to `u` in [0, 1)²: `u.x` chooses its column, `u.y` its row.
    pub fn sample(&self, u: Vec2, weight: impl Fn(UVec2) -> f64) -> Cell {
        let row = self.rows.sample(f64::from(u.y));
        let first = row.index * self.blocks_per_row;
        let ends = &self.ends[first..first + self.blocks_per_row];
        // The row was chosen, so that its sum is above zero.
        let at = f64::from(u.x) * ends[self.blocks_per_row - 1];
        let block = ends.partition_point(|&end| end <= at).min(self.blocks_per_row - 1);
        let mut start = if block == 0 { 0.0 } else { ends[block - 1] };
        let columns = block * BLOCK..((block + 1) * BLOCK).min(self.size[0]);
        let mut chosen = None;
        for column in columns {
            let place = UVec2::new(column as u32, row.index as u32);
            let weight = weight(place);
            if weight > 0.0 {
                chosen = Some((place, start, weight));
            }
            // The same sums as those that were kept, term by term.
            start += weight;
            if start > at && chosen.is_some() {
                break;
            }
        }
        // A block that was chosen has weight; should rounding deny it, the row's heaviest cell is one that has.
        let (place, start, weight) = chosen.unwrap_or_else(|| {
            let of = |column: usize| UVec2::new(column as u32, row.index as u32);
            let heaviest = (0..self.size[0]).map(of).max_by(|&a, &b| weight(a).total_cmp(&weight(b)));
            let place = heaviest.unwrap_or_default();
            (place, at, weight(place))
        });
        let remapped = (((at - start) / weight) as f32).clamp(0.0, BELOW_ONE);
        Cell { place, probability: self.probability(weight), remapped: Vec2::new(remapped, row.remapped) }
    }

    /// The probability of a cell of this weight.
    #[inline]
    pub fn probability(&self, weight: f64) -> f64 {
        weight / self.total()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights(size: UVec2) -> impl Fn(UVec2) -> f64 {
        move |place: UVec2| {
            let index = place.y * size.x + place.x;
            if index.is_multiple_of(7) || place.y == 1 { 0.0 } else { f64::from(index * 37 % 11) }
        }
    }

    #[test]
    fn shares_of_the_unit_square_are_the_probabilities() {
        let size = UVec2::new(37, 5);
        let weight = weights(size);
        let table = Discrete2d::new(size, &weight).expect("fine weights");
        let steps = 1000;
        let mut hits = vec![0.0; 37 * 5];
        for y in 0..steps {
            for x in 0..steps {
                let u = (Vec2::new(x as f32, y as f32) + 0.5) / steps as f32;
                let cell = table.sample(u, &weight);
                assert!(
                    cell.probability > 0.0 && cell.remapped.min_element() >= 0.0 && cell.remapped.max_element() < 1.0
                );
                hits[(cell.place.y * size.x + cell.place.x) as usize] += 1.0 / f64::from(steps * steps);
            }
        }
        for (index, hits) in hits.into_iter().enumerate() {
            let place = UVec2::new(index as u32 % 37, index as u32 / 37);
            let probability = table.probability(weight(place));
            assert!((hits - probability).abs() < 4e-4, "{place}: {hits} of {probability}");
        }
    }

    #[test]
    fn the_remapped_variates_run_through_the_cell() {
        let table = Discrete2d::new(UVec2::new(2, 2), |place| [1.0, 3.0][place.x as usize]).expect("fine weights");
        let cell = table.sample(Vec2::new(0.625, 0.75), |place| [1.0, 3.0][place.x as usize]);
        assert_eq!((cell.place, cell.probability), (UVec2::ONE, 0.375));
        assert!((cell.remapped - 0.5).abs().max_element() < 1e-6, "{cell:?}");
    }

    #[test]
    fn a_cell_of_a_billionth_beside_the_sun_keeps_its_share() {
        let size = UVec2::new(64, 2);
        let weight = |place: UVec2| if place == UVec2::new(20, 1) { 1e12 } else { 1.0 };
        let table = Discrete2d::new(size, weight).expect("fine weights");
        assert_eq!(table.total(), 1e12 + 127.0);
        assert_eq!(table.probability(1.0), 1.0 / table.total());
        assert_eq!(table.sample(Vec2::new(0.5, 0.5), weight).place, UVec2::new(20, 1));
        assert_eq!(table.sample(Vec2::new(0.0, 1e-12), weight).place, UVec2::ZERO);
    }

    #[test]
    fn the_ends_of_the_square_never_give_a_cell_without_weight() {
        let lone = |place: UVec2| if place == UVec2::new(18, 3) { 1e-300 } else { 0.0 };
        let table = Discrete2d::new(UVec2::new(40, 6), lone).expect("one weight");
        for u in [0.0, 0.5, BELOW_ONE, 1.0] {
            for v in [0.0, 0.5, BELOW_ONE, 1.0] {
                let cell = table.sample(Vec2::new(u, v), lone);
                assert_eq!((cell.place, cell.probability), (UVec2::new(18, 3), 1.0));
            }
        }
    }

    #[test]
    fn bad_weights_are_refused() {
        assert_eq!(Discrete2d::new(UVec2::ZERO, |_| 1.0), Err(DistributionError::AllZero));
        assert_eq!(Discrete2d::new(UVec2::new(3, 2), |_| 0.0), Err(DistributionError::AllZero));
        let negative = Discrete2d::new(UVec2::new(3, 2), |place| if place.y == 1 { -1.0 } else { 1.0 });
        assert_eq!(negative, Err(DistributionError::Weight { index: 1, weight: -1.0 }));
    }
}

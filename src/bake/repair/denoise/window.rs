//! Which texels of a window can be walked to from its middle, always outwards and over links only.

use super::texels::Texels;

/// A step from the middle, and where the walk to it may come from.
#[derive(Clone, Debug)]
struct Cell {
    step: [i32; 2],
    /// Cells of the ring within, and the step from each to this one as a bit of the links.
    from: Vec<(usize, u8)>,
    /// Whether it is nearer than the radius.
    is_inside: bool,
}

/// The cells of a square window, ring after ring.
#[derive(Clone, Debug)]
pub(super) struct Window {
    cells: Vec<Cell>,
}

/// A texel of a window that was reached.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reached {
    /// Its index on the page.
    pub(super) index: usize,
    /// Its place as seen from the middle [texels].
    pub(super) step: [i32; 2],
}

impl Window {
    /// The window of all steps shorter than a radius [texels].
    pub(super) fn new(radius: f32) -> Self {
        let rings = radius.ceil() as i32 - 1;
        let mut cells = vec![Cell { step: [0; 2], from: Vec::new(), is_inside: true }];
        for ring in 1..=rings {
            let steps = (-ring..=ring).flat_map(|y| (-ring..=ring).map(move |x| [x, y]));
            for step in steps.filter(|[x, y]| x.abs().max(y.abs()) == ring) {
                let is_before = |other: &Cell| {
                    let [x, y] = [step[0] - other.step[0], step[1] - other.step[1]];
                    let ring_of_other = other.step[0].abs().max(other.step[1].abs());
                    (ring_of_other == ring - 1 && x.abs() <= 1 && y.abs() <= 1).then(|| Texels::bit([x, y]))
                };
                let from = cells.iter().enumerate().filter_map(|(cell, other)| Some((cell, is_before(other)?)));
                let from = from.collect();
                let [x, y] = step;
                let is_inside = ((x * x + y * y) as f32) < radius * radius;
                cells.push(Cell { step, from, is_inside });
            }
        }
        Self { cells }
    }

    /// The texels that can be reached from one, itself first.
    pub(super) fn reach(&self, texels: &Texels, middle: usize) -> Vec<Reached> {
        // The links of each cell that was reached.
        let mut open = vec![0; self.cells.len()];
        let mut reached = Vec::with_capacity(self.cells.len());
        open[0] = texels.links[middle];
        reached.push(Reached { index: middle, step: [0; 2] });
        for (number, cell) in self.cells.iter().enumerate().skip(1) {
            if !cell.from.iter().any(|&(from, bit)| open[from] & bit != 0) {
                continue;
            }
            let index = texels.at(middle, cell.step);
            open[number] = texels.links[index];
            if cell.is_inside {
                reached.push(Reached { index, step: cell.step });
            }
        }
        reached
    }
}

impl Reached {
    /// Squared distance from the middle [texels²].
    pub(super) fn squared_distance(&self) -> f32 {
        let [x, y] = self.step;
        (x * x + y * y) as f32
    }
}

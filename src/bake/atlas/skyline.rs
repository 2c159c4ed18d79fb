//! Rectangles on a strip, in whole blocks.
//!
//! The strip's upper edge so far is a row of steps; each rectangle goes where it ends lowest, and among those where it
//! leaves the least below it (the skyline of Burke, Kendall and Whitwell 2004, in the form of Jylänki 2010).

/// Rectangles put on a strip of a given width.
pub(crate) struct Skyline {
    width: u32,
    limit: u32,
    /// Where each step starts, and how high it is; the last ends at the width.
    steps: Vec<[u32; 2]>,
}

impl Skyline {
    /// An empty strip, `width` wide and at most `limit` high.
    pub(crate) fn new(width: u32, limit: u32) -> Self {
        Self { width, limit, steps: vec![[0, 0]] }
    }

    /// The smallest corner of a new rectangle; `None` if there is no room for it.
    pub(crate) fn place(&mut self, [width, height]: [u32; 2]) -> Option<[u32; 2]> {
        let mut best: Option<([u64; 3], usize, u32)> = None;
        for first in 0..self.steps.len() {
            let x = self.steps[first][0];
            if x + width > self.width {
                break;
            }
            let (y, waste) = self.rest(first, width);
            let cost = [u64::from(y + height), waste, u64::from(x)];
            if y + height <= self.limit && best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, first, y));
            }
        }
        let (_, first, y) = best?;
        let x = self.steps[first][0];
        self.raise(first, x + width, y + height);
        Some([x, y])
    }

    fn end(&self, step: usize) -> u32 {
        self.steps.get(step + 1).map_or(self.width, |next| next[0])
    }

    /// How high a rectangle of some width rests on the steps from one on, and the area that it covers up.
    fn rest(&self, first: usize, width: u32) -> (u32, u64) {
        let (from, to) = (self.steps[first][0], self.steps[first][0] + width);
        let under = (first..self.steps.len()).take_while(|&step| self.steps[step][0] < to);
        let y = under.clone().map(|step| self.steps[step][1]).max().unwrap_or(0);
        let gap = |step: usize| {
            let span = self.end(step).min(to) - self.steps[step][0].max(from);
            u64::from(span) * u64::from(y - self.steps[step][1])
        };
        (y, under.map(gap).sum())
    }

    /// Raises what lies between a step's start and an end to a height.
    fn raise(&mut self, first: usize, to: u32, height: u32) {
        let last = (first..self.steps.len()).take_while(|&step| self.steps[step][0] < to).last().unwrap_or(first);
        let rest = (self.end(last) > to).then(|| [to, self.steps[last][1]]);
        let from = self.steps[first][0];
        self.steps.splice(first..=last, std::iter::once([from, height]).chain(rest));
        // Steps of one height become one.
        self.steps.dedup_by(|next, kept| next[1] == kept[1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::combine;

    #[test]
    fn nothing_overlaps_and_little_is_left() {
        let sizes: Vec<[u32; 2]> =
            (0..400).map(|key| [0, 1].map(|axis| 2 + (combine(key, axis) % 30) as u32)).collect();
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by_key(|&index| (std::cmp::Reverse(sizes[index][1]), index));
        let mut skyline = Skyline::new(330, 2000);
        let mut is_taken = vec![false; 330 * 2000];
        let (mut area, mut top) = (0, 0);
        for index in order {
            let [width, height] = sizes[index];
            let [x, y] = skyline.place(sizes[index]).unwrap();
            assert!(x + width <= 330);
            top = top.max(y + height);
            area += width * height;
            for row in y..y + height {
                for column in x..x + width {
                    assert!(!std::mem::replace(&mut is_taken[(row * 330 + column) as usize], true));
                }
            }
        }
        let fill = f64::from(area) / f64::from(330 * top);
        assert!(fill > 0.85, "{fill}");
    }

    #[test]
    fn what_has_no_room_is_refused() {
        let mut skyline = Skyline::new(10, 10);
        assert_eq!(skyline.place([11, 1]), None);
        assert_eq!(skyline.place([10, 9]), Some([0, 0]));
        assert_eq!(skyline.place([1, 2]), None);
        assert_eq!(skyline.place([10, 1]), Some([0, 9]));
        assert_eq!(skyline.place([1, 1]), None);
    }
}

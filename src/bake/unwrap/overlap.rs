//! Whether triangles of a plane lie over each other. Knows nothing of meshes.
//!
//! Triangles are sorted into ever smaller boxes until few are left in one, and those are held against each other: a
//! k-d tree (Bentley 1975) whose leaves are looked at once and thrown away, so that a few large triangles among many
//! small ones, or many in one corner, cost no more than others. Two convex shapes are apart if an edge of one has the
//! other on its far side (the theorem of the separating axis, after Minkowski).

use crate::bake::CancelToken;
use glam::DVec2;
use std::collections::BTreeSet;

/// Triangles that are held against each other without further sorting.
const LEAF: usize = 12;

/// Pairs after which nobody needs to know of more.
const ENOUGH_PAIRS: usize = 1000;

/// Comparisons that a layout without overlaps may need, per triangle. The bench's meshes need 20 to 45, at a million
/// triangles as at a thousand, and 79 in the worst of the layouts that are tried for them.
const WORK_PER_TRIANGLE: u64 = 2000;

/// Pairs of triangles that share area.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Overlaps {
    /// In ascending order, the smaller number first.
    pub(super) pairs: Vec<[u32; 2]>,
    /// Whether the search ended before all pairs were looked at: enough were found, the work was done, or it was
    /// cancelled.
    pub(super) is_cut: bool,
}

impl Overlaps {
    /// Finds triangles that lie over each other by more than `slack`, a length.
    pub(super) fn find(triangles: &[[DVec2; 3]], slack: f64, cancel: &CancelToken) -> Self {
        let mut search = Search {
            triangles,
            cancel,
            slack,
            pairs: BTreeSet::new(),
            work: WORK_PER_TRIANGLE * (triangles.len() as u64 + 50),
        };
        let all: Vec<u32> = (0..triangles.len() as u32).filter(|&index| search.height(index) > slack).collect();
        search.sort(all, 0);
        let is_cut = search.is_over();
        Self { pairs: search.pairs.into_iter().collect(), is_cut }
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty() && !self.is_cut
    }
}

struct Search<'a> {
    triangles: &'a [[DVec2; 3]],
    cancel: &'a CancelToken,
    slack: f64,
    pairs: BTreeSet<[u32; 2]>,
    /// Comparisons left.
    work: u64,
}

impl Search<'_> {
    fn is_over(&self) -> bool {
        self.work == 0 || self.pairs.len() >= ENOUGH_PAIRS || self.cancel.is_cancelled()
    }

    fn bounds(&self, index: u32) -> (DVec2, DVec2) {
        let [a, b, c] = self.triangles[index as usize];
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// The smallest height of a triangle. One that is thinner than the slack can overlap nothing.
    fn height(&self, index: u32) -> f64 {
        let [a, b, c] = self.triangles[index as usize];
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        if longest > 0.0 { (b - a).perp_dot(c - a).abs() / longest } else { 0.0 }
    }

    fn sort(&mut self, some: Vec<u32>, depth: u32) {
        self.work = self.work.saturating_sub(some.len() as u64);
        if self.is_over() {
            return;
        }
        if some.len() <= LEAF || depth > 48 {
            return self.compare(&some);
        }
        let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = some.iter().fold(empty, |(low, high), &index| {
            let (a, b) = self.bounds(index);
            (low.min(a), high.max(b))
        });
        let longer = usize::from((high - low).y > (high - low).x);
        let halves = [longer, 1 - longer].into_iter().find_map(|axis| self.halve(&some, axis));
        match halves {
            Some([before, after]) => {
                drop(some);
                self.sort(before, depth + 1);
                self.sort(after, depth + 1);
            }
            None => self.compare(&some),
        }
    }

    /// Both sides of the median along an axis; `None` where that parts next to nothing.
    fn halve(&self, some: &[u32], axis: usize) -> Option<[Vec<u32>; 2]> {
        let middle = |index: u32| {
            let (low, high) = self.bounds(index);
            0.5 * (low[axis] + high[axis])
        };
        let mut middles: Vec<f64> = some.iter().map(|&index| middle(index)).collect();
        let half = middles.len() / 2;
        let cut = *middles.select_nth_unstable_by(half, f64::total_cmp).1;
        let before: Vec<u32> = some.iter().copied().filter(|&index| self.bounds(index).0[axis] < cut).collect();
        let after: Vec<u32> = some.iter().copied().filter(|&index| self.bounds(index).1[axis] >= cut).collect();
        (before.len().max(after.len()) * 10 < some.len() * 9).then_some([before, after])
    }

    fn compare(&mut self, some: &[u32]) {
        for (place, &first) in some.iter().enumerate() {
            let (low, high) = self.bounds(first);
            for &second in &some[place + 1..] {
                self.work = self.work.saturating_sub(1);
                let (other_low, other_high) = self.bounds(second);
                let is_near = low.cmplt(other_high).all() && other_low.cmplt(high).all();
                if is_near && overlap(self.triangles[first as usize], self.triangles[second as usize], self.slack) {
                    self.pairs.insert([first.min(second), first.max(second)]);
                }
            }
            if self.is_over() {
                return;
            }
        }
    }
}

/// Whether two triangles reach into each other by more than a length.
fn overlap(first: [DVec2; 3], second: [DVec2; 3], slack: f64) -> bool {
    !is_apart(first, second, slack) && !is_apart(second, first, slack)
}

/// Whether an edge of the first has all of the second beyond it.
fn is_apart(first: [DVec2; 3], second: [DVec2; 3], slack: f64) -> bool {
    let turn = (first[1] - first[0]).perp_dot(first[2] - first[0]).signum();
    (0..3).any(|corner| {
        let (from, to) = (first[corner], first[(corner + 1) % 3]);
        let Some(along) = (to - from).try_normalize() else {
            return false;
        };
        second.iter().all(|&point| turn * along.perp_dot(point - from) <= slack)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::combine;

    fn find(triangles: &[[DVec2; 3]], slack: f64) -> Overlaps {
        Overlaps::find(triangles, slack, &CancelToken::default())
    }

    fn grid(count: usize) -> Vec<[DVec2; 3]> {
        let point = |x: usize, y: usize| DVec2::new(x as f64, y as f64) / count as f64;
        (0..count * count)
            .flat_map(|cell| {
                let (x, y) = (cell % count, cell / count);
                [
                    [point(x, y), point(x + 1, y), point(x + 1, y + 1)],
                    [point(x, y), point(x + 1, y + 1), point(x, y + 1)],
                ]
            })
            .collect()
    }

    #[test]
    fn neighbours_do_not_overlap_and_a_planted_triangle_is_found() {
        let mut triangles = grid(40);
        assert!(find(&triangles, 1e-9).is_empty());
        triangles.push([DVec2::new(0.501, 0.5002), DVec2::new(0.502, 0.5003), DVec2::new(0.501, 0.5009)]);
        let found = find(&triangles, 1e-9);
        assert!(!found.pairs.is_empty() && found.pairs.iter().all(|pair| pair[1] == 3200), "{found:?}");
    }

    #[test]
    fn a_fold_is_found_and_so_is_a_copy() {
        let quad = [[DVec2::ZERO, DVec2::X, DVec2::ONE], [DVec2::ZERO, DVec2::ONE, DVec2::new(0.9, 0.1)]];
        assert_eq!(find(&quad, 1e-9).pairs, [[0, 1]]);
        assert_eq!(find(&[quad[0], quad[0]], 1e-9).pairs, [[0, 1]]);
    }

    #[test]
    fn what_touches_within_the_slack_is_apart() {
        let beside = [[DVec2::ZERO, DVec2::X, DVec2::Y], [DVec2::X, DVec2::ONE, DVec2::new(-1e-7, 1.0)]];
        assert!(find(&beside, 1e-6).is_empty());
        assert!(!find(&beside, 1e-9).is_empty());
    }

    /// Against the plain search through all pairs.
    #[test]
    fn no_pair_is_missed() {
        let unit = |key: u64| (combine(91, key) >> 11) as f64 / (1_u64 << 53) as f64;
        let triangles: Vec<[DVec2; 3]> = (0..300)
            .map(|key| {
                let at = DVec2::new(unit(10 * key), unit(10 * key + 1));
                let size = if key % 50 == 0 { 0.4 } else { 0.03 };
                [2, 4, 6].map(|next| at + size * DVec2::new(unit(10 * key + next), unit(10 * key + next + 1)))
            })
            .collect();
        let mut plain = Vec::new();
        for first in 0..triangles.len() {
            for second in first + 1..triangles.len() {
                if overlap(triangles[first], triangles[second], 1e-9) {
                    plain.push([first as u32, second as u32]);
                }
            }
        }
        assert!(plain.len() > 30 && plain.len() < ENOUGH_PAIRS, "{}", plain.len());
        let found = find(&triangles, 1e-9);
        assert_eq!(found.pairs, plain);
        assert!(!found.is_cut);
    }

    #[test]
    fn a_pile_ends_the_search() {
        assert!(find(&vec![grid(1)[0]; 100_000], 1e-9).is_cut);
    }

    #[test]
    fn cancelled_is_cut() {
        let cancel = CancelToken::default();
        cancel.cancel();
        let found = Overlaps::find(&grid(40), 1e-9, &cancel);
        assert!(found.is_cut && !found.is_empty());
    }
}

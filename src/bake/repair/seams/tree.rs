//! Which line segments come near another: a tree of boxes over their middles. Knows nothing of charts.
//!
//! Built by halves along the widest axis (as kd-trees are, Bentley 1975), asked with the segment itself against each
//! box (Kay and Kajiya 1986) and not with its box, or one long slanting edge would be compared with all.

use glam::DVec3;

/// Segments in a leaf.
const LEAF: usize = 4;

/// A box and what is in it.
struct Node {
    low: DVec3,
    high: DVec3,
    /// Range of `SegmentTree::order`; a node of more than a leaf's worth is followed by its first half, and `second`
    /// is the number of its other.
    from: u32,
    to: u32,
    second: u32,
}

/// A tree over segments.
pub(super) struct SegmentTree {
    nodes: Vec<Node>,
    /// Numbers of the segments, leaf by leaf.
    order: Vec<u32>,
}

impl SegmentTree {
    pub(super) fn new(segments: &[[DVec3; 2]]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..segments.len() as u32).collect() };
        if !segments.is_empty() {
            tree.add(segments, 0, segments.len());
        }
        tree
    }

    /// Adds the node of a range and those below it.
    fn add(&mut self, segments: &[[DVec3; 2]], from: usize, to: usize) {
        let ends = |number: &u32| segments[*number as usize];
        let range = &mut self.order[from..to];
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for [a, b] in range.iter().map(ends) {
            (low, high) = (low.min(a).min(b), high.max(a).max(b));
        }
        let node = self.nodes.len();
        self.nodes.push(Node { low, high, from: from as u32, to: to as u32, second: 0 });
        if to - from <= LEAF {
            return;
        }
        let size = high - low;
        let axis = if size.x >= size.y.max(size.z) { 0 } else { 1 + usize::from(size.z > size.y) };
        let middle = |number: &u32| ends(number)[0][axis] + ends(number)[1][axis];
        let half = (to - from) / 2;
        range.select_nth_unstable_by(half, |a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
        self.add(segments, from, from + half);
        self.nodes[node].second = self.nodes.len() as u32;
        self.add(segments, from + half, to);
    }

    /// Tells the numbers of all segments that come within `distance` of a segment, and of some that do not.
    pub(super) fn near(&self, [a, b]: [DVec3; 2], distance: f64, mut tell: impl FnMut(u32)) {
        let mut waiting = if self.nodes.is_empty() { vec![] } else { vec![0] };
        while let Some(number) = waiting.pop() {
            let node: &Node = &self.nodes[number];
            if !crosses(a, b, node.low - distance, node.high + distance) {
                continue;
            }
            if (node.to - node.from) as usize <= LEAF {
                self.order[node.from as usize..node.to as usize].iter().copied().for_each(&mut tell);
            } else {
                waiting.extend([node.second as usize, number + 1]);
            }
        }
    }
}

/// Whether a segment has a point in a box.
fn crosses(a: DVec3, b: DVec3, low: DVec3, high: DVec3) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..3 {
        let (start, way) = (a[axis], b[axis] - a[axis]);
        if way == 0.0 {
            if start < low[axis] || start > high[axis] {
                return false;
            }
            continue;
        }
        let (first, second) = ((low[axis] - start) / way, (high[axis] - start) / way);
        from = from.max(first.min(second));
        to = to.min(first.max(second));
    }
    // As far as its own rounding goes.
    from <= to + 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::combine;

    fn random(key: u64) -> f64 {
        (combine(0x5e9, key) >> 11) as f64 / (1_u64 << 53) as f64
    }

    #[test]
    fn all_that_touch_are_told() {
        let point = |key: u64| DVec3::new(random(3 * key), random(3 * key + 1), random(3 * key + 2));
        let short = |key: u64| {
            let from = point(key);
            // Every tenth is as long as the whole.
            let reach = if key.is_multiple_of(10) { 1.0 } else { 0.05 };
            [from, from + reach * (point(key + 10_000) - 0.5)]
        };
        let segments: Vec<[DVec3; 2]> = (0..2000).map(short).collect();
        let tree = SegmentTree::new(&segments);
        let mut told = 0;
        for (number, &[a, b]) in segments.iter().enumerate() {
            let mut near = Vec::new();
            // From a point of each: it itself and those that start there must be found.
            let at = a.lerp(b, 0.3);
            tree.near([at, at + DVec3::splat(1e-3)], 1e-6, |other| near.push(other));
            assert!(near.contains(&(number as u32)), "{number}");
            told += near.len();
        }
        assert!(told < 2000 * 300, "{told}");
    }
}

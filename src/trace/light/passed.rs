//! Which of the sources that block nothing a ray passes: a tree of boxes over them, halved along the longest side.
//! Reports in an order of its own that depends on the sources alone.

use super::Emitter;
use glam::Vec3;

/// Deeper than halves can go.
const STACK: usize = 40;

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// Of an inner node, the right child (the left one follows at once); of a leaf, the source.
    link: u32,
    is_leaf: bool,
}

/// The sources that block nothing and have a size.
#[derive(Debug, Default)]
pub(super) struct Passable {
    nodes: Vec<Node>,
}

impl Passable {
    /// Over some of the sources, by number.
    pub(super) fn new(emitters: &[Emitter], numbers: &[u32]) -> Self {
        let mut members: Vec<(u32, [Vec3; 2])> = numbers
            .iter()
            .map(|&number| {
                let emitter = &emitters[number as usize];
                let [low, high] = emitter.extent();
                // What a ray meets is computed with as much error, and a flat box must have a thickness.
                let margin = 4.0 * emitter.error + Vec3::splat(f32::MIN_POSITIVE);
                (number, [low - margin, high + margin])
            })
            .collect();
        let mut tree = Self::default();
        if !members.is_empty() {
            tree.add(&mut members);
        }
        tree
    }

    fn add(&mut self, members: &mut [(u32, [Vec3; 2])]) {
        let (low, high) = members
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), (_, [l, h])| (low.min(*l), high.max(*h)));
        let number = self.nodes.len();
        self.nodes.push(Node { low, high, link: members[0].0, is_leaf: members.len() == 1 });
        if members.len() == 1 {
            return;
        }
        let axis = (high - low).max_position();
        let middle = |[low, high]: [Vec3; 2]| low[axis] + high[axis];
        members.sort_by(|(a, left), (b, right)| middle(*left).total_cmp(&middle(*right)).then(a.cmp(b)));
        let (left, right) = members.split_at_mut(members.len() / 2);
        self.add(left);
        self.nodes[number].link = self.nodes.len() as u32;
        self.add(right);
    }

    /// Whether there is none.
    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The sources whose boxes a ray meets before `end`.
    pub(super) fn candidates(&self, origin: Vec3, direction: Vec3, end: f32) -> Candidates<'_> {
        // Finite, so that a ray along a side gives no NaN.
        let inverse = direction.map(|d| if d.abs() < 1e-30 { 1e30_f32.copysign(d) } else { d.recip() });
        let mut stack = [0; STACK];
        stack[0] = 0;
        Candidates { nodes: &self.nodes, origin, inverse, end, stack, depth: usize::from(!self.nodes.is_empty()) }
    }
}

/// What is left of a walk through the boxes.
pub(super) struct Candidates<'a> {
    nodes: &'a [Node],
    origin: Vec3,
    inverse: Vec3,
    end: f32,
    stack: [u32; STACK],
    depth: usize,
}

impl Iterator for Candidates<'_> {
    type Item = u32;

    fn next(&mut self) -> Option<u32> {
        while self.depth > 0 {
            self.depth -= 1;
            let number = self.stack[self.depth];
            let node = &self.nodes[number as usize];
            let (a, b) = ((node.low - self.origin) * self.inverse, (node.high - self.origin) * self.inverse);
            let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
            // A little wider than computed, by what rounding may take.
            if near > far * (1.0 + 4.0 * f32::EPSILON) || far < 0.0 || near > self.end {
                continue;
            }
            if node.is_leaf {
                return Some(node.link);
            }
            self.stack[self.depth] = node.link;
            self.stack[self.depth + 1] = number + 1;
            self.depth += 2;
        }
        None
    }
}

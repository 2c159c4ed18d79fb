//! Which of many sources to aim at: a binary tree over them, descended by chance in proportion to what each side can
//! give to the receiver (Conty Estevez and Kulla 2018). Splits go where the cost of having sources together, by size,
//! directions and intensity, falls most. One variate serves all steps; the chance of a source is found again by going
//! down the same way.

use super::bounds::{Bounds, Group};
use super::{Emitter, LightContext};
use glam::DVec3;

/// Intervals in which splits are tried, per axis.
const BINS: usize = 12;

/// Deepest leaf; the way to it is one bit per step.
const MAX_DEPTH: u32 = 64;

/// A source that is not in the tree, since it gives no light.
const NOWHERE: u32 = u32::MAX;

/// A node; nodes lie in the order of a walk that goes left first.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// Of an inner node, the right child (the left one follows at once); of a leaf, the source.
    link: u32,
    is_leaf: bool,
}

/// A tree over sources.
#[derive(Debug)]
pub(super) struct LightTree {
    nodes: Vec<Node>,
    /// Per source, its leaf or [`NOWHERE`].
    leaf_of: Vec<u32>,
    /// Per source, the way to its leaf: bit k is set where step k goes right.
    trails: Vec<u64>,
}

/// A source that was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    pub(super) source: u32,
    pub(super) probability: f64,
}

impl LightTree {
    /// Over those of the sources that give light; `None` if none does. Their order must not depend on how the scene is
    /// stored.
    pub(super) fn new(emitters: &[Emitter]) -> Option<Self> {
        let mut members: Vec<(u32, Group)> =
            emitters.iter().enumerate().map(|(index, emitter)| (index as u32, Group::of(emitter))).collect();
        members.retain(|(_, group)| group.intensity > 0.0 && group.intensity.is_finite());
        if members.is_empty() {
            return None;
        }
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * members.len() - 1),
            leaf_of: vec![NOWHERE; emitters.len()],
            trails: vec![0; emitters.len()],
        };
        tree.add(&mut members, 0, 0);
        Some(tree)
    }

    fn add(&mut self, members: &mut [(u32, Group)], depth: u32, trail: u64) {
        let all = union(members);
        let number = self.nodes.len() as u32;
        let leaf = Node { bounds: Bounds::from(&all), link: members[0].0, is_leaf: true };
        self.nodes.push(leaf);
        if let [(source, _)] = members {
            self.leaf_of[*source as usize] = number;
            self.trails[*source as usize] = trail;
            return;
        }
        // A lopsided tree could grow deeper than a trail is long; halves never do.
        let left_over = MAX_DEPTH - depth;
        let needed = usize::BITS - (members.len() - 1).leading_zeros();
        let middle =
            if needed + 1 >= left_over { None } else { split(members, &all) }.unwrap_or_else(|| halve(members));
        let (left, right) = members.split_at_mut(middle);
        self.add(left, depth + 1, trail);
        self.nodes[number as usize].link = self.nodes.len() as u32;
        self.nodes[number as usize].is_leaf = false;
        self.add(right, depth + 1, trail | 1 << depth);
    }

    /// The irradiance that all sources together give [lx, as brightness]: an estimate, and 0 only if they give none.
    pub(super) fn importance(&self, ctx: &LightContext) -> f64 {
        self.nodes[0].bounds.importance(ctx)
    }

    /// The source that belongs to `u` in [0, 1); `None` if none can give light here.
    pub(super) fn choose(&self, ctx: &LightContext, mut u: f64) -> Option<Choice> {
        let (mut number, mut probability) = (0, 1.0);
        loop {
            let node = &self.nodes[number as usize];
            if node.is_leaf {
                return Some(Choice { source: node.link, probability });
            }
            let left = self.chance_of_left(number, ctx)?;
            if u < left {
                u /= left;
                probability *= left;
                number += 1;
            } else {
                u = (u - left) / (1.0 - left);
                probability *= 1.0 - left;
                number = node.link;
            }
        }
    }

    /// The chance with which [`Self::choose`] takes this source.
    pub(super) fn probability(&self, ctx: &LightContext, source: u32) -> f64 {
        let (leaf, mut trail) = (self.leaf_of[source as usize], self.trails[source as usize]);
        if leaf == NOWHERE {
            return 0.0;
        }
        let (mut number, mut probability) = (0, 1.0);
        while number != leaf {
            let Some(left) = self.chance_of_left(number, ctx) else {
                return 0.0;
            };
            if trail & 1 == 0 {
                probability *= left;
                number += 1;
            } else {
                probability *= 1.0 - left;
                number = self.nodes[number as usize].link;
            }
            trail >>= 1;
        }
        probability
    }

    /// The chance of going left from an inner node; `None` if there is nothing on either side.
    #[inline]
    fn chance_of_left(&self, number: u32, ctx: &LightContext) -> Option<f64> {
        let left = self.nodes[number as usize + 1].bounds.importance(ctx);
        let right = self.nodes[self.nodes[number as usize].link as usize].bounds.importance(ctx);
        let sum = left + right;
        (sum > 0.0).then(|| if sum.is_finite() { left / sum } else { 0.5 })
    }
}

fn union(members: &[(u32, Group)]) -> Group {
    let (first, rest) = members.split_first().expect("a node has members");
    rest.iter().fold(first.1, |all, (_, group)| all.union(group))
}

/// Parts the members in two where that costs least, and tells how many are in the first; `None` where they all lie in
/// one place.
fn split(members: &mut [(u32, Group)], all: &Group) -> Option<usize> {
    let centres = members.iter().map(|(_, group)| group.centre());
    let (low, high) =
        centres.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), centre| (low.min(centre), high.max(centre)));
    let size = high - low;
    let bin_of = |group: &Group, axis: usize| {
        ((BINS as f64 * (group.centre()[axis] - low[axis]) / size[axis]) as usize).min(BINS - 1)
    };
    let box_size = all.high - all.low;
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| size[axis] > 0.0) {
        let mut bins: [Option<Group>; BINS] = [None; BINS];
        for (_, group) in members.iter() {
            let bin = &mut bins[bin_of(group, axis)];
            *bin = Some(bin.map_or(*group, |all| all.union(group)));
        }
        let join = |all: Option<Group>, bin: &Option<Group>| match (all, bin) {
            (Some(all), Some(bin)) => Some(all.union(bin)),
            (all, bin) => all.or(*bin),
        };
        // Cuts across the long side are better than thin slices.
        let thinness = box_size.max_element() / box_size[axis].max(f64::MIN_POSITIVE);
        for cut in 1..BINS {
            let sides = [bins[..cut].iter().fold(None, join), bins[cut..].iter().fold(None, join)];
            let [Some(left), Some(right)] = sides else { continue };
            let cost = thinness * (left.cost() + right.cost());
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, cut));
            }
        }
    }
    let (_, axis, cut) = best?;
    // Stable, so that what is equal stays in the order of the sources.
    members.sort_by_key(|(_, group)| bin_of(group, axis) >= cut);
    Some(members.partition_point(|(_, group)| bin_of(group, axis) < cut))
}

/// Parts the members in halves along the longest side.
fn halve(members: &mut [(u32, Group)]) -> usize {
    let size = union(members);
    let size = size.high - size.low;
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    members.sort_by(|(a, left), (b, right)| left.centre()[axis].total_cmp(&right.centre()[axis]).then(a.cmp(b)));
    members.len() / 2
}

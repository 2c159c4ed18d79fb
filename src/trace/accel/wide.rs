//! The tree that rays walk through: nodes of eight boxes and packets of eight triangles, made of a binary tree.

use super::lanes::LANES;
use super::packet::Packet;
use glam::Vec3;
use prefetch_index::prefetch_index;

/// Set in the number of a child that is a packet.
pub(super) const LEAF: u32 = 1 << 31;

/// Levels that follow the binary tree; below, triangles are dealt out evenly, so that the depth has a bound whatever
/// that tree looks like.
const LEVELS: u32 = 24;

/// What a walk may have to remember: of each level all children but one. Even dealing of 2³¹ triangles takes 10 levels.
pub(super) const STACK: usize = 256;

const _: () = assert!((LEVELS as usize + 10) * (LANES - 1) < STACK);

/// Eight boxes.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Low and high sides, by axis and child. Those of no child are turned inside out, which nothing enters.
    pub(super) sides: [[[f32; LANES]; 3]; 2],
    /// Numbers of nodes, or of packets with [`LEAF`].
    pub(super) children: [u32; LANES],
}

/// A box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

/// A node of the binary tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binary {
    pub(super) bounds: Bounds,
    /// Triangles of a leaf, or the first of its two children, which follow each other.
    pub(super) first: u32,
    /// How many triangles a leaf has; 0 for inner nodes.
    pub(super) count: u32,
}

/// What the tree is made of.
pub(super) struct Source<'a, N: Fn(u32) -> Binary> {
    /// The binary tree's nodes; 0 is its root.
    pub(super) node: N,
    pub(super) node_count: usize,
    /// Triangles in the order of its leaves.
    pub(super) order: &'a [u32],
    pub(super) triangles: &'a [[Vec3; 3]],
    /// Boxes of the triangles.
    pub(super) boxes: &'a [Bounds],
}

/// The tree.
#[derive(Debug, Default)]
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) packets: Vec<Packet>,
}

/// Triangles that become one child.
#[derive(Clone, Copy)]
struct Part {
    bounds: Bounds,
    begin: u32,
    count: u32,
    /// Whether they become a packet; a node else.
    is_packet: bool,
    /// The binary node that has them; `None` where they are dealt out.
    binary: Option<u32>,
}

impl Bounds {
    const NONE: Self = Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    fn and(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn half_area(self) -> f32 {
        let size = self.high - self.low;
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// What it costs to test a packet, in what it costs to test a node's boxes.
const PACKET_COST: f32 = 1.2;

/// Binary nodes of fewer triangles are not taken apart.
const WHOLE: u32 = 4;

/// How the triangles below a binary node are best made into children of one node, by how many those may be (Wald,
/// Benthin and Boulos 2008; Ylitie, Karras and Laine 2017, § 3.1).
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// Expected cost, by the number of children less one, in areas of boxes.
    cost: [f32; LANES],
    /// How many of the children its left half gets; 0 for as with one child less. The first: 1 for a node of its own.
    left: [u8; LANES],
}

/// A tree in the making.
struct Builder<'a, N: Fn(u32) -> Binary> {
    source: Source<'a, N>,
    /// Triangles in depth-first order, so that those below a binary node follow each other.
    order: Vec<u32>,
    /// Per binary node, where its triangles begin and how many there are.
    ranges: Vec<[u32; 2]>,
    /// Per binary node, its plan's number; [`NO_PLAN`] for those that are not taken apart.
    plan_of: Vec<u32>,
    plans: Vec<Plan>,
    tree: Tree,
}

/// Has no plan.
const NO_PLAN: u32 = u32::MAX;

impl Tree {
    /// Makes a tree of eight-way nodes.
    pub(super) fn new<N: Fn(u32) -> Binary>(source: Source<'_, N>) -> Self {
        if source.triangles.is_empty() {
            return Self::default();
        }
        let count = source.node_count;
        let mut builder = Builder {
            order: Vec::with_capacity(source.triangles.len()),
            ranges: vec![[0; 2]; count],
            plan_of: vec![NO_PLAN; count],
            plans: Vec::new(),
            tree: Self::default(),
            source,
        };
        let visited = builder.put_in_order();
        visited.into_iter().rev().for_each(|number| builder.plan(number));
        builder.build();
        builder.tree
    }

    /// Every triangle and its number.
    #[cfg(test)]
    pub(super) fn triangles(&self) -> impl Iterator<Item = ([Vec3; 3], u32)> {
        let lanes = |packet: &Packet| (0..LANES).map(|lane| (packet.triangle(lane), packet.numbers[lane])).collect();
        self.packets
            .iter()
            .flat_map(move |packet| -> Vec<_> { lanes(packet) })
            .filter(|(_, number)| *number != u32::MAX)
    }

    /// Has the memory of a child brought nearer: it is needed soon, and where trees are large it is far away.
    #[inline(always)]
    pub(super) fn prefetch(&self, child: u32) {
        if child & LEAF != 0 {
            self.packets[(child ^ LEAF) as usize].prefetch();
        } else {
            for [x, _, z] in &self.nodes[child as usize].sides {
                prefetch_index(x, 0);
                prefetch_index(z, 0);
            }
        }
    }

    /// Memory that it holds [bytes].
    pub(super) fn memory_bytes(&self) -> u64 {
        (self.nodes.capacity() * size_of::<Node>() + self.packets.capacity() * size_of::<Packet>()) as u64
    }
}

impl<N: Fn(u32) -> Binary> Builder<'_, N> {
    /// Puts the triangles in depth-first order; all binary nodes, each before its children.
    fn put_in_order(&mut self) -> Vec<u32> {
        // Without recursion, which a degenerate tree would take too deep.
        let mut visited = Vec::with_capacity(self.source.node_count);
        let mut open = vec![0];
        while let Some(number) = open.pop() {
            visited.push(number);
            let node = (self.source.node)(number);
            self.ranges[number as usize] = [self.order.len() as u32, node.count];
            if node.count > 0 {
                let leaf = node.first as usize..(node.first + node.count) as usize;
                self.order.extend_from_slice(&self.source.order[leaf]);
            } else {
                open.extend([node.first + 1, node.first]);
            }
        }
        visited
    }

    /// Counts and plans for a binary node whose children have been.
    fn plan(&mut self, number: u32) {
        let node = (self.source.node)(number);
        if node.count > 0 {
            return;
        }
        let children = [node.first, node.first + 1];
        let count = children.iter().map(|&child| self.ranges[child as usize][1]).sum();
        self.ranges[number as usize][1] = count;
        if count < WHOLE {
            return;
        }
        let [l, r] = children.map(|child| self.costs(child));
        let area = node.bounds.half_area();
        let mut plan = Plan { cost: [f32::INFINITY; LANES], left: [0; LANES] };
        for most in 2..=LANES {
            plan.cost[most - 1] = plan.cost[most - 2];
            for left in 1..most {
                let cost = l[left - 1] + r[most - left - 1];
                if cost < plan.cost[most - 1] {
                    (plan.cost[most - 1], plan.left[most - 1]) = (cost, left as u8);
                }
            }
        }
        let own = area + plan.cost[LANES - 1];
        let packet = if count as usize <= LANES { PACKET_COST * area } else { f32::INFINITY };
        plan.left[0] = u8::from(own < packet);
        plan.cost[0] = own.min(packet);
        for most in 1..LANES {
            if plan.cost[most] >= plan.cost[0] {
                (plan.cost[most], plan.left[most]) = (plan.cost[most - 1], 0);
            }
        }
        self.plan_of[number as usize] = self.plans.len() as u32;
        self.plans.push(plan);
    }

    fn costs(&self, binary: u32) -> [f32; LANES] {
        match self.plan_of[binary as usize] {
            NO_PLAN => [PACKET_COST * (self.source.node)(binary).bounds.half_area(); LANES],
            plan => self.plans[plan as usize].cost,
        }
    }

    fn build(&mut self) {
        let mut open = vec![(self.part(0), 0, 0)];
        self.tree.nodes.push(Node::EMPTY);
        while let Some((part, node, level)) = open.pop() {
            for (lane, part) in self.split(part, level).into_iter().enumerate() {
                let child = if part.is_packet {
                    self.packet(part)
                } else {
                    let number = self.tree.nodes.len() as u32;
                    self.tree.nodes.push(Node::EMPTY);
                    open.push((part, number, level + 1));
                    number
                };
                self.tree.nodes[node as usize].set(lane, part.bounds, child);
            }
        }
        self.tree.nodes.shrink_to_fit();
        self.tree.packets.shrink_to_fit();
    }

    fn part(&self, binary: u32) -> Part {
        let [begin, count] = self.ranges[binary as usize];
        let is_packet = match self.plan_of[binary as usize] {
            NO_PLAN => count as usize <= LANES,
            plan => self.plans[plan as usize].left[0] == 0,
        };
        Part { bounds: (self.source.node)(binary).bounds, begin, count, is_packet, binary: Some(binary) }
    }

    fn packet(&mut self, part: Part) -> u32 {
        let numbers = &self.order[part.begin as usize..(part.begin + part.count) as usize];
        let triangles = numbers.iter().map(|&number| (self.source.triangles[number as usize], number));
        self.tree.packets.push(Packet::new(triangles));
        (self.tree.packets.len() - 1) as u32 | LEAF
    }

    /// Up to eight parts of one, as planned.
    fn split(&self, part: Part, level: u32) -> Vec<Part> {
        let planned = part.binary.filter(|&binary| level < LEVELS && self.plan_of[binary as usize] != NO_PLAN);
        let Some(binary) = planned else {
            return self.deal(part);
        };
        let (mut parts, mut open) = (Vec::with_capacity(LANES), vec![(binary, LANES)]);
        while let Some((binary, most)) = open.pop() {
            let plan = self.plan_of[binary as usize];
            let left = if plan == NO_PLAN { 0 } else { usize::from(self.plans[plan as usize].left[most - 1]) };
            if most == 1 || plan == NO_PLAN {
                parts.push(self.part(binary));
            } else if left == 0 {
                open.push((binary, most - 1));
            } else {
                let first = (self.source.node)(binary).first;
                open.extend([(first, left), (first + 1, most - left)]);
            }
        }
        // What is large blocks most: shadow rays look there first.
        parts.sort_by(|a, b| a.bounds.half_area().total_cmp(&b.bounds.half_area()));
        parts
    }

    /// Deals triangles out evenly.
    fn deal(&self, part: Part) -> Vec<Part> {
        let share = part.count.div_ceil(LANES as u32).max(LANES as u32);
        let range = |begin: u32| {
            let count = share.min(part.begin + part.count - begin);
            let numbers = &self.order[begin as usize..(begin + count) as usize];
            let boxes = numbers.iter().map(|&number| self.source.boxes[number as usize]);
            let is_packet = count as usize <= LANES;
            Part { bounds: boxes.fold(Bounds::NONE, Bounds::and), begin, count, is_packet, binary: None }
        };
        (part.begin..part.begin + part.count).step_by(share as usize).map(range).collect()
    }
}

impl Node {
    const EMPTY: Self =
        Self { sides: [[[f32::INFINITY; LANES]; 3], [[f32::NEG_INFINITY; LANES]; 3]], children: [0; LANES] };

    fn set(&mut self, lane: usize, bounds: Bounds, child: u32) {
        for axis in 0..3 {
            self.sides[0][axis][lane] = bounds.low[axis];
            self.sides[1][axis][lane] = bounds.high[axis];
        }
        self.children[lane] = child;
    }
}

//! Rays on their way through the tree: the nearest hit, and any that stops. Written for any way to compute with eight
//! numbers at once; which triangle is found does not depend on it, nor on the order in which boxes are entered.

use super::End;
use super::lanes::Lanes;
use super::packet::{Crossings, Packet, PacketRay};
use super::wide::{LEAF, Node, STACK, Tree};
use crate::trace::triangle::{Crossing, ShearedRay};
use arrayvec::ArrayVec;
use glam::Vec3;

/// A ray and the tree that it goes through.
#[derive(Clone, Copy)]
pub(super) struct Walk<'a> {
    pub(super) tree: &'a Tree,
    pub(super) ray: &'a ShearedRay,
    /// Where it starts.
    pub(super) start: End,
}

/// A triangle that was met.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub(super) t: f32,
    /// The caller's number.
    pub(super) triangle: u32,
    pub(super) barycentric: [f32; 2],
}

/// A ray, spread over the lanes, for the slab test.
///
/// A component of 0 or −0 has an infinite inverse, whose sign tells the near side as that of any other does. A side
/// that then lies at the origin itself gives 0·∞, no number, which [`Lanes::min`] and [`Lanes::max`] pass over: the
/// box is entered.
struct Slabs<L: Lanes> {
    origin: [L::F; 3],
    inverse: [L::F; 3],
    /// Which side of boxes is near.
    near: [usize; 3],
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    fn new(lanes: L, start: &End) -> Self {
        let (o, d) = (start.position, start.inwards);
        let [x, y, z] = [d.x.recip(), d.y.recip(), d.z.recip()];
        Self {
            origin: [lanes.splat(o.x), lanes.splat(o.y), lanes.splat(o.z)],
            inverse: [lanes.splat(x), lanes.splat(y), lanes.splat(z)],
            near: [x.is_sign_negative().into(), y.is_sign_negative().into(), z.is_sign_negative().into()],
        }
    }

    /// Where a ray meets the near or the far sides of boxes along an axis.
    #[inline(always)]
    fn reach(&self, lanes: L, node: &Node, axis: usize, side: usize) -> L::F {
        lanes.mul(lanes.sub(lanes.load(&node.sides[side][axis]), self.origin[axis]), self.inverse[axis])
    }

    /// Which boxes a ray enters before `end`, each a bit, and where.
    #[inline(always)]
    fn enter(&self, lanes: L, node: &Node, end: f32) -> (u32, L::F) {
        let [x, y, z] = self.near;
        let enter = lanes.max(self.reach(lanes, node, 0, x), lanes.splat(0.0));
        let enter = lanes.max(self.reach(lanes, node, 1, y), enter);
        let enter = lanes.max(self.reach(lanes, node, 2, z), enter);
        let leave = lanes.min(self.reach(lanes, node, 0, 1 - x), lanes.splat(end));
        let leave = lanes.min(self.reach(lanes, node, 1, 1 - y), leave);
        let leave = lanes.min(self.reach(lanes, node, 2, 1 - z), leave);
        (lanes.signs(lanes.le(enter, leave)), enter)
    }
}

/// The bits that are set, lowest first.
struct Bits(u32);

impl Iterator for Bits {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        let lane = self.0.trailing_zeros() as usize;
        let is_set = self.0 != 0;
        self.0 &= self.0.wrapping_sub(1);
        is_set.then_some(lane)
    }
}

/// A child and where it is entered, such that nearer ones are less: a distance that is not negative orders as its bits.
#[inline(always)]
fn open(enter: f32, child: u32) -> u64 {
    u64::from(enter.to_bits()) << 32 | u64::from(child)
}

impl Walk<'_> {
    /// Whether there is a tree and the ray is made of numbers, which the slab test takes for granted.
    #[inline(always)]
    fn is_anywhere(&self) -> bool {
        !self.tree.nodes.is_empty() && !(self.start.position + self.start.inwards).is_nan()
    }

    /// The nearest triangle before `end`; of several at the same distance, that of the smallest number. Tells the number
    /// of each that is the nearest so far.
    #[inline(always)]
    pub(super) fn nearest<L: Lanes>(self, lanes: L, end: f32, tell: impl Fn(u32)) -> Option<Met> {
        let (slabs, ray) = (Slabs::new(lanes, &self.start), PacketRay::new(lanes, self.ray));
        // Nothing has a smaller number than 0: what lies at the end itself is not before it.
        let mut nearest = Met { t: end, triangle: 0, barycentric: [0.0; 2] };
        let mut found = false;
        let mut stack = ArrayVec::<u64, STACK>::new();
        let mut current = 0;
        if !self.is_anywhere() {
            return None;
        }
        loop {
            if current & LEAF != 0 {
                if self.nearest_of(lanes, &ray, &self.tree.packets[(current ^ LEAF) as usize], &mut nearest) {
                    found = true;
                    tell(nearest.triangle);
                }
            } else {
                let node = &self.tree.nodes[current as usize];
                let (entered, enter) = slabs.enter(lanes, node, nearest.t);
                if entered != 0 {
                    let enter = lanes.store(enter);
                    let bottom = stack.len();
                    let mut first = u64::MAX;
                    for lane in Bits(entered) {
                        let mut key = open(enter[lane], node.children[lane]);
                        self.tree.prefetch(node.children[lane]);
                        if first == u64::MAX {
                            first = key;
                            continue;
                        }
                        if key < first {
                            std::mem::swap(&mut key, &mut first);
                        }
                        let mut at = stack.len();
                        stack.push(key);
                        while at > bottom && stack[at - 1] < key {
                            stack[at] = stack[at - 1];
                            at -= 1;
                        }
                        stack[at] = key;
                    }
                    current = first as u32;
                    continue;
                }
            }
            loop {
                let Some(key) = stack.pop() else { return found.then_some(nearest) };
                if f32::from_bits((key >> 32) as u32) <= nearest.t {
                    current = key as u32;
                    break;
                }
            }
        }
    }

    /// Takes what is nearer in a packet; whether there was any.
    #[inline(always)]
    fn nearest_of<L: Lanes>(&self, lanes: L, ray: &PacketRay<L>, packet: &Packet, nearest: &mut Met) -> bool {
        let mut found = false;
        let (crossings, zeros) = ray.cross(lanes, packet);
        let nearer = crossings.crossed & lanes.signs(lanes.le(crossings.t, lanes.splat(nearest.t)));
        if nearer != 0 {
            let error = crossings.t_error(lanes);
            let certain = lanes.signs(lanes.lt(error, crossings.t));
            let possible = is_possible(lanes, crossings.t, error);
            let (t, barycentric) = (lanes.store(crossings.t), crossings.barycentric(lanes));
            for lane in Bits(nearer & possible) {
                if nearest.is_after(t[lane], packet.numbers[lane])
                    && (certain & 1 << lane != 0 || self.start.sees(&packet.triangle(lane)))
                {
                    let barycentric = [barycentric[0][lane], barycentric[1][lane]];
                    *nearest = Met { t: t[lane], triangle: packet.numbers[lane], barycentric };
                    found = true;
                }
            }
        }
        for lane in Bits(zeros) {
            if let Some(crossing) = ray.cross_one(packet, lane)
                && nearest.is_after(crossing.t, packet.numbers[lane])
                && self.start.is_behind(crossing.t, crossing.t_error, &packet.triangle(lane))
            {
                *nearest = Met { t: crossing.t, triangle: packet.numbers[lane], barycentric: crossing.barycentric };
                found = true;
            }
        }
        found
    }

    /// Whether `stops` says so of a triangle that lies before `end`, if there is an end. Each is asked for once at
    /// most, in no order.
    #[inline(always)]
    pub(super) fn any<L: Lanes>(self, lanes: L, end: Option<(End, f32)>, mut stops: impl FnMut(Met) -> bool) -> bool {
        let (slabs, ray) = (Slabs::new(lanes, &self.start), PacketRay::new(lanes, self.ray));
        let distance = end.map_or(f32::INFINITY, |(_, distance)| distance);
        let mut stack = ArrayVec::<u32, STACK>::new();
        let mut current = 0;
        if !self.is_anywhere() {
            return false;
        }
        loop {
            if current & LEAF != 0 {
                let packet = &self.tree.packets[(current ^ LEAF) as usize];
                let (crossings, zeros) = ray.cross(lanes, packet);
                if crossings.crossed != 0 && self.any_of(lanes, packet, &crossings, end, &mut stops) {
                    return true;
                }
                for lane in Bits(zeros) {
                    if let Some(crossing) = ray.cross_one(packet, lane)
                        && self.is_between(&crossing, end, &packet.triangle(lane))
                        && stops(Met::new(&crossing, packet.numbers[lane]))
                    {
                        return true;
                    }
                }
            } else {
                let node = &self.tree.nodes[current as usize];
                let (entered, _) = slabs.enter(lanes, node, distance);
                for lane in Bits(entered) {
                    stack.push(node.children[lane]);
                    self.tree.prefetch(node.children[lane]);
                }
            }
            let Some(next) = stack.pop() else { return false };
            current = next;
        }
    }

    /// The same of the triangles of a packet.
    #[inline(always)]
    fn any_of<L: Lanes>(
        &self,
        lanes: L,
        packet: &Packet,
        crossings: &Crossings<L>,
        end: Option<(End, f32)>,
        stops: &mut impl FnMut(Met) -> bool,
    ) -> bool {
        let error = crossings.t_error(lanes);
        let mut between = crossings.crossed & is_possible(lanes, crossings.t, error);
        if let Some((_, distance)) = end {
            let left = lanes.sub(lanes.splat(distance), crossings.t);
            between &= is_possible(lanes, left, lanes.add(error, lanes.splat(end_error(distance))));
        }
        if between == 0 {
            return false;
        }
        let (t, t_error, barycentric) = (lanes.store(crossings.t), lanes.store(error), crossings.barycentric(lanes));
        for lane in Bits(between) {
            let barycentric = [barycentric[0][lane], barycentric[1][lane]];
            let crossing = Crossing { t: t[lane], t_error: t_error[lane], barycentric };
            if crossing.t.is_finite()
                && self.is_between(&crossing, end, &packet.triangle(lane))
                && stops(Met::new(&crossing, packet.numbers[lane]))
            {
                return true;
            }
        }
        false
    }

    /// Whether a crossing lies after the ray's start, and before its end if it has one.
    #[inline]
    fn is_between(&self, crossing: &Crossing, end: Option<(End, f32)>, triangle: &[Vec3; 3]) -> bool {
        let &Crossing { t, t_error, .. } = crossing;
        self.start.is_behind(t, t_error, triangle)
            && end.is_none_or(|(end, distance)| end.is_behind(distance - t, t_error + end_error(distance), triangle))
    }
}

/// Lanes whose distance is not negative for certain.
#[inline(always)]
fn is_possible<L: Lanes>(lanes: L, t: L::F, error: L::F) -> u32 {
    lanes.signs(lanes.le(lanes.sub(lanes.splat(0.0), error), t))
}

/// Bound on the error of a ray's own length.
#[inline]
fn end_error(distance: f32) -> f32 {
    4.0 * f32::EPSILON * distance
}

impl Met {
    #[inline]
    fn new(crossing: &Crossing, triangle: u32) -> Self {
        Self { t: crossing.t, triangle, barycentric: crossing.barycentric }
    }

    /// Whether a triangle at `t` comes first.
    #[inline(always)]
    fn is_after(&self, t: f32, triangle: u32) -> bool {
        t < self.t || (t == self.t && triangle < self.triangle)
    }
}

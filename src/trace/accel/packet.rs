//! Up to eight triangles at once against one ray: the watertight test of [`crate::trace::triangle`], lane by lane the
//! same operations in the same order, so that what it finds has the same bits. The rare triangle of which an edge
//! function is zero goes to that test itself.

use super::lanes::{LANES, Lanes};
use crate::trace::triangle::{Crossing, ShearedRay, gamma};
use glam::Vec3;
use prefetch_index::prefetch_index;

/// Up to eight triangles.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Packet {
    /// By vertex, coordinate and lane. Lanes without a triangle hold no numbers, which nothing meets.
    vertices: [[[f32; LANES]; 3]; 3],
    /// The caller's numbers.
    pub(super) numbers: [u32; LANES],
}

/// A ray, spread over the lanes.
#[derive(Clone, Copy)]
pub(super) struct PacketRay<'r, L: Lanes> {
    ray: &'r ShearedRay,
    origin: [L::F; 3],
    shear: [L::F; 3],
}

/// How a ray's line crosses the triangles of a packet.
pub(super) struct Crossings<L: Lanes> {
    /// Lanes that it crosses, each lane a bit.
    pub(super) crossed: u32,
    /// Distances; means nothing elsewhere, as the following.
    pub(super) t: L::F,
    sheared: [[L::F; 3]; 3],
    edges: [L::F; 3],
    inverse: L::F,
}

impl Packet {
    /// Of these triangles and their numbers, eight at most.
    pub(super) fn new(triangles: impl Iterator<Item = ([Vec3; 3], u32)>) -> Self {
        let mut packet = Self { vertices: [[[f32::NAN; LANES]; 3]; 3], numbers: [u32::MAX; LANES] };
        for (lane, (corners, number)) in triangles.enumerate() {
            for (vertex, corner) in corners.iter().enumerate() {
                (0..3).for_each(|axis| packet.vertices[vertex][axis][lane] = corner[axis]);
            }
            packet.numbers[lane] = number;
        }
        packet
    }

    /// Has its memory brought nearer.
    #[inline(always)]
    pub(super) fn prefetch(&self) {
        for [x, _, z] in &self.vertices {
            prefetch_index(x, 0);
            prefetch_index(z, 0);
        }
    }

    /// The triangle in a lane.
    #[inline]
    pub(super) fn triangle(&self, lane: usize) -> [Vec3; 3] {
        self.vertices.map(|vertex| Vec3::from_array(vertex.map(|coordinate| coordinate[lane])))
    }
}

// No closures over lanes in here and no `map`: what is not inlined for certain is not compiled for AVX2.

impl<'r, L: Lanes> PacketRay<'r, L> {
    #[inline(always)]
    pub(super) fn new(lanes: L, ray: &'r ShearedRay) -> Self {
        let ([x, y, z], [shear_x, shear_y, scale]) = (ray.axes, ray.shear);
        Self {
            ray,
            origin: [lanes.splat(ray.origin[x]), lanes.splat(ray.origin[y]), lanes.splat(ray.origin[z])],
            shear: [lanes.splat(shear_x), lanes.splat(shear_y), lanes.splat(scale)],
        }
    }

    #[inline(always)]
    fn sheared(&self, lanes: L, vertex: &[[f32; LANES]; 3]) -> [L::F; 3] {
        let [x, y, z] = self.ray.axes;
        let along = lanes.sub(lanes.load(&vertex[z]), self.origin[2]);
        let x = lanes.sub(lanes.load(&vertex[x]), self.origin[0]);
        let y = lanes.sub(lanes.load(&vertex[y]), self.origin[1]);
        [lanes.sub(x, lanes.mul(self.shear[0], along)), lanes.sub(y, lanes.mul(self.shear[1], along)), along]
    }

    /// Crosses the ray's line with the triangles; the second, lanes that [`ShearedRay::cross`] must decide.
    #[inline(always)]
    pub(super) fn cross(&self, lanes: L, packet: &Packet) -> (Crossings<L>, u32) {
        let mut a = self.sheared(lanes, &packet.vertices[0]);
        let mut b = self.sheared(lanes, &packet.vertices[1]);
        let mut c = self.sheared(lanes, &packet.vertices[2]);
        let [u, v, w] = [edge(lanes, c, b), edge(lanes, a, c), edge(lanes, b, a)];
        let zero = lanes.splat(0.0);
        let zeros = lanes.signs(lanes.or(lanes.or(lanes.eq(u, zero), lanes.eq(v, zero)), lanes.eq(w, zero)));
        // Without zeros: both signs, if some sign bit is set and not all are.
        let mixed = lanes.signs(lanes.or(lanes.or(u, v), w)) & !lanes.signs(lanes.and(lanes.and(u, v), w));
        let crossed = !(mixed | zeros) & ((1 << LANES) - 1);
        a[2] = lanes.mul(self.shear[2], a[2]);
        b[2] = lanes.mul(self.shear[2], b[2]);
        c[2] = lanes.mul(self.shear[2], c[2]);
        let inverse = lanes.div(lanes.splat(1.0), lanes.add(lanes.add(u, v), w));
        let sum = lanes.add(lanes.add(lanes.mul(u, a[2]), lanes.mul(v, b[2])), lanes.mul(w, c[2]));
        let t = lanes.mul(sum, inverse);
        (Crossings { crossed, t, sheared: [a, b, c], edges: [u, v, w], inverse }, zeros)
    }

    /// What the plain test says of one lane.
    #[cold]
    #[inline(never)]
    pub(super) fn cross_one(&self, packet: &Packet, lane: usize) -> Option<Crossing> {
        self.ray.cross(&packet.triangle(lane))
    }
}

/// The edge function of two sheared vertices.
#[inline(always)]
fn edge<L: Lanes>(lanes: L, p: [L::F; 3], q: [L::F; 3]) -> L::F {
    lanes.sub(lanes.mul(p[0], q[1]), lanes.mul(p[1], q[0]))
}

#[inline(always)]
fn largest<L: Lanes>(lanes: L, a: L::F, b: L::F, c: L::F) -> L::F {
    lanes.max(lanes.max(lanes.abs(a), lanes.abs(b)), lanes.abs(c))
}

#[inline(always)]
fn times<L: Lanes>(lanes: L, factor: f32, of: L::F) -> L::F {
    lanes.mul(lanes.splat(factor), of)
}

impl<L: Lanes> Crossings<L> {
    /// Bounds on the errors of the distances.
    #[inline(always)]
    pub(super) fn t_error(&self, lanes: L) -> L::F {
        let ([a, b, c], [u, v, w]) = (self.sheared, self.edges);
        let x = largest(lanes, a[0], b[0], c[0]);
        let y = largest(lanes, a[1], b[1], c[1]);
        let z = largest(lanes, a[2], b[2], c[2]);
        let edge = largest(lanes, u, v, w);
        let x_error = times(lanes, gamma(5.0), lanes.add(x, z));
        let y_error = times(lanes, gamma(5.0), lanes.add(y, z));
        let z_error = times(lanes, gamma(3.0), z);
        let products = lanes.add(lanes.mul(times(lanes, gamma(2.0), x), y), lanes.mul(y_error, x));
        let edge_error = times(lanes, 2.0, lanes.add(products, lanes.mul(x_error, y)));
        let sum = lanes.add(lanes.mul(times(lanes, gamma(3.0), edge), z), lanes.mul(edge_error, z));
        let sum = lanes.add(sum, lanes.mul(z_error, edge));
        lanes.mul(times(lanes, 3.0, sum), lanes.abs(self.inverse))
    }

    /// Weights of the second and the third vertex.
    #[inline(always)]
    pub(super) fn barycentric(&self, lanes: L) -> [[f32; LANES]; 2] {
        [lanes.store(lanes.mul(self.edges[1], self.inverse)), lanes.store(lanes.mul(self.edges[2], self.inverse))]
    }
}

//! Points on surfaces, and where a ray that leaves them must start.
//!
//! # Ray origins
//!
//! A computed point does not lie on its triangle exactly, so a ray from it may meet the triangle that it leaves. The
//! origin is moved along the geometric normal by a bound on that error, not by a length in scene units (Wächter and
//! Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection", move by integer steps of the coordinates
//! and, near zero, by 1/65536 of a scene unit: a length that is too much for a small scene and too little for a large
//! one). The method is that of Pharr, Jakob and Humphreys 2023, section 6.8; the bound is our own, for each axis alone,
//! so that a floor at height 0 is left by nothing however far it reaches.
//!
//! u = 2⁻²⁴ is f32's unit round-off and γₙ = n·u/(1 − n·u) bounds n roundings in a row (Higham 2002, lemma 3.1). m is,
//! for each axis, the triangle's largest coordinate in the traced frame; N its exact unit normal.
//!
//! *What does not count.* Vertices are brought to the world in f64, rounded once and moved to the traced frame exactly.
//! That rounding decides where the triangle is, but all rays meet the rounded one, and any a + s·(b − a) + t·(c − a)
//! lies in its plane, whatever error s and t have.
//!
//! *Interpolation.* The computed point ((a + (b − a)·s) + (c − a)·t), s and t ≥ 0, s + t ≤ 1 + γ₅, takes two roundings
//! of a, four of (b − a)·s, three of (c − a)·t. With |b − a| and |c − a| ≤ 2m it is off by at most
//! γ₂·m + γ₄·2m·(s + t) ≤ 10.1 u·m.
//!
//! *The move* by d along the normal, which is off by one rounding itself, rounds each coordinate once more, by u·m and
//! u·d. So with d = k·u·Σ|Nᵢ|·mᵢ a start lies at a height between (k − 11.2)·u·Σ|Nᵢ|·mᵢ and (k + 11.2)·u·Σ|Nᵢ|·mᵢ above
//! its triangle's plane.
//!
//! *The direction* may point below the plane: whoever chose it took the sign of n·d, computed with the rounded normal in
//! three products and two sums, off by γ₄·Σ|Nᵢ·dᵢ|. On its way over the triangle a ray goes no farther than 2m on each
//! axis, so it sinks by at most 8.1 u·Σ|Nᵢ|·mᵢ.
//!
//! The sum is 19.3 u; k = 32 = 16 ε/u is the next power of two. A start is then 20.8 u·Σ|Nᵢ|·mᵢ above its plane or more
//! and meets its triangle nowhere. In a plane along the axes through the traced origin, d = 0, interpolation is exact;
//! the start lies in the plane itself, which is not met from there. Whether a hit near the start lies on the ray's side
//! or the other is decided in f64 ([`super::triangle`]), whose own error is 2⁻²⁹ of these.
//!
//! *What may be missed* in return: a start is no farther than (32 + 11.2)/32 = 1.35 d from its plane, d ≤ 1.91e-6·Σ|Nᵢ|·mᵢ,
//! so a neighbour that lies farther above it is seen.
//!
//! *Beside an edge* all that is not enough: a start within rounding of the edge may lie beyond the wall that stands
//! there. Let walls meet at an angle θ; a start at a distance w from the edge and a height h lies w·sin θ − h·cos θ
//! before the other wall, rounding (11.2 u·Σ|Nᵢ|·mᵢ) aside. Points that rays leave are therefore kept w = 64 u·max m
//! off the edges of their triangle, a shift along the surface as small as that along the normal. With Σ|Nᵢ|·mᵢ ≤ √3·max
//! m this is enough for θ ≥ 62° in the worst case, and in all cases for walls at right angles. In narrower corners the
//! share of starts beyond the other wall is that of a strip as wide as h/tan θ.
//!
//! All of this holds barring underflow: for coordinates of zero or above 10⁻³⁰ m.

use super::traced::TracedFromWorld;
use glam::{DMat3, DVec3, Vec3};
use prefetch_index::prefetch_index;

/// Width of the rim, in the largest error of a coordinate.
const RIM: f64 = 2.0;

/// The largest weight of a vertex on the rim: of triangles so narrow that they would be all rim, most is not.
const WIDEST_RIM: f64 = 0.125;

/// A triangle, in the world or in the traced frame, with what a ray that leaves it must know.
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleShape {
    /// Positions [m].
    pub(super) vertices: [Vec3; 3],
    /// Unit normal of the front.
    pub(super) normal: Vec3,
    /// Bound on the error of each coordinate of a point computed on it [m].
    pub(super) error: Vec3,
    /// Per vertex, the least weight that a point keeps which rays leave.
    pub(super) rim: [f32; 3],
}

/// Brings points to world space, or to the traced frame; rounds once, from f64.
pub(super) struct Placement {
    matrix: DMat3,
    translation: DVec3,
}

impl Placement {
    pub(super) fn new(world_from_local: &glam::Affine3A) -> Self {
        Self {
            matrix: glam::Mat3::from(world_from_local.matrix3).as_dmat3(),
            translation: Vec3::from(world_from_local.translation).as_dvec3(),
        }
    }

    /// The same, to the traced frame.
    pub(super) fn traced(world_from_local: &glam::Affine3A, traced_from_world: TracedFromWorld) -> Self {
        let Self { matrix, translation } = Self::new(world_from_local);
        Self { matrix, translation: translation - traced_from_world.origin() }
    }

    /// Whether it turns counter-clockwise into clockwise.
    pub(super) fn is_mirrored(&self) -> bool {
        self.matrix.determinant() < 0.0
    }

    /// Where a local point comes to lie.
    pub(super) fn position(&self, local: Vec3) -> Vec3 {
        (self.matrix * local.as_dvec3() + self.translation).as_vec3()
    }

    /// The world direction of a local one, of unit length or zero.
    pub(super) fn direction(&self, local: Vec3) -> Vec3 {
        (self.matrix * local.as_dvec3()).normalize_or_zero().as_vec3()
    }

    /// The world direction of a local normal, of unit length or zero.
    pub(super) fn normal(&self, local: Vec3) -> Vec3 {
        // Cofactors, not the inverse transpose: they differ by the determinant, and only its sign matters.
        let cofactors = DMat3::from_cols(
            self.matrix.y_axis.cross(self.matrix.z_axis),
            self.matrix.z_axis.cross(self.matrix.x_axis),
            self.matrix.x_axis.cross(self.matrix.y_axis),
        );
        let sign = if self.is_mirrored() { -1.0 } else { 1.0 };
        (sign * (cofactors * local.as_dvec3())).normalize_or_zero().as_vec3()
    }

    /// A triangle in world space, counter-clockwise seen from its front; `None` if it has no area there.
    pub(super) fn triangle(&self, local: [Vec3; 3]) -> Option<TriangleShape> {
        let [a, b, c] = local.map(|vertex| self.position(vertex));
        let vertices = if self.is_mirrored() { [a, c, b] } else { [a, b, c] };
        let [a, b, c] = vertices.map(Vec3::as_dvec3);
        // Of the rounded vertices: that is the triangle that rays meet.
        let normal = (b - a).cross(c - a).try_normalize()?.as_vec3();
        normal.is_finite().then(|| TriangleShape::new(vertices, normal))
    }
}

/// Bound on the error of each coordinate of a point computed among these, and of what is computed from it: k·u·m [m].
pub(super) fn position_error<const N: usize>(vertices: [Vec3; N]) -> Vec3 {
    16.0 * f32::EPSILON * vertices.iter().fold(Vec3::ZERO, |size, vertex| size.max(vertex.abs()))
}

impl TriangleShape {
    /// Has its memory brought nearer: its first line of cache and its last.
    #[inline(always)]
    pub(super) fn prefetch(&self) {
        prefetch_index(self.vertices.as_slice(), 0);
        prefetch_index(self.rim.as_slice(), 2);
    }

    /// The same triangle in the traced frame. Its vertices are moved exactly, so that its normal stays.
    pub(super) fn moved(&self, traced_from_world: TracedFromWorld) -> Self {
        let vertices = self.vertices.map(|vertex| traced_from_world.point(vertex));
        Self::new(vertices, self.normal)
    }

    fn new(vertices: [Vec3; 3], normal: Vec3) -> Self {
        let error = position_error(vertices);
        let [a, b, c] = vertices.map(Vec3::as_dvec3);
        let double_area = (b - a).cross(c - a).length();
        let width = RIM * f64::from(error.max_element());
        let rim = [c - b, a - c, b - a].map(|edge| (width * edge.length() / double_area).min(WIDEST_RIM) as f32);
        Self { vertices, normal, error, rim }
    }

    /// The point with these weights of the second and third vertex, kept off the edges by the rim.
    #[inline]
    pub(super) fn position(&self, [second, third]: [f32; 2]) -> Vec3 {
        let weights = [1.0 - second - third, second, third];
        if (0..3).any(|vertex| weights[vertex] < self.rim[vertex]) {
            return self.interpolate(self.off_the_edges(weights));
        }
        self.interpolate([second, third])
    }

    #[inline]
    fn interpolate(&self, [second, third]: [f32; 2]) -> Vec3 {
        let [a, b, c] = self.vertices;
        a + (b - a) * second + (c - a) * third
    }

    /// Weights of the second and third vertex, none of the three below the rim: the largest gives what the others get.
    #[cold]
    fn off_the_edges(&self, weights: [f32; 3]) -> [f32; 2] {
        let mut inside = [0, 1, 2].map(|vertex| weights[vertex].max(self.rim[vertex]));
        let largest = if inside[0] >= inside[1].max(inside[2]) { 0 } else { 1 + usize::from(inside[2] > inside[1]) };
        inside[largest] -= inside[0] + inside[1] + inside[2] - 1.0;
        [inside[1], inside[2]]
    }

    /// Whether a point on the triangle, at these weights of the second and third vertex, is its own and not that of a
    /// neighbour of the same winding that shares an edge: of each edge one of its two triangles owns the points.
    pub(super) fn owns(&self, [second, third]: [f32; 2]) -> bool {
        // As far off as three roundings of weights in [0, 1] can bring a point of an edge.
        const ON_EDGE: f32 = 2.0 * f32::EPSILON;
        let weights = [1.0 - second - third, second, third];
        let is_before = |a: Vec3, b: Vec3| a.to_array().partial_cmp(&b.to_array()) == Some(std::cmp::Ordering::Less);
        (0..3).all(|opposite| {
            let [from, to] = [1, 2].map(|step| self.vertices[(opposite + step) % 3]);
            weights[opposite] > ON_EDGE || is_before(from, to)
        })
    }

    /// Area [m²].
    pub(super) fn area(&self) -> f64 {
        let [a, b, c] = self.vertices.map(Vec3::as_dvec3);
        0.5 * (b - a).cross(c - a).length()
    }

    /// `position`, a point on the triangle, moved off it to the side of `direction` by the error bound.
    pub(super) fn leave(&self, position: Vec3, direction: Vec3) -> Vec3 {
        let normal = if self.normal.dot(direction) < 0.0 { -self.normal } else { self.normal };
        let distance = self.error.dot(normal.abs());
        position + normal * distance
    }
}

#[cfg(test)]
mod tests;

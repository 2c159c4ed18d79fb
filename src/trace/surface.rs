//! Points on surfaces, and where a ray that leaves them must start.
//!
//! # Ray origins
//!
//! A computed point does not lie on its triangle exactly, so a ray from it may meet the triangle that it leaves. The
//! origin is moved along the geometric normal by a bound on that error, not by a length in scene units (Wächter and
//! Binder 2019 show why those fail). Each axis has a bound of its own, so that a floor at height 0 is left by next to
//! nothing however far it reaches. With u = 2⁻²⁴, for each axis:
//!
//! - *transform*: vertices are brought to world space in f64 and rounded once, which moves the coordinate by at
//!   most u·|v| plus 2⁻⁵¹·(|M|·|p| + |t|), the f64 product's own error where large terms cancel;
//! - *interpolation*: a + β(b − a) + γ(c − a) with β, γ, β + γ in [0, 1], in f32, is off by at most
//!   γ₃·(|a| + 2·|b − a| + 2·|c − a|) ≤ 27u·m, where m is the triangle's largest coordinate on that axis;
//! - *the move itself* rounds each coordinate once more: u·m and a little.
//!
//! The sum, 32u·m and the transform's part, is [`TriangleShape::error`], e; such an error moves a point off its plane
//! by at most |nx|·ex + |ny|·ey + |nz|·ez, which is the distance of the move. Whether a hit near the new origin lies
//! on its own side or the other is then decided in f64 ([`super::triangle`]).

use glam::{DMat3, DVec3, Vec3};

/// A triangle in world space with what a ray that leaves it must know.
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleShape {
    /// World positions [m].
    pub(super) vertices: [Vec3; 3],
    /// Unit normal of the front.
    pub(super) normal: Vec3,
    /// Bound on the error of each coordinate of a point computed on it [m].
    pub(super) error: Vec3,
}

/// Brings points to world space with a known error.
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

    /// Whether it turns counter-clockwise into clockwise.
    pub(super) fn is_mirrored(&self) -> bool {
        self.matrix.determinant() < 0.0
    }

    /// The world position of a local point.
    pub(super) fn position(&self, local: Vec3) -> Vec3 {
        (self.matrix * local.as_dvec3() + self.translation).as_vec3()
    }

    /// Bound on the error of each coordinate of [`Self::position`], rounding to f32 aside [m].
    fn product_error(&self, local: Vec3) -> DVec3 {
        let local = local.as_dvec3().abs();
        let size = self.matrix.x_axis.abs() * local.x
            + self.matrix.y_axis.abs() * local.y
            + self.matrix.z_axis.abs() * local.z
            + self.translation.abs();
        size * f64::EPSILON * 2.0
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
        let normal = (b - a).cross(c - a).try_normalize()?.as_vec3();
        let product_error = local.iter().fold(DVec3::ZERO, |error, vertex| error.max(self.product_error(*vertex)));
        let error = position_error(vertices) + product_error.as_vec3();
        normal.is_finite().then_some(TriangleShape { vertices, normal, error })
    }
}

/// Bound on the error of each coordinate of a point computed among these, the transform's part aside [m].
pub(super) fn position_error<const N: usize>(vertices: [Vec3; N]) -> Vec3 {
    16.0 * f32::EPSILON * vertices.iter().fold(Vec3::ZERO, |size, vertex| size.max(vertex.abs()))
}

impl TriangleShape {
    /// The point with these weights of the second and third vertex.
    pub(super) fn position(&self, [second, third]: [f32; 2]) -> Vec3 {
        let [a, b, c] = self.vertices;
        a + (b - a) * second + (c - a) * third
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
        let moved = position + normal * distance;
        // Where the move is lost in rounding, the next number on that side.
        let step = |moved: f32, position: f32, normal: f32| {
            if moved != position || normal == 0.0 {
                moved
            } else if normal > 0.0 {
                moved.next_up()
            } else {
                moved.next_down()
            }
        };
        Vec3::new(
            step(moved.x, position.x, normal.x),
            step(moved.y, position.y, normal.y),
            step(moved.z, position.z, normal.z),
        )
    }
}

#[cfg(test)]
mod tests;

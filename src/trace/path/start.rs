//! Where paths start.

use crate::trace::surface::TriangleShape;
use crate::trace::tracer::Tracer;
use glam::Vec3;

/// Where paths start, in the traced frame, and which way it faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathStart {
    /// The point itself [m].
    pub(super) position: Vec3,
    /// The point moved off its surface; where rays start [m].
    pub(super) origin: Vec3,
    /// Unit normal that receives.
    pub(super) normal: Vec3,
    /// Unit normal of the flat surface, on the side that receives; of the smooth one where the point was lifted to it.
    pub(super) geometric_normal: Vec3,
}

impl PathStart {
    /// A start on a triangle, on the side of `normal`.
    pub(in crate::trace) fn new(triangle: &TriangleShape, position: Vec3, normal: Vec3) -> Self {
        let side = if triangle.normal.dot(normal) < 0.0 { -1.0 } else { 1.0 };
        Self { position, origin: triangle.leave(position, normal), normal, geometric_normal: side * triangle.normal }
    }

    /// Where rays start [m].
    pub(in crate::trace) fn origin(&self) -> Vec3 {
        self.origin
    }

    /// Unit normal that receives.
    pub(crate) fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Unit normal of the surface that rays must leave, on the side that receives.
    pub(crate) fn geometric_normal(&self) -> Vec3 {
        self.geometric_normal
    }

    /// The point itself, in the traced frame [m].
    pub(crate) fn position(&self) -> Vec3 {
        self.position
    }

    /// A start in mid-air.
    pub(in crate::trace) fn free(position: Vec3, normal: Vec3) -> Self {
        Self { position, origin: position, normal, geometric_normal: normal }
    }
}

impl Tracer {
    /// A start of paths on a triangle, at these weights of its second and third vertex, on the side of `normal`, the
    /// unit normal that receives.
    pub(crate) fn start_on_triangle(&self, triangle: u32, barycentric: [f32; 2], normal: Vec3) -> PathStart {
        let shape = &self.triangles[triangle as usize];
        PathStart::new(shape, shape.position(barycentric), normal)
    }

    /// A start of paths on a triangle that stands for a smooth surface: of these unit normals at its vertices, between
    /// which the receiving one is interpolated.
    ///
    /// The point is lifted to where the smooth surface is. From the flat triangle, light that comes in flat over the
    /// smooth surface is hidden by the neighbours, which shows as facets along the edge of the shadow (the terminator).
    /// The lift is the interpolation of the point's projections onto the tangent planes at the vertices that lie above
    /// it (Hanika 2021, "Hacking the Shadow Terminator", Ray Tracing Gems II, chapter 4); nothing is moved through a
    /// surface, and nothing where all normals are the triangle's own.
    pub(crate) fn start_on_smooth_triangle(
        &self,
        triangle: u32,
        barycentric: [f32; 2],
        normals: [Vec3; 3],
    ) -> PathStart {
        let shape = &self.triangles[triangle as usize];
        let [second, third] = barycentric;
        let weights = [1.0 - second - third, second, third];
        let smooth: Vec3 = (0..3).map(|vertex| normals[vertex] * weights[vertex]).sum();
        // Normals that point into the surface come from broken exports; the flat one is then the better guess.
        let smooth = smooth.try_normalize().filter(|smooth| smooth.dot(shape.normal) > 0.0);
        let Some(normal) = smooth else { return PathStart::new(shape, shape.position(barycentric), shape.normal) };
        let position = shape.position(barycentric);
        let start = PathStart::new(shape, position, normal);
        let above = |vertex: usize| {
            let height = (position - shape.vertices[vertex]).dot(normals[vertex]);
            normals[vertex] * (-height).max(0.0) * weights[vertex]
        };
        let lift: Vec3 = (0..3).map(above).sum();
        // What is below the rounding of the points themselves lifts nothing.
        if lift.abs().cmple(shape.error).all() || self.accel.is_blocked(start.origin, start.origin + lift) {
            return start;
        }
        // Off the flat triangle what it faces no longer matters; light from behind it is stopped by what it meets.
        PathStart { position: position + lift, origin: start.origin + lift, geometric_normal: normal, ..start }
    }

    /// A start of paths at a point of the world. Within 1e-5 of the scene's extent from a surface the point counts as
    /// lying on the nearest one; and so it does if only the rounding of its own coordinates to f32 keeps it off, far
    /// from the world's origin.
    pub(crate) fn start_at(&self, position_world: Vec3, normal: Vec3) -> PathStart {
        let position = self.traced_from_world.point(position_world);
        let rounding = self.traced_from_world.rounding(position_world).dot(normal.abs());
        // Never nothing, so that a point exactly on a surface is looked at from beside it.
        let fine = rounding + 2.0 * f32::EPSILON * position.abs().dot(normal.abs()).max(1e-3 * self.extent);
        let coarse = rounding + 1e-5 * self.extent;
        let meet = |from: Vec3, direction: Vec3, reach: f32| self.accel.closest(from, direction, reach);
        // Within rounding no side is above or below. Farther off, the other plate of a narrow gap may be in reach too.
        let within_rounding = meet(position + normal * fine, -normal, 2.0 * fine);
        let nearest = within_rounding.or_else(|| {
            let [below, above] = [-normal, normal].map(|direction| meet(position, direction, coarse));
            match (below, above) {
                (Some(below), Some(above)) => Some(if above.t < below.t { above } else { below }),
                (below, above) => below.or(above),
            }
        });
        // In the surface's own plane it is seen from neither side, and by a slanted ray only as exactly as the ray is;
        // in a crack between tiles, as wide as their rounding, not at all.
        let wide = rounding + 1e-6 * self.extent;
        let (u, v) = normal.any_orthonormal_pair();
        let beside = [Vec3::ZERO, u, -u, v, -v].map(|aside| position + wide * (normal + aside));
        let nearest = nearest.or_else(|| beside.into_iter().find_map(|from| meet(from, -normal, 2.0 * wide)));
        match nearest {
            Some(hit) => self.start_on_triangle(hit.triangle, hit.barycentric, normal),
            None => PathStart::free(position, normal),
        }
    }
}

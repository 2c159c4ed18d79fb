//! One source: a glowing rectangle or triangle.

use super::LightSample;
use crate::math::{SphericalRectangle, SphericalTriangle, square_to_triangle};
use crate::trace::surface::TriangleShape;
use glam::{Vec2, Vec3};

/// Where a source is.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) enum EmitterShape {
    /// A corner and the two perpendicular edges from it.
    Rectangle {
        /// The corner [m].
        corner: Vec3,
        /// Edges from it [m].
        edges: [Vec3; 2],
    },
    /// Three vertices.
    Triangle {
        /// The vertices [m].
        vertices: [Vec3; 3],
    },
}

/// A glowing flat shape.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Emitter {
    pub(in crate::trace) shape: EmitterShape,
    /// Unit normal of the side that shines.
    pub(in crate::trace) normal: Vec3,
    /// Radiance [cd/m²].
    pub(in crate::trace) radiance: Vec3,
    /// Whether the other side shines too.
    pub(in crate::trace) double_sided: bool,
    /// Reciprocal of the distance from the centre at which Bevy's range window has taken all light [1/m]; 0 for none.
    pub(in crate::trace) inverse_range: f32,
    /// Bound on the error of each coordinate of a point on it [m].
    pub(in crate::trace) error: Vec3,
}

impl Emitter {
    /// The source that a glowing triangle is.
    pub(in crate::trace) fn triangle(triangle: &TriangleShape, radiance: Vec3, double_sided: bool) -> Self {
        Self {
            shape: EmitterShape::Triangle { vertices: triangle.vertices },
            normal: triangle.normal,
            radiance,
            double_sided,
            inverse_range: 0.0,
            error: triangle.error,
        }
    }

    /// Area of one side [m²].
    pub(in crate::trace) fn area(&self) -> f64 {
        match self.shape {
            EmitterShape::Rectangle { edges: [u, v], .. } => u.as_dvec3().cross(v.as_dvec3()).length(),
            EmitterShape::Triangle { vertices: [a, b, c] } => {
                0.5 * (b - a).as_dvec3().cross((c - a).as_dvec3()).length()
            }
        }
    }

    /// A point on it, uniform over its area.
    pub(in crate::trace) fn point(&self, u: Vec2) -> Vec3 {
        Seen::ByArea.sample_offset(&self.shape, Vec3::ZERO, u)
    }

    pub(super) fn centre(&self) -> Vec3 {
        match self.shape {
            EmitterShape::Rectangle { corner, edges: [u, v] } => corner + 0.5 * (u + v),
            EmitterShape::Triangle { vertices: [a, b, c] } => (a + b + c) / 3.0,
        }
    }

    /// Radiance that leaves for `receiver` against the unit direction `wi` [cd/m²]: black behind a one-sided source,
    /// and under Bevy's window (1 − (d/range)⁴)² where it has one.
    pub(in crate::trace) fn radiance_towards(&self, receiver: Vec3, wi: Vec3) -> Vec3 {
        if !self.double_sided && self.normal.dot(wi) >= 0.0 {
            return Vec3::ZERO;
        }
        if self.inverse_range == 0.0 {
            return self.radiance;
        }
        let relative = (self.centre() - receiver).length_squared() * self.inverse_range * self.inverse_range;
        let window = (1.0 - relative * relative).clamp(0.0, 1.0);
        self.radiance * (window * window)
    }

    /// A point on the source as seen from `receiver`. `None` if no light can come from it there.
    pub(super) fn sample(&self, receiver: Vec3, u: Vec2) -> Option<LightSample> {
        let seen = Seen::new(&self.shape, receiver);
        let offset = seen.sample_offset(&self.shape, receiver, u);
        let distance_squared = offset.length_squared();
        let wi = offset.try_normalize()?;
        let radiance = self.radiance_towards(receiver, wi);
        if radiance == Vec3::ZERO {
            return None;
        }
        let cosine = self.normal.dot(wi).abs();
        let pdf = seen.pdf(distance_squared, cosine, || self.area());
        if !(pdf.is_finite() && pdf > 0.0) {
            return None;
        }
        let towards_receiver = if self.normal.dot(wi) > 0.0 { -self.normal } else { self.normal };
        let target = receiver + offset + towards_receiver * self.error.dot(self.normal.abs());
        Some(LightSample { target, wi, radiance, pdf })
    }

    /// Density with which `sample` finds the unit direction `wi` [1/sr], in which the source is `distance` away.
    pub(super) fn pdf(&self, receiver: Vec3, wi: Vec3, distance: f32) -> f32 {
        let cosine = self.normal.dot(wi).abs();
        Seen::new(&self.shape, receiver).pdf(distance * distance, cosine, || self.area())
    }

    /// Distance at which a ray meets the source, for those that no ray meets otherwise.
    pub(super) fn intersect(&self, origin: Vec3, direction: Vec3) -> Option<f32> {
        let EmitterShape::Rectangle { corner, edges: [u, v] } = self.shape else {
            return None;
        };
        let along = self.normal.dot(direction);
        if along == 0.0 {
            return None;
        }
        let distance = self.normal.dot(corner - origin) / along;
        let local = origin + direction * distance - corner;
        let inside = |edge: Vec3| (0.0..=edge.length_squared()).contains(&local.dot(edge));
        (distance > 0.0 && inside(u) && inside(v)).then_some(distance)
    }
}

/// A source's shape as it is sampled from one receiver.
pub(super) enum Seen {
    Rectangle(SphericalRectangle),
    Triangle(SphericalTriangle),
    ByArea,
}

impl Seen {
    pub(super) fn new(shape: &EmitterShape, receiver: Vec3) -> Self {
        match *shape {
            EmitterShape::Rectangle { corner, edges: [u, v] } => {
                SphericalRectangle::new(corner, u, v, receiver).map_or(Self::ByArea, Self::Rectangle)
            }
            EmitterShape::Triangle { vertices } => {
                SphericalTriangle::new(vertices, receiver).map_or(Self::ByArea, Self::Triangle)
            }
        }
    }

    /// A point on the source relative to the receiver.
    fn sample_offset(&self, shape: &EmitterShape, receiver: Vec3, u: Vec2) -> Vec3 {
        match (self, *shape) {
            (Self::Rectangle(rectangle), _) => rectangle.sample_offset(u),
            (Self::Triangle(triangle), _) => triangle.sample_offset(u),
            (Self::ByArea, EmitterShape::Rectangle { corner, edges }) => {
                (corner - receiver) + edges[0] * u.x + edges[1] * u.y
            }
            (Self::ByArea, EmitterShape::Triangle { vertices: [a, b, c] }) => {
                let weights = square_to_triangle(u);
                (a - receiver) + (b - a) * weights.x + (c - a) * weights.y
            }
        }
    }

    fn pdf(&self, distance_squared: f32, cosine: f32, area: impl Fn() -> f64) -> f32 {
        match self {
            Self::Rectangle(rectangle) => (1.0 / rectangle.solid_angle()) as f32,
            Self::Triangle(triangle) => (1.0 / triangle.solid_angle()) as f32,
            Self::ByArea => (f64::from(distance_squared) / (f64::from(cosine) * area())) as f32,
        }
    }
}

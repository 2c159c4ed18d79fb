//! A flat source as one receiver sees it: by solid angle, or by area where that is too small or too large.

use super::EmitterShape;
use crate::math::{SphericalRectangle, SphericalTriangle, square_to_triangle};
use glam::{Vec2, Vec3};

/// A flat source's shape as it is sampled from one receiver.
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
            EmitterShape::Sphere { .. } | EmitterShape::Point { .. } => Self::ByArea,
        }
    }

    /// A point on the source relative to the receiver.
    pub(super) fn sample_offset(&self, shape: &EmitterShape, receiver: Vec3, u: Vec2) -> Vec3 {
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
            (Self::ByArea, EmitterShape::Sphere { centre, .. } | EmitterShape::Point { centre }) => centre - receiver,
        }
    }

    /// Reciprocal of the density with which a direction is found in which the source is met so far away, at this
    /// cosine [sr].
    pub(super) fn solid_angle(&self, distance: f64, cosine: f64, area: impl Fn() -> f64) -> f64 {
        match self {
            Self::Rectangle(rectangle) => rectangle.solid_angle(),
            Self::Triangle(triangle) => triangle.solid_angle(),
            Self::ByArea => cosine * area() / (distance * distance),
        }
    }
}

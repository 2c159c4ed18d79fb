//! One source that is somewhere: a glowing rectangle, triangle, sphere or point, with its range and its cone.

use super::seen::Seen;
use super::sphere::SeenSphere;
use super::{End, brightness};
use crate::math::{Frame, Portable, square_to_uniform_cone, square_to_uniform_sphere};
use crate::trace::surface::{TriangleShape, position_error};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::PI;

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
    /// A sphere.
    Sphere {
        /// Its centre [m].
        centre: Vec3,
        /// Its radius, above zero [m].
        radius: f32,
    },
    /// A point.
    Point {
        /// Where it is [m].
        centre: Vec3,
    },
}

/// The cone that a spot light shines into, as Bevy's shader has it: saturate(cos θ · scale + offset)².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::trace) struct Cone {
    /// Unit direction in which it shines.
    pub(super) direction: Vec3,
    /// Angle within which it is not dimmed [rad].
    pub(super) inner_angle: f32,
    /// Angle beyond which it is dark [rad].
    pub(super) outer_angle: f32,
}

impl Cone {
    /// What is left of the light, for the cosine between the axis and the way to the receiver.
    fn dimming(&self, cosine: f32) -> f32 {
        let outer = Portable::cos(self.outer_angle);
        // Bevy's own least width (bevy_pbr, render/light.rs).
        let scale = 1.0 / (Portable::cos(self.inner_angle) - outer).max(1e-4);
        let share = ((cosine - outer) * scale).clamp(0.0, 1.0);
        share * share
    }
}

/// A source that is somewhere.
#[derive(Clone, Copy, Debug)]
pub(in crate::trace) struct Emitter {
    pub(in crate::trace) shape: EmitterShape,
    /// Unit normal of the side that shines; means nothing for spheres and points.
    pub(in crate::trace) normal: Vec3,
    /// Radiance of a flat source, what multiplies its emission texture if it has one [cd/m²]; intensity of a sphere or
    /// a point [cd].
    pub(in crate::trace) strength: Vec3,
    /// The mean of that over its area, for its share in the choice: differs where there is a texture.
    pub(in crate::trace) mean_strength: Vec3,
    /// Whether the other side shines too.
    pub(in crate::trace) double_sided: bool,
    /// Reciprocal of the distance from the centre at which Bevy's range window has taken all light [1/m]; 0 for none.
    pub(in crate::trace) inverse_range: f32,
    /// The cone that it shines into, if it does not shine all around.
    pub(in crate::trace) cone: Option<Cone>,
    /// Bound on the error of each coordinate of a point on it [m].
    pub(in crate::trace) error: Vec3,
}

/// A direction to a source, before it is known with what chance the source was chosen.
pub(super) struct EmitterSample {
    pub(super) wi: Vec3,
    pub(super) end: End,
    pub(super) distance: f64,
    /// Radiance over density, or the irradiance on a surface that faces a delta source [lx].
    pub(super) value: DVec3,
    /// Reciprocal of the density [sr]; `None` for a delta source.
    pub(super) solid_angle: Option<f64>,
}

impl Emitter {
    /// The source that a glowing triangle is.
    pub(in crate::trace) fn triangle(triangle: &TriangleShape, radiance: Vec3, double_sided: bool) -> Self {
        Self {
            shape: EmitterShape::Triangle { vertices: triangle.vertices },
            normal: triangle.normal,
            strength: radiance,
            mean_strength: radiance,
            double_sided,
            inverse_range: 0.0,
            cone: None,
            error: triangle.error,
        }
    }

    /// Area of one side, or of the whole sphere [m²].
    pub(in crate::trace) fn area(&self) -> f64 {
        match self.shape {
            EmitterShape::Rectangle { edges: [u, v], .. } => u.as_dvec3().cross(v.as_dvec3()).length(),
            EmitterShape::Triangle { vertices: [a, b, c] } => {
                0.5 * (b - a).as_dvec3().cross((c - a).as_dvec3()).length()
            }
            EmitterShape::Sphere { radius, .. } => 4.0 * PI * f64::from(radius).powi(2),
            EmitterShape::Point { .. } => 0.0,
        }
    }

    /// The weights of the second and the third vertex at a point near a triangle; shares of the two edges at one near
    /// a rectangle.
    pub(in crate::trace) fn weights_of(&self, point: Vec3) -> Option<[f32; 2]> {
        let (corner, [u, v]) = match self.shape {
            EmitterShape::Rectangle { corner, edges } => (corner, edges),
            EmitterShape::Triangle { vertices: [a, b, c] } => (a, [b - a, c - a]),
            EmitterShape::Sphere { .. } | EmitterShape::Point { .. } => return None,
        };
        let (u, v, offset) = (u.as_dvec3(), v.as_dvec3(), point.as_dvec3() - corner.as_dvec3());
        let normal = u.cross(v);
        let scale = normal.length_squared().recip();
        let weights = [normal.dot(offset.cross(v)) * scale, normal.dot(u.cross(offset)) * scale];
        Some(weights.map(|weight| weight.clamp(0.0, 1.0) as f32))
    }

    /// Flux per channel [lm]. `None` for a lamp with a range, whose flux is
    /// lost on the way, and for a spot light with a size, whose dimming is no radiance that is conserved.
    pub(in crate::trace) fn flux(&self) -> Option<DVec3> {
        let solid_angle = match (self.shape, self.cone) {
            (EmitterShape::Rectangle { .. } | EmitterShape::Triangle { .. }, _) => {
                (if self.double_sided { 2.0 } else { 1.0 }) * PI * self.area()
            }
            (EmitterShape::Sphere { .. } | EmitterShape::Point { .. }, None) => 4.0 * PI,
            (EmitterShape::Point { .. }, Some(cone)) => {
                // ∫ of the dimming, a parabola in the cosine between the two angles.
                let [inner, outer] = [cone.inner_angle, cone.outer_angle].map(|angle| Portable::cos(f64::from(angle)));
                2.0 * PI * (1.0 - inner + (inner - outer) / 3.0)
            }
            (EmitterShape::Sphere { .. }, Some(_)) => return None,
        };
        (self.inverse_range == 0.0).then(|| self.mean_strength.as_dvec3() * solid_angle)
    }

    /// Brightness of the greatest intensity that it has in any direction [cd].
    pub(super) fn peak_intensity(&self) -> f64 {
        let area = match self.shape {
            EmitterShape::Rectangle { .. } | EmitterShape::Triangle { .. } => self.area(),
            EmitterShape::Sphere { .. } | EmitterShape::Point { .. } => 1.0,
        };
        brightness(self.mean_strength) * area
    }

    pub(super) fn centre(&self) -> Vec3 {
        match self.shape {
            EmitterShape::Rectangle { corner, edges: [u, v] } => corner + 0.5 * (u + v),
            EmitterShape::Triangle { vertices: [a, b, c] } => (a + b + c) / 3.0,
            EmitterShape::Sphere { centre, .. } | EmitterShape::Point { centre } => centre,
        }
    }

    /// The corners of the box around it [m].
    pub(super) fn extent(&self) -> [Vec3; 2] {
        let around = |points: &[Vec3]| {
            let low = points.iter().fold(Vec3::INFINITY, |low, &point| low.min(point));
            [low, points.iter().fold(Vec3::NEG_INFINITY, |high, &point| high.max(point))]
        };
        match self.shape {
            EmitterShape::Rectangle { corner, edges: [u, v] } => {
                around(&[corner, corner + u, corner + v, corner + u + v])
            }
            EmitterShape::Triangle { vertices } => around(&vertices),
            EmitterShape::Sphere { centre, radius } => [centre - Vec3::splat(radius), centre + Vec3::splat(radius)],
            EmitterShape::Point { centre } => [centre; 2],
        }
    }

    /// What is left of its light at a receiver: Bevy's range window (1 − (d/range)⁴)², and the cone.
    pub(super) fn dimming(&self, receiver: Vec3) -> f32 {
        if self.inverse_range == 0.0 && self.cone.is_none() {
            return 1.0;
        }
        let offset = receiver - self.centre();
        let relative = (offset * self.inverse_range).length_squared();
        let window = (1.0 - relative * relative).clamp(0.0, 1.0);
        let cone = self.cone.map_or(1.0, |cone| cone.dimming(cone.direction.dot(offset.normalize_or_zero())));
        window * window * cone
    }

    /// Radiance that arrives at `receiver` against the unit direction `wi`, in which it meets the source [cd/m²]:
    /// black behind a one-sided source and from a point, which no direction meets.
    pub(in crate::trace) fn radiance_towards(&self, receiver: Vec3, wi: Vec3) -> Vec3 {
        match self.shape {
            EmitterShape::Rectangle { .. } | EmitterShape::Triangle { .. } => {
                if self.double_sided || self.normal.dot(wi) < 0.0 {
                    self.strength * self.dimming(receiver)
                } else {
                    Vec3::ZERO
                }
            }
            EmitterShape::Sphere { centre, radius } => {
                SeenSphere::new(centre, radius, receiver).map_or(Vec3::ZERO, |seen| {
                    let scale = f64::from(self.dimming(receiver)) * seen.radiance_per_intensity();
                    (self.strength.as_dvec3() * scale).min(DVec3::splat(f64::from(f32::MAX))).as_vec3()
                })
            }
            EmitterShape::Point { .. } => Vec3::ZERO,
        }
    }

    /// A direction to the source from `receiver`. `None` if no light can come from it there.
    pub(super) fn sample(&self, receiver: Vec3, u: Vec2) -> Option<EmitterSample> {
        let sample = match self.shape {
            EmitterShape::Rectangle { .. } | EmitterShape::Triangle { .. } => self.sample_flat(receiver, u),
            EmitterShape::Sphere { centre, radius } => self.sample_sphere(centre, radius, receiver, u),
            EmitterShape::Point { centre } => self.sample_point(centre, receiver),
        }?;
        let is_usable = sample.value != DVec3::ZERO
            && sample.value.is_finite()
            && sample.solid_angle.is_none_or(|solid_angle| solid_angle.is_finite() && solid_angle > 0.0);
        is_usable.then_some(sample)
    }

    fn sample_flat(&self, receiver: Vec3, u: Vec2) -> Option<EmitterSample> {
        let seen = Seen::new(&self.shape, receiver);
        let offset = seen.sample_offset(&self.shape, receiver, u);
        let wi = offset.try_normalize()?;
        let radiance = self.radiance_towards(receiver, wi);
        let distance = f64::from(offset.length());
        let cosine = f64::from(self.normal.dot(wi).abs());
        let solid_angle = seen.solid_angle(distance, cosine, || self.area());
        let towards_receiver = if self.normal.dot(wi) > 0.0 { -self.normal } else { self.normal };
        let target = self.end_before(receiver, offset, towards_receiver);
        let value = radiance.as_dvec3() * solid_angle;
        Some(EmitterSample { wi, end: End::At(target), distance, value, solid_angle: Some(solid_angle) })
    }

    /// Where a shadow ray from `receiver` along `offset` to a flat source ends: off it, on the side of the unit normal
    /// `towards_receiver`. The offset's own rounding grows with its length and may be far more than the source's
    /// error: from 100 m it put the ends of a fifth of all rays behind a panel, which then blocked its own light. So
    /// the end is brought back to the source's plane, in f64, before it is moved off.
    fn end_before(&self, receiver: Vec3, offset: Vec3, towards_receiver: Vec3) -> Vec3 {
        let point = receiver.as_dvec3() + offset.as_dvec3();
        let corner = match self.shape {
            EmitterShape::Rectangle { corner, .. } | EmitterShape::Triangle { vertices: [corner, ..] } => corner,
            EmitterShape::Sphere { centre, .. } | EmitterShape::Point { centre } => centre,
        };
        let normal = towards_receiver.as_dvec3();
        let height = f64::from(self.error.dot(self.normal.abs())) - normal.dot(point - corner.as_dvec3());
        (point + normal * height).as_vec3()
    }

    fn sample_sphere(&self, centre: Vec3, radius: f32, receiver: Vec3, u: Vec2) -> Option<EmitterSample> {
        let seen = SeenSphere::new(centre, radius, receiver)?;
        let sample = seen.sample(u);
        // Off the sphere, so that a bulb of the same size around it stays behind; nothing to trace where less is left
        // than a point on a surface may be off.
        let distance = sample.distance - f64::from(self.error.max_element());
        let end = if distance > f64::from(2.0 * position_error([receiver]).max_element()) {
            End::At(receiver + sample.wi * distance as f32)
        } else {
            End::Here
        };
        Some(EmitterSample {
            wi: sample.wi,
            end,
            distance: sample.distance,
            value: self.strength.as_dvec3() * (f64::from(self.dimming(receiver)) * seen.flux_per_intensity()),
            solid_angle: Some(seen.solid_angle()),
        })
    }

    fn sample_point(&self, centre: Vec3, receiver: Vec3) -> Option<EmitterSample> {
        let offset = centre.as_dvec3() - receiver.as_dvec3();
        let wi = offset.try_normalize()?.as_vec3();
        let value = self.strength.as_dvec3() * (f64::from(self.dimming(receiver)) / offset.length_squared());
        Some(EmitterSample { wi, end: End::At(centre), distance: offset.length(), value, solid_angle: None })
    }

    /// Reciprocal of the density with which `sample` finds the unit direction `wi`, in which the source is `distance`
    /// away [sr]; `None` for a delta source.
    pub(super) fn solid_angle(&self, receiver: Vec3, wi: Vec3, distance: f32) -> Option<f64> {
        match self.shape {
            EmitterShape::Rectangle { .. } | EmitterShape::Triangle { .. } => {
                let cosine = f64::from(self.normal.dot(wi).abs());
                Some(Seen::new(&self.shape, receiver).solid_angle(f64::from(distance), cosine, || self.area()))
            }
            EmitterShape::Sphere { centre, radius } => Some(SeenSphere::new(centre, radius, receiver)?.solid_angle()),
            EmitterShape::Point { .. } => None,
        }
    }

    /// Distance at which a ray in the unit `direction` meets the source, for those that no ray meets otherwise.
    pub(super) fn intersect(&self, origin: Vec3, direction: Vec3) -> Option<f32> {
        match self.shape {
            EmitterShape::Rectangle { corner, edges: [u, v] } => {
                let along = self.normal.dot(direction);
                if along == 0.0 {
                    return None;
                }
                let distance = self.normal.dot(corner - origin) / along;
                let local = origin + direction * distance - corner;
                let inside = |edge: Vec3| (0.0..=edge.length_squared()).contains(&local.dot(edge));
                (distance > 0.0 && inside(u) && inside(v)).then_some(distance)
            }
            EmitterShape::Sphere { centre, radius } => {
                SeenSphere::new(centre, radius, origin)?.intersect(direction).map(|distance| distance as f32)
            }
            EmitterShape::Triangle { .. } | EmitterShape::Point { .. } => None,
        }
    }

    /// Where and in which direction some of its light sets out, in proportion to flux.
    pub(super) fn depart(&self, [u, v, w, u_side]: [f32; 4]) -> (Vec3, Vec3) {
        let cosine_around =
            |normal: Vec3, u: Vec2| Frame::new(normal).world_from_local(crate::math::square_to_cosine_hemisphere(u));
        match (self.shape, self.cone) {
            (EmitterShape::Rectangle { .. } | EmitterShape::Triangle { .. }, _) => {
                // The last variate serves twice: for the side, and with what is left of it for the direction.
                let (side, rest) = match (self.double_sided, u_side < 0.5) {
                    (false, _) => (1.0, u_side),
                    (true, true) => (-1.0, 2.0 * u_side),
                    (true, false) => (1.0, 2.0 * u_side - 1.0),
                };
                let normal = side * self.normal;
                let point = Seen::ByArea.sample_offset(&self.shape, Vec3::ZERO, Vec2::new(u, v));
                (point + normal * self.error.dot(normal.abs()), cosine_around(normal, Vec2::new(w, rest)))
            }
            (EmitterShape::Sphere { centre, radius }, None) => {
                let normal = square_to_uniform_sphere(Vec2::new(u, v));
                (centre + normal * (radius + self.error.max_element()), cosine_around(normal, Vec2::new(w, u_side)))
            }
            (EmitterShape::Point { centre }, None) => (centre, square_to_uniform_sphere(Vec2::new(u, v))),
            (EmitterShape::Sphere { centre, .. } | EmitterShape::Point { centre }, Some(cone)) => {
                let half = Portable::sin(0.5 * cone.outer_angle);
                let local = square_to_uniform_cone(Vec2::new(u, v), 2.0 * half * half);
                (centre, Frame::new(cone.direction).world_from_local(local))
            }
        }
    }
}

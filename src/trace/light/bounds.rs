//! What a group of sources can give to a receiver at most, nearly: a box, a cone of normals and a sum of intensities,
//! as Conty Estevez and Kulla 2018 ("Importance Sampling of Many Lights with Adaptive Tree Splitting") bound them. The
//! angle functions are those of Pharr, Jakob and Humphreys 2023, section 12.6.3.
//!
//! Only ratios matter, so that a wrong estimate costs noise; but an estimate of 0 would cost light. So every bound here
//! is a true one: the sphere around the box stands for it, and angles have a slack above rounding.

use super::LightContext;
use super::emitter::{Emitter, EmitterShape};
use crate::math::Portable;
use glam::{DVec3, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// How much a cosine may be off before light is said to be impossible; also the least that a cosine counts for.
const SLACK: f32 = 1e-4;

/// Directions within an angle from an axis, which may be all.
#[derive(Clone, Copy, Debug)]
struct Directions {
    /// Unit length.
    axis: DVec3,
    /// [rad]
    angle: f64,
}

impl Directions {
    const ALL: Self = Self { axis: DVec3::Y, angle: PI };

    /// The narrowest cone around both, or near it.
    fn union(self, other: Self) -> Self {
        let (wide, narrow) = if self.angle >= other.angle { (self, other) } else { (other, self) };
        let between = Portable::atan2(wide.axis.cross(narrow.axis).length(), wide.axis.dot(narrow.axis));
        if between + narrow.angle <= wide.angle {
            return wide;
        }
        let angle = 0.5 * (wide.angle + between + narrow.angle);
        let turn = angle - wide.angle;
        // Towards the other axis; opposite ones have none, and then every direction counts.
        let aside = (narrow.axis - wide.axis * wide.axis.dot(narrow.axis)).try_normalize();
        match aside {
            Some(aside) if angle < PI => {
                let (sine, cosine) = Portable::sin_cos(turn);
                Self { axis: wide.axis * cosine + aside * sine, angle }
            }
            _ => Self::ALL,
        }
    }
}

/// What is known of a group of sources while the tree is built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    normals: Directions,
    /// Angle from a normal within which light leaves [rad].
    spread: f64,
    double_sided: bool,
    /// Sum of the greatest intensities [cd, as brightness].
    pub(super) intensity: f64,
    /// Distance beyond which it gives no light [m]; infinite without one.
    reach: f64,
    /// Distance² below which nearness no longer counts [m²].
    softness: f64,
}

impl Group {
    /// A source alone.
    pub(super) fn of(emitter: &Emitter) -> Self {
        let [low, high] = emitter.extent().map(Vec3::as_dvec3);
        let is_flat = matches!(emitter.shape, EmitterShape::Rectangle { .. } | EmitterShape::Triangle { .. });
        let (normals, spread) = match emitter.cone {
            _ if is_flat => (Directions { axis: emitter.normal.as_dvec3(), angle: 0.0 }, FRAC_PI_2),
            None => (Directions::ALL, FRAC_PI_2),
            Some(cone) => {
                let [inner, outer] = [cone.inner_angle, cone.outer_angle].map(f64::from);
                (Directions { axis: cone.direction.as_dvec3(), angle: inner }, (outer - inner).min(FRAC_PI_2))
            }
        };
        Self {
            low,
            high,
            normals,
            spread,
            double_sided: emitter.double_sided,
            intensity: emitter.peak_intensity(),
            reach: f64::from(emitter.inverse_range).recip(),
            // Where a disc of this area, or a sphere, fills the view, it gives no more.
            softness: if is_flat { emitter.area() / PI } else { 0.0 },
        }
    }

    /// Both together.
    pub(super) fn union(&self, other: &Self) -> Self {
        let (low, high) = (self.low.min(other.low), self.high.max(other.high));
        let mut normals = other.normals;
        // A double-sided source may as well be said to face the other way.
        if other.double_sided && normals.axis.dot(self.normals.axis) < 0.0 {
            normals.axis = -normals.axis;
        }
        Self {
            low,
            high,
            normals: self.normals.union(normals),
            spread: self.spread.max(other.spread),
            double_sided: self.double_sided || other.double_sided,
            intensity: self.intensity + other.intensity,
            reach: self.reach.max(other.reach),
            softness: CLUSTER_SOFTNESS * 0.25 * (high - low).length_squared(),
        }
    }

    /// The middle of its box [m].
    pub(super) fn centre(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// What it costs to have these together: intensity × solid angle of the directions × size² of the box. The size
    /// is that of the diagonal, not of the surface, which would call a row of points as good as one point.
    pub(super) fn cost(&self) -> f64 {
        let theta = self.normals.angle;
        let (sine, cosine) = Portable::sin_cos(theta);
        let wide = (theta + self.spread).min(PI);
        let fringe = 2.0 * wide * sine - Portable::cos(theta - 2.0 * wide) - 2.0 * theta * sine + cosine;
        let directions = 2.0 * PI * (1.0 - cosine) + FRAC_PI_2 * fringe;
        self.intensity * directions * (self.high - self.low).length_squared()
    }
}

/// Share of a cluster's half diagonal², below which nearness to its middle no longer counts.
const CLUSTER_SOFTNESS: f64 = 0.5;

/// A group as it is asked for its importance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    centre: Vec3,
    /// Half the box [m].
    half: Vec3,
    /// Of the sphere around the box [m²].
    radius_squared: f32,
    axis: Vec3,
    /// Of the cone of normals.
    sin_normals: f32,
    cos_normals: f32,
    cos_spread: f32,
    double_sided: bool,
    /// 1/reach² [1/m²].
    inverse_reach_squared: f32,
    softness: f64,
    intensity: f64,
}

impl From<&Group> for Bounds {
    fn from(group: &Group) -> Self {
        let half = 0.5 * (group.high - group.low);
        Self {
            centre: group.centre().as_vec3(),
            // Rounding the centre must not let the box lose a corner.
            half: (half + group.centre().abs() * f64::from(f32::EPSILON)).as_vec3(),
            radius_squared: (half.length() + group.centre().length() * f64::from(f32::EPSILON)).powi(2) as f32,
            axis: group.normals.axis.as_vec3(),
            sin_normals: Portable::sin(group.normals.angle) as f32,
            cos_normals: Portable::cos(group.normals.angle) as f32,
            cos_spread: Portable::cos(group.spread) as f32,
            double_sided: group.double_sided,
            inverse_reach_squared: group.reach.powi(2).recip() as f32,
            softness: group.softness.max(f64::from(f32::MIN_POSITIVE)),
            intensity: group.intensity,
        }
    }
}

/// An angle in [0, π] by its sine and cosine.
#[derive(Clone, Copy)]
struct Angle {
    sin: f32,
    cos: f32,
}

impl Angle {
    fn of_cosine(cos: f32) -> Self {
        let cos = cos.clamp(-1.0, 1.0);
        Self { sin: (1.0 - cos * cos).sqrt(), cos }
    }

    /// max(0, self − other)
    fn less(self, other: Self) -> Self {
        if self.cos > other.cos {
            return Self { sin: 0.0, cos: 1.0 };
        }
        Self { sin: self.sin * other.cos - self.cos * other.sin, cos: self.cos * other.cos + self.sin * other.sin }
    }
}

impl Bounds {
    /// The irradiance that the group gives to a receiver [lx, as brightness]: an estimate, and 0 only if it gives none.
    pub(super) fn importance(&self, ctx: &LightContext) -> f64 {
        let offset = self.centre - ctx.position;
        let distance_squared = offset.length_squared();
        let mut importance = self.intensity / f64::from(distance_squared).max(self.softness);
        if self.inverse_reach_squared > 0.0 {
            let nearest = (offset.abs() - self.half).max(Vec3::ZERO).length_squared();
            let relative = nearest * self.inverse_reach_squared * (1.0 - 1e-5);
            let window = (1.0 - relative * relative).max(0.0);
            importance *= f64::from(window * window);
        }
        if distance_squared <= self.radius_squared {
            return importance;
        }
        let towards = offset / distance_squared.sqrt();
        let sine_squared = self.radius_squared / distance_squared;
        let seen = Angle { sin: sine_squared.sqrt(), cos: (1.0 - sine_squared).sqrt() };
        let along = -self.axis.dot(towards);
        let leaving = Angle::of_cosine(if self.double_sided { along.abs() } else { along })
            .less(Angle { sin: self.sin_normals, cos: self.cos_normals })
            .less(seen);
        if leaving.cos < self.cos_spread - SLACK {
            return 0.0;
        }
        importance *= f64::from(leaving.cos.max(SLACK));
        if let Some(normal) = ctx.normal {
            let arriving = Angle::of_cosine(normal.dot(towards)).less(seen);
            if arriving.cos < -SLACK {
                return 0.0;
            }
            importance *= f64::from(arriving.cos.max(SLACK));
        }
        importance
    }
}

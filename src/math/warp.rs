//! Maps from the unit square to a disk, to hemispheres and cones around +Z, to the sphere and to a triangle, each with
//! its density and its inverse. All keep neighbours together, so that a stratified or low-discrepancy set stays one.
//! Does not turn the result into world space: [`Frame`](super::Frame) does.
//!
//! Disk and hemispheres: Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square". Triangle: Heitz
//! 2019, "A Low-Distortion Map Between Triangle and Square".

use super::{Portable, unit_at};
use glam::{Vec2, Vec3, Vec3Swizzles};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4};

/// How near to the rim the hemispheres' points may come: 1 − r there, half of what the smallest 32-bit variate
/// gives. It keeps a direction off the horizon when the variate is exactly 0.
const RIM: f32 = 1.0 / 4_294_967_296.0;

/// A point of the disk by its signed radius and angle, with 1 − |radius| known better than radius tells it.
struct Polar {
    radius: f32,
    angle: f32,
    /// 1 − |radius|.
    rim: f32,
}

#[inline]
fn polar(u: Vec2) -> Polar {
    let o = 2.0 * u - Vec2::ONE;
    // 2 min(u, 1 − u) is 1 − |2u − 1| without its rounding near 0.
    if o.x.abs() > o.y.abs() {
        Polar { radius: o.x, angle: FRAC_PI_4 * (o.y / o.x), rim: 2.0 * u.x.min(1.0 - u.x) }
    } else if o.y != 0.0 {
        Polar { radius: o.y, angle: FRAC_PI_2 - FRAC_PI_4 * (o.x / o.y), rim: 2.0 * u.y.min(1.0 - u.y) }
    } else {
        Polar { radius: 0.0, angle: 0.0, rim: 1.0 }
    }
}

/// Unit square → unit disk, uniform.
#[inline]
pub fn square_to_disk(u: Vec2) -> Vec2 {
    let p = polar(u);
    p.radius * unit_at(p.angle)
}

/// The density of [`square_to_disk`] at `p`, per area: 1/π in the disk, 0 outside.
#[inline]
pub fn disk_pdf(p: Vec2) -> f32 {
    if p.length_squared() <= 1.0 { FRAC_1_PI } else { 0.0 }
}

/// Unit disk → unit square: the inverse of [`square_to_disk`].
#[inline]
pub fn disk_to_square(p: Vec2) -> Vec2 {
    let r = p.length();
    // In the first and third wedge |x| is the radius, in the others |y|.
    let o = if p.x.abs() > p.y.abs() {
        let r = r.copysign(p.x);
        Vec2::new(r, r * Portable::atan(p.y / p.x) / FRAC_PI_4)
    } else if p.y != 0.0 {
        let r = r.copysign(p.y);
        Vec2::new(r * Portable::atan(p.x / p.y) / FRAC_PI_4, r)
    } else {
        Vec2::ZERO
    };
    (0.5 * (o + Vec2::ONE)).clamp(Vec2::ZERO, Vec2::ONE)
}

/// Unit square → unit hemisphere around +Z, uniform in solid angle. z ≥ 4·10⁻¹⁰, also where `u` lies on the rim.
#[inline]
pub fn square_to_uniform_hemisphere(u: Vec2) -> Vec3 {
    let p = polar(u);
    let rim = p.rim.max(RIM);
    let z = rim * (2.0 - rim);
    (p.radius * (1.0 + z).sqrt() * unit_at(p.angle)).extend(z)
}

/// The density of [`square_to_uniform_hemisphere`] in direction `w`: 1/(2π) above the horizon, 0 below.
#[inline]
pub fn uniform_hemisphere_pdf(w: Vec3) -> f32 {
    if w.z > 0.0 { 0.5 * FRAC_1_PI } else { 0.0 }
}

/// Unit hemisphere → unit square: the inverse of [`square_to_uniform_hemisphere`].
#[inline]
pub fn uniform_hemisphere_to_square(w: Vec3) -> Vec2 {
    disk_to_square(w.xy() / (1.0 + w.z).sqrt())
}

/// Unit square → unit hemisphere around +Z, its density proportional to the cosine. z ≥ 2·10⁻⁵, also where `u`
/// lies on the rim.
#[inline]
pub fn square_to_cosine_hemisphere(u: Vec2) -> Vec3 {
    let p = polar(u);
    let rim = p.rim.max(RIM);
    (p.radius * unit_at(p.angle)).extend((rim * (2.0 - rim)).sqrt())
}

/// The density of [`square_to_cosine_hemisphere`] in direction `w`: cos θ/π above the horizon, 0 below.
#[inline]
pub fn cosine_hemisphere_pdf(w: Vec3) -> f32 {
    w.z.max(0.0) * FRAC_1_PI
}

/// Unit hemisphere → unit square: the inverse of [`square_to_cosine_hemisphere`].
#[inline]
pub fn cosine_hemisphere_to_square(w: Vec3) -> Vec2 {
    disk_to_square(w.xy())
}

/// Unit square → directions within a cone around +Z, uniform in solid angle. `height` is 1 − cos of the cone's half
/// angle, in [0, 2]: its digits are what the map's digits rest on, however narrow the cone.
#[inline]
pub fn square_to_uniform_cone(u: Vec2, height: f32) -> Vec3 {
    let p = polar(u);
    // 1 − cos θ grows with the area on the disk, as the solid angle does.
    let drop = height * p.radius * p.radius;
    let sine_over_radius = (height * (2.0 - drop)).max(0.0).sqrt();
    (p.radius * sine_over_radius * unit_at(p.angle)).extend(1.0 - drop)
}

/// The density of [`square_to_uniform_cone`] within the cone: 1/(2π `height`) [1/sr].
#[inline]
pub fn uniform_cone_pdf(height: f32) -> f32 {
    0.5 * FRAC_1_PI / height
}

/// Directions within a cone → unit square: the inverse of [`square_to_uniform_cone`]. −Z, where a whole circle of the
/// square's rim ends, has no inverse.
#[inline]
pub fn uniform_cone_to_square(w: Vec3, height: f32) -> Vec2 {
    disk_to_square(w.xy() / ((1.0 + w.z) * height).sqrt())
}

/// Unit square → unit sphere, uniform.
#[inline]
pub fn square_to_uniform_sphere(u: Vec2) -> Vec3 {
    square_to_uniform_cone(u, 2.0)
}

/// The density of [`square_to_uniform_sphere`]: 1/(4π) [1/sr].
#[inline]
pub fn uniform_sphere_pdf() -> f32 {
    0.25 * FRAC_1_PI
}

/// Unit sphere → unit square: the inverse of [`square_to_uniform_sphere`], but at −Z.
#[inline]
pub fn uniform_sphere_to_square(w: Vec3) -> Vec2 {
    uniform_cone_to_square(w, 2.0)
}

/// Unit square → triangle, uniform. The answer holds the weights of the second and the third corner; the first has
/// what is left of 1, which is never negative.
#[inline]
pub fn square_to_triangle(u: Vec2) -> Vec2 {
    if u.y > u.x { Vec2::new(0.5 * u.x, u.y - 0.5 * u.x) } else { Vec2::new(u.x - 0.5 * u.y, 0.5 * u.y) }
}

/// The density of [`square_to_triangle`] over its weights: 2 in the triangle, 0 outside. Per area it is this over
/// twice the area of the triangle.
#[inline]
pub fn triangle_pdf(weights: Vec2) -> f32 {
    if weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0 { 2.0 } else { 0.0 }
}

/// Weights in a triangle → unit square: the inverse of [`square_to_triangle`].
#[inline]
pub fn triangle_to_square(weights: Vec2) -> Vec2 {
    let sum = weights.x + weights.y;
    if weights.y > weights.x { Vec2::new(2.0 * weights.x, sum) } else { Vec2::new(sum, 2.0 * weights.y) }
}

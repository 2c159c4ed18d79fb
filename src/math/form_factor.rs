//! Form factors in closed form: the share of what leaves the first that arrives at the second. From a receiving point
//! the irradiance of radiance L is π F L. Truths for tests; nothing here knows of occlusion.
//!
//! From Howell's catalogue of radiation configuration factors (thermalradiation.net), whose numbers are given; each
//! follows from Lambert's law by integration.

use std::f64::consts::PI;

/// From a point to the parallel rectangle `width` × `height` at `distance`, one of whose corners lies on the point's
/// normal (B-3).
pub fn corner_parallel_rectangle(width: f64, height: f64, distance: f64) -> f64 {
    let (a, b) = (width / distance, height / distance);
    let (ra, rb) = (a.hypot(1.0), b.hypot(1.0));
    (a / ra * (b / ra).atan() + b / rb * (a / rb).atan()) / (2.0 * PI)
}

/// From a point to a rectangle in a plane that contains the direction of the point's normal, at `distance` from it:
/// the rectangle stands on the point's own plane, its near lower corner nearest to the point, `width` along that
/// plane and `height` up (B-5).
pub fn corner_perpendicular_rectangle(width: f64, height: f64, distance: f64) -> f64 {
    let slant = height.hypot(distance);
    ((width / distance).atan() - distance / slant * (width / slant).atan()) / (2.0 * PI)
}

/// From a point to the parallel disk of `radius` at `distance`, whose centre lies on the point's normal (B-13).
pub fn coaxial_disk(radius: f64, distance: f64) -> f64 {
    let r2 = radius * radius;
    r2 / (r2 + distance * distance)
}

/// From a point to a sphere of `radius` at `distance` from its centre, in the direction that makes `cos_theta` with
/// the point's normal; the sphere wholly above the horizon (B-15).
pub fn sphere_above_horizon(radius: f64, distance: f64, cos_theta: f64) -> f64 {
    (radius / distance).powi(2) * cos_theta
}

/// From a disk of radius `from` to the parallel disk of radius `to` at `distance` on the same axis (C-41).
pub fn coaxial_disks(from: f64, to: f64, distance: f64) -> f64 {
    let s = 1.0 + (distance * distance + to * to) / (from * from);
    // ½(s − √(s² − 4q)) without its cancellation.
    let q = (to / from).powi(2);
    2.0 * q / (s + (s * s - 4.0 * q).sqrt())
}

/// Between two equal parallel rectangles `width` × `height`, one straight over the other at `distance` (C-11).
pub fn parallel_rectangles(width: f64, height: f64, distance: f64) -> f64 {
    let (x, y) = (width / distance, height / distance);
    let (x1, y1) = (x.hypot(1.0), y.hypot(1.0));
    let log = (x1 * y1 / (x * x + y1 * y1).sqrt()).ln();
    let angles = x * y1 * (x / y1).atan() + y * x1 * (y / x1).atan() - x * x.atan() - y * y.atan();
    2.0 * (log + angles) / (PI * x * y)
}

/// From a rectangle `from_depth` × `length` to the one at right angles, `to_depth` × `length`, that shares its edge
/// of `length` (C-14).
pub fn perpendicular_rectangles(from_depth: f64, to_depth: f64, length: f64) -> f64 {
    let (w, h) = (from_depth / length, to_depth / length);
    let (w2, h2) = (w * w, h * h);
    let (diagonal, all) = ((w2 + h2).sqrt(), 1.0 + w2 + h2);
    let angles = w * (1.0 / w).atan() + h * (1.0 / h).atan() - diagonal * (1.0 / diagonal).atan();
    let log = ((1.0 + w2) * (1.0 + h2) / all).ln()
        + w2 * (w2 * all / ((1.0 + w2) * (w2 + h2))).ln()
        + h2 * (h2 * all / ((1.0 + h2) * (w2 + h2))).ln();
    (angles + 0.25 * log) / (PI * w)
}

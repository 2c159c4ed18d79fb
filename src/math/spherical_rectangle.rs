//! Points on a rectangle, uniform in the solid angle under which a receiver sees it. Does not weigh them by the
//! cosine at the receiver, and does not know what light the rectangle gives.
//!
//! The map is that of Ureña, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles":
//! first the strip x, then y in it. Here it is written without differences of nearly equal numbers: the angles at
//! the corners enter as products of complex numbers, one inverse tangent gives the solid angle (Van Oosterom and
//! Strackee 1983), and cos(φ) is followed by its distance from where the strip would reach infinity. So it holds
//! far away and near the plane of the rectangle, and a sample costs one sine and cosine.
//!
//! Measured against 60 digits over 3000 rectangles of aspect 1 to 1000, seen from 10⁻⁴ to 10⁴ lengths and from
//! elevations down to 10⁻⁹: the solid angle is right to 3·10⁻⁷ of itself and the share of it on either side of a
//! sample to 3·10⁻⁷, the worst at 10⁻⁹ from the surface; else to 10⁻⁹.

use super::Portable;
use glam::{DVec2, DVec3, Vec2, Vec3};
use std::f64::consts::TAU;

/// The smallest solid angle [sr] that is sampled. Below it, sample the area: nothing is gained any more.
const SMALLEST_SOLID_ANGLE: f64 = 1e-14;

/// A rectangle as a receiver sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalRectangle {
    from: DVec3,
    axis_u: DVec3,
    axis_v: DVec3,
    /// Foot of the perpendicular from the receiver on the plane, relative to the receiver.
    foot: DVec3,
    extent: Extent,
    solid_angle: f64,
    /// Whether the strips are counted from the `u = 1` end, which is the case where that one is farther.
    mirrored: bool,
    strips: Strips,
}

/// The rectangle in its own axes, seen from the origin: [x0, x1] × [y0, y1] at `distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Extent {
    x0: f64,
    x1: f64,
    y0: f64,
    y1: f64,
    distance: f64,
}

/// What the inversion of the solid angle of a strip needs, relative to its end x0 (named as in [`Strips::new`]).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Strips {
    plus: f64,
    minus: f64,
    kappa: f64,
    x_sigma: f64,
}

impl SphericalRectangle {
    /// The rectangle `corner` + s `edge_u` + t `edge_v`, s and t in [0, 1], as seen from the point `from`; all in
    /// metres and one frame, the edges perpendicular. `None` where its plane holds `from`, where it is degenerate or
    /// not finite, or where it subtends less than 10⁻¹⁴ sr: sample its area instead.
    pub fn new(corner: Vec3, edge_u: Vec3, edge_v: Vec3, from: Vec3) -> Option<Self> {
        let (from, edge_u, edge_v) = (from.as_dvec3(), edge_u.as_dvec3(), edge_v.as_dvec3());
        let offset = corner.as_dvec3() - from;
        let axis_u = edge_u.try_normalize()?;
        let axis_v = (edge_v - edge_v.dot(axis_u) * axis_u).try_normalize()?;
        let normal = axis_u.cross(axis_v);
        let height = offset.dot(normal);
        let (x0, y0) = (offset.dot(axis_u), offset.dot(axis_v));
        let extent =
            Extent { x0, x1: x0 + edge_u.dot(axis_u), y0, y1: y0 + edge_v.dot(axis_v), distance: height.abs() };
        let solid_angle = extent.solid_angle();
        // Written so that a NaN is refused too.
        if !(SMALLEST_SOLID_ANGLE..TAU).contains(&solid_angle) {
            return None;
        }
        let mirrored = extent.x0.abs() < extent.x1.abs();
        let strips = Strips::new(&if mirrored { extent.mirrored() } else { extent });
        Some(Self { from, axis_u, axis_v, foot: height * normal, extent, solid_angle, mirrored, strips })
    }

    /// The solid angle under which the receiver sees it [sr], in (0, 2π). The density of [`Self::sample`] is its
    /// reciprocal.
    #[inline]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// The point of the rectangle that belongs to `u` in [0, 1)², uniform in solid angle [m].
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec3 {
        (self.from + self.offset(self.in_plane(u.as_dvec2()))).as_vec3()
    }

    /// The same point relative to the receiver [m]: more exact than a difference of positions where it is near.
    #[inline]
    pub fn sample_offset(&self, u: Vec2) -> Vec3 {
        self.offset(self.in_plane(u.as_dvec2())).as_vec3()
    }

    /// The same point as its shares (s, t) of the two edges, in [0, 1]².
    #[inline]
    pub fn sample_shares(&self, u: Vec2) -> Vec2 {
        self.extent.shares(self.in_plane(u.as_dvec2())).as_vec2()
    }

    /// The point of the unit square that belongs to the shares (s, t) of the edges: the inverse of
    /// [`Self::sample_shares`].
    pub fn square_from_shares(&self, shares: Vec2) -> Vec2 {
        let e = &self.extent;
        let x = e.x0 + f64::from(shares.x) * (e.x1 - e.x0);
        let y = e.y0 + f64::from(shares.y) * (e.y1 - e.y0);
        let u = Extent { x1: x, ..*e }.solid_angle() / self.solid_angle;
        let d2 = x * x + e.distance * e.distance;
        let v = sine_step(e.y0, y, d2) / sine_step(e.y0, e.y1, d2);
        DVec2::new(u, v).clamp(DVec2::ZERO, DVec2::ONE).as_vec2()
    }

    /// The point of the unit square whose sample lies in `direction` from the receiver (of any length): `None` where
    /// that misses the rectangle. Rounding may turn a sample on the rim into a miss.
    pub fn square_from_direction(&self, direction: Vec3) -> Option<Vec2> {
        let d = direction.as_dvec3();
        let along = d.dot(self.foot);
        let scale = (along > 0.0).then(|| self.foot.length_squared() / along)?;
        let shares = self.extent.shares(scale * DVec2::new(d.dot(self.axis_u), d.dot(self.axis_v)));
        let inside = shares.cmpge(DVec2::ZERO).all() && shares.cmple(DVec2::ONE).all();
        inside.then(|| self.square_from_shares(shares.as_vec2()))
    }

    #[inline]
    fn offset(&self, p: DVec2) -> DVec3 {
        p.x * self.axis_u + p.y * self.axis_v + self.foot
    }

    #[inline]
    fn in_plane(&self, u: DVec2) -> DVec2 {
        let e = &self.extent;
        let share = if self.mirrored { 1.0 - u.x } else { u.x };
        let x = self.strips.x(0.5 * share * self.solid_angle, e.distance);
        let x = (if self.mirrored { -x } else { x }).clamp(e.x0, e.x1);
        DVec2::new(x, e.y(u.y, x * x + e.distance * e.distance))
    }
}

impl Extent {
    /// Solid angle of the rectangle as two triangles: 2 arg((D₁ + iN)(D₂ + iN)), with Van Oosterom's N and D. N is
    /// the volume of the box over the rectangle, so that nothing cancels in it.
    fn solid_angle(&self) -> f64 {
        let corner = |x, y| DVec3::new(x, y, self.distance);
        let (a, b) = (corner(self.x0, self.y0), corner(self.x1, self.y0));
        let (c, d) = (corner(self.x1, self.y1), corner(self.x0, self.y1));
        let (ra, rb, rc, rd) = (a.length(), b.length(), c.length(), d.length());
        let n = self.distance * (self.x1 - self.x0) * (self.y1 - self.y0);
        let ac = a.dot(c);
        let d1 = ra * rb * rc + a.dot(b) * rc + ac * rb + b.dot(c) * ra;
        let d2 = ra * rc * rd + ac * rd + a.dot(d) * rc + c.dot(d) * ra;
        2.0 * Portable::atan2(n * (d1 + d2), d1 * d2 - n * n)
    }

    fn mirrored(&self) -> Self {
        Self { x0: -self.x1, x1: -self.x0, ..*self }
    }

    fn shares(&self, p: DVec2) -> DVec2 {
        (p - DVec2::new(self.x0, self.y0)) / DVec2::new(self.x1 - self.x0, self.y1 - self.y0)
    }

    /// y at share `v` of the strip at x, with `d2` = x² + distance²: the sine of the angle from the strip's foot is
    /// uniform. 1 − sine² is taken from the nearer end, where it does not cancel.
    #[inline]
    fn y(&self, v: f64, d2: f64) -> f64 {
        let (r0, r1) = ((d2 + self.y0 * self.y0).sqrt(), (d2 + self.y1 * self.y1).sqrt());
        let step = sine_step_with(self.y0, self.y1, d2, r0, r1);
        let (sine, cosine2) = if v < 0.5 {
            let (h, s) = (self.y0 / r0, v * step);
            (h + s, d2 / (r0 * r0) - s * (2.0 * h + s))
        } else {
            let (h, s) = (self.y1 / r1, (1.0 - v) * step);
            (h - s, d2 / (r1 * r1) + s * (2.0 * h - s))
        };
        let y = sine * (d2 / cosine2).sqrt();
        // `max` and `min` rather than `clamp`: they also turn a NaN of 0/0 into an end.
        y.max(self.y0).min(self.y1)
    }
}

/// y1/r1 − y0/r0 with r² = d2 + y².
fn sine_step(y0: f64, y1: f64, d2: f64) -> f64 {
    sine_step_with(y0, y1, d2, (d2 + y0 * y0).sqrt(), (d2 + y1 * y1).sqrt())
}

#[inline]
fn sine_step_with(y0: f64, y1: f64, d2: f64, r0: f64, r1: f64) -> f64 {
    if y0 * y1 > 0.0 { d2 * (y1 - y0) * (y1 + y0) / (r0 * r1 * (y1 * r0 + y0 * r1)) } else { y1 / r1 - y0 / r0 }
}

impl Strips {
    /// With c the distance, r₀₀ and r₀₁ the distances of the corners at x0, X² = x0² + c² and K = c²/(Y₀Y₁), where
    /// Y² = y² + c²: the angle φ = k + A after solid angle A has
    /// cos k − cos(a₀ + a₁) = −K `plus`, cos k + cos(a₁ − a₀) = −K `minus`, cos k = −K `kappa`,
    /// sin k = −K `x_sigma`/c, where tan a = y/c; and x = −c sin φ / √((cos φ − cos(a₀ + a₁))(cos φ + cos(a₁ − a₀))).
    fn new(e: &Extent) -> Self {
        let c2 = e.distance * e.distance;
        let (x2, product) = (e.x0 * e.x0 + c2, e.y0 * e.y1);
        let (r0, r1) = ((x2 + e.y0 * e.y0).sqrt(), (x2 + e.y1 * e.y1).sqrt());
        let width = e.y1 - e.y0;
        // Each form where its terms have one sign.
        let (plus, sigma) = if product > 0.0 {
            (
                1.0 + (x2 + e.y0 * e.y0 + e.y1 * e.y1) / (r0 * r1 + product),
                width * (e.y1 + e.y0) / (e.y1 * r0 + e.y0 * r1),
            )
        } else {
            ((r0 * r1 + x2 - product) / x2, (e.y1 * r0 - e.y0 * r1) / x2)
        };
        let minus =
            if x2 > -product { width * width / (x2 + product + r0 * r1) } else { (r0 * r1 - x2 - product) / x2 };
        let kappa = (e.x0 * e.x0 * product / c2 + r0 * r1) / x2;
        Self { plus, minus, kappa, x_sigma: e.x0 * sigma }
    }

    /// The x up to which the strips subtend twice `half` of solid angle.
    #[inline]
    fn x(&self, half: f64, distance: f64) -> f64 {
        let (sin, cos) = Portable::sin_cos(half);
        let (sin_2, sin_sin_2) = (2.0 * sin * cos, 2.0 * sin * sin);
        let step = -self.kappa * sin_sin_2 - self.x_sigma / distance * sin_2;
        let x = self.x_sigma * (1.0 - sin_sin_2) + distance * self.kappa * sin_2;
        x / ((self.plus + step) * (self.minus + step)).max(f64::MIN_POSITIVE).sqrt()
    }
}

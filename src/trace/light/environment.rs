//! A picture of the sky as a source: its pixels are chosen in proportion to the light that each sends, and within a
//! pixel a direction uniformly in solid angle.
//!
//! A density p(u, v) over the unit square of the picture is one of p(u, v) / (2π² sin θ) per solid angle, θ = π v
//! (Pharr, Jakob and Humphreys 2023, section 12.5.2); a pixel in a picture of w × h so takes 2π²/(w·h)·sin θ of solid
//! angle. Here the sine is integrated exactly over the pixel, 2π/w · (cos θ₀ − cos θ₁), both in the pixel's weight and
//! in the place within it, which is uniform in the longitude and in cos θ. So the density is constant over a pixel as
//! its radiance is, brightness over the sum of brightness × solid angle, and their quotient is the same everywhere
//! but for colour.
//!
//! Costs half a byte per pixel beside the picture itself, which is shared with the scene.

use super::brightness;
use crate::math::{Discrete2d, Portable};
use crate::scene::EnvironmentMap;
use glam::{DQuat, DVec3, UVec2, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// A picture of the sky that can be aimed at.
#[derive(Clone, Debug)]
pub(super) struct Environment {
    map: EnvironmentMap,
    world_from_map: DQuat,
    table: Discrete2d,
    /// Per row, the solid angle of one of its pixels [sr].
    solid_angles: Vec<f64>,
}

/// A direction to the sky.
pub(super) struct SkySample {
    pub(super) wi: Vec3,
    pub(super) radiance: Vec3,
    /// [1/sr]
    pub(super) pdf: f64,
}

impl Environment {
    /// `None` for a black sky.
    pub(super) fn new(map: &EnvironmentMap) -> Option<Self> {
        let size = UVec2::new(map.width, map.height);
        let solid_angle = |row| {
            let [top, bottom] = heights(row, map.height);
            (top - bottom) * TAU / f64::from(map.width)
        };
        let solid_angles: Vec<f64> = (0..map.height).map(solid_angle).collect();
        let weight = |place: UVec2| brightness(texel(map, place)) * solid_angles[place.y as usize];
        let table = Discrete2d::new(size, weight).ok()?;
        let world_from_map = map.world_from_map.as_dquat().normalize();
        Some(Self { map: map.clone(), world_from_map, table, solid_angles })
    }

    /// The irradiance that it gives to a receiver [lx, as brightness], on average over all that a receiver may face.
    pub(super) fn importance(&self) -> f64 {
        0.25 * self.table.total()
    }

    /// A direction to it.
    pub(super) fn sample(&self, u: Vec2) -> Option<SkySample> {
        let cell = self.table.sample(u, |place| self.weight(place));
        let wi = self.direction(cell.place, cell.remapped);
        // Rounding to f32 can carry a direction over the pixel's rim. What it says there must be what anyone who looks
        // in that direction finds, so nearer to the middle is better, and the neighbour's answer good enough.
        let wi = if self.pixel(wi) == Some(cell.place) {
            wi
        } else {
            self.direction(cell.place, 0.5 + 0.99 * (cell.remapped - 0.5))
        };
        let (radiance, pdf) = self.look(wi);
        (pdf > 0.0).then_some(SkySample { wi, radiance, pdf })
    }

    /// Brightness × solid angle of a pixel [cd/m² sr].
    fn weight(&self, place: UVec2) -> f64 {
        brightness(texel(&self.map, place)) * self.solid_angles[place.y as usize]
    }

    /// Radiance that arrives against the unit direction `wi` [cd/m²], and the density with which `sample` finds it
    /// [1/sr].
    pub(super) fn look(&self, wi: Vec3) -> (Vec3, f64) {
        let Some(place) = self.pixel(wi) else {
            return (Vec3::ZERO, 0.0);
        };
        let radiance = texel(&self.map, place);
        (radiance, self.table.probability(brightness(radiance)))
    }

    /// The pixel in a unit direction: [`EnvironmentMap::place_of`] in f64. `None` for NaN.
    fn pixel(&self, wi: Vec3) -> Option<UVec2> {
        let local = self.world_from_map.inverse() * wi.as_dvec3();
        let u = 0.5 + Portable::atan2(local.z, local.x) / TAU;
        let v = Portable::atan2(Portable::hypot(local.x, local.z), local.y) / PI;
        let index = |share: f64, count: u32| ((share * f64::from(count)) as u32).min(count - 1);
        (u.is_finite() && v.is_finite()).then(|| UVec2::new(index(u, self.map.width), index(v, self.map.height)))
    }

    /// The unit direction of a place within a pixel, by shares of its longitudes and of its heights.
    fn direction(&self, place: UVec2, within: Vec2) -> Vec3 {
        let phi = ((f64::from(place.x) + f64::from(within.x)) / f64::from(self.map.width) - 0.5) * TAU;
        let [top, bottom] = heights(place.y, self.map.height);
        let cos = top + (bottom - top) * f64::from(within.y);
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = Portable::sin_cos(phi);
        (self.world_from_map * DVec3::new(sin * cos_phi, cos, sin * sin_phi)).as_vec3()
    }
}

/// cos θ at the upper and the lower rim of a row.
fn heights(row: u32, rows: u32) -> [f64; 2] {
    [row, row + 1].map(|edge| Portable::cos(PI * f64::from(edge) / f64::from(rows)))
}

fn texel(map: &EnvironmentMap, place: UVec2) -> Vec3 {
    map.radiance.get(place.y as usize * map.width as usize + place.x as usize).copied().unwrap_or(Vec3::ZERO)
}

#[cfg(test)]
mod tests;

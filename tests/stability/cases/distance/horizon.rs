//! Lamps whose centre is below the horizon, and a part of them above.

use super::by_light;
use crate::case::{Case, Verdict};
use crate::guards::light::HORIZON;
use crate::judge::reads;
use crate::things::{bulb, lit_by, rectangle, sun};
use crate::truths::cone_above_horizon;
use bevy_kiln::artefact::StableId;
use bevy_kiln::math::polygon_irradiance;
use bevy_kiln::scene::{Light, PointLight};
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::PI;

const CULLED: &str = "a light whose centre is below the horizon is culled";
const ABOVE: &str = "E is that of what is above the horizon (quadrature) within 2 %, by light sampling alone";

pub const CASES: &[Case] = &[
    Case {
        name: "a_sun_that_has_half_set",
        hard: "a disc of 0.0093 rad whose middle is 2 mrad below the horizon, beside another light",
        elsewhere: CULLED,
        holds: ABOVE,
        guard: &HORIZON,
        without: "the sun is never chosen: it is dark",
        check: || sun_at(0.0093, -0.002),
    },
    Case {
        name: "a_sun_of_half_a_sphere",
        hard: "a disc of π rad whose middle is 40° below the horizon, beside another light",
        elsewhere: "a light whose centre is below the horizon is culled; 1 − cos² of a right angle is negative by \
                rounding",
        holds: ABOVE,
        guard: &HORIZON,
        without: "the sun is never chosen: it is dark",
        check: || sun_at(std::f32::consts::PI, -0.7),
    },
    Case {
        name: "a_bulb_that_has_half_set",
        hard: "a sphere whose centre is 0.05 rad below the horizon and its rim 0.1 rad above, beside another light",
        elsewhere: CULLED,
        holds: ABOVE,
        guard: &HORIZON,
        without: "the bulb is never chosen: it is dark",
        check: bulb_at_the_horizon,
    },
    Case {
        name: "a_rectangle_half_below_the_horizon",
        hard: "the receiver's plane cuts the lamp, whose centre is below it, beside another light",
        elsewhere: CULLED,
        holds: "E is that of the clipped polygon (Lambert) within 2 %, by light sampling alone",
        guard: &HORIZON,
        without: "the lamp is never chosen: it is dark",
        check: rectangle_at_the_horizon,
    },
];

/// A sun whose middle is below the horizon, beside a bulb, by light sampling alone.
fn sun_at(diameter: f32, elevation: f32) -> Verdict {
    let towards = Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let reading = by_light(&lit_by([Light::Directional(sun(towards, diameter)), dim()]), 1 << 15)?;
    let half = 0.5 * f64::from(diameter);
    let radiance = 1.0 / (PI * half.sin().powi(2));
    reads(&reading, radiance * cone_above_horizon(elevation.into(), half) + 1e-8, 0.02)
}

fn bulb_at_the_horizon() -> Verdict {
    let (radius, distance, elevation) = (0.3_f32, 2.0_f32, -0.05_f32);
    let place = distance * Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let reading = by_light(&lit_by([Light::Point(bulb(place, radius)), dim()]), 1 << 15)?;
    let radiance = 1.0 / (PI * f64::from(radius).powi(2));
    let half = f64::from(radius / distance).asin();
    reads(&reading, radiance * cone_above_horizon(elevation.into(), half) + 1e-8, 0.02)
}

fn rectangle_at_the_horizon() -> Verdict {
    let lamp = rectangle(Vec3::new(1.0, -0.1, 0.0), Vec3::NEG_X, Vec2::ONE);
    let reading = by_light(&lit_by([Light::Rect(lamp), dim()]), 1 << 14)?;
    let corners = [(-0.5, -0.6), (0.5, -0.6), (0.5, 0.4), (-0.5, 0.4)].map(|(z, y)| DVec3::new(1.0, y, z));
    reads(&reading, polygon_irradiance(&corners, DVec3::Y) + 1e-8, 0.02)
}

/// A point of a millionth of a candela, 10 m above.
fn dim() -> Light {
    let id = StableId::new("dim");
    Light::Point(PointLight { id, intensity: Vec3::splat(1e-6), ..bulb(Vec3::Y * 10.0, 0.0) })
}

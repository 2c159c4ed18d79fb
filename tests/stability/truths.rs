//! Light in closed form, and by quadrature where there is none, as several cases expect it.
//!
//! Form factors are the library's own (`bevy_kiln::math`), which its unit tests hold against tables.

use bevy_kiln::math::corner_parallel_rectangle;
use glam::Vec2;
use std::f64::consts::{PI, TAU};

/// Integral of a smooth function over [0, 1] by the midpoint rule.
pub fn integrate(f: impl Fn(f64) -> f64) -> f64 {
    let steps = 100_000;
    (0..steps).map(|i| f((f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps)
}

/// ∫ max(0, cos) over a cone of directions about an axis at this elevation above the horizon [rad], by midpoints.
pub fn cone_above_horizon(elevation: f64, half_angle: f64) -> f64 {
    let (rings, spokes) = (400, 400);
    let mut sum = 0.0;
    for ring in 0..rings {
        let angle = (ring as f64 + 0.5) / rings as f64 * half_angle;
        for spoke in 0..spokes {
            let turn = (spoke as f64 + 0.5) / spokes as f64 * TAU;
            let height = angle.cos() * elevation.sin() + angle.sin() * turn.cos() * elevation.cos();
            sum += height.max(0.0) * angle.sin();
        }
    }
    sum * half_angle / rings as f64 * TAU / spokes as f64
}

/// E [lx] straight under the middle of a square of 1 cd/m² and this half side [m] at this distance [m] (Howell B-3,
/// four times).
pub fn under_square(half: f32, distance: f32) -> f64 {
    4.0 * PI * corner_parallel_rectangle(half.into(), half.into(), distance.into())
}

/// E [lx] under a place of a square of 1 cd/m² and 1 m, `place` [m] off its middle (Howell B-3, four times).
pub fn under_place_of_square(place: Vec2, distance: f32) -> f64 {
    let part = |a: f32, b: f32| corner_parallel_rectangle(f64::from(a), f64::from(b), distance.into());
    let sides = |place: f32| [0.5 - place, 0.5 + place];
    PI * sides(place.x).iter().flat_map(|&a| sides(place.y).map(|b| part(a, b))).sum::<f64>()
}

//! Rectangles that fill the view, or next to nothing of it, and everything between.

use super::{AREA_NEAR, NEAR_2, by_light_at};
use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::guards::light::{SOLID_ANGLE, SOLID_ANGLE_EXACT};
use crate::judge::reads;
use crate::things::{lit_by, rectangle};
use crate::truths::{under_place_of_square, under_square};
use crate::worlds::askew;
use bevy_kiln::math::polygon_irradiance;
use bevy_kiln::scene::Light;
use glam::{DVec3, Vec2, Vec3};

pub const CASES: &[Case] = &[
    Case {
        name: "a_tenth_of_a_millimetre_under_a_rectangle",
        hard: "a rectangle of 1 m fills all but 1e-4 of the view",
        elsewhere: AREA_NEAR,
        holds: NEAR_2,
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_rectangle(1e-4, 0.5, 0.02),
    },
    Case {
        name: "a_micrometre_under_a_rectangle",
        hard: "1/d² = 1e12 1/m², and the lamp's plane is 8 steps of f32 away",
        elsewhere: AREA_NEAR,
        holds: "E = π within 2 %: level, since f32 puts a tilted lamp of 1 m no nearer than 2 µm",
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_level_rectangle(1e-6, 0.5, 0.02),
    },
    Case {
        name: "under_the_edge_of_a_rectangle",
        hard: "0.1 mm under the very edge: half the hemisphere",
        elsewhere: AREA_NEAR,
        holds: "E = π/2 (by four rectangles, Howell B-3) within 2 %",
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_place(Vec2::new(0.5, 0.0), 1e-4),
    },
    Case {
        name: "under_the_corner_of_a_rectangle",
        hard: "0.1 mm under the very corner: a quarter of the hemisphere",
        elsewhere: AREA_NEAR,
        holds: "E = π/4 (Howell B-3) within 2 %",
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_place(Vec2::new(0.5, 0.5), 1e-4),
    },
    Case {
        name: "edge_on_beside_a_rectangle",
        hard: "1 mm off its edge and 1 mm below its plane, facing it: the receiver's normal is perpendicular to the \
                lamp's",
        elsewhere: "Cornell's lamp needs 9.84 million samples by area 1 unit off its edge for 2 %",
        holds: "E is that of the polygon (Lambert) within 3 %",
        guard: &SOLID_ANGLE,
        without: "the noise is more than a tenth",
        check: edge_on,
    },
    Case {
        name: "under_a_ceiling_of_1000_km",
        hard: "a solid angle of 2π less 6e-6 sr",
        elsewhere: "area sampling finds one point in 1e11 within 1 m",
        holds: "E = π within 1 %",
        guard: &SOLID_ANGLE,
        without: "every sample is too far away to count: it is dark",
        check: || under_a_level_rectangle(1.0, 5e5, 0.01),
    },
    Case {
        name: "10_km_from_a_rectangle",
        hard: "a solid angle of 1e-8 sr as a difference of angles",
        elsewhere: "the sum of four angles less 2π has an error of 5e-7 in f32 shaders",
        holds: "E = π·F (Howell B-3) within 1e-3",
        guard: &SOLID_ANGLE_EXACT,
        without: "the difference is rounding: the lamp is dark, or 50 times too bright",
        check: || under_a_rectangle(1e4, 0.5, 1e-3),
    },
    Case {
        name: "1_km_from_a_lamp_of_1_mm",
        hard: "a solid angle of 1e-12 sr",
        elsewhere: "differences of angles are good to 1e-16 in f64 and 1e-7 in f32",
        holds: "E = π·F (Howell B-3) within 1e-3: where f32 puts a lamp 1 km away it keeps its size",
        guard: &SOLID_ANGLE_EXACT,
        without: "the difference is rounding: the lamp is dark",
        check: || under_a_rectangle(1e3, 5e-4, 1e-3),
    },
];

/// Straight under a square of this half side, seen full.
fn under_a_rectangle(distance: f32, half: f32, tolerance: f64) -> Verdict {
    let lamp = rectangle(askew() * Vec3::Y * distance, askew() * Vec3::NEG_Y, Vec2::splat(2.0 * half));
    let readings = by_light_at(&lit_by([Light::Rect(lamp)]), &[at(Vec3::ZERO, askew() * Vec3::Y)], 1 << 14)?;
    reads(&readings[0], under_square(half, distance), tolerance)
}

/// The same of a lamp that lies level.
fn under_a_level_rectangle(distance: f32, half: f32, tolerance: f64) -> Verdict {
    let lamp = rectangle(Vec3::Y * distance, Vec3::NEG_Y, Vec2::splat(2.0 * half));
    let readings = by_light_at(&lit_by([Light::Rect(lamp)]), &[at(Vec3::ZERO, Vec3::Y)], 1 << 14)?;
    reads(&readings[0], under_square(half, distance), tolerance)
}

/// Under the edge or the corner of a square of 1 m.
fn under_a_place(place: Vec2, distance: f32) -> Verdict {
    let lamp = rectangle(Vec3::Y * distance, Vec3::NEG_Y, Vec2::ONE);
    let point = Vec3::new(place.x, 0.0, place.y);
    let readings = by_light_at(&lit_by([Light::Rect(lamp)]), &[at(point, Vec3::Y)], 1 << 14)?;
    reads(&readings[0], under_place_of_square(place, distance), 0.02)
}

/// A millimetre off the edge of a rectangle and below its plane, facing it edge-on.
fn edge_on() -> Verdict {
    let scene = lit_by([Light::Rect(rectangle(Vec3::ZERO, Vec3::NEG_Y, Vec2::ONE))]);
    let place = Vec3::new(0.501, -1e-3, 0.0);
    let readings = by_light_at(&scene, &[at(place, Vec3::NEG_X)], 1 << 14)?;
    let corners =
        [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| DVec3::new(x, 0.0, z) - place.as_dvec3());
    reads(&readings[0], polygon_irradiance(&corners, DVec3::NEG_X), 0.03)
}

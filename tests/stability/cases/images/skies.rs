//! Pictures of the sky: few pixels, bright pixels, and pixels that are no light.

use super::{SPREADS, sky, under_map};
use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::guards::bake::NO_LIGHT_REFUSED;
use crate::guards::texture::{EMISSION_IN_BOUNDS, SINE_INTEGRATED, SKY_BY_ITS_LIGHT};
use crate::judge::{baked, is_refused, light_at, reads};
use bevy_kiln::bake::{BakeSettings, Goal};
use bevy_kiln::scene::EnvironmentMap;
use glam::{Vec2, Vec3};
use std::f64::consts::{PI, TAU};

const NO_LIGHT: &str = "that is negative or not a finite number";
const NAMED: &str = "refused by name, with the pixel's column and row";

pub const CASES: &[Case] = &[
    Case {
        name: "a_sky_with_one_pixel_of_1e7",
        hard: "nearly all light comes from one pixel in 8192, which a random direction meets once in 10 000 times",
        elsewhere: "a light map full of specks",
        holds: "its flat irradiance, L·Δφ·(sin²θ₁ − sin²θ₀)/2 and π of the rest, within 1 %",
        guard: &SKY_BY_ITS_LIGHT,
        without: "specks: the noise is far above 1 %",
        check: one_bright_pixel,
    },
    Case {
        name: "a_sun_on_the_seam",
        hard: "one half of the sun is the last pixel of a row, the other the first",
        elsewhere: "half a sun, or a line in the sky",
        holds: "both halves light a wall: L·2Δφ's quadrature within 1 %",
        guard: &SKY_BY_ITS_LIGHT,
        without: "specks: the noise is far above 1 %",
        check: sun_on_the_seam,
    },
    Case {
        name: "a_sky_of_one_pixel",
        hard: "one pixel is the whole sphere: its middle says nothing of it",
        elsewhere: "sin θ at a pixel's middle: π/2 times the light",
        holds: "E = π·L within 0.1 %",
        guard: &SINE_INTEGRATED,
        without: "the density is not that of the directions",
        check: || horizontal(sky([1, 1], |_, _| 2.0), 2.0 * PI, 1e-3),
    },
    Case {
        name: "a_sky_of_one_column",
        hard: "rows that go round the whole sky, the first around the pole",
        elsewhere: "sin θ at a pixel's middle",
        holds: "E = π·Σ L·(sin²θ₁ − sin²θ₀) over 4 rows, within 0.1 %",
        guard: &SINE_INTEGRATED,
        without: "the density is not that of the directions",
        check: || {
            let rows = [5.0, 1.0, 3.0, 9.0];
            let map = sky([1, 8], move |_, row| rows.get(row as usize).copied().unwrap_or(0.0));
            let edge = |row: usize| (PI * row as f64 / 8.0).sin().powi(2);
            let truth = (0..4).map(|row| PI * f64::from(rows[row]) * (edge(row + 1) - edge(row))).sum::<f64>();
            horizontal(map, truth, 1e-3)
        },
    },
    Case {
        name: "a_pixel_at_the_pole",
        hard: "a pixel that is a triangle: its upper edge is a point",
        elsewhere: "sin θ at a pixel's middle, or a division by sin θ = 0",
        holds: "E = L·Δφ·sin²θ₁/2 within 0.5 %",
        guard: &SINE_INTEGRATED,
        without: "the density is not that of the directions",
        check: || {
            let map = sky([8, 4], |column, row| if (column, row) == (5, 0) { 100.0 } else { 0.0 });
            horizontal(map, 100.0 * TAU / 8.0 * 0.5 * (PI / 4.0).sin().powi(2), 5e-3)
        },
    },
    Case {
        name: "a_black_sky_is_not_baked",
        hard: "a picture that gives no light: no density can be drawn from it",
        elsewhere: "0/0 in the table of pixels",
        holds: "refused: the scene has no light",
        guard: &NO_LIGHT_REFUSED,
        without: "a black bake that looks like a fault of the baker",
        check: || {
            let mut scene = under_map(sky([4, 2], |_, _| 0.0));
            scene.meshes[0].uv1 = Some(vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]);
            match baked(&scene, &BakeSettings { goal: Goal::Samples(16), ..BakeSettings::default() }) {
                Err(error) if error.starts_with("the scene has no light") => Ok(()),
                other => Err(format!("{:?}", other.map(|lightmap| lightmap.report))),
            }
        },
    },
    Case {
        name: "a_sky_with_nan",
        hard: "one pixel is no number",
        elsewhere: SPREADS,
        holds: NAMED,
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || bad_pixel(f32::NAN, NO_LIGHT),
    },
    Case {
        name: "a_sky_with_infinity",
        hard: "a saturated pixel of a photograph, stored as ∞",
        elsewhere: SPREADS,
        holds: NAMED,
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || bad_pixel(f32::INFINITY, NO_LIGHT),
    },
    Case {
        name: "a_sky_with_a_negative_pixel",
        hard: "what sharpening leaves beside a bright edge",
        elsewhere: "a negative density, and light that is taken away",
        holds: NAMED,
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || bad_pixel(-1e-6, NO_LIGHT),
    },
    Case {
        name: "a_sky_with_a_pixel_of_1e30",
        hard: "finite, but squares and quotients of it are not",
        elsewhere: SPREADS,
        holds: "refused by name, with the pixel and the limit of 1e25 cd/m²",
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || bad_pixel(1e30, "brighter than 1e25 cd/m², where numbers end"),
    },
];

/// Whether the ground under a sky reads `truth` [lx].
fn horizontal(map: EnvironmentMap, truth: f64, tolerance: f64) -> Verdict {
    reads(&light_at(&under_map(map), &[at(Vec3::ZERO, Vec3::Y)], 1 << 16)?[0], truth, tolerance)
}

fn one_bright_pixel() -> Verdict {
    let map = sky([128, 64], |column, row| if (column, row) == (40, 20) { 1e7 } else { 1.0 });
    let edge = |row: f64| (PI * row / 64.0).sin().powi(2);
    let truth = PI + (1e7 - 1.0) * TAU / 128.0 * 0.5 * (edge(21.0) - edge(20.0));
    horizontal(map, truth, 1e-2)
}

fn sun_on_the_seam() -> Verdict {
    // The seam lies towards −X; the sun in the row above the horizon.
    let map = sky([128, 64], |column, row| if row == 30 && (column == 0 || column == 127) { 1e6 } else { 0.0 });
    // ∫ sin²θ dθ ∫ cos φ dφ around −X.
    let over = |theta: f64| 0.5 * theta - 0.25 * (2.0 * theta).sin();
    let heights = over(PI * 31.0 / 64.0) - over(PI * 30.0 / 64.0);
    let truth = 1e6 * heights * 2.0 * (TAU / 128.0).sin();
    reads(&light_at(&under_map(map), &[at(Vec3::new(0.0, 1.0, 0.0), Vec3::NEG_X)], 1 << 14)?[0], truth, 1e-2)
}

/// Whether a sky is refused that has such a pixel at column 3, row 1.
fn bad_pixel(value: f32, what: &str) -> Verdict {
    let map = sky([4, 2], |column, row| if (column, row) == (3, 1) { value } else { 1.0 });
    is_refused(&under_map(map), &format!("environment map \"sky\" has a pixel {what} (the first at column 3, row 1"))
}

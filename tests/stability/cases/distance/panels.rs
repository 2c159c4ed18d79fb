//! Lamps that are surfaces, or lie in one, which their own shadow rays must not meet; and the noise near a lamp.

use super::{AREA_NEAR, NEAR_2, by_light_at};
use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey, lit_room};
use crate::guards::light::{LAMP_END, SOLID_ANGLE, TWO_WAYS};
use crate::judge::{ensure, light_at, light_by, reads};
use crate::things::rectangle;
use crate::truths::under_square;
use crate::worlds::{askew, askew_aside, under};
use bevy_kiln::math::luminance;
use bevy_kiln::scene::Light;
use bevy_kiln::trace::Transport;
use glam::{Affine3A, Vec2, Vec3};

const ENDS_BEHIND: &str = "an end that lies behind its lamp is blocked by it; a bias that is long enough passes what \
                           hangs before the lamp";

pub const CASES: &[Case] = &[
    Case {
        name: "a_tenth_of_a_millimetre_under_a_glowing_panel",
        hard: "a surface that glows, askew and near: both samples and rays meet it",
        elsewhere: AREA_NEAR,
        holds: NEAR_2,
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_panel(1e-4, 0.02),
    },
    Case {
        name: "100_m_from_a_glowing_panel",
        hard: "a shadow ray of 100 m ends within 6 µm of its target, on a panel whose own error is 2 µm",
        elsewhere: ENDS_BEHIND,
        holds: "E = π·F (Howell B-3) within 1 %",
        guard: &LAMP_END,
        without: "a fifth of the light is lost",
        check: || under_a_panel(1e2, 1e-2),
    },
    Case {
        name: "10_km_from_a_glowing_panel",
        hard: "a shadow ray of 10 km ends within 0.6 mm of its target, on a panel whose own error is 2 µm",
        elsewhere: ENDS_BEHIND,
        holds: "E = π·F (Howell B-3) within 1e-3",
        guard: &LAMP_END,
        without: "half of the shadow rays end behind the panel, which blocks its own light: E is halved",
        check: || under_a_panel(1e4, 1e-3),
    },
    Case {
        name: "a_lamp_set_into_a_ceiling",
        hard: "lamp and ceiling in one plane, askew: rounding puts the one or the other in front",
        elsewhere: "the ceiling blocks a half of the lamp at random, or the lamp is raised by hand",
        holds: "E = π·F (Howell B-3) within 1 %",
        guard: &LAMP_END,
        without: "the lamp lies behind its ceiling in part",
        check: set_into_a_ceiling,
    },
    Case {
        name: "noise_half_a_millimetre_under_a_lamp",
        hard: "a path's worth by area is radiance · cos²/d² · area: 0.5 m² over 2.5e-7 m²",
        elsewhere: "area sampling needs 55.6 million samples 0.5 mm under Cornell's lamp for 2 %",
        holds: "the relative variance of a path there is at most 10 times that at the floor's middle, by light samples \
                and surface samples together, ρ = 0.5",
        guard: &TWO_WAYS,
        without: "the relative variance is more than a thousand times that",
        check: variance,
    },
];

/// Straight under a glowing panel of 1 m at the world's origin.
fn under_a_panel(distance: f32, tolerance: f64) -> Verdict {
    let panel = SceneBuilder::default()
        .quad("panel", Vec3::new(-0.5, 0.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 1.0))
        .build();
    let scene = under(panel, Affine3A::from_quat(askew()));
    let point = at(askew() * Vec3::NEG_Y * distance, askew() * Vec3::Y);
    let readings = by_light_at(&scene, &[point], 1 << 14)?;
    reads(&readings[0], under_square(0.5, distance), tolerance)
}

fn set_into_a_ceiling() -> Verdict {
    let mut room = SceneBuilder::default()
        .quad("ceiling", Vec3::new(-2.0, 1.0, -2.0), [Vec3::X * 4.0, Vec3::Z * 4.0], grey(0.0))
        .build();
    room.lights.push(Light::Rect(rectangle(Vec3::Y, Vec3::NEG_Y, Vec2::ONE)));
    let root = askew_aside();
    let point = at(root.transform_point3(Vec3::ZERO), askew() * Vec3::Y);
    let readings = light_at(&under(room, root), &[point], 1 << 12)?;
    reads(&readings[0], under_square(0.5, 1.0), 0.01)
}

/// Relative variance of a path's worth half a millimetre under the lamp of a room over that at its floor's middle.
fn variance() -> Verdict {
    let room = lit_room(0.5, 10.0);
    let relative = |point: Vec3| -> Result<f64, String> {
        let (mut mean, mut variance) = (0.0, 0.0);
        for seed in 0..256 {
            // One path for each replicate: their spread is that of single paths.
            let reading = &light_by(&room, &[at(point, Vec3::Y)], 16, Transport { seed, ..Transport::default() })?[0];
            mean += luminance(reading.irradiance) / 256.0;
            variance += luminance(reading.stderr).powi(2) * 16.0 / 256.0;
        }
        Ok(variance / (mean * mean))
    };
    let (near, far) = (relative(Vec3::new(2.0, 3.9 - 5e-4, 2.0))?, relative(Vec3::new(2.0, 0.0, 2.0))?);
    ensure(near <= 10.0 * far, || format!("relative variance of {near:.3} under the lamp and {far:.3} on the floor"))
}

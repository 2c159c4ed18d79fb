//! Bodies that bend and absorb, seen by a receiver in them.

use crate::case::{Case, Verdict};
use crate::common::fresnel::fresnel;
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::bsdf::RADIANCE_BY_INDEX;
use crate::guards::path::{BODY_LEARNT, NO_ZERO_TIMES_INFINITY};
use crate::judge::{light_at, reads};
use crate::things::{CLEAR, level, standard};
use crate::truths::integrate;
use bevy_kiln::bake::MeterReading;
use bevy_kiln::scene::{Interior, Standard};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

const NOT_CONCENTRATED: &str = "the light that the surface concentrates is missing";

pub const CASES: &[Case] = &[
    Case {
        name: "a_receiver_inside_glass",
        hard: "light changes its radiance by n² on the way in and on the way out",
        elsewhere: "glass as a grey filter",
        holds: "under glass under a white sky E = π(1 − F̄), the mean F̄ by Fresnel's law, within 1 %",
        guard: &RADIANCE_BY_INDEX,
        without: NOT_CONCENTRATED,
        check: || under_water(CLEAR),
    },
    Case {
        name: "attenuation_over_1e_6_m",
        hard: "exp(−∞) in two channels, and 0 · ∞ in the one that is not absorbed",
        elsewhere: "NaN, or light that underflow let through",
        holds: "red reads π(1 − F̄) within 1 %, green and blue are 0",
        guard: &BODY_LEARNT,
        without: "the way to the first surface is not dimmed",
        check: short_attenuation,
    },
    Case {
        name: "attenuation_over_1e_6_m_into_the_open",
        hard: "a body without a back: its light travels for ever, in a channel that nothing absorbs",
        elsewhere: "0 · ∞",
        holds: "over a single sheet red reads π(F̄ + (1 − F̄)/n²), as without absorption, within 1 %, green and blue \
                π·F̄, what is reflected, within 5 %",
        guard: &NO_ZERO_TIMES_INFINITY,
        without: "0 · ∞",
        check: open_body,
    },
    Case {
        name: "attenuation_over_1e_6_m_of_black",
        hard: "black has no logarithm: −ln 0 over any distance is ∞, over an infinite one it is no number",
        elsewhere: "NaN",
        holds: "black glass over 1e-6, 1e6 and ∞ m: E is a number; with 1e-6 it is dark, with ∞ clear within 1 %",
        guard: &BODY_LEARNT,
        without: "the way to the first surface is not dimmed",
        check: black_attenuation,
    },
    Case {
        name: "attenuation_over_1e6_m",
        hard: "half a metre of a way of 1e6 m: 1 − 3e-7 is left, five units in the last place",
        elsewhere: "lengths in another unit: glass that is black, or a mist",
        holds: "E = π(1 − F̄) as in clear glass, within 1 %",
        guard: &RADIANCE_BY_INDEX,
        without: NOT_CONCENTRATED,
        check: || under_water(Interior::Volume { attenuation_colour: Vec3::splat(0.5), attenuation_distance: 1e6 }),
    },
];

/// The mean reflectance of glass of index 1.5 under a white sky.
fn fresnel_average() -> f64 {
    integrate(|cosine| 2.0 * cosine * fresnel(cosine, 1.5))
}

/// A black ground half a metre under a surface of this glass, under a white sky.
fn water(interior: Interior) -> SceneBuilder {
    let water = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, interior, ..Standard::default() };
    let builder = level(SceneBuilder::default(), "ground", -0.5, [400.0, 1.0], grey(0.0));
    level(builder, "water", 0.0, [400.0, 1.0], standard(water)).sky(Vec3::ONE)
}

fn under_water(interior: Interior) -> Verdict {
    let reading = light_at(&water(interior).build(), &[at(Vec3::new(0.0, -0.5, 0.0), Vec3::Y)], 1 << 16)?[0];
    reads(&reading, PI * (1.0 - fresnel_average()), 1e-2)
}

/// Red passes, the rest does not.
fn red_alone(reading: &MeterReading, truth: f64) -> Verdict {
    let mut red = *reading;
    red.irradiance = DVec3::splat(reading.irradiance.x);
    red.stderr = DVec3::splat(reading.stderr.x);
    reads(&red, truth, 1e-2)?;
    if reading.irradiance.y == 0.0 && reading.irradiance.z == 0.0 {
        Ok(())
    } else {
        Err(format!("{}", reading.irradiance))
    }
}

fn short_attenuation() -> Verdict {
    let interior = Interior::Volume { attenuation_colour: Vec3::new(1.0, 0.5, 0.0), attenuation_distance: 1e-6 };
    let reading = light_at(&water(interior).build(), &[at(Vec3::new(0.0, -0.5, 0.0), Vec3::Y)], 1 << 16)?[0];
    red_alone(&reading, PI * (1.0 - fresnel_average()))
}

/// Above a sheet of glass that faces down: what goes down enters a body that has no end.
fn open_body() -> Verdict {
    let interior = Interior::Volume { attenuation_colour: Vec3::new(1.0, 0.5, 0.0), attenuation_distance: 1e-6 };
    let glass = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, interior, ..Standard::default() };
    let scene = level(SceneBuilder::default(), "sheet", 0.0, [4000.0, 1.0], standard(glass)).sky(Vec3::ONE).build();
    let reading = light_at(&scene, &[at(Vec3::new(0.0, 1.0, 0.0), Vec3::NEG_Y)], 1 << 16)?[0];
    // What is reflected is the sky of all colours; what crosses, to 1/n² of the radiance there, that of red.
    let reflected = fresnel_average();
    let red = PI * (reflected + (1.0 - reflected) / 2.25);
    let off = (reading.irradiance.x - red).abs() + 4.0 * reading.stderr.x;
    let others = (reading.irradiance.y - PI * reflected).abs() + 4.0 * reading.stderr.y;
    if off <= 1e-2 * red && others <= 5e-2 * PI * reflected { Ok(()) } else { Err(format!("{}", reading.irradiance)) }
}

fn black_attenuation() -> Verdict {
    let black = |attenuation_distance| Interior::Volume { attenuation_colour: Vec3::ZERO, attenuation_distance };
    let point = [at(Vec3::new(0.0, -0.5, 0.0), Vec3::Y)];
    let dark = light_at(&water(black(1e-6)).build(), &point, 1 << 12)?[0];
    if dark.irradiance != DVec3::ZERO {
        return Err(format!("black glass lets {} through", dark.irradiance));
    }
    light_at(&water(black(1e6)).build(), &point, 1 << 12)?;
    under_water(black(f32::INFINITY))
}

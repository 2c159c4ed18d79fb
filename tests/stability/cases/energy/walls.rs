//! Closed rooms whose walls absorb: the light is a series with a known sum.

use super::CUT;
use crate::case::{Case, Verdict};
use crate::common::meter::{at, on_walls};
use crate::common::scenes::{SceneBuilder, furnace, glowing, grey};
use crate::guards::bake::SUM_IN_F64;
use crate::guards::path::{CAP, NO_BEST_CHANCE, SURVIVAL_AT_MOST_ONE, SURVIVORS_STAND_IN, WEIGHTS};
use crate::judge::{all_read, ensure, light_at, light_by, mean_reads};
use crate::look::furnace_of_one;
use crate::things::{level, of, picture};
use bevy_kiln::bake::{CancelToken, MeterSettings, measure_irradiance};
use bevy_kiln::scene::{Filter, Material, Scattering, TextureRef, UvChannel, Wrap};
use bevy_kiln::trace::{Estimator, Transport};
use glam::Vec3;
use std::f64::consts::PI;

const SERIES: &str = "the light is a series Σ ρⁿ, whose tail is the longer the whiter the walls";
const TOO_LOW: &str = "a path is divided by a chance above 1, E is too low";
const WEIGHTS_GROW: &str = "weights grow as (1/q)ⁿ: the variance has no end";

pub const CASES: &[Case] = &[
    Case {
        name: "albedo_0",
        hard: "nothing is scattered: every path but the first segment carries nothing",
        elsewhere: "0 / 0 in roulette",
        holds: "E = π within 0.3 %",
        guard: &WEIGHTS,
        without: "light that both samples find counts twice",
        check: || furnace_reads(0.0, 1 << 14, 3e-3),
    },
    Case {
        name: "albedo_0_5",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 0.3 %",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: TOO_LOW,
        check: || furnace_reads(0.5, 1 << 12, 3e-3),
    },
    Case {
        name: "albedo_0_9",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 0.3 %",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost, E is too low",
        check: || furnace_reads(0.9, 1 << 11, 3e-3),
    },
    Case {
        name: "albedo_0_99",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 1 %, in 504 rays a path",
        guard: &NO_BEST_CHANCE,
        without: WEIGHTS_GROW,
        check: || furnace_reads(0.99, 1 << 8, 1e-2),
    },
    Case {
        name: "albedo_0_999",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 1 %; the cost, seen by surface samples, is ln(0.15)/ln ρ + 1/(1 − ρ) = 2896 rays a \
                path, of which the first 1896 live on for sure",
        guard: &NO_BEST_CHANCE,
        without: WEIGHTS_GROW,
        check: albedo_0_999,
    },
    Case {
        name: "a_cap_loses_what_it_should",
        hard: "a person may ask for a cap; it must lose the tail of the series, and no more",
        elsewhere: "off by one bounce, or roulette that ends paths before the cap",
        holds: "E = π(1 − ρ⁵)/(1 − ρ) for 4 bounces, ρ = 0.8, within 0.3 %",
        guard: &CAP,
        without: "a bounce too many",
        check: cap,
    },
    Case {
        name: "pictures_and_mirrors_on_the_walls",
        hard: "albedos from 0.05 to 0.95 that change with place and channel, and two mirrors between",
        elsewhere: "an average albedo for a wall, or mirrors that bounces do not see",
        holds: "Le(x) = 1 − ρ(x) gives radiance 1 everywhere (Szirmay-Kalos 2001): E = π within 0.5 %",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: TOO_LOW,
        check: pictures_and_mirrors,
    },
    Case {
        name: "coloured_walls",
        hard: "paths that carry 0.95 of red carry 0.05 of blue: roulette knows one number for three",
        elsewhere: "roulette by luminance, which makes blue noise of what red could bear",
        holds: "Le = 1 − ρ per channel gives radiance 1: E = π within 0.5 % in each channel",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost, E is too low",
        check: coloured_walls,
    },
    Case {
        name: "mirrors_on_five_sides",
        hard: "light that no light sample finds, after dozens of reflections",
        elsewhere: "mirrors reflect only what a probe saw",
        holds: "one glowing wall is seen in every direction: E = π within 0.3 %",
        guard: &WEIGHTS,
        without: "light in mirrors is weighted as if light samples found it too",
        check: mirrors_on_five_sides,
    },
    Case {
        name: "two_million_samples_do_not_drift",
        hard: "adding 0.1 to a sum of 13 000 rounds by up to 0.5 % of what is added, the same way every time",
        elsewhere: "accumulators of f32, or of half floats (Godot)",
        holds: "E = π·L to 1e-9: n · 2⁻⁵³ is 2.3e-10",
        guard: &SUM_IN_F64,
        without: "the sum drifts",
        check: two_million_samples,
    },
];

fn furnace_reads(albedo: f32, samples: u32, tolerance: f64) -> Verdict {
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    mean_reads(&light_at(&furnace(albedo), &points, samples)?, PI / (1.0 - f64::from(albedo)), tolerance)
}

fn albedo_0_999() -> Verdict {
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    let transport = Transport { estimator: Estimator::Bsdf, ..Transport::default() };
    let settings = MeterSettings { transport, samples_per_point: 176, threads: None };
    let measured = measure_irradiance(&furnace(0.999), &points, &settings, &(), &CancelToken::default());
    let measured = measured.map_err(|error| error.to_string())?;
    mean_reads(&measured.readings, PI / (1.0 - f64::from(0.999_f32)), 1e-2)?;
    let cost = measured.report.rays as f64 / measured.report.samples as f64;
    ensure((2800.0..3000.0).contains(&cost), || format!("{cost} rays a path"))
}

fn cap() -> Verdict {
    let transport = Transport { max_bounces: Some(4), ..Transport::default() };
    let readings = light_by(&furnace(0.8), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), 1 << 12, transport)?;
    let albedo = f64::from(0.8_f32);
    mean_reads(&readings, PI * (1.0 - albedo.powi(5)) / (1.0 - albedo), 3e-3)
}

fn pictures_and_mirrors() -> Verdict {
    let colour = |i: usize| {
        let value = 0.05 + 0.9 * ((i * 7) % 16) as f32 / 15.0;
        [value, value * 0.5, 1.0 - value, 1.0]
    };
    let mut scene = furnace(1.0);
    let of_16 = |colours: [[f32; 4]; 16]| picture([4, 4], colours.to_vec(), Wrap::Clamp, Filter::Linear);
    let albedos = std::array::from_fn(colour);
    scene.textures = vec![of_16(albedos), of_16(albedos.map(|colour| colour.map(|c| 1.0 - c)))];
    for material in &mut scene.materials {
        material.base_colour_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
        material.emission_texture = Some(TextureRef { texture: 1, uv: UvChannel::Uv1 });
    }
    scene.materials[0].scattering = Scattering::Mirror;
    scene.materials[3].scattering = Scattering::Mirror;
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    mean_reads(&light_at(&scene, &points, 1 << 11)?, PI, 5e-3)
}

fn coloured_walls() -> Verdict {
    let wall = |albedo: Vec3| Material { emitted_radiance: 1.0 - albedo, ..Material::diffuse("wall", albedo) };
    let (red, green) = (Vec3::new(0.95, 0.3, 0.05), Vec3::new(0.1, 0.9, 0.2));
    let sides = [wall(red), wall(green), wall(red), wall(red), wall(green), wall(red)];
    let scene = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, sides).build();
    furnace_of_one(&scene, 1 << 13, 5e-3)
}

fn mirrors_on_five_sides() -> Verdict {
    let mirror = || of(Scattering::Mirror);
    let sides = [mirror(), mirror(), mirror(), glowing(0.0, 1.0), mirror(), mirror()];
    let scene = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, sides).build();
    let points = [Vec3::X, Vec3::Y, Vec3::NEG_Y].map(|normal| at(Vec3::new(0.1, 0.2, -0.3), normal));
    all_read(&light_at(&scene, &points, 1 << 14)?, PI, 3e-3)
}

fn two_million_samples() -> Verdict {
    let scene = level(SceneBuilder::default(), "ground", 0.0, [1.0, 1.0], grey(0.0)).sky(Vec3::splat(0.1)).build();
    let points = [0.0, 0.5].map(|x| at(Vec3::new(x, 0.0, 0.0), Vec3::Y));
    all_read(&light_at(&scene, &points, 1 << 21)?, PI * f64::from(0.1_f32), 1e-9)
}

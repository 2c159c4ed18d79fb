//! Light adds up, and is as strong as what gives it.

use crate::Fault;
use crate::chance::{Search, finds, holds};
use crate::common::scenes::SceneBuilder;
use crate::judge::{Mean, settle};
use crate::sketch::{ALL, INDOORS, Shell, Sketch, sketches};
use bevy_kiln::bake::{CancelToken, MeterReading, MeterSettings, measure_irradiance};
use bevy_kiln::scene::{Light, Scene};
use bevy_kiln::trace::Transport;
use glam::{Vec2, Vec3};

/// To which share of the light its parts must add up.
const TOLERANCE: f64 = 0.03;

fn seed(seed: u64) -> Transport {
    Transport { seed, ..Transport::default() }
}

/// The light of all lamps is the sum of the light of each, under other random numbers.
fn superposition(sketch: &Sketch, fault: Fault) -> Result<(), String> {
    let points = sketch.points();
    settle(TOLERANCE, |samples| {
        let mut lamps = sketch.lamps.clone();
        if fault == Fault::LampTwice {
            lamps.push(lamps[0]);
        }
        let transport = match fault {
            Fault::BounceMissing => Transport { max_bounces: Some(1), ..seed(1) },
            _ => seed(1),
        };
        // What glows reflects too: each part has all of the things, lit or not.
        let part = |lit: usize| {
            let mut scene = sketch.scene();
            darken(&mut scene, |name| name != format!("lamp {lit}"));
            Mean::of(&scene, &points, samples, seed(2 + lit as u64))
        };
        let parts = (0..sketch.lamps.len()).map(part).reduce(Mean::plus).unwrap();
        [Mean::of(&sketch.with_lamps(&lamps), &points, samples, transport), parts]
    })
}

/// Puts out all lamps of these names.
fn darken(scene: &mut Scene, is_out: impl Fn(&str) -> bool) {
    scene.lights.retain(|light| !is_out(light.name()));
    for instance in &scene.instances {
        if is_out(&instance.name) {
            scene.materials[instance.material].emitted_radiance = Vec3::ZERO;
        }
    }
}

const SHELLS: &[Shell] = &[Shell::Closed, Shell::Open];

#[test]
fn lights_add_up() {
    holds(14, sketches(SHELLS, INDOORS), |sketch| superposition(sketch, Fault::None));
    holds(6, sketches(&[Shell::Open], ALL), |sketch| superposition(sketch, Fault::None));
}

#[test]
fn a_lamp_counted_twice_is_found() {
    let found = finds(Search { cases: 4, shrinks: 24 }, sketches(SHELLS, INDOORS), |sketch| {
        superposition(sketch, Fault::LampTwice)
    });
    // Shrunk to what can be read.
    assert!(found.case.lamps.len() == 1 && found.case.blocks.is_empty(), "{}\n{}", found.reason, found.case);
}

#[test]
fn a_missing_bounce_is_found() {
    finds(Search { cases: 4, shrinks: 24 }, sketches(&[Shell::Closed], INDOORS), |sketch| {
        superposition(sketch, Fault::BounceMissing)
    });
}

fn readings(scene: &Scene, sketch: &Sketch) -> Vec<MeterReading> {
    let settings = MeterSettings { transport: seed(7), samples_per_point: 64, threads: None };
    measure_irradiance(scene, &sketch.points(), &settings, &(), &CancelToken::default()).unwrap().readings
}

/// All that gives light, times a factor.
fn brightened(scene: &Scene, factor: f32) -> Scene {
    let mut scene = scene.clone();
    scene.materials.iter_mut().for_each(|material| material.emitted_radiance *= factor);
    for light in &mut scene.lights {
        match light {
            Light::Rect(panel) => panel.radiance *= factor,
            Light::Point(bulb) => bulb.intensity *= factor,
            Light::Spot(spot) => spot.bulb.intensity *= factor,
            Light::Directional(sun) => sun.illuminance *= factor,
        }
    }
    scene
}

/// By how much a factor may be missed that is no power of two: each path is a product of some tens of factors and a
/// sum of as many terms, each rounded to 2⁻²⁴, in random directions.
const ROUNDING: f64 = 1e-5;

/// The same random numbers give the same paths, however bright the lamps: a power of two changes nothing but
/// exponents, any other factor the last bits.
fn linearity(sketch: &Sketch, fault: Fault) -> Result<(), String> {
    let scene = sketch.scene();
    let before = readings(&scene, sketch);
    for factor in [1e-6, 1e-3, 1.7, 1e3, 1e6, 2.0_f32.powi(-20), 2.0_f32.powi(20)] {
        let planted = if fault == Fault::OnePercent { 1.01 } else { 1.0 };
        let after = readings(&brightened(&scene, factor * planted), sketch);
        let is_exact = factor.to_bits().trailing_zeros() >= 23;
        let limit = if is_exact { 0.0 } else { ROUNDING };
        for (before, after) in before.iter().zip(&after) {
            let expected = before.irradiance * f64::from(factor);
            let off = (after.irradiance - expected).abs();
            if !off.cmple(expected * limit).all() {
                return Err(format!("{factor} times {} is {}, not {expected}", before.irradiance, after.irradiance));
            }
        }
    }
    Ok(())
}

#[test]
fn light_is_linear_in_power() {
    holds(32, sketches(SHELLS, ALL), |sketch| linearity(sketch, Fault::None));
}

#[test]
fn one_percent_more_light_is_found() {
    let found = finds(Search { cases: 2, shrinks: 24 }, sketches(SHELLS, INDOORS), |sketch| {
        linearity(sketch, Fault::OnePercent)
    });
    assert!(found.case.lamps.len() == 1 && found.case.blocks.is_empty(), "{}\n{}", found.reason, found.case);
}

/// A lamp that gives no light is no lamp: not a bit changes.
#[test]
fn a_lamp_of_no_light_changes_nothing() {
    holds(6, sketches(SHELLS, ALL), |sketch| {
        let scene = sketch.scene();
        let middle = 0.5 * sketch.far();
        let dark = SceneBuilder::default().rect_light("dark", middle, Vec3::NEG_Y, Vec2::ONE, Vec3::ZERO).build();
        let mut more = scene.clone();
        more.lights.splice(0..0, dark.lights);
        let is_same = readings(&scene, sketch) == readings(&more, sketch);
        if is_same { Ok(()) } else { Err("a lamp of no light changed a bit".into()) }
    });
}

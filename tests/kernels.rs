//! The kernel of the plan against the kernel of everything: what a scene does not call for changes nothing but time.

mod common;

use bevy_kiln::bake::{BakePlan, BakeSettings, CancelToken};
use bevy_kiln::scene::{Interior, Light, Material, Scattering, Scene, Standard};
use bevy_kiln::trace::{Effect, EffectSet, Estimator, ForcedEffects, Transport};
use common::garden::garden;
use common::glb;
use common::meter::{at, on_walls, read};
use common::scenes::{SceneBuilder, glowing, grey};
use glam::Vec3;
use std::f64::consts::PI;

fn with(on: EffectSet) -> Transport {
    Transport { effects: ForcedEffects { on, ..ForcedEffects::default() }, ..Transport::default() }
}

/// Path by path the same but for rounding, whichever effect is forced on and with all of them.
#[test]
fn effects_that_nothing_calls_for_change_nothing() {
    let scene = glb::load("cornell");
    let points = on_walls(Vec3::splat(0.05), Vec3::splat(0.95), 2);
    let planned = read(&scene, &points, 256, Transport::default());
    let alone = Effect::ALL.map(|effect| EffectSet::NONE.with(effect));
    for on in alone.into_iter().chain([Effect::ALL.into_iter().collect()]) {
        for (reading, planned) in read(&scene, &points, 256, with(on)).iter().zip(&planned) {
            let off = (reading.irradiance - planned.irradiance).abs().max_element();
            let names: Vec<&str> = on.iter().map(Effect::name).collect();
            assert!(off <= 1e-4 * planned.irradiance.max_element(), "{names:?}: {reading:?} for {planned:?}");
        }
    }
}

/// What is forced off is not there; what is left is the rest of the light.
#[test]
fn light_that_is_forced_off_is_missing() {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-5.0, 0.0, -5.0), [10.0 * Vec3::Z, 10.0 * Vec3::X], grey(0.5))
        .quad("lamp", Vec3::new(-0.5, 2.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 3.0))
        .build();
    scene.sky_radiance = Vec3::splat(0.2);
    let points = [at(Vec3::new(0.3, 0.0, 0.2), Vec3::Y)];
    let reading = |off: EffectSet| {
        let effects = ForcedEffects { off, ..ForcedEffects::default() };
        let transport =
            Transport { effects, estimator: Estimator::Light, max_bounces: Some(0), ..Transport::default() };
        read(&scene, &points, 1 << 12, transport)[0].irradiance.x
    };
    let none = EffectSet::NONE;
    let [all, no_lamp, no_sky, dark] = [
        none,
        none.with(Effect::AreaLights),
        none.with(Effect::ConstantSky),
        none.with(Effect::AreaLights).with(Effect::ConstantSky),
    ]
    .map(reading);
    assert!(dark == 0.0 && no_lamp > 0.0 && no_sky > 0.0, "{all} {no_lamp} {no_sky} {dark}");
    assert!((no_lamp + no_sky - all).abs() < 2e-3 * all, "{no_lamp} + {no_sky} is not {all}");
}

/// What is black and yet reflects, varnish and the surface of glass, passes light on: paths need a bounce for it.
#[test]
fn black_varnish_and_black_glass_pass_light_on() {
    let varnish =
        Standard { reflectance: 0.0, clearcoat: 1.0, clearcoat_perceptual_roughness: 0.0, ..Standard::default() };
    let interior = Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: 1.0 };
    let glass = Standard {
        reflectance: 0.0,
        specular_transmission: 1.0,
        perceptual_roughness: 0.0,
        interior,
        ..Standard::default()
    };
    for scattering in [
        Scattering::Standard(Box::new(varnish)),
        Scattering::Standard(Box::new(glass)),
        Scattering::Refraction { ior: 1.5 },
    ] {
        let material = Material::scattering("black", Vec3::ZERO, scattering.clone());
        let mut scene = SceneBuilder::default()
            .quad("ceiling", Vec3::new(-50.0, 1.0, -50.0), [100.0 * Vec3::X, 100.0 * Vec3::Z], material)
            .build();
        scene.sky_radiance = Vec3::ONE;
        // Held below the ceiling's front, the meter sees nothing but the sky's reflection in it.
        let reading = read(&scene, &[at(Vec3::ZERO, Vec3::Y)], 1 << 10, Transport::default())[0].irradiance.x;
        assert!(reading > 0.05 * PI, "{scattering:?}: {reading}");
    }
}

/// Light that no path finds is warned of: a sun without a disc on a mirror; with a disc it is found.
#[test]
fn a_sun_without_a_size_is_warned_of_where_a_mirror_should_show_it() {
    let warnings = |angular_diameter: f32, scattering: Scattering| {
        let mut scene = SceneBuilder::default()
            .quad("floor", Vec3::ZERO, [Vec3::Z, Vec3::X], grey(0.5))
            .quad("thing", Vec3::X, [Vec3::Z, Vec3::Y], Material::scattering("thing", Vec3::ONE, scattering))
            .build();
        let mut sun = garden().lights.remove(2);
        if let Light::Directional(sun) = &mut sun {
            sun.angular_diameter = angular_diameter;
        }
        scene.lights.push(sun);
        let plan = BakePlan::for_scene(&scene, &BakeSettings::default(), &(), &CancelToken::default()).unwrap();
        plan.warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let found = warnings(0.0, Scattering::Mirror);
    assert!(found.len() == 1 && found[0].starts_with("lights without a size (1) shine neither through"), "{found:?}");
    let rough = Scattering::Standard(Box::new(Standard { metallic: 1.0, ..Standard::default() }));
    for (diameter, scattering) in [(0.01, Scattering::Mirror), (0.0, rough), (0.0, Scattering::Diffuse)] {
        assert_eq!(warnings(diameter, scattering), [""; 0]);
    }
}

/// The plan as a person reads it, for scenes of different kinds; shares and times, which no test can know, apart.
#[test]
fn plans_read_well() {
    let plan = |scene: &Scene, forced: ForcedEffects| {
        let transport = Transport { effects: forced, ..Transport::default() };
        let settings = BakeSettings { transport, density: 4.0, ..BakeSettings::default() };
        let plan = BakePlan::for_scene(scene, &settings, &(), &CancelToken::default()).unwrap();
        let lines = plan.effects.iter().map(|planned| {
            assert_eq!(planned.cost_share.is_some(), planned.on);
            assert!(planned.cost_share.is_none_or(|share| (0.0..=1.0).contains(&share)));
            format!("{:22}{} {}", planned.effect.name(), if planned.on { "on " } else { "off" }, planned.reason)
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    let forced = |on: EffectSet, off: EffectSet| ForcedEffects { on, off };
    let none = EffectSet::NONE;
    let cornell = glb::load("cornell");
    let glossy = {
        let plastic = Material::scattering("plastic", Vec3::splat(0.5), Scattering::Standard(Box::default()));
        let glass = Standard { specular_transmission: 1.0, ..Standard::default() };
        let window = Material::scattering("window", Vec3::ONE, Scattering::Standard(Box::new(glass)));
        let mut scene = SceneBuilder::default()
            .quad("floor", Vec3::ZERO, [Vec3::Z, Vec3::X], plastic)
            .quad("window", Vec3::Y, [Vec3::Z, Vec3::X], window)
            .build();
        scene.sky_radiance = Vec3::new(0.25, 0.5, 1.0);
        scene
    };
    let garden = garden();
    let found = [
        ("the Cornell box", plan(&cornell, ForcedEffects::default())),
        (
            "the same with forced effects",
            plan(&cornell, forced(none.with(Effect::Refraction), none.with(Effect::Interreflection))),
        ),
        ("plastic and a window under a sky", plan(&glossy, ForcedEffects::default())),
        ("a garden", plan(&garden, ForcedEffects::default())),
    ];
    let found: String = found.iter().map(|(name, plan)| format!("{name}\n{plan}\n\n")).collect();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/plans.txt");
    if std::env::var_os("KILN_WRITE_SNAPSHOTS").is_some() {
        std::fs::write(path, &found).unwrap();
    }
    let expected = std::fs::read_to_string(path).unwrap();
    assert_eq!(found, expected, "\nKILN_WRITE_SNAPSHOTS=1 writes {path} anew; read what has changed");
}

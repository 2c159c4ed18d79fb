//! Lights whose direct light is drawn in real time: a lightmap holds what surfaces send on of theirs, and nothing else.

mod common;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, CancelToken, Denoise, Goal, LaterBounces, Lightmap, TexelState, bake_lightmap};
use bevy_kiln::math::luminance;
use bevy_kiln::scene::{DirectionalLight, Light, PointLight, Scene, SpotLight};
use bevy_kiln::trace::{Estimator, Sharing, Transport};
use common::scenes::{SceneBuilder, glowing, grey};
use glam::{Vec2, Vec3};

/// Means over texels differ by no more than this share, noise included.
const TOLERANCE: f64 = 0.01;

fn bake(scene: &Scene, transport: Transport, later_bounces: LaterBounces) -> Lightmap {
    let settings = BakeSettings {
        goal: Goal::Samples(1024),
        density: 4.0,
        denoise: Denoise::Off,
        transport,
        later_bounces,
        ..BakeSettings::default()
    };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// Mean luminance over all texels, and its standard error as if they were independent.
fn mean(lightmap: &Lightmap) -> [f64; 2] {
    let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
    for page in &lightmap.pages {
        for index in (0..page.state.len()).filter(|&index| page.state[index] == TexelState::Measured) {
            sum += luminance(page.raw[index].as_dvec3());
            squares += luminance(page.stderr[index].as_dvec3()).powi(2);
            count += 1.0;
        }
    }
    [sum / count, squares.sqrt() / count]
}

fn point(name: &str, position: Vec3, radius: f32) -> PointLight {
    PointLight {
        id: StableId::new(name),
        name: name.into(),
        position,
        intensity: Vec3::splat(20.0),
        radius,
        range: None,
    }
}

/// A box without a lid, with a light of every kind over it.
fn box_under_lights() -> Scene {
    let walls = || [0.6; 6].map(grey);
    let builder = SceneBuilder::default().room(Vec3::ZERO, Vec3::splat(2.0), walls()).rect_light(
        "rectangle",
        Vec3::new(1.0, 1.9, 1.0),
        Vec3::NEG_Y,
        Vec2::splat(0.4),
        Vec3::splat(50.0),
    );
    let mut scene = builder.build();
    let lid = scene.instances.iter().position(|instance| instance.name == "+y").unwrap();
    scene.instances.remove(lid);
    let down = Vec3::new(0.3, -1.0, 0.2).normalize();
    scene.lights.extend([
        Light::Point(point("point", Vec3::new(0.4, 1.5, 0.5), 0.0)),
        Light::Point(point("bulb", Vec3::new(1.4, 1.2, 0.5), 0.1)),
        Light::Spot(SpotLight {
            bulb: point("spot", Vec3::new(1.0, 1.8, 1.5), 0.05),
            direction: down,
            inner_angle: 0.3,
            outer_angle: 0.6,
        }),
        Light::Directional(DirectionalLight {
            id: StableId::new("sun"),
            name: "sun".into(),
            direction: down,
            illuminance: Vec3::splat(30.0),
            angular_diameter: 0.05,
        }),
    ]);
    scene
}

const LIGHTS: [&str; 5] = ["rectangle", "point", "bulb", "spot", "sun"];

fn only(mut scene: Scene, light: &str) -> Scene {
    scene.lights.retain(|other| other.name() == light);
    scene
}

fn drawn(mut scene: Scene, lights: &[&str]) -> Scene {
    scene.indirect_only = lights.iter().map(|&light| StableId::new(light)).collect();
    scene
}

fn assert_near(what: &str, [value, error]: [f64; 2], [truth, its_error]: [f64; 2]) {
    let noise = 4.0 * error.hypot(its_error);
    assert!((value - truth).abs() + noise <= TOLERANCE * truth, "{what}: {value} for {truth}, noise {noise}");
}

/// Of a floor alone nothing comes back.
#[test]
fn a_floor_under_a_light_that_is_drawn_is_black() {
    let floor = SceneBuilder::default().quad("floor", Vec3::ZERO, [Vec3::Z * 2.0, Vec3::X * 2.0], grey(0.8)).build();
    for light in LIGHTS {
        for estimator in [Estimator::Mis, Estimator::Light, Estimator::Bsdf] {
            for sharing in [Sharing::Group, Sharing::Alone] {
                let lights = only(box_under_lights(), light).lights;
                let scene = drawn(Scene { lights, ..floor.clone() }, &[light]);
                let transport = Transport { estimator, sharing, ..Transport::default() };
                let lightmap = bake(&scene, transport, LaterBounces::Traced);
                assert_eq!(mean(&lightmap), [0.0; 2], "{light} {estimator:?} {sharing:?}");
                assert!(lightmap.baked_lights.is_empty());
            }
        }
    }
}

/// With all bounces, less direct light alone.
#[test]
fn what_is_left_is_all_less_direct_light() {
    for light in LIGHTS {
        let scene = only(box_under_lights(), light);
        let all = mean(&bake(&scene, Transport::default(), LaterBounces::Traced));
        let capped = Transport { max_bounces: Some(0), ..Transport::default() };
        let direct = mean(&bake(&scene, capped, LaterBounces::Traced));
        let rest = [all[0] - direct[0], all[1].hypot(direct[1])];
        assert!(direct[0] > 0.2 * all[0] && rest[0] > 0.05 * all[0], "{light}: {direct:?} of {all:?}");
        for (estimator, sharing, later_bounces) in [
            (Estimator::Mis, Sharing::Group, LaterBounces::Traced),
            (Estimator::Mis, Sharing::Alone, LaterBounces::Traced),
            (Estimator::Light, Sharing::Alone, LaterBounces::Traced),
            (Estimator::Mis, Sharing::Group, LaterBounces::Reused),
        ] {
            let transport = Transport { estimator, sharing, ..Transport::default() };
            let left = mean(&bake(&drawn(scene.clone(), &[light]), transport, later_bounces));
            assert_near(&format!("{light} {estimator:?} {sharing:?} {later_bounces:?}"), left, rest);
        }
    }
}

/// The checker is worth nothing if it takes these for right.
#[test]
fn planted_faults_are_found_out() {
    let scene = only(box_under_lights(), "bulb");
    let all = mean(&bake(&scene, Transport::default(), LaterBounces::Traced));
    let capped = |bounces| Transport { max_bounces: Some(bounces), ..Transport::default() };
    let direct = mean(&bake(&scene, capped(0), LaterBounces::Traced));
    let rest = [all[0] - direct[0], all[1].hypot(direct[1])];
    let is_taken = |value: [f64; 2]| std::panic::catch_unwind(|| assert_near("", value, rest)).is_ok();
    assert!(is_taken(rest));
    assert!(!is_taken(all), "direct light is still there");
    assert!(!is_taken(mean(&bake(&drawn(scene.clone(), &["bulb"]), capped(1), LaterBounces::Traced))), "one bounce");
    // A light that is left out altogether.
    assert!(!is_taken([0.0; 2]));
}

/// The direct light of all others stays, and what glows is no light that anybody draws.
#[test]
fn other_lights_are_as_they_were() {
    let mut scene = box_under_lights();
    let sign = SceneBuilder::default()
        .quad("sign", Vec3::new(0.2, 0.5, 0.1), [Vec3::X * 0.4, Vec3::Y * 0.4], glowing(0.5, 20.0))
        .build();
    let mut instance = sign.instances[0].clone();
    (instance.mesh, instance.material) = (scene.meshes.len(), scene.materials.len());
    scene.instances.push(instance);
    scene.meshes.extend(sign.meshes);
    scene.materials.extend(sign.materials);
    let drawn_lights = ["point", "sun", "spot"];
    let bake = |scene: &Scene, transport| mean(&bake(scene, transport, LaterBounces::Traced));
    let all = bake(&scene, Transport::default());
    let direct = {
        let mut alone = scene.clone();
        alone.lights.retain(|light| drawn_lights.contains(&light.name()));
        alone.materials.iter_mut().for_each(|material| material.emitted_radiance = Vec3::ZERO);
        bake(&alone, Transport { max_bounces: Some(0), ..Transport::default() })
    };
    let left = bake(&drawn(scene.clone(), &drawn_lights), Transport::default());
    assert_near("all but three", left, [all[0] - direct[0], all[1].hypot(direct[1])]);
    let settings = BakeSettings { goal: Goal::Samples(16), density: 2.0, ..BakeSettings::default() };
    let lightmap = bake_lightmap(&drawn(scene, &drawn_lights), &settings, &(), &CancelToken::default()).unwrap();
    let baked: Vec<&str> = lightmap.baked_lights.iter().map(StableId::as_str).collect();
    assert_eq!(baked, ["bulb", "rectangle"]);
}

/// What is absorbed is then less than what is given off, and says nothing.
#[test]
fn there_is_no_energy_balance_without_direct_light() {
    let lit = common::scenes::lit_room(0.5, 10.0);
    let balance = |scene: &Scene| bake(scene, Transport::default(), LaterBounces::Traced).report.energy_balance;
    assert!(balance(&lit).is_some_and(|balance| (balance - 1.0).abs() < 0.01));
    let lamps: Vec<&str> = lit.lights.iter().map(Light::name).collect();
    assert!(!lamps.is_empty());
    assert_eq!(balance(&drawn(lit.clone(), &lamps)), None);
}

//! Studies of what accuracy costs, end to end: slopes, floors, and the same numbers twice.

#[allow(dead_code, reason = "the reader of scenes is shared")]
#[path = "common/glb.rs"]
mod glb;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeError, BakeSettings, CancelToken};
use bevy_kiln::scene::{Light, Material, PointLight, Scene};
use bevy_kiln::study::{Cost, Curve, Effort, Standing, Study, StudyProgress, StudySettings, Technique, study};
use bevy_kiln::trace::Effect;
use glam::Vec3;
use std::cell::RefCell;
use std::sync::LazyLock;
use std::time::Duration;

fn settings(effort: Effort) -> StudySettings {
    StudySettings { bake: BakeSettings { density: 1.5, ..BakeSettings::default() }, effort }
}

fn run(scene: &Scene, paths: u32) -> Study {
    study(scene, &settings(Effort::Paths(paths)), &|_| (), &CancelToken::default()).unwrap()
}

static CORNELL: LazyLock<Study> = LazyLock::new(|| run(&glb::load("cornell"), 256));

fn curve(technique: Technique) -> &'static Curve {
    CORNELL.curve(technique).unwrap_or_else(|| panic!("no {technique:?}"))
}

#[test]
fn plain_monte_carlo_falls_with_the_root_and_what_a_bake_does_no_slower() {
    let plain = curve(Technique::Independent).slope.unwrap();
    assert!((plain.value + 0.5).abs() + 2.0 * plain.stderr < 0.12, "{plain:?}");
    let sobol = curve(Technique::Mis).slope.unwrap();
    assert!(sobol.value < -0.48 && sobol.value > -0.9 && sobol.stderr < 0.1, "{sobol:?}");
    for technique in [Technique::Naive, Technique::Light, Technique::Independent, Technique::Mis] {
        let curve = curve(technique);
        assert!(technique.is_unbiased() && curve.floor.is_none());
        let paths: Vec<u32> = curve.points.iter().map(|point| point.paths).collect();
        assert_eq!(paths, [16, 32, 64, 128, 256]);
        assert!(curve.points.windows(2).all(|pair| pair[0].error > pair[1].error), "{curve:?}");
    }
}

/// Naive path tracing finds a small lamp by chance alone.
#[test]
fn techniques_rank_as_textbooks_say() {
    let last = |technique| curve(technique).points.last().unwrap().error;
    assert!(last(Technique::Naive) > 2.0 * last(Technique::Light));
    assert!(last(Technique::Mis) < 1.1 * last(Technique::Light));
    assert!(last(Technique::Mis) < last(Technique::Independent));
    let denoised = curve(Technique::Denoised);
    assert_eq!(denoised.points.iter().map(|point| point.paths).collect::<Vec<_>>(), [16, 64, 256]);
    assert!(denoised.points[0].error < curve(Technique::Mis).points[0].error);
}

/// The reference is better than what is shown, and what is not shown is marked.
#[test]
fn points_are_marked_by_the_noise_of_the_reference() {
    let reference = CORNELL.reference;
    assert_eq!(reference.paths, 2048);
    for curve in &CORNELL.curves {
        for point in &curve.points {
            // Its own share of the squared difference is at most a quarter.
            let is_far = reference.error.powi(2) <= 0.25 * (point.error.powi(2) + reference.error.powi(2));
            assert_eq!(point.standing == Standing::Known, is_far, "{:?} {point:?}", curve.technique);
        }
    }
}

/// What a cap takes is the light that comes later, as two long runs of their own say it.
#[test]
fn the_floor_of_direct_light_only_is_the_missing_light() {
    let floor = curve(Technique::Capped(0)).floor.unwrap();
    let mean = |max_bounces| {
        let mut settings = settings(Effort::Paths(16));
        settings.bake.transport.max_bounces = max_bounces;
        settings.bake.transport.seed = 77;
        study(&glb::load("cornell"), &settings, &|_| (), &CancelToken::default()).unwrap().reference.mean
    };
    let missing = 1.0 - mean(Some(0)) / mean(None);
    assert!((floor.missing - missing).abs() < 0.01, "{floor:?} {missing}");
    // A mean square is at least the square of the mean.
    assert!(floor.error > missing && floor.error < 2.0 * missing, "{floor:?} {missing}");
    // The curve lies on its floor, and floors fall with the cap.
    let last = curve(Technique::Capped(0)).points.last().unwrap();
    assert!((last.error / floor.error - 1.0).abs() < 0.05, "{last:?} {floor:?}");
    let floors = [0, 1, 2, 4].map(|cap| curve(Technique::Capped(cap)).floor.unwrap().error);
    assert!(floors.is_sorted_by(|a, b| a > b), "{floors:?}");
    assert_eq!(curve(Technique::Capped(0)).price(0.01), Some(Cost::Never));
    assert!(matches!(curve(Technique::Mis).price(0.005), Some(Cost::Extrapolated(_))));
}

/// A floor of the fast mode that lies far below what a cap leaves, for less time than whole paths take; and bakes to
/// smaller and smaller errors.
#[test]
fn the_fast_mode_has_a_low_floor_and_errors_fall_as_asked() {
    let reused = curve(Technique::Reused);
    let floor = reused.floor.unwrap();
    assert!(!Technique::Reused.is_unbiased() && floor.missing.abs() < 0.01, "{floor:?}");
    assert!(floor.error < 0.03 && curve(Technique::Capped(1)).floor.unwrap().error > 0.1, "{floor:?}");
    let last = |technique| curve(technique).points.last().unwrap().error;
    assert!(last(Technique::Reused) < last(Technique::Mis));
    let adaptive = &curve(Technique::Adaptive).points;
    assert!(adaptive.len() >= 2 && adaptive.windows(2).all(|pair| pair[0].error > pair[1].error), "{adaptive:?}");
}

#[test]
fn effects_have_shares_and_pictures_their_samples() {
    let share = |effect| *CORNELL.effects.iter().find(|share| share.effect == effect).unwrap();
    assert_eq!(CORNELL.effects.len(), 2, "{:?}", CORNELL.effects);
    let bounced = share(Effect::Interreflection);
    let missing = curve(Technique::Capped(0)).floor.unwrap().missing;
    assert!((bounced.light - missing).abs() < 0.01, "{bounced:?} {missing}");
    assert_eq!(share(Effect::AreaLights).light, 1.0);
    let samples: Vec<u32> = CORNELL.strip.pictures.iter().map(|picture| picture.samples).collect();
    assert_eq!(samples, [10, 100]);
    for picture in &CORNELL.strip.pictures {
        assert_eq!(picture.radiance.len(), 96 * 96);
        let lit = picture.radiance.iter().filter(|radiance| radiance.max_element() > 0.0).count();
        assert!(lit > 3000, "{lit}");
    }
    assert!(CORNELL.left_out.iter().any(|sentence| sentence.contains("1000, 10000, 100000")), "{:?}", CORNELL.left_out);
}

/// All but times.
fn numbers(study: &Study) -> String {
    let curve = |curve: &Curve| {
        let points: Vec<_> = curve.points.iter().map(|point| (point.paths, point.error, point.standing)).collect();
        format!("{:?} {points:?} {:?} {:?}", curve.technique, curve.slope, curve.floor)
    };
    let curves: Vec<String> = study.curves.iter().map(curve).collect();
    let light: Vec<_> = study.effects.iter().map(|share| (share.effect, share.light)).collect();
    format!("{curves:?} {:?} {} {light:?} {:?}", study.reference.mean, study.reference.error, study.strip)
}

#[test]
fn the_same_values_twice_whatever_the_threads() {
    let scene = glb::load("cornell");
    let of = |threads: usize| {
        let mut settings = settings(Effort::Paths(32));
        settings.bake.density = 0.7;
        settings.bake.threads = Some(threads.try_into().unwrap());
        numbers(&study(&scene, &settings, &|_| (), &CancelToken::default()).unwrap())
    };
    let once = of(1);
    assert_eq!(once, of(3));
    assert!(once.len() > 1000);
}

/// Estimators that find no light, or all the same, have no curve, and a sentence says why.
#[test]
fn only_what_the_scene_calls_for_is_studied() {
    let mut bulb = glb::load("form_factor");
    for material in &mut bulb.materials {
        *material = Material::diffuse("black", Vec3::ZERO);
    }
    let mut sky = bulb.clone();
    bulb.lights.push(Light::Point(PointLight {
        id: StableId::new("bulb"),
        name: "bulb".into(),
        position: Vec3::new(0.0, 1.0, 0.0),
        intensity: Vec3::splat(100.0),
        radius: 0.0,
        range: None,
    }));
    sky.sky_radiance = Vec3::ONE;
    for (scene, techniques, sentence) in [
        (
            bulb,
            [Technique::Mis, Technique::Light, Technique::Independent, Technique::Adaptive, Technique::Denoised]
                .as_slice(),
            "no size",
        ),
        (
            sky,
            [Technique::Mis, Technique::Independent, Technique::Shared, Technique::Adaptive, Technique::Denoised]
                .as_slice(),
            "a constant sky",
        ),
    ] {
        let study = run(&scene, 16);
        let studied: Vec<Technique> = study.curves.iter().map(|curve| curve.technique).collect();
        assert_eq!(studied, techniques);
        assert!(study.left_out.iter().any(|left_out| left_out.contains(sentence)), "{:?}", study.left_out);
        assert!(study.left_out.iter().any(|left_out| left_out.contains("Caps on bounces")));
    }
}

/// A short time is kept to by and large, with every part there; progress never goes back. Nothing is said of how fast.
#[test]
fn a_study_in_a_second_has_all_parts() {
    let told = RefCell::new(Vec::new());
    let hear = |progress: &StudyProgress| told.borrow_mut().push(progress.clone());
    let effort = Effort::Time(Duration::from_secs(1));
    let study = study(&glb::load("cornell"), &settings(effort), &hear, &CancelToken::default()).unwrap();
    assert_eq!(study.curves.len(), 13);
    assert!(study.curves.iter().all(|curve| !curve.points.is_empty()));
    assert!(study.reference.paths >= 16 && study.reference.mean > 0.0);
    let told = told.into_inner();
    assert!(told.is_sorted_by(|a, b| a.done <= b.done), "{told:?}");
    assert!(told.iter().any(|progress| progress.what == "reference"));
}

#[test]
fn a_study_stops_when_asked_and_refuses_the_dark() {
    let cancel = CancelToken::default();
    let stop = |progress: &StudyProgress| {
        if progress.what == "reference" {
            cancel.cancel();
        }
    };
    let stopped = study(&glb::load("cornell"), &settings(Effort::Paths(16)), &stop, &cancel);
    assert_eq!(stopped.err(), Some(BakeError::Cancelled));
    let mut dark = glb::load("cornell");
    dark.materials.iter_mut().for_each(|material| material.emitted_radiance = Vec3::ZERO);
    let refused = study(&dark, &settings(Effort::Paths(16)), &|_| (), &CancelToken::default());
    assert!(matches!(refused.err(), Some(BakeError::NoLight { .. })));
}

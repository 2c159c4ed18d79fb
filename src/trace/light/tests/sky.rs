//! Discs in the sky and pictures of it: densities, radiance, and what both ways to ask for them agree on.

use super::{along, free};
use crate::artefact::StableId;
use crate::math::Frame;
use crate::math::testing::{ChiSquared, Domain, Random, Rejection};
use crate::scene::{DirectionalLight, EnvironmentMap};
use crate::trace::light::distant::DistantDisc;
use crate::trace::light::environment::Environment;
use crate::trace::light::lights::Parts;
use crate::trace::light::{Emitter, EmitterShape, End, LightContext, LightSample, Lights};
use glam::{Quat, Vec2, Vec3};
use std::cell::RefCell;
use std::f32::consts::PI;

pub(super) fn disc(angular_diameter: f32) -> DistantDisc {
    let direction = Vec3::new(0.48, -0.6, -0.64);
    DistantDisc::new(&DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction,
        illuminance: Vec3::new(1.0, 2.0, 3.0),
        angular_diameter,
    })
}

fn towards_disc() -> Vec3 {
    Vec3::new(-0.48, 0.6, 0.64)
}

/// χ² on the disc of radius 1 onto which the cone maps with equal areas.
fn verdict(diameter: f32, fault: impl Fn(Vec3) -> f64) -> Result<f64, Rejection> {
    let disc = disc(diameter);
    let lights = Lights::new(Parts { distant: vec![disc], ..Parts::default() });
    let ctx = free(Vec3::ZERO);
    let height = 2.0 * (0.25 * f64::from(diameter)).sin().powi(2);
    let frame = Frame::new(towards_disc());
    let disc_from_world = |wi: Vec3| {
        let local = frame.local_from_world(wi);
        // A sample on the very rim may lie beside it by a rounding.
        let inside = 1.0 - 1e-6 - 4e-7 / diameter;
        (local.truncate() / ((1.0 + local.z) * height as f32).sqrt() * inside).extend(0.0)
    };
    let density = |p: Vec3| {
        let inside = p * (1.0 - 1e-6 - 4e-7 / diameter);
        let drop = height as f32 * inside.length_squared();
        let plane = inside.truncate() * (height as f32 * (2.0 - drop)).sqrt();
        let wi = frame.world_from_local(plane.extend(1.0 - drop));
        if p.length_squared() > 1.0 {
            return 0.0;
        }
        let pdf: f64 = lights.distant(&ctx, wi).map(|met| f64::from(met.pdf)).sum();
        pdf * 2.0 * height * fault(wi)
    };
    let domain = Domain::Plane(Vec2::NEG_ONE, Vec2::ONE);
    let test = ChiSquared { cells: [31, 31], samples: 20_000, ..ChiSquared::over(domain) };
    test.run(|u| disc_from_world(lights.sample(&ctx, u, 0.5).expect("it shines").wi), density)
}

#[test]
fn discs_of_all_sizes_follow_their_density() {
    for diameter in [1e-3, 0.0093, 0.2, 1.5, PI] {
        let p = verdict(diameter, |_| 1.0);
        assert!(p.is_ok(), "{diameter}: {p:?}");
        let too_large = verdict(diameter, |_| 1.05);
        assert!(matches!(too_large, Err(Rejection::Total(_))), "{too_large:?}");
    }
    // As if by projected solid angle, mean 1.
    let height = 2.0 * (0.25_f64 * 1.5).sin().powi(2);
    let tilted = verdict(1.5, |wi| f64::from(wi.dot(towards_disc())) / (1.0 - 0.5 * height));
    assert!(matches!(tilted, Err(Rejection::Counts(_))), "{tilted:?}");
}

#[test]
fn a_disc_is_as_bright_as_its_illuminance_says() {
    for diameter in [0.0093_f32, 0.5, PI] {
        let lights = Lights::new(Parts { distant: vec![disc(diameter)], ..Parts::default() });
        let ctx = LightContext { position: Vec3::ONE, normal: Some(towards_disc()) };
        let sum: f64 = (0..10_000)
            .map(|i| Vec2::new((i % 100) as f32 + 0.5, (i / 100) as f32 + 0.5) / 100.0)
            .map(|u| lights.sample(&ctx, u, 0.5).expect("it shines"))
            .map(|sample| {
                assert_eq!(sample.end, End::Infinity);
                f64::from(sample.value.y * sample.wi.dot(towards_disc()))
            })
            .sum();
        assert!((sum / 20_000.0 - 1.0).abs() < 1e-3, "{diameter}: {sum}");
        let sine = f64::from(0.5 * diameter).sin();
        let radiance_of = |wi: Vec3| lights.distant(&ctx, wi).map(|met| met.radiance).sum::<Vec3>();
        let radiance = radiance_of(towards_disc()).z;
        assert!((f64::from(radiance) * std::f64::consts::PI * sine * sine / 3.0 - 1.0).abs() < 1e-5);
        // Its rim, from both sides.
        let frame = Frame::new(towards_disc());
        for turn in 0..7 {
            let aside = Vec2::from_angle(turn as f32);
            let at = |angle: f32| frame.world_from_local((aside * angle.sin()).extend(angle.cos()));
            assert_ne!(radiance_of(at(0.499 * diameter)), Vec3::ZERO);
            assert_eq!(radiance_of(at(0.501 * diameter)), Vec3::ZERO);
        }
    }
    let lone = Lights::new(Parts { distant: vec![disc(0.0)], ..Parts::default() });
    let sample = lone.sample(&free(Vec3::ZERO), Vec2::ZERO, 0.0).expect("it shines");
    assert_eq!((sample.pdf, sample.value), (None, Vec3::new(1.0, 2.0, 3.0)));
    assert!(sample.wi.distance(towards_disc()) < 1e-6 && lone.distant(&free(Vec3::ZERO), sample.wi).next().is_none());
}

/// A picture of the sky with some black in it.
fn patches() -> Option<Environment> {
    let radiance = (0..32).map(|i| Vec3::splat((i * 5 % 7) as f32 * 0.1)).collect();
    let world_from_map = Quat::from_rotation_x(0.4);
    Environment::new(&EnvironmentMap { name: "sky".into(), width: 8, height: 4, radiance, world_from_map })
}

/// Light sampling among a lamp, two suns and a picture of the sky, from a floor that one of the suns half rises over.
fn mixed() -> Lights {
    let corner = Vec3::new(-1.0, 2.0, -1.0);
    let lamp = Emitter {
        normal: Vec3::NEG_Y,
        ..super::source(EmitterShape::Rectangle { corner, edges: [2.0 * Vec3::X, 2.0 * Vec3::Z] }, false)
    };
    let low = DistantDisc::new(&DirectionalLight {
        id: StableId::new("low"),
        name: "low".into(),
        direction: Vec3::X,
        illuminance: Vec3::ONE,
        angular_diameter: 0.6,
    });
    Lights::new(Parts { emitters: vec![lamp], free: vec![0], distant: vec![disc(0.4), low], environment: patches() })
}

/// The densities that rays find, weighted per source: the lamp, the suns in their order, the sky.
fn density(lights: &Lights, ctx: &LightContext, wi: Vec3, weights: [f64; 4]) -> f64 {
    let lamp: f64 = lights.passed(ctx, along(ctx.position, wi, f32::INFINITY)).map(|met| f64::from(met.pdf)).sum();
    let far: f64 = lights
        .distant(ctx, wi)
        .map(|met| {
            // The suns are far brighter than the sky, and each has a colour of its own.
            let source = match met.radiance {
                r if r.x == r.y && r.x < 0.9 => 3,
                r if r.x == r.y => 2,
                _ => 1,
            };
            f64::from(met.pdf) * weights[source]
        })
        .sum();
    lamp * weights[0] + far
}

fn among_all(normal: Option<Vec3>, weights: [f64; 4]) -> Result<f64, Rejection> {
    let lights = mixed();
    let ctx = LightContext { position: Vec3::new(0.1, 0.0, 0.2), normal };
    let choices = RefCell::new(Random::new(3));
    let test = ChiSquared { cells: [61, 31], samples: 20_000, ..ChiSquared::over(Domain::Sphere) };
    let sample = |u| lights.sample(&ctx, u, choices.borrow_mut().unit()).expect("all shine").wi;
    test.run(sample, |wi| density(&lights, &ctx, wi, weights))
}

#[test]
fn the_choice_between_lamp_suns_and_sky_follows_its_density() {
    for normal in [None, Some(Vec3::Y), Some(Vec3::new(0.6, 0.0, 0.8))] {
        let p = among_all(normal, [1.0; 4]);
        assert!(p.is_ok(), "{normal:?}: {p:?}");
    }
    // Planted: the lamp takes a little from the sky, so that the total stays.
    let lights = mixed();
    let ctx = LightContext { position: Vec3::new(0.1, 0.0, 0.2), normal: Some(Vec3::Y) };
    let lamp = lights.chance(0, &ctx);
    let counts = |share: &dyn Fn(&LightSample) -> bool| {
        let mut random = Random::new(8);
        (0..20_000).filter(|_| share(&lights.sample(&ctx, random.square(), random.unit()).expect("all shine"))).count()
    };
    let found = counts(&|sample| sample.end != End::Infinity) as f64 / 20_000.0;
    assert!((found - lamp).abs() < 0.015, "{found} {lamp}");
    let sky = lights.distant(&ctx, Vec3::new(-0.3, 0.9, -0.2).normalize()).map(|met| f64::from(met.pdf)).sum::<f64>();
    assert!(sky > 0.0);
    let shifted = among_all(Some(Vec3::Y), [1.25, 1.0, 1.0, 1.0 - 0.25 * lamp / sky_chance(&lights, &ctx)]);
    assert!(matches!(shifted, Err(Rejection::Counts(_))), "{shifted:?}");
}

/// The chance of the sky: its density over what it has alone.
fn sky_chance(lights: &Lights, ctx: &LightContext) -> f64 {
    let wi = Vec3::new(-0.3, -0.5, -0.2).normalize();
    let met = lights.distant(ctx, wi).next().expect("the sky shines from below too");
    let alone = Lights::new(Parts { environment: patches(), ..Parts::default() });
    let own = alone.distant(ctx, wi).next().expect("the sky shines from below too");
    f64::from(met.pdf) / f64::from(own.pdf)
}

//! What must not break the choice or a sample: lights where the receiver is, of no size, of all sizes and powers, in
//! one place. Nowhere NaN, and what is claimed still sums to one.

use super::sky::disc;
use super::{along, lights, source, target};
use crate::artefact::StableId;
use crate::math::testing::Random;
use crate::scene::{Light, RectLight, Scene};
use crate::trace::Tracer;
use crate::trace::light::emitter::Cone;
use crate::trace::light::lights::Parts;
use crate::trace::light::{Emitter, EmitterShape, LightContext, Lights, SourceIndex};
use glam::{Affine3A, Vec2, Vec3};

fn of_strength(emitter: Emitter, strength: f32) -> Emitter {
    Emitter { strength: Vec3::splat(strength), mean_strength: Vec3::splat(strength), ..emitter }
}

fn every_shape(centre: Vec3, size: f32) -> Vec<Emitter> {
    let (u, v) = (size * Vec3::X, size * Vec3::Y);
    let spot = Cone { direction: Vec3::NEG_Z, inner_angle: 0.0, outer_angle: 1e-3 };
    let sphere = source(EmitterShape::Sphere { centre, radius: size }, false);
    let point = source(EmitterShape::Point { centre }, false);
    vec![
        source(EmitterShape::Rectangle { corner: centre, edges: [u, v] }, true),
        source(EmitterShape::Triangle { vertices: [centre, centre + u, centre + v] }, false),
        sphere,
        point,
        Emitter { cone: Some(spot), ..sphere },
        Emitter { cone: Some(spot), inverse_range: 1e18, ..point },
        Emitter { inverse_range: 1e-18, ..point },
    ]
}

/// Everything that is asked of lights, in many directions from one place; all answers are numbers.
fn interrogate(lights: &Lights, position: Vec3) -> u32 {
    let mut random = Random::new(1);
    let mut answers = 0;
    for index in 0..300 {
        let normal = if index % 3 == 0 { None } else { Some(random.direction()) };
        let ctx = LightContext { position, normal };
        let u = if index % 5 == 0 { Vec2::ZERO } else { random.square() };
        if let Some(sample) = lights.sample(&ctx, u, random.unit()) {
            answers += 1;
            assert!(sample.value.is_finite() && sample.value.min_element() >= 0.0, "{sample:?}");
            assert!((sample.wi.length() - 1.0).abs() < 1e-5, "{sample:?}");
            assert!(sample.pdf.is_none_or(|pdf| pdf.is_finite() && pdf > 0.0), "{sample:?}");
            if let SourceIndex::Emitter(number) = sample.source {
                assert!(lights.pdf(number, &ctx, sample.wi, sample.distance).is_finite());
            }
        }
        let wi = random.direction();
        for met in lights.passed(&ctx, along(position, wi, f32::INFINITY)).chain(lights.distant(&ctx, wi)) {
            assert!(met.pdf.is_finite() && met.radiance.is_finite(), "{met:?}");
        }
    }
    answers
}

#[test]
fn lights_at_and_around_the_receiver() {
    for size in [1e-6, 1.0, 1e6] {
        for centre in [Vec3::ZERO, Vec3::new(3.0, -4.0, 5.0)] {
            let all = lights(every_shape(centre, size));
            for offset in [Vec3::ZERO, size * Vec3::X, 0.3 * size * Vec3::ONE, 1e-30 * Vec3::ONE, size * Vec3::NEG_Z] {
                interrogate(&all, centre + offset);
            }
            assert!(interrogate(&all, centre + 10.0 * size * Vec3::ONE) > 50);
        }
    }
}

#[test]
fn powers_from_1e_minus_30_to_1e30() {
    let all: Vec<Emitter> = [1e-30, 1.0, 1e30]
        .into_iter()
        .enumerate()
        .flat_map(|(index, strength)| {
            let shapes = every_shape(3.0 * index as f32 * Vec3::X, 0.5);
            shapes.into_iter().map(move |emitter| of_strength(emitter, strength))
        })
        .collect();
    let all = lights(all);
    for position in [Vec3::new(1.0, 0.3, 2.0), Vec3::new(6.0, 0.0, -1.0), Vec3::ZERO] {
        assert!(interrogate(&all, position) > 50);
    }
    for strength in [1e-30, 1e30] {
        let dim = lights(every_shape(Vec3::ZERO, 0.5).into_iter().map(|e| of_strength(e, strength)).collect());
        assert!(interrogate(&dim, Vec3::new(0.2, 0.1, -2.0)) > 50);
    }
}

#[test]
fn ten_thousand_lights_in_one_place() {
    let (count, centre) = (10_000, Vec3::new(0.1, 0.2, 0.3));
    let all = lights(vec![source(EmitterShape::Sphere { centre, radius: 0.1 }, false); count]);
    for position in [Vec3::ZERO, centre, centre + 0.05 * Vec3::X] {
        let ctx = LightContext { position, normal: None };
        let sum: f64 = (0..count as u32).map(|index| all.chance(index, &ctx)).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{sum}");
        interrogate(&all, position);
    }
    let ctx = LightContext { position: Vec3::ZERO, normal: None };
    assert!((all.chance(77, &ctx) * count as f64 - 1.0).abs() < 0.7, "equal sources have chances of one size");
}

#[test]
fn lights_without_power_are_never_chosen() {
    let mut all = every_shape(Vec3::ZERO, 0.5);
    all.extend(every_shape(Vec3::X, 0.5).into_iter().map(|emitter| of_strength(emitter, 0.0)));
    let count = all.len() as u32;
    let all = lights(all);
    let ctx = LightContext { position: Vec3::new(0.3, 0.2, 3.0), normal: None };
    for index in count / 2..count {
        assert_eq!(all.chance(index, &ctx), 0.0);
        assert_eq!(all.pdf(index, &ctx, Vec3::NEG_Z, 3.0), 0.0);
    }
}

/// Suns from a point to half the sky, above, on and below the horizon.
#[test]
fn suns_at_the_horizon() {
    for diameter in [0.0, 1e-7, 2.1e-5, 0.0093, 3.0, std::f32::consts::PI] {
        let sun = Lights::new(Parts { distant: vec![disc(diameter), disc(0.0)], ..Parts::default() });
        assert!(interrogate(&sun, Vec3::ZERO) > 50, "{diameter}");
    }
}

/// The end of a shadow ray lies before a flat source, on the receiver's side and by its own error at most, however far
/// away the receiver is.
#[test]
fn shadow_rays_end_before_a_far_source() {
    let mut random = Random::new(5);
    for reach in [1.0_f32, 1e2, 1e4, 1e6] {
        for _ in 0..300 {
            let normal = random.direction();
            let u = normal.any_orthonormal_vector();
            let edges = [u, normal.cross(u)];
            let rectangle = EmitterShape::Rectangle { corner: Vec3::ZERO, edges };
            let triangle = EmitterShape::Triangle { vertices: [Vec3::ZERO, edges[0], edges[1]] };
            for shape in [rectangle, triangle] {
                let emitter = Emitter { normal, error: Vec3::splat(2e-6), ..source(shape, true) };
                let receiver = reach * random.direction();
                let Some(sample) = emitter.sample(receiver, random.square()) else { continue };
                let side = if normal.dot(receiver) > 0.0 { 1.0 } else { -1.0 };
                let height = side * normal.as_dvec3().dot(target(sample.end).as_dvec3());
                let error = f64::from(emitter.error.dot(normal.abs()));
                assert!(height > 0.5 * error && height < 1.5 * error, "{height} of {error} from {reach} m");
            }
        }
    }
}

/// A rectangle far from the world's origin keeps its size, though f32 has steps there as long as its sides.
#[test]
fn a_far_rectangle_keeps_its_size() {
    let place = Vec3::new(3e4, -2e4, 1e4);
    let lamp = RectLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        world_from_local: Affine3A::from_translation(place),
        width: 2e-3,
        height: 3e-3,
        radiance: Vec3::ONE,
        range: None,
    };
    let scene = Scene { lights: vec![Light::Rect(lamp)], ..Scene::default() };
    let distance = 8.0;
    let aim = Tracer::new(&scene).aim(place - distance * Vec3::Z, Vec3::Z, 0.5, Vec2::splat(0.5)).unwrap();
    let solid_angle = f64::from(aim.pdf.unwrap()).recip();
    let expected = 6e-6 / f64::from(distance * distance);
    assert!((solid_angle / expected - 1.0).abs() < 0.02, "{solid_angle:e}, not {expected:e}");
}

//! Light sampling: points on sources follow the density that is claimed for them, on the sphere of directions and on
//! the source itself; the two ways to ask for a density agree; and planted faults are rejected.

mod hard;
mod sky;
mod sphere;
mod tree;

use super::lights::Parts;
use super::seen::Seen;
use super::{Emitter, EmitterShape, End, LightContext, LightSample, Lights, MetSource, SourceIndex, Way};
use crate::math::testing::{ChiSquared, Domain, Random, Rejection};
use glam::{Vec2, Vec3};
use std::cell::RefCell;

/// Receivers for the shapes below: in front and far, beside, near, nearly in the plane, behind.
const RECEIVERS: [Vec3; 5] = [
    Vec3::new(0.3, 0.2, 1.5),
    Vec3::new(2.5, -0.4, 0.8),
    Vec3::new(0.5, 0.25, 0.05),
    Vec3::new(1.3, 0.2, 0.02),
    Vec3::new(0.1, 0.9, -1.0),
];

fn source(shape: EmitterShape, double_sided: bool) -> Emitter {
    Emitter {
        shape,
        normal: Vec3::Z,
        strength: Vec3::ONE,
        mean_strength: Vec3::ONE,
        double_sided,
        inverse_range: 0.0,
        cone: None,
        error: Vec3::ZERO,
    }
}

/// Sources all of which block nothing.
fn lights(emitters: Vec<Emitter>) -> Lights {
    let free = (0..emitters.len() as u32).collect();
    Lights::new(Parts { emitters, free, ..Parts::default() })
}

fn free(position: Vec3) -> LightContext {
    LightContext { position, normal: None }
}

/// A way that begins at the receiver.
fn along(origin: Vec3, direction: Vec3, end: f32) -> Way {
    Way { origin, direction, end, passed: 0.0 }
}

fn pdf(emitter: &Emitter, receiver: Vec3, wi: Vec3, distance: f64) -> f64 {
    emitter.solid_angle(receiver, wi, distance as f32).map_or(0.0, f64::recip)
}

fn target(end: End) -> Vec3 {
    let End::At(target) = end else { panic!("{end:?} is nowhere") };
    target
}

fn rectangle() -> Emitter {
    source(EmitterShape::Rectangle { corner: Vec3::ZERO, edges: [Vec3::X, 0.5 * Vec3::Y] }, true)
}

fn triangle() -> Emitter {
    source(EmitterShape::Triangle { vertices: [Vec3::ZERO, Vec3::X, Vec3::new(0.4, 0.9, 0.0)] }, true)
}

/// Distance along the unit `wi` at which the source lies there; `None` beside it.
fn met(emitter: &Emitter, receiver: Vec3, wi: Vec3) -> Option<f64> {
    let (corner, [u, v]) = axes(emitter);
    let (receiver, wi) = (receiver.as_dvec3(), wi.as_dvec3());
    let normal = u.as_dvec3().cross(v.as_dvec3());
    let t = normal.dot(corner.as_dvec3() - receiver) / normal.dot(wi);
    let [s, t_on] = on_source(emitter, (receiver + t * wi).as_vec3());
    let is_inside = match emitter.shape {
        EmitterShape::Rectangle { .. } => s <= 1.0 && t_on <= 1.0,
        _ => s + t_on <= 1.0,
    };
    (t.is_finite() && t > 0.0 && s >= 0.0 && t_on >= 0.0 && is_inside).then_some(t)
}

fn axes(emitter: &Emitter) -> (Vec3, [Vec3; 2]) {
    match emitter.shape {
        EmitterShape::Rectangle { corner, edges } => (corner, edges),
        EmitterShape::Triangle { vertices: [a, b, c] } => (a, [b - a, c - a]),
        EmitterShape::Sphere { .. } | EmitterShape::Point { .. } => unreachable!("{emitter:?} is not flat"),
    }
}

/// Shares of the two edges that lead to a point of the source's plane.
fn on_source(emitter: &Emitter, point: Vec3) -> [f64; 2] {
    let (corner, [u, v]) = axes(emitter);
    let (u, v, offset) = (u.as_dvec3(), v.as_dvec3(), (point - corner).as_dvec3());
    let normal = u.cross(v);
    let scale = normal.length_squared().recip();
    [normal.dot(offset.cross(v)) * scale, normal.dot(u.cross(offset)) * scale]
}

/// χ² on the sphere of directions, with the density multiplied by `fault(wi)`.
fn on_sphere(emitter: &Emitter, receiver: Vec3, fault: impl Fn(Vec3) -> f64) -> Result<f64, Rejection> {
    // The rim of a source cuts its cells; their integrals are good to about a thousandth, and so many samples see less.
    let test = ChiSquared { cells: [101, 51], samples: 20_000, ..ChiSquared::over(Domain::Sphere) };
    let sample = |u| emitter.sample(receiver, u).expect("both sides shine").wi;
    // A sample on the very rim may lie beside the shape by a rounding.
    let centre = (emitter.centre() - receiver).normalize();
    let density = |wi: Vec3| {
        let inside = (wi + 1e-6 * (centre - wi)).normalize();
        met(emitter, receiver, inside).map_or(0.0, |t| pdf(emitter, receiver, wi, t) * fault(wi))
    };
    test.run(sample, density)
}

/// χ² on the source, over the unit square of its edges: for those too small or too near to be seen on the sphere.
fn on_plane(emitter: &Emitter, receiver: Vec3, fault: impl Fn(Vec3) -> f64) -> Result<f64, Rejection> {
    let test = ChiSquared { cells: [31, 31], ..ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE)) };
    let (corner, [u, v]) = axes(emitter);
    let is_triangle = matches!(emitter.shape, EmitterShape::Triangle { .. });
    let sample = |s| {
        let [s, t] = on_source(emitter, target(emitter.sample(receiver, s).expect("both sides shine").end));
        Vec3::new(s as f32, t as f32, 0.0) * (1.0 - 1e-6)
    };
    let density = |p: Vec3| {
        if is_triangle && p.x + p.y > 1.0 {
            return 0.0;
        }
        let offset = corner + p.x * u + p.y * v - receiver;
        let wi = offset.normalize();
        let area = f64::from(u.cross(v).length());
        let per_area = pdf(emitter, receiver, wi, f64::from(offset.length())) * f64::from(emitter.normal.dot(wi).abs())
            / f64::from(offset.length_squared());
        per_area * area * fault(wi)
    };
    test.run(sample, density)
}

#[test]
fn samples_follow_their_density_on_the_sphere() {
    for (name, emitter) in [("rectangle", rectangle()), ("triangle", triangle())] {
        // From so low that the source is a line, only the other test can tell.
        for receiver in RECEIVERS.into_iter().filter(|receiver| receiver.z.abs() > 0.04) {
            let p = on_sphere(&emitter, receiver, |_| 1.0);
            assert!(p.is_ok(), "{name} from {receiver}: {p:?}");
        }
    }
}

#[test]
fn samples_follow_their_density_on_the_source() {
    let far = Vec3::new(3e7, 2e7, 5e7);
    for (name, emitter) in [("rectangle", rectangle()), ("triangle", triangle())] {
        for receiver in RECEIVERS {
            let p = on_plane(&emitter, receiver, |_| 1.0);
            assert!(p.is_ok(), "{name} from {receiver}: {p:?}");
        }
        // So far away that it is sampled by area.
        assert!(matches!(Seen::new(&emitter.shape, far), Seen::ByArea));
        let mut random = Random::new(3);
        let mut hits = [0_u32; 4];
        for _ in 0..40_000 {
            let sample = emitter.sample(far, random.square()).expect("both sides shine");
            let expected =
                f64::from((far - emitter.centre()).length_squared()) / (emitter.area() * f64::from(sample.wi.z.abs()));
            let solid_angle = sample.solid_angle.expect("it has a size");
            assert!((expected * solid_angle - 1.0).abs() < 1e-5, "{solid_angle}");
            let [s, t] = on_source(&emitter, emitter.depart([random.unit(), random.unit(), 0.5, 0.5]).0);
            hits[usize::from(s > 0.5) + 2 * usize::from(t > 0.5)] += 1;
        }
        // Of a triangle, one half of each side is at the corner: three quarters of the area, and none beyond both.
        let expected = if name == "rectangle" { [10_000; 4] } else { [20_000, 10_000, 10_000, 0] };
        for (hits, expected) in hits.into_iter().zip(expected) {
            assert!(hits.abs_diff(expected) < 500, "{name}: {hits} of {expected}");
        }
    }
}

/// Planted faults: a density 5 % too large, one by solid angle where samples are by area, one that forgets a cosine.
#[test]
fn wrong_densities_are_rejected() {
    for emitter in [rectangle(), triangle()] {
        for receiver in [Vec3::new(0.3, 0.2, 0.6), RECEIVERS[1]] {
            let too_large = on_sphere(&emitter, receiver, |_| 1.05);
            assert!(matches!(too_large, Err(Rejection::Total(_))), "{too_large:?}");
            let too_large = on_plane(&emitter, receiver, |_| 1.05);
            assert!(matches!(too_large, Err(Rejection::Total(_))), "{too_large:?}");
            assert!(on_sphere(&emitter, receiver, |wi| f64::from(wi.z.abs())).is_err());
            // The same total, but the cosine's shape.
            let mean = mean_cosine(&emitter, receiver);
            let tilted = on_plane(&emitter, receiver, |wi| f64::from(wi.z.abs()) / mean);
            assert!(tilted.is_err(), "{tilted:?}");
        }
    }
}

/// Mean of |cos| at the source over the directions in which it is sampled.
fn mean_cosine(emitter: &Emitter, receiver: Vec3) -> f64 {
    let side = 512;
    let points = (0..side * side).map(|i| Vec2::new((i % side) as f32 + 0.5, (i / side) as f32 + 0.5) / side as f32);
    let cosine = |u| f64::from(emitter.sample(receiver, u).expect("both sides shine").wi.z.abs());
    points.map(cosine).sum::<f64>() / f64::from(side * side)
}

/// The density of a sample is the one that is found for its direction, by shape and among several.
#[test]
fn both_ways_to_ask_for_a_density_agree() {
    let lights = several();
    let mut random = Random::new(5);
    let mut count = 0;
    for receiver in RECEIVERS.into_iter().chain([Vec3::new(4e7, 3e7, 6e7)]) {
        for _ in 0..2000 {
            let ctx = LightContext { position: receiver, normal: Some(random.direction()) };
            let Some(sample) = lights.sample(&ctx, random.square(), random.unit()) else {
                continue;
            };
            let LightSample { wi, source: SourceIndex::Emitter(source), pdf: Some(pdf), .. } = sample else {
                panic!("{sample:?} is not on an emitter with a size");
            };
            let found = lights.pdf(source, &ctx, wi, sample.distance);
            // Near the plane of a source the cosine is what f32 leaves of it.
            assert!((found / pdf - 1.0).abs() < 1e-4, "{receiver}: {sample:?} but {found}");
            assert!((wi.length() - 1.0).abs() < 1e-6);
            let radiance = lights.get(source).radiance_towards(receiver, wi);
            assert!((sample.value * pdf / radiance - 1.0).abs().max_element() < 1e-5, "{sample:?}");
            count += 1;
        }
    }
    assert!(count > 8_000, "{count}");
}

/// A lamp, a small bright triangle, a lamp that shines away from most receivers, and a black one.
fn several() -> Lights {
    let lamp = source(EmitterShape::Rectangle { corner: Vec3::new(-2.0, 1.0, 3.0), edges: [Vec3::X, Vec3::Y] }, true);
    let small = Vec3::new(1.0, -1.0, 2.5);
    let small = EmitterShape::Triangle { vertices: [small, small + 0.7 * Vec3::X, small + 0.6 * Vec3::Y] };
    let strength = Vec3::new(9.0, 5.0, 2.0);
    let bright = Emitter { strength, mean_strength: strength, ..source(small, true) };
    let black = Emitter { strength: Vec3::ZERO, mean_strength: Vec3::ZERO, ..rectangle() };
    lights(vec![rectangle(), lamp, bright, black, triangle()])
}

/// χ² of the choice of source and the point on it together; `weight` is what the density is multiplied by, per
/// source.
fn among_several(receiver: Vec3, weight: impl Fn(u32) -> f64) -> Result<f64, Rejection> {
    let lights = several();
    let ctx = free(receiver);
    let choices = RefCell::new(Random::new(9));
    // The rim of a source cuts its cells; their integrals are good to about a thousandth, and so many samples see less.
    let test = ChiSquared { cells: [101, 51], samples: 20_000, ..ChiSquared::over(Domain::Sphere) };
    let sample = |u| lights.sample(&ctx, u, choices.borrow_mut().unit()).expect("all shine").wi;
    let density = |wi: Vec3| {
        let of = |index: u32| {
            let emitter = lights.get(index);
            let centre = (emitter.centre() - receiver).normalize();
            let inside = (wi + 1e-6 * (centre - wi)).normalize();
            let distance = met(emitter, receiver, inside)? as f32;
            Some(f64::from(lights.pdf(index, &ctx, wi, distance)) * weight(index))
        };
        (0..lights.emitter_count() as u32).filter_map(of).sum()
    };
    test.run(sample, density)
}

#[test]
fn the_choice_among_sources_follows_its_density() {
    for receiver in [RECEIVERS[0], RECEIVERS[1], RECEIVERS[4]] {
        let p = among_several(receiver, |_| 1.0);
        assert!(p.is_ok(), "{receiver}: {p:?}");
        // Planted: two sources take a little from each other, so that the total stays.
        let (lights, ctx) = (several(), free(receiver));
        let probability = |index| lights.chance(index, &ctx);
        let shifted = among_several(receiver, |index| match index {
            1 => 1.0 + 0.04 / probability(1),
            2 => 1.0 - 0.04 / probability(2),
            _ => 1.0,
        });
        assert!(matches!(shifted, Err(Rejection::Counts(_))), "{shifted:?}");
        let uniform = among_several(receiver, |index| 0.25 / probability(index).max(1e-9));
        assert!(matches!(uniform, Err(Rejection::Counts(_))), "{uniform:?}");
    }
    assert_eq!(several().chance(3, &free(RECEIVERS[0])), 0.0);
}

#[test]
fn nothing_to_aim_at() {
    assert!(Lights::default().is_empty());
    let black = Emitter { strength: Vec3::ZERO, mean_strength: Vec3::ZERO, ..rectangle() };
    let black = lights(vec![black]);
    assert!(black.is_empty() && black.sample(&free(RECEIVERS[0]), Vec2::splat(0.5), 0.5).is_none());
}

#[test]
fn one_side_shines_unless_both_do() {
    let one_sided = Emitter { double_sided: false, ..rectangle() };
    let mut random = Random::new(6);
    for receiver in RECEIVERS {
        for _ in 0..100 {
            let u = random.square();
            assert_eq!(one_sided.sample(receiver, u).is_some(), receiver.z > 0.0);
            assert!(rectangle().sample(receiver, u).is_some());
        }
    }
    assert_eq!(one_sided.radiance_towards(Vec3::Z, Vec3::NEG_Z), Vec3::ONE);
    assert_eq!(one_sided.radiance_towards(Vec3::NEG_Z, Vec3::Z), Vec3::ZERO);
}

/// Bevy's window (1 − (d/range)⁴)², by the distance from the centre.
#[test]
fn the_range_window() {
    let lamp = Emitter { inverse_range: 0.5, ..rectangle() };
    let centre = Vec3::new(0.5, 0.25, 0.0);
    for (distance, expected) in [(0.0, 1.0), (1.0, (15.0 / 16.0_f32).powi(2)), (2.0, 0.0), (3.0, 0.0)] {
        let found = lamp.radiance_towards(centre + distance * Vec3::Z, Vec3::NEG_Z);
        assert!((found - Vec3::splat(expected)).length() < 1e-6, "{distance}: {found}");
    }
    assert!(lamp.sample(centre + 2.0 * Vec3::Z, Vec2::splat(0.5)).is_none());
}

/// A ray meets a source that blocks nothing where the source's points are.
#[test]
fn rays_meet_free_sources_where_they_are() {
    let mut random = Random::new(8);
    let (mut hits, count) = (0, 20_000);
    for _ in 0..count {
        let origin = 2.0 * random.direction();
        let direction = (Vec3::new(0.5, 0.25, 0.0) + random.direction() - origin).normalize();
        let found = rectangle().intersect(origin, direction);
        assert_eq!(found.is_some(), met(&rectangle(), origin, direction).is_some(), "{origin} {direction}");
        hits += u32::from(found.is_some());
    }
    assert!((count / 50..count / 2).contains(&hits), "{hits}");
    let passed = |end| -> Vec<MetSource> {
        let ctx = free(Vec3::new(0.5, 0.25, 2.0));
        several().passed(&ctx, along(ctx.position, Vec3::NEG_Z, end)).collect()
    };
    assert_eq!((passed(9.0).len(), passed(1.0).len()), (1, 0));
    assert_eq!(passed(9.0)[0].radiance, Vec3::ONE);
}

/// Weights of vertices at a sampled point are those that lead there.
#[test]
fn weights_lead_to_the_point() {
    let mut random = Random::new(12);
    for emitter in [rectangle(), triangle()] {
        let (corner, [u, v]) = axes(&emitter);
        for _ in 0..100 {
            let point = target(emitter.sample(RECEIVERS[0], random.square()).expect("both sides shine").end);
            let [s, t] = emitter.weights_of(point).expect("it is flat");
            assert!((corner + s * u + t * v - point).length() < 1e-6);
        }
    }
    assert_eq!(source(EmitterShape::Point { centre: Vec3::ZERO }, false).weights_of(Vec3::X), None);
}

//! The estimator as a whole, in furnaces, whose answer is known: a closed room of one albedo ρ whose walls all glow
//! with Le shows Le / (1 − ρ) in every direction. And that the check which says so would notice if it did not.

use super::walk::{ROULETTE_THROUGHPUT, survival_probability};
use super::{PathStart, Tally};
use crate::artefact::StableId;
use crate::math::testing::{Random, mean_and_error, mean_within};
use crate::math::{Frame, combine, square_to_cosine_hemisphere, square_to_triangle};
use crate::scene::{DirectionalLight, Interior, Light, Material, PointLight, Scattering, Standard};
use crate::trace::light::{End, LightContext};
use crate::trace::mis::power_heuristic;
use crate::trace::sampler::{Dimensions, Sampler};
use crate::trace::testing::Shape;
use crate::trace::{Estimator, Sobol, Tracer, Transport};
use glam::{Affine3A, Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Replicates of each mean.
const REPLICATES: u64 = 16;

/// Paths of each replicate, enough for a tenth of a per cent at albedo 0.5.
const PATHS: u64 = 32_768;

/// How far a furnace may be off, relative: the project's promise.
const TOLERANCE: f64 = 1e-3;

fn furnace(albedo: f32) -> (Tracer, f64) {
    let material = Material { emitted_radiance: Vec3::ONE, ..Material::diffuse("wall", Vec3::splat(albedo)) };
    let truth = 1.0 / (1.0 - f64::from(albedo));
    (Tracer::new(&Shape::cube().scene(material, Affine3A::IDENTITY)), truth)
}

/// Mean and standard error of `value`, one path's E/π from a start anywhere on the walls.
fn measure(tracer: &Tracer, paths: u64, value: impl Fn(&PathStart, &Sobol) -> Vec3) -> (f64, f64) {
    let replicate = |replicate| {
        let path = |index| {
            let sampler = Sobol::new(combine(77, replicate), index);
            let [u, v, choice, _] = sampler.draw(Dimensions::Start);
            let weights = square_to_triangle(Vec2::new(u, v));
            let triangle = (choice * tracer.triangle_count() as f32) as u32;
            let start = tracer.start_on_triangle(triangle, weights.to_array(), tracer.normal(triangle));
            f64::from(value(&start, &sampler).y)
        };
        (0..paths).map(path).sum::<f64>() / paths as f64
    };
    mean_and_error(&(0..REPLICATES).map(replicate).collect::<Vec<f64>>())
}

#[test]
fn the_furnace() {
    let cases = [(0.0, Estimator::Bsdf, 4096), (0.5, Estimator::Mis, PATHS), (0.9, Estimator::Bsdf, 4 * PATHS)];
    for (albedo, estimator, paths) in cases {
        let (tracer, truth) = furnace(albedo);
        let transport = Transport { estimator, ..Transport::default() };
        let (mean, error) = measure(&tracer, paths, |start, sampler| {
            tracer.diffuse_radiance(start, sampler, &transport, &mut Tally::default())
        });
        let found = mean_within(mean, error, truth, TOLERANCE * truth);
        assert_eq!(found, Ok(()), "ρ = {albedo}, {estimator:?}");
    }
}

/// What may be wrong with a path tracer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// Roulette divides by a chance of survival above 1.
    UnclampedRoulette,
    /// The path is cut where it still carries a hundredth.
    DroppedBounces,
    /// Light samples forget the cosine at the receiver.
    MissingCosine,
    /// The density of light samples is 5 % too large: in their estimate alone, not in the weights.
    LightPdf,
    /// Both strategies count in full.
    NoWeights,
    /// Survivors of roulette do not stand in for the rest.
    RouletteWithoutDivision,
}

/// The estimator written a second time, short and slow, with a fault.
fn second_opinion(tracer: &Tracer, start: &PathStart, sampler: &Sobol, fault: Fault) -> Vec3 {
    let (mut vertex, mut throughput, mut radiance, mut albedo) = (*start, Vec3::ONE, Vec3::ZERO, Vec3::ONE);
    for number in 0.. {
        let frame = Frame::new(vertex.normal);
        let weigh = |own: f32, other: f32| if fault == Fault::NoWeights { 1.0 } else { power_heuristic(own, other) };
        let [u, v, choice, _] = sampler.draw(Dimensions::Light { vertex: number });
        let ctx = LightContext { position: vertex.position, normal: Some(vertex.normal) };
        if let Some(sample) = tracer.lights.sample(&ctx, Vec2::new(u, v), choice) {
            let (cosine, pdf) = (vertex.normal.dot(sample.wi), sample.pdf.expect("the walls have a size"));
            let End::At(target) = sample.end else { unreachable!("the walls are somewhere") };
            if cosine > 0.0 && !tracer.accel.is_blocked(vertex.origin, target) {
                let value = if fault == Fault::LightPdf { sample.value / 1.05 } else { sample.value };
                let scattered = albedo * FRAC_1_PI * if fault == Fault::MissingCosine { 1.0 } else { cosine };
                radiance += throughput * scattered * value * weigh(pdf, cosine * FRAC_1_PI);
            }
        }
        let [u, v, u_survive, _] = sampler.draw(Dimensions::Scatter { vertex: number });
        let local = square_to_cosine_hemisphere(Vec2::new(u, v));
        let wi = frame.world_from_local(local);
        throughput *= albedo;
        let Some(hit) = tracer.accel.closest(vertex.origin, wi, f32::INFINITY) else {
            break;
        };
        if tracer.normal(hit.triangle).dot(wi) < 0.0 {
            let emitter = tracer.emitter_of[hit.triangle as usize];
            let pdf = tracer.lights.pdf(emitter, &ctx, wi, hit.t);
            radiance += throughput * tracer.lights.get(emitter).strength * weigh(local.z * FRAC_1_PI, pdf);
        }
        albedo = tracer.diffuse_albedo(hit.triangle, hit.barycentric);
        let survival = match fault {
            Fault::UnclampedRoulette => (throughput * albedo).max_element() / ROULETTE_THROUGHPUT,
            _ => survival_probability((throughput * albedo).max_element()),
        };
        if u_survive >= survival || fault == Fault::DroppedBounces && number >= 5 {
            break;
        }
        if fault != Fault::RouletteWithoutDivision {
            throughput /= survival;
        }
        vertex = tracer.start_on_triangle(hit.triangle, hit.barycentric, tracer.normal(hit.triangle));
    }
    radiance
}

/// The check passes what is right, and rejects each planted fault by what it does to the mean, not by noise.
#[test]
fn planted_faults_are_rejected() {
    // So white that the first bounces are above the throughput at which roulette begins.
    let (tracer, truth) = furnace(0.75);
    let verdict = |fault, paths| {
        let (mean, error) = measure(&tracer, paths, |start, sampler| second_opinion(&tracer, start, sampler, fault));
        let bias = (mean - truth).abs() / error;
        (mean_within(mean, error, truth, TOLERANCE * truth), bias)
    };
    assert_eq!(verdict(Fault::None, PATHS).0, Ok(()));
    for fault in [
        Fault::UnclampedRoulette,
        Fault::DroppedBounces,
        Fault::MissingCosine,
        Fault::LightPdf,
        Fault::NoWeights,
        Fault::RouletteWithoutDivision,
    ] {
        let (found, bias) = verdict(fault, 4096);
        assert!(found.is_err() && bias > 5.0, "{fault:?}: {found:?}, {bias} standard errors");
    }
}

/// The second opinion is the same estimator: path by path, but for rounding.
#[test]
fn the_second_opinion_is_the_estimator() {
    let (tracer, _) = furnace(0.5);
    for index in 0..500 {
        let sampler = Sobol::new(5, index);
        let [u, v, ..] = sampler.draw(Dimensions::Start);
        let weights = [0.5 * u, 0.5 * v];
        let start = tracer.start_on_triangle((index % 12) as u32, weights, tracer.normal((index % 12) as u32));
        let one = tracer.diffuse_radiance(&start, &sampler, &Transport::default(), &mut Tally::default()).y;
        let other = second_opinion(&tracer, &start, &sampler, Fault::None).y;
        assert!((one - other).abs() < 1e-4 * one, "{one} {other}");
    }
}

/// What survives roulette, divided by the chance, is on average what went in; and the chance is one.
#[test]
fn roulette_loses_nothing() {
    let mut random = Random::new(1);
    for step in 1..200 {
        let throughput = Vec3::new(0.3, 1.0, 0.7) * 0.02 * step as f32;
        let survival = survival_probability(throughput.max_element());
        assert!(survival > 0.0 && survival <= 1.0, "{throughput}: {survival}");
        // One number in each of a thousand equal intervals.
        let survivor = |index| if (index as f32 + random.unit()) / 1000.0 < survival { 1.0 / survival } else { 0.0 };
        let mean = (0..1000).map(survivor).sum::<f32>() / 1000.0;
        assert!((mean - 1.0).abs() <= 0.0011 / survival, "{throughput}: {mean}");
    }
    assert_eq!(survival_probability(0.0), 0.0);
    assert_eq!(survival_probability(1e9), 1.0);
    let dim = survival_probability(0.01);
    assert!((survival_probability(0.02) - 2.0 * dim).abs() < 1e-6);
}

/// Of two plates in reach of a meter, the one that it lies on is the nearest, however narrow the gap.
#[test]
fn a_meter_in_a_narrow_gap_lies_on_its_own_plate() {
    let plate = |height: f32| {
        let corners = [Vec3::new(-1.0, height, -1.0), Vec3::new(-1.0, height, 1.0), Vec3::new(1.0, height, 1.0)];
        Shape { positions: corners.to_vec(), triangles: vec![[0, 1, 2]] }
    };
    for gap in [2e-5, 1e-5, 1e-6] {
        let (low, high) = (plate(0.0), plate(gap));
        let both = Shape { positions: [low.positions, high.positions].concat(), triangles: vec![[0, 1, 2], [3, 4, 5]] };
        let tracer = both.tracer(Affine3A::IDENTITY);
        for (off, plate) in [(0.0, 0.0), (0.1 * gap, 0.0), (-1e-7, 0.0), (0.9 * gap, gap), (gap, gap)] {
            for side in [1.0, -1.0] {
                let start = tracer.start_at(Vec3::new(-0.5, off, 0.3), side * Vec3::Y);
                let found = start.origin().y;
                assert!((found - plate).abs() < 0.05 * gap, "{off} of {gap}: on {found}");
            }
        }
    }
}

/// Between walls that absorb nothing a path would never end: it is cut, and says by which material.
#[test]
fn a_path_that_nothing_ends_is_cut_and_counted() {
    let tracer = Shape::cube().tracer(Affine3A::IDENTITY);
    let start = tracer.start_on_triangle(0, [0.3, 0.4], tracer.normal(0));
    let mut tally = Tally::default();
    let value = tracer.diffuse_radiance(&start, &Sobol::new(1, 0), &Transport::default(), &mut tally);
    assert_eq!((value, tally.endless, tally.kept_by), (Vec3::ZERO, 1, Some(0)));
    assert_eq!(tally.rays, u64::from(super::MAX_VERTICES));
    let capped = Transport { max_bounces: Some(100), ..Transport::default() };
    let mut tally = Tally::default();
    tracer.diffuse_radiance(&start, &Sobol::new(1, 0), &capped, &mut tally);
    assert_eq!((tally.endless, tally.rays), (0, 101));
}

/// A lamp's light in a solid block of glass may go round for ever, but in no way that a receiver could find.
#[test]
fn light_that_total_reflection_keeps_is_no_fault() {
    let interior = Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: f32::INFINITY };
    let glass = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, interior, ..Standard::default() };
    let material = Material::scattering("glass", Vec3::ONE, Scattering::Standard(Box::new(glass)));
    // The cube faces inwards: mirrored, outwards.
    let mut scene = Shape::cube().moved(|v| Vec3::new(1.0 - v.x, v.y, v.z)).scene(material, Affine3A::IDENTITY);
    let (id, name) = (StableId::new("lamp"), "lamp".into());
    let position = Vec3::new(0.51, 0.49, 0.52);
    let lamp = PointLight { id, name, position, intensity: Vec3::ONE, radius: 0.2, range: None };
    scene.lights.push(Light::Point(lamp));
    let tracer = Tracer::new(&scene);
    let mut endless = 0;
    for index in 0..64 {
        let sampler = Sobol::new(9, index);
        let mut tally = Tally::default();
        let way = Vec3::new(1.0, 0.9, 0.8 + 0.003 * index as f32).normalize();
        tracer.radiance_along(position, way, &sampler, &Transport::default(), &mut tally);
        assert!(!tally.was_spread);
        endless += tally.endless;
        let mut tally = Tally::default();
        tracer.follow_from_source(&sampler, &Transport::default(), &mut tally);
        assert_eq!(tally.kept_by, None);
    }
    assert!(endless > 16, "{endless}");
}

/// A meter in the very plane of its floor lies on it, however it is tilted; and so does one in a crack between tiles.
#[test]
fn a_meter_in_a_plane_or_in_a_crack_lies_on_the_floor() {
    let tile = |[low, high]: [f32; 2]| {
        [Vec3::new(low, 0.0, -50.0), Vec3::new(low, 0.0, 50.0), Vec3::new(high, 0.0, 50.0), Vec3::new(high, 0.0, -50.0)]
    };
    let crack = 1.0_f32.next_up();
    let positions = [tile([-50.0, 1.0]), tile([crack.next_up(), 50.0])].concat();
    let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let tracer = Shape { positions, triangles }.tracer(Affine3A::IDENTITY);
    for place in [Vec3::new(1.0, 0.0, 2.0), Vec3::new(crack, 0.0, 2.0), Vec3::new(crack, 0.0, 0.3)] {
        for facing in [Vec3::Y, Vec3::new(1.0, 0.3, 0.0), Vec3::new(-0.2, 0.1, 1.0)] {
            let start = tracer.start_at(place, facing.normalize());
            assert_eq!(start.geometric_normal, Vec3::Y, "{place} {facing}");
        }
    }
}

/// A start that lies in a body learns so at the first surface that it meets from behind, and not at one from before.
#[test]
fn a_path_that_starts_in_a_body_is_dimmed_from_its_start() {
    let attenuation = |colour: f32| {
        let interior = Interior::Volume { attenuation_colour: Vec3::splat(colour), attenuation_distance: 1e-3 };
        let glass = Standard {
            specular_transmission: 1.0,
            perceptual_roughness: 0.0,
            ior: 1.0,
            interior,
            ..Standard::default()
        };
        let material = Material::scattering("glass", Vec3::ONE, Scattering::Standard(Box::new(glass)));
        // The cube faces inwards: mirrored, outwards.
        let mut scene = Shape::cube().moved(|v| Vec3::new(1.0 - v.x, v.y, v.z)).scene(material, Affine3A::IDENTITY);
        scene.sky_radiance = Vec3::ONE;
        Tracer::new(&scene)
    };
    let value = |tracer: &Tracer, position: Vec3| {
        let start = PathStart::free(position, Vec3::Y);
        tracer.diffuse_radiance(&start, &Sobol::new(3, 5), &Transport::default(), &mut Tally::default())
    };
    let (clear, dark) = (attenuation(1.0), attenuation(0.5));
    let (inside, above) = (Vec3::splat(0.5), Vec3::new(0.5, 2.0, 0.5));
    assert!((value(&clear, inside) - 1.0).length() < 1e-5, "{}", value(&clear, inside));
    assert_eq!(value(&dark, inside), Vec3::ZERO);
    assert_eq!(value(&dark, above), Vec3::ONE);
}

/// A coarse sphere with smooth normals in the sun. Where the sun grazes it, flat facets that face away from the sun, or
/// stand in their neighbours' shade, are black although the smooth surface is lit: the terminator. Starts that are lifted
/// to the smooth surface see the sun.
#[test]
fn smooth_surfaces_have_no_facets_along_the_edge_of_their_shade() {
    let mut sphere = Shape::icosphere(2);
    sphere.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    let mut scene = sphere.scene(Material::diffuse("black", Vec3::ZERO), Affine3A::IDENTITY);
    scene.lights.push(Light::Directional(DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction: Vec3::NEG_Y,
        illuminance: Vec3::splat(std::f32::consts::PI),
        angular_diameter: 0.0,
    }));
    let tracer = Tracer::new(&scene);
    let transport = Transport::default();
    let (mut lifted, mut flat, mut light) = (0.0, 0.0, 0.0);
    for index in 0..20_000 {
        let sampler = Sobol::new(5, index);
        let [u, v, choice, _] = sampler.draw(Dimensions::Start);
        let weights = square_to_triangle(Vec2::new(u, v)).to_array();
        let triangle = (choice * tracer.triangle_count() as f32) as u32;
        let normals = tracer.vertices(triangle).map(Vec3::normalize);
        let smooth = tracer.start_on_smooth_triangle(triangle, weights, normals);
        let cosine = smooth.normal().y;
        if !(0.01..0.3).contains(&cosine) {
            continue;
        }
        let shown =
            |start: &PathStart| tracer.diffuse_radiance(start, &sampler, &transport, &mut Tally::default()).y - cosine;
        lifted += shown(&smooth).abs();
        flat += shown(&tracer.start_on_triangle(triangle, weights, smooth.normal())).abs();
        light += cosine;
    }
    let [lifted, flat] = [lifted, flat].map(|wrong| wrong / light);
    println!("of the light along the terminator, wrong: {lifted:.3} lifted, {flat:.3} flat");
    assert!(lifted < 1e-3 && flat > 0.03, "{lifted} lifted, {flat} flat");
}

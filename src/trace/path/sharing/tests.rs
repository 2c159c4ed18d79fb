//! Shared paths against the same receivers' own, and what is wrong with a way to share, planted.

use super::{Found, MOST_RECEIVERS, Shared, Whence};
use crate::artefact::StableId;
use crate::math::combine;
use crate::math::testing::{mean_and_error, mean_within};
use crate::scene::{Instance, Light, Material, PointLight};
use crate::trace::path::{PathStart, Tally};
use crate::trace::testing::Shape;
use crate::trace::{Sharing, Sobol, Tracer, Transport};
use glam::{Affine3A, Vec3};

const REPLICATES: u64 = 16;

/// How far apart the means may be, relative.
const TOLERANCE: f64 = 0.025;

/// What may be wrong with a way to share.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The cosine at the receiver.
    NoCosineHere,
    /// The cosine where the light comes from, which differs between receivers.
    NoCosineThere,
    /// The square of the distance.
    NoFalloff,
    /// What hides the place from some.
    NoVisibility,
}

/// A box open at its top under a white sky, a lamp in a corner and a black ball in the middle: what a place shows
/// depends on where it is, and who sees it.
fn yard() -> Tracer {
    let mut open = Shape::cube();
    open.triangles.drain(6..8);
    let mut scene = open.scene(Material::diffuse("wall", Vec3::new(0.3, 0.5, 0.7)), Affine3A::IDENTITY);
    let ball = Shape::icosphere(1).scene(Material::diffuse("ball", Vec3::splat(0.02)), Affine3A::IDENTITY);
    scene.meshes.extend(ball.meshes);
    scene.materials.extend(ball.materials);
    scene.instances.push(Instance {
        id: StableId::new("the ball, after the shape"),
        mesh: 1,
        material: 1,
        world_from_local: Affine3A::from_scale_rotation_translation(
            Vec3::splat(0.3),
            glam::Quat::IDENTITY,
            Vec3::new(0.5, 0.4, 0.5),
        ),
        ..ball.instances[0].clone()
    });
    scene.sky_radiance = Vec3::splat(0.2);
    scene.lights.push(Light::Point(PointLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        position: Vec3::new(0.1, 0.7, 0.15),
        intensity: Vec3::splat(0.5),
        radius: 0.0,
        range: None,
    }));
    Tracer::new(&scene)
}

/// Some near each other, some near an edge, some on other walls.
fn receivers(tracer: &Tracer) -> Vec<PathStart> {
    let on = |triangle: u32, at: [f32; 2]| tracer.start_on_triangle(triangle, at, tracer.normal(triangle));
    let floor = [[0.3, 0.3], [0.35, 0.3], [0.6, 0.2], [0.01, 0.4]].map(|at| on(4, at));
    let walls = [on(0, [0.3, 0.02]), on(0, [0.2, 0.4]), on(2, [0.5, 0.3]), on(7, [0.4, 0.4])];
    floor.into_iter().chain(walls).collect()
}

/// The same written a second time, with a fault.
fn second_opinion(tracer: &Tracer, starts: &[PathStart], own: usize, found: &Found, fault: Fault) -> Vec<Vec3> {
    let mut light = vec![Vec3::ZERO; starts.len()];
    light[own] = found.alone;
    let Some(Shared { whence, radiance }) = found.shared else { return light };
    let density = |number: usize| {
        let start = &starts[number];
        let (wi, geometry, is_blocked) = match whence {
            Whence::Sky(wi) => (wi, 1.0, tracer.accel.is_blocked_towards(start.origin, wi)),
            Whence::Surface { point, normal } => {
                let (wi, distance) = (point - start.origin).normalize_and_length();
                let cosine = if fault == Fault::NoCosineThere { 1.0 } else { normal.dot(-wi) };
                let falloff = if fault == Fault::NoFalloff { 1.0 } else { distance * distance };
                (wi, cosine / falloff, tracer.accel.is_blocked(start.origin, point))
            }
        };
        let is_for = matches!(whence, Whence::Surface { .. }) || start.normal == starts[own].normal;
        let is_seen = number == own || fault == Fault::NoVisibility || !is_blocked;
        let cosine = start.normal.dot(wi);
        let is_before = cosine > 0.0 && geometry > 0.0;
        let cosine = if fault == Fault::NoCosineHere { 1.0 } else { cosine };
        if is_for && is_before && is_seen { cosine * geometry } else { 0.0 }
    };
    let densities: Vec<f32> = (0..starts.len()).map(density).collect();
    let sum: f32 = densities.iter().sum();
    light.iter_mut().zip(densities).for_each(|(light, density)| *light += radiance * density / sum);
    light
}

/// The light of all receivers by one path of each.
fn one_of_each(
    tracer: &Tracer,
    starts: &[PathStart],
    (key, index): (u64, u64),
    mut share: impl FnMut(usize, &Found) -> Vec<Vec3>,
) -> Vec<Vec3> {
    let mut light = vec![Vec3::ZERO; starts.len()];
    for (own, start) in starts.iter().enumerate() {
        let sampler = Sobol::new(combine(key, own as u64), index);
        let found = tracer.find(start, &sampler, &Transport::default(), &mut Tally::default());
        light.iter_mut().zip(share(own, &found)).for_each(|(light, more)| *light += more);
    }
    light
}

/// How far the means of shared paths are from those of the receivers' own, receiver by receiver: relative difference
/// and standard error.
fn differences(tracer: &Tracer, paths: u64, share: impl Fn(&[PathStart], usize, &Found) -> Vec<Vec3>) -> Vec<[f64; 2]> {
    let starts = receivers(tracer);
    let alone = Transport { sharing: Sharing::Alone, ..Transport::default() };
    let mut all = vec![(Vec::new(), Vec::new()); starts.len()];
    for replicate in 0..REPLICATES {
        let (mut shared, mut own) = (vec![0.0_f64; starts.len()], vec![0.0_f64; starts.len()]);
        for index in 0..paths {
            let light =
                one_of_each(tracer, &starts, (combine(3, replicate), index), |own, found| share(&starts, own, found));
            for (number, (light, start)) in light.iter().zip(&starts).enumerate() {
                shared[number] += f64::from(light.y) / paths as f64;
                let sampler = Sobol::new(combine(combine(4, replicate), number as u64), index);
                let light = tracer.diffuse_radiance(start, &sampler, &alone, &mut Tally::default());
                own[number] += f64::from(light.y) / paths as f64;
            }
        }
        for (all, (shared, own)) in all.iter_mut().zip(shared.into_iter().zip(own)) {
            all.0.push(shared);
            all.1.push(own);
        }
    }
    let relative = |(shared, own): &(Vec<f64>, Vec<f64>)| {
        let [(shared, shared_error), (own, own_error)] = [shared, own].map(|values| mean_and_error(values));
        [(shared - own) / own, shared_error.hypot(own_error) / own]
    };
    all.iter().map(relative).collect()
}

fn tracers_own(tracer: &Tracer, starts: &[PathStart], own: usize, found: &Found) -> Vec<Vec3> {
    let mut light = [Vec3::ZERO; MOST_RECEIVERS];
    tracer.share(starts, own, found, &mut light, &mut Tally::default());
    light[..starts.len()].to_vec()
}

#[test]
fn shared_paths_have_the_mean_of_the_receivers_own() {
    let tracer = yard();
    let all = differences(&tracer, 8192, |starts, own, found| tracers_own(&tracer, starts, own, found));
    for (number, [off, error]) in all.into_iter().enumerate() {
        assert_eq!(mean_within(off, error, 0.0, TOLERANCE), Ok(()), "receiver {number}");
    }
}

#[test]
fn planted_faults_are_rejected() {
    let tracer = yard();
    let verdict = |fault, paths| {
        differences(&tracer, paths, |starts, own, found| second_opinion(&tracer, starts, own, found, fault))
    };
    let worst = |all: Vec<[f64; 2]>| all.into_iter().map(|[off, error]| off.abs() / error).fold(0.0, f64::max);
    for fault in [Fault::NoCosineHere, Fault::NoCosineThere, Fault::NoFalloff, Fault::NoVisibility] {
        let all = verdict(fault, 1024);
        let is_rejected = all.iter().any(|&[off, error]| mean_within(off, error, 0.0, TOLERANCE).is_err());
        let worst = worst(all);
        assert!(is_rejected && worst > 8.0, "{fault:?}: {worst} standard errors");
    }
    let without = worst(verdict(Fault::None, 1024));
    assert!(without < 4.5, "{without} standard errors without a fault");
}

/// Path by path, the second opinion is the way that is used; no light is lost or made.
#[test]
fn a_path_s_light_is_dealt_out_whole() {
    let tracer = yard();
    let starts = receivers(&tracer);
    let (mut surfaces, mut skies) = (0, 0);
    for index in 0..500 {
        one_of_each(&tracer, &starts, (9, index), |own, found| {
            let light = tracers_own(&tracer, &starts, own, found);
            for (used, other) in light.iter().zip(second_opinion(&tracer, &starts, own, found, Fault::None)) {
                assert!((*used - other).length() <= 1e-5 * (1.0 + other.length()), "{used} {other}");
            }
            let shared = found.shared.map_or(Vec3::ZERO, |shared| shared.radiance);
            let total: Vec3 = light.iter().sum();
            assert!((total - found.alone - shared).length() <= 1e-5 * (1.0 + total.length()));
            match found.shared.map(|shared| shared.whence) {
                Some(Whence::Surface { .. }) => surfaces += 1,
                Some(Whence::Sky(_)) => skies += 1,
                None => {}
            }
            light
        });
    }
    assert!(surfaces > 1000 && skies > 300, "{surfaces} {skies}");
}

/// What looks different from elsewhere, and what is not to be shared, serves its own receiver.
#[test]
fn some_paths_serve_their_own_receiver_alone() {
    let tracer = yard();
    let start = receivers(&tracer)[0];
    let alone = Transport { sharing: Sharing::Alone, ..Transport::default() };
    for index in 0..200 {
        let sampler = Sobol::new(1, index);
        let [shared, own] = [Transport::default(), alone]
            .map(|transport| tracer.find(&start, &sampler, &transport, &mut Tally::default()));
        let whole = tracer.diffuse_radiance(&start, &sampler, &alone, &mut Tally::default());
        assert!(own.shared.is_none() && own.alone == whole);
        let sum = shared.alone + shared.shared.map_or(Vec3::ZERO, |shared| shared.radiance);
        assert!((sum - whole).length() <= 1e-5 * (1.0 + whole.length()), "{sum} {whole}");
    }
}

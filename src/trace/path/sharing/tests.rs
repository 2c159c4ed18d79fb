//! Shared paths against the same receivers' own, and what is wrong with a way to share, planted.

mod second_opinion;
mod yard;

use super::{Found, MOST_RECEIVERS, Shared, Whence};
use crate::math::combine;
use crate::math::testing::{mean_and_error, mean_within};
use crate::trace::path::{PathStart, Tally};
use crate::trace::{Sharing, Sobol, Tracer, Transport};
use glam::Vec3;
use second_opinion::{Fault, second_opinion};
use yard::{YARDS, Yard, receivers};

const REPLICATES: u64 = 16;

/// How far apart the means may be, relative to that of all receivers.
const TOLERANCE: f64 = 0.01;

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

/// How far the means of shared paths are from those of the receivers' own, receiver by receiver: difference and standard
/// error over the mean of all receivers. Both are of the same paths, so that what is not shared is no noise between them.
fn differences(tracer: &Tracer, paths: u64, share: impl Fn(&[PathStart], usize, &Found) -> Vec<Vec3>) -> Vec<[f64; 2]> {
    let starts = receivers(tracer);
    let alone = Transport { sharing: Sharing::Alone, ..Transport::default() };
    let (mut all, mut light) = (vec![Vec::new(); starts.len()], 0.0);
    for replicate in 0..REPLICATES {
        let (mut shared, mut own) = (vec![0.0_f64; starts.len()], vec![0.0_f64; starts.len()]);
        for index in 0..paths {
            let light =
                one_of_each(tracer, &starts, (combine(3, replicate), index), |own, found| share(&starts, own, found));
            for (number, (light, start)) in light.iter().zip(&starts).enumerate() {
                shared[number] += f64::from(light.y) / paths as f64;
                let sampler = Sobol::new(combine(combine(3, replicate), number as u64), index);
                let light = tracer.diffuse_radiance(start, &sampler, &alone, &mut Tally::default());
                own[number] += f64::from(light.y) / paths as f64;
            }
        }
        for (all, (shared, own)) in all.iter_mut().zip(shared.into_iter().zip(own)) {
            all.push(shared - own);
            light += own / (REPLICATES as usize * starts.len()) as f64;
        }
    }
    let relative = |differences: &Vec<f64>| {
        let (off, error) = mean_and_error(differences);
        [off / light, error / light]
    };
    all.iter().map(relative).collect()
}

fn tracers_own(tracer: &Tracer, starts: &[PathStart], own: usize, found: &Found) -> Vec<Vec3> {
    let mut light = [Vec3::ZERO; MOST_RECEIVERS];
    tracer.share(starts, own, found, &mut light, &mut Tally::default());
    light[..starts.len()].to_vec()
}

fn has_the_mean_of_the_receivers_own(yard: Yard) {
    let tracer = yard.tracer();
    let all = differences(&tracer, 8192, |starts, own, found| tracers_own(&tracer, starts, own, found));
    for (number, [off, error]) in all.into_iter().enumerate() {
        assert_eq!(mean_within(off, error, 0.0, TOLERANCE), Ok(()), "{yard:?}, receiver {number}");
    }
}

/// By yards, that they are measured beside each other.
macro_rules! shared_paths_have_the_mean_of_the_receivers_own {
    ($($name:ident: $yard:expr),*) => {
        mod shared_paths_have_the_mean_of_the_receivers_own {
            use super::*;
            $(#[test]
            fn $name() {
                has_the_mean_of_the_receivers_own($yard);
            })*
        }
    };
}
shared_paths_have_the_mean_of_the_receivers_own! {
    matt: Yard::Matt,
    glossy: Yard::Glossy,
    metallic: Yard::Metallic,
    varnished: Yard::Varnished,
    phong: Yard::Phong,
    smooth: Yard::Smooth,
    mirror: Yard::Mirror,
    veiled: Yard::Veiled,
    clear: Yard::Clear
}

fn rejects(yard: Yard, paths: u64, faults: &[Fault]) {
    let tracer = yard.tracer();
    let verdict =
        |fault| differences(&tracer, paths, |starts, own, found| second_opinion(&tracer, starts, own, found, fault));
    let worst = |all: &[[f64; 2]]| all.iter().map(|[off, error]| off.abs() / error).fold(0.0, f64::max);
    for &fault in faults {
        let all = verdict(fault);
        let is_rejected = all.iter().any(|&[off, error]| mean_within(off, error, 0.0, TOLERANCE).is_err());
        let worst = worst(&all);
        assert!(is_rejected && worst > 8.0, "{yard:?}, {fault:?}: {worst} standard errors");
    }
    let without = worst(&verdict(Fault::None));
    assert!(without < 4.5, "{yard:?}: {without} standard errors without a fault");
}

#[test]
fn planted_faults_are_rejected() {
    rejects(Yard::Matt, 1024, &[Fault::NoCosineHere, Fault::NoCosineThere, Fault::NoFalloff, Fault::NoVisibility]);
}

#[test]
fn planted_faults_of_gloss_are_rejected() {
    rejects(Yard::Varnished, 4096, &[Fault::NoAngle]);
}

#[test]
fn planted_faults_of_passing_are_rejected() {
    rejects(Yard::Veiled, 1024, &[Fault::ThroughTheVeil, Fault::NoFalloff]);
}

/// Path by path, the second opinion is the way that is used; no light is lost or made.
#[test]
fn a_path_s_light_is_dealt_out_whole() {
    for yard in YARDS {
        let tracer = yard.tracer();
        let starts = receivers(&tracer);
        let (mut surfaces, mut skies) = (0, 0);
        for index in 0..500 {
            one_of_each(&tracer, &starts, (9, index), |own, found| {
                let light = tracers_own(&tracer, &starts, own, found);
                for (used, other) in light.iter().zip(second_opinion(&tracer, &starts, own, found, Fault::None)) {
                    assert!((*used - other).length() <= 1e-4 * (1.0 + other.length()), "{yard:?}: {used} {other}");
                }
                let shared = found.shared.map_or(Vec3::ZERO, |shared| shared.radiance);
                let total: Vec3 = light.iter().sum();
                // What looks alike from everywhere.
                if yard == Yard::Matt {
                    assert!((total - found.alone - shared).length() <= 1e-5 * (1.0 + total.length()));
                }
                match found.shared.map(|shared| shared.whence) {
                    Some(Whence::Surface { .. }) => surfaces += 1,
                    Some(Whence::Sky(_)) => skies += 1,
                    None => {}
                }
                light
            });
        }
        assert!(surfaces > 1000 && skies > 200, "{yard:?}: {surfaces} {skies}");
    }
}

/// What looks different from elsewhere, and what is not to be shared, serves its own receiver; both parts together are
/// the path as it is without sharing.
#[test]
fn some_paths_serve_their_own_receiver_alone() {
    let alone = Transport { sharing: Sharing::Alone, ..Transport::default() };
    for yard in YARDS {
        let tracer = yard.tracer();
        let (mut parted, mut unshared) = (0, 0);
        for (number, start) in receivers(&tracer).iter().enumerate() {
            for index in 0..200 {
                let sampler = Sobol::new(1 + number as u64, index);
                let [shared, own] = [Transport::default(), alone]
                    .map(|transport| tracer.find(start, &sampler, &transport, &mut Tally::default()));
                let whole = tracer.diffuse_radiance(start, &sampler, &alone, &mut Tally::default());
                assert!(own.shared.is_none() && own.alone == whole);
                let sum = shared.alone + shared.shared.map_or(Vec3::ZERO, |shared| shared.radiance * shared.own);
                assert!((sum - whole).length() <= 1e-5 * (1.0 + whole.length()), "{yard:?}: {sum} {whole}");
                parted += u32::from(shared.shared.is_some() && shared.alone != Vec3::ZERO);
                unshared += u32::from(shared.shared.is_none());
            }
        }
        let has_alone = !matches!(yard, Yard::Glossy | Yard::Metallic | Yard::Varnished | Yard::Phong);
        assert!(parted > 500 && (unshared > 0 || !has_alone), "{yard:?}: {parted} parted, {unshared} alone");
    }
}

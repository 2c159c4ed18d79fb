//! The numbers: even where they should be, unrelated where they should be, the same whenever they are asked for.

use super::{Dimensions, Independent, Sampler, Sobol};
use crate::math::combine;
use crate::math::testing::{assert_mean, mean_and_error, mean_within};

const GROUPS: [Dimensions; 5] = [
    Dimensions::Start,
    Dimensions::Scatter { vertex: 0 },
    Dimensions::Light { vertex: 0 },
    Dimensions::Scatter { vertex: 1 },
    Dimensions::Light { vertex: 40 },
];

/// The t of each group's first two numbers.
const QUALITY: [u32; 5] = [3, 0, 3, 2, 1];

/// Whether every elementary interval of area 2^t/n holds exactly 2^t of n = 2^k points: a (t, k, 2)-net (Niederreiter
/// 1992). Says which shape of interval fails.
fn is_net(points: &[[f32; 2]], t: u32) -> Result<(), String> {
    let bits = points.len().trailing_zeros() - t;
    for x_bits in 0..=bits {
        let (columns, rows) = (1_usize << x_bits, 1_usize << (bits - x_bits));
        let mut counts = vec![0; columns * rows];
        for [x, y] in points {
            counts[(x * columns as f32) as usize * rows + (y * rows as f32) as usize] += 1;
        }
        if counts.iter().any(|&count| count != 1 << t) {
            return Err(format!("{columns} × {rows} intervals"));
        }
    }
    Ok(())
}

fn points(sampler: impl Fn(u64) -> [f32; 4], from: u64, count: u64, axes: [usize; 2]) -> Vec<[f32; 2]> {
    (from..from + count).map(sampler).map(|numbers| axes.map(|axis| numbers[axis])).collect()
}

/// The first direction of a path is of the best: t = 0. The other groups are later dimensions of the sequence.
#[test]
fn the_first_two_of_a_group_are_nets() {
    for key in 0..20 {
        for (group, t) in GROUPS.into_iter().zip(QUALITY) {
            for count in [256, 1024] {
                // Also later runs of the sequence, and beyond its first block of 2^16.
                for from in [0, count, 7 * count, 65_536, 5 * 65_536 + count] {
                    let net = is_net(&points(|index| Sobol::new(key, index).draw(group), from, count, [0, 1]), t);
                    assert_eq!(net, Ok(()), "key {key}, {group:?}, {count} from {from}");
                }
            }
        }
    }
}

/// Planted: independent numbers are no net, and neither is a run that does not begin where one does.
#[test]
fn other_points_are_no_nets() {
    let independent = |index| Independent::new(1, index).draw(Dimensions::Start);
    assert!(is_net(&points(independent, 0, 64, [0, 1]), 0).is_err());
    assert!(QUALITY.into_iter().all(|t| is_net(&points(independent, 0, 256, [0, 1]), t).is_err()));
    let shifted = |index| Sobol::new(1, index + 1).draw(GROUPS[1]);
    assert!(is_net(&points(shifted, 0, 64, [0, 1]), 0).is_err());
}

#[test]
fn each_number_alone_is_stratified() {
    for group in GROUPS {
        for axis in 0..4 {
            let numbers = points(|index| Sobol::new(5, index).draw(group), 0, 4096, [axis, axis]);
            let mut counts = [0; 4096];
            numbers.iter().for_each(|[x, _]| counts[(x * 4096.0) as usize] += 1);
            assert!(counts.iter().all(|&count| count == 1), "{group:?} {axis}");
        }
    }
}

#[test]
fn numbers_do_not_depend_on_the_order_in_which_they_are_asked_for() {
    let there: Vec<[f32; 4]> = (0..70_000).step_by(7).map(|index| Sobol::new(3, index).draw(GROUPS[2])).collect();
    let mut back: Vec<[f32; 4]> = Vec::new();
    for index in (0..70_000).step_by(7).collect::<Vec<u64>>().into_iter().rev() {
        let sampler = Sobol::new(3, index);
        let _ = sampler.draw(GROUPS[4]);
        back.push(sampler.draw(GROUPS[2]));
    }
    back.reverse();
    assert_eq!(there, back);
    assert!(there.iter().flatten().all(|number| (0.0..1.0).contains(number)));
}

#[test]
fn groups_have_dimensions_of_their_own() {
    let mut groups: Vec<u32> = vec![Dimensions::Start.group()];
    for vertex in 0..1000 {
        groups.extend([Dimensions::Scatter { vertex }.group(), Dimensions::Light { vertex }.group()]);
    }
    let count = groups.len();
    groups.sort_unstable();
    groups.dedup();
    assert_eq!(groups.len(), count);
}

/// The correlation of two rows of numbers, times √n: about normal if they are independent.
fn correlation(a: &[f32], b: &[f32]) -> f64 {
    let centred = |numbers: &[f32]| -> Vec<f64> { numbers.iter().map(|&number| f64::from(number) - 0.5).collect() };
    let (a, b) = (centred(a), centred(b));
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt() * (a.len() as f64).sqrt()
}

/// Numbers of other groups, other keys and other blocks are unrelated: 4.5 of their standard deviations for some
/// thousand pairs.
#[test]
fn what_should_be_independent_is_uncorrelated() {
    let row = |key: u64, group: Dimensions, axis: usize, from: u64| -> Vec<f32> {
        (from..from + 4096).map(|index| Sobol::new(key, index).draw(group)[axis]).collect()
    };
    let mut rows = Vec::new();
    for group in GROUPS {
        for axis in 0..2 {
            rows.push(row(1, group, axis, 0));
        }
    }
    // The keys of neighbours: as replicates are made, and differing in one bit.
    for key in [2, 3, combine(1, 0), combine(1, 1), combine(1, 2), combine(2, 0)] {
        rows.push(row(key, Dimensions::Start, 0, 0));
        rows.push(row(key, Dimensions::Start, 1, 0));
    }
    rows.push(row(1, Dimensions::Start, 0, 65_536));
    rows.push(row(1, Dimensions::Start, 0, 131_072));
    let mut pairs = 0;
    for (index, a) in rows.iter().enumerate() {
        for b in &rows[..index] {
            let found = correlation(a, b);
            assert!(found.abs() < 4.5, "{found} at pair {pairs}");
            pairs += 1;
        }
    }
    assert!(pairs > 200, "{pairs}");
    // Planted: the same row in another guise.
    let shifted: Vec<f32> = rows[0].iter().map(|number| (number + 0.1).fract()).collect();
    assert!(correlation(&rows[0], &shifted) > 4.5);
}

/// An integrand of six numbers from two groups, with mean 1: not additive, with a step in it.
fn integrand(sampler: &impl Sampler) -> f64 {
    let [a, b, c, _] = sampler.draw(Dimensions::Scatter { vertex: 0 }).map(f64::from);
    let [d, e, f, _] = sampler.draw(Dimensions::Light { vertex: 0 }).map(f64::from);
    let step = if a + d > 1.0 { 2.0 } else { 0.0 };
    step * (1.5 * b.sqrt()) * (2.0 * c) * (0.5 + e) * (3.0 * f * f)
}

fn means(count: u64, sample: impl Fn(u64, u64) -> f64) -> Vec<f64> {
    (0..64).map(|key| (0..count).map(|index| sample(key, index)).sum::<f64>() / count as f64).collect()
}

#[test]
fn the_mean_is_that_of_independent_numbers_with_less_noise() {
    let independent = means(1024, |key, index| integrand(&Independent::new(key, index)));
    let sobol = means(1024, |key, index| integrand(&Sobol::new(key, index)));
    assert_mean(&independent, 1.0, 0.08);
    assert_mean(&sobol, 1.0, 0.02);
    let [(_, independent), (_, sobol)] = [independent, sobol].map(|means| mean_and_error(&means));
    assert!(sobol < 0.4 * independent, "{sobol} against {independent}");
}

/// Sums over more samples than one Sobol sequence has are right too.
#[test]
fn blocks_go_on_where_the_sequence_ends() {
    let long = means(8192, |key, index| integrand(&Sobol::new(key, index + 61_440)));
    assert_mean(&long, 1.0, 0.015);
    let first = (0..1000).map(|index| Sobol::new(1, index).draw(GROUPS[0]));
    let again = (65_536..66_536).map(|index| Sobol::new(1, index).draw(GROUPS[0]));
    assert_eq!(first.zip(again).filter(|(first, again)| first == again).count(), 0);
    // Planted: numbers squeezed by a hundredth.
    let squeezed = means(8192, |key, index| integrand(&Squeezed(Sobol::new(key, index))));
    let (mean, error) = mean_and_error(&squeezed);
    assert!(mean_within(mean, error, 1.0, 0.015).is_err(), "{mean} {error}");
}

struct Squeezed(Sobol);

impl Sampler for Squeezed {
    fn draw(&self, dimensions: Dimensions) -> [f32; 4] {
        self.0.draw(dimensions).map(|number| 0.99 * number)
    }
}

//! What dilation may never do, on fields by chance: charts that touch and overlap, with holes, hidden texels, cut links
//! and black texels among bright ones. The judges work by definitions of their own; `faults` holds them against
//! dilations with planted faults.

mod faults;

use super::*;
use crate::math::testing::Random;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::num::NonZeroUsize;

/// What is wrong, as a sentence.
type Verdict = Result<(), String>;

/// A dilation: the one of the house, or one with a fault.
type Dilation = fn(&mut Field, &Workers<'_>) -> Owners;

/// What stands in texels that nobody measured: no light at all, so that whatever reads it shows.
const POISONS: [f32; 5] = [f32::NAN, f32::INFINITY, 1e30, -1e30, f32::NEG_INFINITY];

/// A page by chance.
#[derive(Clone, Debug)]
struct Sketch {
    size: [u32; 2],
    /// Corner (around the page) and size of each chart; the later ones lie on top.
    charts: Vec<[u32; 4]>,
    /// Of values, states and links.
    seed: u64,
    /// Of the texels of charts, out of 16.
    hidden: u32,
    black: u32,
    /// Of the links between neighbours in a chart, out of 16.
    cut: u32,
}

fn sketches() -> impl Strategy<Value = Sketch> {
    let side = || 1..=30_u32;
    let chart = (0..28_u32, 0..28_u32, 1..=12_u32, 1..=12_u32).prop_map(|(x, y, width, height)| [x, y, width, height]);
    let charts = proptest::collection::vec(chart, 1..=6);
    ((side(), side()), charts, any::<u64>(), 0..=14_u32, 0..=12_u32, 0..=8_u32).prop_map(
        |((width, height), charts, seed, hidden, black, cut)| Sketch {
            size: [width, height],
            charts,
            seed,
            hidden,
            black,
            cut,
        },
    )
}

impl Sketch {
    /// The field; texels that were not measured hold nothing.
    fn field(&self) -> Field {
        let mut field = Field::empty(self.size);
        let mut random = Random::new(self.seed);
        let mut chance = |of_sixteen: u32| random.unit() * 16.0 < of_sixteen as f32;
        for (number, &[left, top, width, height]) in self.charts.iter().enumerate() {
            let [left, top] = [left % self.size[0], top % self.size[1]];
            for index in 0..field.value.len() {
                let [x, y] = [index as u32 % self.size[0], index as u32 / self.size[0]];
                if (left..left + width).contains(&x) && (top..top + height).contains(&y) {
                    field.chart[index] = number as u32;
                    field.state[index] = if chance(self.hidden) { TexelState::Hidden } else { TexelState::Measured };
                }
            }
        }
        let mut random = Random::new(!self.seed);
        let mut unit = || random.unit();
        for index in 0..field.value.len() {
            // Every number is drawn for every texel, so that fewer charts leave the rest as it is.
            let light = Vec3::new(unit(), unit(), unit()) * 2.0_f32.powi((20.0 * unit()) as i32 - 10);
            let is_black = unit() * 16.0 < self.black as f32;
            if field.is_measured(index) {
                field.value[index] = if is_black { Vec3::ZERO } else { light };
            }
            for step in [[1, 0], [-1, 1], [0, 1], [1, 1]] {
                let is_cut = unit() * 16.0 < self.cut as f32;
                // Links to hidden texels, too, which no bake makes: nobody may follow them.
                let is_covered = |index: &usize| field.state[*index] != TexelState::Empty;
                let Some(other) = field.step(index, step).filter(is_covered) else { continue };
                if !is_cut && is_covered(&index) && field.chart[index] == field.chart[other] {
                    field.links[index].add(step);
                    field.links[other].add(step.map(i32::wrapping_neg));
                }
            }
        }
        field
    }
}

/// As the house does it.
fn proper(field: &mut Field, workers: &Workers<'_>) -> Owners {
    dilate(field, workers).unwrap()
}

fn run(dilation: Dilation, before: &Field, threads: usize) -> (Field, Owners) {
    let cancel = CancelToken::default();
    let workers = Workers::new(NonZeroUsize::new(threads), &(), &cancel).unwrap();
    let mut after = before.clone();
    let owners = dilation(&mut after, &workers);
    (after, owners)
}

fn bits(value: Vec3) -> [u32; 3] {
    value.to_array().map(f32::to_bits)
}

fn place(field: &Field, index: usize) -> [i64; 2] {
    let width = field.size[0] as usize;
    [(index % width) as i64, (index / width) as i64]
}

/// Steps from one texel to another, where a diagonal one counts as one.
fn distance(field: &Field, a: usize, b: usize) -> i64 {
    let ([a_x, a_y], [b_x, b_y]) = (place(field, a), place(field, b));
    (a_x - b_x).abs().max((a_y - b_y).abs())
}

/// What was measured keeps its bits, black or not, and all that is known of every texel stays.
fn keeps_what_was_measured(before: &Field, after: &Field, owners: &Owners) -> Verdict {
    for index in (0..before.value.len()).filter(|&index| before.is_measured(index)) {
        if bits(before.value[index]) != bits(after.value[index]) {
            return Err(format!("measured {index} was {} and is {}", before.value[index], after.value[index]));
        }
        if owners.source(index) != Some(index) {
            return Err(format!("measured {index} goes by {:?}", owners.source(index)));
        }
    }
    let is_kept = before.state == after.state && before.chart == after.chart && before.links == after.links;
    is_kept.then_some(()).ok_or_else(|| "states, charts or links have changed".into())
}

/// What texels that nobody measured held before makes no difference, and what is not filled is left alone.
fn reads_only_what_was_measured(dilation: Dilation, before: &Field) -> Verdict {
    let (expected, owners) = run(dilation, before, 2);
    for shift in 0..POISONS.len() {
        let mut poisoned = before.clone();
        for index in (0..before.value.len()).filter(|&index| !before.is_measured(index)) {
            poisoned.value[index] = Vec3::splat(POISONS[(index + shift) % POISONS.len()]);
        }
        let (after, other_owners) = run(dilation, &poisoned, 2);
        if owners.source != other_owners.source {
            return Err("whom texels go by hangs on what was not measured".into());
        }
        for index in 0..before.value.len() {
            let expected = if owners.source(index).is_some() { expected.value[index] } else { poisoned.value[index] };
            if bits(after.value[index]) != bits(expected) {
                return Err(format!("{index} is {} and not {expected}", after.value[index]));
            }
        }
    }
    Ok(())
}

/// The measured texels at most [`REACH`] from one along each axis to which links lead within that window.
fn sources(field: &Field, from: usize) -> Vec<usize> {
    let near: Vec<usize> = (0..field.value.len())
        .filter(|&index| field.is_measured(index) && distance(field, index, from) <= i64::from(REACH))
        .collect();
    let mut found = vec![from];
    // Until nothing is added any more.
    loop {
        let is_beside = |&a: &usize, &b: &usize| {
            let ([a_x, a_y], [b_x, b_y]) = (place(field, a), place(field, b));
            distance(field, a, b) == 1 && field.links[a].reaches([(b_x - a_x) as i32, (b_y - a_y) as i32])
        };
        let added = |index: &usize| !found.contains(index) && found.iter().any(|known| is_beside(known, index));
        let added: Vec<usize> = near.iter().copied().filter(added).collect();
        if added.is_empty() {
            return found;
        }
        found.extend(added);
    }
}

/// What is filled lies within the range of the measured texels around the one that it goes by, that range carried on by
/// itself upwards, and downwards by no more than half of what is least. So what goes by black alone is black.
fn stays_within_its_sources(before: &Field, after: &Field, owners: &Owners) -> Verdict {
    for index in (0..before.value.len()).filter(|&index| !before.is_measured(index)) {
        let Some(source) = owners.source(index) else { continue };
        if !before.is_measured(source) {
            return Err(format!("{index} goes by {source}, which was not measured"));
        }
        let values: Vec<Vec3> = sources(before, source).into_iter().map(|source| before.value[source]).collect();
        for channel in 0..3 {
            let values = || values.iter().map(|value| f64::from(value[channel]));
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
            let (least, most) = (low - (high - low).min(0.5 * low), high + (high - low));
            let value = f64::from(after.value[index][channel]);
            // Of one rounding; none where all is black.
            let slack = most * f64::from(f32::EPSILON);
            if !(least - slack..=most + slack).contains(&value) {
                return Err(format!("{index} is {value}, not within {least} and {most}"));
            }
        }
    }
    Ok(())
}

/// Whoever can be reached from a measured texel in [`PASSES`] steps that touch no hidden texel is filled, then all of
/// its block is, and nothing else.
fn fills_rings_and_blocks(before: &Field, owners: &Owners) -> Verdict {
    let count = before.value.len();
    let mut is_reached: Vec<bool> = (0..count).map(|index| before.is_measured(index)).collect();
    for _ in 0..PASSES {
        let known = is_reached.clone();
        for index in (0..count).filter(|&index| before.state[index] == TexelState::Empty) {
            is_reached[index] |= neighbours(before, index).any(|other| known[other]);
        }
    }
    let measured: Vec<usize> = (0..count).filter(|&index| before.is_measured(index)).collect();
    let block = |index: usize| place(before, index).map(|along| along / i64::from(BLOCK));
    for (index, &is_reached) in is_reached.iter().enumerate() {
        let is_filled = owners.source(index).is_some();
        if is_reached && !is_filled {
            return Err(format!("{index} lies in a ring and is not filled"));
        }
        let mut of_block = (0..count).filter(|&other| block(other) == block(index));
        if of_block.clone().any(|other| owners.source(other).is_some() != is_filled) {
            return Err(format!("the block of {index} is not complete"));
        }
        let is_near = |other| measured.iter().any(|&from| distance(before, from, other) <= i64::from(PASSES));
        if is_filled && !of_block.any(is_near) {
            return Err(format!("{index} lies beyond all rings and is filled"));
        }
    }
    Ok(())
}

/// A hidden texel beside a measured one of its own chart goes by its own chart.
fn hidden_texels_go_by_their_own(before: &Field, owners: &Owners) -> Verdict {
    for index in (0..before.value.len()).filter(|&index| before.state[index] == TexelState::Hidden) {
        let is_own = |other: usize| before.chart[other] == before.chart[index];
        let has_own = neighbours(before, index).any(|other| before.is_measured(other) && is_own(other));
        if has_own && !owners.source(index).is_some_and(is_own) {
            return Err(format!("hidden {index} goes by {:?}, of another chart", owners.source(index)));
        }
    }
    Ok(())
}

/// The same bits whatever the number of threads.
fn is_the_same_on_all_threads(dilation: Dilation, before: &Field) -> Verdict {
    let (expected, expected_owners) = run(dilation, before, 1);
    for threads in [2, 3, 5] {
        let (after, owners) = run(dilation, before, threads);
        let is_same = after.value.iter().zip(&expected.value).all(|(a, b)| bits(*a) == bits(*b));
        if !is_same || owners.source != expected_owners.source {
            return Err(format!("{threads} threads give other bits than one"));
        }
    }
    Ok(())
}

/// All of the above but threads.
fn judge(dilation: Dilation, before: &Field) -> Verdict {
    let (after, owners) = run(dilation, before, 2);
    keeps_what_was_measured(before, &after, &owners)?;
    reads_only_what_was_measured(dilation, before)?;
    stays_within_its_sources(before, &after, &owners)?;
    fills_rings_and_blocks(before, &owners)?;
    hidden_texels_go_by_their_own(before, &owners)
}

fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x6469_6c61),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config(512))]

    #[test]
    fn any_field_is_filled_from_what_was_measured_and_from_nothing_else(sketch in sketches()) {
        let verdict = judge(proper, &sketch.field());
        prop_assert!(verdict.is_ok(), "{:?}", verdict);
    }

    /// Black charts beside bright ones: what goes by black is black, to the bit.
    #[test]
    fn black_stays_black_and_so_do_its_rings(mut sketch in sketches(), is_black in [any::<bool>(); 6]) {
        sketch.black = 0;
        let mut before = sketch.field();
        for index in 0..before.value.len() {
            if before.is_measured(index) && is_black[before.chart[index] as usize] {
                before.value[index] = Vec3::ZERO;
            }
        }
        let (after, owners) = run(proper, &before, 2);
        for index in 0..before.value.len() {
            let Some(source) = owners.source(index) else { continue };
            let goes_by_black = is_black[before.chart[source] as usize];
            prop_assert_eq!(after.value[index] == Vec3::ZERO, goes_by_black, "{} by {}", index, source);
        }
    }

    /// A million times the light, or a millionth, to the bit.
    #[test]
    fn strength_only_scales(sketch in sketches()) {
        let before = sketch.field();
        let (plain, _) = run(proper, &before, 2);
        for scale in [2.0_f32.powi(20), 2.0_f32.powi(-20)] {
            let mut other = before.clone();
            other.value.iter_mut().for_each(|value| *value *= scale);
            let (other, _) = run(proper, &other, 2);
            for (value, other) in plain.value.iter().zip(&other.value) {
                prop_assert_eq!(bits(*value * scale), bits(*other));
            }
        }
    }
}

proptest! {
    #![proptest_config(config(128))]

    #[test]
    fn threads_change_nothing(sketch in sketches()) {
        let verdict = is_the_same_on_all_threads(proper, &sketch.field());
        prop_assert!(verdict.is_ok(), "{:?}", verdict);
    }
}

/// The fields by chance have what is asked of them: filled, hidden, black, cut and left alone.
#[test]
fn sketches_are_of_all_kinds() {
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;
    let mut runner = TestRunner::new(config(1));
    let mut seen = [0_u32; 6];
    for _ in 0..64 {
        let before = sketches().new_tree(&mut runner).unwrap().current().field();
        let (_, owners) = run(proper, &before, 1);
        let all = || 0..before.value.len();
        let measured = |index: usize| before.is_measured(index);
        let kinds = [
            all().any(|index| !measured(index) && owners.source(index).is_some()),
            all().any(|index| owners.source(index).is_none()),
            all().any(|index| before.state[index] == TexelState::Hidden && owners.source(index).is_some()),
            all().any(|index| measured(index) && before.value[index] == Vec3::ZERO),
            all().any(|index| measured(index) && before.links[index] == Links::default()),
            all().any(|index| {
                let foreign = |source| before.chart[source] != before.chart[index];
                before.state[index] == TexelState::Hidden && owners.source(index).is_some_and(foreign)
            }),
        ];
        seen.iter_mut().zip(kinds).for_each(|(seen, kind)| *seen += u32::from(kind));
    }
    assert!(seen.iter().all(|&seen| seen >= 8), "{seen:?} of 64");
}

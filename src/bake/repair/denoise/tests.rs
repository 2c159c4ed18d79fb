use super::*;
use crate::bake::CancelToken;
use crate::bake::repair::TexelState;
use crate::bake::validity::Links;
use crate::math::luminance;
use crate::math::testing::Random;
use glam::Vec3;
use proptest::prelude::*;

/// Normal numbers from uniform ones: the sum of twelve.
fn normal(random: &mut Random) -> f32 {
    (0..12).map(|_| random.unit()).sum::<f32>() - 6.0
}

/// A page of one flat chart whose light is `truth` by column and row, measured by 16 runs with noise of `stderr`
/// times the light.
fn noisy([width, height]: [u32; 2], seed: u64, stderr: f32, truth: impl Fn(f32, f32) -> Vec3) -> Field {
    let mut field = Field::empty([width, height]);
    let mut random = Random::new(seed);
    for index in 0..field.value.len() {
        let [x, y] = [index as u32 % width, index as u32 / width];
        let light = truth(x as f32, y as f32);
        let runs: Vec<Vec3> = (0..16).map(|_| light * (1.0 + 4.0 * stderr * normal(&mut random)).max(0.0)).collect();
        measure(&mut field, index, &runs);
        field.position[index] = Vec3::new(x as f32, 0.0, y as f32);
    }
    link(&mut field);
    field
}

/// The same under even light, with the noise of texels that share their paths: alike every fourth texel of a tile.
fn akin(seed: u64, stderr: f32) -> Field {
    let side = 64;
    let mut field = Field::empty([side; 2]);
    let mut random = Random::new(seed);
    let tiles = side / 16;
    let noise: Vec<[f32; 16]> = (0..16 * tiles * tiles).map(|_| std::array::from_fn(|_| normal(&mut random))).collect();
    for index in 0..field.value.len() {
        let [x, y] = [index as u32 % side, index as u32 / side];
        let family = (y / 16 * tiles + x / 16) * 16 + y % 4 * 4 + x % 4;
        let runs = noise[family as usize].map(|noise| Vec3::splat((1.0 + 4.0 * stderr * noise).max(0.0)));
        measure(&mut field, index, &runs);
        field.position[index] = Vec3::new(x as f32, 0.0, y as f32);
    }
    link(&mut field);
    field
}

fn measure(field: &mut Field, index: usize, runs: &[Vec3]) {
    let mean = runs.iter().sum::<Vec3>() / 16.0;
    let squares: Vec3 = runs.iter().map(|run| (*run - mean) * (*run - mean)).sum();
    field.value[index] = mean;
    field.stderr[index] = root(squares / 240.0);
    field.residual[index] = field.stderr[index];
    field.half[index] = runs.iter().step_by(2).sum::<Vec3>() / 8.0;
    field.state[index] = TexelState::Measured;
    field.normal[index] = Vec3::Y;
}

/// Links all measured neighbours of one chart.
fn link(field: &mut Field) {
    for index in 0..field.value.len() {
        field.links[index] = Links::default();
        for step in (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y])) {
            let other = field.step(index, step).filter(|&other| field.is_measured(other));
            if other.is_some_and(|other| field.is_measured(index) && field.chart[other] == field.chart[index]) {
                field.links[index].add(step);
            }
        }
    }
}

fn denoised(field: &Field) -> Field {
    let mut fields = [field.clone()];
    let cancel = CancelToken::default();
    let workers = Workers::new(std::num::NonZeroUsize::new(2), &(), &cancel).unwrap();
    denoise(&mut fields, &workers).unwrap();
    let [field] = fields;
    field
}

/// Root of the mean squared error, by luminance.
fn error(field: &Field, truth: impl Fn(f32, f32) -> Vec3) -> f64 {
    let width = field.size[0] as usize;
    let square =
        |index: usize| luminance(field.value[index] - truth((index % width) as f32, (index / width) as f32)).powi(2);
    ((0..field.value.len()).map(square).sum::<f64>() / field.value.len() as f64).sqrt()
}

const GREY: fn(f32, f32) -> Vec3 = |_, _| Vec3::new(0.8, 1.0, 1.2);

/// A curved light with an edge in it.
const SHADOW: fn(f32, f32) -> Vec3 = |x, y| {
    let light = Vec3::new(1.0, 0.9, 0.7) * (2.0 + 0.02 * (x - 10.0) * (x - 10.0) + 0.05 * y);
    if x + 0.5 * y < 20.0 { light } else { 0.2 * light }
};

#[test]
fn noise_goes_and_edges_stay() {
    for (truth, gain) in [(GREY, 4.0), (SHADOW, 2.0)] {
        let field = noisy([40, 32], 5, 0.05, truth);
        let after = denoised(&field);
        let [was, is] = [error(&field, truth), error(&after, truth)];
        assert!(is * gain < was, "{was} → {is}");
    }
}

#[test]
fn what_has_no_error_keeps_its_bits() {
    let mut field = noisy([24, 16], 1, 0.0, SHADOW);
    field.stderr.fill(Vec3::ZERO);
    field.half = field.value.clone();
    assert_eq!(denoised(&field).value, field.value);
    // A single exact texel among noisy ones, and a channel of one.
    let mut field = noisy([24, 16], 1, 0.05, SHADOW);
    field.stderr[100] = Vec3::ZERO;
    field.stderr[200].y = 0.0;
    let after = denoised(&field);
    assert_eq!(after.value[100], field.value[100]);
    assert_eq!(after.value[200].y, field.value[200].y);
    assert_ne!(after.value[200].x, field.value[200].x);
}

#[test]
fn scaled_radiance_gives_scaled_texels() {
    let field = noisy([24, 20], 3, 0.08, SHADOW);
    let plain = denoised(&field);
    for scale in [1e-6_f32, 1e-3, 1024.0, 1e6, 1.0 / 4096.0] {
        let mut scaled = field.clone();
        for layer in [&mut scaled.value, &mut scaled.stderr, &mut scaled.half] {
            layer.iter_mut().for_each(|texel| *texel *= scale);
        }
        for (one, other) in plain.value.iter().zip(&denoised(&scaled).value) {
            assert!((*one - *other / scale).length() < 3e-4 * one.length(), "{one} {other} {scale}");
            // A power of two scales all that is worked out, to the bit.
            assert!(scale.to_bits() & 0x7f_ffff != 0 || *one == *other / scale, "{one} {other} {scale}");
        }
    }
}

#[test]
fn light_that_is_rarely_found_is_not_lost() {
    for chance in [0.003, 0.01, 0.03, 0.1] {
        let field = rare([64, 64], 77, |_| chance);
        let sum = |field: &Field| field.value.iter().map(|value| f64::from(value.x)).sum::<f64>();
        let after = denoised(&field);
        let squares: f64 = field.stderr.iter().map(|error| f64::from(error.x).powi(2)).sum();
        let change = (sum(&after) - sum(&field)) / squares.sqrt();
        assert!(change.abs() < 1.0, "{chance}: the total moved by {change} of its standard errors");
        assert!(after.value.iter().all(|value| value.min_element() >= 0.0));
    }
}

/// Weights that know the noise that they weigh keep it, and make too little of what is left.
#[test]
fn weights_of_the_same_half_are_no_good() {
    let field = noisy([48, 48], 21, 0.1, GREY);
    let texels = Texels::new(&field);
    let cancel = CancelToken::default();
    let workers = Workers::new(None, &(), &cancel).unwrap();
    // Sharper than those that are used, which would show it less.
    let looks = [0, 1].map(|half| Looks::measured(&texels, half).exceeded_by(1.0));
    let levels = level(&texels, &looks, 4.6, &workers).unwrap();
    let ratio = |halves: fn(&Level) -> [Fitted; 2]| {
        let (mut squares, mut variances) = (0.0, 0.0);
        for half in levels.iter().flat_map(halves) {
            squares += luminance(half.value - GREY(0.0, 0.0)).powi(2);
            variances += luminance(root(half.variance)).powi(2);
        }
        f64::sqrt(squares / variances)
    };
    let [same, other] = [ratio(|level| level.own), ratio(|level| level.crossed)];
    assert!((other - 1.0).abs() < 0.15, "{other}");
    assert!(same > 1.05 * other, "{same} against {other}");
}

/// A page where a run finds light with some chance, by column, and then always the same.
fn rare([width, height]: [u32; 2], seed: u64, chance: impl Fn(u32) -> f32) -> Field {
    let mut field = noisy([width, height], 1, 0.0, GREY);
    let mut random = Random::new(seed);
    for index in 0..field.value.len() {
        let chance = chance(index as u32 % width);
        let runs: Vec<Vec3> =
            (0..16).map(|_| Vec3::splat(if random.unit() < chance { 1.0 / 16.0 } else { 0.0 })).collect();
        measure(&mut field, index, &runs);
    }
    field
}

#[test]
fn what_light_missed_by_chance_is_no_speck() {
    for (seed, chance) in [(1, 0.03), (2, 0.1), (3, 0.2)] {
        let field = rare([64, 64], seed, |_| chance);
        let after = denoised(&field);
        let black = |field: &Field| field.value.iter().filter(|value| **value == Vec3::ZERO).count();
        assert!(black(&field) > 40, "nothing to be seen");
        assert!(20 * black(&after) < black(&field), "{} black, then {}", black(&field), black(&after));
        let truth = |_, _| Vec3::splat(chance / 16.0);
        assert!(3.0 * error(&after, truth) < error(&field, truth), "{chance}");
    }
}

/// Where light is rare a texel that little of it found looks certain. One is a speck, a pool of them is a shadow.
#[test]
fn what_light_nearly_missed_is_no_speck() {
    let mut field = noisy([48, 48], 12, 0.3, |_, _| Vec3::ONE);
    let speck = 48 * 10 + 10;
    let is_pool = |index: usize| (index % 48).abs_diff(34).pow(2) + (index / 48).abs_diff(34).pow(2) <= 25;
    let mut random = Random::new(13);
    for index in (0..field.value.len()).filter(|&index| index == speck || is_pool(index)) {
        let runs: Vec<Vec3> = (0..16).map(|_| Vec3::splat(0.3 * (1.0 + 0.2 * normal(&mut random)))).collect();
        measure(&mut field, index, &runs);
    }
    let after = denoised(&field);
    assert!(after.value[speck].x > 0.7, "{}", after.value[speck]);
    for index in (0..after.value.len()).filter(|&index| is_pool(index)) {
        assert!((after.value[index].x - 0.3).abs() < 0.1, "{index}: {}", after.value[index]);
    }
}

/// Beyond an edge there are more black texels than chance makes, and all to one side.
#[test]
fn what_is_black_beside_rare_light_stays_black() {
    let is_dark = |x: u32| x < 24 || x == 40;
    for (chance, width) in [(0.1, 24), (0.3, 24), (0.45, 64)] {
        let field = rare([64, 64], 4, |x| if is_dark(x) { 0.0 } else { chance });
        let after = denoised(&field);
        let dark = (0..after.value.len() as u32).filter(|index| index % 64 < width && is_dark(index % 64));
        let wrong: Vec<u32> = dark.filter(|&index| after.value[index as usize] != Vec3::ZERO).collect();
        // Further from the light than errors are averaged nothing may happen, and nearer to it next to nothing.
        assert!(wrong.iter().all(|index| index % 64 > 20), "light far from any");
        let light: f32 = wrong.iter().map(|&index| after.value[index as usize].x).sum();
        assert!(light < 0.02 * 64.0 * chance / 16.0, "{chance}: {light} in {} dark texels", wrong.len());
    }
}

/// A plane split by a wall that no link crosses, dark behind it.
fn split() -> Field {
    let mut field = noisy([24, 16], 9, 0.2, |x, _| if x < 12.0 { Vec3::ONE } else { Vec3::splat(0.9) });
    for row in 0..16 {
        for column in [11, 12] {
            let index = row * 24 + column;
            let mut links = Links::default();
            let away = if column == 11 { -1 } else { 1 };
            for step in [[0, -1], [0, 1], [away, -1], [away, 0], [away, 1]] {
                if field.links[index].reaches(step) {
                    links.add(step);
                }
            }
            field.links[index] = links;
        }
    }
    field
}

#[test]
fn nothing_crosses_a_wall() {
    let field = split();
    let mut other = field.clone();
    for index in (0..other.value.len()).filter(|index| index % 24 >= 12) {
        for layer in [&mut other.value, &mut other.stderr, &mut other.half] {
            layer[index] *= 0.5;
        }
    }
    let [one, two] = [&field, &other].map(denoised);
    for index in (0..field.value.len()).filter(|index| index % 24 < 12) {
        assert_eq!(one.value[index], two.value[index], "{index}");
    }
    // The check itself: over the wall something would come.
    let [mut open, mut changed] = [field, other];
    link(&mut open);
    link(&mut changed);
    let [one, two] = [&open, &changed].map(denoised);
    assert!((0..one.value.len()).any(|index| index % 24 < 12 && one.value[index] != two.value[index]));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(5), ..ProptestConfig::default() })]

    /// Holes, charts and states anywhere: what is not measured, and what belongs to another chart, never matters.
    #[test]
    fn only_measured_texels_of_the_chart_are_read(seed in 0_u64..1000, stderr in 0.0_f32..0.5) {
        let mut field = noisy([20, 18], seed, stderr, SHADOW);
        let mut random = Random::new(seed);
        for index in 0..field.value.len() {
            field.chart[index] = u32::from(index % 20 >= 9) + 2 * u32::from(random.unit() < 0.1);
            field.state[index] = match random.unit() {
                unit if unit < 0.1 => TexelState::Hidden,
                unit if unit < 0.2 => TexelState::Empty,
                _ => TexelState::Measured,
            };
        }
        link(&mut field);
        let plain = denoised(&field);
        let mut spoilt = field.clone();
        for index in 0..spoilt.value.len() {
            let layers = [&mut spoilt.value, &mut spoilt.stderr, &mut spoilt.half, &mut spoilt.normal];
            match (field.state[index], field.chart[index]) {
                (TexelState::Measured, 1) => layers.into_iter().take(3).for_each(|layer| layer[index] *= 3.0),
                (TexelState::Measured, _) => {}
                _ => layers.into_iter().for_each(|layer| layer[index] = Vec3::NAN),
            }
        }
        let other = denoised(&spoilt);
        let (low, high) = (0..field.value.len())
            .filter(|&index| field.is_measured(index))
            .flat_map(|index| [field.half[index], 2.0 * field.value[index] - field.half[index]])
            .fold((Vec3::MAX, Vec3::ZERO), |(low, high), value| (low.min(value), high.max(value)));
        for index in 0..field.value.len() {
            if field.is_measured(index) {
                let value = plain.value[index];
                prop_assert!(value.is_finite() && value.cmpge(low.max(Vec3::ZERO)).all() && value.cmple(high).all());
                prop_assert!(plain.residual[index].is_finite());
                prop_assert!(field.chart[index] == 1 || other.value[index] == value, "{}", index);
            } else {
                prop_assert_eq!(plain.value[index], field.value[index]);
            }
        }
    }

    #[test]
    fn black_stays_black(seed in 0_u64..1000) {
        let field = noisy([16, 12], seed, 0.3, |x, _| if x < 8.0 { Vec3::ZERO } else { Vec3::ONE });
        let after = denoised(&field);
        for index in (0..after.value.len()).filter(|index| index % 16 < 8) {
            prop_assert_eq!(after.value[index], Vec3::ZERO);
        }
    }
}

/// Errors of texels that share their paths do not go away as others do, and what is told of the rest knows it.
#[test]
fn what_is_left_is_told_also_of_texels_that_err_together() {
    let even = |seed| noisy([64; 2], seed, 0.1, |_, _| Vec3::ONE);
    let root_mean = |values: &[Vec3], of: fn(&Vec3) -> f32| {
        (values.iter().map(|value| of(value).powi(2)).sum::<f32>() / values.len() as f32).sqrt()
    };
    let [mut off, mut told] = [[0.0_f32; 2]; 2];
    for seed in 0..4 {
        for (kind, field) in [even(seed), akin(seed, 0.1)].iter().enumerate() {
            let field = denoised(field);
            off[kind] += root_mean(&field.value, |value| value.y - 1.0) / 4.0;
            told[kind] += root_mean(&field.residual, |residual| residual.y) / 4.0;
        }
    }
    assert!(off[1] > 1.5 * off[0], "no kinship to be seen: {off:?}");
    for kind in 0..2 {
        let ratio = told[kind] / off[kind];
        assert!((0.8..1.6).contains(&ratio), "kind {kind}: told {told:?}, off {off:?}");
    }
}

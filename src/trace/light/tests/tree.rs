//! The choice by the tree: frequencies against probabilities, from outside and from within clusters; no source that
//! gives light is ever left out; rays find all that block nothing.

use super::{along, free, lights, source};
use crate::math::testing::{ChiSquared, Domain, Random, Rejection};
use crate::trace::light::emitter::Cone;
use crate::trace::light::tree::LightTree;
use crate::trace::light::{Emitter, EmitterShape, LightContext, MetSource};
use glam::{Vec2, Vec3};

/// The cells of the test: one for each source, and the last for none, where a cluster turned out to give nothing.
const CELLS: [usize; 2] = [41, 25];

/// How many sources.
const COUNT: u32 = (CELLS[0] * CELLS[1]) as u32 - 1;

/// Sources of all kinds and sizes, in clusters.
fn crowd(count: usize, seed: u64) -> Vec<Emitter> {
    let mut random = Random::new(seed);
    let one = |index: usize| {
        let cluster = Vec3::new((index % 5) as f32 * 4.0, 0.0, (index % 3) as f32 * 5.0);
        let centre = cluster + random.direction() * random.unit();
        let strength = Vec3::splat(10.0_f32.powf(2.0 * random.unit() - 1.0));
        let [u, v] = [random.direction(), random.direction()].map(|edge| 0.2 * edge);
        let normal = u.cross(v).normalize();
        let emitter = match index % 4 {
            0 => source(EmitterShape::Rectangle { corner: centre, edges: [u, normal.cross(u)] }, false),
            1 => source(EmitterShape::Triangle { vertices: [centre, centre + u, centre + v] }, index % 8 == 1),
            2 => source(EmitterShape::Sphere { centre, radius: 0.1 * random.unit() + 1e-3 }, false),
            _ => source(EmitterShape::Point { centre }, false),
        };
        let cone = Cone { direction: normal, inner_angle: 0.5, outer_angle: 1.0 };
        Emitter {
            strength,
            mean_strength: strength,
            normal: if index.is_multiple_of(4) { u.cross(normal.cross(u)).normalize() } else { normal },
            inverse_range: if index.is_multiple_of(6) { 0.2 } else { 0.0 },
            cone: (index % 8 == 3).then_some(cone),
            ..emitter
        }
    };
    (0..count).map(one).collect()
}

/// Receivers outside, between and within the clusters, and in the very middle of one's box.
fn receivers() -> Vec<LightContext> {
    let places = [Vec3::new(30.0, 12.0, -20.0), Vec3::new(4.0, 0.3, 5.0), Vec3::new(2.0, 1.0, 2.0), Vec3::ZERO];
    let facing = |position| {
        [None, Some(Vec3::Y), Some(Vec3::new(-0.6, -0.8, 0.0))].map(|normal| LightContext { position, normal })
    };
    places.into_iter().flat_map(facing).collect()
}

/// χ² of the choice over a plane with a cell for each source.
fn verdict(tree: &LightTree, ctx: &LightContext, fault: impl Fn(u32) -> f64) -> Result<f64, Rejection> {
    let test = ChiSquared { cells: CELLS, ..ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE)) };
    let size = Vec2::new(CELLS[0] as f32, CELLS[1] as f32);
    let cell_of = |index: u32| Vec2::new((index % CELLS[0] as u32) as f32, (index / CELLS[0] as u32) as f32);
    let sample = |u: Vec2| {
        let index = tree.choose(ctx, f64::from(u.x)).map_or(COUNT, |choice| {
            assert_eq!(choice.probability, tree.probability(ctx, choice.source), "{choice:?}");
            choice.source
        });
        ((cell_of(index) + 0.5) / size).extend(0.0)
    };
    let probabilities: Vec<f64> =
        (0..=COUNT).map(|index| probability(tree, ctx, index) * fault(index) * f64::from(COUNT + 1)).collect();
    let density = |p: Vec3| {
        let cell = (p.truncate() * size).floor().min(size - 1.0);
        probabilities[cell.y as usize * CELLS[0] + cell.x as usize]
    };
    test.run(sample, density)
}

/// Of a source, or of none by the number after the last.
fn probability(tree: &LightTree, ctx: &LightContext, index: u32) -> f64 {
    if index < COUNT {
        return tree.probability(ctx, index);
    }
    // Rounding aside, never below zero.
    (1.0 - (0..COUNT).map(|index| tree.probability(ctx, index)).sum::<f64>()).max(1e-12)
}

#[test]
fn choices_follow_their_probabilities() {
    let tree = LightTree::new(&crowd(COUNT as usize, 1)).expect("they shine");
    let lit: Vec<_> = receivers().into_iter().filter(|ctx| probability(&tree, ctx, COUNT) < 0.5).collect();
    assert!(lit.len() > 8, "{}", lit.len());
    for ctx in lit {
        let p = verdict(&tree, &ctx, |_| 1.0);
        assert!(p.is_ok(), "{ctx:?}: {p:?}");
    }
    let ctx = receivers()[3];
    let too_large = verdict(&tree, &ctx, |_| 1.05);
    assert!(matches!(too_large, Err(Rejection::Total(_))), "{too_large:?}");
    // Planted: uniform; and half of the sources a little too often, at the cost of the others.
    let uniform = verdict(&tree, &ctx, |index| 1.0 / (1025.0 * probability(&tree, &ctx, index)).max(1e-12));
    assert!(uniform.is_err(), "{uniform:?}");
    let odd: f64 = (0..COUNT).filter(|index| index % 2 == 1).map(|index| tree.probability(&ctx, index)).sum();
    let shifted = verdict(&tree, &ctx, |index| if index % 2 == 1 { 1.0 + 0.1 / odd } else { 1.0 - 0.1 / (1.0 - odd) });
    assert!(matches!(shifted, Err(Rejection::Counts(_))), "{shifted:?}");
}

/// What is left of 1 is the chance that a cluster seemed to give light and none in it does.
#[test]
fn probabilities_sum_to_one() {
    for count in [1, 2, 3, 17, 1000] {
        let tree = LightTree::new(&crowd(count, 2)).expect("they shine");
        for ctx in receivers() {
            let sum: f64 = (0..count as u32).map(|index| tree.probability(&ctx, index)).sum();
            let none = (0..1000).filter(|step| tree.choose(&ctx, (f64::from(*step) + 0.5) / 1000.0).is_none()).count();
            assert!((sum + none as f64 / 1000.0 - 1.0).abs() < 0.02, "{count}, {ctx:?}: {sum} and {none}");
            assert!(sum <= 1.0 + 1e-9 && (none > 0 || sum > 0.99), "{count}, {ctx:?}: {sum} and {none}");
        }
    }
}

/// Wherever a sample of a source gives light to a receiver, the tree can choose the source.
#[test]
fn no_source_that_gives_light_is_left_out() {
    let mut random = Random::new(5);
    for seed in 0..4 {
        let emitters = crowd(300, 10 + seed);
        let tree = LightTree::new(&emitters).expect("they shine");
        let mut lit = 0;
        for _ in 0..200 {
            let position = Vec3::new(8.0, 0.0, 5.0) + 12.0 * random.unit() * random.direction();
            let ctx = LightContext { position, normal: Some(random.direction()) };
            let normal = ctx.normal.expect("it was just given");
            for (index, emitter) in emitters.iter().enumerate() {
                let Some(sample) = emitter.sample(position, random.square()) else { continue };
                if sample.wi.dot(normal) <= 0.0 {
                    continue;
                }
                lit += 1;
                assert!(tree.probability(&ctx, index as u32) > 0.0, "{emitter:?} at {ctx:?}");
            }
        }
        assert!(lit > 5000, "{lit}");
    }
}

/// The best choice would have chances in proportion to contributions; the tree's are near enough that the variance of
/// contribution / chance is far below that of a choice by power.
#[test]
fn near_and_bright_sources_are_preferred() {
    let emitters = crowd(1000, 3);
    let tree = LightTree::new(&emitters).expect("they shine");
    let power: f64 = emitters.iter().map(Emitter::peak_intensity).sum();
    let (mut by_tree, mut by_power) = (0.0, 0.0);
    for ctx in receivers().into_iter().filter(|ctx| ctx.normal.is_some()) {
        let normal = ctx.normal.expect("it was just asked");
        let given = |emitter: &Emitter| {
            let sample = emitter.sample(ctx.position, Vec2::splat(0.5));
            sample.map_or(0.0, |sample| sample.value.x * f64::from(sample.wi.dot(normal).max(0.0)))
        };
        let total: f64 = emitters.iter().map(given).sum();
        for (index, emitter) in emitters.iter().enumerate() {
            let share = given(emitter) / total;
            if share > 0.0 {
                by_tree += share * share / tree.probability(&ctx, index as u32);
                by_power += share * share * power / emitter.peak_intensity();
            }
        }
    }
    println!("second moments of contribution / chance: tree {by_tree}, power {by_power}");
    assert!(by_tree < 0.2 * by_power, "{by_tree} {by_power}");
}

/// All that block nothing, found through boxes as one by one.
#[test]
fn rays_pass_what_they_pass() {
    let emitters = crowd(400, 7);
    let all = lights(emitters.clone());
    let mut random = Random::new(6);
    let mut met = 0;
    for _ in 0..20_000 {
        let origin = Vec3::new(8.0, 0.0, 5.0) + 8.0 * random.unit() * random.direction();
        let target = emitters[(random.unit() * 400.0) as usize].centre();
        let wi = if random.unit() < 0.1 { Vec3::X } else { (target + 0.1 * random.direction() - origin).normalize() };
        let end = 12.0 * random.unit();
        let ctx = free(origin);
        let found: Vec<MetSource> = all.passed(&ctx, along(origin, wi, end)).collect();
        let expected: Vec<f32> = emitters
            .iter()
            .filter(|emitter| emitter.intersect(origin, wi).is_some_and(|distance| distance < end))
            .map(|emitter| emitter.radiance_towards(origin, wi).x)
            .filter(|&radiance| radiance > 0.0)
            .collect();
        let sorted = |mut values: Vec<f32>| {
            values.sort_by(f32::total_cmp);
            values
        };
        assert_eq!(sorted(found.iter().map(|met| met.radiance.x).collect()), sorted(expected), "{origin} {wi} {end}");
        met += found.len();
    }
    assert!(met > 1000, "{met}");
}

#[test]
fn the_tree_does_not_depend_on_where_sources_are_stored() {
    // The same sources in the same order, at other addresses: the same choices to the last bit.
    let [one, other] = [0; 2].map(|_| LightTree::new(&crowd(500, 9)).expect("they shine"));
    for ctx in receivers() {
        for step in 0..100 {
            assert_eq!(one.choose(&ctx, f64::from(step) / 100.0), other.choose(&ctx, f64::from(step) / 100.0));
        }
    }
}

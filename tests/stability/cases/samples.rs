//! Random numbers: more of them, in more dimensions, for more neighbours than a sequence was made for.

use crate::case::{Case, Verdict};
use crate::common::meter::{at, by, on_walls};
use crate::common::scenes::{SceneBuilder, cornell_lamp, furnace, glowing, grey};
use crate::guards::sampler::{
    BLOCKS, CANCEL, KEY_OF_OBJECT, KEY_OF_PLACE, KEY_OF_REPLICATE, KEY_OF_SEED, LIGHT_DIMENSIONS, ROUNDS, SCRAMBLE,
    START_DIMENSIONS, WHOLE_REPLICATES,
};
use crate::judge::{baked, ensure, light_at, light_by, mean_reads, reads};
use bevy_kiln::bake::{
    BakeError, BakeSettings, CancelToken, Goal, MeterSettings, PictureSettings, measure_irradiance, render_picture,
};
use bevy_kiln::math::{corner_parallel_rectangle, parallel_rectangles};
use bevy_kiln::scene::{Camera, Scene};
use bevy_kiln::trace::{Estimator, Transport};
use glam::Vec3;
use std::f64::consts::PI;
use std::sync::mpsc::channel;
use std::time::Duration;

/// How long a handful of paths may take on a machine that has much else to do.
const AT_ONCE: Duration = Duration::from_secs(30);

const EQUAL_SEEDS: &str = "one seed for all of them: what one has too much of, its neighbour has too";
const BLOTCHES: &str = "one noise pattern over all texels: blotches and stripes that no denoiser takes for noise";
const CORRELATION: &str =
    "the correlation of their errors is 0 to 4.5 standard deviations, beyond which chance goes once in 150 000 times";

pub const CASES: &[Case] = &[
    Case {
        name: "more_samples_than_the_sequence_has",
        hard: "2^21 samples, each of 16 runs twice as long as the Sobol sequence of 2^16",
        elsewhere: "the sequence begins again: more samples, the same answer",
        holds: "the first half differs from the whole, E = π·F (Howell B-3) within 3e-4",
        guard: &BLOCKS,
        without: "twice the samples give the same bits",
        check: longer_than_the_sequence,
    },
    Case {
        name: "paths_of_thousands_of_dimensions",
        hard: "ρ = 0.98 makes paths of hundreds of vertices, eight numbers each; the sequence has 256 dimensions",
        elsewhere: "dimensions repeat: what survived roulette once survives it for ever",
        holds: "E = π/(1 − ρ) within 1 %",
        guard: &ROUNDS,
        without: "E is wrong, or paths do not end",
        check: thousands_of_dimensions,
    },
    Case {
        name: "neighbouring_texels",
        hard: "equal seeds and paths on neighbouring texels",
        elsewhere: BLOTCHES,
        holds: CORRELATION,
        guard: &KEY_OF_PLACE,
        without: "all texels have the same error",
        check: neighbouring_texels,
    },
    Case {
        name: "neighbouring_pixels",
        hard: "equal seeds on neighbouring pixels of a picture",
        elsewhere: BLOTCHES,
        holds: CORRELATION,
        guard: &KEY_OF_PLACE,
        without: "all pixels have the same error",
        check: neighbouring_pixels,
    },
    Case {
        name: "neighbouring_points",
        hard: "meter points next to each other, by one unit in the last place",
        elsewhere: EQUAL_SEEDS,
        holds: CORRELATION,
        guard: &KEY_OF_OBJECT,
        without: "all points have the same error",
        check: neighbouring_points,
    },
    Case {
        name: "equal_objects",
        hard: "texels at the same place of objects with the same UV1, as of instances",
        elsewhere: EQUAL_SEEDS,
        holds: CORRELATION,
        guard: &KEY_OF_OBJECT,
        without: "both objects have the same errors",
        check: equal_objects,
    },
    Case {
        name: "neighbouring_seeds",
        hard: "a seed and the next, whose mean should be twice as good",
        elsewhere: "seeds added to counters: one run is the other, moved by a sample",
        holds: CORRELATION,
        guard: &KEY_OF_SEED,
        without: "both bakes are one",
        check: neighbouring_seeds,
    },
    Case {
        name: "errors_are_honest",
        hard: "samples of one Sobol sequence are not independent: their own spread says nothing of their mean's error",
        elsewhere: "the variance of single samples is taken for that of the mean's error",
        holds: "root mean square of error over standard error is 0.93 to 1.2 (Student's t, 15 degrees: 1.07)",
        guard: &KEY_OF_REPLICATE,
        without: "replicates repeat each other: errors are larger than told",
        check: honest_errors,
    },
    Case {
        name: "one_sample",
        hard: "1 sample is asked for and shared among 16 runs",
        elsewhere: "0/0 in the first preview",
        holds: "16 samples, all numbers finite",
        guard: &WHOLE_REPLICATES,
        without: "a mean of no samples",
        check: one_sample,
    },
    Case {
        name: "light_met_after_a_bounce",
        hard: "a bounce and the light sample after it are multiplied: numbers that depend on each other bias them",
        elsewhere: "one pair of numbers for the way on and the light sample after it",
        holds: "indirect E by light samples and by bounces alone agree within 1 %",
        guard: &LIGHT_DIMENSIONS,
        without: "indirect light is off",
        check: light_after_a_bounce,
    },
    Case {
        name: "one_texel_as_large_as_the_floor",
        hard: "place and direction of a path's start are multiplied where light varies over the texel",
        elsewhere: "one pair of numbers for the place and the direction",
        holds: "mean E/π = form factor of two squares at a distance of 1, within 1 %",
        guard: &START_DIMENSIONS,
        without: "each place looks in one direction only",
        check: one_large_texel,
    },
    Case {
        name: "smooth_light_needs_few_samples",
        hard: "64 times the samples of a smooth light",
        elsewhere: "independent numbers: 64 times the samples give an eighth of the error",
        holds: "less than a fortieth of the error",
        guard: &SCRAMBLE,
        without: "about an eighth",
        check: smooth_light,
    },
    Case {
        name: "four_billion_samples_can_be_cancelled",
        hard: "one estimate of hours on a single point",
        elsewhere: "cancelled between texels only",
        holds: "it ends at once, as cancelled",
        guard: &CANCEL,
        without: "it goes on",
        check: cancelled_in_the_middle,
    },
];

/// A floor without bounces under a lamp, and a point on it: one ray a path.
fn lamp_over_a_point() -> (Scene, [bevy_kiln::bake::MeterPoint; 1]) {
    let scene = SceneBuilder::default()
        .quad("lamp", Vec3::new(-1.0, 1.0, -1.0), [Vec3::X * 2.0, Vec3::Z * 2.0], glowing(0.0, 1.0))
        .build();
    (scene, [at(Vec3::ZERO, Vec3::Y)])
}

fn longer_than_the_sequence() -> Verdict {
    let (scene, point) = lamp_over_a_point();
    let transport = by(Estimator::Bsdf);
    let half = light_by(&scene, &point, 1 << 20, transport)?[0];
    let whole = light_by(&scene, &point, 1 << 21, transport)?[0];
    reads(&whole, 4.0 * PI * corner_parallel_rectangle(1.0, 1.0, 1.0), 3e-4)?;
    ensure(half.irradiance != whole.irradiance, || format!("E is {} after half of it and all of it", half.irradiance.x))
}

fn thousands_of_dimensions() -> Verdict {
    mean_reads(&light_at(&furnace(0.98), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 1), 1 << 11)?, PI / 0.02, 0.01)
}

/// The correlation of pairs of errors, in its own standard deviations.
fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let count = pairs.len() as f64;
    let mean = [0, 1].map(|side| pairs.iter().map(|pair| pair[side]).sum::<f64>() / count);
    let moment = |a: usize, b: usize| pairs.iter().map(|pair| (pair[a] - mean[a]) * (pair[b] - mean[b])).sum::<f64>();
    moment(0, 1) / (moment(0, 0) * moment(1, 1)).sqrt() * count.sqrt()
}

/// Whether errors next to each other, in rows of `width`, are unrelated.
fn are_unrelated(errors: &[f64], width: usize) -> Verdict {
    let rows = errors.len() / width;
    for (right, down) in [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (8, 0)] {
        let mut pairs = Vec::new();
        for y in 0..rows - down {
            pairs.extend((0..width - right).map(|x| [errors[y * width + x], errors[(y + down) * width + x + right]]));
        }
        is_unrelated(&pairs)?;
    }
    Ok(())
}

fn is_unrelated(pairs: &[[f64; 2]]) -> Verdict {
    let found = correlation(pairs);
    let holds = pairs.len() > 100 && found.abs() < 4.5;
    ensure(holds, || format!("{} pairs are correlated by {found:.1} standard deviations", pairs.len()))
}

/// Errors of a floor's 24 × 24 texels in a furnace, where E/π = 2 everywhere.
fn floor_errors(seed: u64, floor: &str) -> Result<Vec<f64>, String> {
    let mut scene = furnace(0.5);
    scene.instances.iter_mut().filter(|side| side.name != floor).for_each(|side| side.lightmap = None);
    let transport = Transport { seed, ..Transport::default() };
    let settings = BakeSettings { transport, goal: Goal::Samples(16), density: 12.0, ..BakeSettings::default() };
    let page = baked(&scene, &settings)?.pages.swap_remove(0);
    let covered = page.raw.iter().zip(&page.coverage).filter(|(_, coverage)| **coverage > 0.0);
    let errors: Vec<f64> = covered.map(|(value, _)| f64::from(value.x) - 2.0).collect();
    if errors.len() == 576 { Ok(errors) } else { Err(format!("{} texels", errors.len())) }
}

fn neighbouring_texels() -> Verdict {
    are_unrelated(&floor_errors(0, "-y")?, 24)
}

fn equal_objects() -> Verdict {
    let [floor, ceiling] = [floor_errors(0, "-y")?, floor_errors(0, "+y")?];
    is_unrelated(&floor.into_iter().zip(ceiling).map(|(a, b)| [a, b]).collect::<Vec<_>>())
}

fn neighbouring_seeds() -> Verdict {
    let [first, second] = [floor_errors(0, "-y")?, floor_errors(1, "-y")?];
    is_unrelated(&first.iter().zip(&second).map(|(a, b)| [*a, *b]).collect::<Vec<_>>())?;
    // And not the same run, moved by a sample.
    is_unrelated(&first.iter().skip(1).zip(&second).map(|(a, b)| [*a, *b]).collect::<Vec<_>>())
}

fn neighbouring_pixels() -> Verdict {
    let camera = Camera::look_at("camera", Vec3::new(0.1, 0.2, 0.3), Vec3::NEG_Y, 1.0);
    let settings = PictureSettings {
        transport: Transport::default(),
        width: 24,
        height: 24,
        samples_per_pixel: 16,
        threads: None,
    };
    let picture = render_picture(&furnace(0.5), &camera, &settings, &(), &CancelToken::default());
    let radiance = picture.map_err(|error| error.to_string())?.radiance;
    are_unrelated(&radiance.iter().map(|value| f64::from(value.x) - 2.0).collect::<Vec<_>>(), 24)
}

fn neighbouring_points() -> Verdict {
    let mut x = 0.25_f32;
    let mut points = Vec::new();
    for _ in 0..576 {
        points.push(at(Vec3::new(x, -1.0, 0.5), Vec3::Y));
        x = x.next_up();
    }
    let readings = light_at(&furnace(0.5), &points, 16)?;
    are_unrelated(&readings.iter().map(|reading| reading.irradiance.x - 2.0 * PI).collect::<Vec<_>>(), 24)
}

fn honest_errors() -> Verdict {
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 12);
    let readings = light_at(&furnace(0.5), &points, 64)?;
    let squares: f64 = readings.iter().map(|r| ((r.irradiance.x - 2.0 * PI) / r.stderr.x).powi(2)).sum();
    let ratio = (squares / readings.len() as f64).sqrt();
    ensure((0.93..1.2).contains(&ratio), || format!("errors are {ratio:.2} of what is told"))
}

fn one_sample() -> Verdict {
    let reading = light_at(&furnace(0.5), &[at(Vec3::NEG_Y, Vec3::Y)], 1)?[0];
    let holds = reading.samples == 16 && reading.stderr.x > 0.0;
    ensure(holds, || format!("{} samples, ± {}", reading.samples, reading.stderr.x))
}

fn light_after_a_bounce() -> Verdict {
    // A lamp that the floor does not see: all its light comes by way of the ceiling.
    let scene = SceneBuilder::default()
        .quad("lamp", Vec3::new(-1.0, 0.2, -1.0), [Vec3::Z * 2.0, Vec3::X * 2.0], glowing(0.0, 1.0))
        .quad("ceiling", Vec3::new(-2.0, 1.0, -2.0), [Vec3::X * 4.0, Vec3::Z * 4.0], grey(0.8))
        .build();
    let points: Vec<_> = (0..8).map(|index| at(Vec3::new(1.2 + 0.1 * index as f32, 0.2, 0.3), Vec3::Y)).collect();
    let [lights, bounces] = [Estimator::Light, Estimator::Bsdf].map(|e| light_by(&scene, &points, 1 << 14, by(e)));
    let truth = bounces?.iter().map(|reading| reading.irradiance.x).sum::<f64>() / 8.0;
    mean_reads(&lights?, truth, 0.01)
}

fn one_large_texel() -> Verdict {
    let scene = SceneBuilder::default()
        .quad("floor", Vec3::ZERO, [Vec3::Z, Vec3::X], grey(0.0))
        .quad("lamp", Vec3::Y, [Vec3::X, Vec3::Z], glowing(0.0, 1.0))
        .build();
    let mut scene = scene;
    scene.instances[1].lightmap = None;
    let transport = by(Estimator::Bsdf);
    let settings = BakeSettings { transport, goal: Goal::Samples(1 << 15), density: 1.0, ..BakeSettings::default() };
    let page = baked(&scene, &settings)?.pages.swap_remove(0);
    let texel = page.raw.iter().zip(&page.coverage).find(|(_, coverage)| **coverage > 0.99);
    let value = f64::from(texel.ok_or("no texel")?.0.x);
    let truth = parallel_rectangles(1.0, 1.0, 1.0);
    ensure((value / truth - 1.0).abs() < 0.01, || format!("E/π is {value}, not {truth}"))
}

fn smooth_light() -> Verdict {
    let scene = cornell_lamp();
    let points: Vec<_> = (0..16).map(|index| at(Vec3::new(30.0 * index as f32, 0.0, 250.0), Vec3::Y)).collect();
    let error = |samples: u32| -> Result<f64, String> {
        let readings = light_by(&scene, &points, samples, by(Estimator::Light))?;
        Ok(readings.iter().map(|reading| reading.stderr.x.powi(2)).sum::<f64>().sqrt())
    };
    let (few, many) = (error(256)?, error(64 * 256)?);
    ensure(few > 40.0 * many, || format!("the error falls from {few:.2e} to {many:.2e}"))
}

fn cancelled_in_the_middle() -> Verdict {
    let cancel = CancelToken::default();
    let (tell, hear) = channel();
    // Not in a scope, which would wait for work of hours: a thread that does not end is left to end with the process.
    std::thread::spawn({
        let cancel = cancel.clone();
        move || {
            let (scene, point) = lamp_over_a_point();
            let settings = MeterSettings { samples_per_point: u32::MAX, ..MeterSettings::default() };
            let result = measure_irradiance(&scene, &point, &settings, &(), &cancel);
            // Nobody listens once it has taken too long.
            let _ = tell.send(result);
        }
    });
    // Whenever that is, before the start or long after: what must come out is the same.
    std::thread::sleep(Duration::from_millis(100));
    cancel.cancel();
    let result = hear.recv_timeout(AT_ONCE).map_err(|error| format!("it did not end within {AT_ONCE:?}: {error}"))?;
    ensure(matches!(result, Err(BakeError::Cancelled)), || format!("it ended as {result:?}"))
}

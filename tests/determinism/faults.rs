//! Planted faults: the check of equal bits rejects what a race and a dependence on order would do to a result.

use crate::common::meter::on_walls;
use crate::common::scenes::furnace;
use crate::fingerprint::Fingerprint;
use crate::held::HELD;
use crate::vitrine::vitrine;
use bevy_kiln::bake::{CancelToken, MeterPoint, MeterReading, MeterSettings, measure_irradiance};
use bevy_kiln::math::Welford;
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Transport;
use glam::{DVec3, Vec3};

/// Any one bit of any kind of number.
#[test]
fn one_turned_bit() {
    let sound = Fingerprint::of(&HELD[1].bake(2));
    assert_eq!(sound.same(&sound.clone()), Ok(()));
    for part in 0..8 {
        for (number, bit) in [(0, 0), (1, 31), (977, 13)] {
            let faulty = sound.with_bit_turned(part, number, bit);
            let found = sound.same(&faulty).unwrap_err();
            assert!(found.starts_with("1 of "), "{found}");
            assert_ne!(sound.hash(), faulty.hash());
        }
    }
}

/// A reading at each point, whose random numbers go by the turn in which it was taken, as they would if threads drew
/// them from one counter.
fn by_turn(scene: &Scene, points: &[MeterPoint], turns: impl Iterator<Item = usize>) -> Vec<MeterReading> {
    let mut readings = vec![MeterReading::default(); points.len()];
    for (turn, index) in turns.enumerate() {
        let transport = Transport { seed: turn as u64, ..Transport::default() };
        let settings = MeterSettings { transport, samples_per_point: 16, threads: None };
        let point = [points[index]];
        readings[index] =
            measure_irradiance(scene, &point, &settings, &(), &CancelToken::default()).unwrap().readings[0];
    }
    readings
}

/// A race for random numbers: two threads take neighbouring turns the other way round.
#[test]
fn a_race_for_random_numbers() {
    let (scene, points) = (vitrine(), on_walls(Vec3::splat(-0.9), Vec3::splat(0.9), 1));
    let one = by_turn(&scene, &points, 0..6);
    let again = by_turn(&scene, &points, 0..6);
    assert_eq!(Fingerprint::of_readings(&one).same(&Fingerprint::of_readings(&again)), Ok(()));
    let raced = by_turn(&scene, &points, [0, 1, 3, 2, 4, 5].into_iter());
    let found = Fingerprint::of_readings(&one).same(&Fingerprint::of_readings(&raced)).unwrap_err();
    assert!(found.contains("readings[14]"), "{found}");
}

/// A race for places: two results that come to an end the other way round.
#[test]
fn a_race_for_places() {
    let mut lightmap = HELD[1].bake(2);
    let sound = Fingerprint::of(&lightmap);
    let raw = &mut lightmap.pages[0].raw;
    let lit: Vec<usize> = (0..raw.len()).filter(|&index| raw[index].min_element() > 0.0).collect();
    assert_ne!(raw[lit[0]], raw[lit[1]]);
    raw.swap(lit[0], lit[1]);
    assert!(sound.same(&Fingerprint::of(&lightmap)).is_err());
}

/// Sums in the order in which threads come to an end: the last bits differ.
#[test]
fn sums_in_another_order() {
    let readings = by_turn(&furnace(0.5), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), 0..24);
    let summed = |order: &mut dyn Iterator<Item = &MeterReading>| {
        let irradiance = order.map(|reading| reading.irradiance).sum::<DVec3>();
        Fingerprint::of_readings(&[MeterReading { irradiance, ..MeterReading::default() }])
    };
    let forwards = summed(&mut readings.iter());
    assert_eq!(forwards.same(&summed(&mut readings.iter())), Ok(()));
    assert!(forwards.same(&summed(&mut readings.iter().rev())).is_err());

    let part = |part: i32| (1..=part).map(|number| 1.0 / f64::from(number + part)).collect::<Welford>();
    let parts: Vec<Welford> = (3..9).map(part).collect();
    let merged = |order: &mut dyn Iterator<Item = &Welford>| {
        let mut all = Welford::default();
        order.for_each(|part| all.merge(part));
        Fingerprint::of_readings(&[MeterReading { irradiance: DVec3::splat(all.mean()), ..MeterReading::default() }])
    };
    assert!(merged(&mut parts.iter()).same(&merged(&mut parts.iter().rev())).is_err());
}

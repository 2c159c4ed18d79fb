//! What users of the mathematics rely on, by its public names alone.

#[path = "common/statistics.rs"]
mod statistics;

use bevy_kiln::math::{
    Discrete, Frame, Replicates, SphericalRectangle, combine, cosine_hemisphere_pdf, polygon_irradiance, seed32,
    square_to_cosine_hemisphere, square_to_uniform_hemisphere, uniform_hemisphere_pdf,
};
use glam::Vec3;
use statistics::{ChiSquared, Domain, Random, assert_mean, mean_within};

#[test]
fn a_tilted_frame_keeps_the_density() {
    let frame = Frame::new(Vec3::new(-0.4, 0.7, -0.2).normalize());
    let found = ChiSquared::over(Domain::Sphere).run(
        |u| frame.world_from_local(square_to_cosine_hemisphere(u)),
        |w| f64::from(cosine_hemisphere_pdf(frame.local_from_world(w))),
    );
    assert!(found.is_ok(), "{found:?}");
}

#[test]
fn the_two_hemispheres_agree_on_the_irradiance_of_a_sky() {
    // Radiance 1 + z: E = π + 2π/3. The uniform samples are noisy, so they are given a wide tolerance.
    let truth = std::f64::consts::PI * (1.0 + 2.0 / 3.0);
    let mut random = Random::new(combine(1, 2));
    let values = |random: &mut Random, sample: fn(glam::Vec2) -> Vec3, pdf: fn(Vec3) -> f32| -> Vec<f64> {
        let mut value = |_| {
            let w = sample(random.square());
            f64::from((1.0 + w.z) * w.z / pdf(w))
        };
        (0..200_000).map(&mut value).collect()
    };
    assert_mean(&values(&mut random, square_to_cosine_hemisphere, cosine_hemisphere_pdf), truth, 0.02);
    assert_mean(&values(&mut random, square_to_uniform_hemisphere, uniform_hemisphere_pdf), truth, 0.08);
}

#[test]
fn a_lamp_is_estimated_without_bias_and_with_an_honest_interval() {
    // A unit square overhead: replicates of 64 samples each; 95 % intervals hold the truth in 93 to 97 of 100.
    let seen = SphericalRectangle::new(Vec3::new(-0.5, -0.5, 0.3), Vec3::X, Vec3::Y, Vec3::ZERO).expect("it is seen");
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let height = f64::from(0.3_f32);
    let truth = polygon_irradiance(&corners.map(|(x, y)| glam::DVec3::new(x, y, height)), glam::DVec3::Z);
    let (mut covered, mut all) = (0_u32, Vec::new());
    for experiment in 0..2000 {
        let mut random = Random::new(u64::from(seed32(combine(9, experiment))));
        let mut replicate = |_| {
            let cosines = (0..64).map(|_| f64::from(seen.sample_offset(random.square()).normalize().z));
            seen.solid_angle() * cosines.sum::<f64>() / 64.0
        };
        let r = Replicates::from_means((0..16).map(&mut replicate));
        covered += u32::from((r.mean() - truth).abs() <= r.half_width_95());
        all.push(r.mean());
    }
    assert_mean(&all, truth, 2e-3 * truth);
    let share = f64::from(covered) / 2000.0;
    assert!((0.93..0.97).contains(&share), "{share}");
}

#[test]
fn choosing_by_weight_estimates_their_sum() {
    let weights = [4.0, 0.0, 1.0, 0.25, 7.0];
    let choice = Discrete::new(weights).expect("fine weights");
    let mut random = Random::new(4);
    // Zero variance: weight over probability is the sum each time.
    for _ in 0..1000 {
        let chosen = choice.sample(f64::from(random.unit()));
        let estimate = weights[chosen.index] / chosen.probability;
        assert_eq!(mean_within(estimate, 0.0, 12.25, 1e-12), Ok(()));
    }
}

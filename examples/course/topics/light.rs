//! Where the light of a point is looked for: over directions, over the area of a lamp, over a picture of the sky.

use crate::Desk;
use crate::film::{Shot, mean_luminance, rms_error, row};
use crate::scenes;
use bevy_kiln::bake::Picture;
use bevy_kiln::trace::{Estimator, Transport};

/// The rendering equation over directions and over areas.
pub fn equation(desk: &Desk) {
    let (scene, camera) = (scenes::lamp_and_ball(), scenes::above());
    let by = |estimator, samples| {
        let shot = Shot { scene: &scene, camera: &camera, size: [128; 2], samples };
        shot.take_with(Transport { estimator, max_bounces: Some(0), ..Transport::default() })
    };
    let [angular, area] = [by(Estimator::Bsdf, 2048), by(Estimator::Light, 256)];
    for (name, picture) in [("over directions", &angular), ("over the lamp's area", &area)] {
        desk.say(&format!("{name}: mean luminance {:.5} ± {:.5} cd/m²", mean_luminance(picture), mean_error(picture)));
    }
    desk.keep("equation", &row(&[angular, area]), 2.0);
}

/// Points on the lamp against directions that may meet it, at equal samples.
pub fn direct(desk: &Desk) {
    let (scene, camera) = (scenes::cornell(), scenes::cornell_low_camera());
    let shot = |samples| Shot { scene: &scene, camera: &camera, size: [96; 2], samples };
    let reference = shot(512).take_with(Transport { seed: 1, ..Transport::default() });
    let pictures = [Estimator::Bsdf, Estimator::Light, Estimator::Mis].map(|estimator| {
        let picture = shot(16).take_by(estimator);
        desk.say(&format!("16 paths, {estimator:?}: rms error {:.1} %", 100.0 * rms_error(&picture, &reference)));
        picture
    });
    desk.keep("direct", &row(&pictures), 0.7);
}

/// The sky's picture by its brightness against directions that may meet its sun, at equal samples.
pub fn environment(desk: &Desk) {
    let (scene, camera) = (scenes::sunny(), scenes::above());
    let shot = |samples| Shot { scene: &scene, camera: &camera, size: [96; 2], samples };
    let reference = shot(1024).take_with(Transport { seed: 1, ..Transport::default() });
    let mut pictures = [Estimator::Bsdf, Estimator::Mis].map(|estimator| shot(64).take_by(estimator)).to_vec();
    for (name, picture) in ["over directions", "and by brightness"].into_iter().zip(&pictures) {
        desk.say(&format!("64 paths {name}: rms error {:.1} %", 100.0 * rms_error(picture, &reference)));
    }
    pictures.push(reference);
    desk.keep("environment", &row(&pictures), 2.2);
}

/// Standard error of the mean luminance, from the pixels' own.
fn mean_error(picture: &Picture) -> f64 {
    let squares: f64 = picture.stderr.iter().map(|&error| bevy_kiln::math::luminance(error).powi(2)).sum();
    squares.sqrt() / picture.stderr.len() as f64
}

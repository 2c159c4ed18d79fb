//! Error against samples, from 10 paths to a million.

use crate::Desk;
use crate::film::{Shot, enlarge, rms_error, row, slope};
use crate::scenes;
use bevy_kiln::scene::Camera;
use bevy_kiln::trace::Transport;
use glam::Vec3;

/// Paths through a pixel of the whole box.
const WHOLE: [u32; 4] = [10, 100, 1000, 10_000];

/// Paths through a pixel of the piece; the last is the reference.
const PIECE: [u32; 6] = [10, 100, 1000, 10_000, 100_000, 1_000_000];

/// Width of the piece [pixels], and how much larger it is shown. A million paths through each pixel are dear.
const PIECE_SIZE: u32 = 4;
const ENLARGED: u32 = 24;

/// The Cornell box and a piece of it, from 10 to a million paths.
pub fn convergence(desk: &Desk) {
    let scene = scenes::cornell();
    let camera = scenes::cornell_camera();
    let whole = WHOLE.map(|samples| {
        desk.say(&format!("the whole at {samples} paths"));
        Shot { scene: &scene, camera: &camera, size: [96; 2], samples }.take()
    });
    desk.keep("convergence", &row(&whole), 0.7);
    // On the floor between the blocks, as large as four pixels of the whole.
    let eye = Vec3::from(camera.world_from_camera.translation);
    let fov = camera.vertical_fov * PIECE_SIZE as f32 / 96.0;
    let piece = Camera::look_at("piece", eye, Vec3::new(2.95, 0.0, 2.6), fov);
    let pictures = PIECE.map(|samples| {
        let shot = Shot { scene: &scene, camera: &piece, size: [PIECE_SIZE; 2], samples };
        // Seeds of their own: else the reference would hold the others' paths.
        let picture = shot.take_with(Transport { seed: u64::from(samples), ..Transport::default() });
        desk.say(&format!("the piece at {samples} paths"));
        picture
    });
    let reference = &pictures[PIECE.len() - 1];
    let traced = |samples: u32| f64::from(samples.next_multiple_of(bevy_kiln::bake::REPLICATES));
    let points: Vec<(f64, f64)> = PIECE[..PIECE.len() - 1]
        .iter()
        .zip(&pictures)
        .map(|(&samples, picture)| (traced(samples), rms_error(picture, reference)))
        .collect();
    for (samples, error) in &points {
        desk.say(&format!("{samples} paths: rms error {:.4} %", 100.0 * error));
    }
    desk.say(&format!("slope {:.3}", slope(&points)));
    desk.keep("convergence_piece", &row(&pictures.map(|picture| enlarge(&picture, ENLARGED))), 0.6);
}

//! What surfaces do with light: frames, ways to scatter, a caustic, and the box that has it all.

use crate::Desk;
use crate::film::{Shot, mean_luminance, row};
use crate::scenes;
use bevy_kiln::scene::Camera;
use glam::Vec3;

/// A flat wall, the same with relief, and the relief's texture turned by a quarter: the light stays on the left.
pub fn frames(desk: &Desk) {
    let camera = Camera::look_at("wall", Vec3::Z * 5.0, Vec3::ZERO, 0.4);
    let pictures = [None, Some(0), Some(1)].map(|turns| {
        let scene = scenes::relief(turns);
        Shot { scene: &scene, camera: &camera, size: [96; 2], samples: 64 }.take()
    });
    desk.keep("frames", &row(&pictures), 1.1);
}

/// Lambert, mirror, modified Phong, glass and Bevy's standard surface as gold.
pub fn materials(desk: &Desk) {
    let (scene, camera) = (scenes::materials(), scenes::materials_camera());
    let picture = Shot { scene: &scene, camera: &camera, size: [256, 112], samples: 384 }.take();
    desk.keep("materials", &picture, 2.0);
}

/// Light through a ball of glass.
pub fn caustic(desk: &Desk) {
    let camera = Camera::look_at("caustic", Vec3::new(1.2, 2.2, 4.6), Vec3::new(0.2, 0.45, 0.0), 0.55);
    let scene = scenes::caustic(Some(scenes::glass()));
    let picture = Shot { scene: &scene, camera: &camera, size: [160, 128], samples: 1024 }.take();
    desk.keep("caustic", &picture, 1.2);
}

/// The Cornell box.
pub fn cornell(desk: &Desk) {
    let (scene, camera) = (scenes::cornell(), scenes::cornell_camera());
    let picture = Shot { scene: &scene, camera: &camera, size: [192; 2], samples: 256 }.take();
    desk.say(&format!("mean luminance {:.4} cd/m²", mean_luminance(&picture)));
    desk.keep("cornell", &picture, 0.7);
}

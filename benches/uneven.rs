//! Scenes of which most texels are easy and a few are hard, as in a game: where light is found at once nearly
//! everywhere and only by luck in a corner of them. For the bench of what sampling to an error gains.

use crate::common::scenes::{SceneBuilder, grey};
use bevy_kiln::scene::Scene;
use glam::{Vec2, Vec3};

const UP: Vec3 = Vec3::Y;

/// Adds a wall without a thickness that is seen from both sides.
fn sheet(builder: SceneBuilder, name: &str, corner: Vec3, [u, v]: [Vec3; 2]) -> SceneBuilder {
    builder.quad(name, corner, [u, v], grey(0.6)).quad(&format!("{name}, behind"), corner, [v, u], grey(0.6))
}

/// Four walls and a roof over the floor, with a door of `door` × 2 m in the wall of the largest z.
fn hut(mut builder: SceneBuilder, low: Vec3, size: Vec3, door: f32) -> SceneBuilder {
    let [x, y, z] = [Vec3::X * size, Vec3::Y * size, Vec3::Z * size];
    let post = Vec3::X * (0.5 * (size.x - door));
    let front = low + z;
    let sides = [
        ("left", low, [y, z]),
        ("right", low + x, [z, y]),
        ("back", low, [x, y]),
        ("roof", low + y, [x, z]),
        ("left of the door", front, [y, post]),
        ("right of the door", front + x - post, [y, post]),
        ("over the door", front + post + 2.0 * UP, [y - 2.0 * UP, Vec3::X * door]),
    ];
    for (name, corner, edges) in sides {
        builder = sheet(builder, name, corner, edges);
    }
    builder
}

/// A yard under the sky, and in it a shed whose door is ajar.
pub fn shed() -> Scene {
    let ground = [Vec3::Z * 12.0, Vec3::X * 12.0];
    let yard = SceneBuilder::default().quad("ground", Vec3::ZERO, ground, grey(0.5)).sky(Vec3::splat(10.0));
    hut(yard, Vec3::new(5.0, 0.0, 5.0), Vec3::new(2.0, 2.3, 2.0), 0.3).build()
}

/// A room with a lamp, and in it a closet whose door is ajar.
pub fn closet() -> Scene {
    let room = SceneBuilder::default()
        .room(Vec3::ZERO, Vec3::new(6.0, 3.0, 6.0), std::array::from_fn(|_| grey(0.6)))
        .rect_light("lamp", Vec3::new(3.5, 2.9, 4.0), -UP, Vec2::splat(0.5), Vec3::splat(100.0));
    hut(room, Vec3::new(0.5, 0.0, 0.5), Vec3::new(1.5, 2.3, 1.5), 0.2).build()
}

/// A street under the sky that goes through an underpass.
pub fn underpass() -> Scene {
    let (along, up, across) = (Vec3::X * 14.0, UP * 2.5, Vec3::Z * 3.0);
    let low = Vec3::new(13.0, 0.0, 4.5);
    let mut street = SceneBuilder::default()
        .quad("street", Vec3::ZERO, [Vec3::Z * 12.0, Vec3::X * 40.0], grey(0.3))
        .sky(Vec3::splat(10.0));
    for (name, corner, edges) in
        [("left", low, [along, up]), ("right", low + across, [up, along]), ("roof", low + up, [along, across])]
    {
        street = sheet(street, name, corner, edges);
    }
    street.build()
}

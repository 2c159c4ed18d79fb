//! Scenes of different difficulty, each of a few hundred texels.

use crate::common::garden;
use crate::common::scenes::{SceneBuilder, grey};
use crate::denoise_scenes;
use bevy_kiln::bake::Layout;
use bevy_kiln::scene::Scene;
use glam::Vec3;

/// A scene, and how it is baked.
pub struct Case {
    pub name: &'static str,
    pub scene: Scene,
    pub layout: Layout,
    /// Texels per metre, for those that are packed.
    pub density: f32,
    /// Errors that are asked for; the least is ten times what the reference is off by.
    pub targets: [f64; 3],
    /// Paths of each texel of the reference.
    pub long: u32,
}

/// All of them.
pub fn all() -> [Case; 5] {
    [cornell(), sunlit(), lamps(), garden(), slit()]
}

pub fn cornell() -> Case {
    shared(denoise_scenes::cornell(), [0.1, 0.05, 0.02], 1 << 18)
}

pub fn sunlit() -> Case {
    shared(denoise_scenes::sunlit(), [0.2, 0.1, 0.05], 1 << 19)
}

pub fn lamps() -> Case {
    shared(denoise_scenes::lamps(), [0.1, 0.05, 0.02], 1 << 17)
}

pub fn garden() -> Case {
    packed("garden", garden::garden(), 6.0, [0.1, 0.05, 0.02], 1 << 17)
}

pub fn slit() -> Case {
    packed("slit", room_behind_a_slit(), 3.0, [0.2, 0.1, 0.06], 1 << 20)
}

fn shared(case: denoise_scenes::Case, targets: [f64; 3], long: u32) -> Case {
    let layout = Layout::Shared { size: 24 };
    Case { name: case.name, scene: case.scene, layout, density: 1.0, targets, long }
}

fn packed(name: &'static str, scene: Scene, density: f32, targets: [f64; 3], long: u32) -> Case {
    Case { name, scene, layout: Layout::Packed, density, targets, long }
}

/// A grey room under a bright sky that enters by a slit in one wall and no other way: nearly all light is indirect.
fn room_behind_a_slit() -> Scene {
    let wall = || grey(0.6);
    let (x, y, z) = (Vec3::X * 2.0, Vec3::Y * 2.0, Vec3::Z * 2.0);
    SceneBuilder::default()
        .quad("floor", Vec3::ZERO, [z, x], wall())
        .quad("ceiling", y, [x, z], wall())
        .quad("back", Vec3::ZERO, [x, y], wall())
        .quad("left", Vec3::ZERO, [y, z], wall())
        .quad("right", x, [z, y], wall())
        .quad("front low", z, [y * 0.8, x], wall())
        .quad("front high", z + y * 0.9, [y * 0.1, x], wall())
        .sky(Vec3::splat(10.0))
        .build()
}

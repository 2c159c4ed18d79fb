//! Scenes of different difficulty, each of a few hundred texels.

use crate::common::garden::garden;
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
    /// Paths of each texel of the reference.
    pub long: u32,
}

/// All of them.
pub fn all() -> [Case; 5] {
    let shared = |case: denoise_scenes::Case, size, long| {
        let layout = Layout::Shared { size };
        Case { name: case.name, scene: case.scene, layout, density: 1.0, long }
    };
    let packed = |name, scene, density, long| Case { name, scene, layout: Layout::Packed, density, long };
    [
        shared(denoise_scenes::cornell(), 24, 1 << 18),
        shared(denoise_scenes::sunlit(), 24, 1 << 18),
        shared(denoise_scenes::lamps(), 24, 1 << 17),
        packed("garden", garden(), 6.0, 1 << 17),
        packed("slit", slit(), 3.0, 1 << 18),
    ]
}

/// A grey room under a bright sky that enters by a slit in one wall and no other way: nearly all light is indirect.
fn slit() -> Scene {
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

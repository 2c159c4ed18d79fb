//! Balances of whole bakes: what is absorbed over what is given off.

use super::CUT;
use crate::case::{Case, Verdict};
use crate::common::glb;
use crate::common::scenes::{SceneBuilder, glowing, grey, lit_room};
use crate::guards::path::{SURVIVAL_AT_MOST_ONE, SURVIVORS_STAND_IN};
use crate::judge::{baked, ensure};
use crate::things::sphere;
use crate::worlds::joined;
use bevy_kiln::bake::{BakeSettings, Goal};
use bevy_kiln::scene::Scene;
use glam::Vec3;

pub const CASES: &[Case] = &[
    Case {
        name: "balance_of_a_white_room",
        hard: "a lamp's light is absorbed after twenty bounces on average",
        elsewhere: CUT,
        holds: "absorbed over emitted flux is 1 to 1 %, ρ = 0.95: the noise of 256 paths a texel",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: "light is lost on the way",
        check: || balances(&lit_room(0.95, 10.0), 0.5, 1e-2),
    },
    Case {
        name: "balance_of_the_cornell_box_closed",
        hard: "coloured walls and blocks, the box's front closed by a wall of albedo ½",
        elsewhere: CUT,
        holds: "absorbed over emitted flux is 1 to 1 %: the noise of 256 paths a texel",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost",
        check: || balances(&cornell_closed(), 1.0, 1e-2),
    },
    Case {
        name: "balance_of_spheres_in_each_other",
        hard: "4096 triangles without a lightmap around a glowing sphere: both sides of all are points spread by area",
        elsewhere: "a balance of what has texels alone",
        holds: "absorbed over emitted flux is 1 to 2 %, ρ = 0.8: the noise of 256 paths a texel",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost",
        check: || balances(&spheres(), 1.0, 2e-2),
    },
];

fn balances(scene: &Scene, density: f32, tolerance: f64) -> Verdict {
    let settings = BakeSettings { goal: Goal::Samples(256), density, ..BakeSettings::default() };
    let balance = baked(scene, &settings)?.report.energy_balance;
    ensure(balance.is_some_and(|balance| (balance - 1.0).abs() <= tolerance), || {
        format!("absorbed over emitted flux: {balance:?}")
    })
}

fn cornell_closed() -> Scene {
    let scene = glb::load("cornell");
    let positions = || scene.meshes.iter().flat_map(|mesh| mesh.positions.iter().copied());
    let low = positions().fold(Vec3::INFINITY, Vec3::min);
    let high = positions().fold(Vec3::NEG_INFINITY, Vec3::max);
    let size = high - low;
    // A box around all, against which the open front looks; the gap between is part of the closed scene.
    let mut shell = SceneBuilder::default().room(low - 0.01 * size, high + 0.01 * size, [0.5; 6].map(grey)).build();
    shell.instances.iter_mut().for_each(|side| side.lightmap = None);
    joined(scene, shell)
}

fn spheres() -> Scene {
    let (inner, outer) = (sphere(Vec3::ZERO, 0.25, 3), sphere(Vec3::ZERO, 1.0, 4));
    SceneBuilder::default()
        .mesh("inner", inner.0, inner.1, None, glowing(0.0, 1.0))
        .mesh("outer", outer.0, outer.1, None, grey(0.8))
        .quad("probe", Vec3::new(0.5, -0.01, -0.01), [0.02 * Vec3::Z, 0.02 * Vec3::X], grey(0.5))
        .build()
}

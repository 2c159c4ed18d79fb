//! Worlds of millimetres and of kilometres.

use crate::case::{Case, Verdict};
use crate::cases::SELF_SHADOW;
use crate::common::meter::on_walls;
use crate::common::scenes::{SceneBuilder, furnace, grey};
use crate::guards::rays::{NO_CONSTANT, ORIGIN_MOVE, TREE_UNITS};
use crate::guards::scene::TEXELS_IN_WORLD;
use crate::judge::{SameRoom, baked, ensure, texels};
use crate::look::{FURNACE_HOLDS, furnace_of_0_8};
use crate::worlds::{askew, points_under, room, under};
use bevy_kiln::bake::{BakeSettings, Goal};
use glam::{Affine3A, Vec3};
use std::f64::consts::PI;

const FURNACE: &str = "rays that start in a corner of a closed room lie within rounding of the next wall; no wall lies \
                       along an axis, so that every point has an error off its plane";
const LARGE_BIAS: &str = "an absolute ray bias is lost in rounding: surfaces meet their own rays";
const SMALL_BIAS: &str = "an absolute ray bias (Godot: 0.5 mm, Fyrox: 10 mm) starts rays behind walls: light leaks out";
const ROOM: &str = "a room with a lamp and a board, askew: all lengths and all errors are scaled";
const ROOM_HOLDS: &str = "the mean texel is that of the room of 2 m to 0.5 %: the same random numbers, other rounding; and \
                          that of a room along the axes to 3 %: other random numbers";

pub const CASES: &[Case] = &[
    Case {
        name: "a_furnace_of_2_mm",
        hard: FURNACE,
        elsewhere: SMALL_BIAS,
        holds: FURNACE_HOLDS,
        guard: &TREE_UNITS,
        without: "rays from corners leave the room, E is too low",
        check: || furnace_of_scale(1e-3),
    },
    Case {
        name: "a_furnace_of_2_cm",
        hard: FURNACE,
        elsewhere: SMALL_BIAS,
        holds: FURNACE_HOLDS,
        guard: &NO_CONSTANT,
        without: "rays start behind the next wall and leave the room",
        check: || furnace_of_scale(1e-2),
    },
    Case {
        name: "a_furnace_of_200_m",
        hard: FURNACE,
        elsewhere: LARGE_BIAS,
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_of_scale(1e2),
    },
    Case {
        name: "a_furnace_of_2_km",
        hard: FURNACE,
        elsewhere: LARGE_BIAS,
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_of_scale(1e3),
    },
    Case {
        name: "a_furnace_of_20_km",
        hard: FURNACE,
        elsewhere: LARGE_BIAS,
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_of_scale(1e4),
    },
    Case {
        name: "a_room_of_2_mm",
        hard: ROOM,
        elsewhere: SMALL_BIAS,
        holds: ROOM_HOLDS,
        guard: &NO_CONSTANT,
        without: "rays start outside of the room, which is dark",
        check: || room_of_scale(1e-3),
    },
    Case {
        name: "a_room_of_2_cm",
        hard: ROOM,
        elsewhere: SMALL_BIAS,
        holds: ROOM_HOLDS,
        guard: &NO_CONSTANT,
        without: "rays start beyond the lamp and behind walls",
        check: || room_of_scale(1e-2),
    },
    Case {
        name: "a_room_of_2_km",
        hard: ROOM,
        elsewhere: LARGE_BIAS,
        holds: ROOM_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_of_scale(1e3),
    },
    Case {
        name: "a_room_of_20_km",
        hard: ROOM,
        elsewhere: LARGE_BIAS,
        holds: ROOM_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_of_scale(1e4),
    },
    Case {
        name: "texels_under_a_scaled_root",
        hard: "the scale stands in the root, not in the mesh",
        elsewhere: "lightmap sizes by the mesh's own lengths: a model at scale 4 has a quarter of its texels",
        holds: "under a root of scale 4 a quad has four times the texels along each side, at scale 1e-3 the least, 2",
        guard: &TEXELS_IN_WORLD,
        without: "the number of texels is that of the mesh",
        check: || {
            let scaled = |scale| Affine3A::from_scale(Vec3::splat(scale));
            texels_of(scaled(4.0), 36 * 36).and(texels_of(scaled(1e-3), 2 * 2))
        },
    },
    Case {
        name: "texels_under_nested_scales",
        hard: "a scale on one axis within a turn within a scale on another: the quad is sheared to a parallelogram",
        elsewhere: "the length of a scale vector is taken for the stretch",
        holds: "sides get √(mean square stretch) texels each: 10 along u and 32 along v at 9 per metre",
        guard: &TEXELS_IN_WORLD,
        without: "the number of texels is that of the mesh",
        check: || texels_of(nested(), 10 * 32),
    },
];

fn furnace_of_scale(scale: f32) -> Verdict {
    let root = Affine3A::from_quat(askew()) * Affine3A::from_scale(Vec3::splat(scale));
    let points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), root);
    furnace_of_0_8(&under(furnace(0.8), root), &points)
}

fn room_of_scale(scale: f32) -> Verdict {
    let there = under(room(), Affine3A::from_scale(Vec3::splat(scale)));
    SameRoom { here: &room(), there: &there, scale, density: 4.7, tolerance: 5e-3 }.holds()
}

fn nested() -> Affine3A {
    Affine3A::from_scale(Vec3::new(4.0, 1.0, 1.0))
        * Affine3A::from_rotation_y(PI as f32 / 6.0)
        * Affine3A::from_scale(Vec3::new(1.0, 1.0, 0.5))
}

/// Whether a square of 1 m has this many texels under this root, 9 per metre, and no other light for that.
fn texels_of(root: Affine3A, expected: usize) -> Verdict {
    let quad = SceneBuilder::default().quad("quad", Vec3::ZERO, [Vec3::Z, Vec3::X], grey(0.5)).sky(Vec3::ONE).build();
    let settings = BakeSettings { goal: Goal::Samples(64), density: 9.0, ..BakeSettings::default() };
    let (count, mean) = texels(&baked(&under(quad, root), &settings)?);
    ensure(count == expected, || format!("{count} texels, not {expected}"))?;
    ensure((mean - 1.0).abs() < 1e-3, || format!("the mean texel is {mean}, not 1"))
}

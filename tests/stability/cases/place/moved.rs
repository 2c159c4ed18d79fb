//! Worlds far from the origin, and worlds that are turned.

use crate::case::{Case, Verdict};
use crate::cases::SELF_SHADOW;
use crate::common::meter::on_walls;
use crate::common::scenes::furnace;
use crate::guards::rays::ORIGIN_MOVE;
use crate::judge::{SameRoom, agree, light_at, mean_of};
use crate::look::{FURNACE_HOLDS, furnace_of_0_8};
use crate::worlds::{askew, in_the_room, level_room, points_under, room, rounded_by, under};
use glam::{Affine3A, DVec3, Quat, Vec3};
use std::f64::consts::PI;

const TURNED_HOLDS: &str = "the mean light at four points is that of the room along the axes within 2 %";
const MOVED_HOLDS: &str = "the mean texel is that of the room whose vertices are rounded so, at home, to 0.5 %: the \
                           step moves vertices, and nothing else; and that of a room along the axes to 3 %: \
                           other random numbers";
const REPORTED: &str = "reported for the usual offset: shadow acne at a translation of 10 000";
const FLOATING_ORIGIN: &str = "games move the world instead (floating origin); bakers do not";

pub const CASES: &[Case] = &[
    Case {
        name: "a_room_1_km_away",
        hard: "f32 has steps of 61 µm there",
        elsewhere: "an offset without the coordinates' error (Ray Tracing Gems, chapter 6, with a transform) fails",
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::new(1e3, 0.0, 0.0)),
    },
    Case {
        name: "a_room_10_km_away",
        hard: "f32 has steps of 1 mm there, along one axis",
        elsewhere: REPORTED,
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::new(0.0, 0.0, -1e4)),
    },
    Case {
        name: "a_room_10_km_away_on_all_axes",
        hard: "f32 has steps of 1 mm there, along every axis",
        elsewhere: REPORTED,
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::splat(1e4)),
    },
    Case {
        name: "a_room_100_km_away",
        hard: "f32 has steps of 7.8 mm there: points on a wall are off by several times that along its normal",
        elsewhere: FLOATING_ORIGIN,
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::new(1e5, 0.0, 0.0)),
    },
    Case {
        name: "a_room_100_km_away_on_all_axes",
        hard: "f32 has steps of 7.8 mm there, along every axis",
        elsewhere: FLOATING_ORIGIN,
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::splat(-1e5)),
    },
    Case {
        name: "a_furnace_100_km_away",
        hard: "its walls are crooked by steps of 7.8 mm, but it is closed whatever its vertices are",
        elsewhere: "a bias below the step does not leave the wall; one above it leaves the room",
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_at(DVec3::splat(1e5)),
    },
    Case {
        name: "a_world_turned_by_a_ten_thousandth",
        hard: "walls that lie along an axis nearly, so that coordinates differ in their last digits only",
        elsewhere: "tests with axis-aligned walls see no error off the plane",
        holds: TURNED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_turned(Quat::from_rotation_z(1e-4) * Quat::from_rotation_x(1e-4) * askew().inverse()),
    },
    Case {
        name: "a_world_turned_by_45_degrees",
        hard: "walls whose normals have two equal components: their rays run along diagonals of the tree's boxes",
        elsewhere: "a bias along the dominant axis alone is too short by √2",
        holds: TURNED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_turned(Quat::from_rotation_z(PI as f32 / 4.0) * askew().inverse()),
    },
    Case {
        name: "a_world_turned_upside_down",
        hard: "a half turn about an axis that is none of the world's: no coordinate stays",
        elsewhere: "a frame or a pole that is taken from world up (Y) changes the light",
        holds: TURNED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_turned(Quat::from_axis_angle(Vec3::new(0.8, 0.0, 0.6), 3.1)),
    },
];

/// The room moved away, against the room with its vertices rounded as they are there.
fn room_at(offset: DVec3) -> Verdict {
    let there = under(room(), Affine3A::from_translation(offset.as_vec3()));
    SameRoom { here: &rounded_by(room(), offset), there: &there, scale: 1.0, density: 4.7, tolerance: 5e-3 }.holds()
}

fn furnace_at(offset: DVec3) -> Verdict {
    let root = Affine3A::from_rotation_translation(askew(), offset.as_vec3());
    let points = points_under(&on_walls(Vec3::splat(-0.9), Vec3::splat(0.9), 2), root);
    furnace_of_0_8(&under(furnace(0.8), root), &points)
}

/// The light in the room under a turn, against that in the level room.
fn room_turned(turn: Quat) -> Verdict {
    let turn = Affine3A::from_quat(turn);
    let back = Affine3A::from_quat(askew().inverse());
    let here = mean_of(&light_at(&level_room(), &points_under(&in_the_room(), back), 1 << 13)?);
    let there = mean_of(&light_at(&under(room(), turn), &points_under(&in_the_room(), turn), 1 << 13)?);
    agree(&there, &here, 0.02)
}

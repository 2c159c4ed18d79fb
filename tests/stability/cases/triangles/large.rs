//! Very many triangles, and triangles very far away.

use super::has_the_light_of_the_room;
use crate::case::{Case, Verdict};
use crate::cases::SELF_SHADOW;
use crate::common::meter::on_walls;
use crate::common::scenes::{SceneBuilder, furnace, glowing, grey};
use crate::guards::rays::ORIGIN_MOVE;
use crate::guards::scene::VALIDATED;
use crate::judge::{is_refused, light_at, mean_reads};
use crate::look::{FURNACE_HOLDS, furnace_of_0_8};
use crate::worlds::{askew, askew_aside, joined, points_under, room};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{Instance, Scene};
use glam::{Affine3A, Mat3, Vec3};
use std::f64::consts::PI;

const FAR_REFUSED: &str = "refused by name: a vertex beyond 1e9 m would take the order from what lies nearer to each \
                           other than 1e-13 of that; the mean texel of the room beside it is that of the room alone to \
                           1e-3";

pub const CASES: &[Case] = &[
    Case {
        name: "a_hundred_thousand_instances",
        hard: "98 304 glowing instances of one square are the walls of a furnace, each corner rounded four times",
        elsewhere: "a tree or a light list per instance; cracks between instances",
        holds: "E = π/(1 − ρ) within 0.8 %, ρ = 0.5: gaps of a step (5e-7 m) around tiles of 16 mm lose 1e-4",
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: hundred_thousand,
    },
    Case {
        name: "a_furnace_of_a_million_km",
        hard: "coordinates of 9e8 m, farther than the moon, with steps of 64 m",
        elsewhere: "edge functions or areas overflow: light leaks or is NaN",
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_of(5e8),
    },
    Case {
        name: "a_room_beside_triangles_at_900_000_km",
        hard: "a scene 1e9 times as large as the room in it",
        elsewhere: "errors and boxes by the scene's size: walls are 100 m thick",
        holds: "the mean texel is that of the room alone to 1e-3, by the same random numbers: errors are each \
                triangle's own",
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || beside(9e8),
    },
    Case {
        name: "vertices_at_1e15",
        hard: "a scene 1e15 times as large as the room in it: for the tree the room is one point",
        elsewhere: "a sky dome far out takes all precision, silently",
        holds: FAR_REFUSED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || far_is_refused(1e15),
    },
    Case {
        name: "vertices_at_1e30",
        hard: "coordinates whose square no f32 holds",
        elsewhere: "areas of boxes overflow: a tree over NaN",
        holds: FAR_REFUSED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || far_is_refused(1e30),
    },
    Case {
        name: "boxes_that_overflow",
        hard: "triangles at 3e38 m on either side: their distance is infinite in f32",
        elsewhere: "a tree over infinities",
        holds: FAR_REFUSED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || far_is_refused(3e38),
    },
];

/// A furnace whose walls are 98 304 instances of one square.
fn hundred_thousand() -> Verdict {
    let (count, root) = (128, askew_aside());
    let mut scene = SceneBuilder::default().quad("tile", Vec3::ZERO, [Vec3::X, Vec3::Y], glowing(0.5, 1.0)).build();
    scene.instances.clear();
    let pitch = 2.0 / count as f32;
    // The sides of a cube: a half turn, and quarter turns to either side, exactly.
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    let sides = [[x, y, z], [-x, y, -z], [z, y, -x], [-z, y, x], [x, z, -y], [x, -z, y]];
    for (side, [x, y, z]) in sides.into_iter().enumerate() {
        let side_root = root * Affine3A::from_mat3(Mat3::from_cols(x, y, z));
        for tile in 0..count * count {
            let corner = Vec3::new((tile % count) as f32 * pitch - 1.0, (tile / count) as f32 * pitch - 1.0, -1.0);
            let own = Affine3A::from_translation(corner) * Affine3A::from_scale(Vec3::splat(pitch));
            let id = StableId::new(format!("{side} {tile}"));
            let name = "tile".to_owned();
            scene.instances.push(Instance {
                id,
                name,
                mesh: 0,
                material: 0,
                world_from_local: side_root * own,
                lightmap: None,
            });
        }
    }
    let points = points_under(&off_centre(), root);
    mean_reads(&light_at(&scene, &points, 1 << 11)?, PI / 0.5, 8e-3)
}

/// A point on each wall, not on the border of a tile.
fn off_centre() -> Vec<MeterPoint> {
    let mut points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 1);
    for point in &mut points {
        point.position += 0.0131 * (Vec3::ONE - point.normal.abs());
    }
    points
}

/// A furnace whose vertices are this far away, in the mesh itself.
fn furnace_of(scale: f32) -> Verdict {
    let turn = Affine3A::from_quat(askew());
    let mut scene = furnace(0.8);
    for position in scene.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
        *position = scale * turn.transform_point3(*position);
    }
    let mut points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), turn);
    points.iter_mut().for_each(|point| point.position *= scale);
    furnace_of_0_8(&scene, &points)
}

/// The room in a world with two triangles this far away on either side.
fn room_beside(distance: f32) -> Scene {
    let far = |side: f32| {
        [Vec3::ONE, Vec3::new(1.0, 0.5, 1.0), Vec3::new(0.5, 1.0, 1.0)].map(|way| side * distance * way).to_vec()
    };
    let others = SceneBuilder::default()
        .mesh("far", far(1.0), vec![0, 1, 2], None, grey(0.5))
        .mesh("farther", far(-1.0), vec![0, 1, 2], None, grey(0.5))
        .unchecked();
    joined(room(), others)
}

fn beside(distance: f32) -> Verdict {
    has_the_light_of_the_room(&room_beside(distance))
}

/// Both triangles are refused, and the room has its own light.
fn far_is_refused(distance: f32) -> Verdict {
    let scene = room_beside(distance);
    is_refused(&scene, &format!("instance \"far\" has a vertex {:.1e} m", distance))?;
    is_refused(&scene, &format!("instance \"farther\" has a vertex {:.1e} m", distance))?;
    beside(distance)
}

//! Size and place of the world: light does not know how large a scene is, where it stands or how bright it is.

use crate::case::{Case, Verdict};
use crate::common::meter::on_walls;
use crate::common::scenes::furnace;
use crate::guards::light::FULL_SUMS;
use crate::guards::rays::{ORIGIN_MOVE, TREE_UNITS};
use crate::judge::{agree, all_read, baked, ensure, light_at, light_by, mean_reads, same_but_for_rounding};
use crate::worlds::{askew, bulb, in_the_room, lit_by, points_under, rectangle, room, rounded_by, spot, sun, under};
use bevy_kiln::bake::BakeSettings;
use bevy_kiln::scene::Scene;
use glam::{Affine3A, DVec3, Quat, Vec3};
use std::f64::consts::PI;

pub const CASES: &[Case] = &[
    Case { name: "f-3", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || furnace_of_scale(1e-3) },
    Case { name: "f-2", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || furnace_of_scale(1e-2) },
    Case { name: "f2", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || furnace_of_scale(1e2) },
    Case { name: "f4", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || furnace_of_scale(1e4) },
    Case { name: "r-3", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || room_under(Affine3A::from_scale(Vec3::splat(1e-3))) },
    Case { name: "r4", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || room_under(Affine3A::from_scale(Vec3::splat(1e4))) },
    Case { name: "m3", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || room_at(DVec3::new(1e3, 0.0, 0.0)) },
    Case { name: "m4", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || room_at(DVec3::splat(1e4)) },
    Case { name: "m5", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || room_at(DVec3::new(1e5, 0.0, 0.0)) },
    Case { name: "m53", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || room_at(DVec3::splat(-1e5)) },
    Case { name: "fm5", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || furnace_at(DVec3::splat(1e5)) },
    Case { name: "bm5", hard: "x", elsewhere: "x", holds: "x", guard: &TREE_UNITS, without: "x", check: || bake_at(DVec3::splat(1e5)) },
];

fn furnace_of_scale(scale: f32) -> Verdict {
    let root = Affine3A::from_quat(askew()) * Affine3A::from_scale(Vec3::splat(scale));
    let points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), root);
    mean_reads(&light_at(&under(furnace(0.8), root), &points, 1 << 11)?, PI / 0.2, 3e-3)
}

/// The light in the room under a root, against the room.
fn room_under(root: Affine3A) -> Verdict {
    let here = light_at(&room(), &in_the_room(), 1 << 12)?;
    let there = light_at(&under(room(), root), &points_under(&in_the_room(), root), 1 << 12)?;
    here.iter().zip(&there).try_for_each(|(here, there)| agree(there, here, 0.03))
}

/// The light in the room moved away, against that of the room with its vertices rounded as they are there.
fn room_at(offset: DVec3) -> Verdict {
    let root = Affine3A::from_translation(offset.as_vec3());
    let there = light_at(&under(room(), root), &points_under(&in_the_room(), root), 1 << 12)?;
    let here = light_at(&rounded_by(room(), offset), &in_the_room(), 1 << 12)?;
    here.iter().zip(&there).try_for_each(|(here, there)| agree(there, here, 0.03))
}

fn furnace_at(offset: DVec3) -> Verdict {
    let root = Affine3A::from_rotation_translation(askew(), offset.as_vec3());
    let points = points_under(&on_walls(Vec3::splat(-0.9), Vec3::splat(0.9), 2), root);
    mean_reads(&light_at(&under(furnace(0.8), root), &points, 1 << 11)?, PI / 0.2, 3e-3)
}

fn mean_texel(scene: &Scene) -> Result<f64, String> {
    let page = baked(scene, &BakeSettings { samples_per_texel: 256, density: 3.0, ..BakeSettings::default() })?.pages;
    let texels = page[0].raw.iter().zip(&page[0].coverage).filter(|(_, coverage)| **coverage > 0.0);
    let texels: Vec<f64> = texels.map(|(raw, _)| f64::from(raw.x)).collect();
    Ok(texels.iter().sum::<f64>() / texels.len() as f64)
}

fn bake_at(offset: DVec3) -> Verdict {
    let there = mean_texel(&under(room(), Affine3A::from_translation(offset.as_vec3())))?;
    let here = mean_texel(&rounded_by(room(), offset))?;
    Err(format!("{there} {here}"))
}

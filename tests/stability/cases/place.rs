//! Size and place of the world: light does not know how large a scene is, where it stands or how bright it is.

use crate::case::{Case, Verdict};
use crate::common::meter::on_walls;
use crate::common::scenes::furnace;
use crate::guards::rays::{ORIGIN_MOVE, TREE_UNITS};
use crate::judge::{light_at, mean_reads};
use bevy_kiln::scene::Scene;
use glam::{Affine3A, Vec3};
use std::f64::consts::PI;

const CLOSED_ROOM: &str = "rays that start in a corner lie within rounding of the next wall";

pub const CASES: &[Case] = &[
    Case {
        name: "a_furnace_of_2_mm",
        hard: CLOSED_ROOM,
        elsewhere: "an absolute ray bias (Godot: 0.5 mm, Fyrox: 10 mm) starts rays behind walls: light leaks out",
        holds: "E = π/(1 − ρ) within 0.3 %, ρ = 0.8",
        guard: &TREE_UNITS,
        without: "rays from corners leave the room, E is too low",
        check: || furnace_of_scale(1e-3),
    },
    Case {
        name: "a_furnace_of_20_km",
        hard: CLOSED_ROOM,
        elsewhere: "an absolute ray bias is lost in rounding: surfaces meet their own rays",
        holds: "E = π/(1 − ρ) within 0.3 %, ρ = 0.8",
        guard: &ORIGIN_MOVE,
        without: "walls meet the rays that leave them",
        check: || furnace_of_scale(1e4),
    },
];

/// The same scene under another root transform.
fn under(mut scene: Scene, root: Affine3A) -> Scene {
    for instance in &mut scene.instances {
        instance.world_from_local = root * instance.world_from_local;
    }
    scene
}

fn furnace_of_scale(scale: f32) -> Verdict {
    let scene = under(furnace(0.8), Affine3A::from_scale(Vec3::splat(scale)));
    let points = on_walls(Vec3::splat(-scale), Vec3::splat(scale), 2);
    mean_reads(&light_at(&scene, &points, 1 << 11)?, PI / 0.2, 3e-3)
}

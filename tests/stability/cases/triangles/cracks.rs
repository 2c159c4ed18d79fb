//! Edges that triangles share, or nearly share: no ray passes between, none starts behind.

use crate::case::{Case, Verdict};
use crate::cases::SELF_SHADOW;
use crate::common::meter::on_walls;
use crate::common::scenes::furnace;
use crate::guards::rays::{NO_CONSTANT, ORIGIN_MOVE, WATERTIGHT};
use crate::judge::{all_dark, ensure, light_at};
use crate::look::{FURNACE_HOLDS, furnace_of_0_8};
use crate::worlds::{askew_aside, dark_box, leaning, near_narrow_edges, points_under, under};
use bevy_kiln::scene::{Indices, Scene};
use bevy_kiln::trace::Tracer;
use glam::Vec3;

pub const CASES: &[Case] = &[
    Case {
        name: "a_wall_in_slivers",
        hard: "a wall of a closed room as a fan of 1000 triangles around a point on its rim, askew",
        elsewhere: "thin triangles are dropped or their normals are wrong: light leaks",
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: wall_in_slivers,
    },
    Case {
        name: "rays_at_the_edges_of_slivers",
        hard: "200 000 rays within 1 µm of edges that slivers share",
        elsewhere: "a ray at an edge is outside of both triangles by rounding",
        holds: "none passes: 0 lx enter",
        guard: &WATERTIGHT,
        without: "every ray at an edge passes",
        check: aimed_at_slivers,
    },
    Case {
        name: "rays_at_a_t_junction",
        hard: "a vertex on the middle of an edge, where f32 moves it: a real gap",
        elsewhere: "cracks at T-junctions as wide as the test's tolerance",
        holds: "what enters a black box is at most the gap that f32 allows: 2·√3·2⁻²² m wide (coordinates of 8 m), 2 m \
                long, seen from 1 m: 1.7e-6 lx under a sky of 1 cd/m²",
        guard: &WATERTIGHT,
        without: "the gap is as wide as the tolerance",
        check: aimed_at_a_t_junction,
    },
    Case {
        name: "dark_behind_a_t_junction",
        hard: "a black box that leans (its walls meet the floor at 40°), with points 1 mm from that edge and from \
                where a cut of the floor ends in it, under a sky",
        elsewhere: "a bias of 10 mm starts rays behind the next wall",
        holds: "E = 0 exactly: none of 10 points × 1024 paths sees the sky",
        guard: &NO_CONSTANT,
        without: "rays start outside of the box",
        check: dark_behind_a_t_junction,
    },
];

/// A room with another floor.
fn with_floor(mut scene: Scene, (positions, indices): (Vec<Vec3>, Vec<u32>)) -> Scene {
    let floor = scene.instances.iter().position(|instance| instance.name == "-y").expect("a room has a floor");
    let mesh = &mut scene.meshes[floor];
    (mesh.positions, mesh.indices, mesh.uv1) = (positions, Indices::U32(indices), None);
    scene.instances[floor].lightmap = None;
    scene
}

/// The floor of a box from −1 to 1 as a fan of slivers around a point on its rim.
fn fan() -> (Vec<Vec3>, Vec<u32>) {
    let count = 1000;
    let mut positions = vec![Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, -1.0, -1.0), Vec3::new(1.0, -1.0, 1.0)];
    positions.extend((1..count).map(|i| Vec3::new(1.0 - 2.0 * i as f32 / count as f32, -1.0, 1.0)));
    positions.push(Vec3::new(-1.0, -1.0, 1.0));
    let indices = (1..positions.len() as u32 - 1).flat_map(|i| [0, i + 1, i]).collect();
    (positions, indices)
}

fn wall_in_slivers() -> Verdict {
    let scene = under(with_floor(furnace(0.8), fan()), askew_aside());
    let points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), askew_aside());
    furnace_of_0_8(&scene, &points)
}

/// Irradiance that enters a black box, at its middle, through a band of ±`band` about edges from `a` to `b`, found by
/// rays aimed at it [lx].
fn entering(scene: &Scene, edges: &[[Vec3; 2]], band: f32) -> f64 {
    let (tracer, rays) = (Tracer::new(scene), 20_000);
    let mut sum = 0.0;
    let middle = askew_aside().transform_point3(Vec3::ZERO);
    for [a, b] in edges {
        let across = (*b - *a).normalize().cross(Vec3::Y);
        let mut lost = 0;
        for ray in 0..rays {
            let along = (ray as f32 + 0.5) / rays as f32;
            let aside = ((ray % 101) as f32 / 50.0 - 1.0) * band;
            let aim = askew_aside().transform_point3(*a + (*b - *a) * along + across * aside);
            lost += u32::from(tracer.closest_hit(middle, (aim - middle).normalize()).is_none());
        }
        // The floor is a metre away and is seen at a cosine of 1 at most.
        sum += f64::from(lost) / f64::from(rays) * f64::from(2.0 * band * (*b - *a).length());
    }
    sum
}

fn aimed_at_slivers() -> Verdict {
    let (positions, indices) = fan();
    let edges: Vec<[Vec3; 2]> = (100..110).map(|i| [positions[0], positions[i * 9]]).collect();
    let leak = entering(&under(with_floor(dark_box(0.0, 1.0), (positions, indices)), askew_aside()), &edges, 1e-6);
    ensure(leak == 0.0, || format!("{leak:.2e} lx enter at edges that triangles share"))
}

/// A floor in three pieces: one half whole, the other cut at a third, where the cut ends on the first's edge.
fn tee() -> (Vec<Vec3>, Vec<u32>) {
    let cut = -1.0 / 3.0;
    let point = |x: f32, z: f32| Vec3::new(x, -1.0, z);
    let quads = [
        [point(-0.1, -1.0), point(-0.1, 1.0), point(1.0, 1.0), point(1.0, -1.0)],
        [point(-1.0, -1.0), point(-1.0, cut), point(-0.1, cut), point(-0.1, -1.0)],
        [point(-1.0, cut), point(-1.0, 1.0), point(-0.1, 1.0), point(-0.1, cut)],
    ];
    let indices = (0..3).flat_map(|quad| [0, 1, 2, 0, 2, 3].map(|corner| 4 * quad + corner)).collect();
    (quads.concat(), indices)
}

/// f32 puts each end of an edge, and the vertex between them, off by half a step of the largest coordinate (8 m here:
/// 2⁻²² m), along three axes: a gap of at most 2·√3·2⁻²² m, and 2 m long.
fn aimed_at_a_t_junction() -> Verdict {
    let edge = [Vec3::new(-0.1, -1.0, -1.0), Vec3::new(-0.1, -1.0, 1.0)];
    let leak = entering(&under(with_floor(dark_box(0.0, 1.0), tee()), askew_aside()), &[edge], 4e-6);
    let bound = 2.0 * 3.0_f64.sqrt() * 2.0_f64.powi(-22) * 2.0;
    ensure(leak <= bound, || format!("{leak:.2e} lx enter at a T-junction, more than {bound:.2e}"))
}

fn dark_behind_a_t_junction() -> Verdict {
    all_dark(&light_at(&under(with_floor(dark_box(0.0, 1.0), tee()), leaning()), &near_narrow_edges(), 1 << 10)?)
}

//! Transforms that mirror, shrink and squeeze: what they place is still there, and faces where it should.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing};
use crate::guards::scene::{FRAMES, RELATIVE_DETERMINANT};
use crate::judge::{all_dark, light_at, reads};
use crate::truths::under_square;
use crate::worlds::askew;
use glam::{Affine3A, Vec3};

const SINGULAR: &str = "a determinant below an ε counts as singular: the mesh is gone";
const FACTOR: &str = "E = π·F (Howell B-3) of a lamp of 1 m within 1 %";

pub const CASES: &[Case] = &[
    Case {
        name: "a_mirrored_lamp",
        hard: "a negative determinant turns triangles round",
        elsewhere: "a mirrored lamp shines out of its back",
        holds: "a square that faces down faces down: E = π·F (Howell B-3) within 1 % below it, 0 above",
        guard: &FRAMES,
        without: "it shines upwards",
        check: || lamp_under(Vec3::new(-1.0, 1.0, 1.0), 1.0),
    },
    Case {
        name: "a_lamp_mirrored_on_all_axes",
        hard: "three mirrors: the front is carried to the other side, and the winding is turned",
        elsewhere: "a mirrored lamp shines out of its back",
        holds: "a square that faces down faces up: E = π·F (Howell B-3) within 1 % above it, 0 below",
        guard: &FRAMES,
        without: "it shines downwards",
        check: || lamp_under(Vec3::NEG_ONE, -1.0),
    },
    Case {
        name: "a_mesh_scaled_by_a_millionth",
        hard: "its determinant is 1e-18",
        elsewhere: SINGULAR,
        holds: FACTOR,
        guard: &RELATIVE_DETERMINANT,
        without: "it is refused",
        check: || squeezed(Vec3::splat(1e-6)),
    },
    Case {
        name: "a_mesh_squeezed_by_a_millionth_on_one_axis",
        hard: "its determinant is 1e-10, its axes differ by 1e8",
        elsewhere: SINGULAR,
        holds: FACTOR,
        guard: &RELATIVE_DETERMINANT,
        without: "it is refused",
        check: || squeezed(Vec3::new(1e-2, 1.0, 1e-8)),
    },
];

/// A glowing square that faces down under a matrix that mirrors: it still faces down, or up where that mirrors it so.
fn lamp_under(scale: Vec3, side: f32) -> Verdict {
    let mut scene =
        SceneBuilder::default().quad("lamp", Vec3::new(-0.5, 0.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 1.0)).build();
    scene.instances[0].world_from_local = Affine3A::from_scale(scale);
    let points = [at(Vec3::NEG_Y * side, Vec3::Y * side), at(Vec3::Y * side, Vec3::NEG_Y * side)];
    let readings = light_at(&scene, &points, 1 << 12)?;
    reads(&readings[0], under_square(0.5, 1.0), 0.01)?;
    all_dark(&readings[1..])
}

/// A glowing square of 1 m whose mesh is as large as its transform is small.
fn squeezed(scale: Vec3) -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("lamp", Vec3::new(-0.5, 0.0, -0.5) / scale, [Vec3::X / scale.x, Vec3::Z / scale.z], glowing(0.0, 1.0))
        .build();
    scene.instances[0].world_from_local = Affine3A::from_quat(askew()) * Affine3A::from_scale(scale);
    let readings = light_at(&scene, &[at(askew() * Vec3::NEG_Y, askew() * Vec3::Y)], 1 << 12)?;
    reads(&readings[0], under_square(0.5, 1.0), 0.01)
}

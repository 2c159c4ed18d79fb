//! Normals that are broken, and normals under transforms that bend them.

use super::{mean, raw_texels};
use crate::case::{Case, Verdict};
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::scene::{DIRECTIONS, FRAMES};
use crate::judge::ensure;
use crate::things::rectangle;
use bevy_kiln::scene::{Light, Scene};
use glam::{Affine3A, Mat3, Vec2, Vec3};

const BLACK: &str =
    "black or NaN meshes (ericw-tools: entire lightmap turning black; glTF exporters write such normals)";
const FLAT: &str = "every texel is that of the mesh without normals to 1e-4: the same paths, rounded";
const BY_THE_MATRIX: &str = "normals by the matrix itself, or by an inverse that overflows";

pub const CASES: &[Case] = &[
    Case {
        name: "a_triangle_without_area_among_good_ones",
        hard: "0/0 for its normal, and it has texels in UV1",
        elsewhere: "NaN texels, which filters spread (MoonRay 251)",
        holds: "every texel has the bits that it has without it",
        guard: &DIRECTIONS,
        without: "NaN in the texels of that triangle",
        check: zero_area,
    },
    Case {
        name: "normals_of_zero",
        hard: "0/0",
        elsewhere: BLACK,
        holds: FLAT,
        guard: &DIRECTIONS,
        without: "NaN in every texel",
        check: || broken_normals(Vec3::ZERO),
    },
    Case {
        name: "normals_of_nan",
        hard: "NaN compares with nothing",
        elsewhere: BLACK,
        holds: FLAT,
        guard: &DIRECTIONS,
        without: "NaN in every texel",
        check: || broken_normals(Vec3::NAN),
    },
    Case {
        name: "normals_of_infinity",
        hard: "∞/∞",
        elsewhere: BLACK,
        holds: FLAT,
        guard: &DIRECTIONS,
        without: "NaN in every texel",
        check: || broken_normals(Vec3::splat(f32::INFINITY)),
    },
    Case {
        name: "normals_against_the_face",
        hard: "they point into the surface, where there is no light",
        elsewhere: BLACK,
        holds: FLAT,
        guard: &DIRECTIONS,
        without: "texels have the light of another direction, or none",
        check: || broken_normals(Vec3::new(0.2, -1.0, 0.1)),
    },
    Case {
        name: "normals_of_a_sheared_mesh",
        hard: "normals do not transform as positions do",
        elsewhere: BY_THE_MATRIX,
        holds: FLAT,
        guard: &FRAMES,
        without: "texels have the light of another direction",
        check: || normals_under(Mat3::from_cols(Vec3::X, Vec3::new(1.5, 1.0, 0.5), Vec3::new(-0.5, 0.0, 1.0))),
    },
    Case {
        name: "normals_of_a_mesh_flattened_to_a_millionth",
        hard: "the inverse transpose has entries of 1e6",
        elsewhere: BY_THE_MATRIX,
        holds: FLAT,
        guard: &FRAMES,
        without: "texels have the light of another direction",
        check: || normals_under(Mat3::from_diagonal(Vec3::new(1.0, 1e-6, 1.0)) * Mat3::from_rotation_z(0.3)),
    },
];

/// A floor on the left half of its UV1, and a triangle without area on the right.
fn zero_area() -> Verdict {
    let floor = |extra: bool| {
        let mut positions = vec![Vec3::ZERO, Vec3::Z, Vec3::X + Vec3::Z, Vec3::X];
        let mut uv1 = vec![Vec2::ZERO, Vec2::new(0.5, 0.0), Vec2::new(0.5, 1.0), Vec2::Y];
        let mut indices = vec![0, 1, 2, 0, 2, 3];
        if extra {
            positions.extend([Vec3::ZERO, Vec3::X, Vec3::X]);
            uv1.extend([Vec2::new(0.6, 0.0), Vec2::ONE, Vec2::new(0.6, 1.0)]);
            indices.extend([4, 5, 6]);
        }
        SceneBuilder::default().mesh("floor", positions, indices, Some(uv1), grey(0.5)).sky(Vec3::ONE).build()
    };
    let [plain, extra] = [floor(false), floor(true)].map(|scene| raw_texels(&scene));
    let (plain, extra) = (plain?, extra?);
    let brightest = plain.iter().fold(Vec3::ZERO, |most, texel| most.max(*texel));
    ensure((brightest.x - 1.0).abs() < 1e-5, || format!("the brightest texel is {brightest}, not 1"))?;
    ensure(plain == extra, || format!("mean texels of {} and {}", mean(&plain), mean(&extra)))
}

/// A tilted floor under a lamp, with normals at its vertices or none.
fn floor_with(normals: Option<Vec<Vec3>>) -> Scene {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-1.0, 0.0, -1.0), [Vec3::new(0.0, 0.3, 2.0), Vec3::new(2.0, -0.2, 0.0)], grey(0.5))
        .build();
    scene.meshes[0].normals = normals;
    scene.lights.push(Light::Rect(rectangle(Vec3::new(0.3, 1.5, 0.2), Vec3::NEG_Y, Vec2::splat(0.4))));
    scene
}

fn same_texels(a: &Scene, b: &Scene) -> Verdict {
    let (a, b) = (raw_texels(a)?, raw_texels(b)?);
    ensure(mean(&a) > 1e-3, || "it is dark".into())?;
    let same =
        a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (*a - *b).abs().max_element() <= 1e-4 * a.max_element());
    ensure(same, || format!("mean texels of {} and {}", mean(&a), mean(&b)))
}

fn broken_normals(normal: Vec3) -> Verdict {
    same_texels(&floor_with(None), &floor_with(Some(vec![normal; 4])))
}

/// The floor's own normals under a matrix, against none.
fn normals_under(matrix: Mat3) -> Verdict {
    let own = Vec3::new(0.0, 0.3, 2.0).cross(Vec3::new(2.0, -0.2, 0.0)).normalize();
    let [flat, smooth] = [None, Some(vec![own; 4])].map(|normals| {
        let mut scene = floor_with(normals);
        scene.instances[0].world_from_local = Affine3A::from_mat3(matrix);
        scene
    });
    same_texels(&flat, &smooth)
}

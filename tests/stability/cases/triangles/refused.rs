//! What is no triangle, or lies nowhere: it is refused by name, and the rest of the scene is baked.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::scene::{RELATIVE_DETERMINANT, VALIDATED};
use crate::judge::{all_read, is_refused, light_at};
use bevy_kiln::scene::{Indices, Mesh, Scene};
use glam::{Affine3A, Mat3, Vec2, Vec3};
use std::f64::consts::PI;

const NAMELESS: &str = "NaN spreads through boxes and tree to all that the ray meets (Godot 95875, MoonRay 251)";
const NAMED: &str = "refused by name, with what to do; the rest of the scene is baked";
const STILL_THERE: &str = "refused by name; the mesh still blocks and reflects";

pub const CASES: &[Case] = &[
    Case {
        name: "a_near_singular_transform_at_scale_10000",
        hard: "axes 1e-10 rad apart, with a determinant of 100",
        elsewhere: "a determinant above an ε passes: normals and areas are rounding",
        holds: NAMED,
        guard: &RELATIVE_DETERMINANT,
        without: "nothing is said",
        check: || {
            transform_is_refused(Affine3A::from_mat3(Mat3::from_cols(
                1e4 * Vec3::X,
                1e4 * (Vec3::X + 1e-10 * Vec3::Y),
                1e4 * Vec3::Z,
            )))
        },
    },
    Case {
        name: "a_singular_transform",
        hard: "a scale of 0 on one axis",
        elsewhere: "its inverse is NaN",
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || transform_is_refused(Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))),
    },
    Case {
        name: "a_transform_with_nan",
        hard: "NaN compares with nothing: a test for a small determinant passes it",
        elsewhere: NAMELESS,
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || transform_is_refused(Affine3A::from_scale(Vec3::new(1.0, f32::NAN, 1.0))),
    },
    Case {
        name: "a_transform_to_infinity",
        hard: "an infinite translation; its determinant is 1",
        elsewhere: NAMELESS,
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || transform_is_refused(Affine3A::from_translation(Vec3::new(f32::INFINITY, 0.0, 0.0))),
    },
    Case {
        name: "a_vertex_of_nan",
        hard: "one vertex of four",
        elsewhere: NAMELESS,
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            mesh_is_refused("has a position that is not a finite number (vertex 2)", |mesh| {
                mesh.positions[2].y = f32::NAN
            })
        },
    },
    Case {
        name: "a_vertex_at_infinity",
        hard: "one vertex of four",
        elsewhere: NAMELESS,
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            mesh_is_refused("has a position that is not a finite number (vertex 1)", |mesh| {
                mesh.positions[1].x = f32::INFINITY
            })
        },
    },
    Case {
        name: "an_index_out_of_range",
        hard: "index 9 of 4 vertices",
        elsewhere: "memory beyond the list, or a panic",
        holds: NAMED,
        guard: &VALIDATED,
        without: "a panic",
        check: || mesh_is_refused("has index 9 but only 4 vertices", |mesh| mesh.indices = Indices::U32(vec![0, 1, 9])),
    },
    Case {
        name: "an_empty_mesh",
        hard: "no vertex and no triangle",
        elsewhere: "bounds from +∞ to −∞; a bake that waits for texels that never come",
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            mesh_is_refused("has no triangle with an area", |mesh| {
                mesh.positions.clear();
                mesh.uv1 = None;
                mesh.indices = Indices::None;
            })
        },
    },
    Case {
        name: "a_mesh_without_area",
        hard: "all vertices in one place",
        elsewhere: "0/0 for every normal",
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || mesh_is_refused("has no triangle with an area", |mesh| mesh.positions = vec![Vec3::ONE; 4]),
    },
    Case {
        name: "a_uv1_without_area",
        hard: "all of UV1 in one point: no texel lies on the mesh",
        elsewhere: "texels per metre of 1/0",
        holds: STILL_THERE,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            instance_is_refused("has a UV1 (TEXCOORD_1) without area", |scene| {
                scene.meshes[0].uv1 = Some(vec![Vec2::ONE; 4])
            })
        },
    },
    Case {
        name: "a_uv1_of_nan",
        hard: "NaN as a place on the map",
        elsewhere: "a texel's number out of NaN: memory beyond the map",
        holds: STILL_THERE,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            instance_is_refused("has a UV1 (TEXCOORD_1) outside the unit square (vertex 0)", |scene| {
                scene.meshes[0].uv1 = Some(vec![Vec2::NAN; 4])
            })
        },
    },
];

/// A quad that is spoilt is refused with this sentence, and what is beside it is baked all the same.
fn refused(sentence: &str, spoil: impl Fn(&mut Scene)) -> Verdict {
    let quad = SceneBuilder::default().quad("quad", Vec3::ZERO, [Vec3::Z, Vec3::X], grey(0.5));
    let mut scene = quad.sky(Vec3::ONE).build();
    spoil(&mut scene);
    is_refused(&scene, sentence)?;
    all_read(&light_at(&scene, &[at(Vec3::new(0.5, 3.0, 0.5), Vec3::Y)], 16)?, PI, 1e-5)
}

fn instance_is_refused(sentence: &str, spoil: impl Fn(&mut Scene)) -> Verdict {
    refused(&format!("instance \"quad\" {sentence}"), spoil)
}

fn mesh_is_refused(sentence: &str, spoil: impl Fn(&mut Mesh)) -> Verdict {
    refused(&format!("mesh \"quad\" {sentence}"), |scene| spoil(&mut scene.meshes[0]))
}

fn transform_is_refused(transform: Affine3A) -> Verdict {
    instance_is_refused("has a transform that cannot be inverted", |scene| {
        scene.instances[0].world_from_local = transform
    })
}

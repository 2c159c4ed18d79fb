//! Shapes and placements of triangles: thin, tiny, huge, doubled, cut, turned inside out, and what is no triangle.

use crate::case::{Case, Verdict};
use crate::common::meter::{at, on_walls};
use crate::common::scenes::{SceneBuilder, furnace, glowing, grey};
use crate::guards::rays::{NO_CONSTANT, NO_LEAST_AREA, ORIGIN_MOVE, WATERTIGHT};
use crate::guards::scene::{DIRECTIONS, FRAMES, RELATIVE_DETERMINANT, SORTED, VALIDATED};
use crate::judge::{all_read, baked, ensure, is_refused, light_at, mean_reads, reads};
use crate::worlds::{askew, bulb, in_the_room, level_room, points_under, rectangle, room, sun, under};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, MeterPoint, MeterReading};
use bevy_kiln::math::corner_parallel_rectangle;
use bevy_kiln::scene::{Indices, Instance, Light, Material, Mesh, PointLight, Scene};
use bevy_kiln::trace::Tracer;
use glam::{Affine3A, DVec3, Mat3, Vec2, Vec3};
use std::f64::consts::PI;

const NAMELESS: &str = "NaN spreads through boxes and tree to all that the ray meets (Godot 95875, MoonRay 251)";
const NAMED: &str = "refused by name, with what to do; the rest of the scene is baked";

const BLACK: &str =
    "black or NaN meshes (ericw-tools: entire lightmap turning black; glTF exporters write such normals)";
const FLAT: &str = "every texel is that of the mesh without normals, to 1e-4";
const SELF: &str = "walls meet the rays that leave them";

pub const CASES: &[Case] = &[
    Case {
        name: "a_wall_in_slivers",
        hard: "a wall of a closed room as a fan of 1000 triangles around a point on its rim, askew",
        elsewhere: "thin triangles are dropped or their normals are wrong: light leaks",
        holds: "E = π/(1 − ρ) within 0.3 % (ρ = 0.8), noise counted in",
        guard: &ORIGIN_MOVE,
        without: SELF,
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
        holds: "what enters a black box is at most the gap that f32 allows: 2·√3·2⁻²² m wide (coordinates of 8 m), 2 m long, seen from 1 m: 1.7e-6 lx under a sky of 1 cd/m²",
        guard: &WATERTIGHT,
        without: "the gap is as wide as the tolerance",
        check: aimed_at_a_t_junction,
    },
    Case {
        name: "dark_behind_a_t_junction",
        hard: "a black box that leans (its walls meet the floor at 40°), with points 1 mm from that edge and from where a cut of the floor ends in it, under a sky",
        elsewhere: "a bias of 10 mm starts rays behind the next wall",
        holds: "E = 0 exactly: none of 10 points × 1024 paths sees the sky",
        guard: &NO_CONSTANT,
        without: "rays start outside of the box",
        check: dark_behind_a_t_junction,
    },
    Case {
        name: "a_triangle_of_3_mm_over_a_floor_of_250_m",
        hard: "twice its area is 9e-6 m², five decades and more below the floor's",
        elsewhere: "Godot's lightmapper rejects det below 1e-5: such a triangle is invisible to every ray",
        holds: "it casts its shadow (E = 0); beside it E = I·cos/d² to 1e-5, and a lamp under the floor is not seen",
        guard: &NO_LEAST_AREA,
        without: "there is no shadow",
        check: || shadow_of(&[Vec3::new(-1e-3, 1.0, -1e-3), Vec3::new(2e-3, 1.0, -1e-3), Vec3::new(-1e-3, 1.0, 2e-3)]),
    },
    Case {
        name: "a_triangle_of_3_um_over_a_floor_of_250_m",
        hard: "sizes over eight decades in one tree",
        elsewhere: "Godot's lightmapper rejects det below 1e-5: such a triangle is invisible to every ray",
        holds: "it casts its shadow (E = 0); beside it E = I·cos/d² to 1e-5, and a lamp under the floor is not seen",
        guard: &NO_LEAST_AREA,
        without: "there is no shadow",
        check: || shadow_of(&[Vec3::new(-1e-6, 1.0, -1e-6), Vec3::new(2e-6, 1.0, -1e-6), Vec3::new(-1e-6, 1.0, 2e-6)]),
    },
    Case {
        name: "a_needle_of_a_million_to_one",
        hard: "1 m long and 1 µm wide",
        elsewhere: "Godot's lightmapper rejects det below 1e-5: such a triangle is invisible to every ray",
        holds: "it casts its shadow on its axis (E = 0); 10 cm beside it E = I·cos/d² to 1e-5",
        guard: &NO_LEAST_AREA,
        without: "there is no shadow",
        check: || shadow_of(&[Vec3::new(-5e-7, 1.0, -0.5), Vec3::new(5e-7, 1.0, -0.5), Vec3::new(0.0, 1.0, 0.5)]),
    },
    Case {
        name: "walls_twice",
        hard: "every wall a second time at the very same place: each ray leaves one and could meet the other",
        elsewhere: "shadow acne of coplanar copies",
        holds: "the mean texel is that of single walls to 1e-3",
        guard: &ORIGIN_MOVE,
        without: "walls meet the rays that leave their copies",
        check: doubled,
    },
    Case {
        name: "two_materials_in_one_place",
        hard: "two walls of different albedo in the same plane: which one a ray meets is a tie",
        elsewhere: "the tie goes to whichever was loaded first, or to a thread (Godot 55681)",
        holds: "every texel has the same bits whichever way round the scene lists its instances",
        guard: &SORTED,
        without: "texels change with the list",
        check: coincident,
    },
    Case {
        name: "three_bulbs_in_one_place",
        hard: "the tree over lamps can part them in no way",
        elsewhere: "the order of the list decides, and with it the noise",
        holds: "every reading has the same bits whichever way round the scene lists its lights",
        guard: &SORTED,
        without: "readings change with the list",
        check: lamps_in_one_place,
    },
    Case {
        name: "interpenetrating_boxes",
        hard: "two black boxes that lean, through each other, under a sky, with points 1 mm from edges of 40°",
        elsewhere: "a bias of 10 mm starts rays behind the next wall",
        holds: "E = 0 exactly at 10 points",
        guard: &NO_CONSTANT,
        without: "rays start outside",
        check: interpenetrating,
    },
    Case {
        name: "a_closed_box_in_a_bright_sky",
        hard: "a sky of 1e6 cd/m² around white walls that lean; points 1 mm from edges of 40°",
        elsewhere: "leaks at edges and corners are the first of all complaints (Godot 51638 and others)",
        holds: "E = 0 exactly, which is below 1e-6 of outside",
        guard: &NO_CONSTANT,
        without: "rays start outside: the box is bright",
        check: dark_box,
    },
    Case {
        name: "a_leaning_sheet_between_light_and_dark",
        hard: "a floor 1 mm from where a sheet without thickness meets it at 45°",
        elsewhere: "a bias of 10 mm starts rays beyond the sheet",
        holds: "E = 0 exactly on the dark side",
        guard: &NO_CONSTANT,
        without: "light comes through the sheet",
        check: leaning_sheet,
    },
    Case {
        name: "sheets_back_to_back",
        hard: "two sheets in the same plane, askew, front to front outwards, one white and one black, under a sun",
        elsewhere: "each hides the other by rounding, and light comes through to the lower",
        holds: "each texel of the upper has E/π = E⊥·cos/π, each of the lower 0, to 1e-5",
        guard: &ORIGIN_MOVE,
        without: "the sheets shadow themselves and each other",
        check: || back_to_back(0.0),
    },
    Case {
        name: "a_wall_of_a_tenth_of_a_millimetre",
        hard: "two sheets 0.1 mm apart, askew, under a sun",
        elsewhere: "a bias longer than the wall (Godot: 0.5 mm) puts ray starts on its other side",
        holds: "each texel of the upper has E/π = E⊥·cos/π, each of the lower 0, to 1e-5",
        guard: &ORIGIN_MOVE,
        without: "the upper sheet shadows itself",
        check: || back_to_back(1e-4),
    },
    Case {
        name: "a_hundred_thousand_instances",
        hard: "98 304 glowing instances of one square are the walls of a furnace, each corner rounded four times",
        elsewhere: "a tree or a light list per instance; cracks between instances",
        holds: "E = π/(1 − ρ) within 0.8 % (ρ = 0.5), noise counted in: gaps of a step (5e-7 m) around tiles of 16 mm lose 1e-4",
        guard: &ORIGIN_MOVE,
        without: SELF,
        check: hundred_thousand,
    },
    Case {
        name: "a_furnace_of_a_million_km",
        hard: "coordinates of 9e8 m, farther than the moon, with steps of 64 m",
        elsewhere: "edge functions or areas overflow: light leaks or is NaN",
        holds: "E = π/(1 − ρ) within 0.3 % (ρ = 0.8), noise counted in",
        guard: &ORIGIN_MOVE,
        without: "walls meet the rays that leave them",
        check: || furnace_of(5e8),
    },
    Case {
        name: "vertices_at_1e30",
        hard: "coordinates whose square no f32 holds",
        elsewhere: "areas of boxes overflow: a tree over NaN",
        holds: "refused by name: a vertex beyond 1e9 m would take the order from what is within 1e-13 of that; the room beside it has its own light to 1e-3",
        guard: &VALIDATED,
        without: "nothing is said",
        check: || far_is_refused(1e30),
    },
    Case {
        name: "vertices_at_1e15",
        hard: "a scene 1e15 times as large as the room in it: for the tree the room is one point",
        elsewhere: "a sky dome far out takes all precision, silently",
        holds: "refused by name: a vertex beyond 1e9 m would take the order from what is within 1e-13 of that; the room beside it has its own light to 1e-3",
        guard: &VALIDATED,
        without: "nothing is said",
        check: || far_is_refused(1e15),
    },
    Case {
        name: "a_room_beside_triangles_at_900_000_km",
        hard: "a scene 1e9 times as large as the room in it",
        elsewhere: "errors and boxes by the scene's size: walls are 100 m thick",
        holds: "the mean texel is that of the room alone to 1e-3: errors are each triangle's own",
        guard: &ORIGIN_MOVE,
        without: "walls meet the rays that leave them",
        check: || beside(9e8),
    },
    Case {
        name: "boxes_that_overflow",
        hard: "triangles at 3e38 m on either side: their distance is infinite in f32",
        elsewhere: "a tree over infinities",
        holds: "refused by name: a vertex beyond 1e9 m would take the order from what is within 1e-13 of that; the room beside it has its own light to 1e-3",
        guard: &VALIDATED,
        without: "nothing is said",
        check: || far_is_refused(3e38),
    },
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
        elsewhere: "a determinant below an ε counts as singular: the mesh is gone",
        holds: "E = π·F (Howell B-3) of a lamp of 1 m within 1 %",
        guard: &RELATIVE_DETERMINANT,
        without: "it is refused",
        check: || squeezed(Vec3::splat(1e-6)),
    },
    Case {
        name: "a_mesh_squeezed_by_a_millionth_on_one_axis",
        hard: "its determinant is 1e-10, its axes differ by 1e8",
        elsewhere: "a determinant below an ε counts as singular: the mesh is gone",
        holds: "E = π·F (Howell B-3) of a lamp of 1 m within 1 %",
        guard: &RELATIVE_DETERMINANT,
        without: "it is refused",
        check: || squeezed(Vec3::new(1e-2, 1.0, 1e-8)),
    },
    Case {
        name: "normals_of_a_sheared_mesh",
        hard: "normals do not transform as positions do",
        elsewhere: "normals by the matrix itself, or by an inverse that overflows",
        holds: "every texel with the mesh's own normals is that without, to 1e-4",
        guard: &FRAMES,
        without: "texels have the light of another direction",
        check: || normals_under(Mat3::from_cols(Vec3::X, Vec3::new(1.5, 1.0, 0.5), Vec3::new(-0.5, 0.0, 1.0))),
    },
    Case {
        name: "normals_of_a_mesh_flattened_to_a_millionth",
        hard: "the inverse transpose has entries of 1e6",
        elsewhere: "normals by the matrix itself, or by an inverse that overflows",
        holds: "every texel with the mesh's own normals is that without, to 1e-4",
        guard: &FRAMES,
        without: "texels have the light of another direction",
        check: || normals_under(Mat3::from_diagonal(Vec3::new(1.0, 1e-6, 1.0)) * Mat3::from_rotation_z(0.3)),
    },
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
            mesh_is_refused("has a position that is not a finite number (vertex 2)", &|mesh| {
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
            mesh_is_refused("has a position that is not a finite number (vertex 1)", &|mesh| {
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
        check: || {
            mesh_is_refused("has index 9 but only 4 vertices", &|mesh| mesh.indices = Indices::U32(vec![0, 1, 9]))
        },
    },
    Case {
        name: "an_empty_mesh",
        hard: "no vertex and no triangle",
        elsewhere: "bounds from +∞ to −∞; a bake that waits for texels that never come",
        holds: NAMED,
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            mesh_is_refused("has no triangle with an area", &|mesh| {
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
        check: || mesh_is_refused("has no triangle with an area", &|mesh| mesh.positions = vec![Vec3::ONE; 4]),
    },
    Case {
        name: "a_uv1_without_area",
        hard: "all of UV1 in one point: no texel lies on the mesh",
        elsewhere: "texels per metre of 1/0",
        holds: "refused by name; the mesh still blocks and reflects",
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            instance_is_refused("has a UV1 (TEXCOORD_1) without area", &|scene| {
                scene.meshes[0].uv1 = Some(vec![Vec2::ONE; 4])
            })
        },
    },
    Case {
        name: "a_uv1_of_nan",
        hard: "NaN as a place on the map",
        elsewhere: "a texel's number out of NaN: memory beyond the map",
        holds: "refused by name; the mesh still blocks and reflects",
        guard: &VALIDATED,
        without: "nothing is said",
        check: || {
            instance_is_refused("has a UV1 (TEXCOORD_1) outside the unit square (vertex 0)", &|scene| {
                scene.meshes[0].uv1 = Some(vec![Vec2::NAN; 4])
            })
        },
    },
];

fn turned() -> Affine3A {
    Affine3A::from_rotation_translation(askew(), Vec3::new(3.1, -2.7, 5.3))
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

fn with_floor(scene: Scene, (positions, indices): (Vec<Vec3>, Vec<u32>)) -> Scene {
    let mut scene = scene;
    let floor = scene.instances.iter().position(|instance| instance.name == "-y").expect("a room has a floor");
    let mesh = &mut scene.meshes[floor];
    (mesh.positions, mesh.indices, mesh.uv1) = (positions, Indices::U32(indices), None);
    scene.instances[floor].lightmap = None;
    scene
}

fn wall_in_slivers() -> Verdict {
    let scene = under(with_floor(furnace(0.8), fan()), turned());
    let points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), turned());
    mean_reads(&light_at(&scene, &points, 1 << 11)?, PI / 0.2, 3e-3)
}

/// A black closed box under a sky of 1.
fn black_box() -> Scene {
    let side = || grey(0.0);
    let sides = [side(), side(), side(), side(), side(), side()];
    SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, sides).sky(Vec3::ONE).build()
}

/// Irradiance that enters a black box, at its middle, through a band of ±`band` about edges from `a` to `b`, found by
/// rays aimed at it [lx].
fn entering(scene: &Scene, edges: &[[Vec3; 2]], band: f32) -> f64 {
    let (tracer, rays) = (Tracer::new(scene), 20_000);
    let mut sum = 0.0;
    let middle = turned().transform_point3(Vec3::ZERO);
    for [a, b] in edges {
        let across = (*b - *a).normalize().cross(Vec3::Y);
        let mut lost = 0;
        for ray in 0..rays {
            let along = (ray as f32 + 0.5) / rays as f32;
            let aside = ((ray % 101) as f32 / 50.0 - 1.0) * band;
            let aim = turned().transform_point3(*a + (*b - *a) * along + across * aside);
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
    let leak = entering(&under(with_floor(black_box(), (positions, indices)), turned()), &edges, 1e-6);
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
    let leak = entering(&under(with_floor(black_box(), tee()), turned()), &[edge], 4e-6);
    let bound = 2.0 * 3.0_f64.sqrt() * 2.0_f64.powi(-22) * 2.0;
    ensure(leak <= bound, || format!("{leak:.2e} lx enter at a T-junction, more than {bound:.2e}"))
}

/// A root under which a cube's floor and its −x wall meet at 40°, as its ceiling and its +x wall do.
fn leaning() -> Affine3A {
    turned() * Affine3A::from_mat3(Mat3::from_cols(Vec3::X, Vec3::new(1.2, 1.0, 0.0), Vec3::Z))
}

/// Points in that cube, a millimetre from its narrow edges.
fn near_edges() -> Vec<MeterPoint> {
    let along = [-0.9, -1.0 / 3.0, -0.332, 0.4, 0.999];
    let sides = [(Vec3::new(-0.999, -1.0, 0.0), Vec3::Y), (Vec3::new(0.999, 1.0, 0.0), Vec3::NEG_Y)];
    let point =
        |(place, facing): (Vec3, Vec3), z: f32| at(leaning().transform_point3(place.with_z(z)), askew() * facing);
    sides.into_iter().flat_map(|side| along.map(|z| point(side, z))).collect()
}

fn all_dark(readings: &[MeterReading]) -> Verdict {
    ensure(!readings.is_empty(), || "nothing was read".into())?;
    readings.iter().try_for_each(|reading| {
        ensure(reading.irradiance == DVec3::ZERO, || format!("E is {}, not 0", reading.irradiance))
    })
}

fn dark_behind_a_t_junction() -> Verdict {
    all_dark(&light_at(&under(with_floor(black_box(), tee()), leaning()), &near_edges(), 1 << 10)?)
}

/// A floor of 250 m, a point 2 m over it and a triangle between.
fn shadow_of(triangle: &[Vec3; 3]) -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-125.0, 0.0, -125.0), [Vec3::Z * 250.0, Vec3::X * 250.0], grey(0.0))
        .mesh("triangle", triangle.to_vec(), vec![0, 1, 2], None, grey(0.0))
        .build();
    scene.lights.push(Light::Point(bulb(2.0 * Vec3::Y, 0.0)));
    scene.lights.push(Light::Point(PointLight { id: StableId::new("below"), ..bulb(Vec3::NEG_Y, 0.0) }));
    // In the air: a point that is computed on a floor of 250 m is off along it by 0.1 mm.
    let places = [Vec3::ZERO, Vec3::new(0.1, 0.0, 0.0), Vec3::new(124.0, 0.0, -124.5)].map(|p| p + 0.25 * Vec3::Y);
    let readings = light_at(&scene, &places.map(|place| at(place, Vec3::Y)), 256)?;
    all_dark(&readings[..1]).map_err(|error| format!("in the shadow {error}"))?;
    places[1..].iter().zip(&readings[1..]).try_for_each(|(place, reading)| {
        reads(reading, 1.75 / (place.as_dvec3() - 2.0 * DVec3::Y).length().powi(3), 1e-5)
    })
}

/// Every wall of the room a second time, under another name.
fn doubled_room(material: impl Fn(&Material) -> Material) -> Scene {
    let mut scene = room();
    let copies: Vec<Instance> = scene.instances.iter().filter(|instance| instance.name != "lamp").cloned().collect();
    for mut copy in copies {
        let own = material(&scene.materials[copy.material]);
        copy.id = StableId::new(format!("{} again", copy.name));
        (copy.lightmap, copy.material) = (None, scene.materials.len());
        scene.materials.push(own);
        scene.instances.push(copy);
    }
    scene
}

fn texels(scene: &Scene) -> Result<Vec<Vec3>, String> {
    let settings = BakeSettings { samples_per_texel: 64, density: 3.3, ..BakeSettings::default() };
    let pages = baked(scene, &settings)?.pages;
    Ok(pages.iter().flat_map(|page| page.raw.clone()).collect())
}

fn mean(texels: &[Vec3]) -> f64 {
    texels.iter().map(|texel| f64::from(texel.x)).sum::<f64>() / texels.len() as f64
}

/// Whether a bake has the room's mean texel to 1e-3, and that has the level room's to 3 %, whose random numbers differ.
fn is_like_the_room(scene: &Scene) -> Verdict {
    let [level, room, other] = [&level_room(), &room(), scene].map(|scene| texels(scene).map(|texels| mean(&texels)));
    let (level, room, other) = (level?, room?, other?);
    ensure((room / level - 1.0).abs() < 0.03, || {
        format!("the mean texel is {room:.5}, and {level:.5} of a level room")
    })?;
    ensure((other / room - 1.0).abs() < 1e-3, || format!("the mean texel is {other:.5}, not {room:.5}"))
}

fn doubled() -> Verdict {
    is_like_the_room(&doubled_room(Material::clone))
}

fn coincident() -> Verdict {
    let scene = doubled_room(|material| Material { base_colour: Vec3::splat(0.9).extend(1.0), ..material.clone() });
    let mut turned_round = scene.clone();
    turned_round.instances.reverse();
    let [a, b] = [texels(&scene)?, texels(&turned_round)?];
    ensure(a == b, || format!("mean texels of {} and {}, by the order of the list", mean(&a), mean(&b)))
}

fn lamps_in_one_place() -> Verdict {
    let mut scene = room();
    for (name, power) in [("a", 1.0), ("b", 3.0), ("c", 0.5)] {
        let lamp = PointLight { id: StableId::new(name), ..bulb(Vec3::new(0.1, 0.2, 0.3), 0.05) };
        scene.lights.push(Light::Point(PointLight { intensity: Vec3::splat(power), ..lamp }));
    }
    let mut turned_round = scene.clone();
    turned_round.lights.reverse();
    let [a, b] = [scene, turned_round].map(|scene| light_at(&scene, &in_the_room(), 64));
    let (a, b) = (a?, b?);
    ensure(a == b, || format!("E is {} and {}, by the order of the list", a[0].irradiance, b[0].irradiance))
}

fn interpenetrating() -> Verdict {
    let mut scene = black_box();
    let mut second = under(black_box(), Affine3A::from_rotation_translation(askew(), Vec3::new(0.7, 0.6, 0.5)));
    for instance in &mut second.instances {
        instance.id = StableId::new(format!("second {}", instance.name));
    }
    join(&mut scene, &mut second);
    all_dark(&light_at(&under(scene, leaning()), &near_edges(), 1 << 10)?)
}

fn dark_box() -> Verdict {
    let white = || grey(0.9);
    let sides = [white(), white(), white(), white(), white(), white()];
    let scene = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, sides).sky(Vec3::splat(1e6)).build();
    all_dark(&light_at(&under(scene, leaning()), &near_edges(), 1 << 8)?)
}

/// A sheet that leans against a wall parts a black box; a lamp is on the one side.
fn leaning_sheet() -> Verdict {
    let sheet = [Vec3::new(1.5, 1.5, 0.0), Vec3::Z * 4.0];
    let mut scene = SceneBuilder::default()
        .room(Vec3::NEG_ONE, Vec3::ONE, [0.0; 6].map(grey))
        .quad("sheet", Vec3::new(-0.5, -1.0, -2.0), [sheet[0] * 2.0, sheet[1]], grey(0.0))
        .build();
    scene.lights.push(Light::Point(bulb(Vec3::new(-0.6, 0.5, 0.0), 0.0)));
    let points: Vec<MeterPoint> = [-0.8, -0.2, 0.1, 0.7].map(|z| at(Vec3::new(-0.499, -1.0, z), Vec3::Y)).to_vec();
    all_dark(&light_at(&under(scene, turned()), &points_under(&points, turned()), 64)?)
}

/// Two sheets with their backs to each other, so far apart, white above and black below, under a sun.
fn back_to_back(gap: f32) -> Verdict {
    let edges = [Vec3::Z * 2.0, Vec3::X * 2.0];
    let low = Vec3::new(-1.0, -gap, -1.0);
    let mut scene = SceneBuilder::default()
        .quad("above", Vec3::new(-1.0, 0.0, -1.0), edges, grey(0.9))
        .quad("below", low, [edges[1], edges[0]], grey(0.0))
        .build();
    scene.lights.push(Light::Directional(sun(Vec3::new(0.6, 0.8, 0.0), 0.0)));
    let scene = under(scene, turned());
    let lightmap = baked(&scene, &BakeSettings { samples_per_texel: 16, density: 4.0, ..BakeSettings::default() })?;
    for placement in &lightmap.placements {
        let page = &lightmap.pages[placement.page as usize];
        let size = Vec2::new(page.width as f32, page.height as f32);
        let [low, high] = [placement.uv_min, placement.uv_max].map(|uv| (Vec2::from(uv) * size).round());
        let expected = if placement.id == StableId::new("above") { 0.8 / PI } else { 0.0 };
        for y in low.y as u32..high.y as u32 {
            for x in low.x as u32..high.x as u32 {
                let found = f64::from(page.raw[(y * page.width + x) as usize].x);
                ensure((found - expected).abs() < 1e-5, || format!("a texel of {found}, not {expected}"))?;
            }
        }
    }
    Ok(())
}

/// A furnace whose walls are 98 304 instances of one square.
fn hundred_thousand() -> Verdict {
    let (count, root) = (128, turned());
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
    mean_reads(&light_at(&scene, &points, 1 << 11)?, PI / 0.2, 3e-3)
}

/// Both triangles are refused, and the room has its own light.
fn far_is_refused(distance: f32) -> Verdict {
    let scene = room_beside(distance);
    is_refused(&scene, &format!("instance \"far\" has a vertex {:.1e} m", distance))?;
    is_refused(&scene, &format!("instance \"farther\" has a vertex {:.1e} m", distance))?;
    beside(distance)
}

/// The room in a world with two triangles this far away on either side, against the room alone.
fn beside(distance: f32) -> Verdict {
    is_like_the_room(&room_beside(distance))
}

fn room_beside(distance: f32) -> Scene {
    let far = |side: f32| {
        [Vec3::ONE, Vec3::new(1.0, 0.5, 1.0), Vec3::new(0.5, 1.0, 1.0)].map(|way| side * distance * way).to_vec()
    };
    let mut scene = room();
    let mut others = SceneBuilder::default()
        .mesh("far", far(1.0), vec![0, 1, 2], None, grey(0.5))
        .mesh("farther", far(-1.0), vec![0, 1, 2], None, grey(0.5))
        .unchecked();
    join(&mut scene, &mut others);
    scene
}

/// Adds the meshes of another scene.
fn join(scene: &mut Scene, other: &mut Scene) {
    for instance in &mut other.instances {
        instance.mesh += scene.meshes.len();
        instance.material += scene.materials.len();
    }
    scene.meshes.append(&mut other.meshes);
    scene.materials.append(&mut other.materials);
    scene.instances.append(&mut other.instances);
}

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
    let [plain, extra] = [floor(false), floor(true)].map(|scene| texels(&scene));
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
    let (a, b) = (texels(a)?, texels(b)?);
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

/// A glowing square that faces down under a matrix that mirrors: it still faces down, or up where that mirrors it so.
fn lamp_under(scale: Vec3, side: f32) -> Verdict {
    let mut scene =
        SceneBuilder::default().quad("lamp", Vec3::new(-0.5, 0.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 1.0)).build();
    scene.instances[0].world_from_local = Affine3A::from_scale(scale);
    let points = [at(Vec3::NEG_Y * side, Vec3::Y * side), at(Vec3::Y * side, Vec3::NEG_Y * side)];
    let readings = light_at(&scene, &points, 1 << 12)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(0.5, 0.5, 1.0), 0.01)?;
    all_dark(&readings[1..])
}

/// A glowing square of 1 m whose mesh is as large as its transform is small.
fn squeezed(scale: Vec3) -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("lamp", Vec3::new(-0.5, 0.0, -0.5) / scale, [Vec3::X / scale.x, Vec3::Z / scale.z], glowing(0.0, 1.0))
        .build();
    scene.instances[0].world_from_local = Affine3A::from_quat(askew()) * Affine3A::from_scale(scale);
    let readings = light_at(&scene, &[at(askew() * Vec3::NEG_Y, askew() * Vec3::Y)], 1 << 12)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(0.5, 0.5, 1.0), 0.01)
}

fn quad() -> Scene {
    SceneBuilder::default().quad("quad", Vec3::ZERO, [Vec3::Z, Vec3::X], grey(0.5)).sky(Vec3::ONE).build()
}

/// The quad is refused with this sentence, and what is beside it is baked all the same.
fn instance_is_refused(sentence: &str, spoil: &dyn Fn(&mut Scene)) -> Verdict {
    let mut scene = quad();
    spoil(&mut scene);
    is_refused(&scene, &format!("instance \"quad\" {sentence}"))?;
    all_read(&light_at(&scene, &[at(Vec3::new(0.5, 3.0, 0.5), Vec3::Y)], 16)?, PI, 1e-5)
}

fn mesh_is_refused(sentence: &str, spoil: &dyn Fn(&mut Mesh)) -> Verdict {
    let mut scene = quad();
    spoil(&mut scene.meshes[0]);
    is_refused(&scene, &format!("mesh \"quad\" {sentence}"))?;
    all_read(&light_at(&scene, &[at(Vec3::new(0.5, 3.0, 0.5), Vec3::Y)], 16)?, PI, 1e-5)
}

fn transform_is_refused(transform: Affine3A) -> Verdict {
    instance_is_refused("has a transform that cannot be inverted", &|scene| {
        scene.instances[0].world_from_local = transform
    })
}

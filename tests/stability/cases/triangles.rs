//! Shapes and placements of triangles: thin, tiny, huge, doubled, cut, turned inside out, and what is no triangle.

use crate::case::{Case, Verdict};
use crate::common::meter::{at, on_walls};
use crate::common::scenes::{SceneBuilder, furnace, glowing, grey};
use crate::guards::rays::{NO_CONSTANT, NO_LEAST_AREA, ORIGIN_MOVE, WATERTIGHT};
use crate::guards::scene::{DIRECTIONS, FRAMES, RELATIVE_DETERMINANT, SORTED, VALIDATED};
use crate::judge::{all_read, baked, ensure, is_refused, light_at, mean_reads, reads};
use crate::worlds::{askew, bulb, in_the_room, points_under, rectangle, room, sun, under};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, MeterPoint, MeterReading};
use bevy_kiln::math::corner_parallel_rectangle;
use bevy_kiln::scene::{Indices, Instance, Light, Material, Scene};
use bevy_kiln::trace::Tracer;
use glam::{Affine3A, DVec3, Mat3, Quat, Vec2, Vec3};
use std::f64::consts::PI;

const NAMELESS: &str = "NaN spreads through boxes and tree to all that the ray meets (Godot 95875, MoonRay 251)";
const NAMED: &str = "refused by name, with what to do; the rest of the scene is baked";

pub const CASES: &[Case] = &[
    Case { name: "fan", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: wall_in_slivers },
    Case { name: "fan_aimed", hard: "x", elsewhere: "x", holds: "x", guard: &WATERTIGHT, without: "x", check: aimed_at_slivers },
    Case { name: "tee_aimed", hard: "x", elsewhere: "x", holds: "x", guard: &WATERTIGHT, without: "x", check: aimed_at_a_t_junction },
    Case { name: "tee", hard: "x", elsewhere: "x", holds: "x", guard: &NO_CONSTANT, without: "x", check: dark_behind_a_t_junction },
    Case { name: "3mm", hard: "x", elsewhere: "x", holds: "x", guard: &NO_LEAST_AREA, without: "x", check: || shadow_of(&[Vec3::new(-1e-3, 1.0, -1e-3), Vec3::new(2e-3, 1.0, -1e-3), Vec3::new(-1e-3, 1.0, 2e-3)]) },
    Case { name: "3um", hard: "x", elsewhere: "x", holds: "x", guard: &NO_LEAST_AREA, without: "x", check: || shadow_of(&[Vec3::new(-1e-6, 1.0, -1e-6), Vec3::new(2e-6, 1.0, -1e-6), Vec3::new(-1e-6, 1.0, 2e-6)]) },
    Case { name: "needle", hard: "x", elsewhere: "x", holds: "x", guard: &NO_LEAST_AREA, without: "x", check: || shadow_of(&[Vec3::new(-5e-7, 1.0, -0.5), Vec3::new(5e-7, 1.0, -0.5), Vec3::new(0.0, 1.0, 0.5)]) },
    Case { name: "doubled", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: doubled },
    Case { name: "coincident", hard: "x", elsewhere: "x", holds: "x", guard: &SORTED, without: "x", check: coincident },
    Case { name: "lamps", hard: "x", elsewhere: "x", holds: "x", guard: &SORTED, without: "x", check: lamps_in_one_place },
    Case { name: "boxes", hard: "x", elsewhere: "x", holds: "x", guard: &NO_CONSTANT, without: "x", check: interpenetrating },
    Case { name: "darkbox", hard: "x", elsewhere: "x", holds: "x", guard: &NO_CONSTANT, without: "x", check: dark_box },
    Case { name: "lean", hard: "x", elsewhere: "x", holds: "x", guard: &NO_CONSTANT, without: "x", check: leaning_sheet },
    Case { name: "b2b", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || back_to_back(0.0) },
    Case { name: "thin", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || back_to_back(1e-4) },
    Case { name: "1e5", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: hundred_thousand },
    Case { name: "f15", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || furnace_of(1e15) },
    Case { name: "f30", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || furnace_of(1e30) },
    Case { name: "far15", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || beside(1e15) },
    Case { name: "far30", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || beside(1e30) },
    Case { name: "far38", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || beside(3e38) },
    Case { name: "zero_area", hard: "x", elsewhere: "x", holds: "x", guard: &DIRECTIONS, without: "x", check: zero_area },
    Case { name: "n_zero", hard: "x", elsewhere: "x", holds: "x", guard: &DIRECTIONS, without: "x", check: || broken_normals(Vec3::ZERO) },
    Case { name: "n_nan", hard: "x", elsewhere: "x", holds: "x", guard: &DIRECTIONS, without: "x", check: || broken_normals(Vec3::NAN) },
    Case { name: "n_inf", hard: "x", elsewhere: "x", holds: "x", guard: &DIRECTIONS, without: "x", check: || broken_normals(Vec3::splat(f32::INFINITY)) },
    Case { name: "n_opp", hard: "x", elsewhere: "x", holds: "x", guard: &DIRECTIONS, without: "x", check: || broken_normals(Vec3::new(0.2, -1.0, 0.1)) },
    Case { name: "mirrored", hard: "x", elsewhere: "x", holds: "x", guard: &FRAMES, without: "x", check: || lamp_under(Vec3::new(-1.0, 1.0, 1.0), 1.0) },
    Case { name: "insideout", hard: "x", elsewhere: "x", holds: "x", guard: &FRAMES, without: "x", check: || lamp_under(Vec3::NEG_ONE, -1.0) },
    Case { name: "tiny", hard: "x", elsewhere: "x", holds: "x", guard: &RELATIVE_DETERMINANT, without: "x", check: || squeezed(Vec3::splat(1e-6)) },
    Case { name: "squeezed", hard: "x", elsewhere: "x", holds: "x", guard: &RELATIVE_DETERMINANT, without: "x", check: || squeezed(Vec3::new(1e-2, 1.0, 1e-8)) },
    Case { name: "sheared", hard: "x", elsewhere: "x", holds: "x", guard: &FRAMES, without: "x", check: || normals_under(Mat3::from_cols(Vec3::X, Vec3::new(1.5, 1.0, 0.5), Vec3::new(-0.5, 0.0, 1.0))) },
    Case { name: "flattened", hard: "x", elsewhere: "x", holds: "x", guard: &FRAMES, without: "x", check: || normals_under(Mat3::from_diagonal(Vec3::new(1.0, 1e-6, 1.0)) * Mat3::from_rotation_z(0.3)) },
    Case { name: "near_singular", hard: "x", elsewhere: "x", holds: "x", guard: &RELATIVE_DETERMINANT, without: "x", check: || transform_is_refused(Affine3A::from_mat3(Mat3::from_cols(1e4 * Vec3::X, 1e4 * (Vec3::X + 1e-10 * Vec3::Y), 1e4 * Vec3::Z))) },
    Case { name: "singular", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || transform_is_refused(Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))) },
    Case { name: "t_nan", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || transform_is_refused(Affine3A::from_scale(Vec3::new(1.0, f32::NAN, 1.0))) },
    Case { name: "t_inf", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || transform_is_refused(Affine3A::from_translation(Vec3::new(f32::INFINITY, 0.0, 0.0))) },
    Case { name: "v_nan", hard: "x", elsewhere: NAMELESS, holds: NAMED, guard: &VALIDATED, without: "x", check: || mesh_is_refused("has a position that is not a finite number (vertex 2)", &|mesh| mesh.positions[2].y = f32::NAN) },
    Case { name: "v_inf", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || mesh_is_refused("has a position that is not a finite number (vertex 1)", &|mesh| mesh.positions[1].x = f32::INFINITY) },
    Case { name: "index", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || mesh_is_refused("has index 9 but only 4 vertices", &|mesh| mesh.indices = Indices::U32(vec![0, 1, 9])) },
    Case { name: "empty", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || mesh_is_refused("has no triangle with an area", &|mesh| { mesh.positions.clear(); mesh.uv1 = None; mesh.indices = Indices::None; }) },
    Case { name: "no_area", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || mesh_is_refused("has no triangle with an area", &|mesh| mesh.positions = vec![Vec3::ONE; 4]) },
    Case { name: "uv1_area", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || instance_is_refused("has a UV1 (TEXCOORD_1) without area", &|scene| scene.meshes[0].uv1 = Some(vec![Vec2::ONE; 4])) },
    Case { name: "uv1_nan", hard: "x", elsewhere: "x", holds: "x", guard: &VALIDATED, without: "x", check: || instance_is_refused("has a UV1 (TEXCOORD_1) outside the unit square (vertex 0)", &|scene| scene.meshes[0].uv1 = Some(vec![Vec2::NAN; 4])) },
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
    mean_reads(&light_at(&scene, &points, 1 << 10)?, PI / 0.2, 3e-3)
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
        [point(-1.0, -1.0), point(-1.0, 1.0), point(0.1, 1.0), point(0.1, -1.0)],
        [point(0.1, -1.0), point(0.1, cut), point(1.0, cut), point(1.0, -1.0)],
        [point(0.1, cut), point(0.1, 1.0), point(1.0, 1.0), point(1.0, cut)],
    ];
    let indices = (0..3).flat_map(|quad| [0, 1, 2, 0, 2, 3].map(|corner| 4 * quad + corner)).collect();
    (quads.concat(), indices)
}

/// f32 puts each end of an edge, and the vertex between them, off by half a step of the largest coordinate (8 m here:
/// 2⁻²² m), along three axes: a gap of at most 2·√3·2⁻²² m, and 2 m long.
fn aimed_at_a_t_junction() -> Verdict {
    let edge = [Vec3::new(0.1, -1.0, -1.0), Vec3::new(0.1, -1.0, 1.0)];
    let leak = entering(&under(with_floor(black_box(), tee()), turned()), &[edge], 4e-6);
    let bound = 2.0 * 3.0_f64.sqrt() * 2.0_f64.powi(-22) * 2.0;
    ensure(leak <= bound, || format!("{leak:.2e} lx enter at a T-junction, more than {bound:.2e}"))
}

/// Points inside, a millimetre from edges and from the T.
fn near_edges() -> Vec<MeterPoint> {
    let near = 0.999;
    let along = [-0.9, -1.0 / 3.0, 0.0, 0.4];
    let floor = along.iter().flat_map(|&x| {
        [(Vec3::new(x, -1.0, near), Vec3::Y), (Vec3::new(-near, -1.0, x), Vec3::Y), (Vec3::new(near, x, 1.0), Vec3::NEG_Z)]
    });
    let corners = [(Vec3::new(near, near, 1.0), Vec3::NEG_Z), (Vec3::new(0.1, -1.0, -near), Vec3::Y)];
    floor.chain(corners).map(|(place, facing)| at(place, facing)).collect()
}

fn all_dark(readings: &[MeterReading]) -> Verdict {
    ensure(!readings.is_empty(), || "nothing was read".into())?;
    readings
        .iter()
        .try_for_each(|reading| ensure(reading.irradiance == DVec3::ZERO, || format!("E is {}, not 0", reading.irradiance)))
}

fn dark_behind_a_t_junction() -> Verdict {
    let scene = under(with_floor(black_box(), tee()), turned());
    all_dark(&light_at(&scene, &points_under(&near_edges(), turned()), 1 << 10)?)
}

/// A floor of 250 m, a point 2 m over it and a triangle between.
fn shadow_of(triangle: &[Vec3; 3]) -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-125.0, 0.0, -125.0), [Vec3::Z * 250.0, Vec3::X * 250.0], grey(0.0))
        .mesh("triangle", triangle.to_vec(), vec![0, 1, 2], None, grey(0.0))
        .build();
    scene.lights.push(Light::Point(bulb(2.0 * Vec3::Y, 0.0)));
    scene.lights.push(Light::Point(bevy_kiln::scene::PointLight { id: StableId::new("below"), ..bulb(Vec3::NEG_Y, 0.0) }));
    let places = [Vec3::ZERO, Vec3::new(0.1, 0.0, 0.0), Vec3::new(124.0, 0.0, -124.5)];
    let readings = light_at(&scene, &places.map(|place| at(place, Vec3::Y)), 256)?;
    all_dark(&readings[..1]).map_err(|error| format!("in the shadow {error}"))?;
    places[1..].iter().zip(&readings[1..]).try_for_each(|(place, reading)| {
        reads(reading, 2.0 / (place.as_dvec3() - 2.0 * DVec3::Y).length().powi(3), 1e-5)
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

fn doubled() -> Verdict {
    let (once, twice) = (mean(&texels(&room())?), mean(&texels(&doubled_room(Material::clone))?));
    ensure((twice / once - 1.0).abs() < 1e-3, || format!("the mean texel is {twice:.5}, and {once:.5} of single walls"))
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
        let lamp = bevy_kiln::scene::PointLight { id: StableId::new(name), ..bulb(Vec3::new(0.1, 0.2, 0.3), 0.05) };
        scene.lights.push(Light::Point(bevy_kiln::scene::PointLight { intensity: Vec3::splat(power), ..lamp }));
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
        instance.mesh += scene.meshes.len();
        instance.material += scene.materials.len();
    }
    scene.meshes.append(&mut second.meshes);
    scene.materials.append(&mut second.materials);
    scene.instances.append(&mut second.instances);
    all_dark(&light_at(&under(scene, turned()), &points_under(&near_edges(), turned()), 1 << 10)?)
}

fn dark_box() -> Verdict {
    let white = || grey(0.9);
    let sides = [white(), white(), white(), white(), white(), white()];
    let scene = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, sides).sky(Vec3::splat(1e6)).build();
    all_dark(&light_at(&under(scene, turned()), &points_under(&near_edges(), turned()), 1 << 8)?)
}

/// A sheet that leans against a wall parts a black box; a lamp is on the one side.
fn leaning_sheet() -> Verdict {
    let sheet = [Vec3::new(1.5, 1.5, 0.0), Vec3::Z * 4.0];
    let mut scene = SceneBuilder::default()
        .room(Vec3::NEG_ONE, Vec3::ONE, [0.0; 6].map(grey))
        .quad("sheet", Vec3::new(-0.5, -1.0, -2.0), [sheet[0] * 2.0, sheet[1]], grey(0.0))
        .build();
    scene.lights.push(Light::Point(bulb(Vec3::new(-0.6, 0.5, 0.0), 0.0)));
    let points: Vec<MeterPoint> =
        [-0.8, -0.2, 0.1, 0.7].map(|z| at(Vec3::new(-0.499, -1.0, z), Vec3::Y)).to_vec();
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
    let count = 128;
    let mut scene = SceneBuilder::default().quad("tile", Vec3::ZERO, [Vec3::X, Vec3::Y], glowing(0.5, 1.0)).build();
    scene.instances.clear();
    let pitch = 2.0 / count as f32;
    let faces = [
        Quat::IDENTITY,
        Quat::from_rotation_y(PI as f32),
        Quat::from_rotation_y(PI as f32 / 2.0),
        Quat::from_rotation_y(-PI as f32 / 2.0),
        Quat::from_rotation_x(PI as f32 / 2.0),
        Quat::from_rotation_x(-PI as f32 / 2.0),
    ];
    for (face, turn) in faces.into_iter().enumerate() {
        let face_root = turned() * Affine3A::from_mat3(Mat3::from_quat(turn).to_cols_array_2d().map(|c| c.map(f32::round)).into_matrix());
        for tile in 0..count * count {
            let corner = Vec3::new((tile % count) as f32 * pitch - 1.0, (tile / count) as f32 * pitch - 1.0, -1.0);
            let own = Affine3A::from_scale_rotation_translation(Vec3::splat(pitch), Quat::IDENTITY, corner);
            let id = StableId::new(format!("{face} {tile}"));
            let name = "tile".to_owned();
            scene.instances.push(Instance { id, name, mesh: 0, material: 0, world_from_local: face_root * own, lightmap: None });
        }
    }
    let points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 1), turned());
    mean_reads(&light_at(&scene, &points, 1 << 10)?, PI / 0.5, 3e-3)
}

trait IntoMatrix {
    fn into_matrix(self) -> Mat3;
}

impl IntoMatrix for [[f32; 3]; 3] {
    fn into_matrix(self) -> Mat3 {
        Mat3::from_cols_array_2d(&self)
    }
}

fn furnace_of(scale: f32) -> Verdict {
    let root = Affine3A::from_quat(askew()) * Affine3A::from_scale(Vec3::splat(scale));
    let points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), root);
    let mut scene = furnace(0.8);
    for mesh in &mut scene.meshes {
        mesh.positions.iter_mut().for_each(|position| *position = root.transform_point3(*position));
    }
    mean_reads(&light_at(&scene, &points, 1 << 10)?, PI / 0.2, 3e-3)
}

/// A furnace of 2 m in a world with two triangles this far away on either side.
fn beside(distance: f32) -> Verdict {
    let far = |side: f32| vec![side * Vec3::splat(distance), side * Vec3::new(distance, 0.5 * distance, distance), side * Vec3::new(0.5 * distance, distance, distance)];
    let mut scene = under(furnace(0.8), Affine3A::from_quat(askew()));
    let builder = SceneBuilder::default()
        .mesh("far", far(1.0), vec![0, 1, 2], None, grey(0.5))
        .mesh("farther", far(-1.0), vec![0, 1, 2], None, grey(0.5))
        .build();
    let (meshes, materials) = (scene.meshes.len(), scene.materials.len());
    scene.meshes.extend(builder.meshes);
    scene.materials.extend(builder.materials);
    scene.instances.extend(builder.instances.into_iter().map(|instance| Instance {
        mesh: instance.mesh + meshes,
        material: instance.material + materials,
        ..instance
    }));
    let points = points_under(&on_walls(Vec3::splat(-0.9), Vec3::splat(0.9), 1), Affine3A::from_quat(askew()));
    mean_reads(&light_at(&scene, &points, 1 << 10)?, PI / 0.2, 5e-3)
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
    let same = a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (*a - *b).abs().max_element() <= 1e-4 * a.max_element());
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
    let mut scene = SceneBuilder::default()
        .quad("lamp", Vec3::new(-0.5, 0.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 1.0))
        .build();
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

fn mesh_is_refused(sentence: &str, spoil: &dyn Fn(&mut bevy_kiln::scene::Mesh)) -> Verdict {
    let mut scene = quad();
    spoil(&mut scene.meshes[0]);
    is_refused(&scene, &format!("mesh \"quad\" {sentence}"))?;
    all_read(&light_at(&scene, &[at(Vec3::new(0.5, 3.0, 0.5), Vec3::Y)], 16)?, PI, 1e-5)
}

fn transform_is_refused(transform: Affine3A) -> Verdict {
    instance_is_refused("has a transform that cannot be inverted", &|scene| scene.instances[0].world_from_local = transform)
}

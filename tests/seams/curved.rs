//! Curved meshes under one lamp.

use crate::charted::{Patch, capsule, cylinder, mesh, pipe, sphere, torus};
use crate::common::scenes::grey;
use crate::judge::{Edges, Look, TARGET, bake, in_shared_exponents, pairs, settings, unrepaired, worst_jump};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Filtering, Lightmap, SeamReport};
use bevy_kiln::scene::{Indices, Instance, Light, LightmapRequest, Mesh, PointLight, Scene};
use glam::{Affine3A, Quat, Vec2, Vec3};

/// A shape over a grey floor, which is not baked, under one lamp.
pub fn scene(name: &str, patches: &[Patch]) -> Scene {
    let floor = Mesh {
        name: "floor".into(),
        indices: Indices::U16(vec![0, 2, 1, 0, 3, 2]),
        positions: [[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]].map(|[x, z]| Vec3::new(x, -1.0, z)).to_vec(),
        ..Mesh::default()
    };
    let instance = |mesh: usize, name: &str| Instance {
        id: StableId::new(name),
        name: name.into(),
        mesh,
        material: 0,
        world_from_local: Affine3A::IDENTITY,
        lightmap: None,
    };
    let turned = Affine3A::from_rotation_translation(Quat::from_rotation_z(0.3), Vec3::new(0.1, 0.2, -0.1));
    let shape = Instance { world_from_local: turned, lightmap: Some(LightmapRequest::default()), ..instance(1, name) };
    let lamp = PointLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        position: Vec3::new(1.2, 2.0, 0.9),
        intensity: Vec3::new(100.0, 90.0, 60.0),
        radius: 0.1,
        range: None,
    };
    let scene = Scene {
        meshes: vec![floor, mesh(name, patches)],
        materials: vec![grey(0.6)],
        instances: vec![instance(0, "floor"), shape],
        lights: vec![Light::Point(lamp)],
        ..Scene::default()
    };
    assert_eq!(scene.validate(), []);
    scene
}

fn report(lightmap: &Lightmap) -> SeamReport {
    lightmap.report.seams.expect("there are seams")
}

fn check(name: &str, patches: &[Patch]) -> Result<(), String> {
    let scene = scene(name, patches);
    let lightmap = bake(&scene, &settings(48.0, 64));
    let pairs = pairs(&scene, Edges::Smooth);
    let bare = worst_jump(&scene, &unrepaired(&lightmap), &pairs);
    let jump = worst_jump(&scene, &lightmap, &pairs);
    let kept = worst_jump(&scene, &in_shared_exponents(&lightmap), &pairs);
    let SeamReport { joints, samples, before, after } = report(&lightmap);
    println!(
        "{name}: {joints} joints, {samples} samples; jump {:.2} % as measured, {:.2} % (p99 {:.2} %) before, {:.2} % \
         after by the report; {:.2} % as displayed, {:.2} % in shared exponents; noise {:.1} %",
        100.0 * bare,
        100.0 * before.max,
        100.0 * before.p99,
        100.0 * after.max,
        100.0 * jump,
        100.0 * kept,
        100.0 * lightmap.report.relative_stderr.mean,
    );
    if bare < 2.0 * TARGET {
        return Err(format!("{name}: there is nothing to mend: {bare}"));
    }
    if jump.max(kept) > TARGET { Err(format!("{name}: {jump} {kept}")) } else { Ok(()) }
}

#[test]
fn no_jump_on_a_sphere() {
    check("sphere", &sphere()).unwrap();
}

#[test]
fn no_jump_on_a_capsule() {
    check("capsule", &capsule()).unwrap();
}

#[test]
fn no_jump_on_a_cylinder() {
    check("cylinder", &cylinder()).unwrap();
}

#[test]
#[ignore = "misses its target: 1.04 % of the local value where the lamp's terminator crosses a slanted seam"]
fn no_jump_on_a_torus() {
    check("torus", &torus()).unwrap();
}

#[test]
fn no_jump_on_a_bent_pipe() {
    check("pipe", &pipe()).unwrap();
}

/// The edge between a cylinder's side and its cap is as hard as before: both sides are what was measured.
#[test]
fn a_hard_edge_stays_hard() {
    let scene = scene("cylinder", &cylinder());
    let lightmap = bake(&scene, &settings(48.0, 64));
    let pairs = pairs(&scene, Edges::Hard);
    let bare = unrepaired(&lightmap);
    let apart = |lightmap: &Lightmap| {
        let look = Look::new(&scene, lightmap, Filtering::Bilinear);
        let jumps = look.jumps(&pairs);
        jumps.iter().sum::<f32>() / jumps.len() as f32
    };
    let (before, after) = (apart(&bare), apart(&lightmap));
    assert!(before > 0.2 && (after / before - 1.0).abs() < 0.1, "{before} {after}");
    // A solve that knew no normals would leave nothing of it.
    let mut flat = lightmap.clone();
    flat.pages[0].radiance.fill(Vec3::ONE);
    assert!(apart(&flat) < 0.1 * before);
}

/// Faults that the judge of jumps must find.
#[test]
fn the_judge_sees_a_missing_solve_and_lookups_half_a_texel_off() {
    let scene = scene("sphere", &sphere());
    let lightmap = bake(&scene, &settings(48.0, 64));
    let pairs = pairs(&scene, Edges::Smooth);
    assert!(worst_jump(&scene, &unrepaired(&lightmap), &pairs) > TARGET);
    for filtering in [Filtering::Bilinear, Filtering::Bicubic] {
        let look = Look { shift: Vec2::splat(0.5), ..Look::new(&scene, &lightmap, filtering) };
        assert!(look.worst_jump(&pairs) > TARGET, "{filtering:?}");
    }
}

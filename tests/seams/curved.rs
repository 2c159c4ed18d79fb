//! Curved meshes under one lamp.

use crate::charted::{Patch, capsule, cylinder, mesh, pipe, sphere, torus};
use crate::common::scenes::grey;
use crate::judge::{
    Edges, Look, TARGET, bake, displayed, in_shared_exponents, pairs, settings, unrepaired, worst_jump,
};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Filtering, Lightmap, SeamReport};
use bevy_kiln::scene::{Indices, Instance, Light, LightmapRequest, Mesh, PointLight, Scene};
use glam::{Affine3A, EulerRot, Quat, Vec2, Vec3};

/// How a shape stands under its lamp.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    pub size: f32,
    pub turn: Quat,
    pub lamp: Vec3,
    pub lamp_radius: f32,
    pub density: f32,
    /// Changes the paths.
    pub seed: u64,
}

impl Default for Setting {
    fn default() -> Self {
        Self {
            size: 1.0,
            turn: Quat::from_rotation_z(0.3),
            lamp: Vec3::new(1.2, 2.0, 0.9),
            lamp_radius: 0.1,
            density: 96.0,
            seed: 0,
        }
    }
}

/// Who lays out the charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Charting {
    ByHand,
    Unwrapped,
}

/// A shape over a grey floor, which is not baked, under one lamp.
pub fn scene(name: &str, patches: &[Patch], charting: Charting, setting: &Setting) -> Scene {
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
    let place = Vec3::new(0.1, 0.2, -0.1);
    let turned = Affine3A::from_scale_rotation_translation(Vec3::splat(setting.size), setting.turn, place);
    let shape = Instance {
        world_from_local: turned,
        lightmap: Some(LightmapRequest::default()),
        ..instance(1, &format!("{name} {}", setting.seed))
    };
    let lamp = PointLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        position: setting.lamp,
        intensity: Vec3::new(100.0, 90.0, 60.0),
        radius: setting.lamp_radius,
        range: None,
    };
    let mut mesh = mesh(name, patches);
    if charting == Charting::Unwrapped {
        mesh.uv1 = None;
    }
    Scene {
        meshes: vec![floor, mesh],
        materials: vec![grey(0.6)],
        instances: vec![instance(0, "floor"), shape],
        lights: vec![Light::Point(lamp)],
        ..Scene::default()
    }
}

fn report(lightmap: &Lightmap) -> SeamReport {
    lightmap.report.seams.expect("there are seams")
}

type Shape = fn() -> Vec<Patch>;

/// All of them, by name.
const SHAPES: [(&str, Shape); 5] =
    [("sphere", sphere), ("capsule", capsule), ("cylinder", cylinder), ("torus", torus), ("pipe", pipe)];

fn check(name: &str, patches: &[Patch], charting: Charting, setting: &Setting) -> Result<(), String> {
    let scene = scene(name, patches, charting, setting);
    let lightmap = bake(&scene, &settings(setting.density, 64));
    let scene = displayed(&scene, &lightmap);
    let pairs = pairs(&scene, Edges::Smooth);
    let bare = worst_jump(&scene, &unrepaired(&lightmap), &pairs);
    let jump = worst_jump(&scene, &lightmap, &pairs);
    let kept = worst_jump(&scene, &in_shared_exponents(&lightmap), &pairs);
    let SeamReport { joints, samples, before, after } = report(&lightmap);
    println!(
        "{name}, {charting:?}: {joints} joints, {samples} samples; jump {:.2} % as measured, {:.2} % (p99 {:.2} %) before, {:.2} % \
         after by the report; {:.2} % as displayed, {:.2} % in shared exponents; noise {:.1} %",
        100.0 * bare,
        100.0 * before.max,
        100.0 * before.p99,
        100.0 * after.max,
        100.0 * jump,
        100.0 * kept,
        100.0 * lightmap.report.relative_stderr.mean,
    );
    // A cylinder's side unrolls into one chart, whose two ends are alike.
    if bare < 2.0 * TARGET && charting == Charting::ByHand {
        return Err(format!("{name}: there is nothing to mend: {bare}"));
    }
    if jump.max(kept) > TARGET { Err(format!("{name}: {jump} {kept}")) } else { Ok(()) }
}

fn by_hand(name: &str, patches: &[Patch]) {
    check(name, patches, Charting::ByHand, &Setting::default()).unwrap();
}

fn unwrapped(name: &str, patches: &[Patch], density: f32) {
    check(name, patches, Charting::Unwrapped, &Setting { density, ..Setting::default() }).unwrap();
}

/// The same shapes, whose charts nobody has laid out: they meet at all angles.
#[test]
fn no_jump_on_an_unwrapped_sphere() {
    unwrapped("sphere", &sphere(), 96.0);
}

#[test]
fn no_jump_on_an_unwrapped_capsule_and_cylinder() {
    unwrapped("capsule", &capsule(), 128.0);
    unwrapped("cylinder", &cylinder(), 96.0);
}

#[test]
#[ignore = "slow: 140 000 texels"]
fn no_jump_on_an_unwrapped_bent_pipe() {
    unwrapped("pipe", &pipe(), 256.0);
}

/// Its own shadow is sharpest where the tube is nearest, and there charts meet askew.
#[test]
#[ignore = "slow: 160 000 texels"]
fn no_jump_on_an_unwrapped_torus() {
    unwrapped("torus", &torus(), 192.0);
}

#[test]
fn no_jump_on_a_sphere() {
    by_hand("sphere", &sphere());
}

#[test]
fn no_jump_on_a_capsule() {
    by_hand("capsule", &capsule());
}

#[test]
fn no_jump_on_a_cylinder() {
    by_hand("cylinder", &cylinder());
}

/// Finer than the others, for a torus stands in its own shadow. The light along a seam must not change faster than by
/// e in six or seven texels, or two grids at an angle cannot show the same of it to 1 % of what is local.
#[test]
fn no_jump_on_a_torus() {
    check("torus", &torus(), Charting::ByHand, &Setting { density: 288.0, ..Setting::default() }).unwrap();
}

/// Where the edge of a shadow is as narrow as a texel, jumps are left at its dark foot, not the shadow smeared along
/// the seam: few, and small against the light beside them.
#[test]
fn what_texels_do_not_resolve_is_left_and_small() {
    let scene = scene("torus", &torus(), Charting::ByHand, &Setting::default());
    let lightmap = bake(&scene, &settings(48.0, 64));
    let pairs = pairs(&scene, Edges::Smooth);
    for filtering in [Filtering::Bilinear, Filtering::Bicubic] {
        let look = Look::new(&scene, &lightmap, filtering);
        let jumps = look.jumps(&pairs);
        let above = jumps.iter().filter(|&&jump| jump > TARGET).count() as f32 / jumps.len() as f32;
        let worst = look.worst_jump_over_brightest(&pairs);
        println!(
            "torus, coarse, {filtering:?}: worst {:.2} %, above 1 % at {:.2} % of all points; {:.3} % of the brightest",
            100.0 * jumps[0],
            100.0 * above,
            100.0 * worst
        );
        assert!(above < 1e-2 && worst < 5e-3, "{above} {worst}");
    }
}

#[test]
fn no_jump_on_a_bent_pipe() {
    by_hand("pipe", &pipe());
}

/// The edge between a cylinder's side and its cap is as hard as before: both sides are what was measured.
#[test]
fn a_hard_edge_stays_hard() {
    let scene = scene("cylinder", &cylinder(), Charting::ByHand, &Setting::default());
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
    let scene = scene("sphere", &sphere(), Charting::ByHand, &Setting::default());
    let lightmap = bake(&scene, &settings(48.0, 64));
    let pairs = pairs(&scene, Edges::Smooth);
    assert!(worst_jump(&scene, &unrepaired(&lightmap), &pairs) > TARGET);
    for filtering in [Filtering::Bilinear, Filtering::Bicubic] {
        let look = Look { shift: Vec2::splat(0.5), ..Look::new(&scene, &lightmap, filtering) };
        assert!(look.worst_jump(&pairs) > TARGET, "{filtering:?}");
    }
}

/// The shapes in other places, sizes and lights, charted both ways.
#[test]
#[ignore = "slow: 110 bakes, a table to read"]
fn variations() {
    let base = Setting::default();
    let turn = |x: f32, y: f32, z: f32| Quat::from_euler(EulerRot::XYZ, x, y, z);
    let variations = [
        ("as tested", base),
        ("16 texels/m", Setting { density: 16.0, ..base }),
        ("24 texels/m", Setting { density: 24.0, ..base }),
        ("64 texels/m", Setting { density: 64.0, ..base }),
        ("other paths", Setting { seed: 77, ..base }),
        ("turned", Setting { turn: turn(1.1, 0.4, 2.0), ..base }),
        ("lamp aside", Setting { lamp: Vec3::new(-1.4, 0.8, 1.1), ..base }),
        ("small lamp", Setting { lamp_radius: 0.01, lamp: Vec3::new(0.4, 1.9, -1.4), ..base }),
        ("large lamp", Setting { lamp_radius: 0.4, ..base }),
        ("half the size", Setting { size: 0.5, density: 64.0, ..base }),
        ("turned, other paths", Setting { turn: turn(-0.7, 2.4, 0.6), seed: 3, density: 32.0, ..base }),
    ];
    let mut failures = Vec::new();
    for (label, setting) in variations {
        println!("{label}:");
        for (name, shape) in SHAPES {
            for charting in [Charting::ByHand, Charting::Unwrapped] {
                failures
                    .extend(check(name, &shape(), charting, &setting).err().map(|fault| format!("{label}: {fault}")));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

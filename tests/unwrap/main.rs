//! Every mesh gets a UV1 or is refused by name: charts overlap nowhere, with the border that filtering reads, and the
//! same mesh gives the same bits.

mod check;
mod faulty;
mod fuzz;
mod shapes;
mod shared;

extern crate bevy_kiln;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, CancelToken, TexelLayout, UnwrapMethod};
use bevy_kiln::scene::{Instance, LightmapRequest, Material, Mesh, Scene};
use check::judge;
use glam::{Affine3A, DVec2, Vec2, Vec3};
use shapes::*;

fn instance(id: &str, mesh: usize, world_from_local: Affine3A) -> Instance {
    Instance {
        id: StableId::new(id),
        name: id.into(),
        mesh,
        material: 0,
        world_from_local,
        lightmap: Some(LightmapRequest::default()),
    }
}

fn alone(mesh: Mesh) -> Scene {
    Scene {
        instances: vec![instance(&mesh.name.clone(), 0, Affine3A::IDENTITY)],
        meshes: vec![mesh],
        materials: vec![Material::diffuse("grey", Vec3::splat(0.5))],
        sky_radiance: Vec3::ONE,
        ..Scene::default()
    }
}

fn settings(density: f32) -> BakeSettings {
    BakeSettings { density, ..BakeSettings::default() }
}

fn layout(scene: &Scene, settings: &BakeSettings) -> TexelLayout {
    TexelLayout::for_scene(scene, settings, &CancelToken::default()).unwrap()
}

/// What a mesh is to become.
struct Case {
    mesh: Mesh,
    density: f32,
    charts: std::ops::RangeInclusive<u64>,
    /// Mean and worst.
    stretch: [f64; 2],
}

fn case(mesh: Mesh, density: f32, charts: std::ops::RangeInclusive<u64>, stretch: [f64; 2]) -> Case {
    Case { mesh, density, charts, stretch }
}

fn cases() -> Vec<Case> {
    let quad = mesh("quad", vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y], vec![0, 1, 2, 0, 2, 3]);
    vec![
        case(quad, 16.0, 1..=1, [1.01, 1.01]),
        case(sphere(32, 16), 16.0, 2..=10, [1.15, 1.7]),
        case(sphere(96, 48), 32.0, 2..=10, [1.15, 1.7]),
        case(capsule(32), 16.0, 3..=14, [1.15, 1.7]),
        case(torus(48, 24), 16.0, 4..=20, [1.15, 1.7]),
        case(tube(32), 16.0, 1..=1, [1.03, 1.05]),
        case(cone(32), 16.0, 1..=2, [1.05, 1.1]),
        case(bent_sheet(24), 16.0, 1..=1, [1.03, 1.05]),
        case(pipe(24, 12), 16.0, 2..=12, [1.15, 1.7]),
        case(moebius(48), 16.0, 1..=8, [1.15, 1.7]),
        case(cuboid("box", Vec3::ZERO, Vec3::ONE, 1), 16.0, 6..=6, [1.01, 1.01]),
        case(cuboid("fine box", Vec3::ZERO, Vec3::ONE, 20), 16.0, 6..=6, [1.01, 1.01]),
        case(terrain(80), 8.0, 1..=20, [1.2, 1.7]),
        case(bumpy(64, 32), 16.0, 2..=80, [1.25, 2.5]),
        case(chair(), 64.0, 36..=36, [1.3, 1.5]),
        case(stairs(10), 16.0, 40..=60, [1.2, 2.0]),
        case(arch(), 16.0, 4..=4, [1.05, 1.1]),
        case(crates(4, 3), 16.0, 24..=24, [1.2, 1.5]),
        case(clutter(2000), 16.0, 2000..=4000, [1.3, 3.0]),
        case(needles(300), 16.0, 1..=1, [1.05, 1.1]),
        case(strip(40), 16.0, 1..=1, [1.01, 1.01]),
    ]
}

#[test]
fn every_mesh_is_unwrapped() {
    for case in cases() {
        let name = case.mesh.name.clone();
        let scene = alone(case.mesh);
        let layout = layout(&scene, &settings(case.density));
        let figures = judge(&scene, &layout, case.density.into()).unwrap_or_else(|fault| panic!("{name}: {fault}"));
        println!("{name:>12} {figures:?}");
        assert_eq!(layout.warnings, [], "{name}");
        assert_eq!(layout.meshes[0].method, UnwrapMethod::Charts, "{name}");
        assert!(case.charts.contains(&figures.charts), "{name}: {figures:?}");
        assert_eq!(u64::from(layout.meshes[0].charts), figures.charts, "{name}");
        assert!(figures.stretch <= case.stretch[0] && figures.worst <= case.stretch[1], "{name}: {figures:?}");
    }
}

/// A mesh of a million triangles, without a word, is as sound as a small one.
#[test]
#[ignore = "a minute: what it takes is told by the bench"]
fn a_million_triangles() {
    let cases = [(sphere(1000, 500), 64.0, 10), (terrain(707), 64.0, 20), (crates(1667, 7), 32.0, 10_002)];
    for (mesh, density, charts) in cases {
        let name = mesh.name.clone();
        let scene = alone(mesh);
        let first = layout(&scene, &settings(density));
        assert_eq!(first.warnings, [], "{name}");
        let figures = judge(&scene, &first, density.into()).unwrap_or_else(|fault| panic!("{name}: {fault}"));
        println!("{name:>12} {figures:?} {:?}", first.pages);
        assert!(figures.charts <= charts && figures.stretch < 1.2, "{name}: {figures:?}");
        assert_eq!(first, layout(&scene, &settings(density)), "{name}: twice");
    }
}

/// The judge must see what it is there for.
#[test]
fn planted_faults_are_rejected() {
    let scene = alone(cuboid("box", Vec3::ZERO, Vec3::ONE, 1));
    let sound = layout(&scene, &settings(16.0));
    judge(&scene, &sound, 16.0).unwrap();
    let placement = &sound.placements[0];
    let page = DVec2::new(sound.pages[0][0].into(), sound.pages[0][1].into());
    let [low, high] = [placement.uv_min, placement.uv_max].map(|[u, v]| DVec2::new(u.into(), v.into()) * page);
    let moved = |vertices: &[u32], texels: DVec2| {
        let mut layout = sound.clone();
        for &vertex in vertices {
            let uv = &mut layout.meshes[0].uv1[vertex as usize];
            *uv = (*uv + (texels / (high - low)).as_vec2()).clamp(Vec2::ZERO, Vec2::ONE);
        }
        judge(&scene, &layout, 16.0).err().unwrap_or_default()
    };
    let indices = &sound.meshes[0].indices;
    // A chart one texel towards the next.
    let beside = indices.chunks(6).flat_map(|chart| [DVec2::X, DVec2::Y].map(|step| moved(&unique(chart), step)));
    let beside: Vec<String> = beside.filter(|fault| fault.contains("share") || fault.contains("block")).collect();
    assert!(beside.len() >= 4, "{beside:?}");
    // A chart on the next.
    let steps = [[17.0, 0.0], [-17.0, 0.0], [0.0, 17.0], [0.0, -17.0]];
    let onto = indices.chunks(6).flat_map(|chart| steps.map(|step| moved(&unique(chart), step.into())));
    assert!(onto.filter(|fault| fault.contains("two charts")).count() >= 4);
    // A corner across its own chart's diagonal.
    let lone: Vec<u32> = unique(&indices[..3]).into_iter().filter(|vertex| !indices[3..6].contains(vertex)).collect();
    let folded = [[14.0, 14.0], [-14.0, -14.0], [14.0, -14.0], [-14.0, 14.0]].map(|step| moved(&lone, step.into()));
    assert!(folded.iter().any(|fault| fault.contains("over itself")), "{folded:?}");
}

fn unique(vertices: &[u32]) -> Vec<u32> {
    let mut vertices = vertices.to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

//! Meshes that nobody would make on purpose, and UV1 that cannot carry a lightmap: unwrapped, or refused by name.

use crate::check::judge;
use crate::shapes::*;
use crate::{alone, instance, layout, settings};
use bevy_kiln::bake::{BakeError, BakeSettings, BakeWarning, CancelToken, TexelLayout, Uv1Fault, unwrap_meshes};
use bevy_kiln::scene::{FaultKind, Filter, Indices, Material, Mesh, Scene, Texels, Texture, TextureRef, UvChannel};
use glam::{Affine3A, Vec2, Vec3};

/// Unwraps a mesh without a word, judges it and gives its charts.
fn charts(mesh: Mesh, density: f32) -> u64 {
    let name = mesh.name.clone();
    let scene = alone(mesh);
    let layout = layout(&scene, &settings(density));
    assert_eq!(layout.warnings, [], "{name}");
    let figures = judge(&scene, &layout, density.into()).unwrap_or_else(|fault| panic!("{name}: {fault}"));
    println!("{name}: {figures:?}");
    figures.charts
}

fn grid(name: &str) -> Mesh {
    sheet(name, [4, 4], |u, v| Vec3::new(u, 0.0, 1.0 - v))
}

fn push(mesh: &mut Mesh, more: impl IntoIterator<Item = u32>) {
    let Indices::U32(indices) = &mut mesh.indices else { unreachable!("made here") };
    indices.extend(more);
}

#[test]
fn triangles_without_area_share_no_texel_with_others() {
    let mut mesh = grid("degenerate");
    push(&mut mesh, [0, 0, 1, 3, 3, 3, 0, 1, 2, 0, 24, 12]);
    assert_eq!(charts(mesh, 16.0), 1);
}

#[test]
fn copies_and_backs_have_charts_of_their_own() {
    let mut copied = grid("copied");
    let again: Vec<u32> = copied.triangles().flatten().collect();
    push(&mut copied, again);
    assert_eq!(charts(copied, 16.0), 2);

    let mut backed = grid("backed");
    let back: Vec<u32> = backed.triangles().flat_map(|[a, b, c]| [a, c, b]).collect();
    push(&mut backed, back);
    assert_eq!(charts(backed, 16.0), 2);
}

#[test]
fn thousands_of_faces_in_one_place_end_in_as_many_charts() {
    let mut pile = grid("pile");
    let again: Vec<u32> = pile.triangles().flatten().collect();
    (0..300).for_each(|_| push(&mut pile, again.iter().copied()));
    let meshes = unwrap_meshes(&alone(pile), &settings(1.0), &CancelToken::default()).unwrap();
    assert_eq!(meshes[0].charts, 301 * 32, "beyond a few in one place, none are joined");
}

#[test]
fn three_sheets_may_meet_in_an_edge() {
    let mut mesh = grid("three sheets");
    for turn in [1.0_f32, 2.0] {
        let lift = Vec3::new(-0.5 * turn, 1.0, 0.0);
        join(&mut mesh, &sheet("", [4, 4], |u, v| u * lift + Vec3::Z * (1.0 - v)));
    }
    assert!((2..=3).contains(&charts(mesh, 16.0)));
}

#[test]
fn a_mesh_whose_triangles_turn_every_way_is_unwrapped() {
    let mut mesh = grid("turned");
    let mut turned: Vec<u32> = Vec::new();
    for (index, [a, b, c]) in mesh.triangles().enumerate() {
        turned.extend(if index % 2 == 0 { [a, b, c] } else { [a, c, b] });
    }
    mesh.indices = Indices::U32(turned);
    assert_eq!(charts(mesh, 16.0), 32);
}

#[test]
fn large_and_small() {
    let triangle = |name: &str, size: f32| {
        mesh(name, [Vec3::ZERO, Vec3::X, Vec3::new(0.3, 0.8, 0.1)].map(|corner| size * corner).to_vec(), vec![0, 1, 2])
    };
    assert_eq!(charts(triangle("3 mm", 0.003), 16.0), 1);
    assert_eq!(charts(triangle("250 m", 250.0), 1.0), 1);
    let scene = alone(triangle("250 m", 250.0));
    let lowered = layout(&scene, &BakeSettings { max_page_size: 1024, ..settings(64.0) });
    let [BakeWarning::LoweredDensity { asked, got, limit, .. }] = lowered.warnings[..] else {
        panic!("{:?}", lowered.warnings)
    };
    assert!(asked == 64.0 && limit == 1020 && (3.8..4.8).contains(&got), "{got}");
    assert!(lowered.pages.iter().flatten().all(|&side| side <= 1024));
    judge(&scene, &lowered, got.into()).unwrap();
}

/// A quad that keeps its own UV1 and is too large as well.
#[test]
fn a_kept_uv1_too_large_for_a_page_is_lowered() {
    let quad = sheet("quad", [1, 1], |u, v| 100.0 * Vec3::new(u, 0.0, 1.0 - v));
    let scene = alone(with_uv1(quad, |_, position| Vec2::new(position.x, position.z) / 100.0));
    let lowered = layout(&scene, &BakeSettings { max_page_size: 510, ..settings(16.0) });
    assert!(lowered.meshes.is_empty());
    assert_eq!(lowered.pages, [[508, 508]]);
    assert!(matches!(lowered.warnings[..], [BakeWarning::LoweredDensity { limit: 504, .. }]), "{:?}", lowered.warnings);
}

#[test]
fn what_has_no_triangle_is_refused_by_name() {
    let empty = mesh("empty", vec![], vec![]);
    let flat = mesh("flat", vec![Vec3::ZERO, Vec3::X, 2.0 * Vec3::X], vec![0, 1, 2, 0, 0, 1]);
    for mesh in [empty, flat] {
        let layout = layout(&alone(mesh), &settings(16.0));
        let [BakeWarning::LeftOut(fault)] = &layout.warnings[..] else { panic!("{:?}", layout.warnings) };
        assert_eq!(fault.kind, FaultKind::NoTriangles);
        assert!(layout.placements.is_empty());
    }
}

fn fault_of(mesh: Mesh) -> Option<Uv1Fault> {
    let scene = alone(mesh);
    let layout = layout(&scene, &settings(16.0));
    match &layout.warnings[..] {
        [] => {
            assert!(layout.meshes.is_empty() && layout.placements[0].mesh.is_none());
            None
        }
        [BakeWarning::Unwrapped { fault, .. }] => {
            judge(&scene, &layout, 16.0).unwrap();
            Some(fault.clone())
        }
        others => panic!("{others:?}"),
    }
}

#[test]
fn a_valid_uv1_is_kept_and_any_other_is_told() {
    let plan = |_: usize, position: Vec3| Vec2::new(position.x, position.z);
    assert_eq!(fault_of(with_uv1(grid("valid"), plan)), None);
    let outside = fault_of(with_uv1(grid("outside"), |index, position| 1.1 * plan(index, position)));
    assert!(matches!(outside, Some(Uv1Fault::Outside { vertex: 0 })), "{outside:?}");
    let nan =
        fault_of(with_uv1(grid("nan"), |index, position| plan(index, position) / (index as f32 - 7.0).abs().min(0.0)));
    assert!(matches!(nan, Some(Uv1Fault::Outside { .. })), "{nan:?}");
    let halves = |index: usize, position: Vec3| (2.0 * plan(index, position)).map(|x| 1.0 - (x - 1.0).abs());
    let folded = fault_of(with_uv1(grid("folded"), halves));
    assert!(matches!(folded, Some(Uv1Fault::Overlaps { is_more: false, .. })), "{folded:?}");
    let bare = fault_of(with_uv1(grid("bare"), |index, position| plan(index, position).min(Vec2::splat(0.75))));
    assert!(matches!(bare, Some(Uv1Fault::WithoutArea { share }) if (share - 0.4375).abs() < 1e-6), "{bare:?}");
}

#[test]
fn a_uv1_that_textures_are_looked_up_by_is_not_touched() {
    let mut scene = alone(with_uv1(grid("tiled"), |_, position| 0.5 * Vec2::new(position.x, position.x)));
    scene.textures.push(Texture {
        name: "tiles".into(),
        width: 1,
        height: 1,
        texels: Texels::Linear8([[255; 4]].into()),
        wrap: Default::default(),
        filter: Filter::Linear,
    });
    scene.materials[0] = Material {
        base_colour_texture: Some(TextureRef { texture: 0, uv: UvChannel::Uv1 }),
        ..Material::diffuse("tiles", Vec3::splat(0.5))
    };
    let layout = layout(&scene, &settings(16.0));
    assert!(layout.meshes.is_empty());
    let in_use = |warning: &BakeWarning| matches!(warning, BakeWarning::Uv1InUse { .. });
    assert!(layout.warnings.iter().any(in_use), "{:?}", layout.warnings);
}

#[test]
fn a_mesh_in_too_many_pieces_for_a_page_is_refused_by_name() {
    let mut scene = alone(clutter(300));
    scene.meshes.push(cuboid("box", Vec3::ZERO, Vec3::ONE, 1));
    scene.instances.push(instance("box", 1, Affine3A::IDENTITY));
    let layout = layout(&scene, &BakeSettings { max_page_size: 64, ..settings(4.0) });
    let [BakeWarning::TooManyCharts { charts: 300, limit: 64, .. }] = &layout.warnings[..] else {
        panic!("{:?}", layout.warnings)
    };
    assert_eq!(layout.placements.len(), 1, "the box has its place");
}

#[test]
fn settings_and_cancelling() {
    let scene: Scene = alone(sphere(16, 8));
    for max_page_size in [0, 63, 4097, u32::MAX] {
        let settings = BakeSettings { max_page_size, ..BakeSettings::default() };
        let refused = TexelLayout::for_scene(&scene, &settings, &CancelToken::default());
        assert!(matches!(refused, Err(BakeError::Settings { .. })), "{max_page_size}");
    }
    let cancel = CancelToken::default();
    cancel.cancel();
    let stopped = TexelLayout::for_scene(&scene, &BakeSettings::default(), &cancel);
    assert_eq!(stopped, Err(BakeError::Cancelled));
}

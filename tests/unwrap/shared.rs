//! Many objects: what they share, what their order may not matter to, and what a bake makes of them.

use crate::check::judge;
use crate::shapes::*;
use crate::{alone, instance, layout, settings};
use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, TexelLayout, bake_lightmap};
use bevy_kiln::scene::Scene;
use glam::{Affine3A, Quat, Vec3};
use std::num::NonZeroUsize;

/// Meshes and shapes of many kinds, turned, scaled and mirrored.
fn crowd() -> Scene {
    let mut scene = alone(cuboid("box", Vec3::splat(-0.5), Vec3::ONE, 2));
    scene.instances.clear();
    scene.meshes.extend([sphere(24, 12), torus(32, 16), clutter(50), chair()]);
    for number in 0..40_u64 {
        let mesh = (number % 5) as usize;
        let turn = Quat::from_rotation_y(number as f32) * Quat::from_rotation_x(0.3 * number as f32);
        let size = [1.0, 1.5, 0.8, 3.0][(number / 5 % 4) as usize];
        let mirror = if number % 7 == 0 { Vec3::new(-1.0, 1.0, 1.0) } else { Vec3::ONE };
        let place = Vec3::new(10.0 * number as f32, 0.0, 0.0);
        let transform = Affine3A::from_scale_rotation_translation(size * mirror, turn, place);
        scene.instances.push(instance(&format!("thing {number:02}"), mesh, transform));
    }
    scene
}

#[test]
fn threads_and_order_cannot_matter() {
    let scene = crowd();
    let with = |scene: &Scene, threads: usize| {
        layout(scene, &BakeSettings { threads: NonZeroUsize::new(threads), ..settings(8.0) })
    };
    let one = with(&scene, 1);
    assert_eq!(one, with(&scene, 1), "twice");
    assert_eq!(one, with(&scene, 2));
    assert_eq!(one, with(&scene, 8));
    let mut shuffled = scene.clone();
    shuffled.instances.reverse();
    shuffled.instances.rotate_left(13);
    shuffled.meshes.rotate_left(2);
    shuffled.instances.iter_mut().for_each(|instance| instance.mesh = (instance.mesh + 3) % 5);
    let mut other = with(&shuffled, 2);
    other.meshes.iter_mut().for_each(|mesh| mesh.source = (mesh.source + 2) % 5);
    assert_eq!(one, other, "in another order");
}

#[test]
fn objects_of_one_shape_share_a_mesh() {
    let scene = crowd();
    let layout = layout(&scene, &settings(8.0));
    assert_eq!(layout.warnings, []);
    // Sizes 0.8, 1 and 1.5 in one mesh, 3 in another.
    assert_eq!(layout.meshes.len(), 10);
    assert_eq!(layout.placements.len(), 40);
    let figures = judge(&scene, &layout, 8.0).unwrap();
    println!("{figures:?}, {} pages", layout.pages.len());
    assert!(figures.stretch < 1.2, "{figures:?}");
}

/// A unit cube scaled to a wall has the texels of a wall.
#[test]
fn what_counts_is_the_shape_in_the_world() {
    for scale in [Vec3::new(6.0, 3.0, 0.25), Vec3::new(-0.5, 8.0, 2.0)] {
        let mut scene = alone(cuboid("box", Vec3::ZERO, Vec3::ONE, 1));
        scene.instances[0].world_from_local =
            Affine3A::from_scale_rotation_translation(scale, Quat::from_rotation_y(0.7), Vec3::ONE);
        let layout = layout(&scene, &settings(16.0));
        let figures = judge(&scene, &layout, 16.0).unwrap();
        assert!(figures.charts == 6 && figures.worst < 1.01, "{figures:?}");
        let faces = scale.abs().element_product() * 2.0 * 256.0 / scale.abs();
        assert_eq!(figures.covered, faces.element_sum() as u64, "whole texels");
    }
    // Sheared, so that squares become parallelograms.
    let mut scene = alone(cuboid("box", Vec3::ZERO, Vec3::ONE, 1));
    scene.instances[0].world_from_local =
        Affine3A::from_cols(Vec3::X.into(), Vec3::new(1.0, 1.0, 0.0).into(), Vec3::Z.into(), Vec3::ZERO.into());
    let figures = judge(&scene, &layout(&scene, &settings(16.0)), 16.0).unwrap();
    // Four sides are rectangles of √2 · 16 texels, stretched to 23.
    assert!(figures.charts == 6 && figures.worst < 1.02, "{figures:?}");
}

#[test]
fn a_shipped_mesh_is_rebuilt_from_its_source() {
    let scene = crowd();
    let layout = layout(&scene, &settings(8.0));
    for mesh in &layout.meshes {
        let source = &scene.meshes[mesh.source];
        assert_eq!(mesh.vertices.len(), mesh.uv1.len());
        assert!(mesh.indices.iter().all(|&index| (index as usize) < mesh.vertices.len()));
        assert!(mesh.vertices.iter().all(|&vertex| (vertex as usize) < source.positions.len()));
        // A sphere has triangles without area at its poles, whose vertices stand at the end.
        assert!(source.name == "sphere" || mesh.vertices.is_sorted(), "neighbours stay neighbours");
    }
}

/// A sphere without UV1 under an even sky sees the whole of it from everywhere.
#[test]
fn a_bake_of_what_was_unwrapped() {
    let mut scene = alone(sphere(32, 16));
    scene.materials[0].base_colour = Vec3::ZERO.extend(1.0);
    let settings = BakeSettings { goal: Goal::Samples(16), ..settings(4.0) };
    let lightmap = bake_lightmap(&scene, &settings, &(), &CancelToken::default()).unwrap();
    let layout: TexelLayout = layout(&scene, &settings);
    assert_eq!(lightmap.placements, layout.placements);
    assert_eq!(lightmap.meshes, layout.meshes);
    assert_eq!(lightmap.placements[0].mesh, Some(0));
    let report = &lightmap.report;
    assert_eq!((report.pages, report.unwrapped, report.warnings.len()), (1, 1, 0), "{report:?}");
    assert!((0.3..0.9).contains(&report.fill), "{}", report.fill);
    let page = &lightmap.pages[0];
    let covered = page.coverage.iter().zip(&page.raw).filter(|(coverage, _)| **coverage > 0.0);
    let mut count = 0;
    for (_, value) in covered {
        // Shading normals lean towards the horizon of a coarse sphere's faces.
        assert!((value.y - 1.0).abs() < 0.1, "{value}");
        count += 1;
    }
    assert_eq!(count as u64, report.texels);
}

//! The same light for the same world, however its meshes are placed, cut and listed.

mod common;

use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Lightmap, bake_lightmap};
use bevy_kiln::scene::{Indices, Scene, Topology};
use bevy_kiln::trace::Transport;
use common::meter::{at, read};
use common::scenes::{SceneBuilder, glowing, grey};
use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};

/// A lamp over a floor and a tilted blocker.
fn scene() -> Scene {
    SceneBuilder::default()
        .quad("blocker", Vec3::new(-0.4, 0.5, -0.3), [Vec3::new(0.1, 0.1, 0.9), Vec3::new(0.7, 0.2, 0.0)], grey(0.6))
        .quad("floor", Vec3::new(-2.0, 0.0, -2.0), [Vec3::Z * 4.0, Vec3::X * 4.0], grey(0.5))
        .quad("lamp", Vec3::new(-0.5, 1.5, -0.5), [Vec3::X, Vec3::Z], glowing(0.2, 3.0))
        .build()
}

/// Moves every mesh into another frame and places it so that the world stays as it was. A frame that mirrors turns
/// the triangles round: a front stays a front.
fn replaced(scene: &Scene, world_from_local: Affine3A) -> Scene {
    let mut scene = scene.clone();
    let local_from_world = world_from_local.inverse();
    for mesh in &mut scene.meshes {
        for position in &mut mesh.positions {
            *position = local_from_world.transform_point3(*position);
        }
        if world_from_local.matrix3.determinant() < 0.0 {
            let triangles: Vec<[u32; 3]> = mesh.triangles().collect();
            mesh.indices = Indices::U32(triangles.into_iter().flat_map(|[a, b, c]| [a, c, b]).collect());
        }
    }
    for instance in &mut scene.instances {
        instance.world_from_local = world_from_local;
    }
    scene
}

fn bake(scene: &Scene, density: f32) -> Lightmap {
    let settings = BakeSettings { goal: Goal::Samples(64), density, ..BakeSettings::default() };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

#[test]
fn mirrored_sheared_and_squeezed_placements() {
    let shear = Mat3::from_cols(Vec3::X, Vec3::new(2.0, 1.0, 0.5), Vec3::new(-1.0, 0.0, 1.0));
    let squeeze = Mat3::from_diagonal(Vec3::new(0.01, 30.0, 1.0));
    let mirror = Mat3::from_diagonal(Vec3::new(-1.0, 1.0, 1.0));
    let points = [(0.3, 0.2), (-1.1, 0.7), (1.4, -1.3)].map(|(x, z)| at(Vec3::new(x, 0.0, z), Vec3::Y));
    let truth = read(&scene(), &points, 1 << 12, Transport::default());
    for matrix in [shear, squeeze, mirror, mirror * shear, shear * squeeze] {
        let placement = Affine3A::from_mat3_translation(matrix, Vec3::new(3.0, -7.0, 0.5));
        let readings = read(&replaced(&scene(), placement), &points, 1 << 12, Transport::default());
        for (reading, truth) in readings.iter().zip(&truth) {
            // The same random numbers meet vertices that differ by rounding: far closer than the noise.
            assert!((reading.irradiance / truth.irradiance - 1.0).abs().max_element() < 2e-3, "{matrix}");
            assert!(truth.irradiance.min_element() > 0.1);
        }
    }
}

/// Scaling by a power of two rounds nothing, so not a bit may change: no length of our own is hidden anywhere.
#[test]
fn scale_does_not_matter_to_the_bit() {
    let truth = bake(&scene(), 4.0);
    for exponent in [-20, -10, 13, 28] {
        let scale = 2.0_f32.powi(exponent);
        let mut scaled = scene();
        for position in scaled.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
            *position *= scale;
        }
        let mut lightmap = bake(&scaled, 4.0 / scale);
        // Texels per metre are the one length of a page; those scale, to the bit.
        lightmap.pages.iter_mut().flat_map(|page| &mut page.density).for_each(|density| *density *= scale);
        assert_eq!(lightmap.pages.len(), 1);
        assert!(lightmap.pages == truth.pages, "scale 2^{exponent}");
    }
}

#[test]
fn a_turned_world_has_the_same_light() {
    let points = [(0.3, 0.2), (-1.1, 0.7), (1.4, -1.3)].map(|(x, z)| at(Vec3::new(x, 0.0, z), Vec3::Y));
    let truth = read(&scene(), &points, 1 << 13, Transport::default());
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -2.0);
    let mut turned = scene();
    for position in turned.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
        *position = turn * *position;
    }
    let turned_points = points.map(|point| at(turn * point.position, turn * point.normal));
    let readings = read(&turned, &turned_points, 1 << 13, Transport::default());
    for (reading, truth) in readings.iter().zip(&truth) {
        let error = (reading.stderr * reading.stderr + truth.stderr * truth.stderr).x.sqrt();
        assert!((reading.irradiance - truth.irradiance).x.abs() < 4.5 * error, "{reading:?} {truth:?}");
        assert!(error < 0.01 * truth.irradiance.x);
    }
}

#[test]
fn strips_lists_and_small_indices_are_one() {
    let list = scene();
    let mut strip = scene();
    let mut plain = scene();
    for mesh in &mut strip.meshes {
        mesh.topology = Topology::TriangleStrip;
        mesh.indices = Indices::U16(vec![1, 2, 0, 3]);
    }
    for mesh in &mut plain.meshes {
        let corners: Vec<usize> = (0..mesh.corner_count()).map(|corner| mesh.vertex(corner) as usize).collect();
        mesh.positions = corners.iter().map(|&corner| mesh.positions[corner]).collect();
        mesh.uv1 = mesh.uv1.take().map(|uv1: Vec<Vec2>| corners.iter().map(|&corner| uv1[corner]).collect());
        mesh.indices = Indices::None;
    }
    assert_eq!((strip.validate(), plain.validate()), (vec![], vec![]));
    let points = [at(Vec3::new(0.3, 0.0, 0.2), Vec3::Y)];
    let reading = |scene: &Scene| read(scene, &points, 1 << 12, Transport::default())[0].irradiance;
    assert_eq!(reading(&plain), reading(&list));
    assert!((reading(&strip) / reading(&list) - 1.0).abs().max_element() < 5e-3);
}

#[test]
fn smooth_normals_receive_and_broken_ones_do_no_harm() {
    let mut smooth = scene();
    smooth.meshes[1].normals = Some(vec![Vec3::new(0.3, 1.0, 0.0); 4]);
    let bright = |scene: &Scene| bake(scene, 2.0).pages[0].raw.iter().map(|value| value.y).sum::<f32>();
    assert!((bright(&smooth) / bright(&scene()) - 1.0).abs() > 1e-3, "a turned normal receives other light");
    for broken in [Vec3::ZERO, Vec3::NAN, Vec3::NEG_Y, Vec3::splat(f32::INFINITY)] {
        let mut scene = scene();
        scene.meshes[1].normals = Some(vec![broken; 4]);
        let lightmap = bake(&scene, 2.0);
        assert!(lightmap.pages[0].radiance.iter().all(|value| value.is_finite()), "{broken}");
        assert!(bright(&scene) > 0.0);
    }
}

/// What a UV1 does to texels is told, never silent.
#[test]
fn overlapping_and_vanishing_uv1_are_named() {
    use bevy_kiln::bake::BakeWarning;
    let mut overlapping = scene();
    let uv1 = overlapping.meshes[1].uv1.as_mut().unwrap();
    // Both triangles of the floor on the same half of the square.
    (uv1[0], uv1[1], uv1[2], uv1[3]) = (Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::X);
    let warnings = bake(&overlapping, 2.0).report.warnings;
    assert!(matches!(&warnings[..], [BakeWarning::Unwrapped { .. }]), "{warnings:?}");

    let mut vanishing = scene();
    for uv in vanishing.meshes[1].uv1.as_mut().unwrap() {
        *uv = uv.with_y(0.5 + 1e-7 * uv.y);
    }
    let settings = BakeSettings {
        goal: Goal::Samples(16),
        layout: bevy_kiln::bake::Layout::Shared { size: 64 },
        ..BakeSettings::default()
    };
    // On a map that is shared, UV1 stays as it is.
    let warnings = |mut alone: Scene| {
        alone.instances.iter_mut().filter(|instance| instance.name != "floor").for_each(|other| other.lightmap = None);
        bake_lightmap(&alone, &settings, &(), &CancelToken::default()).unwrap().report.warnings
    };
    let of_overlapping = warnings(overlapping);
    let is_told = matches!(&of_overlapping[..], [BakeWarning::OverlappingUv1 { texels, .. }] if *texels > 10);
    assert!(is_told, "{of_overlapping:?}");
    let of_vanishing = warnings(vanishing);
    assert!(matches!(&of_vanishing[..], [BakeWarning::NoTexels { .. }]), "{of_vanishing:?}");
}

//! Places and boxes at which a volume might break, and bits that nothing may change.

use crate::common::scenes::{SceneBuilder, glowing, grey, lit_room};
use crate::{along_axes, bake, given};
use bevy_kiln::bake::{
    BakeError, BakeWarning, CancelToken, Goal, ProbeState, VolumeBoxes, VolumeSettings, bake_volumes,
};
use bevy_kiln::scene::Scene;
use glam::{Quat, Vec3};
use std::num::NonZeroUsize;

fn refusal(scene: &Scene, settings: &VolumeSettings) -> BakeError {
    bake_volumes(scene, settings, &(), &CancelToken::default()).unwrap_err()
}

#[test]
fn neither_threads_nor_order_change_a_bit() {
    let scene = lit_room(0.6, 20.0);
    let settings = |threads: usize| VolumeSettings {
        threads: NonZeroUsize::new(threads),
        goal: Goal::Error(0.1),
        boxes: VolumeBoxes::Automatic { spacing: Some(1.0) },
        ..VolumeSettings::default()
    };
    let one = bake(&scene, &settings(1));
    assert_eq!(one.volumes, bake(&scene, &settings(3)).volumes);
    let mut turned = scene.clone();
    turned.instances.reverse();
    assert_eq!(one.volumes, bake(&turned, &settings(2)).volumes);
}

#[test]
fn probes_on_surfaces_in_corners_and_in_walls_are_numbers() {
    let scene = lit_room(0.9, 20.0);
    // Outermost probes exactly on the walls, in edges and corners.
    let on_walls = along_axes(Vec3::splat(-0.5), Vec3::splat(4.5), 1.0);
    // One cell; and cells of a millimetre.
    let single = along_axes(Vec3::splat(1.0), Vec3::splat(2.0), 100.0);
    let tiny = along_axes(Vec3::splat(1.0), Vec3::splat(1.003), 1e-3);
    for boxes in [on_walls, single, tiny] {
        let volume = bake(&scene, &given(vec![boxes], 64)).volumes.remove(0);
        assert_eq!(volume.cubes.len(), volume.resolution.element_product() as usize);
        for (cube, state) in volume.cubes.iter().zip(&volume.probes) {
            let is_light = cube.iter().all(|face| face.is_finite() && face.min_element() >= 0.0);
            assert!(is_light && cube.iter().any(|face| face.max_element() > 0.0), "{state:?}: {cube:?}");
        }
    }
}

#[test]
fn a_volume_in_a_body_is_left_out_by_name() {
    let scene = SceneBuilder::default()
        .sky(Vec3::ONE)
        .quad("floor", Vec3::new(-9.0, 0.0, -9.0), [Vec3::Z * 18.0, Vec3::X * 18.0], grey(0.5))
        .build();
    let below = along_axes(Vec3::new(-1.0, -2.0, -1.0), Vec3::new(1.0, -1.0, 1.0), 0.4);
    let above = along_axes(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 2.0, 1.0), 0.4);
    let alone = refusal(&scene, &given(vec![below.clone()], 16)).to_string();
    assert!(alone.contains("no probe of an irradiance volume stands in the air"), "{alone}");
    let both = bake(&scene, &given(vec![below, above], 16));
    assert_eq!(both.volumes.len(), 1);
    assert!(both.report.warnings.iter().any(|warning| matches!(warning, BakeWarning::NoAir { .. })));
}

#[test]
fn what_cannot_be_is_refused_with_a_reason() {
    let scene = lit_room(0.5, 20.0);
    let cube = along_axes(Vec3::ZERO, Vec3::ONE, 0.5);
    for (boxes, word) in [
        (crate::VolumeBox { size: Vec3::new(1.0, 0.0, 1.0), ..cube.clone() }, "box"),
        (crate::VolumeBox { centre: Vec3::NAN, ..cube.clone() }, "box"),
        (crate::VolumeBox { rotation: Quat::from_xyzw(0.0, 0.0, 0.0, 3.0), ..cube.clone() }, "box"),
        (crate::VolumeBox { spacing: Some(-1.0), ..cube.clone() }, "box"),
    ] {
        let refusal = refusal(&scene, &given(vec![boxes], 16)).to_string();
        assert!(refusal.starts_with("volume: ") && refusal.contains(word), "{refusal}");
    }
    let time = VolumeSettings { goal: Goal::Time(std::time::Duration::from_secs(1)), ..given(vec![cube.clone()], 1) };
    assert!(refusal(&scene, &time).to_string().contains("to an error or by paths"));
    let empty = SceneBuilder::default().build();
    assert!(matches!(refusal(&empty, &VolumeSettings::default()), BakeError::NoLight { .. }));
    let sky = SceneBuilder::default().sky(Vec3::ONE).build();
    assert!(matches!(refusal(&sky, &VolumeSettings::default()), BakeError::NothingToBake { .. }));
    let cancel = CancelToken::default();
    cancel.cancel();
    assert_eq!(bake_volumes(&scene, &given(vec![cube], 16), &(), &cancel), Err(BakeError::Cancelled));
}

/// A coarse map of a wide scene stays small, and objects that ask for many texels do not make it large.
#[test]
fn a_wide_scene_is_no_more_work_than_a_small_one() {
    let scene = |side: f32| {
        let floor = [Vec3::Z * side, Vec3::X * side];
        let corner = -0.5 * Vec3::new(side, 0.0, side);
        SceneBuilder::default().quad("floor", corner, floor, grey(0.5)).sky(Vec3::ONE).build()
    };
    let boxes = VolumeBoxes::Given(vec![along_axes(Vec3::Y, Vec3::new(1.0, 2.0, 1.0), 0.5)]);
    let settings = VolumeSettings { goal: Goal::Samples(64), boxes, ..VolumeSettings::default() };
    let texels = |scene: &Scene| bake(scene, &settings).report.first_pass.unwrap().texels;
    let mut wide = scene(4000.0);
    let few = texels(&wide);
    wide.instances[0].lightmap.as_mut().unwrap().density = Some(0.5);
    assert_eq!(texels(&wide), few);
    assert!((1000..100_000).contains(&few) && texels(&scene(2.0)) < 200, "{few}");
}

/// More than Bevy shows at once: baked all the same, and said.
#[test]
fn the_limit_of_eight_is_told() {
    let scene = lit_room(0.5, 20.0);
    let at = |place: f32| along_axes(Vec3::new(place, 1.0, 1.0), Vec3::new(place + 0.2, 1.2, 1.2), 1.0);
    let bake = bake(&scene, &given((1..10).map(|place| at(0.3 * place as f32)).collect(), 16));
    assert_eq!(bake.volumes.len(), 9);
    let warning = BakeWarning::TooManyVolumes { volumes: 9, limit: 8 };
    assert!(bake.report.warnings.contains(&warning), "{:?}", bake.report.warnings);
}

/// A shell of thin walls without light inside, as a cupboard, is a pocket: it darkens nothing around it.
#[test]
fn the_inside_of_a_cupboard_darkens_nothing() {
    let room = || SceneBuilder::default().room(Vec3::ZERO, Vec3::splat(3.0), [0; 6].map(|_| glowing(0.5, 1.0)));
    let (low, high) = (Vec3::new(1.2, 0.0, 1.2), Vec3::new(1.9, 0.9, 1.9));
    let inside = [low + 0.02, high - 0.02];
    let cupboard =
        room().block("outside", low, high, glowing(0.5, 1.0)).chamber("inside", inside[0], inside[1], grey(0.5));
    let cupboard = cupboard.build();
    let volume = bake(&cupboard, &given(vec![along_axes(Vec3::ZERO, Vec3::splat(3.0), 0.3)], 256)).volumes.remove(0);
    let filled = volume.probes.iter().filter(|&&state| state == ProbeState::Filled).count();
    assert!(filled > 0, "the inside is a pocket");
    for (cube, state) in volume.cubes.iter().zip(&volume.probes) {
        assert!(cube.iter().all(|face| (face.x / 2.0 - 1.0).abs() < 0.25), "{state:?}: {cube:?}");
    }
}

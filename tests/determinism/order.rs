//! Any number of threads, any order of the work, any order of the scene's parts.

use crate::common::garden::garden;
use crate::common::glb;
use crate::common::meter::{at, on_walls};
use crate::fingerprint::{Fingerprint, assert_same};
use crate::vitrine::vitrine;
use crate::{bake, common};
use bevy_kiln::bake::{
    BakeError, BakeSettings, CancelToken, Goal, LaterBounces, Layout, Lightmap, MeterPoint, MeterReading,
    MeterSettings, Progress, Stage, bake_lightmap, measure_irradiance,
};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Transport;
use common::scenes::{furnace, lit_room};
use common::statistics::Random;
use glam::Vec3;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

#[test]
fn one_thread_and_two_and_eight() {
    for layout in [Layout::Packed, Layout::Shared { size: 64 }] {
        let scene = glb::load("cornell");
        let one = bake(&scene, 1, layout);
        assert!(one.report.texels > 500);
        assert_same(&one, &bake(&scene, 2, layout));
        assert_same(&one, &bake(&scene, 8, layout));
    }
}

/// A closed room, whose energy balance is summed over what all threads bring; one wall alone has texels, so that
/// nearly all of it comes from paths of the balance's own, and the order of their sum shows.
#[test]
fn the_energy_balance_of_one_thread_and_two_and_eight() {
    // An albedo of many digits: with ½, every sum would be exact in any order.
    let mut room = lit_room(0.3, 10.0);
    room.instances[1..].iter_mut().for_each(|wall| wall.lightmap = None);
    let one = bake(&room, 1, Layout::Packed);
    assert!(one.report.energy_balance.is_some_and(|balance| (0.9..1.1).contains(&balance)));
    assert_same(&one, &bake(&room, 2, Layout::Packed));
    for _ in 0..2 {
        assert_same(&one, &bake(&room, 8, Layout::Packed));
    }
}

/// Meshes, materials, instances and lights in an order that chance picks.
fn shuffled(scene: &Scene, seed: u64) -> Scene {
    let mut random = Random::new(seed);
    let mut order = |count: usize| {
        let mut order: Vec<usize> = (0..count).collect();
        (1..count).for_each(|last| order.swap(last, random.bits() as usize % (last + 1)));
        order
    };
    let mut shuffled = scene.clone();
    let [meshes, materials, instances, lights] =
        [scene.meshes.len(), scene.materials.len(), scene.instances.len(), scene.lights.len()].map(&mut order);
    shuffled.meshes = meshes.iter().map(|&index| scene.meshes[index].clone()).collect();
    shuffled.materials = materials.iter().map(|&index| scene.materials[index].clone()).collect();
    shuffled.instances = instances.iter().map(|&index| scene.instances[index].clone()).collect();
    shuffled.lights = lights.iter().map(|&index| scene.lights[index].clone()).collect();
    let place = |order: &[usize], of: usize| order.iter().position(|&index| index == of).unwrap();
    for instance in &mut shuffled.instances {
        instance.mesh = place(&meshes, instance.mesh);
        instance.material = place(&materials, instance.material);
    }
    shuffled
}

#[test]
fn shuffled_meshes_materials_instances_and_lights() {
    for (scene, layouts) in [
        (glb::load("cornell"), [Layout::Packed, Layout::Shared { size: 64 }].as_slice()),
        (garden(), &[Layout::Packed]),
        (vitrine(), &[Layout::Packed]),
        (furnace(0.3), &[Layout::Packed]),
    ] {
        for &layout in layouts {
            let one = bake(&scene, 1, layout);
            for seed in 0..2 {
                assert_same(&one, &bake(&shuffled(&scene, seed), 2, layout));
            }
        }
    }
}

/// Threads that are held up after each piece of work, for a time that chance picks: the pieces then come to an end in
/// another order each time, whichever thread takes them.
#[test]
fn threads_that_are_held_up() {
    let scene = vitrine();
    let settings = |threads| BakeSettings {
        goal: Goal::Samples(16),
        density: 3.0,
        threads: NonZeroUsize::new(threads),
        ..BakeSettings::default()
    };
    let free = bake_lightmap(&scene, &settings(1), &(), &CancelToken::default()).unwrap();
    for seed in 0..4 {
        let turn = AtomicU64::new(100 * seed);
        let hold_up = |_: Progress| {
            let pause = Random::new(turn.fetch_add(1, Ordering::Relaxed)).bits() % 400;
            std::thread::sleep(Duration::from_micros(pause));
        };
        let held = bake_lightmap(&scene, &settings(8), &hold_up, &CancelToken::default()).unwrap();
        assert_same(&free, &held);
    }
}

/// Texels that are sampled to an error: how many paths each gets, and all that comes of them.
#[test]
fn threads_that_sample_to_an_error() {
    let scene = vitrine();
    let settings = |threads| BakeSettings {
        goal: Goal::Error(0.5),
        density: 3.0,
        threads: NonZeroUsize::new(threads),
        ..BakeSettings::default()
    };
    let bake = |threads| bake_lightmap(&scene, &settings(threads), &(), &CancelToken::default()).unwrap();
    let one = bake(1);
    let counts: std::collections::BTreeSet<u32> = one.pages.iter().flat_map(|page| page.samples.clone()).collect();
    assert!(counts.len() > 3, "all texels had the same paths: {counts:?}");
    for threads in [2, 8] {
        let other = bake(threads);
        assert_same(&one, &other);
        for (a, b) in one.pages.iter().zip(&other.pages) {
            assert!(a.samples == b.samples && a.rays == b.rays && a.half_width == b.half_width);
        }
    }
}

/// A bake whose paths end on the texels of its own first pass, and one that is stopped in it.
#[test]
fn threads_that_reuse_a_first_pass() {
    let scene = glb::load("cornell");
    let settings = |threads| BakeSettings {
        goal: Goal::Samples(16),
        later_bounces: LaterBounces::Reused,
        density: 2.0,
        threads: NonZeroUsize::new(threads),
        ..BakeSettings::default()
    };
    let bake = |threads| bake_lightmap(&scene, &settings(threads), &(), &CancelToken::default()).unwrap();
    let one = bake(1);
    let first = one.report.first_pass.unwrap();
    assert!(first.texels > one.report.texels / 2 && first.samples == 64 * one.report.texels, "{first:?}");
    for threads in [2, 8] {
        let other = bake(threads);
        assert_same(&one, &other);
        assert!(one.pages.iter().zip(&other.pages).all(|(a, b)| a.rays == b.rays && a.half_width == b.half_width));
    }
    let cancel = CancelToken::default();
    let stop = |progress: Progress| {
        if progress.stage == Stage::Prepare && progress.done > 0 {
            cancel.cancel();
        }
        assert!(progress.stage == Stage::Prepare, "went on to {:?}", progress.stage);
    };
    let stopped = bake_lightmap(&scene, &settings(2), &stop, &cancel);
    assert!(matches!(stopped, Err(BakeError::Cancelled)));
}

/// The texels of one object, without what its neighbours on the page add beside it.
fn own_texels(lightmap: &Lightmap, id: &str) -> Vec<[u32; 7]> {
    let place = lightmap.placements.iter().find(|place| place.id.as_str() == id).unwrap();
    let page = &lightmap.pages[place.page as usize];
    let texel = |uv: [f32; 2]| [(uv[0] * page.width as f32) as u32, (uv[1] * page.height as f32) as u32];
    let ([left, top], [right, bottom]) = (texel(place.uv_min), texel(place.uv_max));
    let rows = (top..bottom).flat_map(|y| (left..right).map(move |x| (y * page.width + x) as usize));
    let bits = |index: usize| {
        let ([r, g, b], [er, eg, eb]) = (page.raw[index].to_array(), page.stderr[index].to_array());
        [r, g, b, er, eg, eb, page.coverage[index]].map(f32::to_bits)
    };
    rows.map(bits).collect()
}

/// What is baked besides an object does not matter to its texels: a bake may be cut into any parts.
#[test]
fn an_object_baked_alone() {
    let scene = vitrine();
    let all = bake(&scene, 2, Layout::Packed);
    for id in ["floor", "paint"] {
        let mut alone = scene.clone();
        alone
            .instances
            .iter_mut()
            .filter(|instance| instance.id.as_str() != id)
            .for_each(|other| other.lightmap = None);
        let alone = bake(&alone, 2, Layout::Packed);
        assert_eq!(alone.placements.len(), 1);
        let texels = own_texels(&all, id);
        assert!(texels.len() >= 9 && texels.iter().any(|texel| texel[0] != 0), "{id}: {texels:?}");
        assert!(texels == own_texels(&alone, id), "{id} differs where it is baked alone");
    }
}

fn measure(points: &[MeterPoint], threads: usize) -> Vec<MeterReading> {
    let settings =
        MeterSettings { transport: Transport::default(), samples_per_point: 64, threads: NonZeroUsize::new(threads) };
    measure_irradiance(&vitrine(), points, &settings, &(), &CancelToken::default()).unwrap().readings
}

#[test]
fn points_in_any_order_and_alone() {
    let points = on_walls(Vec3::splat(-0.9), Vec3::splat(0.9), 4);
    let readings = measure(&points, 1);
    assert!(readings.iter().filter(|reading| reading.irradiance.min_element() > 0.0).count() > 40);
    let reversed: Vec<MeterPoint> = points.iter().rev().copied().collect();
    for threads in [1, 2, 8] {
        let mut back = measure(&reversed, threads);
        back.reverse();
        assert_eq!(Fingerprint::of_readings(&readings).same(&Fingerprint::of_readings(&back)), Ok(()));
    }
    for index in [0, 40, 95] {
        assert_eq!(measure(&points[index..=index], 8), readings[index..=index]);
    }
    // The same place with another face is another point.
    let turned = at(points[0].position, -points[0].normal);
    assert_ne!(measure(&[turned], 1), readings[..1]);
}

//! The same bits for any number of threads and any order of the scene's parts.

mod common;

use bevy_kiln::bake::{BakeSettings, CancelToken, Layout, Lightmap, bake_lightmap};
use bevy_kiln::scene::Scene;
use common::garden::garden;
use common::glb;
use std::num::NonZeroUsize;

fn bake(scene: &Scene, threads: usize, layout: Layout) -> Lightmap {
    let settings = BakeSettings {
        samples_per_texel: 32,
        density: 3.0,
        layout,
        threads: NonZeroUsize::new(threads),
        ..BakeSettings::default()
    };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// Every number of a lightmap, bit for bit.
fn bits(lightmap: &Lightmap) -> Vec<u32> {
    let layers = |page: &bevy_kiln::bake::Page| [page.radiance.clone(), page.raw.clone(), page.stderr.clone()];
    let values = lightmap.pages.iter().flat_map(layers).flatten().flat_map(|value| value.to_array());
    let coverage = lightmap.pages.iter().flat_map(|page| page.coverage.clone());
    values.chain(coverage).map(f32::to_bits).collect()
}

fn assert_same(a: &Lightmap, b: &Lightmap) {
    assert_eq!(a.placements, b.placements);
    assert!(bits(a) == bits(b), "texels differ");
    assert_eq!(a.report.rays, b.report.rays);
    assert_eq!(a.report.relative_stderr, b.report.relative_stderr);
}

#[test]
fn one_thread_and_two_and_seven() {
    for layout in [Layout::Packed, Layout::Shared { size: 64 }] {
        let scene = glb::load("cornell");
        let one = bake(&scene, 1, layout);
        assert!(one.report.texels > 500);
        assert_same(&one, &bake(&scene, 2, layout));
        assert_same(&one, &bake(&scene, 7, layout));
    }
}

#[test]
fn shuffled_meshes_materials_and_instances() {
    let scene = glb::load("cornell");
    let mut shuffled = scene.clone();
    shuffled.meshes.reverse();
    shuffled.materials.rotate_left(1);
    shuffled.instances.rotate_right(3);
    shuffled.instances.swap(0, 4);
    for instance in &mut shuffled.instances {
        instance.mesh = scene.meshes.len() - 1 - instance.mesh;
        instance.material = (instance.material + scene.materials.len() - 1) % scene.materials.len();
    }
    for layout in [Layout::Packed, Layout::Shared { size: 64 }] {
        assert_same(&bake(&scene, 2, layout), &bake(&shuffled, 2, layout));
    }
}

/// The same for a scene with something of nearly every effect, its lights and textures in another order too.
#[test]
fn a_garden_is_the_same_on_any_threads_and_in_any_order() {
    let scene = garden();
    let one = bake(&scene, 1, Layout::Packed);
    assert!(one.report.texels > 30 && one.report.relative_stderr.mean > 0.0);
    assert_same(&one, &bake(&scene, 2, Layout::Packed));
    assert_same(&one, &bake(&scene, 7, Layout::Packed));
    let mut shuffled = scene.clone();
    shuffled.lights.reverse();
    shuffled.materials.rotate_left(2);
    shuffled.instances.reverse();
    for instance in &mut shuffled.instances {
        instance.material = (instance.material + scene.materials.len() - 2) % scene.materials.len();
    }
    assert_same(&one, &bake(&shuffled, 2, Layout::Packed));
}

#[test]
fn another_seed_gives_other_bits() {
    let scene = glb::load("furnace");
    let mut settings = BakeSettings { samples_per_texel: 16, density: 2.0, ..BakeSettings::default() };
    let first = bake_lightmap(&scene, &settings, &(), &CancelToken::default()).unwrap();
    settings.transport.seed = 1;
    let second = bake_lightmap(&scene, &settings, &(), &CancelToken::default()).unwrap();
    assert!(bits(&first) != bits(&second));
}

#[test]
fn cancelled_in_the_middle() {
    let cancel = CancelToken::default();
    let progress = |progress: bevy_kiln::bake::Progress| {
        if progress.done > 0 {
            cancel.cancel();
        }
    };
    let result = bake_lightmap(&glb::load("furnace"), &BakeSettings::default(), &progress, &cancel);
    assert!(matches!(result, Err(bevy_kiln::bake::BakeError::Cancelled)));
}

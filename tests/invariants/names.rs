//! Neither the order in which meshes, materials, instances and lights are listed nor what they are called changes a
//! bit. An id does, since random numbers go by it; and then no more than noise.

use crate::Fault;
use crate::chance::{Search, finds, holds};
use crate::common::statistics::Random;
use crate::judge::{Mean, settle};
use crate::sketch::{ALL, INDOORS, Kind, Shell, Sketch, sketches};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Lightmap, bake_lightmap};
use bevy_kiln::scene::{Light, Scene};
use bevy_kiln::trace::Transport;

fn bake(scene: &Scene, samples: u32) -> Lightmap {
    // A clamp that nothing reaches spares the energy balance, which takes longer than such a bake.
    let transport = Transport { clamp: Some(1e30), ..Transport::default() };
    let settings = BakeSettings { goal: Goal::Samples(samples), density: 1.5, transport, ..BakeSettings::default() };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// All bits of all texels and places.
fn bits(lightmap: &Lightmap) -> Vec<u32> {
    let layers = |page: &bevy_kiln::bake::Page| {
        let colours =
            [&page.radiance, &page.raw, &page.stderr].into_iter().flatten().flat_map(|value| value.to_array());
        colours.chain(page.coverage.iter().copied()).map(f32::to_bits).collect::<Vec<_>>()
    };
    let places = |place: &bevy_kiln::bake::Placement| {
        let [low, high] = [place.uv_min, place.uv_max].map(|uv| uv.map(f32::to_bits));
        [[place.page, place.id.key() as u32], low, high].concat()
    };
    lightmap.pages.iter().flat_map(layers).chain(lightmap.placements.iter().flat_map(places)).collect()
}

fn same_bits(a: &Lightmap, b: &Lightmap) -> Result<(), String> {
    let (a, b) = (bits(a), bits(b));
    let apart = a.iter().zip(&b).filter(|(a, b)| a != b).count();
    if a == b { Ok(()) } else { Err(format!("{apart} of {} and {} numbers differ", a.len(), b.len())) }
}

fn mean_of(lightmap: &Lightmap) -> Mean {
    let texels = lightmap.pages.iter().flat_map(|page| {
        let covered = (0..page.raw.len()).filter(|&index| page.coverage[index] > 0.0);
        covered.map(|index| [page.raw[index].y, page.stderr[index].y].map(f64::from)).collect::<Vec<_>>()
    });
    let (value, squares, count) = texels.fold((0.0, 0.0, 0.0), |(value, squares, count), [texel, error]| {
        (value + texel, squares + error * error, count + 1.0)
    });
    Mean { value: value / count, error: f64::sqrt(squares) / count }
}

/// Everything listed in an order by chance.
fn shuffled(scene: &Scene) -> Scene {
    let mut random = Random::new(5);
    let mut order = |count: usize| {
        let mut order: Vec<usize> = (0..count).collect();
        (1..count).for_each(|last| order.swap(last, random.bits() as usize % (last + 1)));
        order
    };
    let counts = [scene.meshes.len(), scene.materials.len(), scene.instances.len(), scene.lights.len()];
    let [meshes, materials, instances, lights] = counts.map(&mut order);
    let mut shuffled = scene.clone();
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

fn set_ids(scene: &mut Scene, id: impl Fn(usize, &str) -> String) {
    for (turn, instance) in scene.instances.iter_mut().enumerate() {
        instance.id = StableId::new(id(turn, instance.id.as_str()));
    }
}

/// The list's order changes no bit.
fn order(sketch: &Sketch, fault: Fault) -> Result<(), String> {
    let (mut scene, mut other) = (sketch.scene(), shuffled(&sketch.scene()));
    if fault == Fault::KeyOfTurn {
        for scene in [&mut scene, &mut other] {
            set_ids(scene, |turn, _| format!("{turn:03}"));
        }
    }
    same_bits(&bake(&scene, 16), &bake(&other, 16))
}

const SHELLS: &[Shell] = &[Shell::Closed, Shell::Open];

#[test]
fn the_order_of_meshes_and_lights_changes_no_bit() {
    holds(32, sketches(SHELLS, ALL), |sketch| order(sketch, Fault::None));
}

#[test]
fn keys_by_the_turn_are_found() {
    let search = Search { cases: 2, shrinks: 24 };
    let found = finds(search, sketches(SHELLS, ALL), |sketch| order(sketch, Fault::KeyOfTurn));
    assert!(found.case.lamps.len() == 1 && found.case.blocks.is_empty(), "{}\n{}", found.reason, found.case);
}

#[test]
fn names_change_no_bit() {
    holds(8, sketches(SHELLS, ALL), |sketch| {
        let mut renamed = sketch.scene();
        let rename = |name: &mut String| *name = format!("another {}", name.len());
        renamed.meshes.iter_mut().for_each(|mesh| rename(&mut mesh.name));
        renamed.materials.iter_mut().for_each(|material| rename(&mut material.name));
        renamed.instances.iter_mut().for_each(|instance| rename(&mut instance.name));
        for light in &mut renamed.lights {
            match light {
                Light::Rect(light) => rename(&mut light.name),
                Light::Point(light) => rename(&mut light.name),
                Light::Spot(light) => rename(&mut light.bulb.name),
                Light::Directional(light) => rename(&mut light.name),
            }
        }
        same_bits(&bake(&sketch.scene(), 16), &bake(&renamed, 16))
    });
}

/// Other ids, in the same order: other random numbers for the same light.
fn other_ids(sketch: &Sketch, fault: Fault) -> Result<(), String> {
    let mut renamed = sketch.scene();
    set_ids(&mut renamed, |_, id| format!("{id}'"));
    if fault == Fault::MoreLight {
        renamed.materials.iter_mut().for_each(|material| material.emitted_radiance *= 1.04);
    }
    let (before, after) = (bake(&sketch.scene(), 16), bake(&renamed, 16));
    if before.pages == after.pages {
        return Err("other ids have the same random numbers".into());
    }
    settle(0.02, |samples| [&sketch.scene(), &renamed].map(|scene| mean_of(&bake(scene, samples / 16))))
}

#[test]
fn ids_change_noise_and_no_more() {
    holds(4, sketches(&[Shell::Closed], INDOORS), |sketch| other_ids(sketch, Fault::None));
}

#[test]
fn ids_that_change_more_are_found() {
    let search = Search { cases: 1, shrinks: 0 };
    finds(search, sketches(&[Shell::Closed], &[Kind::Glow]), |sketch| other_ids(sketch, Fault::MoreLight));
}

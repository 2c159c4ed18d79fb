//! Surfaces and lamps in one place or nearly so: which one a ray meets is no accident.

use super::{has_the_light_of_the_room, mean, raw_texels};
use crate::case::{Case, Verdict};
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::rays::ORIGIN_MOVE;
use crate::guards::scene::SORTED;
use crate::judge::{baked, ensure, light_at};
use crate::things::{bulb, sun};
use crate::worlds::{askew_aside, in_the_room, room, under};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, Goal};
use bevy_kiln::scene::{Instance, Light, Material, PointLight, Scene};
use glam::{Vec2, Vec3};
use std::f64::consts::PI;

const UPPER_LIT: &str = "each texel of the upper has E/π = E⊥·cos/π, each of the lower 0, to 1e-5: f32 rounds the \
                         normal and the sun";

pub const CASES: &[Case] = &[
    Case {
        name: "walls_twice",
        hard: "every wall a second time at the very same place: each ray leaves one and could meet the other",
        elsewhere: "shadow acne of coplanar copies",
        holds: "the mean texel is that of single walls to 1e-3: the same random numbers",
        guard: &ORIGIN_MOVE,
        without: "walls meet the rays that leave their copies",
        check: doubled,
    },
    Case {
        name: "two_materials_in_one_place",
        hard: "two walls of different albedo in the same plane: which one a ray meets is a tie",
        elsewhere: "the tie goes to whichever was loaded first, or to a thread (Godot 55681)",
        holds: "every texel has the same bits whichever way round the scene lists its instances",
        guard: &SORTED,
        without: "texels change with the list",
        check: coincident,
    },
    Case {
        name: "three_bulbs_in_one_place",
        hard: "the tree over lamps can part them in no way",
        elsewhere: "the order of the list decides, and with it the noise",
        holds: "every reading has the same bits whichever way round the scene lists its lights",
        guard: &SORTED,
        without: "readings change with the list",
        check: lamps_in_one_place,
    },
    Case {
        name: "sheets_back_to_back",
        hard: "two sheets in the same plane, askew, with their fronts outwards, one white and one black, under a sun",
        elsewhere: "each hides the other by rounding, and light comes through to the lower",
        holds: UPPER_LIT,
        guard: &ORIGIN_MOVE,
        without: "the sheets shadow themselves and each other",
        check: || back_to_back(0.0),
    },
    Case {
        name: "a_wall_of_a_tenth_of_a_millimetre",
        hard: "two sheets 0.1 mm apart, askew, under a sun",
        elsewhere: "a bias longer than the wall (Godot: 0.5 mm) puts ray starts on its other side",
        holds: UPPER_LIT,
        guard: &ORIGIN_MOVE,
        without: "the upper sheet shadows itself",
        check: || back_to_back(1e-4),
    },
];

/// Every wall of the room a second time, under another name.
fn doubled_room(material: impl Fn(&Material) -> Material) -> Scene {
    let mut scene = room();
    let copies: Vec<Instance> = scene.instances.iter().filter(|instance| instance.name != "lamp").cloned().collect();
    for mut copy in copies {
        let own = material(&scene.materials[copy.material]);
        copy.id = StableId::new(format!("{} again", copy.name));
        (copy.lightmap, copy.material) = (None, scene.materials.len());
        scene.materials.push(own);
        scene.instances.push(copy);
    }
    scene
}

fn doubled() -> Verdict {
    has_the_light_of_the_room(&doubled_room(Material::clone))
}

fn coincident() -> Verdict {
    let scene = doubled_room(|material| Material { base_colour: Vec3::splat(0.9).extend(1.0), ..material.clone() });
    let mut turned_round = scene.clone();
    turned_round.instances.reverse();
    let [a, b] = [raw_texels(&scene)?, raw_texels(&turned_round)?];
    ensure(a == b, || format!("mean texels of {} and {}, by the order of the list", mean(&a), mean(&b)))
}

fn lamps_in_one_place() -> Verdict {
    let mut scene = room();
    for (name, power) in [("a", 1.0), ("b", 3.0), ("c", 0.5)] {
        let lamp = PointLight { id: StableId::new(name), ..bulb(Vec3::new(0.1, 0.2, 0.3), 0.05) };
        scene.lights.push(Light::Point(PointLight { intensity: Vec3::splat(power), ..lamp }));
    }
    let mut turned_round = scene.clone();
    turned_round.lights.reverse();
    let [a, b] = [scene, turned_round].map(|scene| light_at(&scene, &in_the_room(), 64));
    let (a, b) = (a?, b?);
    ensure(a == b, || format!("E is {} and {}, by the order of the list", a[0].irradiance, b[0].irradiance))
}

/// Two sheets with their backs to each other, so far apart, white above and black below, under a sun.
fn back_to_back(gap: f32) -> Verdict {
    let edges = [Vec3::Z * 2.0, Vec3::X * 2.0];
    let low = Vec3::new(-1.0, -gap, -1.0);
    let mut scene = SceneBuilder::default()
        .quad("above", Vec3::new(-1.0, 0.0, -1.0), edges, grey(0.9))
        .quad("below", low, [edges[1], edges[0]], grey(0.0))
        .build();
    scene.lights.push(Light::Directional(sun(Vec3::new(0.6, 0.8, 0.0), 0.0)));
    let scene = under(scene, askew_aside());
    let lightmap = baked(&scene, &BakeSettings { goal: Goal::Samples(16), density: 4.0, ..BakeSettings::default() })?;
    for placement in &lightmap.placements {
        let page = &lightmap.pages[placement.page as usize];
        let size = Vec2::new(page.width as f32, page.height as f32);
        let [low, high] = [placement.uv_min, placement.uv_max].map(|uv| (Vec2::from(uv) * size).round());
        let expected = if placement.id == StableId::new("above") { 0.8 / PI } else { 0.0 };
        for y in low.y as u32..high.y as u32 {
            for x in low.x as u32..high.x as u32 {
                let found = f64::from(page.raw[(y * page.width + x) as usize].x);
                ensure((found - expected).abs() < 1e-5, || format!("a texel of {found}, not {expected}"))?;
            }
        }
    }
    Ok(())
}

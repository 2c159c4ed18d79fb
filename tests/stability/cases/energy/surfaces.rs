//! Surfaces that lose no light: metal, glass, plastic and coats give back all that they get, and no more.

use crate::case::{Case, Verdict};
use crate::common::scenes::{SceneBuilder, glowing};
use crate::guards::bsdf::{INDEX_TURNED, MORE_THAN_ONE_FACET, WHAT_THE_COAT_LEAVES};
use crate::look::{furnace_of_one, shows_albedos, vanishes};
use crate::things::{glass, metal, standard};
use bevy_kiln::scene::Standard;
use glam::Vec3;

const LOSES: &str = "a lobe that loses a few per cent at each bounce darkens a room by a multiple of that";
const THREE_WALLS: &str = "three walls of it, three that glow: E = π within 0.3 %";

pub const CASES: &[Case] = &[
    Case {
        name: "white_metal_of_roughness_0_3",
        hard: "a facet's light meets another facet: 0.7 % of it along the normal, 8 % at 80°",
        elsewhere: LOSES,
        holds: THREE_WALLS,
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: || metal_walls(0.3, 1 << 12),
    },
    Case {
        name: "white_metal_of_roughness_0_6",
        hard: "a facet's light meets another facet: 18 % of it along the normal",
        elsewhere: LOSES,
        holds: THREE_WALLS,
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: || metal_walls(0.6, 1 << 14),
    },
    Case {
        name: "white_metal_of_roughness_1",
        hard: "a facet's light meets another facet: 69 % of it along the normal",
        elsewhere: LOSES,
        holds: THREE_WALLS,
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: || metal_walls(1.0, 1 << 15),
    },
    Case {
        name: "glass_in_a_furnace",
        hard: "a body of smooth glass that takes up half of the room: radiance goes by the index squared inside",
        elsewhere: "glass that light does not pass, or that is a grey filter",
        holds: "what loses no light cannot be seen in a furnace: E = π within 0.3 %",
        guard: &INDEX_TURNED,
        without: "light is squeezed twice by n² and not let go: E is too low",
        check: || vanishes(&glass(1.5, 0.0), 1 << 12, 3e-3),
    },
    Case {
        name: "rough_glass_in_a_furnace",
        hard: "facets of glass send light to other facets, from both sides",
        elsewhere: LOSES,
        holds: "E = π within 0.5 % around glass of roughness 0.6: the last digit of the tables of its albedo",
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: || vanishes(&glass(1.5, 0.6), 1 << 14, 5e-3),
    },
    Case {
        name: "white_plastic",
        hard: "a coat and a base that share what arrives: more than all, if the base does not know of the coat",
        elsewhere: "coat plus base: an albedo up to 1.04, and light that grows from bounce to bounce",
        holds: "under a white sky it shows its albedo in the table (docs/albedo.md), 1 within 0.2 %, at 0°, 60° and \
                80°",
        guard: &WHAT_THE_COAT_LEAVES,
        without: "it shows more than the sky",
        check: || shows_albedos(standard(Standard::default()), [1.0, 1.0, 1.0], 2e-3),
    },
    Case {
        name: "a_clear_coat_over_white",
        hard: "two coats over a base: the upper one hides a part of the lower ones both ways",
        elsewhere: "coat plus base: an albedo above 1 at grazing angles",
        holds: "under a white sky it shows its albedo in the table (docs/albedo.md), within 0.2 %, at 0°, 60° and 80°",
        guard: &WHAT_THE_COAT_LEAVES,
        without: "it shows more than the sky",
        check: || {
            let coat = Standard { reflectance: 0.0, clearcoat: 1.0, ..Standard::default() };
            shows_albedos(standard(coat), [0.983, 0.991, 0.999], 2e-3)
        },
    },
];

fn metal_walls(roughness: f32, samples: u32) -> Verdict {
    let (white, lit) = (|| metal(roughness), || glowing(0.5, 0.5));
    let scene = SceneBuilder::default()
        .room(Vec3::NEG_ONE, Vec3::ONE, [white(), lit(), lit(), white(), white(), lit()])
        .build();
    furnace_of_one(&scene, samples, 3e-3)
}

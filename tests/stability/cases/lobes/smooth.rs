//! Roughness that vanishes: a lobe becomes a single direction.

use super::UNSEEN;
use crate::case::{Case, Verdict};
use crate::common::meter::on_walls;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::bsdf::SMOOTH_LIMIT;
use crate::judge::{light_at, same_but_for_rounding};
use crate::look::{furnace_of_one, vanishes};
use crate::things::{glass, metal, standard, with_box};
use bevy_kiln::scene::{Material, Standard};
use glam::Vec3;

const SPIKE: &str = "the lobe is a spike of density 1/(π α²)";
const FIREFLIES: &str = "0/0, or a least roughness (0.045 in games) that blurs every mirror";
const AS_SMOOTH: &str = "a room with a small lamp reads, to the bit, what it does at roughness 0";
const NO_SPIKE: &str = "0/0, or other light than that of a mirror";
const SPIKE_OVER_DIFFUSE: &str = "a spike over a diffuse base: light samples find one of the two";
const TWO_SPIKES: &str = "two spikes, and total reflection between them";
const SPIKE_OVER_SPIKE: &str = "a spike over a spike: a clear coat over a perfect metal";

pub const CASES: &[Case] = &[
    Case {
        name: "metal_of_roughness_0",
        hard: SPIKE,
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || one_wall(metal(0.0)),
    },
    Case {
        name: "metal_of_roughness_1e_4",
        hard: SPIKE,
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(metal),
    },
    Case {
        name: "plastic_of_roughness_0",
        hard: SPIKE_OVER_DIFFUSE,
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || one_wall(plastic(0.0)),
    },
    Case {
        name: "plastic_of_roughness_1e_4",
        hard: SPIKE_OVER_DIFFUSE,
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(plastic),
    },
    Case {
        name: "glass_of_roughness_0",
        hard: TWO_SPIKES,
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || vanishes(&glass(1.5, 0.0), 1 << 12, 3e-3),
    },
    Case {
        name: "glass_of_roughness_1e_4",
        hard: TWO_SPIKES,
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(|roughness| glass(1.5, roughness)),
    },
    Case {
        name: "coat_of_roughness_0",
        hard: SPIKE_OVER_SPIKE,
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || one_wall(coated(0.0)),
    },
    Case {
        name: "coat_of_roughness_1e_4",
        hard: SPIKE_OVER_SPIKE,
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(coated),
    },
];

fn plastic(perceptual_roughness: f32) -> Material {
    standard(Standard { perceptual_roughness, ..Standard::default() })
}

fn coated(clearcoat_perceptual_roughness: f32) -> Material {
    let metal = Standard { metallic: 1.0, perceptual_roughness: 0.0, ..Standard::default() };
    standard(Standard { clearcoat: 1.0, clearcoat_perceptual_roughness, ..metal })
}

/// A room of radiance 1, one wall of which loses no light.
fn one_wall(material: Material) -> Verdict {
    let lit = || glowing(0.5, 0.5);
    let scene =
        SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [material, lit(), lit(), lit(), lit(), lit()]).build();
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

/// A material of roughness 1e-4 is to the bit what it is at 0.
fn as_smooth(material: impl Fn(f32) -> Material) -> Verdict {
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    let [fine, smooth] = [1e-4, 0.0].map(|roughness| {
        let corners = [Vec3::new(-0.5, -0.9, -0.5), Vec3::new(0.5, 0.1, 0.4)];
        let builder = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [0.5; 6].map(grey)).quad(
            "lamp",
            Vec3::new(-0.1, 0.99, -0.1),
            [0.2 * Vec3::X, 0.2 * Vec3::Z],
            glowing(0.0, 100.0),
        );
        light_at(&with_box(builder, "thing", corners, &material(roughness)).build(), &points, 256)
    });
    same_but_for_rounding(&fine?, &smooth?, 1e-9)
}

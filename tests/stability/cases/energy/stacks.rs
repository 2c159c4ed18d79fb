//! Interfaces above each other: light that goes up and down between them before it leaves.

use super::CUT;
use crate::case::{Case, Verdict};
use crate::common::fresnel::fresnel;
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::bsdf::INDEX_TURNED;
use crate::guards::path::{NUMBER_DEALT_ANEW, SURVIVAL_AT_MOST_ONE};
use crate::judge::{light_at, mean_reads, reads};
use crate::things::{level, of, standard};
use crate::truths::integrate;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{Scattering, Standard};
use glam::Vec3;
use std::f64::consts::PI;

pub const CASES: &[Case] = &[
    Case {
        name: "a_path_that_carries_more_than_1",
        hard: "a path that leaves a pool of glass carries n² = 2.25 times what it did, and more after reflections",
        elsewhere: "a chance of survival above 1, by which light is lost",
        holds: "in equilibrium L/n² is the same everywhere: E = n²·π at the pool's floor, within 0.5 %",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: "paths are divided by chances of up to 15, E is too low",
        check: pool,
    },
    Case {
        name: "twenty_panes",
        hard: "light between 20 panes goes up and down about thirty times",
        elsewhere: "a product of transmittances, which forgets what is reflected back down: half of the light",
        holds: "Stokes' stack (1862): T = (1 − r)/(1 + 19 r) at each angle, over a white sky within 2 %",
        guard: &NUMBER_DEALT_ANEW,
        without: "what passed the first pane passes all",
        check: || stack(StackOf::Panes),
    },
    Case {
        name: "twenty_slabs_of_glass",
        hard: "40 interfaces, each of which bends, reflects and may hold light back",
        elsewhere: CUT,
        holds: "Stokes' stack (1862): T = (1 − R)/(1 + 39 R) by Fresnel's R, over a white sky within 2 %",
        guard: &INDEX_TURNED,
        without: "light is squeezed by n² forty times over",
        check: || stack(StackOf::Slabs),
    },
];

/// Glass over a floor, air above it, in a furnace whose walls glow by n² as much below the surface.
fn pool() -> Verdict {
    let [air, water] = [1.0, 2.25].map(|radiance: f32| move || glowing(0.5, 0.5 * radiance));
    let mut builder = SceneBuilder::default();
    for (name, low, wall) in [("pool", -1.0, true), ("air", 0.0, false)] {
        let material = || if wall { water() } else { air() };
        let corner = Vec3::new(-1.0, low, -1.0);
        let [x, y, z] = [2.0 * Vec3::X, Vec3::Y, 2.0 * Vec3::Z];
        for (side, start, edges) in
            [("-x", corner, [y, z]), ("+x", corner + x, [z, y]), ("-z", corner, [x, y]), ("+z", corner + z, [y, x])]
        {
            builder = builder.quad(&format!("{name} {side}"), start, edges, material());
        }
    }
    builder = level(builder, "floor", -1.0, [1.0, 1.0], water());
    builder = level(builder, "ceiling", 1.0, [1.0, -1.0], air());
    let scene = level(builder, "water", 0.0, [1.0, 1.0], of(Scattering::Refraction { ior: 1.5 })).build();
    let readings = light_at(
        &scene,
        &[at(Vec3::new(0.2, -1.0, 0.1), Vec3::Y), at(Vec3::new(0.2, 1.0, 0.1), Vec3::NEG_Y)],
        1 << 16,
    )?;
    reads(&readings[0], 2.25 * PI, 5e-3)?;
    reads(&readings[1], PI, 5e-3)
}

/// What a stack is made of.
#[derive(Clone, Copy, PartialEq)]
enum StackOf {
    Panes,
    Slabs,
}

/// The ground under a stack under a white sky.
fn stack(of_what: StackOf) -> Verdict {
    let pane = || standard(Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, ..Standard::default() });
    let mut builder = level(SceneBuilder::default(), "ground", -0.1, [2000.0, 1.0], grey(0.0));
    for number in 0..20 {
        let height = 0.1 * number as f32;
        if of_what == StackOf::Panes {
            builder = level(builder, &format!("pane {number}"), height, [2000.0, 1.0], pane());
        } else {
            let interface = || of(Scattering::Refraction { ior: 1.5 });
            builder = level(builder, &format!("top {number}"), height + 0.05, [2000.0, 1.0], interface());
            builder = level(builder, &format!("bottom {number}"), height, [2000.0, -1.0], interface());
        }
    }
    let transmitted = |cosine: f64| match of_what {
        StackOf::Panes => {
            let r = 0.04 + 0.96 * (1.0 - cosine).powi(5);
            (1.0 - r) / (1.0 + 19.0 * r)
        }
        StackOf::Slabs => {
            let r = fresnel(cosine, 1.5);
            (1.0 - r) / (1.0 + 39.0 * r)
        }
    };
    let truth = PI * integrate(|cosine| 2.0 * cosine * transmitted(cosine));
    let scene = builder.sky(Vec3::ONE).build();
    let points: Vec<MeterPoint> = (0..4).map(|i| at(Vec3::new(i as f32, -0.1, 0.3), Vec3::Y)).collect();
    mean_reads(&light_at(&scene, &points, 1 << 16)?, truth, 2e-2)
}

//! How narrow the gap: two plates of a square metre that face each other, askew to the axes; the upper one glows, the
//! lower one has a lightmap.

use crate::naive::{FYROX_BIAS, GODOT_BIAS};
use crate::numbers::Numbers;
use crate::scenes::{Stage, askew, in_f64};
use crate::sweep::{Axis, Curve, Effort, Side, Sweep, rms_error};
use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, bake_lightmap};
use bevy_kiln::math::{Frame, parallel_rectangles, square_to_cosine_hemisphere};
use bevy_kiln::scene::{Material, Scene};
use bevy_kiln::trace::{Tracer, Transport};
use glam::{Affine3A, DVec3, Vec2, Vec3};
use std::num::NonZeroUsize;

/// Texels of the plate's side.
const TEXELS: u32 = 8;

/// Paths from each texel.
const PATHS: u32 = 1024;

/// Estimates that an error is the root mean square of.
const ESTIMATES: u64 = 8;

pub fn sweep(effort: Effort) -> Sweep {
    let difficulties: Vec<f64> = vec![1.0, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7];
    let paths = effort.of(PATHS).max(16);
    let errors = |estimate: &dyn Fn(&Scene, u64) -> f64| {
        let error = |&gap: &f64| {
            let scene = plates(gap as f32);
            rms_error((0..ESTIMATES).map(|seed| estimate(&scene, seed)), parallel_rectangles(1.0, 1.0, gap))
        };
        difficulties.iter().map(error).collect::<Vec<f64>>()
    };
    let biased = |bias: f32| errors(&|scene, seed| naive(scene, bias, paths * TEXELS * TEXELS, seed));
    let curves = vec![
        Curve {
            side: Side::Ours,
            name: "bevy_kiln",
            errors: errors(&|s, seed| ours(s, paths, seed)),
            label: [0.45, 0.18],
        },
        Curve { side: Side::Naive, name: "bias 0.5 mm (Godot)", errors: biased(GODOT_BIAS), label: [0.44, 0.83] },
        Curve { side: Side::Naive, name: "bias 10 mm (Fyrox)", errors: biased(FYROX_BIAS), label: [0.1, 0.93] },
    ];
    Sweep {
        name: "gap",
        title: "A narrow gap",
        about: format!(
            "Two plates of 1 m × 1 m face each other across a gap; the upper one glows. Mean over the lower one's\n\
             lightmap of {TEXELS} × {TEXELS} texels × {paths} paths against the form factor of the two; root mean\n\
             square error of {ESTIMATES} estimates. Naive: rays from as many points, a constant length off the plate."
        ),
        difficulty: Axis { title: "gap [m]", decades: [0, -7], step: 1 },
        error: Axis { title: "relative error", decades: [-6, 2], step: 1 },
        difficulties,
        curves,
        notes: vec![
            "The plates' corners are f32 numbers near ½ m, so that a gap below 1 µm is no longer the one asked for, \
             and it is less\nthan the bound on the error of a point on a plate: there ours fails like a bias, of 1 µm."
                .into(),
        ],
    }
}

fn world() -> Affine3A {
    Affine3A::from_quat(askew())
}

fn plates(gap: f32) -> Scene {
    let corner = Vec3::new(-0.5, 0.0, -0.5);
    let glow = Material::emissive("glow", Vec3::ONE);
    Stage::default()
        .quad("upper", world(), corner + Vec3::Y * gap, [Vec3::X, Vec3::Z], glow)
        .quad("lower", world(), corner, [Vec3::Z, Vec3::X], Material::diffuse("black", Vec3::ZERO))
        .with_lightmap()
        .build()
}

/// Mean E/π over the lightmap.
fn ours(scene: &Scene, samples_per_texel: u32, seed: u64) -> f64 {
    let settings = BakeSettings {
        transport: Transport { seed, ..Transport::default() },
        goal: Goal::Samples(samples_per_texel),
        density: TEXELS as f32,
        threads: NonZeroUsize::new(1),
        ..BakeSettings::default()
    };
    let lightmap = bake_lightmap(scene, &settings, &(), &CancelToken::default()).expect("a sound scene");
    let texels = || lightmap.pages.iter().flat_map(|page| page.raw.iter().zip(&page.coverage));
    let covered: f64 = texels().map(|(_, &coverage)| f64::from(coverage)).sum();
    texels().map(|(raw, &coverage)| f64::from(raw.y) * f64::from(coverage)).sum::<f64>() / covered
}

/// Share of the cosine-weighted rays from the lower plate that meet the upper one's front.
fn naive(scene: &Scene, bias: f32, rays: u32, seed: u64) -> f64 {
    let (tracer, world) = (Tracer::new(scene), in_f64(world()));
    let normal = world.transform_vector3(DVec3::Y).as_vec3().normalize();
    let meets = |index: &u32| {
        let [u, v, a, b] = Numbers::new(seed, u64::from(*index)).draw(0);
        let local = DVec3::new(f64::from(a) - 0.5, 0.0, f64::from(b) - 0.5);
        let origin = world.transform_point3(local).as_vec3() + normal * bias;
        let direction = Frame::new(normal).world_from_local(square_to_cosine_hemisphere(Vec2::new(u, v)));
        tracer.closest_hit(origin, direction).is_some_and(|hit| hit.normal.dot(direction) < 0.0)
    };
    f64::from((0..rays).filter(meets).count() as u32) / f64::from(rays)
}

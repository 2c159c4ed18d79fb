//! How low the sun: a floor with a kerb whose shadow covers half of it, from 45° down to a millionth of a radian. The
//! lower the sun, the lower the kerb that throws so long a shadow.

use crate::meter::{mean_irradiance, measure};
use crate::naive::{FYROX_BIAS, GODOT_BIAS};
use crate::scenes::{Stage, askew, facing, in_f64, unit};
use crate::sweep::{Axis, Curve, Effort, Side, Sweep, rms_error};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::math::combine;
use bevy_kiln::scene::{DirectionalLight, Light, Material, Scene};
use bevy_kiln::trace::{Tracer, Transport};
use glam::{Affine3A, DVec3, Vec3};

/// Length of the floor, away from the sun [m].
const LENGTH: f64 = 10.0;

/// Its width [m].
const WIDTH: f64 = 4.0;

/// Points of each estimate.
const POINTS: u32 = 4096;

/// Estimates that an error is the root mean square of.
const ESTIMATES: u64 = 8;

pub fn sweep(effort: Effort) -> Sweep {
    let difficulties = vec![0.8, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6];
    let points: Vec<_> = (0..ESTIMATES).map(|seed| points(effort.of(POINTS), seed, Affine3A::IDENTITY)).collect();
    let errors = |estimate: &dyn Fn(&Scene, f64, &[MeterPoint]) -> f64| {
        let error = |&elevation: &f64| {
            let scene = scene(elevation, Affine3A::IDENTITY);
            rms_error(points.iter().map(|points| estimate(&scene, elevation, points)), 0.5 * elevation.sin())
        };
        difficulties.iter().map(error).collect::<Vec<f64>>()
    };
    let ours = errors(&|scene, _, points| mean_irradiance(&measure(scene, points, 1, Transport::default())));
    let biased = |bias| errors(&|scene, elevation, points| naive(scene, elevation, points, bias));
    let curves = vec![
        Curve { side: Side::Ours, name: "bevy_kiln", errors: ours, label: [0.4, 0.37] },
        Curve { side: Side::Naive, name: "bias 0.5 mm (Godot)", errors: biased(GODOT_BIAS), label: [0.46, 0.68] },
        Curve { side: Side::Naive, name: "bias 10 mm (Fyrox)", errors: biased(FYROX_BIAS), label: [0.05, 0.96] },
    ];
    Sweep {
        name: "grazing",
        title: "Long shadows of a low sun",
        about: format!(
            "A level floor of {LENGTH} m × {WIDTH} m and a kerb at its end, so high that it shades half of the floor:\n\
             mean E = ½ E⊥ sin of the sun's elevation. {} stratified points; root mean square error of {ESTIMATES}\n\
             estimates. Naive: shadow rays that start a constant length above the floor, over the top of a low kerb.",
            effort.of(POINTS)
        ),
        difficulty: Axis { title: "sun above the horizon [rad]", decades: [0, -6], step: 1 },
        error: Axis { title: "relative error", decades: [-10, 1], step: 2 },
        curves,
        difficulties: difficulties.clone(),
        notes: vec![askew_floor(&difficulties, effort)],
    }
}

/// What becomes of ours on a floor askew to the axes: rays leave it by the bound on the error of a point on it, which
/// for a level floor at height 0 is nothing.
fn askew_floor(elevations: &[f64], effort: Effort) -> String {
    let world = Affine3A::from_quat(askew());
    let points = points(effort.of(POINTS), 0, world);
    let errors = elevations.iter().map(|&elevation| {
        let scene = scene(elevation, world);
        let estimate = mean_irradiance(&measure(&scene, &points, 1, Transport::default()));
        format!(" {:.1e}", rms_error([estimate], 0.5 * elevation.sin()))
    });
    let errors: String = errors.collect();
    format!(
        "On the same floor askew to the axes, where points of a triangle of 10 m are known to 12 µm, ours acts like a \
         bias of\nas much; at the same elevations:{errors}"
    )
}

/// Against the sun's light.
fn to_sun(elevation: f64, world: Affine3A) -> Vec3 {
    in_f64(world).transform_vector3(DVec3::new(-elevation.cos(), elevation.sin(), 0.0)).as_vec3()
}

fn scene(elevation: f64, world: Affine3A) -> Scene {
    let height = 0.5 * LENGTH * elevation.tan();
    let [along, across] = [Vec3::X * LENGTH as f32, Vec3::Z * WIDTH as f32];
    let grey = Material::diffuse("grey", Vec3::ZERO);
    let sun = Light::Directional(DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction: -to_sun(elevation, world),
        illuminance: Vec3::ONE,
        angular_diameter: 0.0,
    });
    Stage::default()
        .quad("floor", world, -0.5 * across, [across, along], grey.clone())
        .quad("kerb", world, -0.5 * across, [Vec3::Y * height as f32, across], grey)
        .light(sun)
        .build()
}

/// Points on the floor, one in each of as many equal strips.
fn points(count: u32, seed: u64, world: Affine3A) -> Vec<MeterPoint> {
    let world = in_f64(world);
    let point = |index: u32| {
        let key = combine(seed, u64::from(index));
        let x = LENGTH * (f64::from(index) + unit(combine(key, 0))) / f64::from(count);
        let local = DVec3::new(x, 0.0, 0.8 * WIDTH * (unit(combine(key, 1)) - 0.5));
        facing(world.transform_point3(local), world.transform_vector3(DVec3::Y).as_vec3())
    };
    (0..count).map(point).collect()
}

fn naive(scene: &Scene, elevation: f64, points: &[MeterPoint], bias: f32) -> f64 {
    let (tracer, direction) = (Tracer::new(scene), to_sun(elevation, Affine3A::IDENTITY));
    let is_lit = |point: &&MeterPoint| tracer.closest_hit(point.position + point.normal * bias, direction).is_none();
    f64::from(direction.y) * points.iter().filter(is_lit).count() as f64 / points.len() as f64
}

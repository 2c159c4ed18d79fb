//! Where a receiver is, seen from a light: near, far, on it, beside it, behind it, at a grazing angle.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey, lit_room};
use crate::guards::light::{
    BULBS, DELTA, DIMMING, HORIZON, LAMP_END, ONE_SIDED, SOLID_ANGLE, SOLID_ANGLE_EXACT,
};
use crate::guards::rays::{ORIGIN_MOVE, SHADOW_LENGTH};
use crate::judge::{ensure, light_at, light_by, reads};
use crate::worlds::{askew, bulb, lit_by, rectangle, spot, sun, under};
use bevy_kiln::math::{coaxial_disk, corner_parallel_rectangle, luminance, polygon_irradiance, sphere_above_horizon};
use bevy_kiln::scene::{Light, PointLight, RectLight, Scene, SpotLight};
use bevy_kiln::trace::{Estimator, Transport};
use glam::{Affine3A, DVec3, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub const CASES: &[Case] = &[
    Case { name: "rect_1e-4", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: || under_a_rectangle(1e-4, 0.5, 0.02) },
    Case { name: "rect_1e-6", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: || under_a_level_rectangle(1e-6, 0.5, 0.02) },
    Case { name: "rect_1e4", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE_EXACT, without: "x", check: || under_a_rectangle(1e4, 0.5, 1e-3) },
    Case { name: "rect_edge", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: || under_a_place(Vec2::new(0.5, 0.0), 1e-4) },
    Case { name: "rect_corner", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: || under_a_place(Vec2::new(0.5, 0.5), 1e-4) },
    Case { name: "rect_huge", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: || under_a_level_rectangle(1.0, 5e5, 0.01) },
    Case { name: "rect_tiny", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE_EXACT, without: "x", check: || under_a_rectangle(1e3, 5e-4, 1e-3) },
    Case { name: "quad_1e-4", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: || under_a_panel(1e-4, 0.02) },
    Case { name: "quad_1e4", hard: "x", elsewhere: "x", holds: "x", guard: &LAMP_END, without: "x", check: || under_a_panel(1e4, 1e-3) },
    Case { name: "quad_1e2", hard: "x", elsewhere: "x", holds: "x", guard: &LAMP_END, without: "x", check: || under_a_panel(1e2, 1e-2) },
    Case { name: "bulb_gap", hard: "x", elsewhere: "x", holds: "x", guard: &BULBS, without: "x", check: || beside_a_bulb(1.0, 1.0001, 0.02) },
    Case { name: "bulb_touch", hard: "x", elsewhere: "x", holds: "x", guard: &BULBS, without: "x", check: || beside_a_bulb(1.0, 1.0, 0.02) },
    Case { name: "bulb_inside", hard: "x", elsewhere: "x", holds: "x", guard: &BULBS, without: "x", check: || beside_a_bulb(1.0, 0.5, 0.02) },
    Case { name: "bulb_1e4", hard: "x", elsewhere: "x", holds: "x", guard: &BULBS, without: "x", check: || beside_a_bulb(1.0, 1e4, 1e-3) },
    Case { name: "point_1e-4", hard: "x", elsewhere: "x", holds: "x", guard: &BULBS, without: "x", check: || beside_a_bulb(0.0, 1e-4, 1e-6) },
    Case { name: "point_1e4", hard: "x", elsewhere: "x", holds: "x", guard: &BULBS, without: "x", check: || beside_a_bulb(0.0, 1e4, 1e-6) },
    Case { name: "flush", hard: "x", elsewhere: "x", holds: "x", guard: &LAMP_END, without: "x", check: set_into_a_ceiling },
    Case { name: "variance", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: variance },
    Case { name: "sun0", hard: "x", elsewhere: "x", holds: "x", guard: &DELTA, without: "x", check: || small_sun(0.0) },
    Case { name: "sun-7", hard: "x", elsewhere: "x", holds: "x", guard: &DELTA, without: "x", check: || small_sun(1e-7) },
    Case { name: "sunset", hard: "x", elsewhere: "x", holds: "x", guard: &HORIZON, without: "x", check: || sun_at(0.0093, -0.002) },
    Case { name: "halfsun", hard: "x", elsewhere: "x", holds: "x", guard: &HORIZON, without: "x", check: || sun_at(std::f32::consts::PI, -0.7) },
    Case { name: "bulbset", hard: "x", elsewhere: "x", holds: "x", guard: &HORIZON, without: "x", check: bulb_at_the_horizon },
    Case { name: "rectset", hard: "x", elsewhere: "x", holds: "x", guard: &HORIZON, without: "x", check: rectangle_at_the_horizon },
    Case { name: "graze2", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || grazing(1e-2) },
    Case { name: "graze4", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || grazing(1e-4) },
    Case { name: "graze6", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: || grazing(1e-6) },
    Case { name: "box", hard: "x", elsewhere: "x", holds: "x", guard: &SHADOW_LENGTH, without: "x", check: boxed },
    Case { name: "behind", hard: "x", elsewhere: "x", holds: "x", guard: &ONE_SIDED, without: "x", check: behind_a_rectangle },
    Case { name: "behindp", hard: "x", elsewhere: "x", holds: "x", guard: &ONE_SIDED, without: "x", check: behind_a_panel },
    Case { name: "coplanar", hard: "x", elsewhere: "x", holds: "x", guard: &ONE_SIDED, without: "x", check: coplanar },
    Case { name: "edgeon", hard: "x", elsewhere: "x", holds: "x", guard: &SOLID_ANGLE, without: "x", check: edge_on },
    Case { name: "spot_edge", hard: "x", elsewhere: "x", holds: "x", guard: &DIMMING, without: "x", check: || spot_reads(0.2, 0.6, 0.61, 0.0) },
    Case { name: "spot_inside", hard: "x", elsewhere: "x", holds: "x", guard: &DIMMING, without: "x", check: || spot_reads(0.2, 0.6, 0.1, 1.0) },
    Case { name: "spot_sharp", hard: "x", elsewhere: "x", holds: "x", guard: &DIMMING, without: "x", check: || spot_reads(0.5, 0.5, 0.499, 1.0) },
    Case { name: "range_pt", hard: "x", elsewhere: "x", holds: "x", guard: &DIMMING, without: "x", check: point_range },
    Case { name: "range_rect", hard: "x", elsewhere: "x", holds: "x", guard: &DIMMING, without: "x", check: rectangle_range },
    Case { name: "point_1e4_floor", hard: "x", elsewhere: "x", holds: "x", guard: &ORIGIN_MOVE, without: "x", check: a_far_point_over_a_floor },
];

/// Straight under a square of this half side, seen full.
fn under_a_rectangle(distance: f32, half: f32, tolerance: f64) -> Verdict {
    let lamp = rectangle(askew() * Vec3::Y * distance, askew() * Vec3::NEG_Y, Vec2::splat(2.0 * half));
    let readings = light_at(&lit_by([Light::Rect(lamp)]), &[at(Vec3::ZERO, askew() * Vec3::Y)], 1 << 14)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(half.into(), half.into(), distance.into()), tolerance)
}

/// The same of a lamp that lies level.
fn under_a_level_rectangle(distance: f32, half: f32, tolerance: f64) -> Verdict {
    let lamp = rectangle(Vec3::Y * distance, Vec3::NEG_Y, Vec2::splat(2.0 * half));
    let readings = light_at(&lit_by([Light::Rect(lamp)]), &[at(Vec3::ZERO, Vec3::Y)], 1 << 14)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(half.into(), half.into(), distance.into()), tolerance)
}

/// Under the edge or the corner of a square of 1 m.
fn under_a_place(place: Vec2, distance: f32) -> Verdict {
    let lamp = rectangle(Vec3::Y * distance, Vec3::NEG_Y, Vec2::ONE);
    let point = Vec3::new(place.x, 0.0, place.y);
    let readings = light_at(&lit_by([Light::Rect(lamp)]), &[at(point, Vec3::Y)], 1 << 14)?;
    let part = |a: f32, b: f32| corner_parallel_rectangle(f64::from(a), f64::from(b), distance.into());
    let sides = |place: f32| [0.5 - place, 0.5 + place];
    let truth: f64 = sides(place.x).iter().flat_map(|&a| sides(place.y).map(|b| part(a, b))).sum();
    reads(&readings[0], PI * truth, 0.02)
}

/// Straight under a glowing panel of 1 m at the world's origin.
fn under_a_panel(distance: f32, tolerance: f64) -> Verdict {
    let panel = SceneBuilder::default()
        .quad("panel", Vec3::new(-0.5, 0.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 1.0))
        .build();
    let scene = under(panel, Affine3A::from_quat(askew()));
    let point = at(askew() * Vec3::NEG_Y * distance, askew() * Vec3::Y);
    let readings = light_at(&scene, &[point], 1 << 14)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(0.5, 0.5, distance.into()), tolerance)
}

/// Beside a sphere of 1 cd, or a point; a receiver inside sees it touch.
fn beside_a_bulb(radius: f32, distance: f32, tolerance: f64) -> Verdict {
    let towards = askew() * Vec3::Y;
    let readings =
        light_at(&lit_by([Light::Point(bulb(towards * distance, radius))]), &[at(Vec3::ZERO, towards)], 1 << 14)?;
    reads(&readings[0], f64::from(distance).powi(-2), tolerance)
}

fn set_into_a_ceiling() -> Verdict {
    let mut room = SceneBuilder::default()
        .quad("ceiling", Vec3::new(-2.0, 1.0, -2.0), [Vec3::X * 4.0, Vec3::Z * 4.0], grey(0.0))
        .build();
    room.lights.push(Light::Rect(rectangle(Vec3::Y, Vec3::NEG_Y, Vec2::ONE)));
    let root = Affine3A::from_rotation_translation(askew(), Vec3::new(3.1, -2.7, 5.3));
    let point = at(root.transform_point3(Vec3::ZERO), askew() * Vec3::Y);
    let readings = light_at(&under(room, root), &[point], 1 << 12)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(0.5, 0.5, 1.0), 0.01)
}

/// Relative variance of a path's worth half a millimetre under the lamp of a room over that at its floor's middle.
fn variance() -> Verdict {
    let room = lit_room(0.5, 10.0);
    let relative = |point: Vec3| -> Result<f64, String> {
        let (mut mean, mut variance) = (0.0, 0.0);
        for seed in 0..256 {
            // One path for each replicate: their spread is that of single paths.
            let reading = &light_by(&room, &[at(point, Vec3::Y)], 16, Transport { seed, ..Transport::default() })?[0];
            mean += luminance(reading.irradiance) / 256.0;
            variance += luminance(reading.stderr).powi(2) * 16.0 / 256.0;
        }
        Ok(variance / (mean * mean))
    };
    let (near, far) = (relative(Vec3::new(2.0, 3.9 - 5e-4, 2.0))?, relative(Vec3::new(2.0, 0.0, 2.0))?);
    ensure(near <= 10.0 * far, || format!("relative variance of {near:.3} under the lamp and {far:.3} on the floor"))
}

/// A sun of no width, by directions of the surface alone, which never meet it.
fn small_sun(diameter: f32) -> Verdict {
    let towards = Vec3::new(0.48, 0.6, 0.64);
    for estimator in [Estimator::Mis, Estimator::Light, Estimator::Bsdf] {
        let transport = Transport { estimator, ..Transport::default() };
        let scene = lit_by([Light::Directional(sun(towards, diameter))]);
        let readings = light_by(&scene, &[at(Vec3::ZERO, Vec3::Y)], 16, transport)?;
        reads(&readings[0], 0.6, 1e-6).map_err(|error| format!("{estimator:?}: {error}"))?;
    }
    Ok(())
}

/// ∫ max(0, cos) over a cone of directions about an axis at this elevation above the horizon; midpoints.
fn cone_above_horizon(elevation: f64, half_angle: f64) -> f64 {
    let (rings, spokes) = (1000, 1000);
    let mut sum = 0.0;
    for ring in 0..rings {
        let angle = (ring as f64 + 0.5) / rings as f64 * half_angle;
        for spoke in 0..spokes {
            let turn = (spoke as f64 + 0.5) / spokes as f64 * TAU;
            let height = angle.cos() * elevation.sin() + angle.sin() * turn.cos() * elevation.cos();
            sum += height.max(0.0) * angle.sin();
        }
    }
    sum * half_angle / rings as f64 * TAU / spokes as f64
}

/// A sun whose middle is below the horizon, beside a bulb, by light sampling alone.
fn sun_at(diameter: f32, elevation: f32) -> Verdict {
    let towards = Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let dim = bulb(Vec3::Y * 10.0, 0.0);
    let scene = lit_by([Light::Directional(sun(towards, diameter)), Light::Point(PointLight { intensity: 1e-6 * Vec3::ONE, ..dim })]);
    let transport = Transport { estimator: Estimator::Light, ..Transport::default() };
    let readings = light_by(&scene, &[at(Vec3::ZERO, Vec3::Y)], 1 << 16, transport)?;
    let half = 0.5 * f64::from(diameter);
    let radiance = 1.0 / (PI * half.sin().powi(2));
    reads(&readings[0], radiance * cone_above_horizon(elevation.into(), half) + 1e-8, 0.02)
}

fn by_light(scene: &Scene, samples: u32) -> Result<bevy_kiln::bake::MeterReading, String> {
    let transport = Transport { estimator: Estimator::Light, ..Transport::default() };
    Ok(light_by(scene, &[at(Vec3::ZERO, Vec3::Y)], samples, transport)?[0])
}

fn bulb_at_the_horizon() -> Verdict {
    let (radius, distance, elevation) = (0.3_f32, 2.0_f32, -0.05_f32);
    let place = distance * Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let other = PointLight { intensity: Vec3::splat(1e-6), id: bevy_kiln::artefact::StableId::new("other"), ..bulb(Vec3::Y * 10.0, 0.0) };
    let reading = by_light(&lit_by([Light::Point(bulb(place, radius)), Light::Point(other)]), 1 << 16)?;
    let radiance = 1.0 / (PI * f64::from(radius).powi(2));
    let half = f64::from(radius / distance).asin();
    reads(&reading, radiance * cone_above_horizon(elevation.into(), half) + 1e-8, 0.02)
}

fn rectangle_at_the_horizon() -> Verdict {
    let lamp = rectangle(Vec3::new(1.0, -0.1, 0.0), Vec3::NEG_X, Vec2::ONE);
    let other = PointLight { intensity: Vec3::splat(1e-6), ..bulb(Vec3::Y * 10.0, 0.0) };
    let reading = by_light(&lit_by([Light::Rect(lamp), Light::Point(other)]), 1 << 14)?;
    let corners = [(-0.5, -0.6), (0.5, -0.6), (0.5, 0.4), (-0.5, 0.4)].map(|(z, y)| DVec3::new(1.0, y, z));
    reads(&reading, polygon_irradiance(&corners, DVec3::Y) + 1e-8, 0.02)
}

/// A sun at an elevation over a floor of 200 m that lies askew.
fn grazing(elevation: f64) -> Verdict {
    let floor = SceneBuilder::default()
        .quad("floor", Vec3::new(-100.0, 0.0, -100.0), [Vec3::Z * 200.0, Vec3::X * 200.0], grey(0.5))
        .build();
    let mut scene = under(floor, Affine3A::from_quat(askew()));
    let [a, b, _, d] = [0, 1, 2, 3].map(|v| scene.instances[0].world_from_local.matrix3.as_dmat3() * scene.meshes[0].positions[v].as_dvec3());
    let normal = (b - a).cross(d - a).normalize();
    let along = (b - a).normalize();
    let towards = along * elevation.cos() + normal * elevation.sin();
    scene.lights.push(Light::Directional(sun(towards.as_vec3(), 0.0)));
    let points: Vec<_> = (0..64)
        .map(|index| Vec3::new((index % 8) as f32 * 23.7 - 83.0, 0.0, (index / 8) as f32 * 22.3 - 81.0))
        .map(|place| at(askew() * place, askew() * Vec3::Y))
        .collect();
    let readings = light_at(&scene, &points, 16)?;
    readings.iter().try_for_each(|reading| reads(reading, elevation.sin(), 2.0_f64.powi(-22) / elevation))
}

/// A bulb in a black box whose walls are 1 mm from it, seen from 100 m.
fn boxed() -> Verdict {
    let side = || grey(0.0);
    let near = Vec3::splat(1e-3);
    let mut scene =
        SceneBuilder::default().room(-near, near, [side(), side(), side(), side(), side(), side()]).build();
    scene.lights.push(Light::Point(bulb(Vec3::ZERO, 0.0)));
    let scene = under(scene, Affine3A::from_quat(askew()));
    let points = [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.48, 0.6, 0.64)].map(|way| at(way * 100.0, -way));
    let readings = light_at(&scene, &points, 16)?;
    dark(&readings)
}

fn dark(readings: &[bevy_kiln::bake::MeterReading]) -> Verdict {
    readings.iter().try_for_each(|reading| {
        ensure(reading.irradiance == DVec3::ZERO, || format!("E is {}, not 0", reading.irradiance))
    })
}

fn behind_a_rectangle() -> Verdict {
    let scene = lit_by([Light::Rect(rectangle(Vec3::Y, Vec3::Y, Vec2::ONE))]);
    dark(&light_at(&scene, &[at(Vec3::ZERO, Vec3::Y), at(Vec3::new(0.9, 0.999, 0.0), Vec3::Y)], 1 << 10)?)
}

fn behind_a_panel() -> Verdict {
    let scene = SceneBuilder::default()
        .quad("panel", Vec3::new(-0.5, 1.0, -0.5), [Vec3::Z, Vec3::X], glowing(0.0, 1.0))
        .build();
    dark(&light_at(&scene, &[at(Vec3::ZERO, Vec3::Y), at(Vec3::new(0.9, 0.999, 0.0), Vec3::Y)], 1 << 10)?)
}

/// In the plane of a rectangle, beside it, towards it and along its normals.
fn coplanar() -> Verdict {
    let scene = lit_by([Light::Rect(rectangle(Vec3::ZERO, Vec3::NEG_Y, Vec2::ONE))]);
    let point = Vec3::new(1.5, 0.0, 0.1);
    dark(&light_at(&scene, &[at(point, Vec3::NEG_X), at(point, Vec3::Y), at(point, Vec3::NEG_Y)], 1 << 10)?)
}

/// A millimetre off the edge of a rectangle and below its plane, facing it edge-on.
fn edge_on() -> Verdict {
    let scene = lit_by([Light::Rect(rectangle(Vec3::ZERO, Vec3::NEG_Y, Vec2::ONE))]);
    let place = Vec3::new(0.501, -1e-3, 0.0);
    let readings = light_at(&scene, &[at(place, Vec3::NEG_X)], 1 << 14)?;
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
        .map(|(x, z)| DVec3::new(x, 0.0, z) - place.as_dvec3());
    reads(&readings[0], polygon_irradiance(&corners, DVec3::NEG_X), 0.03)
}

/// Below a spot, at an angle from its axis: what share of its intensity is left.
fn spot_reads(inner: f32, outer: f32, angle: f32, share: f64) -> Verdict {
    let scene = lit_by([Light::Spot(spot(Vec3::ZERO, inner, outer))]);
    let way = Vec3::new(angle.sin(), -angle.cos(), 0.0);
    let readings = light_at(&scene, &[at(2.0 * way, -way)], 16)?;
    if share == 0.0 { dark(&readings) } else { reads(&readings[0], 0.25 * share, 1e-5) }
}

fn point_range() -> Verdict {
    let scene = lit_by([Light::Point(PointLight { range: Some(3.0), ..bulb(Vec3::ZERO, 0.0) })]);
    dark(&light_at(&scene, &[3.0003, 3.0, 6.0, 3e4].map(|x| at(Vec3::X * x, Vec3::NEG_X)), 16)?)
}

fn rectangle_range() -> Verdict {
    let lamp = RectLight { range: Some(3.0), ..rectangle(Vec3::ZERO, Vec3::X, Vec2::ONE) };
    dark(&light_at(&lit_by([Light::Rect(lamp)]), &[3.0003, 3.0, 6.0, 3e4].map(|x| at(Vec3::X * x, Vec3::NEG_X)), 64)?)
}

fn a_far_point_over_a_floor() -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-3.0, 0.0, -3.0), [Vec3::Z * 6.0, Vec3::X * 6.0], grey(0.5))
        .build();
    scene.lights.push(Light::Point(bulb(Vec3::new(1e4, 1e2, 0.0), 0.0)));
    let scene = under(scene, Affine3A::from_rotation_translation(askew(), Vec3::new(5.1, 7.3, -4.9)));
    let root = Affine3A::from_rotation_translation(askew(), Vec3::new(5.1, 7.3, -4.9));
    let places: Vec<Vec3> = (0..64).map(|i| Vec3::new((i % 8) as f32 * 0.7 - 2.5, 0.0, (i / 8) as f32 * 0.7 - 2.4)).collect();
    let points: Vec<_> = places.iter().map(|&place| at(root.transform_point3(place), askew() * Vec3::Y)).collect();
    let readings = light_at(&scene, &points, 16)?;
    places.iter().zip(&readings).try_for_each(|(place, reading)| {
        let offset = DVec3::new(1e4, 1e2, 0.0) - place.as_dvec3();
        reads(reading, offset.y / offset.length().powi(3), 1e-4)
    })
}

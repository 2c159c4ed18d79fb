//! Spheres and points: near, far, touched and from within.

use super::{GRAZING, by_light};
use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::light::{BULBS, SPHERE_CONE};
use crate::guards::rays::{ORIGIN_MOVE, SHADOW_LENGTH};
use crate::judge::{all_dark, light_at, reads};
use crate::things::{bulb, lit_by};
use crate::truths::cone_above_horizon;
use crate::worlds::{askew, under};
use bevy_kiln::scene::Light;
use glam::{Affine3A, DVec3, Vec3};
use std::f64::consts::PI;

const TOO_NARROW: &str = "the cone is too narrow: less of it is below the horizon";
const INVERSE_SQUARE: &str = "E = I/d² to 1e-6: f32 rounds place and intensity";

pub const CASES: &[Case] = &[
    Case {
        name: "a_tenth_of_a_millimetre_from_a_bulb",
        hard: "a sphere of 1 m fills all but 1.4 % of a hemisphere, a part of which is below the tilted receiver's \
                horizon",
        elsewhere: "a sphere as a disc of πr²/d², or sampled by its area, of which most faces away",
        holds: "E is that of what is above the horizon (quadrature) within 2 %, by light sampling alone",
        guard: &SPHERE_CONE,
        without: TOO_NARROW,
        check: || tilted_beside_a_bulb(1.0001),
    },
    Case {
        name: "touching_a_bulb",
        hard: "the sphere fills a hemisphere: sin of its cone is 1, cos is 0; the receiver is tilted by 60°",
        elsewhere: "√ of a negative rounding error is NaN",
        holds: "E = I·(1 + cos 60°)/2/r² within 2 %, by light sampling alone",
        guard: &SPHERE_CONE,
        without: TOO_NARROW,
        check: || tilted_beside_a_bulb(1.0),
    },
    Case {
        name: "inside_a_bulb",
        hard: "no tangent cone: sin would be 2",
        elsewhere: "√(1 − 4) is NaN, or a lamp that hides in its own sphere is dark",
        holds: "a bulb shrinks until it touches the receiver, at the same intensity: E = I/d² within 2 %",
        guard: &BULBS,
        without: "the cone is wider than the sky, or narrower than the sphere: E is wrong",
        check: || beside_a_bulb(1.0, 0.5, 0.02),
    },
    Case {
        name: "10_km_from_a_bulb",
        hard: "1 − cos of its cone is 5e-9: less than a step of f32 at 1",
        elsewhere: "1 − cos as a difference is 0, and a density of 1/0",
        holds: "E = I/d² within 1e-3",
        guard: &BULBS,
        without: "the cone has no width: the bulb is dark",
        check: || beside_a_bulb(1.0, 1e4, 1e-3),
    },
    Case {
        name: "a_tenth_of_a_millimetre_from_a_point",
        hard: "E = 1e8 lx of 1 cd",
        elsewhere: "engines clamp the distance at 1 cm, which takes all but a ten-thousandth",
        holds: INVERSE_SQUARE,
        guard: &BULBS,
        without: "E is 1e4 lx",
        check: || beside_a_bulb(0.0, 1e-4, 1e-6),
    },
    Case {
        name: "a_centimetre_less_than_the_usual_clamp",
        hard: "5 mm from a point: E = 40 000 lx of 1 cd",
        elsewhere: "engines clamp the distance at 1 cm",
        holds: INVERSE_SQUARE,
        guard: &BULBS,
        without: "E is a quarter",
        check: || beside_a_bulb(0.0, 5e-3, 1e-6),
    },
    Case {
        name: "a_point_10_km_from_a_tilted_floor",
        hard: "shadow rays of 10 km at 10 mrad from points with an error off their floor",
        elsewhere: GRAZING,
        holds: "E = I·cos/d² to 1e-4 at 64 points: f32 puts the lamp within 1 mm of its height of 100 m and the normal \
                within 1e-5 of the elevation",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: a_far_point_over_a_floor,
    },
    Case {
        name: "a_bulb_in_a_box",
        hard: "black walls 1 mm from a point, seen from 100 m: a hundred-thousandth of the way",
        elsewhere: "shadow rays are shortened by an ε (pbrt: 1e-4 of the way), which passes what hugs the lamp",
        holds: "E = 0 exactly, from four sides",
        guard: &SHADOW_LENGTH,
        without: "shadow rays end before the box",
        check: boxed,
    },
];

/// Beside a sphere of 1 cd, or a point; a receiver inside sees it touch.
fn beside_a_bulb(radius: f32, distance: f32, tolerance: f64) -> Verdict {
    let towards = askew() * Vec3::Y;
    let readings =
        light_at(&lit_by([Light::Point(bulb(towards * distance, radius))]), &[at(Vec3::ZERO, towards)], 1 << 14)?;
    reads(&readings[0], f64::from(distance).powi(-2), tolerance)
}

/// Beside a sphere of 1 m, tilted by 60° from the way to it.
fn tilted_beside_a_bulb(distance: f32) -> Verdict {
    let elevation = 30.0_f32.to_radians();
    let place = distance * Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let reading = by_light(&lit_by([Light::Point(bulb(place, 1.0))]), 1 << 14)?;
    let half = (1.0 / f64::from(place.length()).max(1.0)).asin();
    reads(&reading, cone_above_horizon(elevation.into(), half) / PI, 0.02)
}

fn a_far_point_over_a_floor() -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-3.0, 0.0, -3.0), [Vec3::Z * 6.0, Vec3::X * 6.0], grey(0.5))
        .build();
    scene.lights.push(Light::Point(bulb(Vec3::new(1e4, 1e2, 0.0), 0.0)));
    let root = Affine3A::from_rotation_translation(askew(), Vec3::new(5.1, 7.3, -4.9));
    let places: Vec<Vec3> =
        (0..64).map(|i| Vec3::new((i % 8) as f32 * 0.7 - 2.5, 0.0, (i / 8) as f32 * 0.7 - 2.4)).collect();
    let points: Vec<_> = places.iter().map(|&place| at(root.transform_point3(place), askew() * Vec3::Y)).collect();
    let readings = light_at(&under(scene, root), &points, 16)?;
    places.iter().zip(&readings).try_for_each(|(place, reading)| {
        let offset = DVec3::new(1e4, 1e2, 0.0) - place.as_dvec3();
        reads(reading, offset.y / offset.length().powi(3), 1e-4)
    })
}

/// A bulb in a black box whose walls are 1 mm from it, seen from 100 m.
fn boxed() -> Verdict {
    let near = Vec3::splat(1e-3);
    let mut scene = SceneBuilder::default().room(-near, near, [0.0; 6].map(grey)).build();
    scene.lights.push(Light::Point(bulb(Vec3::ZERO, 0.0)));
    let scene = under(scene, Affine3A::from_quat(askew()));
    let points =
        [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.48, 0.6, 0.64)].map(|way| at(way * 100.0, -way));
    let readings = light_at(&scene, &points, 16)?;
    all_dark(&readings)
}

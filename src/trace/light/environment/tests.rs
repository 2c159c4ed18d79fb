//! Pictures of the sky: directions follow their density, both ways to ask agree to the last pixel, and faults show.

use super::{Environment, heights, texel};
use crate::math::testing::{ChiSquared, Domain, Random, Rejection};
use crate::scene::EnvironmentMap;
use crate::trace::light::brightness;
use glam::{DVec3, Quat, UVec2, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

fn map(width: u32, height: u32, world_from_map: Quat, radiance: impl Fn(UVec2) -> Vec3) -> EnvironmentMap {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| UVec2::new(x, y)));
    EnvironmentMap { name: "sky".into(), width, height, radiance: pixels.map(radiance).collect(), world_from_map }
}

/// Uneven, with black pixels and a black row.
fn patches(width: u32, height: u32, world_from_map: Quat) -> EnvironmentMap {
    map(width, height, world_from_map, |place| {
        let step = (place.x * 7 + place.y * 5) % 6;
        if place.y == 2 { Vec3::ZERO } else { Vec3::new(1.0, 0.7, 0.4) * step as f32 }
    })
}

fn tilted() -> Quat {
    Quat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -0.7)
}

/// Polar angle from the picture's top [rad].
fn theta(sky: &Environment, wi: Vec3) -> f64 {
    let local = sky.world_from_map.inverse() * wi.as_dvec3();
    local.x.hypot(local.z).atan2(local.y)
}

/// χ² over the unit square of the picture, in cells that pixels are made of: p(u, v) = p(ω) · 2π² sin θ.
fn verdict(map: &EnvironmentMap, fault: impl Fn(&Environment, Vec3) -> f64) -> Result<f64, Rejection> {
    let sky = Environment::new(map).expect("it shines");
    let size = Vec2::new(map.width as f32, map.height as f32);
    let sample = |u: Vec2| {
        let wi = sky.sample(u).expect("it shines").wi;
        let local = sky.world_from_map.inverse() * wi.as_dvec3();
        let place = Vec2::new((0.5 + local.z.atan2(local.x) / TAU) as f32, (theta(&sky, wi) / PI) as f32);
        // A sample on the rim of a pixel may lie beside it by a rounding.
        let middle = (sky.pixel(wi).expect("it is a direction").as_vec2() + 0.5) / size;
        (middle + (place - middle) * (1.0 - 1e-4)).extend(0.0)
    };
    let density = |p: Vec3| {
        let (sin_theta, cos_theta) = (f64::from(p.y) * PI).sin_cos();
        let (sin_phi, cos_phi) = ((f64::from(p.x) - 0.5) * TAU).sin_cos();
        let local = DVec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi);
        let wi = (sky.world_from_map * local).as_vec3();
        sky.look(wi).1 * 2.0 * PI * PI * sin_theta * fault(&sky, wi)
    };
    let cells = [(map.width * 5) as usize, (map.height * 5) as usize];
    ChiSquared { cells, samples: 50_000, ..ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE)) }.run(sample, density)
}

#[test]
fn directions_follow_their_density() {
    let pictures = [
        map(1, 1, tilted(), |_| Vec3::X),
        map(3, 1, tilted(), |place| Vec3::splat(1.0 + place.x as f32)),
        patches(9, 5, Quat::IDENTITY),
        patches(9, 5, tilted()),
        patches(21, 11, tilted()),
    ];
    for picture in pictures {
        let p = verdict(&picture, |_, _| 1.0);
        assert!(p.is_ok(), "{} × {}: {p:?}", picture.width, picture.height);
    }
}

/// Planted: 5 % too much; pixels chosen without the sine of their height; directions within a pixel by the angle, and
/// the Jacobian without its sine.
#[test]
fn wrong_densities_are_rejected() {
    let map = patches(9, 5, tilted());
    let too_large = verdict(&map, |_, _| 1.05);
    assert!(matches!(too_large, Err(Rejection::Total(_))), "{too_large:?}");
    // As if a pixel's weight were its brightness alone: p(u, v) without the Jacobian, its total 1.
    let places = || (0..5).flat_map(|y| (0..9).map(move |x| UVec2::new(x, y)));
    let plain: f64 = places().map(|place| brightness(texel(&map, place))).sum();
    let solid_angle = |place: UVec2| {
        let [top, bottom] = heights(place.y, 5);
        (top - bottom) * TAU / 9.0
    };
    let total: f64 = places().map(|place| brightness(texel(&map, place)) * solid_angle(place)).sum();
    let without_sine = verdict(&map, |sky, wi| {
        let place = sky.pixel(wi).expect("it is a direction");
        total / (plain * solid_angle(place))
    });
    assert!(matches!(without_sine, Err(Rejection::Counts(_))), "{without_sine:?}");
    // As if θ were uniform within the pixel: the density would go with 1/sin θ, its total 1.
    let by_angle = verdict(&map, |sky, wi| {
        let place = sky.pixel(wi).expect("it is a direction");
        solid_angle(place) / (TAU / 9.0 * PI / 5.0 * theta(sky, wi).sin())
    });
    assert!(matches!(by_angle, Err(Rejection::Counts(_))), "{by_angle:?}");
    let no_jacobian = verdict(&map, |sky, wi| 1.0 / theta(sky, wi).sin());
    assert!(matches!(no_jacobian, Err(Rejection::Total(_))), "{no_jacobian:?}");
}

/// A sampled direction is one that is looked up with the same radiance and density, also at the rims of pixels, at the
/// poles and across the seam; and black pixels get none.
#[test]
fn looking_finds_what_was_sampled() {
    let mut random = Random::new(2);
    for (width, height) in [(9, 5), (64, 32), (8192, 16), (16, 4096)] {
        for rotation in [Quat::IDENTITY, Quat::from_euler(glam::EulerRot::XYZ, 2.0, -0.3, 0.8)] {
            let sky = Environment::new(&patches(width, height, rotation)).expect("it shines");
            let mut strayed = 0;
            for index in 0..4000 {
                let mut u = random.square();
                if index % 4 == 0 {
                    u = (u * 64.0).floor() / 64.0;
                }
                let sample = sky.sample(u).expect("no direction is lost");
                let cell = sky.table.sample(u, |place| sky.weight(place));
                strayed += u32::from(sky.pixel(sample.wi) != Some(cell.place));
                let (radiance, pdf) = sky.look(sample.wi);
                assert_eq!((radiance, pdf), (sample.radiance, sample.pdf));
                assert!(pdf > 0.0 && (sample.wi.length() - 1.0).abs() < 1e-6);
            }
            assert!(strayed < 4, "{width} × {height}: {strayed} of 4000 in another pixel");
        }
    }
}

/// The pixel in a direction is the one that the scene's own convention names.
#[test]
fn pixels_lie_where_the_scene_says() {
    let sky = Environment::new(&patches(64, 32, Quat::IDENTITY)).expect("it shines");
    for y in 0..32 {
        for x in 0..64 {
            let place = (Vec2::new(x as f32, y as f32) + 0.5) / Vec2::new(64.0, 32.0);
            assert_eq!(sky.pixel(EnvironmentMap::direction_of(place)), Some(UVec2::new(x, y)));
        }
    }
    assert_eq!(sky.look(Vec3::NAN), (Vec3::ZERO, 0.0));
    for pole in [Vec3::Y, Vec3::NEG_Y, Vec3::ZERO] {
        assert!(sky.pixel(pole).is_some());
    }
}

/// ∫ of the density over all directions, pixel by pixel, and of the light that samples stand for.
#[test]
fn the_density_integrates_to_one() {
    for map in [patches(9, 5, tilted()), patches(512, 256, Quat::IDENTITY)] {
        let sky = Environment::new(&map).expect("it shines");
        let (mut density, mut light) = (0.0, 0.0);
        for y in 0..map.height {
            let [top, bottom] = heights(y, map.height);
            for x in 0..map.width {
                let (radiance, pdf) = sky.look(sky.direction(UVec2::new(x, y), Vec2::splat(0.5)));
                let solid_angle = (top - bottom) * TAU / f64::from(map.width);
                density += pdf * solid_angle;
                light += brightness(radiance) * solid_angle;
            }
        }
        assert!((density - 1.0).abs() < 1e-9, "{density}");
        assert!((4.0 * sky.importance() / light - 1.0).abs() < 1e-9);
    }
    assert!(Environment::new(&map(4, 2, Quat::IDENTITY, |_| Vec3::ZERO)).is_none());
}

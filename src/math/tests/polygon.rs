//! Lambert's formula against form factors in closed form, and both against published numbers.

use super::super::*;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

#[track_caller]
fn close(value: f64, truth: f64, tolerance: f64) {
    assert!((value - truth).abs() <= tolerance, "{value} for {truth}");
}

fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// An axis-parallel rectangle at height `z`.
fn ceiling([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], z: f64) -> [DVec3; 4] {
    [at(x0, y0, z), at(x1, y0, z), at(x1, y1, z), at(x0, y1, z)]
}

/// The mean of `f` over the unit square by Gauss–Legendre on 16 × 16 cells.
fn mean_over_square(f: impl Fn(f64, f64) -> f64) -> f64 {
    let cells = (0..16).flat_map(|i| (0..16).map(move |j| [f64::from(i) / 16.0, f64::from(j) / 16.0]));
    cells.map(|low| testing::integrate(&|s: [f64; 2]| f(s[0], s[1]), low, [1.0 / 16.0; 2], 1e-12)).sum()
}

#[test]
fn parallel_rectangle_over_a_corner() {
    close(corner_parallel_rectangle(1.0, 1.0, 1.0), 0.138_531_606, 1e-9);
    close(4.0 * corner_parallel_rectangle(1.0, 1.0, 1.0), 0.554_126_424, 1e-9);
    for (a, b, c) in [(1.0, 1.0, 1.0), (0.1, 3.0, 0.5), (200.0, 0.01, 1.0), (1.0, 1.0, 1000.0)] {
        let lambert = polygon_irradiance(&ceiling([0.0, a], [0.0, b], c), DVec3::Z) / PI;
        close(lambert / corner_parallel_rectangle(a, b, c), 1.0, 1e-9);
    }
}

#[test]
fn perpendicular_rectangle_from_a_point() {
    close(corner_perpendicular_rectangle(1.0, 1.0, 1.0), 0.055_734_197, 1e-9);
    for (width, height, distance) in [(1.0, 1.0, 1.0), (0.2, 5.0, 0.7), (3.0, 0.1, 2.0)] {
        let wall =
            [at(distance, 0.0, 0.0), at(distance, width, 0.0), at(distance, width, height), at(distance, 0.0, height)];
        let lambert = polygon_irradiance(&wall, DVec3::Z) / PI;
        close(lambert, corner_perpendicular_rectangle(width, height, distance), 1e-14);
    }
}

#[test]
fn disk_and_sphere_from_a_point() {
    close(coaxial_disk(1.0, 1.0), 0.5, 1e-15);
    close(PI * sphere_above_horizon(0.5, 2.0, 1.0), 0.196_349_541, 1e-9);
    let n = 20_000;
    let rim = |i| f64::from(i) * TAU / f64::from(n);
    let disk: Vec<DVec3> = (0..n).map(|i| at(0.7 * rim(i).cos(), 0.7 * rim(i).sin(), 0.4)).collect();
    close(polygon_irradiance(&disk, DVec3::Z) / PI, coaxial_disk(0.7, 0.4), 1e-7);
    // A sphere is the disk that it fills: radius r cos a at distance d − r sin a with sin a = r/d, tilted.
    let (r, d, tilt) = (0.5_f64, 2.0, 0.6_f64);
    let (disk_radius, disk_distance) = (r * (1.0 - r * r / (d * d)).sqrt(), d - r * r / d);
    let normal = at(tilt.sin(), 0.0, tilt.cos());
    let disk: Vec<DVec3> =
        (0..n).map(|i| at(disk_radius * rim(i).cos(), disk_radius * rim(i).sin(), disk_distance)).collect();
    close(polygon_irradiance(&disk, normal) / PI, sphere_above_horizon(r, d, tilt.cos()), 1e-7);
}

#[test]
fn squares_of_the_catalogue() {
    let table =
        [(0.1, 0.826_994_522), (0.5, 0.415_253_284), (1.0, 0.199_824_896), (2.0, 0.068_589_589), (10.0, 0.003_162_057)];
    for (gap, factor) in table {
        close(parallel_rectangles(1.0, 1.0, gap), factor, 1e-9);
    }
    close(perpendicular_rectangles(1.0, 1.0, 1.0), 0.200_043_776, 1e-9);
    close(parallel_rectangles(1.0, 1.0, 1.0) + 4.0 * perpendicular_rectangles(1.0, 1.0, 1.0), 1.0, 1e-14);
    close(coaxial_disks(1.0, 1.0, 1.0), 0.381_966_011, 1e-9);
    // A point-like disk sees what a point sees, and areas times factors are reciprocal.
    close(coaxial_disks(1e-5, 0.7, 0.4), coaxial_disk(0.7, 0.4), 1e-9);
    close(coaxial_disks(0.3, 0.7, 0.4) * 0.09, coaxial_disks(0.7, 0.3, 0.4) * 0.49, 1e-15);
    close(perpendicular_rectangles(0.3, 2.0, 1.5) * 0.3, perpendicular_rectangles(2.0, 0.3, 1.5) * 2.0, 1e-14);
}

#[test]
fn factors_between_areas_are_means_of_lambert() {
    let parallel = mean_over_square(|x, y| {
        let (x, y) = (x * 0.8, y * 1.3);
        polygon_irradiance(&ceiling([-x, 0.8 - x], [-y, 1.3 - y], 0.6), DVec3::Z) / PI
    });
    close(parallel, parallel_rectangles(0.8, 1.3, 0.6), 1e-7);
    // The floor [0, 0.7] × [0, 1.2] and the wall x = 0 of height 0.9.
    let perpendicular = mean_over_square(|x, y| {
        let (x, y) = (-x * 0.7, y * 1.2);
        polygon_irradiance(&[at(x, -y, 0.0), at(x, 1.2 - y, 0.0), at(x, 1.2 - y, 0.9), at(x, -y, 0.9)], DVec3::Z) / PI
    });
    close(perpendicular, perpendicular_rectangles(0.7, 0.9, 1.2), 1e-4);
}

#[test]
fn the_triangles_of_nori() {
    // wjakob/nori, scenes/pa4/tests/polylum1.obj to polylum4.obj: irradiance on the floor.
    let triangles = [
        (
            [at(-0.443432, 0.596366, 0.495985), at(-0.320397, 0.0677699, -0.229359), at(0.0341197, 0.11415, -0.343049)],
            0.564_476_71,
        ),
        (
            [at(0.461963, 0.397843, 0.412747), at(-0.0381582, 0.851323, -0.156872), at(0.195443, 0.891957, -0.260672)],
            0.144_010_86,
        ),
        (
            [at(0.100871, 0.289075, -0.422609), at(-0.308386, 0.629587, 0.423966), at(-0.373132, 0.237287, 0.351592)],
            0.335_644_87,
        ),
        (
            [at(-0.17575, 0.639397, 0.151268), at(0.318604, 0.732996, 0.459771), at(0.139095, 0.294498, 0.478556)],
            0.129_002_54,
        ),
    ];
    for (corners, irradiance) in triangles {
        close(polygon_irradiance(&corners, DVec3::Y), irradiance, 1e-8);
    }
}

#[test]
fn the_floor_of_the_cornell_box() {
    // Cornell's data: ceiling at 548.8 with the lamp in the hole x 213 to 343, z 227 to 332; here y up is z.
    let table = [
        ((278.0, 279.6), 0.044_632_475),
        ((100.0, 100.0), 0.030_656_670),
        ((450.0, 450.0), 0.031_541_122),
        ((50.0, 500.0), 0.025_393_683),
    ];
    for ((x, z), irradiance) in table {
        let lamp = ceiling([213.0 - x, 343.0 - x], [227.0 - z, 332.0 - z], 548.8);
        close(polygon_irradiance(&lamp, DVec3::Z), irradiance, 1e-8);
    }
}

#[test]
fn the_sky_over_a_slot_and_a_wall() {
    // A very long strip at the top of a slot of depth h and width w: sin(atan(w/2h)).
    for (ratio, share) in [(0.5, 0.5_f64.sqrt()), (1.0, 0.447_213_595), (2.0, 0.242_535_625)] {
        let strip = ceiling([-0.5, 0.5], [-1e6, 1e6], ratio);
        close(polygon_irradiance(&strip, DVec3::Z) / PI, share, 1e-9);
        close((0.5 / ratio).atan().sin(), share, 1e-9);
    }
    close(polygon_irradiance(&ceiling([-1e7, 1e7], [-1e7, 1e7], 1.0), DVec3::Z), PI, 1e-6);
    // A wall whose top stands at elevation e leaves π/2 (1 + cos e).
    let elevation = 0.7_f64;
    let open = ceiling([-1e7, 1.0 / elevation.tan()], [-1e7, 1e7], 1.0);
    close(polygon_irradiance(&open, DVec3::Z), PI / 2.0 * (1.0 + elevation.cos()), 1e-6);
}

#[test]
fn what_is_below_the_horizon_gives_nothing() {
    // A wall half sunk in the floor is the wall that stands on it; one wholly below is dark.
    let wall = |low| [at(1.0, 0.0, low), at(1.0, 1.0, low), at(1.0, 1.0, 1.0), at(1.0, 0.0, 1.0)];
    close(polygon_irradiance(&wall(-3.0), DVec3::Z), polygon_irradiance(&wall(0.0), DVec3::Z), 1e-15);
    assert_eq!(polygon_irradiance(&ceiling([0.0, 1.0], [0.0, 1.0], -1.0), DVec3::Z), 0.0);
    // Either winding.
    let mut turned = wall(-3.0);
    turned.reverse();
    close(polygon_irradiance(&turned, DVec3::Z), polygon_irradiance(&wall(0.0), DVec3::Z), 1e-15);
    // Cut in two, it is the sum of its parts, also where it touches the horizon with a corner.
    let (corner, u, v) = (at(2.0, -1.0, -0.5), at(-1.0, 2.0, 0.5), at(-1.5, 0.0, 1.5));
    let [a, b, c, d] = [corner, corner + u, corner + u + v, corner + v];
    let whole = polygon_irradiance(&[a, b, c, d], DVec3::Z);
    let parts = polygon_irradiance(&[a, b, c], DVec3::Z) + polygon_irradiance(&[a, c, d], DVec3::Z);
    assert!(whole > 0.1);
    close(whole, parts, 1e-14);
}

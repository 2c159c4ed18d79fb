//! Spherical rectangles and triangles, from easy and from hard points of view, against their density in the plane,
//! their inverse and closed forms.

use super::super::testing::{ChiSquared, Domain, Random, integrate};
use super::super::*;
use glam::{DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// A rectangle of 0.7 × 0.4, tilted so that no axis is spared.
fn rectangle() -> (Vec3, Vec3, Vec3) {
    let frame = Frame::new(Vec3::new(0.3, -0.5, 0.8).normalize());
    (Vec3::new(0.2, 1.1, -0.4), 0.7 * frame.tangent, 0.4 * frame.bitangent)
}

/// Points of view: along the first edge, along the second, and height over its plane, in lengths of the edges.
const VIEWS: [(f32, f32, f32); 12] = [
    (0.5, 0.5, 1.0),
    (0.5, 0.5, 500.0),
    (0.5, 0.5, 0.05),
    (0.3, 0.8, -0.4),
    (0.0, 0.0, 0.5),
    (1.0, 0.4, 0.3),
    (2.5, -1.5, 0.7),
    (1.5, 0.5, 0.002),
    (0.5, -3.0, 0.01),
    (-0.02, 0.5, 0.02),
    (30.0, 10.0, 1e-4),
    (-1.5, 0.5, -1.0),
];

fn viewpoint((corner, u, v): (Vec3, Vec3, Vec3), (s, t, height): (f32, f32, f32)) -> Vec3 {
    corner + s * u + t * v + height * 0.5 * (u.length() + v.length()) * u.cross(v).normalize()
}

/// The solid angle per area of a unit square that is mapped on the plane: volume/distance³.
fn density(offset: DVec3, volume: f64) -> f64 {
    volume / offset.length().powi(3)
}

#[test]
fn rectangles_are_sampled_by_solid_angle() {
    let (corner, u, v) = rectangle();
    let plane = Domain::Plane(Vec2::ZERO, Vec2::ONE);
    for (view, seed) in VIEWS.into_iter().zip(1..) {
        let from = viewpoint((corner, u, v), view);
        let seen = SphericalRectangle::new(corner, u, v, from).expect("it is seen");
        let (offset, u, v) = ((corner.as_dvec3() - from.as_dvec3()), u.as_dvec3(), v.as_dvec3());
        let volume = offset.dot(u.cross(v)).abs();
        let pdf = |p: Vec3| density(offset + f64::from(p.x) * u + f64::from(p.y) * v, volume) / seen.solid_angle();
        let test = ChiSquared { cells: [31, 31], seed, ..ChiSquared::over(plane) };
        let p = test.run(|s| seen.sample_shares(s).extend(0.0), pdf);
        assert!(p.is_ok(), "{view:?}: {p:?}");
    }
}

#[test]
fn triangles_are_sampled_by_solid_angle() {
    let (corner, u, v) = rectangle();
    let plane = Domain::Plane(Vec2::ZERO, Vec2::ONE);
    for (view, seed) in VIEWS.into_iter().zip(1..) {
        let from = viewpoint((corner, u, v), view);
        let corners = [corner, corner + u, corner + 0.3 * u + v];
        let seen = SphericalTriangle::new(corners, from).expect("it is seen");
        let [a, b, c] = corners.map(|corner| corner.as_dvec3() - from.as_dvec3());
        let volume = a.dot((b - a).cross(c - a)).abs();
        // The triangle is drawn out to a square by its uniform map, of density 2, so that no cell is cut.
        let pdf = |p: Vec3| {
            let w = square_to_triangle(p.truncate()).as_dvec2();
            0.5 * density(a + w.x * (b - a) + w.y * (c - a), volume) / seen.solid_angle()
        };
        let test = ChiSquared { cells: [31, 31], seed, ..ChiSquared::over(plane) };
        let p = test.run(|s| triangle_to_square(seen.sample_weights(s)).extend(0.0), pdf);
        assert!(p.is_ok(), "{view:?}: {p:?}");
    }
}

#[test]
fn area_samples_are_not_taken_for_solid_angle() {
    let (corner, u, v) = rectangle();
    let from = viewpoint((corner, u, v), VIEWS[3]);
    let seen = SphericalRectangle::new(corner, u, v, from).expect("it is seen");
    let offset = (corner - from).as_dvec3();
    let volume = offset.dot(u.as_dvec3().cross(v.as_dvec3())).abs();
    let pdf = |p: Vec3| density(offset + (p.x * u + p.y * v).as_dvec3(), volume) / seen.solid_angle();
    let test = ChiSquared { cells: [31, 31], ..ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE)) };
    assert!(test.run(|s| s.extend(0.0), pdf).is_err());
}

#[test]
fn inverses_undo_the_samplers() {
    let (corner, u, v) = rectangle();
    for view in VIEWS {
        let from = viewpoint((corner, u, v), view);
        let quad = SphericalRectangle::new(corner, u, v, from).expect("it is seen");
        let triangle = SphericalTriangle::new([corner, corner + u, corner + v], from).expect("it is seen");
        // An f32 share leaves a doubt of 6·10⁻⁸ of the rectangle, which is more of the solid angle where near.
        let doubt = 1e-6 * (0.05 / view.2.abs()).max(1.0) + 1e-6;
        let mut random = Random::new(17);
        for _ in 0..2000 {
            let s = random.square();
            let back = quad.square_from_shares(quad.sample_shares(s));
            assert!((back - s).abs().max_element() <= doubt, "{view:?}: {s} to {back}");
            let back = triangle.square_from_weights(triangle.sample_weights(s));
            assert!((back - s).abs().max_element() <= 30.0 * doubt, "{view:?}: {s} to {back}");
        }
    }
}

#[test]
fn directions_lead_back_to_the_square() {
    let (corner, u, v) = rectangle();
    for view in [VIEWS[0], VIEWS[3], VIEWS[4], VIEWS[6], VIEWS[11]] {
        let from = viewpoint((corner, u, v), view);
        let quad = SphericalRectangle::new(corner, u, v, from).expect("it is seen");
        let triangle = SphericalTriangle::new([corner, corner + u, corner + v], from).expect("it is seen");
        let mut random = Random::new(19);
        for _ in 0..2000 {
            let s = 0.01 + 0.98 * random.square();
            let back = quad.square_from_direction(3.0 * quad.sample_offset(s)).expect("it is hit");
            assert!((back - s).abs().max_element() < 2e-5, "{view:?}: {s} to {back}");
            let back = triangle.square_from_direction(3.0 * triangle.sample_offset(s)).expect("it is hit");
            assert!((back - s).abs().max_element() < 1e-4, "{view:?}: {s} to {back}");
        }
        let away = -quad.sample_offset(Vec2::splat(0.5));
        assert_eq!(quad.square_from_direction(away), None);
        assert_eq!(triangle.square_from_direction(-triangle.sample_offset(Vec2::splat(0.5))), None);
        assert_eq!(triangle.square_from_direction(corner + u + v - from), None);
        assert_eq!(quad.square_from_direction(corner + 1.01 * (u + v) - from), None);
    }
}

#[test]
fn samples_lie_on_the_shape_and_offsets_are_their_distance() {
    let (corner, u, v) = rectangle();
    let mut random = Random::new(23);
    for view in VIEWS {
        let from = viewpoint((corner, u, v), view);
        let scale = 1e-6 * (1.0 + from.length());
        let quad = SphericalRectangle::new(corner, u, v, from).expect("it is seen");
        let triangle = SphericalTriangle::new([corner, corner + u, corner + v], from).expect("it is seen");
        for s in [Vec2::ZERO, Vec2::X * 0.999_999_9, Vec2::Y * 0.999_999_9, Vec2::splat(0.999_999_9), random.square()] {
            let (shares, weights) = (quad.sample_shares(s), triangle.sample_weights(s));
            assert!(shares.min_element() >= 0.0 && shares.max_element() <= 1.0, "{shares}");
            assert!(weights.min_element() >= 0.0 && weights.element_sum() <= 1.000_001, "{weights}");
            assert!((quad.sample(s) - (corner + shares.x * u + shares.y * v)).length() < scale);
            assert!((triangle.sample(s) - (corner + weights.x * u + weights.y * v)).length() < scale);
            assert!((quad.sample(s) - from - quad.sample_offset(s)).length() < scale);
            assert!((triangle.sample(s) - from - triangle.sample_offset(s)).length() < scale);
        }
    }
}

#[test]
fn solid_angles_in_closed_form() {
    let square = |height: f32| {
        let seen = SphericalRectangle::new(Vec3::new(-1.0, -1.0, height), 2.0 * Vec3::X, 2.0 * Vec3::Y, Vec3::ZERO);
        seen.expect("it is seen").solid_angle()
    };
    // A face of a cube is a sixth of the sphere; far away it is area over distance squared.
    assert!((square(1.0) - 4.0 * PI / 6.0).abs() < 1e-14);
    assert!((square(1e4) / (4.0 / 1e8) - 1.0).abs() < 2e-8);
    assert!((square(1e-4) - TAU).abs() < 1e-3);
    let octant = SphericalTriangle::new([Vec3::X, Vec3::Y, Vec3::Z], Vec3::ZERO).expect("it is seen");
    assert!((octant.solid_angle() - PI / 2.0).abs() < 1e-14);
    let (corner, u, v) = rectangle();
    for view in VIEWS {
        let from = viewpoint((corner, u, v), view);
        let quad = SphericalRectangle::new(corner, u, v, from).expect("it is seen").solid_angle();
        let offset = corner.as_dvec3() - from.as_dvec3();
        let (du, dv) = (u.as_dvec3(), v.as_dvec3());
        let volume = offset.dot(du.cross(dv)).abs();
        let area = integrate(&|s: [f64; 2]| density(offset + s[0] * du + s[1] * dv, volume), [0.0; 2], [1.0; 2], 1e-11);
        assert!((area / quad - 1.0).abs() < 1e-5, "{view:?}: {area} for {quad}");
        // The two triangles that a rectangle is cut into. Rounded corners move what is seen at a grazing angle.
        let half = |a, b, c| SphericalTriangle::new([a, b, c], from).expect("it is seen").solid_angle();
        let sum = half(corner, corner + u, corner + u + v) + half(corner, corner + u + v, corner + v);
        let doubt = 1e-6 + 1e-6 / f64::from(view.2.abs());
        assert!((sum / quad - 1.0).abs() < doubt, "{view:?}: {sum} for {quad}");
    }
}

#[test]
fn lamberts_irradiance_from_samples() {
    // The mean of the cosine over a 256 × 256 grid of the unit square, whose error falls with the square of its step.
    let (corner, u, v) = rectangle();
    for view in VIEWS {
        let from = viewpoint((corner, u, v), view);
        let quad = SphericalRectangle::new(corner, u, v, from).expect("it is seen");
        let triangle = SphericalTriangle::new([corner, corner + u, corner + v], from).expect("it is seen");
        // Exact edges for the one, rounded corners for the other, as each is given: at a grazing angle it matters.
        let (offset, du, dv) = (corner.as_dvec3() - from.as_dvec3(), u.as_dvec3(), v.as_dvec3());
        let exact = [offset, offset + du, offset + du + dv, offset + dv];
        let rounded = [corner, corner + u, corner + v].map(|c| c.as_dvec3() - from.as_dvec3());
        // A normal towards its middle, so that most of it is above the horizon, and not quite.
        let normal = ((corner + 0.5 * (u + v) - from).normalize() + Vec3::new(0.2, 0.1, -0.3)).normalize();
        let mean = |sample: &dyn Fn(Vec2) -> Vec3| {
            let grid = (0..256).flat_map(|i| (0..256).map(move |j| Vec2::new(i as f32 + 0.5, j as f32 + 0.5) / 256.0));
            grid.map(|s| f64::from(sample(s).normalize().dot(normal).max(0.0))).sum::<f64>() / 65_536.0
        };
        let normal_64 = normal.as_dvec3().normalize();
        let cases = [
            (quad.solid_angle() * mean(&|s| quad.sample_offset(s)), polygon_irradiance(&exact, normal_64)),
            (triangle.solid_angle() * mean(&|s| triangle.sample_offset(s)), polygon_irradiance(&rounded, normal_64)),
        ];
        for (estimate, truth) in cases {
            assert!(truth > 0.0 && (estimate / truth - 1.0).abs() < 1e-4, "{view:?}: {estimate} for {truth}");
        }
    }
}

#[test]
fn what_cannot_be_sampled_by_solid_angle_is_refused() {
    let quad = |corner, u, v| SphericalRectangle::new(corner, u, v, Vec3::ZERO);
    // In its own plane, inside it and beside it; degenerate; too far; not a number.
    assert_eq!(quad(Vec3::new(1.0, 1.0, 0.0), Vec3::X, Vec3::Y), None);
    assert_eq!(quad(Vec3::new(-0.5, -0.5, 0.0), Vec3::X, Vec3::Y), None);
    assert_eq!(quad(Vec3::Z, Vec3::ZERO, Vec3::Y), None);
    assert_eq!(quad(Vec3::Z, Vec3::Y, Vec3::Y), None);
    assert_eq!(quad(Vec3::Z * 1e8, Vec3::X, Vec3::Y), None);
    assert_eq!(quad(Vec3::new(0.0, f32::NAN, 1.0), Vec3::X, Vec3::Y), None);
    assert_eq!(quad(Vec3::new(0.0, f32::INFINITY, 1.0), Vec3::X, Vec3::Y), None);
    let triangle = |a, b, c| SphericalTriangle::new([a, b, c], Vec3::ZERO);
    assert_eq!(triangle(Vec3::X, Vec3::Y, Vec3::X + Vec3::Y), None);
    assert_eq!(triangle(Vec3::ZERO, Vec3::Y, Vec3::X), None);
    assert_eq!(triangle(Vec3::Z, Vec3::Z + Vec3::X, Vec3::Z + 2.0 * Vec3::X), None);
    assert_eq!(triangle(Vec3::Z * 1e8, Vec3::Z * 1e8 + Vec3::X, Vec3::Z * 1e8 + Vec3::Y), None);
    assert_eq!(triangle(Vec3::NAN, Vec3::X, Vec3::Y), None);
    let touching = 1e-7 * Vec3::Z;
    assert_eq!(triangle(touching - Vec3::X - Vec3::Y, touching + Vec3::X - Vec3::Y, touching + Vec3::Y), None);
}

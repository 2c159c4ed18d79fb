//! Spherical rectangles and triangles, from easy and from hard points of view, against their density in the plane,
//! their inverse and closed forms.

use super::super::testing::{ChiSquared, Domain, Random, integrate};
use super::super::*;
use glam::{DVec2, DVec3, Vec2, Vec3};
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

/// A point of view (heights are powers of two) and what 60 digits say of it: the solid angle, and where the point (¼,
/// ¾) of the square goes.
type Exact = ([f32; 3], f64, [f64; 2]);

/// The unit square in the plane z = 0.
const RECTANGLES: [Exact; 7] = [
    ([0.5, 0.5, 10_000.0], 9.999_999_975e-9, [0.250_000_000_234, 0.749_999_999_766]),
    ([1.5, 0.5, 9.536_743e-7], 1.373_752_628_260_498_5e-6, [0.600_546_280_026, 0.725_256_056_227]),
    ([1000.0, 0.25, 9.765_625e-4], 9.780_290_851_598_52e-13, [0.250_281_507_969, 0.749_999_906_203]),
    ([-9.765_625e-4, 0.5, 6.103_515_6e-5], 0.124_564_954_133_981_67, [0.000_325_313_798_249, 0.500_752_460_807]),
    ([0.5, 0.25, 2.441_406_3e-4], 6.279_827_965_740_634, [0.499_756_064_076, 0.250_199_256_519]),
    ([3.0, -2.0, 9.313_226e-10], 2.173_625_228_654_955_5e-11, [0.312_993_536_213, 0.693_369_296_322]),
    ([0.25, 0.75, 1.0], 0.719_205_273_031_060_1, [0.220_201_557_515, 0.781_898_708_425]),
];

/// The triangle (0, 0), (1, 0), (¼, 1) in the plane z = 0; the weights of its second and third corner.
const TRIANGLES: [Exact; 7] = [
    ([0.5, 0.5, 10_000.0], 4.999_999_989_843_75e-9, [0.133_974_596_291, 0.216_506_351_301]),
    ([1.5, 0.5, 9.536_743e-7], 4.152_308_059_482_445e-7, [0.254_733_505_669, 0.238_009_082_873]),
    ([1000.0, 0.25, 9.765_625e-4], 4.888_921_972_235_249e-13, [0.134_083_461_683, 0.216_519_721_879]),
    ([-9.765_625e-4, 0.5, 6.103_515_6e-5], 6.993_102_802_293_794e-4, [0.021_333_999_403_4, 0.374_218_514_945]),
    ([0.5, 0.25, 2.441_406_3e-4], 6.278_778_843_522_815, [0.437_244_805_705, 0.249_870_981_752]),
    ([3.0, -2.0, 9.313_226e-10], 1.135_974_036_002_332e-11, [0.168_503_787_27, 0.189_425_324_062]),
    ([0.25, 0.75, 1.0], 0.356_351_557_935_519_64, [0.115_384_819_421, 0.279_505_975_479]),
];

#[test]
fn hard_points_of_view_against_sixty_digits() {
    let s = Vec2::new(0.25, 0.75);
    for (from, solid_angle, place) in RECTANGLES {
        let seen = SphericalRectangle::new(Vec3::ZERO, Vec3::X, Vec3::Y, from.into()).expect("it is seen");
        assert!((seen.solid_angle() / solid_angle - 1.0).abs() < 1e-10, "{from:?}: {}", seen.solid_angle());
        let found = seen.sample_shares(s);
        assert!((found.as_dvec2() - DVec2::from(place)).abs().max_element() < 1e-7, "{from:?}: {found}");
    }
    for (from, solid_angle, place) in TRIANGLES {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::new(0.25, 1.0, 0.0)];
        let seen = SphericalTriangle::new(corners, from.into()).expect("it is seen");
        assert!((seen.solid_angle() / solid_angle - 1.0).abs() < 1e-10, "{from:?}: {}", seen.solid_angle());
        let found = seen.sample_weights(s);
        assert!((found.as_dvec2() - DVec2::from(place)).abs().max_element() < 1e-7, "{from:?}: {found}");
    }
}

#[test]
fn no_point_of_view_gives_what_is_no_number() {
    let mut random = Random::new(29);
    let (mut quads, mut triangles) = (0, 0);
    for _ in 0..100_000 {
        let mut power = |low: f32, high: f32| 10_f32.powf(low + (high - low) * random.unit());
        let (width, height) = (power(-3.0, 3.0), power(-3.0, 3.0));
        let (distance, elevation) = (power(-6.0, 5.0), power(-12.0, 1.0));
        let mut towards = random.direction();
        towards.z *= elevation;
        let near = random.square() * Vec2::new(width, height);
        // Every fourth on a line through an edge, where differences vanish.
        let near = if random.bits() & 3 == 0 { Vec2::new(near.x, 0.0) } else { near };
        let from = near.extend(0.0) + distance * towards;
        let (u, v, s) = (width * Vec3::X, height * Vec3::Y, random.square());
        let ends = [Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON / 2.0), s];
        if let Some(seen) = SphericalRectangle::new(Vec3::ZERO, u, v, from) {
            quads += 1;
            assert!(seen.solid_angle() > 0.0 && seen.solid_angle() < TAU, "{from}");
            for s in ends {
                let shares = seen.sample_shares(s);
                assert!(shares.min_element() >= 0.0 && shares.max_element() <= 1.0, "{from}, {s}: {shares}");
                assert!(seen.sample_offset(s).is_finite() && seen.square_from_shares(shares).is_finite());
            }
        }
        if let Some(seen) = SphericalTriangle::new([Vec3::ZERO, u, v + 0.3 * u], from) {
            triangles += 1;
            assert!(seen.solid_angle() > 0.0 && seen.solid_angle() < TAU, "{from}");
            for s in ends {
                let weights = seen.sample_weights(s);
                assert!(weights.min_element() >= 0.0 && weights.element_sum() <= 1.000_000_2, "{from}, {s}: {weights}");
                assert!(seen.sample_offset(s).is_finite() && seen.square_from_weights(weights).is_finite());
            }
        }
    }
    assert!(quads > 50_000 && triangles > 50_000, "{quads}, {triangles}");
}

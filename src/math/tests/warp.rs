//! Each map of the unit square against its density and its inverse.

use super::super::testing::{ChiSquared, Domain, Random, round_trip};
use super::super::*;
use glam::{Vec2, Vec3, Vec3Swizzles};

/// How far an inverse may miss: some steps of an `f32`, and more at a rim, where the slope is steep.
const ROUND_TRIP: f32 = 2e-6;

/// The edges of the square, exactly and by the smallest steps that variates have.
fn rims() -> Vec<Vec2> {
    let ends = [
        0.0,
        2.0_f32.powi(-32),
        2.0_f32.powi(-24),
        0.25,
        0.5 - f32::EPSILON / 4.0,
        0.5,
        0.75,
        1.0 - f32::EPSILON / 2.0,
    ];
    ends.iter().flat_map(|&x| ends.iter().map(move |&y| Vec2::new(x, y))).collect()
}

#[test]
fn the_disk() {
    let square = Domain::Plane(Vec2::splat(-1.0), Vec2::splat(1.0));
    let test = ChiSquared { cells: [41, 41], ..ChiSquared::over(square) };
    // Rounding may carry the rim out of the disk; the density of the sample is asked a hair further in.
    let sample = |u| (square_to_disk(u) * (1.0 - 1e-6)).extend(0.0);
    let p = test.run(sample, |p| f64::from(disk_pdf(p.xy())));
    assert!(p.is_ok(), "{p:?}");
    assert_eq!(round_trip(|u| square_to_disk(u).extend(0.0), |p| disk_to_square(p.xy()), ROUND_TRIP), Ok(()));
    assert_eq!(disk_pdf(Vec2::new(0.8, 0.8)), 0.0);
    assert!(rims().into_iter().all(|u| square_to_disk(u).length() < 1.0 + 1e-6));
}

#[test]
fn the_uniform_hemisphere() {
    let p =
        ChiSquared::over(Domain::Sphere).run(square_to_uniform_hemisphere, |w| f64::from(uniform_hemisphere_pdf(w)));
    assert!(p.is_ok(), "{p:?}");
    assert_eq!(round_trip(square_to_uniform_hemisphere, uniform_hemisphere_to_square, ROUND_TRIP), Ok(()));
    assert_eq!(uniform_hemisphere_pdf(-Vec3::Z), 0.0);
}

#[test]
fn the_cosine_hemisphere() {
    let p = ChiSquared::over(Domain::Sphere).run(square_to_cosine_hemisphere, |w| f64::from(cosine_hemisphere_pdf(w)));
    assert!(p.is_ok(), "{p:?}");
    assert_eq!(round_trip(square_to_cosine_hemisphere, cosine_hemisphere_to_square, ROUND_TRIP), Ok(()));
    assert_eq!(cosine_hemisphere_pdf(-Vec3::Z), 0.0);
}

#[test]
fn hemispheres_stay_above_the_horizon_and_on_the_sphere() {
    let mut random = Random::new(11);
    for u in rims().into_iter().chain((0..100_000).map(|_| random.square())) {
        for (w, least) in [(square_to_uniform_hemisphere(u), 4e-10), (square_to_cosine_hemisphere(u), 2e-5)] {
            assert!(w.z >= least && (w.length() - 1.0).abs() < 1e-6, "{u} to {w}");
        }
    }
}

#[test]
fn the_cosine_is_exact_towards_the_horizon() {
    // On the diagonal-free axis z² = 1 − (1 − 2u)² = 4u(1 − u).
    for u in [1e-7_f32, 1e-5, 1e-3, 0.1, 0.4] {
        let exact = (4.0 * f64::from(u) * (1.0 - f64::from(u))).sqrt();
        let z = f64::from(square_to_cosine_hemisphere(Vec2::new(u, 0.5)).z);
        assert!((z / exact - 1.0).abs() < 2e-7, "{u}");
    }
}

#[test]
fn the_triangle() {
    let test = ChiSquared { cells: [41, 41], ..ChiSquared::over(Domain::Plane(Vec2::ZERO, Vec2::ONE)) };
    let p = test.run(|u| square_to_triangle(u).extend(0.0), |w| f64::from(triangle_pdf(w.xy())));
    assert!(p.is_ok(), "{p:?}");
    assert_eq!(round_trip(|u| square_to_triangle(u).extend(0.0), |w| triangle_to_square(w.xy()), 3e-7), Ok(()));
    assert_eq!((triangle_pdf(Vec2::new(0.6, 0.6)), triangle_pdf(Vec2::new(-0.1, 0.6))), (0.0, 0.0));
    for w in rims().into_iter().map(square_to_triangle) {
        assert!(w.min_element() >= 0.0 && w.element_sum() <= 1.0, "{w}");
    }
}

#[test]
fn neighbours_stay_neighbours() {
    // No map tears the square: the image of a step is at most four times as long. Of the hemispheres seen from above,
    // since the slope of the cosine's z at the rim is infinite.
    let maps: [fn(Vec2) -> Vec2; 4] = [
        square_to_disk,
        square_to_triangle,
        |u| square_to_cosine_hemisphere(u).xy(),
        |u| square_to_uniform_hemisphere(u).xy(),
    ];
    let mut random = Random::new(13);
    for _ in 0..100_000 {
        let (u, step) = (0.999 * random.square(), 1e-3 * random.square());
        for map in maps {
            assert!((map(u + step) - map(u)).length() <= 4.0 * step.length() + 1e-6, "{u}");
        }
    }
}

#[test]
fn the_uniform_cone_and_the_sphere() {
    // Wide cones on the sphere, their rim aligned with the cells' heights: 1 − z is a multiple of 2/25.
    for height in [0.08_f32, 0.4, 1.04, 1.92] {
        let sample = |u| square_to_uniform_cone(u, height * (1.0 - 1e-6));
        let density = |w: Vec3| if 1.0 - w.z <= height { f64::from(uniform_cone_pdf(height)) } else { 0.0 };
        let p = ChiSquared::over(Domain::Sphere).run(sample, density);
        assert!(p.is_ok(), "{height}: {p:?}");
        let too_wide = ChiSquared::over(Domain::Sphere).run(sample, |w| 1.05 * density(w));
        assert!(too_wide.is_err(), "{height}: {too_wide:?}");
    }
    let p = ChiSquared::over(Domain::Sphere).run(square_to_uniform_sphere, |_| f64::from(uniform_sphere_pdf()));
    assert!(p.is_ok(), "{p:?}");
    // Narrow ones by their inverse; the sphere's, but near −Z, where the slope has no bound.
    for height in [1e-12_f32, 1e-6, 0.3, 1.0] {
        let (map, inverse) = (|u| square_to_uniform_cone(u, height), |w| uniform_cone_to_square(w, height));
        assert_eq!(round_trip(map, inverse, ROUND_TRIP), Ok(()), "{height}");
    }
    let inner = |u: Vec2| square_to_uniform_sphere(0.1 + 0.8 * u);
    assert_eq!(round_trip(inner, |w| (uniform_sphere_to_square(w) - 0.1) / 0.8, 1e-5), Ok(()));
    for u in rims() {
        for height in [1e-30, 1e-9, 0.5, 2.0] {
            let w = square_to_uniform_cone(u, height);
            assert!((w.length() - 1.0).abs() < 1e-6 && 1.0 - w.z <= height * 1.000_001 + 1e-7, "{u} {height}: {w}");
        }
    }
}

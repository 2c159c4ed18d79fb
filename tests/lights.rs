//! Lights against closed forms and quadrature: spheres, points, cones, suns and pictures of the sky; noise against
//! samples where the choice of light decides it; and the three estimators against each other.
//!
//! A test passes only if |mean − truth| + 4 standard errors ≤ tolerance: too noisy fails like wrong.

mod common;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::math::{Welford, sphere_above_horizon, welch_t_test};
use bevy_kiln::scene::{DirectionalLight, EnvironmentMap, Light, PointLight, Scene, SpotLight};
use bevy_kiln::trace::{Estimator, Transport};
use common::meter::{at, by, on_walls, read};
use common::scenes::{SceneBuilder, grey};
use common::statistics::mean_within;
use glam::{Quat, Vec2, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

const ALL: [Estimator; 3] = [Estimator::Mis, Estimator::Light, Estimator::Bsdf];

fn point_light(name: &str, position: Vec3, intensity: f32, radius: f32) -> PointLight {
    PointLight {
        id: StableId::new(name),
        name: name.into(),
        position,
        intensity: Vec3::splat(intensity),
        radius,
        range: None,
    }
}

/// A sphere of this radiance.
fn sphere_light(name: &str, position: Vec3, radiance: f32, radius: f32) -> Light {
    Light::Point(point_light(name, position, radiance * (PI as f32) * radius * radius, radius))
}

fn sun(name: &str, towards: Vec3, illuminance: f32, angular_diameter: f32) -> Light {
    Light::Directional(DirectionalLight {
        id: StableId::new(name),
        name: name.into(),
        direction: -towards.normalize(),
        illuminance: Vec3::splat(illuminance),
        angular_diameter,
    })
}

fn lit_by(lights: impl IntoIterator<Item = Light>) -> Scene {
    let scene = Scene { lights: lights.into_iter().collect(), ..Scene::default() };
    assert_eq!(scene.validate(), []);
    scene
}

/// A picture of the sky from its radiance in a direction of its own frame, taken at the pixels' middles.
fn sky(size: [u32; 2], world_from_map: Quat, radiance: impl Fn(Vec3) -> Vec3) -> EnvironmentMap {
    let [width, height] = size;
    let middle = |index: u32| {
        let place = Vec2::new((index % width) as f32 + 0.5, (index / width) as f32 + 0.5);
        EnvironmentMap::direction_of(place / Vec2::new(width as f32, height as f32))
    };
    EnvironmentMap {
        name: "sky".into(),
        width,
        height,
        radiance: (0..width * height).map(|index| radiance(middle(index))).collect(),
        world_from_map,
    }
}

fn under(map: EnvironmentMap) -> Scene {
    let scene = Scene { environment: Some(map), ..Scene::default() };
    assert_eq!(scene.validate(), []);
    scene
}

/// Holds a point against `truth`, to a relative `tolerance` (absolute for darkness), by these estimators.
#[track_caller]
fn assert_point(scene: &Scene, point: MeterPoint, truth: f64, tolerance: f64, estimators: &[Estimator]) {
    for &estimator in estimators {
        // Rays that leave the surface find what is small but rarely, so that less can be asked of them.
        let is_blind = estimator == Estimator::Bsdf && truth > 0.0;
        let (samples, tolerance) = if is_blind { (1 << 18, tolerance.max(0.03)) } else { (1 << 15, tolerance) };
        let reading = read(scene, &[point], samples, by(estimator))[0];
        let allowed = if truth == 0.0 { tolerance } else { tolerance * truth };
        mean_within(reading.irradiance.y, reading.stderr.y, truth, allowed)
            .unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
    }
}

fn up() -> MeterPoint {
    at(Vec3::ZERO, Vec3::Y)
}

/// π L (r/d)² cos θ.
#[test]
fn a_sphere_above_the_horizon() {
    for (centre, radius) in
        [(Vec3::new(0.0, 2.0, 0.0), 0.5_f32), (Vec3::new(2.0, 1.5, -0.5), 0.7), (Vec3::Y * 3.0, 2.9)]
    {
        let scene = lit_by([sphere_light("bulb", centre, 1.0, radius)]);
        let direction = f64::from(centre.normalize().y);
        let truth = PI * sphere_above_horizon(f64::from(radius), f64::from(centre.length()), direction);
        assert_point(&scene, up(), truth, 2e-3, &ALL);
    }
    let truth = 0.196349541;
    assert_point(&lit_by([sphere_light("bulb", Vec3::Y * 2.0, 1.0, 0.5)]), up(), truth, 1e-3, &ALL);
}

/// ∫ of the cosine over the part above the horizon of a cone of this half angle, its axis at this elevation, by
/// quadrature over the polar angle from the zenith.
fn above_the_horizon(elevation: f64, half_angle: f64) -> f64 {
    let steps = 200_000;
    let step = FRAC_PI_2 / f64::from(steps);
    let zenith = FRAC_PI_2 - elevation;
    let ring = |index: i32| {
        let theta = (f64::from(index) + 0.5) * step;
        // Half the width in longitude of the cone on this ring.
        let cosine = (half_angle.cos() - theta.cos() * zenith.cos()) / (theta.sin() * zenith.sin());
        2.0 * cosine.clamp(-1.0, 1.0).acos() * theta.cos() * theta.sin() * step
    };
    (0..steps).map(ring).sum()
}

#[test]
fn the_quadrature_is_right_where_the_answer_is_known() {
    // Wholly above: π sin² of the half angle × sin of the elevation. Half of it (Howell's catalogue, B-15): a − sin a cos a.
    assert!((above_the_horizon(0.7, 0.3) / (PI * 0.3_f64.sin().powi(2) * 0.7_f64.sin()) - 1.0).abs() < 1e-6);
    assert!((above_the_horizon(0.0, 0.8) / (0.8 - 0.8_f64.sin() * 0.8_f64.cos()) - 1.0).abs() < 1e-5);
    assert!(above_the_horizon(-0.5, 0.4).abs() < 1e-12);
}

#[test]
fn a_sphere_that_the_horizon_cuts() {
    for (elevation, half_angle) in [(0.2_f64, 0.5_f64), (-0.3, 0.6), (0.0, 0.25)] {
        let centre = 3.0 * Vec3::new(elevation.cos() as f32, elevation.sin() as f32, 0.0);
        let scene = lit_by([sphere_light("bulb", centre, 1.0, (3.0 * half_angle.sin()) as f32)]);
        assert_point(&scene, up(), above_the_horizon(elevation, half_angle), 3e-3, &ALL);
    }
    // Wholly below.
    assert_point(&lit_by([sphere_light("bulb", Vec3::new(1.0, -0.6, 0.0), 1.0, 0.5)]), up(), 0.0, 1e-9, &ALL);
}

/// A receiver inside sees the sphere shrunk until it touches: as much light as from its middle.
#[test]
fn a_receiver_inside_a_sphere() {
    let lamp = Light::Point(point_light("bulb", Vec3::new(0.3, 0.4, 0.0), 2.0, 1.5));
    assert_point(
        &lit_by([lamp.clone()]),
        up(),
        2.0 / 0.25 * above_the_horizon(0.8_f64.asin(), FRAC_PI_2) / PI,
        3e-3,
        &ALL,
    );
    // Facing it, where nothing is lost below the horizon.
    let facing = at(Vec3::ZERO, Vec3::new(0.6, 0.8, 0.0));
    assert_point(&lit_by([lamp]), facing, 2.0 / 0.25, 2e-3, &ALL);
}

/// I cos θ / d², under Bevy's range window and in Bevy's cone.
#[test]
fn points_and_spots() {
    let position = Vec3::new(0.5, 2.0, 1.0);
    let point = point_light("bulb", position, 3.0, 0.0);
    let bare = 3.0 * f64::from(position.normalize().y) / f64::from(position.length_squared());
    assert_point(&lit_by([Light::Point(point.clone())]), up(), bare, 1e-5, &ALL);
    let ranged = PointLight { range: Some(3.0), ..point.clone() };
    let window = (1.0 - (f64::from(position.length_squared()) / 9.0).powi(2)).powi(2);
    assert_point(&lit_by([Light::Point(ranged)]), up(), bare * window, 1e-4, &ALL);
    let out_of_range = PointLight { range: Some(2.0), ..point.clone() };
    assert_point(&lit_by([Light::Point(out_of_range)]), up(), 0.0, 1e-12, &ALL);
    for (inner, outer) in [(0.1_f32, 0.8_f32), (0.0, 0.6), (0.3, 0.3), (0.7, 0.7)] {
        let spot =
            |bulb| Light::Spot(SpotLight { bulb, direction: Vec3::NEG_Y, inner_angle: inner, outer_angle: outer });
        let cosine = f64::from(position.normalize().y);
        let [inside, outside] = [inner, outer].map(|angle| f64::from(angle).cos());
        let share = ((cosine - outside) / (inside - outside).max(1e-4)).clamp(0.0, 1.0).powi(2);
        assert_point(&lit_by([spot(point.clone())]), up(), bare * share, 1e-4, &ALL);
        // All of a sphere is dimmed alike.
        let sphere = PointLight { radius: 0.4, ..point.clone() };
        assert_point(&lit_by([spot(sphere)]), up(), bare * share, 3e-3, &ALL);
    }
}

/// E sin of the elevation, whatever the diameter, while all of the disc is up; the quadrature's part of it where not.
#[test]
fn suns_of_several_diameters() {
    for diameter in [0.0_f32, 1e-4, 0.0093, 0.3, 1.0] {
        let elevation = 0.6_f64;
        let towards = Vec3::new(elevation.cos() as f32, elevation.sin() as f32, 0.0);
        let estimators = if diameter > 0.1 || diameter == 0.0 { &ALL[..] } else { &ALL[..2] };
        assert_point(&lit_by([sun("sun", towards, 7.0, diameter)]), up(), 7.0 * elevation.sin(), 2e-3, estimators);
    }
    let half_the_sky = lit_by([sun("sun", Vec3::Y, 7.0, std::f32::consts::PI)]);
    assert_point(&half_the_sky, up(), 7.0, 1e-3, &ALL);
    assert_point(&half_the_sky, at(Vec3::ZERO, Vec3::X), 3.5, 2e-3, &ALL);
    for (elevation, diameter) in [(0.1_f64, 0.5_f32), (-0.1, 0.5), (0.5, 3.0), (0.0, 0.1)] {
        let towards = Vec3::new(0.0, elevation.sin() as f32, elevation.cos() as f32);
        let half = 0.5 * f64::from(diameter);
        let truth = 5.0 / (PI * half.sin().powi(2)) * above_the_horizon(elevation, half);
        let estimators = if diameter > 0.3 && elevation > 0.0 { &ALL[..] } else { &ALL[..2] };
        assert_point(&lit_by([sun("sun", towards, 5.0, diameter)]), up(), truth, 4e-3, estimators);
    }
    assert_point(&lit_by([sun("sun", Vec3::NEG_Y, 5.0, 0.5)]), up(), 0.0, 1e-12, &ALL);
}

/// Uniform: E = π L, whatever the size and the rotation.
#[test]
fn a_uniform_picture_of_the_sky() {
    let tilted = Quat::from_euler(glam::EulerRot::XYZ, 0.5, -1.2, 2.0);
    for (size, rotation) in [([64, 32], Quat::IDENTITY), ([1, 1], tilted), ([1024, 512], tilted)] {
        let scene = under(sky(size, rotation, |_| Vec3::new(1.0, 2.0, 3.0)));
        assert_point(&scene, up(), 2.0 * PI, 1e-3, &ALL);
    }
}

/// L = cos of the angle to a direction, 0 beyond: E = 2π/3 facing it; where the picture's up is rotated, too.
#[test]
fn a_gradient() {
    let rotation = Quat::from_rotation_arc(Vec3::Y, Vec3::new(0.48, 0.6, -0.64));
    for rotation in [Quat::IDENTITY, rotation] {
        let scene = under(sky([1024, 512], rotation, |w| Vec3::splat(w.y.max(0.0))));
        assert_point(&scene, at(Vec3::ZERO, rotation * Vec3::Y), 2.0 * PI / 3.0, 1e-3, &ALL);
    }
    // Coarse: constant over each row. ∫ of it by rows, exactly.
    let coarse: f64 = (0..16)
        .map(|row| {
            let [top, bottom] = [row, row + 1].map(|edge| PI * f64::from(edge) / 32.0);
            PI * (bottom.sin().powi(2) - top.sin().powi(2)) * (0.5 * (top + bottom)).cos()
        })
        .sum();
    assert_point(&under(sky([64, 32], Quat::IDENTITY, |w| Vec3::splat(w.y.max(0.0)))), up(), coarse, 1e-3, &ALL);
}

/// A picture lies where its convention says, turned by its rotation: one bright octant and a meter on each side.
#[test]
fn pictures_are_the_right_way_round() {
    let rotation = Quat::from_euler(glam::EulerRot::YXZ, 0.7, 0.2, -1.1);
    let octant = sky([64, 32], rotation, |w| Vec3::splat(if w.cmpgt(Vec3::ZERO).all() { 1.0 } else { 0.0 }));
    let scene = under(octant);
    for (axis, truth) in [(Vec3::X, PI / 4.0), (Vec3::Y, PI / 4.0), (Vec3::Z, PI / 4.0), (Vec3::NEG_X, 0.0)] {
        let tolerance = if truth == 0.0 { 1e-4 } else { 2e-3 };
        assert_point(&scene, at(Vec3::ZERO, rotation * axis), truth, tolerance, &ALL);
    }
}

/// The floor of a long slot, and a wall across half of the view, under the same sky as a picture and as a constant.
#[test]
fn a_slot_and_a_wall_under_both_kinds_of_sky() {
    let skies = |build: &dyn Fn() -> SceneBuilder| {
        let mut picture = build().build();
        picture.environment = Some(sky([64, 32], Quat::from_rotation_z(0.3), |_| Vec3::ONE));
        [build().sky(Vec3::ONE).build(), picture]
    };
    for (height, truth) in [(0.5_f32, 0.5_f64.sqrt()), (1.0, 0.447213595), (2.0, 0.242535625)] {
        let slot = || {
            let long = Vec3::Z * 2e4;
            SceneBuilder::default()
                .quad("floor", Vec3::new(-0.5, 0.0, -1e4), [long, Vec3::X], grey(0.0))
                .quad("left", Vec3::new(-0.5, 0.0, -1e4), [Vec3::Y * height, long], grey(0.0))
                .quad("right", Vec3::new(0.5, 0.0, -1e4), [long, Vec3::Y * height], grey(0.0))
        };
        for scene in skies(&slot) {
            assert_point(&scene, up(), PI * truth, 8e-3, &[Estimator::Mis]);
            assert_point(&scene, up(), PI * truth, 0.02, &[Estimator::Light, Estimator::Bsdf]);
        }
    }
    for elevation in [0.3_f64, 0.8] {
        let wall = || {
            let top = Vec3::Y * elevation.tan() as f32;
            let corner = Vec3::new(1.0, 0.0, -1e4);
            SceneBuilder::default().quad("wall", corner, [Vec3::Z * 2e4, top], grey(0.0))
        };
        for scene in skies(&wall) {
            assert_point(&scene, up(), FRAC_PI_2 * (1.0 + elevation.cos()), 4e-3, &ALL);
        }
    }
}

/// A sun, a point and a sky of one radiance over a floor: E = 3 cos 30° + 5 cos θ / d² + π/4.
#[test]
fn sun_point_and_sky_together() {
    let towards_sun = Vec3::new(0.0, 30.0_f32.to_radians().cos(), 30.0_f32.to_radians().sin());
    let lamp = Vec3::new(0.5, 2.0, -0.3);
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-2.0, 0.0, -2.0), [Vec3::Z * 4.0, Vec3::X * 4.0], grey(0.0))
        .sky(Vec3::splat(0.25))
        .build();
    scene.lights = vec![sun("sun", towards_sun, 3.0, 0.0), Light::Point(point_light("bulb", lamp, 5.0, 0.0))];
    for (x, z) in [(0.0, 0.0), (1.1, -0.83), (-1.7, 1.9)] {
        let position = Vec3::new(x, 0.0, z);
        let offset = lamp - position;
        let truth = 3.0 * 30.0_f64.to_radians().cos()
            + 5.0 * f64::from(offset.y) / f64::from(offset.length()).powi(3)
            + PI / 4.0;
        assert_point(&scene, at(position, Vec3::Y), truth, 2e-3, &ALL);
    }
}

/// Variance of a single sample's worth, from the standard error.
fn variance(scene: &Scene, point: MeterPoint, samples: u32, estimator: Estimator) -> (f64, f64) {
    let mut spread = Welford::default();
    for run in 0..32 {
        let transport = Transport { estimator, max_bounces: None, seed: 100 * (estimator as u64 + 1) + run };
        spread.push(read(scene, &[point], samples, transport)[0].irradiance.y);
    }
    (spread.mean(), spread.variance())
}

/// One bright pixel: aiming at it leaves less than a hundredth of the variance of going where the cosine leads.
#[test]
fn one_bright_pixel() {
    let bright = Vec3::new(0.3, 0.8, -0.5).normalize();
    let scene =
        under(sky([64, 32], Quat::IDENTITY, |w| Vec3::splat(if w.distance(bright) < 0.05 { 1000.0 } else { 0.1 })));
    let [(mis, mis_variance), (light, light_variance), (bsdf, bsdf_variance)] =
        ALL.map(|estimator| variance(&scene, up(), 1024, estimator));
    println!(
        "variance over 1024 samples: mis {mis_variance:.3e}, light {light_variance:.3e}, bsdf {bsdf_variance:.3e}"
    );
    assert!((mis / light - 1.0).abs() < 0.02 && (mis / bsdf - 1.0).abs() < 0.1, "{mis} {light} {bsdf}");
    assert!(bsdf_variance > 100.0 * mis_variance, "{bsdf_variance} {mis_variance}");
    assert!(bsdf_variance > 100.0 * light_variance, "{bsdf_variance} {light_variance}");
}

/// A ceiling of 500 small lamps against one of the same extent and power: as much light, and an error at equal samples
/// of at most twice as much.
#[test]
fn five_hundred_small_lamps_are_as_good_as_a_large_one() {
    let (columns, rows) = (25, 20);
    let size = Vec2::new(2.5, 2.0);
    let pitch = size / Vec2::new(columns as f32, rows as f32);
    let centre = |index: u32| {
        let place = (Vec2::new((index % columns) as f32, (index / columns) as f32) + 0.5) * pitch - 0.5 * size;
        Vec3::new(place.x, 2.0, place.y)
    };
    let one = SceneBuilder::default().rect_light("lamp", Vec3::Y * 2.0, Vec3::NEG_Y, size, Vec3::ONE).build();
    // A quarter of the area, four times the radiance.
    let panels = (0..columns * rows).fold(SceneBuilder::default(), |scene, index| {
        scene.rect_light(&format!("lamp {index}"), centre(index), Vec3::NEG_Y, 0.5 * pitch, Vec3::splat(4.0))
    });
    let panels = panels.build();
    let bulbs = lit_by((0..columns * rows).map(|index| {
        let intensity = pitch.element_product();
        Light::Point(point_light(&format!("bulb {index}"), centre(index), intensity, 0.01))
    }));
    let mut worst = 0.0_f64;
    for point in [
        up(),
        at(Vec3::new(1.5, 0.0, 1.0), Vec3::Y),
        at(Vec3::new(0.2, 1.0, 0.1), Vec3::Y),
        at(Vec3::new(3.0, 0.5, 0.0), Vec3::NEG_X),
    ] {
        for estimator in [Estimator::Mis, Estimator::Light] {
            let found = [&one, &panels, &bulbs].map(|scene| variance(scene, point, 256, estimator));
            let [one, panels, bulbs] = found.map(|(mean, variance)| variance.sqrt() / mean);
            println!(
                "{estimator:?} at {}: relative error of one lamp {one:.5}, of 500 panels {panels:.5}, of 500 bulbs \
                 {bulbs:.5}",
                point.position,
            );
            assert!((found[1].0 / found[0].0 - 1.0).abs() < 0.01, "{found:?}");
            if estimator == Estimator::Mis {
                worst = worst.max(panels / one);
            }
        }
    }
    assert!(worst < 2.0, "{worst}");
}

/// Whether two estimators agree: not told apart by Welch's test, and seen well enough that 1 % would be.
fn agree(a: &Welford, b: &Welford) -> Result<(), String> {
    let spread = a.standard_error().hypot(b.standard_error());
    if 4.0 * spread > 0.01 * a.mean() {
        return Err(format!("too noisy to see 1 %: {} and {} ± {spread}", a.mean(), b.mean()));
    }
    let welch = welch_t_test(a, b).ok_or("no spread to judge by")?;
    if welch.p_value < 1e-4 { Err(format!("{} and {}: p = {}", a.mean(), b.mean(), welch.p_value)) } else { Ok(()) }
}

/// A room with a window and a shelf.
fn room() -> SceneBuilder {
    let side = || grey(0.6);
    SceneBuilder::default()
        .quad("floor", Vec3::ZERO, [Vec3::Z * 3.0, Vec3::X * 3.0], side())
        .quad("back", Vec3::ZERO, [Vec3::X * 3.0, Vec3::Y * 3.0], side())
        .quad("left", Vec3::ZERO, [Vec3::Y * 3.0, Vec3::Z * 3.0], side())
        .quad("shelf", Vec3::new(0.5, 1.0, 0.2), [Vec3::Z, Vec3::X * 1.5], side())
}

#[test]
fn three_estimators_agree() {
    let lamps = [
        sphere_light("bulb", Vec3::new(2.0, 1.5, 1.5), 3.0, 0.3),
        sphere_light("large", Vec3::new(1.0, 3.2, 2.0), 0.5, 0.9),
        sun("sun", Vec3::new(0.5, 1.0, 0.7), 2.0, 0.5),
        Light::Spot(SpotLight {
            bulb: point_light("spot", Vec3::new(2.5, 2.5, 2.5), 3.0, 0.2),
            direction: Vec3::new(-1.0, -1.0, -1.0).normalize(),
            inner_angle: 0.2,
            outer_angle: 0.7,
        }),
        sun("low", Vec3::new(1.0, 0.1, 0.2), 1.0, 0.0),
    ];
    let picture =
        sky([32, 16], Quat::from_rotation_y(0.4), |w| Vec3::splat(0.2 + 3.0 * w.dot(Vec3::X).max(0.0).powi(8)));
    let mut all = room().build();
    all.lights = lamps.to_vec();
    all.environment = Some(picture.clone());
    let mut bulbs = room().build();
    bulbs.lights = lamps[..2].to_vec();
    let mut suns = room().build();
    suns.lights = vec![lamps[2].clone(), lamps[4].clone()];
    let mut pictured = room().build();
    pictured.environment = Some(picture);
    let points = on_walls(Vec3::ZERO, Vec3::splat(3.0), 2);
    let points = [&points[..4], &points[8..12]].concat();
    for (name, scene) in [("all", all), ("bulbs", bulbs), ("suns", suns), ("picture", pictured)] {
        let [mis, light, bsdf] = ALL.map(|estimator| {
            let samples = if estimator == Estimator::Bsdf { 8192 } else { 1024 };
            let mut means = Welford::default();
            for run in 0..16 {
                let transport = Transport { estimator, max_bounces: None, seed: 1000 * (estimator as u64 + 1) + run };
                let readings = read(&scene, &points, samples, transport);
                means.push(readings.iter().map(|reading| reading.irradiance.y).sum::<f64>() / points.len() as f64);
            }
            means
        });
        for other in [&light, &bsdf] {
            agree(&mis, other).unwrap_or_else(|reason| panic!("{name}: {reason}"));
        }
        let mut biased = Welford::default();
        for run in 0..16 {
            biased.push(mis.mean() * 1.02 + mis.variance().sqrt() * (f64::from(run) - 7.5) / 5.0);
        }
        agree(&mis, &biased).expect_err("a planted bias of 2 % went unseen");
    }
}

/// Light passes a lamp that blocks nothing, from a lamp that is inside another, and the room keeps what it gets.
#[test]
fn bulbs_in_a_closed_room_balance() {
    let wall = || grey(0.5);
    let mut scene = SceneBuilder::default()
        .room(Vec3::ZERO, Vec3::splat(2.0), [wall(), wall(), wall(), wall(), wall(), wall()])
        .build();
    scene.lights = vec![
        sphere_light("large", Vec3::splat(1.0), 1.0, 0.5),
        sphere_light("small", Vec3::new(1.1, 0.9, 1.2), 4.0, 0.1),
        Light::Point(point_light("point", Vec3::new(0.4, 1.3, 1.2), 1.0, 0.0)),
    ];
    // Mean E over the walls: flux / (area · (1 − ρ)).
    let flux = 4.0 * PI * (PI * 0.25 + PI * 4.0 * 0.01 + 1.0);
    let points = on_walls(Vec3::ZERO, Vec3::splat(2.0), 8);
    let readings = read(&scene, &points, 256, Transport::default());
    let (mean, error) = common::meter::mean(&readings, 0);
    mean_within(mean, error, flux / (24.0 * 0.5), 0.01 * flux / 12.0).unwrap();
}

//! Surfaces that light passes straight: holes cut by a mask, things that are there in part, tints and clear panes.
//! What arrives behind them against closed forms, for light from one direction, from a lamp and from a whole sky.

mod common;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{CancelToken, MeterPoint, PictureSettings, render_picture};
use bevy_kiln::math::{Welford, corner_parallel_rectangle, polygon_irradiance, welch_t_test};
use bevy_kiln::scene::{
    Alpha, Camera, DirectionalLight, Filter, Light, Material, PointLight, Scattering, Scene, Standard, Texels, Texture,
    TextureRef, UvChannel, Wrap,
};
use bevy_kiln::trace::{Effect, Estimator, Transport};
use common::meter::{at, by, mean, read};
use common::scenes::{SceneBuilder, glowing};
use common::statistics::mean_within;
use glam::{Affine2, DVec3, Vec2, Vec3, Vec4};
use std::f64::consts::PI;

const ESTIMATORS: [Estimator; 3] = [Estimator::Mis, Estimator::Light, Estimator::Bsdf];

/// A surface that reflects nothing, so that all light is straight from its source.
fn black(alpha: Alpha, colour: Vec4) -> Material {
    Material { name: "screen".into(), base_colour: colour, alpha, scattering: Scattering::None, ..Material::default() }
}

/// A screen `height` above the origin, 200 m wide: from below it hides all of the sky but 0.1 %.
fn screen(height: f32, material: Material) -> Scene {
    let corner = Vec3::new(-100.0, height, -100.0);
    SceneBuilder::default().quad("screen", corner, [200.0 * Vec3::Z, 200.0 * Vec3::X], material).build()
}

fn sun(direction: Vec3, illuminance: Vec3) -> Light {
    Light::Directional(DirectionalLight {
        id: StableId::new("sun"),
        name: "sun".into(),
        direction: direction.normalize(),
        illuminance,
        angular_diameter: 0.0,
    })
}

/// A fence of stripes: a quarter of each period is bars, the rest holes.
fn stripes() -> Texture {
    let texels: Vec<[u8; 4]> = [255, 0, 0, 0].map(|alpha| [255, 255, 255, alpha]).to_vec();
    Texture {
        name: "stripes".into(),
        width: 4,
        height: 1,
        texels: Texels::Srgb8(texels.into()),
        wrap: [Wrap::Repeat; 2],
        filter: Filter::Nearest,
    }
}

/// A fence of fine stripes, five to the metre.
fn fence(height: f32) -> Scene {
    let mut scene = screen(height, black(Alpha::Mask { cutoff: 0.5 }, Vec4::ONE));
    scene.textures.push(stripes());
    scene.materials[0].base_colour_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
    scene.materials[0].uv_transform = Affine2::from_scale(Vec2::splat(1000.0));
    assert_eq!(scene.validate(), []);
    scene
}

/// Points of a row that runs across four stripes, 80 of them: twenty to a stripe.
fn across_the_stripes() -> Vec<MeterPoint> {
    (0..80).map(|i| at(Vec3::new(0.0, 0.0, 0.8 * (i as f32 + 0.5) / 80.0), Vec3::Y)).collect()
}

/// The sun makes stripes of light and shadow on the ground: a mask of coverage c leaves (1 − c)·E.
#[test]
fn a_fence_in_the_sun() {
    let mut scene = fence(1.0);
    scene.lights.push(sun(Vec3::new(0.3, -1.0, 0.0), Vec3::new(8.0, 4.0, 2.0)));
    let readings = read(&scene, &across_the_stripes(), 16, Transport::default());
    let full = 8.0 / f64::from(1.09_f32.sqrt());
    for reading in &readings {
        let share = reading.irradiance.x / full;
        assert!(share.abs() < 1e-4 || (share - 1.0).abs() < 1e-4, "{share} of the light");
    }
    let (through, _) = mean(&readings, 0);
    assert!((through / full - 0.75).abs() < 1e-3, "{through} of {full}");
}

/// Far below a fine fence the sky is dimmed by its coverage, whichever samples look for it.
#[test]
fn a_fence_under_a_sky() {
    let mut scene = fence(20.0);
    scene.sky_radiance = Vec3::ONE;
    let points = [at(Vec3::ZERO, Vec3::Y)];
    // What is beyond the screen's rim is open: sin² of the elevation, in both axes about 4 %.
    let open = 1.0 - parallel_seen(20.0);
    let truth = PI * (0.75 * (1.0 - open) + open);
    let reading = read(&scene, &points, 1 << 15, Transport::default())[0];
    mean_within(reading.irradiance.y, reading.stderr.y, truth, 0.01 * truth).unwrap();
}

/// Form factor of the screen seen from the origin, `height` below its middle.
fn parallel_seen(height: f64) -> f64 {
    4.0 * corner_parallel_rectangle(100.0, 100.0, height)
}

/// E behind a screen, over E without it.
#[track_caller]
fn assert_transmittance(material: Material, transmittance: Vec3) {
    let mut scene = screen(1.0, material.clone());
    scene.lights.push(sun(Vec3::NEG_Y, Vec3::ONE));
    let reading = read(&scene, &[at(Vec3::ZERO, Vec3::Y)], 16, Transport::default())[0];
    let off = (reading.irradiance - transmittance.as_dvec3()).abs().max_element();
    assert!(off < 1e-5, "sun: {} instead of {transmittance}", reading.irradiance);

    // The same from a lamp above the screen, which all three estimators find.
    let lamp = |screen: Option<Material>| {
        let lamp =
            SceneBuilder::default().quad("lamp", Vec3::new(-0.5, 2.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 1.0));
        let corner = Vec3::new(-5.0, 1.0, -5.0);
        match screen {
            Some(material) => lamp.quad("screen", corner, [10.0 * Vec3::Z, 10.0 * Vec3::X], material).build(),
            None => lamp.build(),
        }
    };
    let points = [at(Vec3::new(0.2, 0.0, 0.1), Vec3::Y)];
    for estimator in ESTIMATORS {
        let open = read(&lamp(None), &points, 1 << 13, by(Estimator::Light))[0];
        let paths = if estimator == Estimator::Bsdf { 1 << 18 } else { 1 << 15 };
        let behind = read(&lamp(Some(material.clone())), &points, paths, by(estimator))[0];
        for channel in 0..3 {
            let truth = open.irradiance[channel] * f64::from(transmittance[channel]);
            let error = behind.stderr[channel].hypot(open.stderr[channel] * f64::from(transmittance[channel]));
            mean_within(behind.irradiance[channel], error, truth, 0.03 * open.irradiance[channel])
                .unwrap_or_else(|reason| panic!("{estimator:?}, channel {channel}: {reason}"));
        }
    }
}

#[test]
fn what_is_there_in_part_lets_the_rest_through() {
    assert_transmittance(black(Alpha::Blend, Vec4::new(1.0, 0.5, 0.2, 0.3)), Vec3::splat(0.7));
}

#[test]
fn a_tint_multiplies_what_it_covers() {
    let colour = Vec4::new(1.0, 0.5, 0.0, 0.4);
    assert_transmittance(black(Alpha::Multiply, colour), Vec3::new(1.0, 0.8, 0.6));
}

#[test]
fn what_is_added_to_the_picture_takes_no_light() {
    assert_transmittance(black(Alpha::Add, Vec4::new(0.3, 0.3, 0.3, 1.0)), Vec3::ONE);
}

/// Coloured glass of no thickness, whose surface does not reflect: its colour is its transmittance.
#[test]
fn a_tinted_pane_multiplies_by_its_transmittance() {
    let standard = Standard {
        specular_transmission: 1.0,
        perceptual_roughness: 0.0,
        ior: 1.0,
        reflectance: 0.0,
        ..Standard::default()
    };
    let tint = Vec3::new(0.9, 0.5, 0.1);
    assert_transmittance(Material::scattering("pane", tint, Scattering::Standard(Box::new(standard))), tint);
}

/// The same of window glass: what its surface reflects at this angle is missing besides.
#[test]
fn a_window_takes_what_it_reflects() {
    let standard = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, ior: 1.5, ..Standard::default() };
    let mut scene = screen(1.0, Material::scattering("window", Vec3::ONE, Scattering::Standard(Box::new(standard))));
    for degrees in [0.0_f32, 40.0, 70.0] {
        let angle = degrees.to_radians();
        scene.lights = vec![sun(Vec3::new(angle.sin(), -angle.cos(), 0.0), Vec3::ONE)];
        let reading = read(&scene, &[at(Vec3::ZERO, Vec3::Y)], 16, Transport::default())[0];
        // Panes reflect as Bevy's surfaces do, by Schlick's formula with the material's own reflectance.
        let cosine = f64::from(angle.cos());
        let truth = cosine * (1.0 - (0.04 + 0.96 * (1.0 - cosine).powi(5)));
        assert!((reading.irradiance.x - truth).abs() < 2e-5, "{degrees}°: {} for {truth}", reading.irradiance.x);
    }
}

/// The three estimators agree in a room whose lamp hangs behind a fence and a pane, with all that bounces.
#[test]
fn estimators_agree_behind_a_fence_and_a_pane() {
    let grey = || common::scenes::grey(0.5);
    let pane = Standard {
        specular_transmission: 0.8,
        perceptual_roughness: 0.0,
        diffuse_transmission: 0.3,
        ..Standard::default()
    };
    let mut scene = SceneBuilder::default()
        .room(Vec3::ZERO, Vec3::splat(2.0), [grey(), grey(), grey(), grey(), grey(), grey()])
        .quad("lamp", Vec3::new(0.5, 1.9, 0.5), [Vec3::X, Vec3::Z], glowing(0.2, 4.0))
        .quad("fence", Vec3::new(0.0, 1.4, 0.0), [2.0 * Vec3::Z, 2.0 * Vec3::X], grey())
        .quad(
            "pane",
            Vec3::new(0.0, 0.8, 0.0),
            [2.0 * Vec3::Z, 2.0 * Vec3::X],
            Material::scattering("pane", Vec3::new(0.9, 0.7, 0.5), Scattering::Standard(Box::new(pane))),
        )
        .build();
    scene.textures.push(stripes());
    let fence = &mut scene.materials[7];
    fence.alpha = Alpha::Mask { cutoff: 0.5 };
    fence.base_colour_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
    fence.uv_transform = Affine2::from_scale(Vec2::splat(4.0));
    let points = [at(Vec3::new(0.7, 0.0, 1.1), Vec3::Y), at(Vec3::new(0.0, 1.1, 0.7), Vec3::X)];
    let runs = |estimator: Estimator| {
        let mut means = Welford::default();
        for run in 0..16 {
            let transport = Transport { estimator, seed: 100 * (estimator as u64 + 1) + run, ..Transport::default() };
            means.push(mean(&read(&scene, &points, 1 << 11, transport), 1).0);
        }
        means
    };
    let [mis, light, bsdf] = ESTIMATORS.map(runs);
    for (name, other) in [("light", light), ("bsdf", bsdf)] {
        let spread = mis.standard_error().hypot(other.standard_error());
        assert!(4.0 * spread < 0.03 * mis.mean(), "{name}: too noisy to see 3 %: {} ± {spread}", mis.mean());
        let p = welch_t_test(&mis, &other).unwrap().p_value;
        assert!(p > 1e-4, "{name}: {} and {}, p = {p}", mis.mean(), other.mean());
    }
}

/// Forced off, holes are filled: the report of what is simulated is what is simulated.
#[test]
fn holes_that_are_forced_off_are_filled() {
    let mut scene = fence(1.0);
    scene.lights.push(sun(Vec3::NEG_Y, Vec3::ONE));
    let mut transport = Transport::default();
    transport.effects.off = transport.effects.off.with(Effect::CutOuts);
    let readings = read(&scene, &across_the_stripes(), 16, transport);
    assert!(readings.iter().all(|reading| reading.irradiance.x == 0.0));
}

/// A quarter of a furnace's light is seen past a pane that is there to three quarters: E stays π·L.
#[test]
fn a_furnace_with_glowing_panes_in_it() {
    let scene = {
        let side = || glowing(0.6, 0.4);
        let mut pane = glowing(0.6, 0.4);
        pane.alpha = Alpha::Blend;
        pane.base_colour.w = 0.75;
        pane.double_sided = true;
        SceneBuilder::default()
            .room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()])
            .quad("pane", Vec3::new(-0.5, -0.2, -0.5), [Vec3::Z, Vec3::X], pane)
            .build()
    };
    for estimator in ESTIMATORS {
        let readings = read(&scene, &[at(Vec3::new(0.1, -1.0, 0.2), Vec3::Y)], 1 << 16, by(estimator));
        mean_within(readings[0].irradiance.x, readings[0].stderr.x, PI, 0.01 * PI)
            .unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
    }
}

/// A camera sees the ground through a black veil that is half there, and the sky lights the ground through the same
/// veil: what the camera's ray did must not decide what the next one does.
#[test]
fn a_camera_and_the_light_each_pass_by_chances_of_their_own() {
    let mut scene = screen(1.0, black(Alpha::Blend, Vec4::new(0.0, 0.0, 0.0, 0.5)));
    let ground = SceneBuilder::default()
        .quad("ground", Vec3::ZERO, [100.0 * Vec3::Z, 100.0 * Vec3::X], common::scenes::grey(1.0))
        .build();
    scene.instances.push(bevy_kiln::scene::Instance { mesh: 1, material: 1, ..ground.instances[0].clone() });
    scene.instances[1].world_from_local.translation = Vec3::new(-50.0, 0.0, -50.0).into();
    scene.meshes.extend(ground.meshes);
    scene.materials.extend(ground.materials);
    scene.sky_radiance = Vec3::ONE;
    let camera = Camera::look_at("camera", Vec3::new(0.0, 2.0, 0.0), Vec3::new(0.1, 0.0, 0.1), 0.01);
    let settings = PictureSettings {
        transport: Transport::default(),
        width: 1,
        height: 1,
        samples_per_pixel: 1 << 14,
        threads: None,
    };
    let picture = render_picture(&scene, &camera, &settings, &(), &CancelToken::default()).unwrap();
    // Light that comes in beyond the rim is less than 0.1 %.
    mean_within(f64::from(picture.radiance[0].x), f64::from(picture.stderr[0].x), 0.25, 0.01).unwrap();
}

/// Sparks that are added to the picture light the room as much as they show: by alpha, and without a shadow.
#[test]
fn what_is_added_to_the_picture_glows() {
    let lamp = |alpha: Alpha, opacity: f32| {
        let mut material = Material { alpha, ..glowing(0.0, 2.0) };
        material.base_colour.w = opacity;
        SceneBuilder::default().quad("lamp", Vec3::new(-0.5, 2.0, -0.5), [Vec3::X, Vec3::Z], material).build()
    };
    let point = Vec3::new(0.2, 0.0, 0.1);
    let corners =
        [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| (Vec3::new(x, 2.0, z) - point).as_dvec3());
    let whole = 2.0 * polygon_irradiance(&corners, DVec3::Y).abs();
    for (alpha, share) in [(Alpha::Add, 0.25), (Alpha::Blend, 0.25), (Alpha::Multiply, 0.0)] {
        for estimator in ESTIMATORS {
            let reading = read(&lamp(alpha, 0.25), &[at(point, Vec3::Y)], 1 << 16, by(estimator))[0];
            mean_within(reading.irradiance.x, reading.stderr.x, share * whole, 0.02 * whole)
                .unwrap_or_else(|reason| panic!("{alpha:?}, {estimator:?}: {reason}"));
        }
    }
}

/// A bulb so large that a clear pane cuts through it is one bulb, on whichever side of the pane it is met.
#[test]
fn a_pane_inside_a_bulb() {
    let mut scene = screen(1.0, black(Alpha::Add, Vec4::ONE));
    scene.lights.push(Light::Point(PointLight {
        id: StableId::new("bulb"),
        name: "bulb".into(),
        position: Vec3::new(0.0, 1.2, 0.0),
        intensity: Vec3::splat(PI as f32 * 0.25),
        radius: 0.5,
        range: None,
    }));
    // A sphere of radiance 1, all of it above the horizon.
    let truth = PI * (0.5_f64 / 1.2).powi(2);
    for estimator in ESTIMATORS {
        let reading = read(&scene, &[at(Vec3::ZERO, Vec3::Y)], 1 << 14, by(estimator))[0];
        mean_within(reading.irradiance.x, reading.stderr.x, truth, 0.02 * truth)
            .unwrap_or_else(|reason| panic!("{estimator:?}: {reason}"));
    }
}

/// A smooth pane loses nothing, and makes nothing, where its shading normals are not those of its triangles: what
/// crosses is what is not reflected, by the same normal.
#[test]
fn a_pane_with_smooth_normals_in_a_furnace() {
    let standard = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, ..Standard::default() };
    let mut scene = common::scenes::furnace(0.0);
    let pane = SceneBuilder::default()
        .quad(
            "pane",
            Vec3::new(-0.9, 0.0, -0.9),
            [1.8 * Vec3::Z, 1.8 * Vec3::X],
            Material::scattering("pane", Vec3::ONE, Scattering::Standard(Box::new(standard))),
        )
        .build();
    scene.instances.push(bevy_kiln::scene::Instance { mesh: 6, material: 6, ..pane.instances[0].clone() });
    scene.meshes.extend(pane.meshes);
    scene.materials.extend(pane.materials);
    scene.meshes[6].normals = Some(vec![Vec3::new(0.7, 1.0, 0.0).normalize(); 4]);
    let camera = Camera::look_at("camera", Vec3::new(0.6, 0.5, 0.0), Vec3::new(0.0, 0.0, 0.1), 0.01);
    let settings = PictureSettings {
        transport: Transport::default(),
        width: 1,
        height: 1,
        samples_per_pixel: 1 << 10,
        threads: None,
    };
    let picture = render_picture(&scene, &camera, &settings, &(), &CancelToken::default()).unwrap();
    mean_within(f64::from(picture.radiance[0].x), f64::from(picture.stderr[0].x), 1.0, 1e-3).unwrap();
}

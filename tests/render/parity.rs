//! Lights as Bevy shows them in real time against the same lights baked, and both against closed forms: on a convex
//! hill where nothing is in the way, without specular reflection, direct light only. One app for all kinds.
//!
//! Bevy's diffuse reflection of point, spot and directional lights is Burley's, while lightmaps, skies and rectangular
//! lights are Lambert's; they differ by a factor of roughness and angles (Burley 2012, as in pbr_lighting.wgsl), which
//! is computed here for each pixel. Nothing else is corrected.

mod light;
mod stage;
mod verdict;

use crate::renderer::{EXPOSURE, Screen, app, bake, show};
use bevy::light::GlobalAmbientLight;
use bevy::prelude::*;
use bevy_kiln::math::polygon_irradiance;
use bevy_kiln::prelude::*;
use glam::DVec3;
use light::Kind;
use stage::Shown;
use std::f64::consts::PI;
use verdict::compare;

/// A bake of direct light.
fn direct() -> BakeLightmaps {
    BakeLightmaps {
        scene: SceneSettings { emissive: EmissiveUnit::AsDisplayed { ev100: 0.0 }, ..default() },
        samples_per_texel: 1024,
        density: 12.0,
        max_bounces: Some(0),
        format: LightmapFormat::Rgba16f,
        ..default()
    }
}

#[test]
fn each_light_is_baked_as_it_is_shown() {
    let Some(mut app) = app() else { return };
    let camera = stage::spawn(app.world_mut());
    let stage = stage::shown();
    for kind in Kind::ALL {
        stage::set_roughness(app.world_mut(), kind.perceptual_roughness());
        kind.spawn(app.world_mut(), camera);
        show(&mut app);
        let shown = picture(&app, &stage);
        let done = bake(&mut app, direct());
        assert_eq!(done.warnings, [""; 0], "{kind:?}");
        let baked = picture(&app, &stage);
        app.world_mut().trigger(ClearLightmaps);
        kind.remove(app.world_mut(), camera);
        show(&mut app);
        assert!(picture(&app, &stage).iter().all(|&pixel| pixel == DVec3::ZERO), "{kind:?} is still there");

        let seen: Vec<Shown> = stage.iter().flatten().copied().collect();
        let albedo = stage::pieces().map(|piece| piece.albedo);
        let truth = seen.iter().map(|at| kind.irradiance(at.point, at.normal) / PI * albedo[at.piece] * EXPOSURE);
        let truth: Vec<DVec3> = truth.collect();
        let factor: Vec<f64> = seen.iter().map(|at| burley_over_lambert(kind, at)).collect();
        let lambert: Vec<DVec3> = shown.iter().zip(&factor).map(|(pixel, factor)| *pixel / *factor).collect();
        for (what, a, b) in [
            ("shown in real time against the closed form", &lambert, &truth),
            ("baked against the closed form", &baked, &truth),
            ("shown in real time against baked", &lambert, &baked),
        ] {
            let difference = compare(a, b);
            println!("{kind:?}: {what}: {difference:?}");
            difference.verdict().unwrap_or_else(|fault| panic!("{kind:?}, {what}: {fault}"));
        }
        reject_planted_faults(kind, &shown, &lambert, &baked, &factor);
    }
}

/// The checker on the very pictures that it has accepted.
fn reject_planted_faults(kind: Kind, shown: &[DVec3], lambert: &[DVec3], baked: &[DVec3], factor: &[f64]) {
    let brighter: Vec<DVec3> = baked.iter().map(|pixel| *pixel * 1.02).collect();
    assert!(compare(&brighter, lambert).verdict().is_err(), "{kind:?}");
    let mut backwards = baked.to_vec();
    backwards.reverse();
    assert!(compare(&backwards, lambert).verdict().is_err(), "{kind:?}");
    // Burley's factor is no matter of taste: without it the pictures are not the same.
    let matters = factor.iter().any(|factor| (factor - 1.0).abs() > 0.04);
    assert!(!matters || compare(shown, baked).verdict().is_err(), "{kind:?}");
}

/// What Burley's diffuse reflection gives over Lambert's.
fn burley_over_lambert(kind: Kind, at: &Shown) -> f64 {
    let Some(to_light) = kind.to_light(at.point) else { return 1.0 };
    let roughness = f64::from(kind.perceptual_roughness()).powi(2);
    let half = (to_light + at.to_eye).normalize();
    let grazing = 0.5 + 2.0 * roughness * to_light.dot(half).powi(2);
    let scatter = |cosine: f64| 1.0 + (grazing - 1.0) * (1.0 - cosine.clamp(0.0, 1.0)).powi(5);
    scatter(at.normal.dot(to_light)) * scatter(at.normal.dot(at.to_eye))
}

/// The pixels that show the hill, in order.
fn picture(app: &App, stage: &[Option<Shown>]) -> Vec<DVec3> {
    let screen = &app.world().resource::<Screen>().0;
    assert_eq!(screen.len(), stage.len(), "nothing was read back");
    screen.iter().zip(stage).filter(|(_, at)| at.is_some()).map(|(pixel, _)| pixel.as_dvec3()).collect()
}

/// Bevy shows ambient light through an approximation that takes away more than half of it, so that there is only the
/// closed form to hold it against: E = π L where nothing is in the way.
#[test]
fn ambient_light_and_what_glows_are_baked_by_their_closed_forms() {
    let Some(mut app) = app() else { return };
    stage::spawn(app.world_mut());
    let stage = stage::shown();
    let ambient = GlobalAmbientLight { color: Color::linear_rgb(1.0, 0.5, 0.25), brightness: 2.0, ..default() };
    app.insert_resource(ambient);
    let scene = SceneSettings { ambient: AmbientMode::Bake, ..direct().scene };
    bake(&mut app, BakeLightmaps { scene, ..direct() });
    let albedo = stage::pieces().map(|piece| piece.albedo);
    let expected = stage.iter().flatten().map(|at| DVec3::new(2.0, 1.0, 0.5) * albedo[at.piece] * EXPOSURE);
    let difference = compare(&picture(&app, &stage), &expected.collect::<Vec<_>>());
    println!("ambient: {difference:?}");
    difference.verdict().unwrap();
    app.world_mut().trigger(ClearLightmaps);
    app.insert_resource(GlobalAmbientLight::NONE);

    spawn_glowing(app.world_mut());
    show(&mut app);
    // The radiance that the screen shows is what lights the room, whatever the unit of `emissive` may be.
    let on_screen = app.world().resource::<Screen>().0[pixel_of(GLOWING)].as_dvec3() / EXPOSURE;
    assert!((on_screen / (1.2 * GLOW.as_dvec3()) - 1.0).abs().max_element() < 2e-3, "{on_screen}");
    bake(&mut app, direct());
    let screen = app.world().resource::<Screen>().0.clone();
    let free = stage.iter().zip(&screen).filter_map(|(at, pixel)| Some((at.as_ref()?, pixel)));
    let free = free.filter(|(at, _)| !is_hidden(at));
    let (mut seen, mut truth) = (Vec::new(), Vec::new());
    for (at, pixel) in free {
        let corners = glowing_corners().map(|corner| corner - at.point);
        seen.push(pixel.as_dvec3());
        truth.push(on_screen * polygon_irradiance(&corners, at.normal) / PI * albedo[at.piece] * EXPOSURE);
    }
    let difference = compare(&seen, &truth);
    println!("emissive: {difference:?}");
    difference.verdict().unwrap();
    let brighter: Vec<DVec3> = seen.iter().map(|pixel| *pixel * 1.02).collect();
    assert!(compare(&brighter, &truth).verdict().is_err());
}

const GLOWING: DVec3 = DVec3::new(0.0, 1.2, -0.6);
const GLOWING_HALF: f64 = 0.3;
const GLOW: Vec3 = Vec3::new(20.0, 15.0, 10.0);

fn glowing_corners() -> [DVec3; 4] {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| GLOWING + DVec3::new(x, 0.0, z) * GLOWING_HALF)
}

/// A level square that glows on both sides and reflects nothing.
fn spawn_glowing(world: &mut World) {
    let material = StandardMaterial {
        base_color: Color::BLACK,
        reflectance: 0.0,
        emissive: LinearRgba::rgb(GLOW.x, GLOW.y, GLOW.z),
        double_sided: true,
        cull_mode: None,
        ..default()
    };
    let side = 2.0 * GLOWING_HALF as f32;
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(side, side));
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
    let place = Transform::from_translation(GLOWING.as_vec3());
    world.spawn((Name::new("glowing"), LightBlocker, Mesh3d(mesh), MeshMaterial3d(material), place));
}

/// Whether the glowing square is before a place, or nearly so.
fn is_hidden(at: &Shown) -> bool {
    let share = (GLOWING.y - at.point.y) / (stage::eye().y - at.point.y);
    let crossing = at.point.lerp(stage::eye(), share);
    (0.0..1.0).contains(&share) && (crossing - GLOWING).abs().max_element() < 1.3 * GLOWING_HALF
}

/// The pixel that shows a point.
fn pixel_of(point: DVec3) -> usize {
    let towards = (point - stage::eye()).normalize();
    let pixels = (0..stage::HEIGHT * stage::WIDTH).map(|pixel| {
        let place = glam::DVec2::new((pixel % stage::WIDTH) as f64, (pixel / stage::WIDTH) as f64) + 0.5;
        (stage::ray(place).dot(towards), pixel)
    });
    pixels.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, pixel)| pixel)
}

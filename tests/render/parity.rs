//! Lights as Bevy shows them in real time against the same lights baked, and both against closed forms: on a convex
//! hill where nothing is in the way, without specular reflection, direct light only. One app for all kinds.
//!
//! Bevy's diffuse reflection of point, spot and directional lights is Burley's, while lightmaps, skies and rectangular
//! lights are Lambert's; they differ by a factor of roughness and angles (Burley 2012, as in pbr_lighting.wgsl), which
//! is computed here for each pixel. Nothing else is corrected.

mod glow;
mod light;
mod stage;
mod verdict;

use crate::renderer::{EXPOSURE, Screen, app, bake, show};
use bevy::prelude::*;
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
        goal: BakeGoal::Samples(1024),
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
        assert_eq!(done.warnings, [], "{kind:?}");
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

//! The scene that the arguments ask for, through the plugin's one way in.

use crate::args::{EstimatorArg, GoalArgs, LayoutArg, LayoutArgs, SceneArgs};
use crate::failure::Failure;
use bevy_kiln::bake::{BakeSettings, CancelToken, Layout};
use bevy_kiln::plugin::windowless::{load_environment, open_scene, unread_parts};
use bevy_kiln::plugin::{AmbientMode, Extraction, RangeWindow, SceneSettings, extract_scene};
use bevy_kiln::trace::{Estimator, ForcedEffects, Sharing, Transport};
use glam::Vec3;

/// Loads and reads the scene.
pub(crate) fn open(args: &SceneArgs, cancel: &CancelToken) -> Result<Extraction, Failure> {
    let mut app = open_scene(&args.scene).map_err(Failure::failed)?;
    let environment = args.environment.as_deref().map(|file| load_environment(&mut app, file));
    let environment = environment.transpose().map_err(Failure::failed)?;
    if cancel.is_cancelled() {
        return Err(Failure::Stopped);
    }
    let settings = SceneSettings {
        emissive: args.emissive,
        ambient: AmbientMode::Ignore,
        range: if args.no_range { RangeWindow::Ignore } else { RangeWindow::AsDisplayed },
        sky_radiance: args.sky.unwrap_or(Vec3::ZERO),
        environment,
        layers: args.layers.clone(),
    };
    let mut extraction = extract_scene(app.world_mut(), &settings);
    extraction.warnings.extend(unread_parts(&app));
    Ok(extraction)
}

/// The same for what makes no lightmaps, so that nothing is said about those that cannot be made.
pub(crate) fn open_without_lightmaps(args: &SceneArgs, cancel: &CancelToken) -> Result<Extraction, Failure> {
    let mut extraction = open(args, cancel)?;
    for instance in &mut extraction.scene.instances {
        instance.lightmap = None;
    }
    Ok(extraction)
}

pub(crate) fn transport(args: &SceneArgs) -> Transport {
    let estimator = match args.estimator {
        EstimatorArg::Mis => Estimator::Mis,
        EstimatorArg::Light => Estimator::Light,
        EstimatorArg::Bsdf => Estimator::Bsdf,
    };
    let effects =
        ForcedEffects { on: args.with.iter().copied().collect(), off: args.without.iter().copied().collect() };
    let (max_bounces, sharing) = (args.max_bounces.0, Sharing::default());
    Transport { estimator, max_bounces, sharing, seed: args.seed, clamp: args.clamp, effects }
}

pub(crate) fn bake_settings(scene: &SceneArgs, layout: &LayoutArgs, goal: &GoalArgs) -> Result<BakeSettings, Failure> {
    let layout_kind = match (layout.layout, layout.size) {
        (LayoutArg::Packed, None) => Layout::Packed,
        (LayoutArg::Packed, Some(_)) => {
            return Err(Failure::Arguments("--size is for --layout shared; ask for --density instead".to_owned()));
        }
        (LayoutArg::Shared, size) => Layout::Shared { size: size.unwrap_or(0) },
    };
    let settings = BakeSettings {
        transport: transport(scene),
        goal: goal.goal(),
        later_bounces: goal.later_bounces(),
        density: layout.density,
        layout: layout_kind,
        max_page_size: layout.page_size,
        threads: scene.threads,
        ..BakeSettings::default()
    };
    settings.validate()?;
    Ok(settings)
}

//! The keys, and what the kiln says.

use super::args::Args;
use bevy::prelude::*;
use bevy_kiln::bake::Stage;
use bevy_kiln::prelude::*;

/// Where things stand.
#[derive(Resource, Clone, Debug, Default)]
pub enum Status {
    #[default]
    Loading,
    /// The room is there and as it was loaded.
    Dark,
    Baking(Option<BakeProgress>),
    Lit(BakeFinished),
    /// A folder is shown: so many of its things have been found in the scene.
    Worn {
        found: usize,
        of: usize,
        lightmaps: usize,
    },
    Cancelled,
    /// What went wrong, as a sentence.
    Failed(String),
}

pub fn plugin(app: &mut App) {
    app.init_resource::<Status>()
        .add_systems(Update, keys)
        .add_observer(|at: On<BakeProgress>, mut status: ResMut<Status>| *status = Status::Baking(Some(*at.event())))
        .add_observer(finished)
        .add_observer(failed);
}

fn keys(
    keys: Res<ButtonInput<KeyCode>>,
    args: Res<Args>,
    mut status: ResMut<Status>,
    mut filtering: ResMut<LightmapFiltering>,
    mut commands: Commands,
) {
    if keys.just_pressed(KeyCode::KeyF) {
        *filtering = match *filtering {
            LightmapFiltering::Bilinear => LightmapFiltering::Bicubic,
            LightmapFiltering::Bicubic => LightmapFiltering::Bilinear,
        };
    }
    let is_baking = matches!(*status, Status::Baking(_));
    let is_loaded = !matches!(*status, Status::Loading);
    if keys.just_pressed(KeyCode::KeyB) && is_loaded && !is_baking {
        start(&args, &mut status, &mut commands);
    }
    if keys.just_pressed(KeyCode::Escape) {
        commands.trigger(CancelBake);
    }
    if keys.just_pressed(KeyCode::KeyC) && is_loaded && !is_baking {
        commands.trigger(ClearLightmaps);
        *status = Status::Dark;
    }
}

/// Asks for a bake; the game runs on.
pub fn start(args: &Args, status: &mut Status, commands: &mut Commands) {
    // What glows lights the room as bright as it is seen.
    let emissive = EmissiveUnit::AsDisplayed { ev100: args.ev100 };
    commands.trigger(BakeLightmaps {
        scene: SceneSettings { sky_radiance: args.stage.sky.into(), emissive, ..default() },
        goal: BakeGoal::Samples(args.spp),
        density: args.density,
        volumes: args.stage.volumes,
        ..default()
    });
    *status = Status::Baking(None);
}

/// The lightmaps are on the screen; `--save` keeps them as a folder, too.
fn finished(done: On<BakeFinished>, args: Res<Args>, mut status: ResMut<Status>) {
    let written = args.save.as_ref().map_or(Ok(()), |folder| done.save(folder));
    *status = match written {
        Ok(()) => Status::Lit(done.event().clone()),
        Err(error) => Status::Failed(error.to_string()),
    };
}

fn failed(failed: On<BakeFailed>, mut status: ResMut<Status>) {
    *status = if failed.cancelled { Status::Cancelled } else { Status::Failed(failed.reason.clone()) };
}

impl std::fmt::Display for Status {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Loading => write!(f, "loading"),
            Self::Dark => write!(f, "not baked: only what glows is seen"),
            Self::Baking(None) => write!(f, "baking"),
            Self::Baking(Some(at)) => {
                let stage = match at.stage {
                    Stage::Prepare => "preparing",
                    Stage::Gather => "baking",
                    Stage::Repair => "filling in",
                    Stage::Probes => "probing the air",
                };
                write!(f, "{stage}: {:.0} %", 100.0 * at.fraction())?;
                at.relative_stderr.map_or(Ok(()), |error| write!(f, ", error {:.1} %", 100.0 * error))
            }
            Self::Lit(done) => {
                write!(f, "baked: {} texels, {} paths, {:.1} s", done.texels, done.samples, done.seconds)?;
                done.warnings.iter().try_for_each(|warning| write!(f, "\n{warning}"))
            }
            Self::Worn { found, of, .. } => write!(f, "baked before: {found} of its {of} objects and lights are here"),
            Self::Cancelled => write!(f, "stopped"),
            Self::Failed(sentence) => write!(f, "{sentence}"),
        }
    }
}

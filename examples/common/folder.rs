//! A bake of before on the scene, as a shipped game shows it.

use super::args::Args;
use super::bake::Status;
use bevy::asset::LoadState;
use bevy::prelude::*;
use bevy::world_serialization::WorldAssetRoot;
use bevy_kiln::plugin::AppliedLightmaps;
use bevy_kiln::prelude::*;

pub fn plugin(app: &mut App) {
    app.add_systems(Update, (put_on, report).chain().run_if(|args: Res<Args>| args.folder.is_some()));
}

fn put_on(
    roots: Query<Entity, (Added<WorldAssetRoot>, With<LightmapReceiver>)>,
    args: Res<Args>,
    assets: Res<AssetServer>,
    mut status: ResMut<Status>,
    mut commands: Commands,
) {
    let Some(folder) = &args.folder else { return };
    for root in roots {
        match std::path::absolute(folder) {
            Ok(folder) => _ = commands.entity(root).insert(BakedLightmaps(assets.load(folder.join("kiln.ron")))),
            Err(error) => *status = Status::Failed(format!("{} cannot be opened ({error})", folder.display())),
        }
    }
}

/// Says how much of it has been found in the scene.
fn report(
    roots: Query<(&BakedLightmaps, &AppliedLightmaps)>,
    folders: Res<Assets<BakedFolder>>,
    args: Res<Args>,
    assets: Res<AssetServer>,
    mut status: ResMut<Status>,
) {
    for (baked, applied) in roots {
        if let (Some(LoadState::Failed(error)), Some(folder)) = (assets.get_load_state(&baked.0), &args.folder) {
            let sentence = Status::Failed(format!("{} cannot be shown: {error}", folder.display()));
            if !matches!(*status, Status::Failed(_)) {
                *status = sentence;
            }
        }
        let Some(manifest) = folders.get(&baked.0).map(|folder| &folder.manifest) else { continue };
        let of = manifest.placements.len() + manifest.baked_lights.len();
        let is_news = match &*status {
            Status::Dark => true,
            Status::Worn { found, .. } => *found != applied.len(),
            _ => false,
        };
        if is_news {
            *status = Status::Worn { found: applied.len(), of, lightmaps: manifest.placements.len() };
        }
    }
}

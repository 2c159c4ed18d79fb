//! Puts a loaded bake on its entities, as they come.

use super::attach::{attach, detach};
use super::find::{Found, Job, find};
use super::mute::{MutedLight, mute_light, unmute_light};
use super::out_of_date::sentence;
use super::volume::{ShownVolume, despawn_volumes, spawn_volume};
use super::{BakedFolder, stable_id};
use crate::artefact::StableId;
use bevy::prelude::*;
use std::collections::HashSet;

/// Lights what is below this entity with a baked folder. Put it beside the scene's root component; it finds the
/// objects by their [`StableId`] as they spawn, and mutes the lights that the textures hold. What the game itself adds
/// outside of scene files, such as a sun, is found by its `Name`; without one, if it is like what was baked, and there, when it comes.
/// Nothing changes before all textures have come, so that no light goes off too early. A folder that is read anew while
/// the game runs is shown anew; another one takes the place of the one before once it is there.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Default, Debug, Clone)]
#[require(Transform, Visibility, AppliedLightmaps)]
pub struct BakedLightmaps(pub Handle<BakedFolder>);

/// What of a folder has been put on which entities.
#[derive(Component, Clone, Debug, Default)]
pub struct AppliedLightmaps {
    folder: Option<AssetId<BakedFolder>>,
    /// Whether there was nothing left to find when it was last looked for.
    is_at_rest: bool,
    pub(super) done: HashSet<Entity>,
    /// What shows another folder, or this one as it was before it was read again, until this one is there.
    before: HashSet<Entity>,
    /// What was put into the world: irradiance volumes.
    volumes: Vec<Entity>,
    /// What was compared with how it was at the bake.
    pub(super) compared: HashSet<Entity>,
    changed: Vec<StableId>,
}

impl AppliedLightmaps {
    /// How many entities (meshes and lights) of the folder have been found and set up.
    pub fn len(&self) -> usize {
        self.done.len()
    }

    /// Whether none has.
    pub fn is_empty(&self) -> bool {
        self.done.is_empty()
    }

    /// What is not as it was when it was baked: elsewhere, of another material, or shining otherwise. Things that are
    /// new or gone, and what is in pictures and meshes, are not compared.
    pub fn changed_since_bake(&self) -> &[StableId] {
        &self.changed
    }

    /// Whether it is of this folder.
    pub(super) fn is_of(&self, folder: AssetId<BakedFolder>) -> bool {
        self.folder == Some(folder)
    }

    /// Has what is not found yet looked for again.
    pub(super) fn look_again(&mut self) {
        self.is_at_rest = false;
    }

    /// Has everything put on anew, in place of what is there until then.
    pub(super) fn put_on_again(&mut self) {
        self.before.extend(self.done.drain());
        self.folder = None;
        self.is_at_rest = false;
        self.compared.clear();
        self.changed.clear();
    }
}

/// Applies loaded folders to what has come since the last frame, below their roots and outside of files.
pub(crate) fn apply_baked_lightmaps(world: &mut World) {
    let mut roots = world.query::<(Entity, &BakedLightmaps, &AppliedLightmaps)>();
    let roots: Vec<(Entity, Handle<BakedFolder>, AppliedLightmaps)> = roots
        .iter(world)
        .filter(|(_, baked, applied)| !(applied.is_at_rest && applied.is_of(baked.0.id())))
        .map(|(entity, baked, applied)| (entity, baked.0.clone(), applied.clone()))
        .collect();
    for (root, folder, mut applied) in roots {
        if applied.folder.is_some_and(|before| before != folder.id()) {
            applied.put_on_again();
        }
        let is_new = applied.folder.is_none();
        if is_new && !is_there(world, &folder) {
            continue;
        }
        let Found { jobs, compared, changed } = find(world, root, &folder, &applied);
        if jobs.is_empty() && compared.is_empty() && !is_new {
            if let Some(mut applied) = world.get_mut::<AppliedLightmaps>(root) {
                applied.is_at_rest = true;
            }
            continue;
        }
        if is_new {
            despawn_volumes(world, &mut applied.volumes);
            let volumes = volumes_of(world, &folder);
            applied.volumes.extend(volumes.into_iter().map(|volume| spawn_volume(world, volume)));
            applied.folder = Some(folder.id());
        }
        if applied.changed.is_empty() && !changed.is_empty() {
            warn!("{}", sentence(&changed));
        }
        applied.changed.extend(changed.into_iter().map(|(id, _)| id));
        applied.compared.extend(compared);
        for (entity, job) in jobs {
            match job {
                Job::Attach(shown) => {
                    if let Err(why) = attach(world, entity, shown) {
                        warn!("\"{}\" {why}, so it does not show its lightmap", stable_id(world, entity));
                    }
                }
                Job::Mute => mute_light(&mut world.entity_mut(entity)),
            }
            applied.before.remove(&entity);
            applied.done.insert(entity);
        }
        for entity in std::mem::take(&mut applied.before) {
            take_off(world, entity);
        }
        applied.done.retain(|&entity| world.get_entity(entity).is_ok());
        applied.compared.retain(|&entity| world.get_entity(entity).is_ok());
        if let Ok(mut entity) = world.get_entity_mut(root) {
            entity.insert(applied);
        }
    }
}

/// Takes off what an entity's folder had put on, when the component goes.
pub(crate) fn take_off_with_component(removed: On<Remove, BakedLightmaps>, mut commands: Commands) {
    let root = removed.entity;
    commands.queue(move |world: &mut World| {
        let Ok(mut entity) = world.get_entity_mut(root) else { return };
        if let Some(mut applied) = entity.take::<AppliedLightmaps>() {
            undo(world, &mut applied);
        }
    });
}

fn undo(world: &mut World, applied: &mut AppliedLightmaps) {
    for entity in applied.done.drain().chain(applied.before.drain()) {
        take_off(world, entity);
    }
    despawn_volumes(world, &mut applied.volumes);
    applied.folder = None;
}

/// Gives an entity back as it was.
fn take_off(world: &mut World, entity: Entity) {
    let Ok(mut found) = world.get_entity_mut(entity) else { return };
    if found.contains::<MutedLight>() {
        unmute_light(&mut found);
    } else {
        detach(world, entity);
    }
}

/// Whether a folder has come with all its textures, but for those that cannot be read. Before, its lights would be
/// muted and nothing shine in their place.
fn is_there(world: &World, folder: &Handle<BakedFolder>) -> bool {
    let folder = world.get_resource::<Assets<BakedFolder>>().and_then(|folders| folders.get(folder));
    let is_coming = |texture: &Handle<Image>| {
        let server = world.get_resource::<AssetServer>();
        server.and_then(|server| server.get_load_state(texture)).is_some_and(|state| state.is_loading())
    };
    folder.is_some_and(|folder| !folder.pages.iter().chain(&folder.volumes).any(is_coming))
}

/// The irradiance volumes of a folder, once it is loaded.
fn volumes_of(world: &World, folder: &Handle<BakedFolder>) -> Vec<ShownVolume> {
    let folder = world.get_resource::<Assets<BakedFolder>>().and_then(|folders| folders.get(folder));
    let entries = folder.into_iter().flat_map(|folder| folder.manifest.volumes.iter().zip(&folder.volumes));
    let shown = entries.map(|(volume, voxels)| ShownVolume {
        name: volume.id.as_str().to_owned(),
        voxels: voxels.clone(),
        centre: volume.centre.into(),
        rotation: Quat::from_array(volume.rotation),
        size: volume.size.into(),
        falloff: volume.falloff,
    });
    shown.collect()
}

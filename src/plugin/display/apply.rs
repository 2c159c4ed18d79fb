//! Puts a loaded bake on the entities below a scene's root, as they come.

use super::attach::{Shown, attach, detach};
use super::filtering::FilteredBy;
use super::mute::{MutedLight, mute_light, unmute_light};
use super::volume::{ShownVolume, despawn_volumes, spawn_volume};
use super::{BakedFolder, stable_id};
use crate::artefact::StableId;
use bevy::light::RectLight;
use bevy::pbr::Lightmap;
use bevy::prelude::*;
use std::collections::{HashMap, HashSet};

/// Lights what is below this entity with a baked folder. Put it beside the scene's root component; it finds the
/// objects by their [`StableId`] as they spawn, and mutes the lights that the textures hold.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Default, Debug, Clone)]
#[require(Transform, Visibility, AppliedLightmaps)]
pub struct BakedLightmaps(pub Handle<BakedFolder>);

/// What of a folder has been put on which entities.
#[derive(Component, Clone, Debug, Default)]
pub struct AppliedLightmaps {
    folder: Option<AssetId<BakedFolder>>,
    done: HashSet<Entity>,
    /// What was put into the world: irradiance volumes.
    volumes: Vec<Entity>,
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
}

/// One thing that a folder says about an entity.
enum Job {
    Attach(Shown),
    Mute,
}

/// Applies loaded folders to what has come below their roots since the last frame.
pub(crate) fn apply_baked_lightmaps(world: &mut World) {
    let mut roots = world.query::<(Entity, &BakedLightmaps, &AppliedLightmaps)>();
    let roots: Vec<(Entity, Handle<BakedFolder>, AppliedLightmaps)> =
        roots.iter(world).map(|(entity, baked, applied)| (entity, baked.0.clone(), applied.clone())).collect();
    for (root, folder, mut applied) in roots {
        if applied.folder.is_some_and(|before| before != folder.id()) {
            undo(world, &mut applied);
        }
        let jobs = find_jobs(world, root, &folder, &applied);
        let volumes = if applied.folder.is_none() { volumes_of(world, &folder) } else { Vec::new() };
        if jobs.is_empty() && volumes.is_empty() && applied.folder.is_none() {
            continue;
        }
        applied.folder = Some(folder.id());
        applied.volumes.extend(volumes.into_iter().map(|volume| spawn_volume(world, volume)));
        for (entity, job) in jobs {
            match job {
                Job::Attach(shown) => {
                    if let Err(why) = attach(world, entity, shown) {
                        warn!("\"{}\" {why}, so it does not show its lightmap", stable_id(world, entity));
                    }
                }
                Job::Mute => mute_light(&mut world.entity_mut(entity)),
            }
            applied.done.insert(entity);
        }
        applied.done.retain(|&entity| world.get_entity(entity).is_ok());
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
    for entity in applied.done.drain() {
        let Ok(mut found) = world.get_entity_mut(entity) else { continue };
        if found.contains::<MutedLight>() {
            unmute_light(&mut found);
        } else {
            detach(world, entity);
        }
    }
    despawn_volumes(world, &mut applied.volumes);
    applied.folder = None;
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

fn find_jobs(
    world: &World,
    root: Entity,
    folder: &Handle<BakedFolder>,
    applied: &AppliedLightmaps,
) -> Vec<(Entity, Job)> {
    let Some(folder) = world.get_resource::<Assets<BakedFolder>>().and_then(|folders| folders.get(folder)) else {
        return Vec::new();
    };
    if applied.done.len() >= folder.manifest.placements.len() + folder.manifest.baked_lights.len() {
        return Vec::new();
    }
    let placements: HashMap<&StableId, Shown> = folder
        .manifest
        .placements
        .iter()
        .map(|placement| {
            let lightmap = Lightmap {
                image: folder.pages[placement.page as usize].clone(),
                uv_rect: Rect { min: placement.uv_min.into(), max: placement.uv_max.into() },
                ..default()
            };
            let layout = placement.mesh.and_then(|mesh| folder.meshes.get(mesh as usize)).cloned();
            (&placement.id, Shown { lightmap, layout, filtered_by: FilteredBy::Plugin })
        })
        .collect();
    let lights: HashSet<&StableId> = folder.manifest.baked_lights.iter().map(|light| &light.id).collect();
    let mut jobs = Vec::new();
    let mut below = vec![root];
    while let Some(entity) = below.pop() {
        below.extend(world.get::<Children>(entity).into_iter().flatten());
        if applied.done.contains(&entity) {
            continue;
        }
        if let Some(mesh) = world.get::<Mesh3d>(entity) {
            let is_loaded = world.get_resource::<Assets<Mesh>>().is_some_and(|meshes| meshes.contains(&mesh.0));
            if let Some(shown) = placements.get(&stable_id(world, entity)).filter(|_| is_loaded) {
                jobs.push((entity, Job::Attach(shown.clone())));
            }
        }
        if is_light(world, entity) && lights.contains(&stable_id(world, entity)) {
            jobs.push((entity, Job::Mute));
        }
    }
    jobs
}

fn is_light(world: &World, entity: Entity) -> bool {
    let Ok(entity) = world.get_entity(entity) else { return false };
    entity.contains::<RectLight>()
        || entity.contains::<PointLight>()
        || entity.contains::<SpotLight>()
        || entity.contains::<DirectionalLight>()
}

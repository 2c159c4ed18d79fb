//! Which entities a baked folder is about: those below its root, and those that a game has made outside of all scene
//! files, such as a sun. Finds only; what is done about it is [`apply`](super::apply)'s.

use super::attach::Shown;
use super::filtering::FilteredBy;
use super::fingerprint::fingerprint;
use super::stable_path::{StableIds, is_named};
use super::{AppliedLightmaps, BakedFolder, BakedLightmaps, LightBaking};
use crate::artefact::{Change, Manifest, StableId};
use bevy::light::RectLight;
use bevy::pbr::Lightmap;
use bevy::prelude::*;
use bevy::world_serialization::{DynamicWorldRoot, WorldAssetRoot};
use std::collections::{HashMap, HashSet};

/// One thing that a folder says about an entity.
pub(super) enum Job {
    Attach(Shown),
    Mute,
}

/// What there is to do about a folder, and what was found on the way.
#[derive(Default)]
pub(super) struct Found {
    pub(super) jobs: Vec<(Entity, Job)>,
    pub(super) compared: Vec<Entity>,
    pub(super) changed: Vec<(StableId, Change)>,
}

/// Finds what a folder says of the entities below `root` and of those outside of files. Looks at nothing once all has
/// been found.
pub(super) fn find(world: &mut World, root: Entity, folder: &Handle<BakedFolder>, applied: &AppliedLightmaps) -> Found {
    let is_all_found = |folder: &BakedFolder| {
        applied.done.len() >= folder.manifest.placements.len() + folder.manifest.baked_lights.len()
    };
    let assets = world.get_resource::<Assets<BakedFolder>>();
    if assets.and_then(|folders| folders.get(folder)).is_none_or(is_all_found) {
        return Found::default();
    }
    let outside = outside_of_files(world);
    let Some(folder) = world.get_resource::<Assets<BakedFolder>>().and_then(|folders| folders.get(folder)) else {
        return Found::default();
    };
    let below = below(world, root).into_iter().map(|entity| (entity, false));
    look_at(world, below.chain(outside.into_iter().map(|entity| (entity, true))), folder, applied)
}

/// Goes through entities, each with whether it stands outside of files.
fn look_at(
    world: &World,
    entities: impl Iterator<Item = (Entity, bool)>,
    folder: &BakedFolder,
    applied: &AppliedLightmaps,
) -> Found {
    let mut found = Found::default();
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
    let ids = StableIds::new(world);
    for (entity, is_outside) in entities {
        let (mesh, is_light) = (world.get::<Mesh3d>(entity), is_light(world, entity));
        let is_known = applied.done.contains(&entity) && applied.compared.contains(&entity);
        if is_known || (mesh.is_none() && !is_light) {
            continue;
        }
        let id = ids.of(entity);
        if is_outside && !is_meant(world, &folder.manifest, entity, &id) {
            continue;
        }
        let is_mesh_loaded =
            mesh.is_none_or(|mesh| world.get_resource::<Assets<Mesh>>().is_some_and(|meshes| meshes.contains(&mesh.0)));
        if !applied.compared.contains(&entity)
            && let Some(now) = fingerprint(world, entity)
        {
            let change = folder.manifest.things.get(&id).and_then(|before| before.change_to(&now));
            found.changed.extend(change.map(|change| (id.clone(), change)));
            found.compared.push(entity);
        }
        if applied.done.contains(&entity) {
            continue;
        }
        if let Some(shown) = placements.get(&id).filter(|_| mesh.is_some() && is_mesh_loaded) {
            found.jobs.push((entity, Job::Attach(shown.clone())));
        }
        if is_light && lights.contains(&id) {
            found.jobs.push((entity, Job::Mute));
        }
    }
    found.changed.sort_by(|(a, _), (b, _)| a.cmp(b));
    found
}

/// The root and all below it.
fn below(world: &World, root: Entity) -> Vec<Entity> {
    let mut entities = vec![root];
    let mut next = 0;
    while let Some(&entity) = entities.get(next) {
        entities.extend(world.get::<Children>(entity).into_iter().flatten());
        next += 1;
    }
    entities
}

/// Meshes and lights that no file and no other folder holds.
fn outside_of_files(world: &mut World) -> Vec<Entity> {
    type Light = Or<(With<RectLight>, With<PointLight>, With<SpotLight>, With<DirectionalLight>)>;
    let mut found = world.query_filtered::<Entity, Or<(With<Mesh3d>, Light)>>();
    let found: Vec<Entity> = found.iter(world).collect();
    found.into_iter().filter(|&entity| is_outside_of_files(world, entity)).collect()
}

fn is_outside_of_files(world: &World, entity: Entity) -> bool {
    let mut next = Some(entity);
    while let Some(entity) = next.and_then(|entity| world.get_entity(entity).ok()) {
        if entity.contains::<WorldAssetRoot>()
            || entity.contains::<DynamicWorldRoot>()
            || entity.contains::<BakedLightmaps>()
        {
            return false;
        }
        next = entity.get::<ChildOf>().map(ChildOf::parent);
    }
    true
}

/// Whether a folder means this entity outside of files by its id. A game may spawn a flash of light or a crate at any
/// time: without a name it is what was baked only if it is where that was and like it.
fn is_meant(world: &World, manifest: &Manifest, entity: Entity, id: &StableId) -> bool {
    let is_carried = is_light(world, entity) && LightBaking::of(world, entity) == LightBaking::RealTime;
    let is_as_baked = || {
        let before = manifest.things.get(id);
        before.zip(fingerprint(world, entity)).is_some_and(|(before, now)| before.change_to(&now).is_none())
    };
    !is_carried && (is_named(id) || is_as_baked())
}

fn is_light(world: &World, entity: Entity) -> bool {
    let Ok(entity) = world.get_entity(entity) else { return false };
    entity.contains::<RectLight>()
        || entity.contains::<PointLight>()
        || entity.contains::<SpotLight>()
        || entity.contains::<DirectionalLight>()
}

//! Putting a `Lightmap` on an entity that may be on screen, and taking it off, without killing Bevy 0.19.
//!
//! Bevy specialises a pipeline anew only where the mesh or material component changed, so each step touches the
//! material; and it never notices another image on an entity that has a lightmap already (bevy#20299), so such a
//! one is taken off for a few frames first. All of it must happen before `PostUpdate`, where Bevy looks for
//! changed materials.

use bevy::mesh::MeshAccessError;
use bevy::pbr::Lightmap;
use bevy::prelude::*;

/// Frames between taking a lightmap off and putting another on; the renderer must have seen one without it.
const FRAMES_BETWEEN: u8 = 3;

/// A lightmap that goes on once the renderer has forgotten the one before.
#[derive(Component, Clone)]
pub(crate) struct PendingLightmap {
    lightmap: Lightmap,
    frames_left: u8,
}

/// Why an entity cannot show a lightmap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CannotAttach {
    /// It is gone.
    Despawned,
    /// It has no `Mesh3d` with a `StandardMaterial`.
    NoStandardMaterial,
    /// Its mesh has no second UV set, without which Bevy's shader does not compile.
    NoUv1,
    /// Its mesh is skinned or morphed, for which Bevy's shader does not compile either.
    Deformed,
}

impl std::fmt::Display for CannotAttach {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Despawned => "is no longer there",
            Self::NoStandardMaterial => "has no StandardMaterial",
            Self::NoUv1 => "has no UV1",
            Self::Deformed => "is skinned or morphed",
        })
    }
}

/// Puts a lightmap on an entity, at once or in a few frames if it has another one.
pub(crate) fn attach(world: &mut World, entity: Entity, lightmap: Lightmap) -> Result<(), CannotAttach> {
    check(world, entity)?;
    let mut entity = world.get_entity_mut(entity).map_err(|_| CannotAttach::Despawned)?;
    if entity.contains::<PendingLightmap>() {
        entity.insert(PendingLightmap { lightmap, frames_left: FRAMES_BETWEEN });
    } else if entity.contains::<Lightmap>() {
        entity.remove::<Lightmap>().insert(PendingLightmap { lightmap, frames_left: FRAMES_BETWEEN });
    } else {
        entity.insert(lightmap);
    }
    touch_material(&mut entity);
    Ok(())
}

/// Takes the lightmap off an entity, if it is there and has one.
pub(crate) fn detach(world: &mut World, entity: Entity) {
    if let Ok(mut entity) = world.get_entity_mut(entity) {
        entity.remove::<(Lightmap, PendingLightmap)>();
        touch_material(&mut entity);
    }
}

/// The lightmap that an entity has or will have in a few frames.
#[cfg(feature = "bake")]
pub(crate) fn attached(world: &World, entity: Entity) -> Option<Lightmap> {
    let pending = world.get::<PendingLightmap>(entity).map(|pending| pending.lightmap.clone());
    pending.or_else(|| world.get::<Lightmap>(entity).cloned())
}

/// Counts the frames of those that wait.
pub(crate) fn attach_pending(
    mut commands: Commands,
    mut waiting: Query<(Entity, &mut PendingLightmap, Option<&mut MeshMaterial3d<StandardMaterial>>)>,
) {
    for (entity, mut pending, material) in &mut waiting {
        if pending.frames_left > 0 {
            pending.frames_left -= 1;
            continue;
        }
        let lightmap = pending.lightmap.clone();
        let mut entity = commands.entity(entity);
        entity.try_remove::<PendingLightmap>();
        if let Some(mut material) = material {
            entity.try_insert(lightmap);
            material.set_changed();
        }
    }
}

fn touch_material(entity: &mut EntityWorldMut) {
    if let Some(mut material) = entity.get_mut::<MeshMaterial3d<StandardMaterial>>() {
        material.set_changed();
    }
}

fn check(world: &World, entity: Entity) -> Result<(), CannotAttach> {
    let entity = world.get_entity(entity).map_err(|_| CannotAttach::Despawned)?;
    let (Some(mesh), true) = (entity.get::<Mesh3d>(), entity.contains::<MeshMaterial3d<StandardMaterial>>()) else {
        return Err(CannotAttach::NoStandardMaterial);
    };
    if entity.contains::<bevy::mesh::skinning::SkinnedMesh>()
        || entity.contains::<bevy::mesh::morph::MeshMorphWeights>()
    {
        return Err(CannotAttach::Deformed);
    }
    let Some(mesh) = world.get_resource::<Assets<Mesh>>().and_then(|meshes| meshes.get(&mesh.0)) else {
        return Err(CannotAttach::NoUv1);
    };
    match mesh.try_contains_attribute(Mesh::ATTRIBUTE_UV_1) {
        // What went to the renderer cannot be looked into; whoever baked it has seen its UV1.
        Ok(true) | Err(MeshAccessError::ExtractedToRenderWorld) => Ok(()),
        Ok(false) | Err(MeshAccessError::NotFound) => Err(CannotAttach::NoUv1),
    }
}

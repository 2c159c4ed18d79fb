//! Putting a `Lightmap` on an entity that may be on screen, and taking it off, without killing Bevy 0.19.
//!
//! Bevy specialises a pipeline anew only where the mesh or material component changed, so each step touches the
//! material; and it never notices another image on an entity that has a lightmap already (bevy#20299), so such a
//! one is taken off for a few frames first. All of it must happen before `PostUpdate`, where Bevy looks for
//! changed materials.

use super::filtering::{FilteredBy, FollowsFiltering, LightmapFiltering};
use super::material::{shows_lightmaps, touch_materials};
use super::relay::CannotLayOut;
use super::wear::{self, SharedLayout};
use bevy::ecs::world::EntityRef;
use bevy::mesh::MeshAccessError;
use bevy::pbr::Lightmap;
use bevy::prelude::*;

/// Frames between taking a lightmap off and putting another on; the renderer must have seen one without it.
const FRAMES_BETWEEN: u8 = 3;

/// What an entity shows of a bake.
#[derive(Clone)]
pub(crate) struct Shown {
    /// The lightmap.
    pub(crate) lightmap: Lightmap,
    /// How the bake laid out its mesh, if it did.
    pub(crate) layout: Option<SharedLayout>,
    /// Who says how it is filtered.
    pub(crate) filtered_by: FilteredBy,
}

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
    /// It has no `Mesh3d`, or with a material that is not known to show lightmaps.
    NoStandardMaterial,
    /// Its mesh is not there yet.
    NotLoaded,
    /// Its mesh must be laid out, and its vertices are with the renderer.
    RenderWorldOnly,
    /// Its mesh is not the one that was baked.
    MeshChanged,
    /// Its mesh has no second UV set, without which Bevy's shader does not compile.
    NoUv1,
    /// Its mesh is skinned or morphed, for which Bevy's shader does not compile either.
    Deformed,
}

impl std::fmt::Display for CannotAttach {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Despawned => "is no longer there",
            Self::NoStandardMaterial => "has neither a StandardMaterial nor one that add_baked_material has made known",
            Self::NotLoaded => "has a mesh that is not loaded",
            Self::RenderWorldOnly => {
                "has a mesh that is in the render world only (load it with RenderAssetUsages::MAIN_WORLD as well)"
            }
            Self::MeshChanged => "has another mesh than the one that was baked (bake again)",
            Self::NoUv1 => "has no UV1",
            Self::Deformed => "is skinned or morphed",
        })
    }
}

impl From<CannotLayOut> for CannotAttach {
    fn from(error: CannotLayOut) -> Self {
        match error {
            CannotLayOut::RenderWorldOnly => Self::RenderWorldOnly,
            CannotLayOut::Changed => Self::MeshChanged,
        }
    }
}

/// Puts a lightmap on an entity, at once or in a few frames if it has another one. The mesh that belongs to it goes
/// on at once.
pub(crate) fn attach(world: &mut World, entity: Entity, shown: Shown) -> Result<(), CannotAttach> {
    let own = check(world, entity)?;
    let Shown { lightmap, layout, filtered_by } = shown;
    let filtering = LightmapFiltering::of(world);
    let laid_out = match layout {
        Some(layout) => Some(wear::lay_out(world, own, layout)?),
        None => check_uv1(world, &own).map(|()| None)?,
    };
    let mut entity = world.get_entity_mut(entity).map_err(|_| CannotAttach::Despawned)?;
    match laid_out {
        Some(laid_out) => wear::put_on(&mut entity, laid_out),
        None => wear::take_off(&mut entity),
    }
    match filtered_by {
        FilteredBy::Plugin => put_on(entity.insert(FollowsFiltering), filtering.apply(lightmap)),
        #[cfg(feature = "bake")]
        FilteredBy::Itself => put_on(entity.remove::<FollowsFiltering>(), lightmap),
    }
    Ok(())
}

/// Puts a lightmap on in place of the one that the renderer may know.
fn put_on(entity: &mut EntityWorldMut, lightmap: Lightmap) {
    if entity.contains::<PendingLightmap>() {
        entity.insert(PendingLightmap { lightmap, frames_left: FRAMES_BETWEEN });
    } else if entity.contains::<Lightmap>() {
        entity.remove::<Lightmap>().insert(PendingLightmap { lightmap, frames_left: FRAMES_BETWEEN });
    } else {
        entity.insert(lightmap);
    }
    touch_materials(entity);
}

/// Puts an entity's lightmap on again if it is filtered otherwise.
pub(super) fn refilter(entity: &mut EntityWorldMut, filtering: LightmapFiltering) {
    let pending = entity.get::<PendingLightmap>().map(|pending| &pending.lightmap);
    let Some(lightmap) = pending.or_else(|| entity.get::<Lightmap>()) else { return };
    let filtered = filtering.apply(lightmap.clone());
    if filtered.bicubic_sampling != lightmap.bicubic_sampling {
        put_on(entity, filtered);
    }
}

/// Takes the lightmap and its mesh off an entity, if it is there and has them.
pub(crate) fn detach(world: &mut World, entity: Entity) {
    if let Ok(mut entity) = world.get_entity_mut(entity) {
        entity.remove::<(Lightmap, PendingLightmap, FollowsFiltering)>();
        wear::take_off(&mut entity);
        touch_materials(&mut entity);
    }
}

/// What an entity shows, or will in a few frames.
#[cfg(feature = "bake")]
pub(crate) fn attached(world: &World, entity: Entity) -> Option<Shown> {
    let entity = world.get_entity(entity).ok()?;
    let pending = entity.get::<PendingLightmap>().map(|pending| &pending.lightmap);
    let lightmap = pending.or_else(|| entity.get::<Lightmap>())?.clone();
    let filtered_by = if entity.contains::<FollowsFiltering>() { FilteredBy::Plugin } else { FilteredBy::Itself };
    Some(Shown { lightmap, layout: wear::worn_layout(entity).cloned(), filtered_by })
}

/// Counts the frames of those that wait.
pub(crate) fn attach_pending(mut commands: Commands, mut waiting: Query<(Entity, &mut PendingLightmap)>) {
    for (entity, mut pending) in &mut waiting {
        if pending.frames_left > 0 {
            pending.frames_left -= 1;
            continue;
        }
        commands.entity(entity).queue_silenced(|mut entity: EntityWorldMut| {
            let Some(PendingLightmap { lightmap, .. }) = entity.take() else { return };
            if shows_lightmaps(entity.world(), EntityRef::from(&entity)) {
                entity.insert(lightmap);
                touch_materials(&mut entity);
            }
        });
    }
}

/// The entity's own mesh, if it can show a lightmap.
fn check(world: &World, entity: Entity) -> Result<Handle<Mesh>, CannotAttach> {
    let entity = world.get_entity(entity).map_err(|_| CannotAttach::Despawned)?;
    let (Some(mesh), true) = (wear::own_mesh(entity), shows_lightmaps(world, entity)) else {
        return Err(CannotAttach::NoStandardMaterial);
    };
    if entity.contains::<bevy::mesh::skinning::SkinnedMesh>()
        || entity.contains::<bevy::mesh::morph::MeshMorphWeights>()
    {
        return Err(CannotAttach::Deformed);
    }
    let is_loaded = world.get_resource::<Assets<Mesh>>().is_some_and(|meshes| meshes.contains(mesh));
    if is_loaded { Ok(mesh.clone()) } else { Err(CannotAttach::NotLoaded) }
}

fn check_uv1(world: &World, mesh: &Handle<Mesh>) -> Result<(), CannotAttach> {
    let Some(mesh) = world.get_resource::<Assets<Mesh>>().and_then(|meshes| meshes.get(mesh)) else {
        return Err(CannotAttach::NotLoaded);
    };
    match mesh.try_contains_attribute(Mesh::ATTRIBUTE_UV_1) {
        // What went to the renderer cannot be looked into; whoever baked it has seen its UV1.
        Ok(true) | Err(MeshAccessError::ExtractedToRenderWorld) => Ok(()),
        Ok(false) | Err(MeshAccessError::NotFound) => Err(CannotAttach::NoUv1),
    }
}

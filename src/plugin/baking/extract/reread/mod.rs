//! Meshes and images whose data Bevy has handed to the renderer (`RenderAssetUsages::RENDER_WORLD`), read a second time
//! from their files, and let go of after the snapshot. What was made in code has no file and is named.
//!
//! The second reading is an asset of its own kind at the same path, so that the game's handles, which Bevy finds by
//! path and kind, never see it, and nothing of it goes to the renderer. Nobody waits here: [`is_reading`] is asked once
//! per frame.

mod file;

pub(crate) use file::{FileLoader, SecondReading};

use super::Extraction;
use bevy::asset::{Asset, AssetPath, LoadState};
use bevy::image::Image;
use bevy::math::Vec3A;
use bevy::mesh::MeshAccessError;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use std::borrow::Cow;
use thiserror::Error;

/// Why an asset whose data is with the renderer was not read again.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NotReread {
    /// Nobody has asked for it: whoever takes a snapshot by himself takes what is there.
    #[error("")]
    NotAsked,
    /// It has no file.
    #[error(", and it was made in code, so that there is no file to read it from again")]
    MadeInCode,
    /// The file cannot be read.
    #[error(", and its file cannot be read again ({reason})")]
    Failed {
        /// What Bevy says.
        reason: String,
    },
    /// The file has something else there.
    #[error(", and its file has something else by now, or is read with settings of its own")]
    Changed,
}

/// The files that are read again for the next snapshot.
#[derive(Resource, Default)]
pub(crate) struct Rereading(HashMap<AssetPath<'static>, Handle<SecondReading>>);

/// Starts to read what a snapshot has missed. Whether there is anything to wait for.
pub(crate) fn ask(world: &mut World, extraction: &Extraction) -> bool {
    let Some(server) = world.get_resource::<AssetServer>().cloned() else { return false };
    let mut rereading = world.get_resource_or_init::<Rereading>();
    let before = rereading.0.len();
    for file in &extraction.missed {
        let load = || server.load_builder().override_unapproved().load(file.clone());
        rereading.0.entry(file.clone()).or_insert_with(load);
    }
    rereading.0.len() > before
}

/// Whether anything that was asked for is not there yet.
pub(crate) fn is_reading(world: &World) -> bool {
    let (Some(server), Some(rereading)) = (world.get_resource::<AssetServer>(), world.get_resource::<Rereading>())
    else {
        return false;
    };
    rereading.0.values().any(|file| !matches!(server.load_state(file), LoadState::Loaded | LoadState::Failed(_)))
}

/// Lets go of all that was read again.
pub(crate) fn forget(world: &mut World) {
    world.remove_resource::<Rereading>();
}

/// A mesh with its vertices, wherever they are; the outer `None` where no such asset is loaded.
pub(super) fn mesh<'w>(
    world: &'w World,
    handle: &Handle<Mesh>,
    missed: &mut Vec<AssetPath<'static>>,
) -> Option<Result<&'w Mesh, NotReread>> {
    let mesh = world.get_resource::<Assets<Mesh>>()?.get(handle)?;
    if !matches!(mesh.try_attribute(Mesh::ATTRIBUTE_POSITION), Err(MeshAccessError::ExtractedToRenderWorld)) {
        return Some(Ok(mesh));
    }
    let again = find(world, handle, missed, SecondReading::mesh);
    Some(again.and_then(|again| if has_box_of(again, mesh) { Ok(again) } else { Err(NotReread::Changed) }))
}

/// An image with its texels, wherever they are, as it was loaded: whether its file is read as sRGB and how it is
/// sampled may be a setting of the game.
pub(super) fn image<'w>(
    world: &'w World,
    handle: &Handle<Image>,
    missed: &mut Vec<AssetPath<'static>>,
) -> Option<Result<Cow<'w, Image>, NotReread>> {
    let image = world.get_resource::<Assets<Image>>()?.get(handle)?;
    if image.data.is_some() {
        return Some(Ok(Cow::Borrowed(image)));
    }
    let again = find(world, handle, missed, SecondReading::image);
    Some(again.and_then(|again| {
        let (now, before) = (&again.texture_descriptor, &image.texture_descriptor);
        let is_same = now.size == before.size
            && now.mip_level_count == before.mip_level_count
            && now.dimension == before.dimension
            && now.format.remove_srgb_suffix() == before.format.remove_srgb_suffix();
        let whole = || Image { data: again.data.clone(), data_order: again.data_order, ..image.clone() };
        if is_same { Ok(Cow::Owned(whole())) } else { Err(NotReread::Changed) }
    }))
}

/// What has the path of a handle in the second reading of its file.
fn find<'w, A: Asset>(
    world: &'w World,
    handle: &Handle<A>,
    missed: &mut Vec<AssetPath<'static>>,
    part: impl Fn(&'w SecondReading, &str) -> Option<&'w A>,
) -> Result<&'w A, NotReread> {
    let path = handle.path().ok_or(NotReread::MadeInCode)?;
    let file = path.without_label().into_owned();
    let Some(reading) = world.get_resource::<Rereading>().and_then(|rereading| rereading.0.get(&file)) else {
        missed.push(file);
        return Err(NotReread::NotAsked);
    };
    if let Some(read) = world.get_resource::<Assets<SecondReading>>().and_then(|read| read.get(reading)) {
        return part(read, path.label().unwrap_or_default()).ok_or(NotReread::Changed);
    }
    let reason = match world.get_resource::<AssetServer>().map(|server| server.load_state(reading)) {
        Some(LoadState::Failed(error)) => error.to_string(),
        _ => "it is not there yet".to_owned(),
    };
    Err(NotReread::Failed { reason })
}

/// Whether a mesh fills the box that Bevy remembers of one whose vertices are gone.
fn has_box_of(again: &Mesh, gone: &Mesh) -> bool {
    let Some(expected) = gone.final_aabb else { return true };
    let positions = again.try_attribute(Mesh::ATTRIBUTE_POSITION).ok().and_then(|positions| positions.as_float3());
    let Some(positions) = positions else { return false };
    let corners = positions.iter().map(|&position| Vec3A::from_array(position));
    let corner = |pick: fn(Vec3A, Vec3A) -> Vec3A| corners.clone().reduce(pick);
    (corner(Vec3A::min), corner(Vec3A::max)) == (Some(expected.min), Some(expected.max))
}

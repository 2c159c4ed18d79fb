//! A finished bake onto its entities, and off again. Runs in `PreUpdate`, see [`attach`].

use super::events::LightmapFormat;
use crate::artefact::{MeshLayout, StableId};
use crate::bake::{self, BakeWarning, Placement};
use crate::output::{TexelFormat, texel_bytes};
use crate::plugin::display::{
    MutedLight, SharedLayout, Shown, attach, attached, detach, lightmap_sampler, mute_light, unmute_light,
};
use bevy::asset::RenderAssetUsages;
use bevy::ecs::entity::EntityHashMap;
use bevy::pbr::Lightmap;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use std::collections::BTreeMap;

/// A bake that is ready to be shown.
pub(super) struct Finished<'a> {
    pub(super) lightmap: &'a bake::Lightmap,
    pub(super) entities: &'a BTreeMap<StableId, Entity>,
    pub(super) ambient_baked: bool,
    pub(super) format: LightmapFormat,
}

/// What came of it.
#[derive(Default)]
pub(super) struct Written {
    pub(super) entities: usize,
    pub(super) warnings: Vec<String>,
}

/// What is shown, and what was there before.
#[derive(Resource, Default)]
struct OnShow {
    pages: Vec<Handle<Image>>,
    /// What an entity showed before its first bake.
    before: EntityHashMap<Option<Shown>>,
    /// The lights that were muted for it.
    lights: Vec<Entity>,
    /// `GlobalAmbientLight::affects_lightmapped_meshes` before it was baked.
    ambient_flag: Option<bool>,
}

/// Puts a bake on its entities and mutes the lights that it holds.
pub(super) fn write_back(world: &mut World, finished: &Finished) -> Written {
    let mut shown = world.remove_resource::<OnShow>().unwrap_or_default();
    let mut clamped = 0;
    let images = finished.lightmap.pages.iter().map(|page| image(page, finished.format, &mut clamped));
    let images: Vec<Image> = images.collect();
    let targets: Vec<(Entity, &Placement)> = finished
        .lightmap
        .placements
        .iter()
        .filter_map(|placement| Some((*finished.entities.get(&placement.id)?, placement)))
        .collect();
    let in_place = fits_in_place(world, &shown, &images, &targets);
    if in_place {
        overwrite(world, &shown.pages, images);
    } else {
        let mut assets = world.resource_mut::<Assets<Image>>();
        shown.pages = images.into_iter().map(|image| assets.add(image)).collect();
    }
    take_off_the_rest(world, &mut shown, &targets);
    let layouts: Vec<SharedLayout> =
        finished.lightmap.meshes.iter().map(|mesh| SharedLayout::from(MeshLayout::from(mesh))).collect();
    let mut written = put_on(world, &mut shown, &targets, &layouts);
    if clamped > 0 {
        let format = texel_format(finished.format);
        let warning = BakeWarning::Clamped { texels: clamped, format: format.name(), limit: format.limit() };
        written.warnings.push(warning.to_string());
    }
    mute(world, &mut shown, finished);
    world.insert_resource(shown);
    written
}

/// Takes everything off again that [`write_back`] has put on.
pub(super) fn clear(world: &mut World) {
    let Some(shown) = world.remove_resource::<OnShow>() else { return };
    for (entity, before) in shown.before {
        restore(world, entity, before);
    }
    unmute(world, &shown.lights);
    restore_ambient(world, shown.ambient_flag);
}

fn texel_format(format: LightmapFormat) -> TexelFormat {
    match format {
        LightmapFormat::Rgb9e5 => TexelFormat::Rgb9e5,
        LightmapFormat::Rgba16f => TexelFormat::Rgba16f,
    }
}

fn image(page: &bake::Page, format: LightmapFormat, clamped: &mut u64) -> Image {
    let texture = match format {
        LightmapFormat::Rgb9e5 => TextureFormat::Rgb9e5Ufloat,
        LightmapFormat::Rgba16f => TextureFormat::Rgba16Float,
    };
    let encoded = texel_bytes(page, texel_format(format));
    *clamped += encoded.clamped;
    let size = Extent3d { width: page.width, height: page.height, depth_or_array_layers: 1 };
    let mut image = Image::new(size, TextureDimension::D2, encoded.bytes, texture, RenderAssetUsages::default());
    image.sampler = lightmap_sampler();
    image
}

/// Whether the textures of the last bake can take the new texels, which then show without a frame in between:
/// same sizes and format, and no entity moves to another page.
fn fits_in_place(world: &World, shown: &OnShow, images: &[Image], targets: &[(Entity, &Placement)]) -> bool {
    let Some(assets) = world.get_resource::<Assets<Image>>() else { return false };
    let same_textures = shown.pages.len() == images.len()
        && shown.pages.iter().zip(images).all(|(page, new)| {
            assets.get(page).is_some_and(|old| {
                old.texture_descriptor.size == new.texture_descriptor.size
                    && old.texture_descriptor.format == new.texture_descriptor.format
            })
        });
    same_textures
        && targets.iter().all(|&(entity, placement)| {
            let page = &shown.pages[placement.page as usize];
            attached(world, entity).is_none_or(|before| before.lightmap.image == *page)
        })
}

fn overwrite(world: &mut World, pages: &[Handle<Image>], images: Vec<Image>) {
    let mut assets = world.resource_mut::<Assets<Image>>();
    for (page, new) in pages.iter().zip(images) {
        if let Some(mut old) = assets.get_mut(page) {
            old.data = new.data;
        }
    }
}

/// Gives entities that are no longer in the bake what they had before it.
fn take_off_the_rest(world: &mut World, shown: &mut OnShow, targets: &[(Entity, &Placement)]) {
    let kept: EntityHashMap<()> = targets.iter().map(|&(entity, _)| (entity, ())).collect();
    let gone: Vec<Entity> = shown.before.keys().copied().filter(|entity| !kept.contains_key(entity)).collect();
    for entity in gone {
        let before = shown.before.remove(&entity).flatten();
        restore(world, entity, before);
    }
}

fn put_on(
    world: &mut World,
    shown: &mut OnShow,
    targets: &[(Entity, &Placement)],
    layouts: &[SharedLayout],
) -> Written {
    let mut written = Written::default();
    for &(entity, placement) in targets {
        let lightmap = Lightmap {
            image: shown.pages[placement.page as usize].clone(),
            uv_rect: Rect { min: placement.uv_min.into(), max: placement.uv_max.into() },
            bicubic_sampling: false,
        };
        let layout = placement.mesh.and_then(|mesh| layouts.get(mesh)).cloned();
        let before = attached(world, entity);
        let is_there =
            before.as_ref().is_some_and(|before| before.lightmap.image == lightmap.image && before.layout == layout);
        if is_there && world.get::<Lightmap>(entity).is_some() {
            if let Some(mut shown) = world.get_mut::<Lightmap>(entity) {
                shown.uv_rect = lightmap.uv_rect;
            }
        } else if let Err(why) = attach(world, entity, Shown { lightmap, layout }) {
            written.warnings.push(format!("\"{}\" {why}, so it does not show its lightmap", placement.id));
            continue;
        }
        shown.before.entry(entity).or_insert(before);
        written.entities += 1;
    }
    written
}

fn mute(world: &mut World, shown: &mut OnShow, finished: &Finished) {
    unmute(world, &std::mem::take(&mut shown.lights));
    let baked = finished.lightmap.baked_lights.iter().filter_map(|id| finished.entities.get(id).copied());
    for light in baked {
        let Ok(mut entity) = world.get_entity_mut(light) else { continue };
        // A baked folder on the same scene may hold it already.
        if !entity.contains::<MutedLight>() {
            mute_light(&mut entity);
            shown.lights.push(light);
        }
    }
    if !finished.ambient_baked {
        restore_ambient(world, shown.ambient_flag.take());
    } else if let Some(mut ambient) = world.get_resource_mut::<GlobalAmbientLight>() {
        let before = std::mem::replace(&mut ambient.affects_lightmapped_meshes, false);
        shown.ambient_flag.get_or_insert(before);
    }
}

fn unmute(world: &mut World, lights: &[Entity]) {
    for &light in lights {
        if let Ok(mut entity) = world.get_entity_mut(light) {
            unmute_light(&mut entity);
        }
    }
}

fn restore(world: &mut World, entity: Entity, before: Option<Shown>) {
    let Some(before) = before else { return detach(world, entity) };
    // What it had before was on it, so it can only fail where the entity is gone or was remade since.
    let _ = attach(world, entity, before);
}

fn restore_ambient(world: &mut World, flag: Option<bool>) {
    if let (Some(flag), Some(mut ambient)) = (flag, world.get_resource_mut::<GlobalAmbientLight>()) {
        ambient.affects_lightmapped_meshes = flag;
    }
}

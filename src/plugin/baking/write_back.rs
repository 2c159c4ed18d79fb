//! A finished bake onto its entities, and off again. Runs in `PreUpdate`, see [`attach`].

use super::events::LightmapFormat;
use crate::artefact::{MeshLayout, StableId};
use crate::bake::{self, BakeWarning, Placement};
use crate::output::{TexelFormat, VolumeTexture, texel_bytes};
use crate::plugin::display::{
    FilteredBy, MutedLight, SharedLayout, Shown, ShownVolume, attach, attached, despawn_volumes, detach,
    lightmap_sampler, mute_light, spawn_volume, unmute_light,
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
    /// The volumes that take the place of those there; `None` leaves these.
    pub(super) volumes: Option<&'a [bake::Volume]>,
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
    volumes: Vec<Entity>,
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
    if let Some(volumes) = finished.volumes {
        despawn_volumes(world, &mut shown.volumes);
        shown.volumes = volumes.iter().map(|volume| put_volume(world, volume, finished.format)).collect();
    }
    world.insert_resource(shown);
    written
}

/// Shows other texels in the textures that are on show, by the numbers of their pages.
pub(super) fn show_texels(world: &mut World, pages: Vec<(usize, Vec<u8>)>) {
    let Some(shown) = world.get_resource::<OnShow>() else { return };
    let textures: Vec<(Handle<Image>, Vec<u8>)> =
        pages.into_iter().filter_map(|(page, bytes)| Some((shown.pages.get(page)?.clone(), bytes))).collect();
    let Some(mut assets) = world.get_resource_mut::<Assets<Image>>() else { return };
    for (texture, bytes) in textures {
        // Another bake's textures may be of another size by now; such news is old.
        if let Some(mut image) = assets.get_mut(&texture)
            && image.data.as_ref().is_some_and(|data| data.len() == bytes.len())
        {
            image.data = Some(bytes);
        }
    }
}

/// Takes everything off again that [`write_back`] has put on.
pub(super) fn clear(world: &mut World) {
    let Some(mut shown) = world.remove_resource::<OnShow>() else { return };
    despawn_volumes(world, &mut shown.volumes);
    for (entity, before) in shown.before {
        restore(world, entity, before);
    }
    unmute(world, &shown.lights);
    restore_ambient(world, shown.ambient_flag);
}

/// Puts an irradiance volume into the world.
fn put_volume(world: &mut World, volume: &bake::Volume, format: LightmapFormat) -> Entity {
    let texture = VolumeTexture::new(volume);
    let [width, height, depth_or_array_layers] = texture.size.to_array();
    let size = Extent3d { width, height, depth_or_array_layers };
    let texels = texture.bytes(texel_format(format)).bytes;
    let mut image =
        Image::new(size, TextureDimension::D3, texels, texture_format(format), RenderAssetUsages::default());
    image.sampler = lightmap_sampler();
    let voxels = world.resource_mut::<Assets<Image>>().add(image);
    let &bake::Volume { centre, rotation, size, falloff, .. } = volume;
    spawn_volume(world, ShownVolume { name: volume.id.as_str().to_owned(), voxels, centre, rotation, size, falloff })
}

pub(super) fn texel_format(format: LightmapFormat) -> TexelFormat {
    match format {
        LightmapFormat::Rgb9e5 => TexelFormat::Rgb9e5,
        LightmapFormat::Rgba16f => TexelFormat::Rgba16f,
    }
}

fn texture_format(format: LightmapFormat) -> TextureFormat {
    match format {
        LightmapFormat::Rgb9e5 => TextureFormat::Rgb9e5Ufloat,
        LightmapFormat::Rgba16f => TextureFormat::Rgba16Float,
    }
}

fn image(page: &bake::Page, format: LightmapFormat, clamped: &mut u64) -> Image {
    let texture = texture_format(format);
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
            ..default()
        };
        let layout = placement.mesh.and_then(|mesh| layouts.get(mesh)).cloned();
        let before = attached(world, entity);
        let is_there =
            before.as_ref().is_some_and(|before| before.lightmap.image == lightmap.image && before.layout == layout);
        if is_there && world.get::<Lightmap>(entity).is_some() {
            if let Some(mut shown) = world.get_mut::<Lightmap>(entity) {
                shown.uv_rect = lightmap.uv_rect;
            }
        } else if let Err(why) = attach(world, entity, Shown { lightmap, layout, filtered_by: FilteredBy::Plugin }) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::artefact::MeshHash;
    use crate::bake::{BakeReport, LaidOutMesh, Page};
    use bevy::mesh::PrimitiveTopology;

    const TRIANGLE: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// A world with one triangle without UV1.
    fn world() -> (World, Entity, Handle<Mesh>) {
        let mut world = World::new();
        world.insert_resource(Assets::<Image>::default());
        world.insert_resource(Assets::<Mesh>::default());
        world.insert_resource(Assets::<StandardMaterial>::default());
        let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, TRIANGLE.to_vec());
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default());
        let entity = world.spawn((Mesh3d(mesh.clone()), MeshMaterial3d(material))).id();
        (world, entity, mesh)
    }

    /// A bake of it whose UV1 starts at `uv`.
    fn bake_of(positions: [[f32; 3]; 3], uv: f32, radiance: f32) -> bake::Lightmap {
        let page = Page {
            width: 4,
            height: 4,
            radiance: vec![Vec3::splat(radiance); 16],
            coverage: vec![1.0; 16],
            raw: vec![Vec3::splat(radiance); 16],
            stderr: vec![Vec3::ZERO; 16],
            ..Page::default()
        };
        let mesh = LaidOutMesh {
            source: 0,
            hash: MeshHash::of(positions, [[0, 1, 2]]),
            vertices: vec![0, 1, 2],
            uv1: vec![Vec2::splat(uv), Vec2::X, Vec2::Y],
            indices: vec![0, 1, 2],
            charts: 1,
            ..LaidOutMesh::default()
        };
        let placement =
            Placement { id: StableId::new("a"), page: 0, uv_min: [0.0; 2], uv_max: [1.0; 2], mesh: Some(0) };
        bake::Lightmap {
            pages: vec![page],
            placements: vec![placement],
            meshes: vec![mesh],
            baked_lights: Vec::new(),
            report: BakeReport::default(),
        }
    }

    fn show(world: &mut World, entity: Entity, lightmap: &bake::Lightmap) -> Written {
        let entities = BTreeMap::from([(StableId::new("a"), entity)]);
        let format = LightmapFormat::Rgba16f;
        write_back(world, &Finished { lightmap, volumes: None, entities: &entities, ambient_baked: false, format })
    }

    #[test]
    fn a_mesh_without_uv1_wears_its_layout_until_it_is_cleared() {
        let (mut world, entity, own) = world();
        let mesh_of = |world: &World| world.get::<Mesh3d>(entity).unwrap().0.clone();
        let written = show(&mut world, entity, &bake_of(TRIANGLE, 0.0, 1.0));
        assert_eq!((written.entities, written.warnings), (1, vec![]));
        let first = mesh_of(&world);
        assert!(first != own && world.get::<Lightmap>(entity).is_some());
        assert!(world.resource::<Assets<Mesh>>().get(&first).unwrap().contains_attribute(Mesh::ATTRIBUTE_UV_1));

        // The same layout: the texels change in place and nothing else does.
        show(&mut world, entity, &bake_of(TRIANGLE, 0.0, 2.0));
        assert_eq!(mesh_of(&world), first);
        assert!(world.get::<Lightmap>(entity).is_some());

        // Another layout: another mesh of the same own one, and a few frames without a lightmap.
        show(&mut world, entity, &bake_of(TRIANGLE, 0.5, 2.0));
        let second = mesh_of(&world);
        assert!(second != own && second != first && world.get::<Lightmap>(entity).is_none());

        clear(&mut world);
        assert_eq!(mesh_of(&world), own);
        assert!(attached(&world, entity).is_none());
        assert_eq!(world.resource::<Assets<Mesh>>().get(&own).unwrap().attributes().count(), 1);
    }

    #[test]
    fn a_mesh_that_changed_while_it_was_baked_is_left_alone() {
        let (mut world, entity, own) = world();
        let written = show(&mut world, entity, &bake_of([[0.5; 3]; 3], 0.0, 1.0));
        assert_eq!(written.entities, 0);
        let sentence =
            "\"a\" has another mesh than the one that was baked (bake again), so it does not show its lightmap";
        assert_eq!(written.warnings, [sentence]);
        assert_eq!(world.get::<Mesh3d>(entity).unwrap().0, own);
        assert!(attached(&world, entity).is_none());
    }

    #[test]
    fn what_was_shown_before_the_first_bake_comes_back_with_its_mesh() {
        let (mut world, entity, own) = world();
        let layout = MeshLayout::from(&bake_of(TRIANGLE, 0.25, 1.0).meshes[0]);
        let lightmap =
            Lightmap { image: Handle::default(), uv_rect: Rect::new(0.0, 0.0, 1.0, 1.0), bicubic_sampling: true };
        attach(&mut world, entity, Shown { lightmap, layout: Some(layout.into()), filtered_by: FilteredBy::Itself })
            .unwrap();
        let before = world.get::<Mesh3d>(entity).unwrap().0.clone();
        assert_ne!(before, own);
        show(&mut world, entity, &bake_of(TRIANGLE, 0.5, 1.0));
        let baked = world.get::<Mesh3d>(entity).unwrap().0.clone();
        assert!(baked != own && baked != before);
        clear(&mut world);
        assert_eq!(world.get::<Mesh3d>(entity).unwrap().0, before);
        assert!(attached(&world, entity).is_some_and(|shown| shown.lightmap.bicubic_sampling));
    }
}

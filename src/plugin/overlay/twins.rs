//! The twins of surfaces: children that show the same mesh in the overlay's material.

use super::KilnOverlay;
use super::colours::{Asked, of_texel};
use super::material::{OverlayMaterial, Place};
use super::split::indirect;
use crate::bake::{Page, Placement};
use crate::plugin::LightmapReceiver;
use crate::plugin::baking::LastBake;
use crate::plugin::display::attached;
use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::RenderLayers;
use bevy::image::{ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use half::f16;

/// Draws colours of texels.
pub(super) fn of_colours(world: &mut World, last: &LastBake, overlay: KilnOverlay, asked: Asked) -> Vec<Entity> {
    let lightmap = &last.lightmap;
    let mut pages: Vec<Vec<u8>> = lightmap.pages.iter().map(|page| vec![0; page.radiance.len() * 4]).collect();
    for placement in &lightmap.placements {
        let page = &lightmap.pages[placement.page as usize];
        let own = last.entity(&placement.id).and_then(|entity| density_of(world, entity));
        let asked = Asked { density: own.unwrap_or(asked.density), ..asked };
        for texel in texels_of(placement, page) {
            let [red, green, blue] = of_texel(overlay, page, texel, asked);
            pages[placement.page as usize][4 * texel..4 * texel + 4].copy_from_slice(&[red, green, blue, 255]);
        }
    }
    let images = lightmap.pages.iter().zip(pages);
    let images =
        images.map(|(page, bytes)| image(page, bytes, TextureFormat::Rgba8UnormSrgb, ImageFilterMode::Nearest));
    let images = images.collect();
    spawn(world, last, images, false)
}

/// Draws direct light, or the rest.
pub(super) fn of_light(world: &mut World, last: &LastBake, overlay: KilnOverlay, direct: &[Vec<Vec3>]) -> Vec<Entity> {
    let pages = last.lightmap.pages.iter().zip(direct);
    let images = pages.map(|(page, direct)| {
        let texels = page.radiance.iter().zip(direct).map(|(&all, &direct)| match overlay {
            KilnOverlay::IndirectOnly => indirect(all, direct),
            _ => direct,
        });
        let halves = texels
            .flat_map(|texel| texel.extend(1.0).to_array())
            .map(|value| f16::from_f32(value.min(f16::MAX.to_f32())));
        let bytes = halves.flat_map(f16::to_le_bytes).collect();
        image(page, bytes, TextureFormat::Rgba16Float, ImageFilterMode::Linear)
    });
    let images = images.collect();
    spawn(world, last, images, true)
}

/// Takes them away.
pub(super) fn despawn(world: &mut World, twins: &mut Vec<Entity>) {
    for twin in twins.drain(..) {
        // One may have gone with its surface.
        if let Ok(twin) = world.get_entity_mut(twin) {
            twin.despawn();
        }
    }
}

fn spawn(world: &mut World, last: &LastBake, images: Vec<Image>, is_light: bool) -> Vec<Entity> {
    let mut assets = world.resource_mut::<Assets<Image>>();
    let images: Vec<Handle<Image>> = images.into_iter().map(|image| assets.add(image)).collect();
    let mut twins = Vec::new();
    for placement in &last.lightmap.placements {
        let Some(surface) = last.entity(&placement.id).filter(|&entity| attached(world, entity).is_some()) else {
            continue;
        };
        let Some(mesh) = world.get::<Mesh3d>(surface).cloned() else { continue };
        let layers = world.get::<RenderLayers>(surface).cloned().unwrap_or_default();
        let [u, v] = placement.uv_min;
        let [u_end, v_end] = placement.uv_max;
        let place = Place { uv_rect: Vec4::new(u, v, u_end, v_end), is_light: u32::from(is_light) };
        let texels = images[placement.page as usize].clone();
        let material = world.resource_mut::<Assets<OverlayMaterial>>().add(OverlayMaterial { place, texels });
        let look = (mesh, MeshMaterial3d(material), layers, NotShadowCaster, NotShadowReceiver);
        twins.push(world.spawn((Name::new("kiln overlay"), look, ChildOf(surface))).id());
    }
    twins
}

/// Texels per metre that the nearest mark on or above an entity asks for.
fn density_of(world: &World, entity: Entity) -> Option<f32> {
    let mut next = Some(entity);
    while let Some(entity) = next {
        if let Some(receiver) = world.get::<LightmapReceiver>(entity) {
            return receiver.density;
        }
        next = world.get::<ChildOf>(entity).map(ChildOf::parent);
    }
    None
}

/// The texels of an object's rectangle.
fn texels_of(placement: &Placement, page: &Page) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (page.width, page.height);
    let first = |share: f32, size: u32| (share * size as f32).floor().clamp(0.0, size as f32) as u32;
    let end = |share: f32, size: u32| (share * size as f32).ceil().clamp(0.0, size as f32) as u32;
    let columns = first(placement.uv_min[0], width)..end(placement.uv_max[0], width);
    let rows = first(placement.uv_min[1], height)..end(placement.uv_max[1], height);
    rows.flat_map(move |row| columns.clone().map(move |column| (row * width + column) as usize))
}

fn image(page: &Page, bytes: Vec<u8>, format: TextureFormat, filter: ImageFilterMode) -> Image {
    let size = Extent3d { width: page.width, height: page.height, depth_or_array_layers: 1 };
    let mut image = Image::new(size, TextureDimension::D2, bytes, format, RenderAssetUsages::RENDER_WORLD);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        mag_filter: filter,
        min_filter: filter,
        ..ImageSamplerDescriptor::default()
    });
    image
}

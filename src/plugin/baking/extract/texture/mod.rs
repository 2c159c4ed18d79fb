//! `Image` into textures: each that a material refers to, once. What is compressed in a way that no decoder reads, or
//! no longer in main memory, becomes a warning, and the material does without it.

mod blocks;
mod formats;

use blocks::Blocks;
pub use formats::Unreadable;
use formats::{decode, texel_size};

use super::{Extraction, ExtractionWarning, NotReread, reread};
use crate::scene::{Filter, Texels, Texture, TextureRef, UvChannel, Wrap};
use bevy::asset::AssetPath;
use bevy::image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{TextureDataOrder, TextureDimension, TextureFormat};
use std::borrow::Cow;

/// A material's field that may hold a picture.
#[derive(Clone, Copy)]
pub(super) struct Slot<'a> {
    /// Whose it is, for a person.
    pub(super) owner: &'a str,
    /// What it is, for a person.
    pub(super) what: &'static str,
    /// The field.
    pub(super) image: Option<&'a Handle<Image>>,
    /// By which coordinates it is looked up.
    pub(super) uv: UvChannel,
}

/// The place of a picture in the scene; reads it at its first use. `None` where there is none or it cannot be read.
pub(super) fn place(world: &World, slot: Slot, out: &mut Extraction) -> Option<TextureRef> {
    let handle = slot.image?;
    let known = out.seen.textures.get(&handle.id()).copied();
    let index = known.unwrap_or_else(|| {
        let index = match read(world, slot, handle, &mut out.missed) {
            Ok(texture) => {
                out.scene.textures.push(texture);
                Some(out.scene.textures.len() - 1)
            }
            Err(why) => {
                let (name, what) = (slot.owner.to_owned(), slot.what);
                out.warnings.push(ExtractionWarning::TextureNotRead { name, what, why });
                None
            }
        };
        out.seen.textures.insert(handle.id(), index);
        index
    });
    index.map(|texture| TextureRef { texture, uv: slot.uv })
}

/// Whether a normal map's picture has two channels by its format, as Bevy asks (bevy_pbr 0.19, pbr_material.rs).
pub(super) fn has_two_channels(world: &World, handle: &Handle<Image>) -> bool {
    let image = world.get_resource::<Assets<Image>>().and_then(|images| images.get(handle));
    let format = image.map(|image| image.texture_descriptor.format);
    matches!(format, Some(TextureFormat::Rg8Unorm | TextureFormat::Rg16Unorm | TextureFormat::Bc5RgUnorm))
}

fn read(
    world: &World,
    slot: Slot,
    handle: &Handle<Image>,
    missed: &mut Vec<AssetPath<'static>>,
) -> Result<Texture, Unreadable> {
    let image = &*image(world, handle, missed)?;
    let size = image.texture_descriptor.size;
    if image.texture_descriptor.dimension != TextureDimension::D2 || size.depth_or_array_layers != 1 {
        return Err(Unreadable::NotFlat);
    }
    // Bevy's own default is linear and does not repeat; what glTF says comes as a descriptor.
    let default = ImageSamplerDescriptor::linear();
    let sampler = match &image.sampler {
        ImageSampler::Default => &default,
        ImageSampler::Descriptor(descriptor) => descriptor,
    };
    Ok(Texture {
        name: name(handle).unwrap_or_else(|| format!("{} of {}", slot.what, slot.owner)),
        width: size.width,
        height: size.height,
        texels: layer(image, 0)?,
        wrap: [wrap(sampler.address_mode_u), wrap(sampler.address_mode_v)],
        // Bilinear as soon as Bevy is when one comes near.
        filter: match sampler.mag_filter {
            ImageFilterMode::Linear => Filter::Linear,
            ImageFilterMode::Nearest => Filter::Nearest,
        },
    })
}

/// An image that is loaded, with its texels.
pub(super) fn image<'w>(
    world: &'w World,
    handle: &Handle<Image>,
    missed: &mut Vec<AssetPath<'static>>,
) -> Result<Cow<'w, Image>, Unreadable> {
    let image = reread::image(world, handle, missed).ok_or(Unreadable::NotLoaded)?;
    image.map_err(|why| Unreadable::RenderWorldOnly { why })
}

/// The file that an image came from, as a name for it.
pub(super) fn name(handle: &Handle<Image>) -> Option<String> {
    handle.path().map(ToString::to_string)
}

/// The finest texels of one layer of an image.
pub(super) fn layer(image: &Image, layer: usize) -> Result<Texels, Unreadable> {
    let descriptor = &image.texture_descriptor;
    let blocks = Blocks::of(descriptor.format);
    let texel = if blocks.is_none() { texel_size(descriptor.format)? } else { 0 };
    let data = image.data.as_ref().ok_or(Unreadable::RenderWorldOnly { why: NotReread::NotAsked })?;
    let size_of =
        |level: u32| [descriptor.size.width, descriptor.size.height].map(|length| (length >> level).max(1) as usize);
    let bytes_of = |level: u32| {
        let [width, height] = size_of(level);
        blocks.map_or(width * height * texel, |blocks| blocks.bytes([width, height]))
    };
    let finest = bytes_of(0);
    let stride = match image.data_order {
        TextureDataOrder::LayerMajor => (0..descriptor.mip_level_count.max(1)).map(bytes_of).sum(),
        TextureDataOrder::MipMajor => finest,
    };
    let bytes = data.get(layer * stride..).and_then(|rest| rest.get(..finest)).ok_or(Unreadable::TooShort)?;
    blocks.map_or_else(|| decode(descriptor.format, bytes), |blocks| Ok(blocks.decode(size_of(0), bytes)))
}

fn wrap(mode: ImageAddressMode) -> Wrap {
    match mode {
        ImageAddressMode::Repeat => Wrap::Repeat,
        ImageAddressMode::MirrorRepeat => Wrap::Mirror,
        // A border of one colour is what few adapters can do; Bevy then clamps.
        ImageAddressMode::ClampToEdge | ImageAddressMode::ClampToBorder => Wrap::Clamp,
    }
}

//! Texel formats: from the bytes of an image to plain numbers, as a shader sees them: what a format lacks is 0, and
//! alpha 1. Packed floats by the Vulkan specification's chapter on formats.

use crate::plugin::baking::NotReread;
use crate::scene::Texels;
use bevy::render::render_resource::TextureFormat as Format;
use half::f16;
use thiserror::Error;

/// Why an image cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Unreadable {
    /// It is not there yet.
    #[error("is not loaded; bake once it is")]
    NotLoaded,
    /// Its texels are no longer in main memory.
    #[error("is in the render world only{why}; make or load it with RenderAssetUsages::MAIN_WORLD as well")]
    RenderWorldOnly {
        /// Why it was not read again.
        why: NotReread,
    },
    /// A format without a decoder, such as ETC2 and ASTC.
    #[error("is {format}, which cannot be read; give it uncompressed, or as BC1 to BC7, for the bake")]
    Format {
        /// Its format.
        format: String,
    },
    /// It is an array, a cube or a volume.
    #[error("is no flat picture; give one of a single layer")]
    NotFlat,
    /// It is no cube of six square faces.
    #[error("is no cube of six square faces; give one")]
    NotACube,
    /// It has fewer bytes than its size and format need.
    #[error("has fewer bytes than its size needs; export it again")]
    TooShort,
}

/// How the bytes of a texel make numbers.
#[derive(Clone, Copy)]
enum Layout {
    /// Eight bits a channel, this many channels; in the order blue, green, red where said so.
    Bytes { channels: usize, order: Order, curve: Curve },
    /// Sixteen bits a channel from 0 to 1.
    Unorm16 { channels: usize },
    /// Half floats.
    Half { channels: usize },
    /// Floats.
    Float { channels: usize },
    /// Three nine-bit mantissas and one exponent.
    Rgb9e5,
    /// Two floats of eleven bits and one of ten, without signs.
    Rg11b10,
}

#[derive(Clone, Copy, PartialEq)]
enum Order {
    Rgba,
    Bgra,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Curve {
    Linear,
    Srgb,
}

fn layout(format: Format) -> Result<Layout, Unreadable> {
    let bytes = |channels, order, curve| Layout::Bytes { channels, order, curve };
    Ok(match format {
        Format::R8Unorm => bytes(1, Order::Rgba, Curve::Linear),
        Format::Rg8Unorm => bytes(2, Order::Rgba, Curve::Linear),
        Format::Rgba8Unorm => bytes(4, Order::Rgba, Curve::Linear),
        Format::Rgba8UnormSrgb => bytes(4, Order::Rgba, Curve::Srgb),
        Format::Bgra8Unorm => bytes(4, Order::Bgra, Curve::Linear),
        Format::Bgra8UnormSrgb => bytes(4, Order::Bgra, Curve::Srgb),
        Format::R16Unorm => Layout::Unorm16 { channels: 1 },
        Format::Rg16Unorm => Layout::Unorm16 { channels: 2 },
        Format::Rgba16Unorm => Layout::Unorm16 { channels: 4 },
        Format::R16Float => Layout::Half { channels: 1 },
        Format::Rg16Float => Layout::Half { channels: 2 },
        Format::Rgba16Float => Layout::Half { channels: 4 },
        Format::R32Float => Layout::Float { channels: 1 },
        Format::Rg32Float => Layout::Float { channels: 2 },
        Format::Rgba32Float => Layout::Float { channels: 4 },
        Format::Rgb9e5Ufloat => Layout::Rgb9e5,
        Format::Rg11b10Ufloat => Layout::Rg11b10,
        other => return Err(Unreadable::Format { format: format!("{other:?}") }),
    })
}

/// Bytes of one texel.
pub(super) fn texel_size(format: Format) -> Result<usize, Unreadable> {
    Ok(match layout(format)? {
        Layout::Bytes { channels, .. } => channels,
        Layout::Unorm16 { channels } | Layout::Half { channels } => 2 * channels,
        Layout::Float { channels } => 4 * channels,
        Layout::Rgb9e5 | Layout::Rg11b10 => 4,
    })
}

/// All texels in `bytes`.
pub(super) fn decode(format: Format, bytes: &[u8]) -> Result<Texels, Unreadable> {
    let size = texel_size(format)?;
    let texels = bytes.chunks_exact(size);
    let floats = |texel: fn(&[u8]) -> [f32; 4]| Ok(Texels::Float(texels.clone().map(texel).collect()));
    match layout(format)? {
        Layout::Bytes { order, curve, .. } => {
            let texels = texels.clone().map(|texel| {
                let mut all = [0, 0, 0, u8::MAX];
                all[..size].copy_from_slice(texel);
                if order == Order::Bgra { [all[2], all[1], all[0], all[3]] } else { all }
            });
            Ok(match curve {
                Curve::Linear => Texels::Linear8(texels.collect()),
                Curve::Srgb => Texels::Srgb8(texels.collect()),
            })
        }
        Layout::Unorm16 { .. } => {
            floats(|texel| channels(texel, |c: [u8; 2]| f32::from(u16::from_le_bytes(c)) / f32::from(u16::MAX)))
        }
        Layout::Half { .. } => floats(|texel| channels(texel, |c: [u8; 2]| f16::from_le_bytes(c).to_f32())),
        Layout::Float { .. } => floats(|texel| channels(texel, f32::from_le_bytes)),
        Layout::Rgb9e5 => floats(|texel| rgb9e5(word(texel))),
        Layout::Rg11b10 => floats(|texel| rg11b10(word(texel))),
    }
}

fn channels<const N: usize>(texel: &[u8], channel: impl Fn([u8; N]) -> f32) -> [f32; 4] {
    let mut all = [0.0, 0.0, 0.0, 1.0];
    for (to, from) in all.iter_mut().zip(texel.as_chunks().0) {
        *to = channel(*from);
    }
    all
}

fn word(texel: &[u8]) -> u32 {
    texel.first_chunk().copied().map_or(0, u32::from_le_bytes)
}

fn rgb9e5(word: u32) -> [f32; 4] {
    // Bias 15 and nine bits of mantissa.
    let scale = 2.0_f32.powi((word >> 27) as i32 - 24);
    let channel = |shift: u32| (word >> shift & 0x1ff) as f32 * scale;
    [channel(0), channel(9), channel(18), 1.0]
}

fn rg11b10(word: u32) -> [f32; 4] {
    // With the mantissa filled up to ten bits each is a half float without its sign.
    let channel = |bits: u32, missing: u32| f16::from_bits((bits << missing) as u16).to_f32();
    [channel(word & 0x7ff, 4), channel(word >> 11 & 0x7ff, 4), channel(word >> 22, 5), 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn floats(format: Format, bytes: &[u8]) -> Vec<[f32; 4]> {
        match decode(format, bytes).unwrap() {
            Texels::Float(texels) => texels.to_vec(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn bytes_keep_their_curve_and_missing_channels_are_black_and_opaque() {
        let Texels::Srgb8(texels) = decode(Format::Bgra8UnormSrgb, &[1, 2, 3, 4]).unwrap() else { panic!() };
        assert_eq!(*texels, [[3, 2, 1, 4]]);
        let Texels::Linear8(texels) = decode(Format::Rg8Unorm, &[1, 2, 3, 4]).unwrap() else { panic!() };
        assert_eq!(*texels, [[1, 2, 0, 255], [3, 4, 0, 255]]);
        let Texels::Linear8(texels) = decode(Format::R8Unorm, &[9]).unwrap() else { panic!() };
        assert_eq!(*texels, [[9, 0, 0, 255]]);
    }

    #[test]
    fn numbers_of_every_width() {
        let bytes: Vec<u8> = [0.25_f32, 1e6].iter().flat_map(|x| x.to_le_bytes()).collect();
        assert_eq!(floats(Format::R32Float, &bytes), [[0.25, 0.0, 0.0, 1.0], [1e6, 0.0, 0.0, 1.0]]);
        assert_eq!(floats(Format::Rg32Float, &bytes), [[0.25, 1e6, 0.0, 1.0]]);
        let bytes: Vec<u8> = [0.5_f32, 2.0, 3.0, 0.75].iter().flat_map(|&x| f16::from_f32(x).to_le_bytes()).collect();
        assert_eq!(floats(Format::Rgba16Float, &bytes), [[0.5, 2.0, 3.0, 0.75]]);
        assert_eq!(floats(Format::Rg16Unorm, &[255, 255, 0, 0]), [[1.0, 0.0, 0.0, 1.0]]);
    }

    /// Numbers put together by hand from the definitions of the formats.
    #[test]
    fn packed_floats() {
        // (1, 0.5, 0.25): exponent 16 makes a step 2^-8.
        let word = (16_u32 << 27) | (64 << 18) | (128 << 9) | 256;
        assert_eq!(floats(Format::Rgb9e5Ufloat, &word.to_le_bytes()), [[1.0, 0.5, 0.25, 1.0]]);
        let cut = |x: f32, by: u32| u32::from(f16::from_f32(x).to_bits()) >> by;
        let word = cut(1.5, 4) | cut(0.125, 4) << 11 | cut(640.0, 5) << 22;
        assert_eq!(floats(Format::Rg11b10Ufloat, &word.to_le_bytes()), [[1.5, 0.125, 640.0, 1.0]]);
    }

    #[test]
    fn what_has_no_decoder_is_named() {
        let error = decode(Format::Etc2Rgb8Unorm, &[0; 8]).unwrap_err();
        assert!(error.to_string().contains("Etc2Rgb8Unorm"), "{error}");
    }
}

//! Block-compressed texels, BC1 to BC7, as plain numbers. Blocks of 4 × 4 texels lie in rows; those on the right and lower
//! edge reach beyond the picture and are cut off there. The decoder is `bcdec_rs`, which follows the Khronos Data Format
//! Specification's chapters on S3TC, RGTC and BPTC; channels of eight bits are rounded, a GPU's need not be. What a format
//! lacks is 0, and alpha 1, as for the others.

use super::formats::Curve;
use crate::scene::Texels;
use bevy::render::render_resource::TextureFormat as Format;
use std::array;
use std::sync::Arc;

/// Texels on a block's side.
const SIDE: usize = 4;

/// One block's texels, row by row.
type Block<T> = [[T; 4]; SIDE * SIDE];

/// A format of blocks.
#[derive(Clone, Copy)]
pub(super) struct Blocks {
    /// Bytes of a block.
    size: usize,
    unpack: Unpack,
}

#[derive(Clone, Copy)]
enum Unpack {
    Bytes(fn(&[u8]) -> Block<u8>, Curve),
    Floats(fn(&[u8]) -> Block<f32>),
}

impl Blocks {
    /// The blocks of a format; `None` for one that has none, and for ETC and ASTC.
    pub(super) fn of(format: Format) -> Option<Self> {
        let bytes = |size, unpack, curve| Some(Self { size, unpack: Unpack::Bytes(unpack, curve) });
        let floats = |size, unpack| Some(Self { size, unpack: Unpack::Floats(unpack) });
        match format {
            Format::Bc1RgbaUnorm => bytes(8, |block| rgba(block, bcdec_rs::bc1), Curve::Linear),
            Format::Bc1RgbaUnormSrgb => bytes(8, |block| rgba(block, bcdec_rs::bc1), Curve::Srgb),
            Format::Bc2RgbaUnorm => bytes(16, |block| rgba(block, bcdec_rs::bc2), Curve::Linear),
            Format::Bc2RgbaUnormSrgb => bytes(16, |block| rgba(block, bcdec_rs::bc2), Curve::Srgb),
            Format::Bc3RgbaUnorm => bytes(16, |block| rgba(block, bcdec_rs::bc3), Curve::Linear),
            Format::Bc3RgbaUnormSrgb => bytes(16, |block| rgba(block, bcdec_rs::bc3), Curve::Srgb),
            Format::Bc4RUnorm => bytes(8, bc4, Curve::Linear),
            Format::Bc4RSnorm => floats(8, bc4_signed),
            Format::Bc5RgUnorm => bytes(16, bc5, Curve::Linear),
            Format::Bc5RgSnorm => floats(16, bc5_signed),
            Format::Bc6hRgbUfloat => floats(16, |block| bc6h(block, false)),
            Format::Bc6hRgbFloat => floats(16, |block| bc6h(block, true)),
            Format::Bc7RgbaUnorm => bytes(16, |block| rgba(block, bcdec_rs::bc7), Curve::Linear),
            Format::Bc7RgbaUnormSrgb => bytes(16, |block| rgba(block, bcdec_rs::bc7), Curve::Srgb),
            _ => None,
        }
    }

    /// Bytes of a picture of this many texels.
    pub(super) fn bytes(self, [width, height]: [usize; 2]) -> usize {
        width.div_ceil(SIDE) * height.div_ceil(SIDE) * self.size
    }

    /// The texels of a picture, from [`Self::bytes`] of them.
    pub(super) fn decode(self, size: [usize; 2], bytes: &[u8]) -> Texels {
        match self.unpack {
            Unpack::Bytes(unpack, Curve::Linear) => {
                Texels::Linear8(spread(size, bytes.chunks_exact(self.size), unpack))
            }
            Unpack::Bytes(unpack, Curve::Srgb) => Texels::Srgb8(spread(size, bytes.chunks_exact(self.size), unpack)),
            Unpack::Floats(unpack) => Texels::Float(spread(size, bytes.chunks_exact(self.size), unpack)),
        }
    }
}

/// Lays blocks out as a picture.
fn spread<'a, T: Copy + Default>(
    [width, height]: [usize; 2],
    blocks: impl Iterator<Item = &'a [u8]>,
    unpack: fn(&[u8]) -> Block<T>,
) -> Arc<[[T; 4]]> {
    let mut texels = vec![[T::default(); 4]; width * height];
    let across = width.div_ceil(SIDE);
    for (index, block) in blocks.enumerate() {
        let (left, top) = (index % across * SIDE, index / across * SIDE);
        for (within, texel) in unpack(block).into_iter().enumerate() {
            let (x, y) = (left + within % SIDE, top + within / SIDE);
            if x < width && y < height {
                texels[y * width + x] = texel;
            }
        }
    }
    texels.into()
}

fn rgba(block: &[u8], unpack: fn(&[u8], &mut [u8], usize)) -> Block<u8> {
    let mut flat = [0; 4 * SIDE * SIDE];
    unpack(block, &mut flat, 4 * SIDE);
    array::from_fn(|texel| array::from_fn(|channel| flat[4 * texel + channel]))
}

fn bc4(block: &[u8]) -> Block<u8> {
    let mut flat = [0; SIDE * SIDE];
    bcdec_rs::bc4(block, &mut flat, SIDE, false);
    flat.map(|red| [red, 0, 0, u8::MAX])
}

fn bc4_signed(block: &[u8]) -> Block<f32> {
    let mut flat = [0.0; SIDE * SIDE];
    bcdec_rs::bc4_float(block, &mut flat, SIDE, true);
    flat.map(|red| [red, 0.0, 0.0, 1.0])
}

fn bc5(block: &[u8]) -> Block<u8> {
    let mut flat = [0; 2 * SIDE * SIDE];
    bcdec_rs::bc5(block, &mut flat, 2 * SIDE, false);
    array::from_fn(|texel| [flat[2 * texel], flat[2 * texel + 1], 0, u8::MAX])
}

fn bc5_signed(block: &[u8]) -> Block<f32> {
    let mut flat = [0.0; 2 * SIDE * SIDE];
    bcdec_rs::bc5_float(block, &mut flat, 2 * SIDE, true);
    array::from_fn(|texel| [flat[2 * texel], flat[2 * texel + 1], 0.0, 1.0])
}

fn bc6h(block: &[u8], is_signed: bool) -> Block<f32> {
    let mut flat = [0.0; 3 * SIDE * SIDE];
    bcdec_rs::bc6h_float(block, &mut flat, 3 * SIDE, is_signed);
    array::from_fn(|texel| [flat[3 * texel], flat[3 * texel + 1], flat[3 * texel + 2], 1.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(format: Format, size: [usize; 2], bytes: &[u8]) -> Vec<[u8; 4]> {
        let blocks = Blocks::of(format).unwrap();
        assert_eq!(blocks.bytes(size), bytes.len());
        match blocks.decode(size, bytes) {
            Texels::Linear8(texels) | Texels::Srgb8(texels) => texels.to_vec(),
            other => panic!("{other:?}"),
        }
    }

    fn floats(format: Format, block: &[u8]) -> [f32; 4] {
        match Blocks::of(format).unwrap().decode([4, 4], block) {
            Texels::Float(texels) => texels[0],
            other => panic!("{other:?}"),
        }
    }

    /// Red, with blue at the end of the first row and all along the last: two colours of 5:6:5 bits, two bits a texel.
    const RED_AND_BLUE: [u8; 8] = [0x00, 0xf8, 0x1f, 0x00, 0b01_00_00_00, 0, 0, 0b01_01_01_01];

    #[test]
    fn rows_and_columns_are_where_they_were_and_what_reaches_beyond_is_cut() {
        let (red, blue) = ([255, 0, 0, 255], [0, 0, 255, 255]);
        let whole = bytes(Format::Bc1RgbaUnormSrgb, [4, 4], &RED_AND_BLUE);
        assert_eq!(whole[..4], [red, red, red, blue]);
        assert_eq!((&whole[4..12], &whole[12..]), (&[red; 8][..], &[blue; 4][..]));
        // Five by five: four blocks, of which three are one texel wide or high.
        let all = [RED_AND_BLUE, [0, 0xf8, 0, 0xf8, 0, 0, 0, 0], [0x1f, 0, 0x1f, 0, 0, 0, 0, 0], RED_AND_BLUE].concat();
        let cut = bytes(Format::Bc1RgbaUnorm, [5, 5], &all);
        assert_eq!(cut.len(), 25);
        assert_eq!(cut[..5], [red, red, red, blue, red]);
        assert_eq!(cut[20..], [blue, blue, blue, blue, red]);
    }

    #[test]
    fn alpha_is_read_in_each_way_that_there_is() {
        let colour = [0x00, 0xf8, 0x00, 0xf8, 0, 0, 0, 0];
        // Four bits a texel, and two end points with indices.
        let explicit = [[0x80_u8; 8], colour].concat();
        assert_eq!(bytes(Format::Bc2RgbaUnorm, [2, 1], &explicit), [[255, 0, 0, 0], [255, 0, 0, 136]]);
        let between = [[200, 100, 1, 0, 0, 0, 0, 0], colour].concat();
        assert_eq!(bytes(Format::Bc3RgbaUnorm, [2, 1], &between), [[255, 0, 0, 100], [255, 0, 0, 200]]);
        // With its end points in rising order BC1's last index is a hole.
        assert_eq!(bytes(Format::Bc1RgbaUnorm, [1, 1], &[0, 0, 0xff, 0xff, 3, 0, 0, 0]), [[0; 4]]);
    }

    #[test]
    fn one_and_two_channels() {
        let red = [200, 100, 1, 0, 0, 0, 0, 0];
        assert_eq!(bytes(Format::Bc4RUnorm, [2, 1], &red), [[100, 0, 0, 255], [200, 0, 0, 255]]);
        let both = [red, [7, 7, 0, 0, 0, 0, 0, 0]].concat();
        assert_eq!(bytes(Format::Bc5RgUnorm, [2, 1], &both), [[100, 7, 0, 255], [200, 7, 0, 255]]);
        assert_eq!(floats(Format::Bc4RSnorm, &[127, 127, 0, 0, 0, 0, 0, 0]), [1.0, 0.0, 0.0, 1.0]);
        let both = [[129, 129, 0, 0, 0, 0, 0, 0], [127, 127, 0, 0, 0, 0, 0, 0_u8]].concat();
        assert_eq!(floats(Format::Bc5RgSnorm, &both), [-1.0, 1.0, 0.0, 1.0]);
    }

    #[test]
    fn a_block_of_bc7_in_its_sixth_mode() {
        // Bit 6 set: end points of seven bits and a shared lowest one. All bits of colour and alpha set: white.
        let white = [0xc0, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(bytes(Format::Bc7RgbaUnormSrgb, [1, 1], &white), [[255; 4]]);
    }

    #[test]
    fn a_block_of_bc6h_in_its_eleventh_mode() {
        // Six end points of ten bits, all set: the largest half float, or the least step below zero as the format scales it.
        let block = [0xe3, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1, 0, 0, 0, 0, 0, 0, 0];
        assert_eq!(floats(Format::Bc6hRgbUfloat, &block), [65_504.0, 65_504.0, 65_504.0, 1.0]);
        let least = -93.0 * 2.0_f32.powi(-24);
        assert_eq!(floats(Format::Bc6hRgbFloat, &block), [least, least, least, 1.0]);
    }

    #[test]
    fn what_is_no_block_and_what_no_decoder_reads() {
        assert!(Blocks::of(Format::Rgba8Unorm).is_none() && Blocks::of(Format::Etc2Rgb8Unorm).is_none());
        let empty = Blocks::of(Format::Bc1RgbaUnorm).unwrap();
        assert_eq!(empty.bytes([0, 4]), 0);
        assert!(empty.decode([0, 4], &[]).is_empty());
    }
}

//! BC6H, unsigned: blocks of 4 × 4 texels in 16 bytes, after the Khronos Data Format Specification 1.3, section 20.
//!
//! It owns the way to the encoder (`block_compression`, the same in plain Rust on every machine) and to a decoder that
//! is none of the encoder's (`bcdec_rs`). It expects values that were clamped before. Blocks know nothing of each
//! other, so that threads cannot matter.

use block_compression::encode::compress_rgba16;
use block_compression::{BC6HSettings, CompressionVariant};
use half::f16;
use rayon::prelude::*;

/// Texels along a side of a block.
pub(super) const SIDE: u32 = 4;
/// Bytes of a block.
pub(super) const BLOCK_BYTES: usize = 16;
/// Largest value.
pub(super) const MAX: f32 = 65504.0;

/// Halfway between the encoder's extremes: the slower settings take four and eight times as long, for errors that
/// are a few hundredths smaller.
const SETTINGS: BC6HSettings = BC6HSettings::basic();

/// The blocks of a picture, row by row. Its width and height must be multiples of [`SIDE`], its channels in
/// [0, [`MAX`]].
pub(super) fn encode(colours: &[[f32; 3]], width: u32) -> Vec<u8> {
    let halves: Vec<f16> =
        colours.iter().flat_map(|&[red, green, blue]| [red, green, blue, 1.0].map(f16::from_f32)).collect();
    let row_of_halves = 4 * SIDE as usize * width as usize;
    let row_of_bytes = BLOCK_BYTES * (width / SIDE) as usize;
    let mut blocks = vec![0; colours.len() / (SIDE * SIDE) as usize * BLOCK_BYTES];
    if row_of_bytes > 0 {
        blocks.par_chunks_exact_mut(row_of_bytes).zip(halves.par_chunks_exact(row_of_halves)).for_each(
            |(blocks, halves)| {
                compress_rgba16(CompressionVariant::BC6H(SETTINGS), halves, blocks, width, SIDE, 4 * width);
            },
        );
    }
    blocks
}

/// The picture that blocks stand for, as a GPU reads it; what [`encode`] takes.
pub(super) fn decode(blocks: &[u8], width: u32) -> Vec<[f32; 3]> {
    let (width, side) = (width as usize, SIDE as usize);
    let mut colours = vec![[0.0; 3]; blocks.len() / BLOCK_BYTES * side * side];
    for (index, block) in blocks.as_chunks::<BLOCK_BYTES>().0.iter().enumerate() {
        let mut texels = [0.0; 3 * (SIDE * SIDE) as usize];
        bcdec_rs::bc6h_float(block, &mut texels, 3 * side, false);
        let (row, column) = (index / (width / side) * side, index % (width / side) * side);
        for (texel, colour) in texels.as_chunks::<3>().0.iter().enumerate() {
            colours[(row + texel / side) * width + column + texel % side] = *colour;
        }
    }
    colours
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bits of a block, the least first, from pieces of (value, width).
    fn block(pieces: &[(u128, u32)]) -> [u8; BLOCK_BYTES] {
        let mut bits = 0_u128;
        let mut at = 0;
        for &(value, width) in pieces {
            bits |= value << at;
            at += width;
        }
        assert_eq!(at, 128);
        bits.to_le_bytes()
    }

    /// Blocks worked out by hand from the specification: mode 3 has five bits of mode, 6 × 10 bits of ends and 63 bits
    /// of indices. An end e unpacks to (e·2¹⁶ + 2¹⁵) / 2¹⁰, or to 0 and 0xffff at its extremes; the half float is
    /// 31/64 of what is between the ends.
    #[test]
    fn a_block_made_by_hand_is_read_as_the_specification_says() {
        let [low, high] = [100_u128, 400];
        let unpacked = [low, high].map(|end| ((end << 16) + 0x8000) >> 10);
        // The first texel's index lacks its highest bit.
        let indices = (1..16).fold(0_u128, |bits, texel| bits | texel << (4 * texel - 1));
        let made = block(&[(3, 5), (low, 10), (0, 10), (1023, 10), (high, 10), (0, 10), (1023, 10), (indices, 63)]);
        let weights = [0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64];
        for (colour, weight) in decode(&made, 4).iter().zip(weights) {
            let mixed = (unpacked[0] * (64 - weight) + unpacked[1] * weight + 32) >> 6;
            let red = f16::from_bits(((mixed * 31) >> 6) as u16).to_f32();
            assert_eq!(*colour, [red, 0.0, MAX]);
        }
    }

    #[test]
    fn even_colours_come_back_to_half_a_step() {
        // The finest ends have 16 bits where all are equal, of which 31/64 are used: two steps of half floats.
        for value in [0.0, 1e-4, 0.001, 0.5, 1.0, 3.25, 1000.0, 31_830.0, MAX] {
            let colours = vec![[value, value * 0.5, value * 0.25]; 64];
            let back = decode(&encode(&colours, 8), 8);
            for (colour, wanted) in back.iter().flatten().zip(colours.as_flattened()) {
                let step = f16::from_f32(*wanted).to_bits().abs_diff(f16::from_f32(*colour).to_bits());
                assert!(step <= 16, "{colour} for {wanted}");
            }
        }
        assert_eq!(decode(&encode(&[[0.0; 3]; 16], 4), 4), [[0.0; 3]; 16], "black stays black");
    }

    #[test]
    fn blocks_lie_where_their_texels_lay() {
        // Every block has an even colour of its own.
        let (width, height) = (12_u32, 20_u32);
        let colour = |x: u32, y: u32| [(x / 4 + 1) as f32, (y / 4 + 1) as f32 * 10.0, 0.5];
        let colours: Vec<[f32; 3]> = (0..width * height).map(|at| colour(at % width, at / width)).collect();
        let blocks = encode(&colours, width);
        assert_eq!(blocks.len(), (width * height) as usize);
        for (back, wanted) in decode(&blocks, width).as_flattened().iter().zip(colours.as_flattened()) {
            assert!((back - wanted).abs() <= 0.01 * wanted, "{back} for {wanted}");
        }
        assert!(encode(&[], 0).is_empty() && decode(&[], 0).is_empty());
    }

    #[test]
    fn the_bits_are_the_same_everywhere_and_on_any_number_of_threads() {
        let colours: Vec<[f32; 3]> = (0..64 * 32).map(texel).collect();
        let blocks = encode(&colours, 64);
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(alone.install(|| encode(&colours, 64)), blocks);
        let key = blocks
            .iter()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
        assert_eq!(key, 0x0983_afcb_3c79_e588);
    }

    /// Smooth, with an edge.
    fn texel(at: usize) -> [f32; 3] {
        let (x, y) = ((at % 64) as f32, (at / 64) as f32);
        let bright = if 3.0 * x + y > 100.0 { 8.0 } else { 0.5 };
        [bright + 0.01 * x, bright * 0.75 + 0.02 * y, bright * 0.5]
    }
}

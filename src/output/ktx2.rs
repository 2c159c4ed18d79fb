//! A page as a KTX2 texture, which Bevy loads without further features.
//!
//! It owns the container after the KTX File Format Specification 2.0 (Khronos 2020): header, level index, data
//! format descriptor, key and value data, one level, compressed by Zstandard (RFC 8878) where that helps. What a
//! texel is made of belongs to `texels`.

use super::format::TexelFormat;
use super::texels::{Encoded, texel_bytes};
use crate::bake::Page;
use ktx2::dfd::{Basic, Block};
use ktx2::{Format, Header, Index, LevelIndex, SupercompressionScheme};
use ruzstd::decoding::StreamingDecoder;
use ruzstd::encoding::{CompressionLevel, compress_to_vec};
use std::io::Read;
use std::panic::catch_unwind;

/// What the file says about who wrote it.
const WRITER: &str = concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION"));

/// Least height of a stored texture. Bevy takes a texture that is one texel high for one-dimensional, and a
/// lightmap must be two-dimensional.
const MIN_HEIGHT: u32 = 2;

/// A page as the bytes of a KTX2 file: two-dimensional, one level, row 0 at v = 0. A page that is one texel high is
/// stored with its row repeated, which looks the same under every v.
pub fn ktx2_bytes(page: &Page, format: TexelFormat) -> Encoded {
    let Encoded { bytes: mut texels, clamped } = texel_bytes(page, format);
    let (width, height) = stored_size(page);
    // Repeats the only row, or blackens a page without any.
    texels.extend_from_within(..);
    texels.truncate((page.width as usize * height as usize) * format.bytes_per_texel());
    texels.resize(width as usize * height as usize * format.bytes_per_texel(), 0);
    let bytes = container(width, height, format, &texels);
    Encoded { bytes, clamped }
}

/// Size of the texture that stores a page [texels].
pub(super) fn stored_size(page: &Page) -> (u32, u32) {
    (page.width.max(1), page.height.max(MIN_HEIGHT))
}

/// The file around a level.
fn container(width: u32, height: u32, format: TexelFormat, texels: &[u8]) -> Vec<u8> {
    let vulkan_format = match format {
        TexelFormat::Rgb9e5 => Format::E5B9G9R9_UFLOAT_PACK32,
        TexelFormat::Rgba16f => Format::R16G16B16A16_SFLOAT,
    };
    let (basic, type_size) = Basic::from_format(vulkan_format).expect("both formats are in the crate's table");
    let descriptor = sized(&Block::Basic(basic).to_vec(), SizeField::Counted);
    let metadata = key_values(&[("KTXorientation", "rd"), ("KTXwriter", WRITER)]);
    let descriptor_offset = Header::LENGTH + LevelIndex::LENGTH;
    let metadata_offset = descriptor_offset + descriptor.len();
    let metadata_end = metadata_offset + metadata.len();

    let compressed = compress(texels);
    let level = compressed.as_deref().unwrap_or(texels);
    // An uncompressed level starts at a multiple of its texel; both sizes are multiples of 4.
    let level_offset = match compressed {
        Some(_) => metadata_end,
        None => metadata_end.next_multiple_of(format.bytes_per_texel()),
    };
    let header = Header {
        format: Some(vulkan_format),
        type_size,
        pixel_width: width,
        pixel_height: height,
        pixel_depth: 0,
        layer_count: 0,
        face_count: 1,
        level_count: 1,
        supercompression_scheme: compressed.as_ref().map(|_| SupercompressionScheme::Zstandard),
        index: Index {
            dfd_byte_offset: descriptor_offset as u32,
            dfd_byte_length: descriptor.len() as u32,
            kvd_byte_offset: metadata_offset as u32,
            kvd_byte_length: metadata.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let level_index = LevelIndex {
        byte_offset: level_offset as u64,
        byte_length: level.len() as u64,
        uncompressed_byte_length: texels.len() as u64,
    };
    let mut file = Vec::with_capacity(level_offset + level.len());
    file.extend(header.as_bytes());
    file.extend(level_index.as_bytes());
    file.extend(descriptor);
    file.extend(metadata);
    file.resize(level_offset, 0);
    file.extend(level);
    file
}

/// Whether the size before a section counts itself.
enum SizeField {
    /// It does, as in the data format descriptor.
    Counted,
    /// It does not, as before a key and its value.
    NotCounted,
}

/// A section behind its size.
fn sized(section: &[u8], field: SizeField) -> Vec<u8> {
    let size = match field {
        SizeField::Counted => section.len() + size_of::<u32>(),
        SizeField::NotCounted => section.len(),
    };
    let mut bytes = (size as u32).to_le_bytes().to_vec();
    bytes.extend(section);
    bytes
}

/// Key and value data; the keys must be in order.
fn key_values(pairs: &[(&str, &str)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (key, value) in pairs {
        bytes.extend(sized(format!("{key}\0{value}\0").as_bytes(), SizeField::NotCounted));
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}

/// The bytes compressed, unless that makes them longer or the decoder does not give them back.
fn compress(bytes: &[u8]) -> Option<Vec<u8>> {
    // The encoder is young and says nothing but panics where it fails; a bake of hours must not end on that.
    let compressed = catch_unwind(|| compress_to_vec(bytes, CompressionLevel::Fastest)).ok()?;
    let faithful = compressed.len() < bytes.len() && decompress(&compressed).is_some_and(|back| back == bytes);
    faithful.then_some(compressed)
}

/// The bytes that a Zstandard frame holds.
fn decompress(mut compressed: &[u8]) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    StreamingDecoder::new(&mut compressed).ok()?.read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

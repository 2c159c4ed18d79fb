//! A page as a KTX2 texture, which Bevy loads without further features.
//!
//! It owns the container after the KTX File Format Specification 2.0 (Khronos 2020): header, level index, data
//! format descriptor, key and value data, one level, compressed by Zstandard (RFC 8878) where that helps. What a
//! texel is made of belongs to `texels`.

use super::bc6h::SIDE;
use super::format::TexelFormat;
use super::texels::{Encoded, texel_bytes};
use super::volume::VolumeTexture;
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
    let Encoded { bytes, clamped } = texel_bytes(page, format);
    Encoded { bytes: file_of(page, format, bytes), clamped }
}

/// The file of a page whose texels are encoded already.
pub(super) fn file_of(page: &Page, format: TexelFormat, mut texels: Vec<u8>) -> Vec<u8> {
    let (width, height) = stored_size(page, format);
    // Repeats the only row, or blackens a page without any.
    texels.extend_from_within(..);
    texels.truncate(width as usize * height as usize * format.bytes_per_texel());
    texels.resize(width as usize * height as usize * format.bytes_per_texel(), 0);
    container([width, height, 0], format, &texels)
}

/// Size of the texture that stores a page [texels].
pub(super) fn stored_size(page: &Page, format: TexelFormat) -> (u32, u32) {
    let least = match format {
        TexelFormat::Rgb9e5 | TexelFormat::Rgba16f => [1, MIN_HEIGHT],
        TexelFormat::Bc6h => [SIDE; 2],
    };
    let [width, height] = format.stored_size(page);
    (width.max(least[0]), height.max(least[1]))
}

/// A three-dimensional texture as the bytes of a KTX2 file.
pub(super) fn file_of_volume(texture: &VolumeTexture, format: TexelFormat, texels: &[u8]) -> Vec<u8> {
    container(texture.size.to_array(), format, texels)
}

/// The file around a level; without depth, for 0, it is two-dimensional.
fn container([width, height, depth]: [u32; 3], format: TexelFormat, texels: &[u8]) -> Vec<u8> {
    let vulkan_format = match format {
        TexelFormat::Rgb9e5 => Format::E5B9G9R9_UFLOAT_PACK32,
        TexelFormat::Rgba16f => Format::R16G16B16A16_SFLOAT,
        TexelFormat::Bc6h => Format::BC6H_UFLOAT_BLOCK,
    };
    let (basic, type_size) = Basic::from_format(vulkan_format).expect("all formats are in the crate's table");
    let descriptor = sized(&Block::Basic(basic).to_vec(), SizeField::Counted);
    let orientation = if depth == 0 { "rd" } else { "rdi" };
    let metadata = key_values(&[("KTXorientation", orientation), ("KTXwriter", WRITER)]);
    let descriptor_offset = Header::LENGTH + LevelIndex::LENGTH;
    let metadata_offset = descriptor_offset + descriptor.len();
    let metadata_end = metadata_offset + metadata.len();

    let compressed = compress(texels);
    let level = compressed.as_deref().unwrap_or(texels);
    // An uncompressed level starts at a multiple of its texel or block; all sizes are multiples of 4.
    let level_offset = match compressed {
        Some(_) => metadata_end,
        None => metadata_end.next_multiple_of(format.unit_bytes()),
    };
    let header = Header {
        format: Some(vulkan_format),
        type_size,
        pixel_width: width,
        pixel_height: height,
        pixel_depth: depth,
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
    // The encoder has no way but a panic to say that it failed, and a bake of hours must not end on that.
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

#[cfg(test)]
mod tests {
    use super::super::rgb9e5;
    use super::super::test_pages::{page, strange_page};
    use super::*;
    use glam::{UVec3, Vec3};
    use ktx2::Reader;
    use ktx2::{ColorModel, ColorPrimaries, TransferFunction};

    const ALL: [TexelFormat; 3] = [TexelFormat::Rgb9e5, TexelFormat::Rgba16f, TexelFormat::Bc6h];

    /// What a loader makes of the file: its header and the texels of its level, decompressed.
    fn load(file: &[u8]) -> (Header, Vec<u8>) {
        let reader = Reader::new(file).expect("a KTX2 file");
        let levels: Vec<_> = reader.levels().collect();
        assert_eq!(levels.len(), 1);
        let texels = match reader.header().supercompression_scheme {
            None => levels[0].data.to_vec(),
            Some(SupercompressionScheme::Zstandard) => decompress(levels[0].data).expect("a Zstandard frame"),
            Some(other) => panic!("{other:?} is not what Bevy reads"),
        };
        assert_eq!(levels[0].uncompressed_byte_length, texels.len() as u64);
        (reader.header(), texels)
    }

    /// Values that a coder of differences cannot predict, from a fixed seed.
    fn noise(length: usize) -> Vec<u8> {
        let mut state = 1_u64;
        let mut byte = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 56) as u8
        };
        (0..length).map(|_| byte()).collect()
    }

    #[test]
    fn the_header_is_that_of_a_two_dimensional_texture() {
        for format in ALL {
            let (header, texels) = load(&ktx2_bytes(&page(24, 20), format).bytes);
            let (expected, type_size) = match format {
                TexelFormat::Rgb9e5 => (Format::E5B9G9R9_UFLOAT_PACK32, 4),
                TexelFormat::Rgba16f => (Format::R16G16B16A16_SFLOAT, 2),
                TexelFormat::Bc6h => (Format::BC6H_UFLOAT_BLOCK, 1),
            };
            assert_eq!((header.format, header.type_size), (Some(expected), type_size));
            assert_eq!((header.pixel_width, header.pixel_height, header.pixel_depth), (24, 20, 0));
            assert_eq!((header.layer_count, header.face_count, header.level_count), (0, 1, 1));
            assert_eq!(header.supercompression_scheme, Some(SupercompressionScheme::Zstandard));
            assert_eq!(texels, texel_bytes(&page(24, 20), format).bytes);
        }
    }

    #[test]
    fn a_volume_is_three_dimensional() {
        let size = UVec3::new(3, 4, 6);
        let texels = (0..72).map(|number| Vec3::new(number as f32, 1.0, 0.5)).collect();
        let texture = VolumeTexture { size, texels };
        for format in [TexelFormat::Rgb9e5, TexelFormat::Rgba16f] {
            let bytes = texture.bytes(format).bytes;
            let (header, texels) = load(&file_of_volume(&texture, format, &bytes));
            assert_eq!((header.pixel_width, header.pixel_height, header.pixel_depth), (3, 4, 6));
            assert_eq!((texels.len(), &texels), (72 * format.bytes_per_texel(), &bytes));
        }
    }

    #[test]
    fn descriptor_and_metadata_say_linear_rec_709_and_row_0_first() {
        let file = ktx2_bytes(&page(8, 8), TexelFormat::Rgb9e5).bytes;
        let reader = Reader::new(&file[..]).unwrap();
        let basic = reader.basic_dfd().expect("a basic descriptor");
        assert_eq!(basic.color_model, Some(ColorModel::RGBSDA));
        assert_eq!(basic.color_primaries, Some(ColorPrimaries::BT709));
        assert_eq!(basic.transfer_function, Some(TransferFunction::Linear));
        assert_eq!(basic.sample_information.len(), 6, "mantissa and exponent of each channel");
        let metadata: Vec<_> = reader.key_value_data().collect();
        let writer = format!("{WRITER}\0");
        assert_eq!(metadata, [("KTXorientation", &b"rd\0"[..]), ("KTXwriter", writer.as_bytes())]);
        assert!(reader.header().index.kvd_byte_offset.is_multiple_of(4));
    }

    #[test]
    fn blocks_are_described_as_such_and_fill_whole_ones() {
        let file = ktx2_bytes(&page(9, 6), TexelFormat::Bc6h).bytes;
        let reader = Reader::new(&file[..]).unwrap();
        let basic = reader.basic_dfd().expect("a basic descriptor");
        assert_eq!(basic.color_model, Some(ColorModel::BC6H));
        assert_eq!(basic.transfer_function, Some(TransferFunction::Linear));
        assert_eq!(basic.texel_block_dimensions.map(|length| length.get()), [4, 4, 1, 1]);
        assert_eq!(basic.bytes_planes[0], 16);
        // Unsigned floats, as the specification tells them from signed ones.
        let sample = &basic.sample_information[0];
        assert_eq!((sample.bit_length.get(), sample.lower, sample.upper), (128, 0, 1.0_f32.to_bits()));
        let (header, texels) = load(&file);
        assert_eq!((header.pixel_width, header.pixel_height, texels.len()), (12, 8, 12 * 8));
        let row = page(5, 1);
        let (header, _) = load(&ktx2_bytes(&row, TexelFormat::Bc6h).bytes);
        assert_eq!((header.pixel_width, header.pixel_height), (8, 4));
        let empty = Page { width: 0, height: 0, ..row };
        let (header, texels) = load(&ktx2_bytes(&empty, TexelFormat::Bc6h).bytes);
        assert_eq!((header.pixel_width, header.pixel_height, texels), (4, 4, vec![0; 16]));
        let noise = noise(64 * 64);
        let file = container([64, 64, 0], TexelFormat::Bc6h, &noise);
        let level = Reader::new(&file[..]).unwrap().levels().next().unwrap().data.as_ptr() as usize;
        assert_eq!((level - file.as_ptr() as usize) % 16, 0);
    }

    #[test]
    fn shared_exponents_are_close_to_the_page() {
        let page = page(16, 9);
        let (_, texels) = load(&ktx2_bytes(&page, TexelFormat::Rgb9e5).bytes);
        assert_eq!(texels.len(), page.radiance.len() * 4);
        for (bytes, radiance) in texels.chunks_exact(4).zip(&page.radiance) {
            let colour = Vec3::from(rgb9e5::decode(u32::from_le_bytes(bytes.try_into().unwrap())));
            assert!((colour - radiance).abs().max_element() <= radiance.max_element() / 511.0);
        }
    }

    #[test]
    fn noise_is_stored_as_it_is_and_aligned() {
        let texels = noise(64 * 64 * 8);
        let file = container([64, 64, 0], TexelFormat::Rgba16f, &texels);
        let (header, stored) = load(&file);
        assert_eq!(header.supercompression_scheme, None);
        assert_eq!(stored, texels);
        assert_eq!((file.len() - texels.len()) % 8, 0);
    }

    #[test]
    fn compression_gives_every_kind_of_level_back() {
        let noise = noise(300_000);
        for length in [8, 16, 100, 1000, 131_071, 131_072, 131_073, 262_144, 300_000] {
            let noisy = &noise[..length];
            let kinds: [Vec<u8>; 5] = [
                vec![0; length],
                noisy.iter().map(|byte| byte & 1).collect(),
                noisy.iter().map(|byte| byte & 0x3f).collect(),
                (0..length).map(|index| (index / 700) as u8).collect(),
                noisy.to_vec(),
            ];
            for (kind, bytes) in kinds.iter().enumerate() {
                let case = format!("kind {kind} of {length} bytes");
                let frame = compress_to_vec(&bytes[..], CompressionLevel::Fastest);
                assert_eq!(decompress(&frame).as_ref(), Some(bytes), "{case}");
                // A small level does not pay for its tables, and noise cannot.
                let (small, noise) = (length <= 1000, kind == 4);
                assert!(small || compress(bytes).is_some() != noise, "{case}");
                assert!(compress(bytes).is_none_or(|compressed| compressed == frame), "{case}");
            }
        }
    }

    #[test]
    fn a_page_one_texel_high_stays_two_dimensional() {
        for width in [1, 3] {
            let page = page(width, 1);
            let (header, texels) = load(&ktx2_bytes(&page, TexelFormat::Rgba16f).bytes);
            assert_eq!((header.pixel_width, header.pixel_height), (width, 2));
            let row = texel_bytes(&page, TexelFormat::Rgba16f).bytes;
            assert_eq!(texels, [&row[..], &row[..]].concat());
        }
        let empty = Page::default();
        let (header, texels) = load(&ktx2_bytes(&empty, TexelFormat::Rgb9e5).bytes);
        assert_eq!((header.pixel_width, header.pixel_height, texels), (1, 2, vec![0; 8]));
    }

    #[test]
    fn what_does_not_fit_is_counted_in_the_file_as_in_the_texels() {
        for format in ALL {
            let encoded = ktx2_bytes(&strange_page(), format);
            assert_eq!(encoded.clamped, texel_bytes(&strange_page(), format).clamped);
            assert_eq!(load(&encoded.bytes).1, texel_bytes(&strange_page(), format).bytes);
        }
    }
}

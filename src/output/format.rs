//! The formats by name, and what each can hold.

use crate::bake::Page;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// What a baked folder holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OutputFormat {
    /// Display maps of 4 bytes per texel, which every GPU filters; 9 bits per channel, without coverage.
    #[default]
    Rgb9e5,
    /// Display maps of 8 bytes per texel; 11 bits per channel, coverage in alpha.
    Rgba16f,
    /// Display maps of 1 byte per texel, compressed in blocks of 4 × 4 texels with some loss; without coverage. For
    /// GPUs with BC compression, which are those of desktops and consoles.
    Bc6h,
    /// What [`Rgb9e5`](Self::Rgb9e5) holds, and every layer of every page as an f32 EXR besides.
    Exr,
}

/// How a display map stores a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TexelFormat {
    /// Three 9-bit mantissas over one 5-bit exponent, 4 bytes; no alpha.
    #[default]
    Rgb9e5,
    /// Four half floats, 8 bytes; alpha is the coverage.
    Rgba16f,
    /// BC6H, unsigned: half floats in blocks of 4 × 4 texels, 16 bytes each; no alpha.
    Bc6h,
}

/// A word that names no [`OutputFormat`].
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("\"{0}\" is no format; use rgb9e5, rgba16f, bc6h or exr")]
pub struct UnknownFormat(pub String);

impl OutputFormat {
    /// How the display maps store a texel.
    pub fn texel_format(self) -> TexelFormat {
        match self {
            Self::Rgb9e5 | Self::Exr => TexelFormat::Rgb9e5,
            Self::Rgba16f => TexelFormat::Rgba16f,
            Self::Bc6h => TexelFormat::Bc6h,
        }
    }
}

impl FromStr for OutputFormat {
    type Err = UnknownFormat;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        [Self::Rgb9e5, Self::Rgba16f, Self::Bc6h, Self::Exr]
            .into_iter()
            .find(|format| format.to_string() == name)
            .ok_or_else(|| UnknownFormat(name.to_owned()))
    }
}

/// The value of `--format`.
impl fmt::Display for OutputFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Rgb9e5 => "rgb9e5",
            Self::Rgba16f => "rgba16f",
            Self::Bc6h => "bc6h",
            Self::Exr => "exr",
        })
    }
}

impl TexelFormat {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rgb9e5 => "rgb9e5",
            Self::Rgba16f => "rgba16f",
            Self::Bc6h => "bc6h",
        }
    }

    /// Largest value that a channel holds [cd/m²].
    pub fn limit(self) -> f32 {
        match self {
            Self::Rgb9e5 => super::rgb9e5::MAX,
            Self::Rgba16f => 65504.0,
            Self::Bc6h => super::bc6h::MAX,
        }
    }

    /// Size of a texel of a whole block [bytes].
    pub fn bytes_per_texel(self) -> usize {
        match self {
            Self::Rgb9e5 => 4,
            Self::Rgba16f => 8,
            Self::Bc6h => 1,
        }
    }

    /// Size of what cannot be split: a texel, or a block of them [bytes].
    pub(super) fn unit_bytes(self) -> usize {
        match self {
            Self::Rgb9e5 | Self::Rgba16f => self.bytes_per_texel(),
            Self::Bc6h => super::bc6h::BLOCK_BYTES,
        }
    }

    /// Width and height of the level that stores a page: the page's own, or what whole blocks cover [texels].
    pub fn stored_size(self, page: &Page) -> [u32; 2] {
        let size = [page.width, page.height];
        match self {
            Self::Rgb9e5 | Self::Rgba16f => size,
            Self::Bc6h => size.map(|length| length.next_multiple_of(super::bc6h::SIDE)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_shown() {
        for format in [OutputFormat::Rgb9e5, OutputFormat::Rgba16f, OutputFormat::Bc6h, OutputFormat::Exr] {
            assert_eq!(format.to_string().parse(), Ok(format));
        }
        assert_eq!("png".parse::<OutputFormat>(), Err(UnknownFormat("png".into())));
    }
}

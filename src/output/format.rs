//! The formats by name, and what each can hold.

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
}

/// A word that names no [`OutputFormat`].
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("\"{0}\" is no format; use rgb9e5, rgba16f or exr")]
pub struct UnknownFormat(pub String);

impl OutputFormat {
    /// How the display maps store a texel.
    pub fn texel_format(self) -> TexelFormat {
        match self {
            Self::Rgb9e5 | Self::Exr => TexelFormat::Rgb9e5,
            Self::Rgba16f => TexelFormat::Rgba16f,
        }
    }
}

impl FromStr for OutputFormat {
    type Err = UnknownFormat;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        [Self::Rgb9e5, Self::Rgba16f, Self::Exr]
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
        }
    }

    /// Largest value that a channel holds [cd/m²].
    pub fn limit(self) -> f32 {
        match self {
            Self::Rgb9e5 => super::rgb9e5::MAX,
            Self::Rgba16f => 65504.0,
        }
    }

    /// Size of a texel [bytes].
    pub fn bytes_per_texel(self) -> usize {
        match self {
            Self::Rgb9e5 => 4,
            Self::Rgba16f => 8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_shown() {
        for format in [OutputFormat::Rgb9e5, OutputFormat::Rgba16f, OutputFormat::Exr] {
            assert_eq!(format.to_string().parse(), Ok(format));
        }
        assert_eq!("png".parse::<OutputFormat>(), Err(UnknownFormat("png".into())));
    }
}

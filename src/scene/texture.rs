//! Pictures on surfaces: their texels as they were stored, and how they are looked up. Decoding them is the tracer's
//! work, so that what nothing looks at stays as it is.

use std::sync::Arc;

/// A picture that materials refer to. Row 0 is v = 0, as in glTF.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name by which a person knows it.
    pub name: String,
    /// Width [texels].
    pub width: u32,
    /// Height [texels].
    pub height: u32,
    /// `width` × `height` texels, row by row.
    pub texels: Texels,
    /// What lies beyond the unit square, along u and along v.
    pub wrap: [Wrap; 2],
    /// What lies between texels.
    pub filter: Filter,
}

/// Texels in the encoding in which they came.
#[derive(Clone, Debug, PartialEq)]
pub enum Texels {
    /// Eight bits a channel; red, green and blue by the sRGB curve, alpha linear.
    Srgb8(Arc<[[u8; 4]]>),
    /// Eight bits a channel, linear.
    Linear8(Arc<[[u8; 4]]>),
    /// Linear numbers.
    Float(Arc<[[f32; 4]]>),
}

impl Texels {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Srgb8(texels) | Self::Linear8(texels) => texels.len(),
            Self::Float(texels) => texels.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// What lies beyond the edge of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// The texture again, every second time mirrored.
    Mirror,
    /// Its edge.
    Clamp,
}

/// What lies between the centres of texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The bilinear mean of the four nearest.
    #[default]
    Linear,
    /// The nearest.
    Nearest,
}

/// Which texture coordinates a mesh is to be looked up by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum UvChannel {
    /// TEXCOORD_0.
    #[default]
    Uv0,
    /// TEXCOORD_1, which is also where lightmaps lie.
    Uv1,
}

/// A material's use of a texture. A mesh without the coordinates asked for has the texture's value at (0, 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureRef {
    /// Index into [`Scene::textures`](super::Scene::textures).
    pub texture: usize,
    /// By which coordinates.
    pub uv: UvChannel,
}

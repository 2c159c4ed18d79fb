//! An irradiance volume as the three-dimensional texture that Bevy reads.
//!
//! Of a volume of (x, y, z) probes the texture has (x, 2y, 3z) texels. Its slices along z are three volumes one behind the
//! other, for the axes X, Y and Z; in each the rows along y are two, the *positive* direction of the axis first and the
//! negative one after it, as Bevy's shader looks them up (`irradiance_volume.wgsl`; the documentation of Bevy's
//! `IrradianceVolume` has them the other way round).

use super::format::TexelFormat;
use super::texels::{Encoded, texel_bytes};
use crate::bake::{Page, Volume};
use glam::{UVec3, Vec3};

/// The texels of an irradiance volume, along x first, then y, then z.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeTexture {
    /// Texels along each axis.
    pub size: UVec3,
    /// E/π for one direction at one probe [cd/m²].
    pub texels: Vec<Vec3>,
}

impl VolumeTexture {
    /// What Bevy's shader is to read of a volume.
    pub fn new(volume: &Volume) -> Self {
        let resolution = volume.resolution;
        let size = resolution * UVec3::new(1, 2, 3);
        let texel = |x: u32, y: u32, z: u32| {
            let (axis, is_negative) = (z / resolution.z, y >= resolution.y);
            let [y, z] = [y % resolution.y, z % resolution.z].map(|along| along as usize);
            let probe = (z * resolution.y as usize + y) * resolution.x as usize + x as usize;
            let face = 2 * axis as usize + usize::from(is_negative);
            volume.cubes.get(probe).map_or(Vec3::ZERO, |cube| cube[face])
        };
        let places = (0..size.z).flat_map(|z| (0..size.y).flat_map(move |y| (0..size.x).map(move |x| (x, y, z))));
        Self { size, texels: places.map(|(x, y, z)| texel(x, y, z)).collect() }
    }

    /// The texels as level 0 of a texture, without padding. Formats of blocks do not come in three dimensions everywhere:
    /// instead of [`TexelFormat::Bc6h`] ask for [`volume_format`].
    pub fn bytes(&self, format: TexelFormat) -> Encoded {
        let (width, height) = (self.size.x, self.size.y * self.size.z);
        let coverage = vec![1.0; self.texels.len()];
        texel_bytes(&Page { width, height, radiance: self.texels.clone(), coverage, ..Page::default() }, format)
    }
}

/// The format of volumes beside lightmaps of a format.
pub fn volume_format(format: TexelFormat) -> TexelFormat {
    match format {
        TexelFormat::Rgb9e5 | TexelFormat::Bc6h => TexelFormat::Rgb9e5,
        TexelFormat::Rgba16f => TexelFormat::Rgba16f,
    }
}

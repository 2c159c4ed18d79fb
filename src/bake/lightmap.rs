//! The finished lightmap: pages of texels and where each object lies on them.

use super::BakeReport;
use crate::artefact::StableId;
use glam::Vec3;

/// A finished lightmap bake.
#[derive(Clone, Debug)]
pub struct Lightmap {
    /// The textures.
    pub pages: Vec<Page>,
    /// Where each object lies, ordered by id.
    pub placements: Vec<Placement>,
    /// Ids of the lights whose direct light is in the texels.
    pub baked_lights: Vec<StableId>,
    /// What the bake did.
    pub report: BakeReport,
}

/// One texture. All layers are row by row, row 0 at v = 0, `width × height` long.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Width [texels].
    pub width: u32,
    /// Height [texels].
    pub height: u32,
    /// E/π after all repair, E being the irradiance [cd/m²].
    pub radiance: Vec<Vec3>,
    /// Share of the texel's area that triangles cover, in [0, 1]; 0 where dilated or empty.
    pub coverage: Vec<f32>,
    /// E/π as measured, before repair [cd/m²].
    pub raw: Vec<Vec3>,
    /// Standard error of `raw` [cd/m²].
    pub stderr: Vec<Vec3>,
}

/// Where an object's unit square of UV1 lies on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// The object.
    pub id: StableId,
    /// Index into [`Lightmap::pages`].
    pub page: u32,
    /// Smallest corner in the page's own unit square; v grows downwards.
    pub uv_min: [f32; 2],
    /// Largest corner.
    pub uv_max: [f32; 2],
}

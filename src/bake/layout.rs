//! Where a bake puts its texels, without a path traced: for pictures of the atlas, for tests and for benches.

use super::atlas::{Atlas, Chart};
use super::unwrap::{LaidOut, LaidOutMesh};
use super::workers::Workers;
use super::{BakeError, BakeSettings, BakeWarning, CancelToken, Placement};
use crate::scene::Scene;
use crate::trace::Compiled;

/// Where the texels of a scene lie.
#[derive(Clone, Debug, PartialEq)]
pub struct TexelLayout {
    /// Width and height of each page [texels].
    pub pages: Vec<[u32; 2]>,
    /// Where each object lies, ordered by id.
    pub placements: Vec<Placement>,
    /// Meshes that were given a UV1.
    pub meshes: Vec<LaidOutMesh>,
    /// What is at fault in the scene, and what was done about UV1.
    pub warnings: Vec<BakeWarning>,
}

impl TexelLayout {
    /// Lays out a scene as [`bake_lightmap`](super::bake_lightmap) does.
    ///
    /// # Errors
    ///
    /// [`BakeError::Settings`], [`BakeError::Threads`] and [`BakeError::Cancelled`].
    pub fn for_scene(scene: &Scene, settings: &BakeSettings, cancel: &CancelToken) -> Result<Self, BakeError> {
        settings.validate()?;
        let workers = Workers::new(settings.threads, &(), cancel)?;
        let laid_out = LaidOut::new(scene, settings, &workers)?;
        let Compiled { tracer, faults, .. } = Compiled::new(&laid_out.scene, &settings.transport);
        let atlas = Atlas::new(&laid_out, &tracer, settings, cancel)?;
        let faults = laid_out.without_solved(faults).into_iter().map(BakeWarning::from);
        let of_layout = Self::of(&laid_out, &atlas);
        Ok(Self { warnings: faults.chain(of_layout.warnings).collect(), ..of_layout })
    }

    /// What is laid out already.
    pub(super) fn of(laid_out: &LaidOut<'_>, atlas: &Atlas<'_>) -> Self {
        Self {
            pages: atlas.pages.clone(),
            placements: placements(laid_out, atlas),
            meshes: laid_out.meshes.clone(),
            warnings: laid_out.warnings.iter().chain(&atlas.warnings).cloned().collect(),
        }
    }
}

/// The meshes of a scene that need a UV1, with one.
///
/// # Errors
///
/// Those of [`TexelLayout::for_scene`].
pub fn unwrap_meshes(
    scene: &Scene,
    settings: &BakeSettings,
    cancel: &CancelToken,
) -> Result<Vec<LaidOutMesh>, BakeError> {
    settings.validate()?;
    let workers = Workers::new(settings.threads, &(), cancel)?;
    Ok(LaidOut::new(scene, settings, &workers)?.meshes)
}

/// Where each object lies, in the order of the atlas.
pub(super) fn placements(laid_out: &LaidOut<'_>, atlas: &Atlas<'_>) -> Vec<Placement> {
    let place = |chart: &Chart<'_>| {
        let [uv_min, uv_max] = corners(chart, atlas.pages[chart.page as usize]);
        let id = &laid_out.scene.instances[chart.receiver.instance].id;
        Placement { id: id.clone(), page: chart.page, uv_min, uv_max, mesh: laid_out.mesh_of.get(id).copied() }
    };
    atlas.charts.iter().map(place).collect()
}

/// Smallest and largest corner of an object's rectangle in the unit square of a page of this size.
pub(super) fn corners(chart: &Chart<'_>, page: [u32; 2]) -> [[f32; 2]; 2] {
    let uv = |texel: [u32; 2]| [0, 1].map(|axis| (f64::from(texel[axis]) / f64::from(page[axis])) as f32);
    [uv(chart.origin), uv([0, 1].map(|axis| chart.origin[axis] + chart.size[axis]))]
}

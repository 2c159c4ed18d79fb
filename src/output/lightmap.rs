//! A baked folder: the display maps, their previews, the measured layers if asked for, and last the manifest.

use super::safe_write::{Staged, make_folder};
use super::{OutputError, OutputFormat, TexelFormat, exr, ktx2, png};
use crate::artefact::{self, BakedLight, MANIFEST_FILE, MANIFEST_VERSION, Manifest};
use crate::bake::{BakeWarning, Lightmap, Page};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The unit of every texel, in the manifest's words.
const TEXEL_UNIT: &str = "E/pi [cd/m^2]";

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenLightmap {
    /// The files, in the order in which they took their places; the manifest is the last.
    pub files: Vec<PathBuf>,
    /// One [`BakeWarning::Clamped`] for each format that could not hold every value.
    pub warnings: Vec<BakeWarning>,
    /// Texels that the display maps could not hold as they are.
    pub clamped: u64,
}

/// Writes a lightmap into the folder `dir`, which is made if it is missing: `lightmap_<page>.ktx2` to display,
/// `lightmap_<page>.png` to look at, with [`OutputFormat::Exr`] `lightmap_<page>.exr` to measure with, and
/// `kiln.ron`, which says where each object lies. `scene_name` is the caller's own word for the scene.
///
/// All files are complete on the disk before the first takes its place, and the manifest takes its place last: what
/// fails before leaves the folder as it was.
pub fn write_lightmap(
    lightmap: &Lightmap,
    scene_name: &str,
    dir: &Path,
    format: OutputFormat,
) -> Result<WrittenLightmap, OutputError> {
    check(lightmap, dir)?;
    make_folder(dir)?;
    let texel_format = format.texel_format();
    let mut staged = Vec::new();
    let mut clamped = 0;
    let mut clamped_in_exr = 0;
    for (index, page) in lightmap.pages.iter().enumerate() {
        let encoded = ktx2::ktx2_bytes(page, texel_format);
        clamped += encoded.clamped;
        staged.push(Staged::write(&dir.join(page_file(index, "ktx2")), |file| file.write_all(&encoded.bytes))?);
        staged.push(Staged::write(&dir.join(page_file(index, "png")), |file| png::write_preview(page, file))?);
        if matches!(format, OutputFormat::Exr) {
            clamped_in_exr += exr::count_clamped(page);
            staged.push(Staged::write(&dir.join(page_file(index, "exr")), |file| exr::write_page(page, file))?);
        }
    }
    let manifest = manifest(lightmap, scene_name).to_ron();
    staged.push(Staged::write(&dir.join(MANIFEST_FILE), |file| file.write_all(manifest.as_bytes()))?);
    let files = staged.into_iter().map(Staged::place).collect::<Result<_, _>>()?;
    Ok(WrittenLightmap { files, warnings: warnings(texel_format, clamped, clamped_in_exr), clamped })
}

fn page_file(index: usize, extension: &str) -> String {
    format!("lightmap_{index}.{extension}")
}

fn warnings(format: TexelFormat, clamped: u64, clamped_in_exr: u64) -> Vec<BakeWarning> {
    let display = BakeWarning::Clamped { texels: clamped, format: format.name(), limit: format.limit() };
    let exr = BakeWarning::Clamped { texels: clamped_in_exr, format: "exr", limit: f32::MAX };
    [(clamped, display), (clamped_in_exr, exr)]
        .into_iter()
        .filter_map(|(texels, warning)| (texels > 0).then_some(warning))
        .collect()
}

fn manifest(lightmap: &Lightmap, scene_name: &str) -> Manifest {
    let page = |(index, page): (usize, &Page)| {
        let (width, height) = ktx2::stored_size(page);
        artefact::Page { file: page_file(index, "ktx2"), width, height }
    };
    let placements = lightmap.placements.iter().map(|placement| artefact::Placement {
        id: placement.id.clone(),
        page: placement.page,
        uv_min: placement.uv_min,
        uv_max: placement.uv_max,
    });
    Manifest {
        version: MANIFEST_VERSION,
        generator: concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).to_owned(),
        scene: scene_name.to_owned(),
        texel_unit: TEXEL_UNIT.to_owned(),
        pages: lightmap.pages.iter().enumerate().map(page).collect(),
        placements: placements.collect(),
        baked_lights: lightmap.baked_lights.iter().map(|id| BakedLight { id: id.clone() }).collect(),
    }
}

/// Refuses what no file could say.
fn check(lightmap: &Lightmap, dir: &Path) -> Result<(), OutputError> {
    for (index, page) in lightmap.pages.iter().enumerate() {
        let texels = page.width as usize * page.height as usize;
        let lengths = [page.radiance.len(), page.coverage.len(), page.raw.len(), page.stderr.len()];
        if texels == 0 || lengths != [texels; 4] {
            let reason = format!("a page of {} × {} texels has layers of {lengths:?}", page.width, page.height);
            return Err(OutputError::Malformed { path: dir.join(page_file(index, "ktx2")), reason });
        }
    }
    match lightmap.placements.iter().find(|placement| placement.page as usize >= lightmap.pages.len()) {
        Some(placement) => Err(OutputError::Malformed {
            path: dir.join(MANIFEST_FILE),
            reason: format!("\"{}\" lies on page {}, which is not there", placement.id, placement.page),
        }),
        None => Ok(()),
    }
}

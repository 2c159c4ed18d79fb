//! A baked folder: the display maps, their previews, the measured layers if asked for, the meshes that were laid out
//! anew, and last the manifest.

use super::compression::{CompressionError, Losses};
use super::safe_write::{Staged, make_folder};
use super::volume::{VolumeTexture, volume_format};
use super::{OutputError, OutputFormat, TexelFormat, cost, exr, ktx2, overview, png, texel_bytes};
use crate::artefact::{
    self, BakedLight, MANIFEST_FILE, MANIFEST_VERSION, MESHES_FILE, Manifest, MeshLayout, MeshLayoutError,
};
use crate::bake::{BakeWarning, Lightmap, Page, Placement, Volume};
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
    /// What the display maps lost to compression; `None` for formats without.
    pub compression: Option<CompressionError>,
}

/// Writes a lightmap into the folder `dir`, which is made if it is missing: `lightmap_<page>.ktx2` to display,
/// `lightmap_<page>.png` to look at, `overview_<page>.png` to see how the page is used, `cost_<page>.png` to see where
/// the paths went, with [`OutputFormat::Exr`] `lightmap_<page>.exr` to measure with, `meshes.kiln` if the bake laid
/// meshes out anew, and `kiln.ron`, which says where each object lies. `scene_name` is the caller's own word for the
/// scene.
///
/// All files are complete on the disk before the first takes its place, and the manifest takes its place last: what
/// fails before leaves the folder as it was.
pub fn write_lightmap(
    lightmap: &Lightmap,
    scene_name: &str,
    dir: &Path,
    format: OutputFormat,
) -> Result<WrittenLightmap, OutputError> {
    write_bake(lightmap, &[], scene_name, dir, format)
}

/// The same with irradiance volumes, each in a `volume_<number>.ktx2`.
pub fn write_bake(
    lightmap: &Lightmap,
    volumes: &[Volume],
    scene_name: &str,
    dir: &Path,
    format: OutputFormat,
) -> Result<WrittenLightmap, OutputError> {
    check(lightmap, dir)?;
    let meshes = meshes(lightmap, dir)?;
    make_folder(dir)?;
    let texel_format = format.texel_format();
    let mut staged = Vec::new();
    let mut clamped = 0;
    let mut clamped_in_exr = 0;
    let mut losses = Losses::of(&lightmap.pages, texel_format);
    for (index, page) in lightmap.pages.iter().enumerate() {
        let encoded = texel_bytes(page, texel_format);
        clamped += encoded.clamped;
        if let Some(losses) = &mut losses {
            losses.add(page, &encoded.bytes);
        }
        let map = ktx2::file_of(page, texel_format, encoded.bytes);
        staged.push(Staged::write(&dir.join(page_file(index, "ktx2")), |file| file.write_all(&map))?);
        staged.push(Staged::write(&dir.join(page_file(index, "png")), |file| png::write_preview(page, file))?);
        staged.push(Staged::write(&dir.join(overview_file(index)), |file| overview::write_overview(page, file))?);
        staged.push(Staged::write(&dir.join(format!("cost_{index}.png")), |file| cost::write_cost(page, file))?);
        if matches!(format, OutputFormat::Exr) {
            clamped_in_exr += exr::count_clamped(page);
            staged.push(Staged::write(&dir.join(page_file(index, "exr")), |file| exr::write_page(page, file))?);
        }
    }
    for (index, volume) in volumes.iter().enumerate() {
        let (texture, format) = (VolumeTexture::new(volume), volume_format(texel_format));
        let encoded = texture.bytes(format);
        clamped += encoded.clamped;
        let file = ktx2::file_of_volume(&texture, format, &encoded.bytes);
        staged.push(Staged::write(&dir.join(volume_file(index)), |out| out.write_all(&file))?);
    }
    if let Some(meshes) = meshes {
        staged.push(Staged::write(&dir.join(MESHES_FILE), |file| file.write_all(&meshes))?);
    }
    let manifest = manifest(lightmap, volumes, scene_name, texel_format).to_ron();
    staged.push(Staged::write(&dir.join(MANIFEST_FILE), |file| file.write_all(manifest.as_bytes()))?);
    let files = staged.into_iter().map(Staged::place).collect::<Result<_, _>>()?;
    let compression = losses.map(|losses| losses.error());
    Ok(WrittenLightmap { files, warnings: warnings(texel_format, clamped, clamped_in_exr), clamped, compression })
}

fn volume_file(index: usize) -> String {
    format!("volume_{index}.ktx2")
}

fn overview_file(index: usize) -> String {
    format!("overview_{index}.png")
}

fn page_file(index: usize, extension: &str) -> String {
    format!("lightmap_{index}.{extension}")
}

/// The file of the meshes that were laid out anew, if there are any.
fn meshes(lightmap: &Lightmap, dir: &Path) -> Result<Option<Vec<u8>>, OutputError> {
    if lightmap.meshes.is_empty() {
        return Ok(None);
    }
    let layouts: Vec<MeshLayout> = lightmap.meshes.iter().map(MeshLayout::from).collect();
    let malformed =
        |reason: MeshLayoutError| OutputError::Malformed { path: dir.join(MESHES_FILE), reason: reason.to_string() };
    MeshLayout::write_all(&layouts).map(Some).map_err(malformed)
}

fn warnings(format: TexelFormat, clamped: u64, clamped_in_exr: u64) -> Vec<BakeWarning> {
    let display = BakeWarning::Clamped { texels: clamped, format: format.name(), limit: format.limit() };
    let exr = BakeWarning::Clamped { texels: clamped_in_exr, format: "exr", limit: f32::MAX };
    [(clamped, display), (clamped_in_exr, exr)]
        .into_iter()
        .filter_map(|(texels, warning)| (texels > 0).then_some(warning))
        .collect()
}

fn manifest(lightmap: &Lightmap, volumes: &[Volume], scene_name: &str, format: TexelFormat) -> Manifest {
    let page = |(index, page): (usize, &Page)| {
        let (width, height) = ktx2::stored_size(page, format);
        artefact::Page { file: page_file(index, "ktx2"), width, height }
    };
    let placement = |placement: &Placement| {
        let page = &lightmap.pages[placement.page as usize];
        let within = |uv| within_stored(uv, page, format);
        artefact::Placement {
            id: placement.id.clone(),
            page: placement.page,
            uv_min: within(placement.uv_min),
            uv_max: within(placement.uv_max),
            mesh: placement.mesh.and_then(|mesh| u32::try_from(mesh).ok()),
        }
    };
    Manifest {
        version: MANIFEST_VERSION,
        generator: concat!(env!("CARGO_PKG_NAME"), " ", env!("CARGO_PKG_VERSION")).to_owned(),
        scene: scene_name.to_owned(),
        texel_unit: TEXEL_UNIT.to_owned(),
        pages: lightmap.pages.iter().enumerate().map(page).collect(),
        placements: lightmap.placements.iter().map(placement).collect(),
        meshes: (!lightmap.meshes.is_empty()).then(|| MESHES_FILE.to_owned()),
        baked_lights: lightmap.baked_lights.iter().map(|id| BakedLight { id: id.clone() }).collect(),
        volumes: volumes.iter().enumerate().map(|(index, volume)| entry(index, volume)).collect(),
        things: lightmap.report.fingerprints.clone(),
    }
}

/// What the manifest says of a volume.
fn entry(index: usize, volume: &Volume) -> artefact::Volume {
    artefact::Volume {
        id: volume.id.clone(),
        file: volume_file(index),
        centre: volume.centre.to_array(),
        rotation: volume.rotation.to_array(),
        size: volume.size.to_array(),
        falloff: volume.falloff,
    }
}

/// A place on a page as a place on the texture that stores it, which may be larger.
fn within_stored(uv: [f32; 2], page: &Page, format: TexelFormat) -> [f32; 2] {
    let stored = format.stored_size(page);
    let share = |length: u32, stored: u32| f64::from(length) / f64::from(stored.max(1));
    let [u, v] = uv.map(f64::from);
    [(u * share(page.width, stored[0])) as f32, (v * share(page.height, stored[1])) as f32]
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
    let malformed = |reason| Err(OutputError::Malformed { path: dir.join(MANIFEST_FILE), reason });
    for placement in &lightmap.placements {
        if placement.page as usize >= lightmap.pages.len() {
            return malformed(format!("\"{}\" lies on page {}, which is not there", placement.id, placement.page));
        }
        if let Some(mesh) = placement.mesh.filter(|&mesh| mesh >= lightmap.meshes.len()) {
            return malformed(format!("\"{}\" has mesh {mesh}, which is not there", placement.id));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::test_pages::{cut_quad, lightmap, names, page, strange_page};
    use super::*;
    use crate::artefact::{MeshHash, StableId};
    use crate::bake::LaidOutMesh;
    use std::fs;

    #[test]
    fn a_folder_holds_maps_previews_and_manifest() {
        let folder = temp_dir::TempDir::new().unwrap();
        let dir = folder.path().join("baked/room");
        let lightmap = lightmap(vec![page(8, 4), page(4, 16)]);
        let written = write_lightmap(&lightmap, "room.glb", &dir, OutputFormat::Rgba16f).unwrap();
        let expected = [
            "lightmap_0.ktx2",
            "lightmap_0.png",
            "overview_0.png",
            "cost_0.png",
            "lightmap_1.ktx2",
            "lightmap_1.png",
            "overview_1.png",
            "cost_1.png",
            "kiln.ron",
        ]
        .map(|n| dir.join(n));
        assert_eq!(
            written,
            WrittenLightmap { files: expected.to_vec(), warnings: vec![], clamped: 0, compression: None }
        );
        assert_eq!(names(&dir).len(), 9);

        let manifest = Manifest::from_ron(&fs::read_to_string(dir.join(MANIFEST_FILE)).unwrap()).unwrap();
        assert_eq!(manifest.scene, "room.glb");
        assert_eq!(manifest.texel_unit, "E/pi [cd/m^2]");
        assert!(manifest.generator.starts_with("bevy_kiln 0."), "{}", manifest.generator);
        assert_eq!(manifest.pages[1], artefact::Page { file: "lightmap_1.ktx2".into(), width: 4, height: 16 });
        assert_eq!(manifest.baked_lights, [BakedLight { id: StableId::new("lamp") }]);
        let placement = artefact::Placement {
            id: StableId::new("room/part 1"),
            page: 1,
            uv_min: [0.0, 0.25],
            uv_max: [0.5, 1.0],
            mesh: None,
        };
        assert_eq!(manifest.placements[1], placement);
        let map = fs::read(dir.join(&manifest.pages[1].file)).unwrap();
        assert_eq!(map, ktx2::ktx2_bytes(&lightmap.pages[1], TexelFormat::Rgba16f).bytes);
    }

    #[test]
    fn compressed_maps_say_what_they_lost_and_where_objects_lie_on_them() {
        let folder = temp_dir::TempDir::new().unwrap();
        let lightmap = lightmap(vec![page(8, 4), page(6, 30)]);
        let written = write_lightmap(&lightmap, "a", folder.path(), OutputFormat::Bc6h).unwrap();
        let error = written.compression.unwrap();
        assert!(error.rms > 0.0 && error.rms < 0.1 && error.worst < 0.3, "{error:?}");
        let manifest = Manifest::from_ron(&fs::read_to_string(folder.path().join(MANIFEST_FILE)).unwrap()).unwrap();
        assert_eq!(manifest.pages[1], artefact::Page { file: "lightmap_1.ktx2".into(), width: 8, height: 32 });
        assert_eq!((manifest.placements[0].uv_min, manifest.placements[0].uv_max), ([0.0, 0.25], [0.5, 1.0]));
        // The page is 6/8 and 30/32 of its texture.
        assert_eq!((manifest.placements[1].uv_min, manifest.placements[1].uv_max), ([0.0, 0.234375], [0.375, 0.9375]));
    }

    #[test]
    fn meshes_that_were_laid_out_anew_come_with_it() {
        let folder = temp_dir::TempDir::new().unwrap();
        let mut lightmap = lightmap(vec![page(8, 4), page(4, 16)]);
        lightmap.meshes = vec![LaidOutMesh { hash: MeshHash::of([], []), ..cut_quad() }, cut_quad()];
        lightmap.placements[1].mesh = Some(1);
        let written = write_lightmap(&lightmap, "a", folder.path(), OutputFormat::Rgb9e5).unwrap();
        let last: Vec<_> = written.files.iter().rev().take(2).map(|file| file.file_name().unwrap()).collect();
        assert_eq!(last, [MANIFEST_FILE, MESHES_FILE]);
        let manifest = Manifest::from_ron(&fs::read_to_string(folder.path().join(MANIFEST_FILE)).unwrap()).unwrap();
        assert_eq!(manifest.meshes.as_deref(), Some(MESHES_FILE));
        assert_eq!([manifest.placements[0].mesh, manifest.placements[1].mesh], [None, Some(1)]);
        let layouts = MeshLayout::read_all(&fs::read(folder.path().join(MESHES_FILE)).unwrap()).unwrap();
        assert_eq!(layouts.len(), 2);
        assert_eq!(layouts[1].vertices, [0, 1, 2, 2, 1, 3]);
        assert_eq!(layouts[1].uv1[4], [1.0, 0.5]);
        assert_eq!((layouts[1].hash, layouts[1].indices.len()), (cut_quad().hash, 6));
    }

    #[test]
    fn meshes_that_contradict_themselves_are_not_written() {
        let folder = temp_dir::TempDir::new().unwrap();
        let dir = folder.path().join("baked");
        let mut missing = lightmap(vec![page(8, 4)]);
        missing.placements[0].mesh = Some(0);
        let mut short = missing.clone();
        short.meshes = vec![cut_quad()];
        short.meshes[0].uv1.pop();
        for (lightmap, file, reason) in [
            (missing, MANIFEST_FILE, "mesh 0, which is not there"),
            (short, MESHES_FILE, "5 coordinates for 6 vertices"),
        ] {
            let error = write_lightmap(&lightmap, "a", &dir, OutputFormat::Rgb9e5).unwrap_err();
            assert!(matches!(&error, OutputError::Malformed { path, .. } if *path == dir.join(file)), "{error}");
            assert!(error.to_string().contains(reason), "{error}");
            assert!(!dir.exists());
        }
    }

    #[test]
    fn exr_comes_besides_the_usual_maps() {
        let (folder, other) = (temp_dir::TempDir::new().unwrap(), temp_dir::TempDir::new().unwrap());
        let lightmap = lightmap(vec![page(8, 4)]);
        write_lightmap(&lightmap, "a", folder.path(), OutputFormat::Exr).unwrap();
        write_lightmap(&lightmap, "a", other.path(), OutputFormat::Rgb9e5).unwrap();
        assert_eq!(
            names(folder.path()),
            ["cost_0.png", "kiln.ron", "lightmap_0.exr", "lightmap_0.ktx2", "lightmap_0.png", "overview_0.png"]
        );
        for name in names(other.path()) {
            assert_eq!(fs::read(folder.path().join(&name)).unwrap(), fs::read(other.path().join(&name)).unwrap());
        }
    }

    #[test]
    fn what_does_not_fit_is_reported() {
        let folder = temp_dir::TempDir::new().unwrap();
        let lightmap = lightmap(vec![page(4, 4), strange_page()]);
        let write = |format| write_lightmap(&lightmap, "a", folder.path(), format).unwrap();
        let shared = BakeWarning::Clamped { texels: 4, format: "rgb9e5", limit: 65408.0 };
        let half = BakeWarning::Clamped { texels: 5, format: "rgba16f", limit: 65504.0 };
        let exr = BakeWarning::Clamped { texels: 4, format: "exr", limit: f32::MAX };
        assert_eq!(
            (write(OutputFormat::Rgb9e5).warnings, write(OutputFormat::Rgb9e5).clamped),
            (vec![shared.clone()], 4)
        );
        assert_eq!((write(OutputFormat::Rgba16f).warnings, write(OutputFormat::Rgba16f).clamped), (vec![half], 5));
        assert_eq!(write(OutputFormat::Exr).warnings, [shared, exr]);
    }

    #[test]
    fn a_write_that_fails_leaves_the_old_bake_whole() {
        let folder = temp_dir::TempDir::new().unwrap();
        let dir = folder.path();
        write_lightmap(&lightmap(vec![page(8, 4)]), "old", dir, OutputFormat::Rgb9e5).unwrap();
        let old: Vec<_> = names(dir).into_iter().map(|name| (fs::read(dir.join(&name)).unwrap(), name)).collect();

        let short = Page { height: 5, ..page(8, 4) };
        let mut nowhere = lightmap(vec![page(4, 4)]);
        nowhere.placements[0].page = 1;
        for (malformed, named) in [
            (lightmap(vec![page(4, 4), short]), "lightmap_1.ktx2"),
            (lightmap(vec![Page { width: 0, ..page(4, 4) }]), "lightmap_0.ktx2"),
            (nowhere, MANIFEST_FILE),
        ] {
            let error = write_lightmap(&malformed, "new", dir, OutputFormat::Exr).unwrap_err();
            assert!(matches!(&error, OutputError::Malformed { path, .. } if *path == dir.join(named)), "{error}");
        }
        // Two other pages, of which the second has no place.
        fs::create_dir(dir.join("lightmap_1.ktx2")).unwrap();
        let error = write_lightmap(&lightmap(vec![page(4, 8); 2]), "new", dir, OutputFormat::Rgb9e5).unwrap_err();
        assert!(matches!(&error, OutputError::Replace { path, .. } if *path == dir.join("lightmap_1.ktx2")), "{error}");
        fs::remove_dir(dir.join("lightmap_1.ktx2")).unwrap();
        let now: Vec<_> = names(dir).into_iter().map(|name| (fs::read(dir.join(&name)).unwrap(), name)).collect();
        assert_eq!(now, old);
    }

    #[test]
    fn a_file_in_the_place_of_the_folder_is_named() {
        let folder = temp_dir::TempDir::new().unwrap();
        let dir = folder.path().join("baked");
        fs::write(&dir, "kept").unwrap();
        let result = write_lightmap(&lightmap(vec![page(4, 4)]), "a", &dir, OutputFormat::Rgb9e5);
        assert_eq!(result, Err(OutputError::FolderIsFile { path: dir.clone() }));
        assert_eq!(fs::read_to_string(&dir).unwrap(), "kept");
    }
}

//! What the tests of the encoders share: pages, and what lies in a folder.

use crate::artefact::{MeshHash, StableId};
use crate::bake::{BakeReport, LaidOutMesh, Lightmap, Page, Placement, TexelState};
use glam::{Vec2, Vec3};
use std::fs;
use std::path::Path;

/// A page of smooth values, different in every texel and layer; the last texel of each row is uncovered.
pub(super) fn page(width: u32, height: u32) -> Page {
    let texel = |index: u32| {
        let (x, y) = (index % width, index / width);
        Vec3::new(1.5 + x as f32, 20.0 + y as f32 * 3.25, 0.125 * (x + y) as f32)
    };
    let texels = 0..width * height;
    Page {
        width,
        height,
        radiance: texels.clone().map(texel).collect(),
        coverage: texels.clone().map(|index| if (index + 1) % width == 0 { 0.0 } else { 0.75 }).collect(),
        raw: texels.clone().map(|index| texel(index) * 1.01).collect(),
        stderr: texels.clone().map(|index| texel(index) * 0.02).collect(),
        state: vec![TexelState::Measured; (width * height) as usize],
        chart: vec![1; (width * height) as usize],
        ..Page::default()
    }
}

/// A page whose first five texels hold, in turn, what is not a number, infinity, a negative value, 1e9 and a
/// coverage that is not a number.
pub(super) fn strange_page() -> Page {
    let mut page = page(4, 4);
    page.coverage.fill(1.0);
    page.radiance[0] = Vec3::new(f32::NAN, 1.0, 2.0);
    page.radiance[1] = Vec3::new(f32::INFINITY, f32::NEG_INFINITY, 0.0);
    page.radiance[2] = Vec3::new(1.0, -1.0, 1.0);
    page.radiance[3] = Vec3::splat(1e9);
    page.radiance[4] = Vec3::new(1.0, 2.0, 3.0);
    page.coverage[4] = f32::NAN;
    page
}

/// A lightmap of these pages with one object on each.
pub(super) fn lightmap(pages: Vec<Page>) -> Lightmap {
    let placements = (0..pages.len() as u32)
        .map(|page| Placement {
            id: StableId::new(format!("room/part {page}")),
            page,
            uv_min: [0.0, 0.25],
            uv_max: [0.5, 1.0],
            mesh: None,
        })
        .collect();
    let baked_lights = vec![StableId::new("lamp")];
    Lightmap { pages, placements, meshes: Vec::new(), baked_lights, report: BakeReport::default() }
}

/// A quad, cut along its diagonal.
pub(super) fn cut_quad() -> LaidOutMesh {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    LaidOutMesh {
        source: 0,
        hash: MeshHash::of(positions, [[0, 1, 2], [2, 1, 3]]),
        vertices: vec![0, 1, 2, 2, 1, 3],
        uv1: [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 1.0], [1.0, 0.5], [1.0, 1.0]].map(Vec2::from).to_vec(),
        indices: vec![0, 1, 2, 3, 4, 5],
        charts: 2,
        ..LaidOutMesh::default()
    }
}

/// The names of what lies in a folder, sorted.
pub(super) fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

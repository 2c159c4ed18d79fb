//! Watching a bake: the whole map in coarse first, then texels as they are measured, near ones before far ones. What is seen so is
//! for the eye; nothing of it changes a finished texel.

use super::Lightmap;
use super::sites::Site;
use super::tiles::Tile;
use glam::Vec3;

/// Paths of each texel before the first picture: one in each run.
pub(super) const PREVIEW_PATHS: u32 = super::REPLICATES;

/// Sees a bake's texels as they are measured, from any of its threads. Be quick: what takes long holds the bake up.
pub trait LiveSink: Sync {
    /// From where it is watched [m]: texels near it are measured first. Asked once.
    fn viewpoint(&self) -> Option<Vec3> {
        None
    }

    /// The whole map by a few paths, repaired but for seams, without a report. Once, before any texel is measured in full;
    /// in a bake that keeps texels of the one before, these are in it. Sizes, places and meshes are those of the
    /// finished map.
    fn preview(&self, coarse: Lightmap);

    /// Texels of a page that are measured, before repair: places row by row, and E/π [cd/m²].
    fn measured(&self, page: u32, texels: &[(u32, Vec3)]);
}

/// Puts tiles near a place first.
pub(super) fn nearest_first(tiles: &mut [&Tile], sites: &[Site], viewpoint: Vec3) {
    let distance = |tile: &&Tile| {
        let of = |&site: &u32| sites[site as usize].footing.anchor.position().distance_squared(viewpoint);
        tile.sites.iter().map(of).fold(f32::INFINITY, f32::min)
    };
    tiles.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
}

//! Baking a scene again and again, as an editor does: what a change does not reach is kept.
//!
//! Owns what is remembered of a bake, and when it may be used: for the same settings, tile by tile where the same texels
//! are there again. `reach` says which tiles a change reaches. A tile that is measured again has the very bits that it
//! would have in a bake from nothing; one that is kept is off by no more than a stated part of the error that was asked
//! for ([`reach::ALLOWED`]), however many changes come one after another. Repair is done anew for all: it is no light.

mod reach;

use super::gather::Estimate;
use super::lightmap::{Measured, bake};
use super::sites::Site;
use super::tiles::{Tile, Until};
use super::workers::Workers;
use super::{BakeError, BakeSettings, CancelToken, Lightmap, ProgressSink};
use crate::scene::Scene;
use crate::trace::Tracer;
use reach::Reach;
use std::collections::BTreeMap;

/// Bakes a scene, remembers it, and bakes again only what a change of it reaches.
///
/// The first bake is that of [`bake_lightmap`](super::bake_lightmap). What is remembered takes about as much memory as
/// the bake did, and goes with the baker or by [`Baker::forget`].
#[derive(Default)]
pub struct Baker {
    earlier: Option<Earlier>,
}

/// What is remembered of a bake.
pub(super) struct Earlier {
    /// As laid out.
    scene: Scene,
    settings: BakeSettings,
    until: Until,
    measured: Measured,
}

/// What of an earlier bake holds for this one.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    /// In the order of the tile's texels.
    pub(super) estimates: Vec<Estimate>,
    /// By how much of the error that was asked for changes may have moved it since it was measured.
    pub(super) drift: f64,
}

/// What a bake is about to measure.
#[derive(Clone, Copy)]
pub(super) struct Upcoming<'a> {
    pub(super) scene: &'a Scene,
    pub(super) settings: &'a BakeSettings,
    pub(super) tracer: &'a Tracer,
    pub(super) sites: &'a [Site],
    pub(super) tiles: &'a [Tile],
    pub(super) until: Until,
}

impl std::fmt::Debug for Baker {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let texels = self.earlier.as_ref().map(|earlier| earlier.measured.sites.len());
        f.debug_struct("Baker").field("remembered_texels", &texels).finish()
    }
}

impl Baker {
    /// Bakes a lightmap of a scene. Where the last bake was of the same settings (but for the number of threads), texels
    /// are kept whose light has not changed; [`BakeReport::kept`](super::BakeReport::kept) says how many. A bake that
    /// fails or is cancelled leaves the memory of the one before.
    ///
    /// # Errors
    ///
    /// Those of [`bake_lightmap`](super::bake_lightmap).
    pub fn bake(
        &mut self,
        scene: &Scene,
        settings: &BakeSettings,
        progress: &dyn ProgressSink,
        cancel: &CancelToken,
    ) -> Result<Lightmap, BakeError> {
        let usable = self.earlier.as_ref().filter(|earlier| is_alike(&earlier.settings, settings));
        let (lightmap, scene, until, measured) = bake(scene, settings, usable, progress, cancel)?;
        self.earlier = Some(Earlier { scene: scene.into_owned(), settings: settings.clone(), until, measured });
        Ok(lightmap)
    }

    /// Forgets the last bake, and gives its memory back. The next one measures everything.
    pub fn forget(&mut self) {
        self.earlier = None;
    }
}

/// Whether two bakes ask for the same texels.
fn is_alike(a: &BakeSettings, b: &BakeSettings) -> bool {
    BakeSettings { threads: None, ..a.clone() } == BakeSettings { threads: None, ..b.clone() }
}

impl Earlier {
    /// How well its texels are known.
    pub(super) fn until(&self) -> Until {
        self.until
    }

    /// What holds for each tile of another bake.
    pub(super) fn kept(&self, upcoming: &Upcoming<'_>, workers: &Workers<'_>) -> Result<Vec<Option<Kept>>, BakeError> {
        let reach = Reach::new(self, upcoming);
        let key = |tile: &Tile, sites: &[Site]| sites[tile.sites[0] as usize].covered.key;
        let known: BTreeMap<u64, usize> = self
            .measured
            .tiles
            .iter()
            .enumerate()
            .map(|(number, tile)| (key(tile, &self.measured.sites), number))
            .collect();
        workers.gather_quietly(upcoming.tiles, |tile, cancel| {
            let Some(&number) = known.get(&key(tile, upcoming.sites)) else { return Some(None) };
            let before = &self.measured.tiles[number];
            if !self.has_the_texels_of(before, tile, upcoming.sites) {
                return Some(None);
            }
            let drift = self.measured.drift[number];
            let moved = reach.moved(before, tile, drift, cancel)?;
            Some(moved.map(|moved| Kept {
                estimates: before.sites.iter().map(|&site| self.measured.estimates[site as usize]).collect(),
                drift: drift + moved,
            }))
        })
    }

    /// Whether a tile is of the same texels, in the same company.
    fn has_the_texels_of(&self, before: &Tile, tile: &Tile, sites: &[Site]) -> bool {
        let keys = |tile: &Tile, sites: &[Site]| -> Vec<u64> {
            tile.sites.iter().map(|&site| sites[site as usize].covered.key).collect()
        };
        before.is_arranged_as(tile) && keys(before, &self.measured.sites) == keys(tile, sites)
    }
}

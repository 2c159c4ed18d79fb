//! Texels sampled tile by tile, each until it is known well enough.
//!
//! A tile is a square of texels of one object. Its texels are sampled in rounds, two of which double their paths; a
//! texel whose interval is narrow enough takes no part in the next. Nothing but a tile's own texels has a say in that,
//! so threads and the order of tiles cannot matter, and no more runs are held than those of the tiles in work. Texels
//! that share their paths (`together`) go on until the last of them is done: what it takes to know that one is a number
//! of paths, whoever's they are, and the others gain by it.
//!
//! The interval of a texel goes by the spread of its runs. By chance a spread comes out too small: where a path in
//! thousands brings all the light, most runs agree that there is none. And who looks after each round and stops at the
//! first small spread picks just these (Wald 1945 on tests that look again and again). So the variance of a texel
//! counts as no smaller than the mean over it and those around it in its tile and chart, each scaled to the texel's
//! number of paths: nine texels together have 135 degrees of freedom, which are not small by chance. Where a texel is
//! noisier than those around it its own variance stands. How many standard errors that makes is `quantile`'s.
//!
//! A texel that comes out bright by chance would be allowed a larger error, stop, and stay too bright. What an error is
//! relative to is therefore the mean over those around it, as far as the texel's own interval allows.
//! `tests/calibration` holds what comes of all this against long references.

mod quantile;
mod together;

pub(super) use quantile::Looks;
use together::{carry_on, groups};

use super::CancelToken;
use super::gather::{Estimate, Runs};
use super::sites::Site;
use crate::math::luminance;
use crate::trace::{Sharing, Tracer, Transport};
use std::collections::BTreeMap;

/// Side of a tile [texels].
const SIDE: u32 = 16;

/// Paths of the first round: four in each run, or their spread is no variance to speak of.
pub(super) const LEAST_PATHS: u32 = 64;

/// The most paths that a texel gets.
pub(super) const MOST_PATHS: u32 = 1 << 20;

/// Paths of the round after the one of so many: half as many more, then a third, so that two rounds double them. A
/// round that doubled them alone would leave a texel with 1.44 times the paths that it needs in the mean; these leave
/// 1.2.
pub(super) fn after(paths: u32) -> u32 {
    if paths.is_power_of_two() { paths / 2 * 3 } else { paths / 3 * 4 }
}

/// How well texels are to be known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Until {
    /// By so many paths.
    Samples(u32),
    /// To this error.
    Error(ErrorTarget),
}

/// How far off a texel may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ErrorTarget {
    /// Half-width of the 95 % interval over the value.
    pub(super) relative: f64,
    /// What the value counts as at least [cd/m²].
    pub(super) floor: f64,
}

impl ErrorTarget {
    /// Whether a texel is known well enough.
    pub(super) fn is_met(self, estimate: &Estimate) -> bool {
        estimate.half_width <= self.relative * self.value(estimate)
    }

    /// What the error of a texel is relative to [cd/m²].
    pub(super) fn value(self, estimate: &Estimate) -> f64 {
        estimate.level.max(self.floor)
    }
}

/// Texels near each other.
#[derive(Clone, Debug, Default)]
pub(super) struct Tile {
    /// By number in the list of sites.
    pub(super) sites: Vec<u32>,
    /// Of each, the places in the tile of those around it in its chart.
    around: Vec<Vec<u16>>,
    /// Places in the tile, in their order, of those that trace together.
    groups: Vec<Vec<u16>>,
}

/// All tiles, in an order of chance: of any first part of it the rest can be told.
pub(super) fn tiles(sites: &[Site], sharing: Sharing) -> Vec<Tile> {
    let mut by_place: BTreeMap<[u32; 4], Vec<u32>> = BTreeMap::new();
    for (number, Site { covered, .. }) in sites.iter().enumerate() {
        let [x, y] = covered.place.map(|along| along / SIDE);
        by_place.entry([covered.page, covered.receiver, y, x]).or_default().push(number as u32);
    }
    let mut tiles: Vec<Tile> = by_place.into_values().map(|of_tile| Tile::new(of_tile, sites, sharing)).collect();
    // Keys of texels are hashes.
    tiles.sort_by_key(|tile| sites[tile.sites[0] as usize].covered.key);
    tiles
}

impl Tile {
    fn new(of_tile: Vec<u32>, sites: &[Site], sharing: Sharing) -> Self {
        let covered = |number: u32| &sites[number as usize].covered;
        let is_beside = |a: u32, b: u32| {
            let [a, b] = [a, b].map(covered);
            a.chart == b.chart && (0..2).all(|axis| a.place[axis].abs_diff(b.place[axis]) <= 1)
        };
        let of_one = |&one: &u32| {
            let others = of_tile.iter().enumerate().filter(|&(_, &other)| other != one && is_beside(one, other));
            others.map(|(place, _)| place as u16).collect()
        };
        let groups = groups(of_tile.iter().map(|&number| covered(number).place), sharing);
        Self { around: of_tile.iter().map(of_one).collect(), sites: of_tile, groups }
    }

    /// Whether texels lie around each other and trace together as in another tile.
    pub(super) fn is_arranged_as(&self, other: &Self) -> bool {
        self.around == other.around && self.groups == other.groups
    }

    /// Groups of those that trace together, by their places in the tile.
    pub(super) fn groups(&self) -> impl Iterator<Item = impl Iterator<Item = usize> + '_> {
        self.groups.iter().map(|group| group.iter().map(|&place| place.into()))
    }

    /// Measures its texels, in their order; `None` if cancelled.
    pub(super) fn measure(
        &self,
        sites: &[Site],
        tracer: &Tracer,
        until: Until,
        transport: &Transport,
        cancel: &CancelToken,
    ) -> Option<Vec<Estimate>> {
        let mut rounds = Rounds::new(self, sites, tracer, transport);
        match until {
            Until::Samples(count) => {
                rounds.sample(count, |_| true, cancel)?;
                rounds.pool(Looks::One);
            }
            Until::Error(target) => {
                let mut paths = LEAST_PATHS;
                while paths <= MOST_PATHS {
                    let is_open: Vec<bool> = rounds
                        .estimates
                        .iter()
                        .map(|estimate| paths == LEAST_PATHS || !target.is_met(estimate))
                        .collect();
                    if !is_open.contains(&true) {
                        break;
                    }
                    rounds.sample(paths, |place| is_open[place], cancel)?;
                    rounds.pool(Looks::Many);
                    paths = after(paths);
                }
            }
        }
        Some(rounds.estimates)
    }
}

/// A tile in work.
pub(super) struct Rounds<'a> {
    tile: &'a Tile,
    sites: &'a [Site],
    tracer: &'a Tracer,
    transport: &'a Transport,
    runs: Vec<Runs>,
    pub(super) estimates: Vec<Estimate>,
}

impl<'a> Rounds<'a> {
    pub(super) fn new(tile: &'a Tile, sites: &'a [Site], tracer: &'a Tracer, transport: &'a Transport) -> Self {
        let runs = tile.sites.iter().map(|&site| sites[site as usize].runs(transport)).collect();
        Self { tile, sites, tracer, transport, runs, estimates: vec![Estimate::default(); tile.sites.len()] }
    }

    /// Carries on those that take part, each with all of its group, until they have so many paths; `None` if cancelled.
    pub(super) fn sample(
        &mut self,
        paths: u32,
        takes_part: impl Fn(usize) -> bool,
        cancel: &CancelToken,
    ) -> Option<()> {
        for group in &self.tile.groups {
            if !group.iter().any(|&place| takes_part(place.into())) {
                continue;
            }
            let sites = &self.tile.sites;
            let mut rest = self.runs.iter_mut().zip(sites).enumerate();
            let mut members = Vec::with_capacity(group.len());
            for &place in group {
                let (_, (runs, &site)) = rest.find(|(number, _)| *number == usize::from(place))?;
                members.push((&self.sites[site as usize], runs));
            }
            carry_on(&mut members, paths, (self.tracer, self.transport), cancel)?;
            for &place in group {
                self.estimates[usize::from(place)] = self.runs[usize::from(place)].estimate();
            }
        }
        Some(())
    }

    /// Makes intervals and levels of texels and those around them.
    pub(super) fn pool(&mut self, looks: Looks) {
        let pooled: Vec<[f64; 2]> = (0..self.estimates.len()).map(|place| self.pooled(place, looks)).collect();
        for (estimate, [half_width, level]) in self.estimates.iter_mut().zip(pooled) {
            (estimate.half_width, estimate.level) = (half_width, level);
        }
    }

    /// Half the width of the 95 % interval of a texel's luminance, and what its error is relative to [cd/m²].
    fn pooled(&self, place: usize, looks: Looks) -> [f64; 2] {
        let around = || std::iter::once(place).chain(self.tile.around[place].iter().map(|&other| usize::from(other)));
        let count = around().count();
        let mean =
            |of: &dyn Fn(&Estimate) -> f64| around().map(|at| of(&self.estimates[at])).sum::<f64>() / count as f64;
        let of_one_path = |estimate: &Estimate| estimate.luminance_error.powi(2) * estimate.samples as f64;
        let own = &self.estimates[place];
        let variance = of_one_path(own).max(mean(&of_one_path)) / own.samples.max(1) as f64;
        let half_width = looks.quantile(count) * variance.sqrt();
        let value = luminance(own.mean);
        let others = (count as f64 * mean(&|estimate| luminance(estimate.mean)) - value) / (count - 1).max(1) as f64;
        let level = if count > 1 { others.clamp(value - half_width, value + half_width) } else { value };
        [half_width, level]
    }
}

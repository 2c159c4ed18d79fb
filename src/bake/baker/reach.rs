//! Which tiles a change reaches: by how much it moves the light of their texels, measured by a few paths.
//!
//! The light of a texel after the change less that before is the sum of two differences, since light adds up:
//!
//! - what the sources that did not change send over surfaces that did: few paths meet those, and the others are the same
//!   to the bit before and after, since they are made of the same random numbers ("common random numbers"). That is not
//!   so when a source changes, because then other sources are chosen everywhere; hence
//! - what the sources that did change send now less what they sent before, over the surfaces of now and before: nothing
//!   or nearly so where they do not shine.
//!
//! Both are measured by texels that trace for themselves. A tile is kept if all its texels' differences, and their noise
//! with them, are small beside the error that was asked for; what is too noisy to be known is measured again.

use super::{Earlier, Upcoming};
use crate::bake::CancelToken;
use crate::bake::gather::{Estimate, Runs};
use crate::bake::sites::Site;
use crate::bake::tiles::{Tile, Until};
use crate::scene::{Change, Scene};
use crate::trace::{Compiled, Tracer, Transport};

/// Share of the error that was asked for by which changes may move a tile that is kept.
pub(super) const ALLOWED: f64 = 0.25;

/// Paths of each round, from each texel in each of up to four scenes.
const ROUNDS: [u32; 2] = [16, 64];

/// Standard errors by which a texel may be off by chance without telling of a change.
const BY_CHANCE: f64 = 4.0;

/// A change, as paths see it.
pub(super) struct Reach<'a> {
    earlier: &'a Earlier,
    upcoming: &'a Upcoming<'a>,
    differences: Vec<[Tracer; 2]>,
}

/// How far a tile's light has moved, in units of the error that was asked for.
#[derive(Clone, Copy, Debug, Default)]
struct Moved {
    /// Mean over the texels of how far each has, noise included.
    mean: f64,
    /// Mean over the texels of that noise.
    noise: f64,
    /// The most that one has, less what may be chance.
    most: f64,
}

impl<'a> Reach<'a> {
    pub(super) fn new(earlier: &'a Earlier, upcoming: &'a Upcoming<'a>) -> Self {
        let change = Change::between(&earlier.scene, upcoming.scene);
        let both = |part: &dyn Fn(&Scene) -> Scene| {
            [&earlier.scene, upcoming.scene]
                .map(|scene| Compiled::new(&part(scene), &upcoming.settings.transport).tracer)
        };
        let mut differences = Vec::new();
        if change.is_of_surfaces() {
            differences.push(both(&|scene| change.by_steady_light(scene)));
        }
        if change.is_of_sources() {
            differences.push(both(&|scene| change.by_changed_light(scene)));
        }
        Self { earlier, upcoming, differences }
    }

    /// By how much of the error that was asked for a tile has moved that may be kept, and has drifted so far before;
    /// the inner `None` if it may not. `None` if cancelled.
    pub(super) fn moved(&self, before: &Tile, tile: &Tile, drift: f64, cancel: &CancelToken) -> Option<Option<f64>> {
        if self.differences.is_empty() {
            return Some(Some(0.0));
        }
        // One group stands for all where the change is plain.
        let first: Vec<usize> = tile.groups().next().into_iter().flatten().collect();
        let all: Vec<usize> = (0..tile.sites.len()).collect();
        if self.measured(before, tile, &first, ROUNDS[0], cancel)?.is_plain() {
            return Some(None);
        }
        for paths in ROUNDS {
            let moved = self.measured(before, tile, &all, paths, cancel)?;
            if moved.is_within(ALLOWED - drift) {
                return Some(Some(moved.mean));
            }
            if moved.is_plain() {
                break;
            }
        }
        Some(None)
    }

    fn measured(
        &self,
        before: &Tile,
        tile: &Tile,
        places: &[usize],
        paths: u32,
        cancel: &CancelToken,
    ) -> Option<Moved> {
        let mut sums = Moved::default();
        for &place in places {
            let sites = [
                &self.earlier.measured.sites[before.sites[place] as usize],
                &self.upcoming.sites[tile.sites[place] as usize],
            ];
            let known = &self.earlier.measured.estimates[before.sites[place] as usize];
            let [difference, error] = self.difference(sites, paths, cancel)?;
            let asked = asked_for(known, self.upcoming.until);
            if difference == 0.0 && error == 0.0 {
                continue;
            }
            let [difference, error] = [difference.abs() / asked, error / asked];
            sums.mean += difference;
            sums.noise += error;
            sums.most = sums.most.max(difference - BY_CHANCE * error);
        }
        let count = places.len().max(1) as f64;
        Some(Moved { mean: sums.mean / count, noise: sums.noise / count, most: sums.most })
    }

    /// By how much a texel's luminance has moved, and the standard error of that [cd/m²].
    fn difference(&self, sites: [&Site; 2], paths: u32, cancel: &CancelToken) -> Option<[f64; 2]> {
        let transport: &Transport = &self.upcoming.settings.transport;
        let mut terms = Vec::with_capacity(2 * self.differences.len());
        for tracers in &self.differences {
            for (side, sign) in [-1.0, 1.0].into_iter().enumerate() {
                let mut runs = sites[side].runs(transport);
                sites[side].carry_on(&mut runs, &tracers[side], paths, transport, cancel)?;
                terms.push((sign, runs));
            }
        }
        Some(Runs::luminance_of_sum(&terms))
    }
}

impl Moved {
    /// Whether noise alone would hardly look so.
    fn is_plain(&self) -> bool {
        self.mean - self.noise > 1.0 || self.most > 1.0
    }

    fn is_within(&self, allowed: f64) -> bool {
        self.mean <= allowed && self.most <= ALLOWED
    }
}

/// How far off a texel may be [cd/m²].
fn asked_for(known: &Estimate, until: Until) -> f64 {
    match until {
        Until::Samples(_) => known.half_width,
        Until::Error(target) => target.relative * target.value(known),
    }
}

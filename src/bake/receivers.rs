//! A few texels that stand for all of a lightmap, measured as the bake measures them, in any manner: for studies of
//! what accuracy costs. Owns which texels these are and sums that can be carried on; says nothing about errors.

use super::atlas::Atlas;
use super::endless::refuse_endless_texels;
use super::gather::Runs;
use super::lightmap::refuse_what_cannot_be_baked;
use super::reuse::{FIRST_PATHS, FirstPass, Place};
use super::sites::{Site, Sites};
use super::unwrap::LaidOut;
use super::workers::Workers;
use super::{BakeError, BakeSettings, BakeWarning, CancelToken};
use crate::math::{combine, luminance, mix64};
use crate::scene::Scene;
use crate::trace::{Census, Compiled, Effect, EffectSet, Independent, Sobol, Tracer, Transport};
use std::num::NonZeroUsize;
use std::time::Duration;

/// Whose numbers say which texels are taken.
const CHOICE: u64 = 0x7265_6365_6976;

/// Where random numbers come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Numbers {
    /// Owen-scrambled Sobol points: the bake's own.
    Sobol,
    /// Each by itself: plain Monte Carlo.
    Independent,
}

/// How texels are measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manner {
    pub(crate) transport: Transport,
    pub(crate) numbers: Numbers,
}

/// Sums over one texel's paths so far.
#[derive(Clone, Debug)]
pub(crate) struct Sums(Runs);

impl Sums {
    /// Mean luminance of E/π [cd/m²].
    pub(crate) fn mean(&self) -> f64 {
        luminance(self.0.estimate().mean)
    }

    /// Variance of that mean, from how the runs differ [cd²/m⁴].
    pub(crate) fn variance(&self) -> f64 {
        self.0.estimate().luminance_error.powi(2)
    }
}

/// A few texels of a lightmap.
pub(crate) struct Receivers<'a> {
    /// With the UV1 that it was given.
    scene: Scene,
    tracer: Tracer,
    transport: Transport,
    census: Census,
    /// Evenly spread over all, in their order.
    sites: Vec<Site>,
    /// How many there are in all.
    texels: u64,
    warnings: Vec<BakeWarning>,
    first_pass: Option<FirstPass>,
    workers: Workers<'a>,
}

impl<'a> Receivers<'a> {
    /// Lays out the lightmap of a scene and takes up to `count` of its texels.
    ///
    /// # Errors
    ///
    /// What a bake would refuse.
    pub(crate) fn new(
        scene: &Scene,
        settings: &BakeSettings,
        count: usize,
        cancel: &'a CancelToken,
    ) -> Result<Self, BakeError> {
        settings.validate()?;
        let workers = Workers::new(settings.threads, &(), cancel)?;
        let laid_out = LaidOut::new(scene, settings, &workers)?;
        let Compiled { tracer, faults, census } = Compiled::new(&laid_out.scene, &settings.transport);
        let faults = laid_out.without_solved(faults);
        refuse_what_cannot_be_baked(&tracer, &faults)?;
        let atlas = Atlas::new(&laid_out, &tracer, settings, cancel)?;
        let Sites { seen, warnings: of_texels, .. } = Sites::new(&laid_out.scene, &tracer, &atlas, settings, &workers)?;
        refuse_endless_texels(&laid_out.scene, &tracer, &settings.transport, &seen)?;
        let mut warnings: Vec<BakeWarning> = faults.into_iter().map(BakeWarning::from).collect();
        warnings.extend(laid_out.warnings.iter().chain(&atlas.warnings).cloned());
        warnings.extend(of_texels);
        warnings.extend(BakeWarning::of_transport(&settings.transport, &census));
        let first_pass = Place { tracer: &tracer, atlas: &atlas, sites: &seen };
        let first_pass = first_pass.first_pass(FIRST_PATHS, settings, &workers)?;
        drop(atlas);
        let texels = seen.len() as u64;
        let scene = laid_out.scene.into_owned();
        let sites = spread(seen, count);
        Ok(Self { scene, tracer, transport: settings.transport, census, sites, texels, warnings, first_pass, workers })
    }

    /// How many texels are measured.
    pub(crate) fn count(&self) -> usize {
        self.sites.len()
    }

    /// How many texels the lightmap has.
    pub(crate) fn texels(&self) -> u64 {
        self.texels
    }

    /// Page of each measured texel, and its place on it, row by row.
    pub(crate) fn places(&self) -> impl Iterator<Item = [u32; 2]> {
        self.sites.iter().map(|site| [site.covered.page, site.covered.index])
    }

    pub(crate) fn tracer(&self) -> &Tracer {
        &self.tracer
    }

    pub(crate) fn effects(&self) -> EffectSet {
        self.tracer.effects()
    }

    pub(crate) fn census(&self) -> &Census {
        &self.census
    }

    /// What the first pass of the fast mode took for all texels; `None` where all bounces are traced.
    pub(crate) fn first_pass(&self) -> Option<FirstPass> {
        self.first_pass
    }

    pub(crate) fn warnings(&self) -> &[BakeWarning] {
        &self.warnings
    }

    /// The same scene without an effect; `None` if light would then be kept for ever or nothing would shine.
    pub(crate) fn without(&self, effect: Effect) -> Option<Tracer> {
        let mut transport = self.transport;
        transport.effects.off = transport.effects.off.with(effect);
        let tracer = Compiled::sharing_tree(&self.scene, &transport, &self.tracer).tracer;
        refuse_endless_texels(&self.scene, &tracer, &self.transport, &self.sites).is_ok().then_some(tracer)
    }

    /// Sums without any path. Those of salt 0 take the bake's own random numbers, and other salts take others.
    pub(crate) fn sums(&self, salt: u64) -> Vec<Sums> {
        let key = |key| if salt == 0 { key } else { combine(key, salt) };
        let empty = |site: &Site| Sums(Runs::new(key(site.covered.key), None));
        self.sites.iter().map(empty).collect()
    }

    /// Carries sums on until each has so many paths, through `tracer`, which is this one's or one without an effect.
    /// Tells the processor time that it took.
    pub(crate) fn carry_on(
        &self,
        tracer: &Tracer,
        manner: &Manner,
        sums: &mut Vec<Sums>,
        count: u32,
    ) -> Result<Duration, BakeError> {
        let items: Vec<(&Site, &Sums)> = self.sites.iter().zip(sums.iter()).collect();
        let work = self.workers.gather(
            &items,
            |&(site, sums), cancel| {
                let (mut runs, transport) = (sums.0.clone(), &manner.transport);
                match manner.numbers {
                    Numbers::Sobol => runs.extend(count, Sobol::new, cancel, |numbers, start, tally| {
                        site.sample(tracer, numbers, start, transport, tally)
                    })?,
                    Numbers::Independent => runs.extend(count, Independent::new, cancel, |numbers, start, tally| {
                        site.sample(tracer, numbers, start, transport, tally)
                    })?,
                }
                Some(Sums(runs))
            },
            |_| None,
        )?;
        *sums = work.results;
        Ok(work.cpu)
    }
}

/// Up to `count` items, one at a place of chance in each of as many equal parts of the list.
fn spread<T>(items: Vec<T>, count: usize) -> Vec<T> {
    let (all, count) = (items.len() as u128, count as u128);
    if all <= count {
        return items;
    }
    let place = |part: u128| {
        let [from, to] = [part, part + 1].map(|part| part * all / count);
        from + (((to - from) * u128::from(mix64(CHOICE ^ part as u64))) >> 64)
    };
    let mut places = (0..count).map(place).peekable();
    let is_taken = |(index, item)| places.next_if_eq(&(index as u128)).map(|_| item);
    items.into_iter().enumerate().filter_map(is_taken).collect()
}

/// Threads that a number of them stands for.
pub(crate) fn thread_count(threads: Option<NonZeroUsize>) -> usize {
    threads.or_else(|| std::thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_are_spread_over_all() {
        let few = spread((0..1000).collect(), 100);
        assert_eq!(few.len(), 100);
        assert!(few.iter().enumerate().all(|(part, item)| item / 10 == part), "{few:?}");
        assert!(few.iter().any(|item| item % 10 != few[0] % 10), "places of chance");
        assert_eq!(spread(vec![1, 2, 3], 5), [1, 2, 3]);
        assert_eq!(spread((0..1001).collect::<Vec<i32>>(), 1000).len(), 1000);
    }
}

//! Every texel that is to be measured, in an order that keeps neighbours together.

use super::atlas::{Atlas, Chart};
use super::charts::Charts;
use super::gather::{Estimate, KeyKind, Runs, Start, key};
use super::raster::{Fragment, MIN_COVERAGE, covered_texels};
use super::texel::Texel;
use super::unseen::unseen;
use super::validity::{Footing, footings};
use super::workers::Workers;
use super::{BakeError, BakeSettings, BakeWarning, CancelToken, Layout};
use crate::scene::{Scene, Subject};
use crate::trace::{Dimensions, PathStart, Sampler, Sobol, Tally, Tracer, Transport};
use glam::{Vec2, Vec3};
use std::collections::BTreeMap;

/// A texel that triangles cover.
pub(super) struct Covered {
    pub(super) page: u32,
    /// Row by row within the page.
    pub(super) index: u32,
    /// The object whose rectangle it is in, or 0 on a map that all objects share.
    pub(super) receiver: u32,
    /// Column and row in that rectangle.
    pub(super) place: [u32; 2],
    /// The chart that it is part of.
    pub(super) chart: u32,
    pub(super) texel: Texel,
    /// Whether triangles, of its chart or of others, cover more than all of it.
    pub(super) is_overlapped: bool,
    pub(super) key: u64,
}

/// A texel to be measured.
pub(super) struct Site {
    pub(super) covered: Covered,
    pub(super) footing: Footing,
}

impl Site {
    /// One sample of E/π [cd/m²] from [`Self::start`].
    pub(super) fn sample(
        &self,
        tracer: &Tracer,
        numbers: &impl Sampler,
        start: Start,
        transport: &Transport,
        tally: &mut Tally,
    ) -> Option<Vec3> {
        let start = self.start(tracer, numbers, start)?;
        Some(tracer.baked_radiance(&start, numbers, transport, tally))
    }

    /// Where a path starts, a place on the texel that can be reached from its anchor; `None` where the numbers say
    /// another.
    pub(super) fn start(&self, tracer: &Tracer, numbers: &impl Sampler, start: Start) -> Option<PathStart> {
        match start {
            Start::Anywhere => Some(self.footing.anchor),
            Start::Drawn => {
                let [u, v, ..] = numbers.draw(Dimensions::Start);
                let drawn = self.covered.texel.start(tracer, Vec2::new(u, v));
                self.footing.reaches(tracer, &drawn).then_some(drawn)
            }
        }
    }

    /// The estimate of its light by this many paths; `None` if cancelled.
    pub(super) fn estimate(
        &self,
        tracer: &Tracer,
        count: u32,
        transport: &Transport,
        cancel: &CancelToken,
    ) -> Option<Estimate> {
        let mut runs = self.runs(transport);
        self.carry_on(&mut runs, tracer, count, transport, cancel)?;
        Some(runs.estimate())
    }

    /// The runs of its estimate, before any path.
    pub(super) fn runs(&self, transport: &Transport) -> Runs {
        self.runs_with(self.covered.key, transport)
    }

    /// The same with other random numbers.
    pub(super) fn runs_with(&self, key: u64, transport: &Transport) -> Runs {
        Runs::new(key, transport.clamp)
    }

    /// Carries them on until there are so many paths; `None` if cancelled.
    pub(super) fn carry_on(
        &self,
        runs: &mut Runs,
        tracer: &Tracer,
        count: u32,
        transport: &Transport,
        cancel: &CancelToken,
    ) -> Option<()> {
        runs.extend(count, Sobol::new, cancel, |sobol, start, tally| {
            self.sample(tracer, sobol, start, transport, tally)
        })
    }

    /// Memory that it holds, its estimate included [bytes].
    pub(super) fn memory_bytes(&self) -> usize {
        let others = size_of_val(&*self.footing.others);
        size_of::<Self>() + size_of::<Estimate>() + self.covered.texel.heap_bytes() + others
    }
}

/// What there is to be measured.
pub(super) struct Sites {
    /// Texels to be measured, in an order that keeps neighbours together.
    pub(super) seen: Vec<Site>,
    /// Covered texels that lie inside of bodies, in the dark.
    pub(super) hidden: Vec<Covered>,
    /// Objects that overlap, cover nothing, or show nothing.
    pub(super) warnings: Vec<BakeWarning>,
}

impl Sites {
    pub(super) fn new(
        scene: &Scene,
        tracer: &Tracer,
        atlas: &Atlas<'_>,
        settings: &BakeSettings,
        workers: &Workers<'_>,
    ) -> Result<Self, BakeError> {
        let charts = Charts::new(tracer, &atlas.charts);
        let (covered, mut warnings) = covered(scene, tracer, atlas, &charts, settings);
        let footings = footings(tracer, atlas, &covered, settings, workers)?;
        let (mut seen, mut hidden) = (Vec::new(), Vec::new());
        for (covered, footing) in covered.into_iter().zip(footings) {
            if footing.is_hidden { hidden.push(covered) } else { seen.push(Site { covered, footing }) }
        }
        warnings.extend(unseen(scene, tracer, &seen));
        Ok(Self { seen, hidden, warnings })
    }
}

/// Every covered texel, and warnings where objects overlap or cover none.
fn covered(
    scene: &Scene,
    tracer: &Tracer,
    atlas: &Atlas<'_>,
    charts: &Charts,
    settings: &BakeSettings,
) -> (Vec<Covered>, Vec<BakeWarning>) {
    let subject = |rectangle: &Chart<'_>| Subject::Instance(scene.instances[rectangle.receiver.instance].name.clone());
    let mut all = Vec::new();
    let mut overlapping: BTreeMap<Subject, u64> = BTreeMap::new();
    let mut is_bare = vec![true; atlas.charts.len()];
    for page in 0..atlas.pages.len() as u32 {
        let [width, _] = atlas.pages[page as usize];
        for group in fragments(atlas, charts, page).chunk_by(|a, b| a.texel == b.texel) {
            let index = group[0].texel;
            let place = [index % width, index / width];
            let of_chart = |group: &[Fragment]| Texel::new(tracer, &atlas.charts, group, place);
            let mut by_chart: Vec<(&[Fragment], Texel)> = group
                .chunk_by(|a, b| a.chart == b.chart)
                .map(|group| (group, of_chart(group)))
                .filter(|(_, texel)| texel.is_covered())
                .collect();
            let coverage: f64 = by_chart.iter().map(|(_, texel)| texel.coverage).sum();
            // A texel has one value; where charts share one, it is that of the chart that has most of it.
            let most = (0..by_chart.len()).reduce(|most, other| {
                if by_chart[other].1.coverage > by_chart[most].1.coverage { other } else { most }
            });
            let Some((group, texel)) = most.map(|most| by_chart.swap_remove(most)) else { continue };
            for fragment in group {
                is_bare[fragment.receiver as usize] = false;
            }
            let rectangle = &atlas.charts[group[0].receiver as usize];
            let is_overlapped = coverage > 1.0 + MIN_COVERAGE;
            if is_overlapped {
                *overlapping.entry(subject(rectangle)).or_default() += 1;
            }
            let key = site_key(scene, rectangle, place, index, settings);
            let receiver = if settings.layout == Layout::Packed { group[0].receiver } else { 0 };
            let place = [0, 1].map(|axis| place[axis] - rectangle.origin[axis]);
            all.push(Covered { page, index, receiver, place, chart: group[0].chart, texel, is_overlapped, key });
        }
    }
    let overlapping = overlapping.into_iter().map(|(subject, texels)| BakeWarning::OverlappingUv1 { subject, texels });
    let bare = atlas.charts.iter().zip(is_bare).filter(|(_, is_bare)| *is_bare);
    let bare = bare.map(|(rectangle, _)| BakeWarning::NoTexels { subject: subject(rectangle) });
    (all, overlapping.chain(bare).collect())
}

/// The key of a texel's random numbers: its object and its place within the object's rectangle, or its place on the
/// map that all objects share.
fn site_key(scene: &Scene, chart: &Chart<'_>, [x, y]: [u32; 2], index: u32, settings: &BakeSettings) -> u64 {
    let seed = settings.transport.seed;
    match settings.layout {
        Layout::Packed => {
            let object = scene.instances[chart.receiver.instance].id.key();
            let place = u64::from(y - chart.origin[1]) << 32 | u64::from(x - chart.origin[0]);
            key(KeyKind::Texel, seed, object, place)
        }
        Layout::Shared { .. } => key(KeyKind::Texel, seed, 0, u64::from(index)),
    }
}

/// What triangles cover of a page, texel by texel.
fn fragments(atlas: &Atlas<'_>, charts: &Charts, page: u32) -> Vec<Fragment> {
    let [width, _] = atlas.pages[page as usize];
    let mut fragments = Vec::new();
    for (receiver, rectangle) in atlas.charts.iter().enumerate().filter(|(_, rectangle)| rectangle.page == page) {
        let receiver = receiver as u32;
        for triangle in 0..rectangle.triangle_count() {
            let chart = charts.of(receiver, triangle);
            covered_texels(rectangle.triangle(triangle), rectangle.size, |x, y| {
                let texel = (rectangle.origin[1] + y) * width + rectangle.origin[0] + x;
                fragments.push(Fragment { texel, chart, receiver, triangle });
            });
        }
    }
    fragments.sort_unstable();
    fragments
}

//! Every texel that is to be measured, in an order that keeps neighbours together.

use super::atlas::{Atlas, Chart};
use super::gather::{Estimate, KeyKind, key};
use super::raster::{Fragment, MIN_COVERAGE, covered_texels};
use super::texel::Texel;
use super::{BakeSettings, BakeWarning, Layout};
use crate::scene::{Scene, Subject};
use crate::trace::Tracer;
use std::collections::BTreeMap;

/// A texel to be measured.
pub(super) struct Site {
    pub(super) page: u32,
    /// Row by row within the page.
    pub(super) index: u32,
    pub(super) texel: Texel,
    pub(super) key: u64,
}

impl Site {
    /// Memory that it holds, its estimate included [bytes].
    pub(super) fn memory_bytes(&self) -> usize {
        size_of::<Self>() + size_of::<Estimate>() + self.texel.heap_bytes()
    }
}

/// Every covered texel, and warnings where objects overlap or cover none.
pub(super) fn sites(
    scene: &Scene,
    tracer: &Tracer,
    atlas: &Atlas<'_>,
    settings: &BakeSettings,
) -> (Vec<Site>, Vec<BakeWarning>) {
    let subject = |chart: &Chart<'_>| Subject::Instance(scene.instances[chart.receiver.instance].name.clone());
    let mut sites = Vec::new();
    let mut overlapping: BTreeMap<Subject, u64> = BTreeMap::new();
    let mut is_bare = vec![true; atlas.charts.len()];
    for page in 0..atlas.pages.len() as u32 {
        let [width, _] = atlas.pages[page as usize];
        for group in fragments(atlas, page).chunk_by(|a, b| a.texel == b.texel) {
            let index = group[0].texel;
            let place = [index % width, index / width];
            let texel = Texel::new(tracer, &atlas.charts, group, place);
            if !texel.is_covered() {
                continue;
            }
            for fragment in group {
                is_bare[fragment.receiver as usize] = false;
            }
            let chart = &atlas.charts[group[0].receiver as usize];
            if texel.coverage > 1.0 + MIN_COVERAGE {
                *overlapping.entry(subject(chart)).or_default() += 1;
            }
            let key = site_key(scene, chart, place, index, settings);
            sites.push(Site { page, index, texel, key });
        }
    }
    let overlapping = overlapping.into_iter().map(|(subject, texels)| BakeWarning::OverlappingUv1 { subject, texels });
    let bare = atlas.charts.iter().zip(is_bare).filter(|(_, is_bare)| *is_bare);
    let bare = bare.map(|(chart, _)| BakeWarning::NoTexels { subject: subject(chart) });
    (sites, overlapping.chain(bare).collect())
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
fn fragments(atlas: &Atlas<'_>, page: u32) -> Vec<Fragment> {
    let [width, _] = atlas.pages[page as usize];
    let mut fragments = Vec::new();
    for (receiver, chart) in atlas.charts.iter().enumerate().filter(|(_, chart)| chart.page == page) {
        for triangle in 0..chart.triangle_count() {
            covered_texels(chart.triangle(triangle), chart.size, |x, y| {
                let texel = (chart.origin[1] + y) * width + chart.origin[0] + x;
                fragments.push(Fragment { texel, receiver: receiver as u32, triangle });
            });
        }
    }
    fragments.sort_unstable();
    fragments
}

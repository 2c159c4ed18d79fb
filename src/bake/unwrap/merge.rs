//! Neighbouring charts put together again where one chart can hold both: the split that came first is seldom the best.
//!
//! Pairs with most of their border in common come first. A pair is tried once; what became one is tried anew with its
//! neighbours. There is a limit on the work, at which the charts are left as they are.

use super::flatten::{Limits, flatten};
use super::patch::{Chart, Patch};
use super::surface::{NONE, Surface};
use super::work::Work;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Charts of a connected patch, fewer than before where that can be.
pub(super) fn merge(surface: &Surface, whole: &Patch, charts: Vec<Chart>, work: &mut Work<'_>) -> Vec<Chart> {
    if charts.len() < 2 {
        return charts;
    }
    let mut merging = Merging::new(surface, whole, charts);
    while let Some((_, Reverse(pair))) = merging.queue.pop() {
        if !merging.try_pair(pair, work) && !work.is_left() {
            break;
        }
    }
    merging.charts.into_iter().flatten().collect()
}

struct Merging<'a> {
    surface: &'a Surface,
    whole: &'a Patch,
    /// By number; those that went into others are gone, those that came of two stand at the end.
    charts: Vec<Option<Chart>>,
    /// Lengths of the borders with neighbours, by chart.
    borders: Vec<BTreeMap<u32, f64>>,
    /// Pairs by the share of their border that they have in common.
    queue: BinaryHeap<(u64, Reverse<[u32; 2]>)>,
}

impl<'a> Merging<'a> {
    fn new(surface: &'a Surface, whole: &'a Patch, charts: Vec<Chart>) -> Self {
        let first = |triangle: u32| whole.triangles.binary_search(&triangle).unwrap_or(0);
        let mut owner = vec![0_u32; whole.len()];
        for (number, chart) in charts.iter().enumerate() {
            chart.triangles.iter().for_each(|&triangle| owner[first(triangle)] = number as u32);
        }
        let mut borders = vec![BTreeMap::new(); charts.len()];
        for (half, &other) in whole.across.iter().enumerate() {
            let [own, other] = [owner[half / 3], if other == NONE { NONE } else { owner[other as usize / 3] }];
            if own != other {
                let corners = surface.triangle(whole.triangles[half / 3]);
                let length = (corners[(half + 1) % 3] - corners[half % 3]).length();
                *borders[own as usize].entry(other).or_insert(0.0) += length;
            }
        }
        let charts: Vec<Option<Chart>> = charts.into_iter().map(Some).collect();
        let mut merging = Self { surface, whole, charts, borders, queue: BinaryHeap::new() };
        (0..merging.borders.len() as u32).for_each(|number| merging.push_pairs(number, |other| number < other));
        merging
    }

    fn push_pairs(&mut self, number: u32, is_wanted: impl Fn(u32) -> bool) {
        let perimeter = |number: u32| self.borders[number as usize].values().sum::<f64>();
        let own = perimeter(number);
        let neighbours = self.borders[number as usize].iter();
        let pairs: Vec<(u64, Reverse<[u32; 2]>)> = neighbours
            .filter(|(other, _)| **other != NONE && is_wanted(**other))
            .map(|(&other, length)| ((length / own.min(perimeter(other))).to_bits(), Reverse([number, other])))
            .collect();
        self.queue.extend(pairs);
    }

    fn try_pair(&mut self, pair: [u32; 2], work: &mut Work<'_>) -> bool {
        let [Some(first), Some(second)] = pair.map(|number| self.charts[number as usize].as_ref()) else {
            return false;
        };
        let mut triangles: Vec<u32> = first.triangles.iter().chain(&second.triangles).copied().collect();
        triangles.sort_unstable();
        let patch = self.patch(triangles);
        let Some(chart) = flatten(self.surface, &patch, &Limits::MERGED, work) else {
            return false;
        };
        let number = self.charts.len() as u32;
        self.charts.push(Some(chart));
        let mut borders = BTreeMap::new();
        for old in pair {
            self.charts[old as usize] = None;
            for (other, length) in std::mem::take(&mut self.borders[old as usize]) {
                if !pair.contains(&other) {
                    *borders.entry(other).or_insert(0.0) += length;
                }
            }
        }
        for (&other, &length) in borders.iter().filter(|(other, _)| **other != NONE) {
            let of_other = &mut self.borders[other as usize];
            for old in pair {
                of_other.remove(&old);
            }
            of_other.insert(number, length);
        }
        self.borders.push(borders);
        self.push_pairs(number, |_| true);
        true
    }

    /// Some triangles of the surface with the edges between them, all of which are closed again.
    fn patch(&self, triangles: Vec<u32>) -> Patch {
        let mut across = Vec::with_capacity(3 * triangles.len());
        for &triangle in &triangles {
            let place = self.whole.triangles.binary_search(&triangle).unwrap_or(0);
            for &other in &self.whole.across[3 * place..3 * place + 3] {
                let there = (other != NONE).then(|| self.whole.triangles[other as usize / 3]);
                let there = there.and_then(|triangle| triangles.binary_search(&triangle).ok());
                across.push(there.map_or(NONE, |place| 3 * place as u32 + other % 3));
            }
        }
        Patch { triangles, across }
    }
}

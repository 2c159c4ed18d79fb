//! Texels that trace together: a path of one serves all ([`Tracer::share`]).
//!
//! Which texels are a group is a matter of their places in the tile, every [`STRIDE`]th along both axes. The errors of a
//! group are alike, since they come from the same paths; those of neighbours, which a person or the denoiser compares,
//! are of different groups and independent.

use crate::bake::CancelToken;
use crate::bake::gather::{REPLICATES, Runs};
use crate::bake::sites::Site;
use crate::trace::{MOST_RECEIVERS, Sharing, Tracer, Transport};
use glam::Vec3;
use std::collections::BTreeMap;

/// Distance between neighbours of one group [texels].
pub(super) const STRIDE: u32 = 4;

/// Steps between two looks at the cancel switch.
const CANCEL_INTERVAL: u64 = 8;

/// Groups of texels, by their numbers in a list of places.
pub(super) fn groups(places: impl Iterator<Item = [u32; 2]>, sharing: Sharing) -> Vec<Vec<u16>> {
    if sharing == Sharing::Alone {
        return (0..places.count() as u16).map(|number| vec![number]).collect();
    }
    let mut by_rest: BTreeMap<[u32; 2], Vec<u16>> = BTreeMap::new();
    for (number, place) in places.enumerate() {
        by_rest.entry(place.map(|along| along % STRIDE)).or_default().push(number as u16);
    }
    by_rest.values().flat_map(|group| group.chunks(MOST_RECEIVERS)).map(<[u16]>::to_vec).collect()
}

/// Carries the runs of a group on, which have had the same number of paths, until each has so many; `None` if
/// cancelled.
pub(super) fn carry_on(
    group: &mut [(&Site, &mut Runs)],
    paths: u32,
    (tracer, transport): (&Tracer, &Transport),
    cancel: &CancelToken,
) -> Option<()> {
    let Some((_, first)) = group.first() else { return Some(()) };
    let (before, per_run) = (first.paths_per_run(), Runs::per_run(paths));
    let (mut starts, mut found) = (Vec::with_capacity(group.len()), Vec::with_capacity(group.len()));
    for run in 0..REPLICATES {
        for step in before..per_run {
            if step.is_multiple_of(CANCEL_INTERVAL) && cancel.is_cancelled() {
                return None;
            }
            starts.clear();
            found.clear();
            for (site, runs) in group.iter_mut() {
                let (start, numbers) = runs.start(run, per_run, |numbers, start| site.start(tracer, numbers, start));
                found.push(tracer.find(&start, &numbers, transport, runs.tally()));
                starts.push(start);
            }
            let mut light = [Vec3::ZERO; MOST_RECEIVERS];
            for (own, found) in found.iter().enumerate() {
                tracer.share(&starts, own, found, &mut light, group[own].1.tally());
            }
            for ((_, runs), light) in group.iter_mut().zip(light) {
                runs.add(run, light);
            }
        }
    }
    for (_, runs) in group {
        runs.have_all(per_run);
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Whatever is missing of a tile, each texel is in one group, no group is too large, and no neighbours meet in one.
    #[test]
    fn a_group_is_of_texels_that_are_no_neighbours() {
        let all = || (0..256_u32).map(|index| [32 + index % 16, 48 + index / 16]);
        for (missing, sharing) in [(0, Sharing::Group), (3, Sharing::Group), (7, Sharing::Group), (3, Sharing::Alone)] {
            let places: Vec<[u32; 2]> = all().filter(|[x, y]| missing == 0 || (7 * x + 5 * y) % missing != 0).collect();
            let groups = groups(places.iter().copied(), sharing);
            let members: Vec<u16> = groups.iter().flatten().copied().collect();
            assert_eq!(members.len(), places.len());
            assert_eq!(members.iter().collect::<BTreeSet<_>>().len(), places.len());
            for group in &groups {
                let most = if sharing == Sharing::Alone { 1 } else { MOST_RECEIVERS };
                assert!((1..=most).contains(&group.len()));
                assert!(group.is_sorted(), "in the order of the tile, as the rounds take them");
                for (a, b) in group.iter().flat_map(|a| group.iter().map(move |b| (a, b))).filter(|(a, b)| a != b) {
                    let [a, b] = [a, b].map(|&number| places[usize::from(number)]);
                    assert!((0..2).any(|axis| a[axis].abs_diff(b[axis]) >= STRIDE), "{a:?} {b:?}");
                }
            }
        }
    }
}

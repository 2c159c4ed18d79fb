//! What probes show: what they measured, but for those that stand nowhere and those beside a wall thinner than a cell.
//!
//! Bevy blends the eight probes around a place whatever stands between. A probe without a place takes the light of its
//! neighbours in the air (as the dilation of baked probe volumes elsewhere does); where these are in several rooms, of the
//! darkest. Where a wall passes between two neighbours, the one that is brighter shows the light of the darker: near such
//! a wall the bright side loses, and nothing shines through. That light may be missing is seen less than that it is where
//! it cannot be.

use super::grid::Grid;
use super::measure::Moments;
use super::rooms::Rooms;
use crate::math::FACES;
use glam::DVec3;

/// What each probe shows. Those in the air have moments; the others need none.
pub(super) fn fill(grid: &Grid, rooms: &Rooms, measured: &[Option<Moments>]) -> Vec<Moments> {
    let of_probe = |index: usize| beside_walls(grid, rooms, measured, index);
    let mut shown: Vec<Option<Moments>> = (0..grid.len()).map(of_probe).collect();
    let in_bodies = (0..grid.len()).filter(|&index| !rooms.is_in_air[index]);
    let nearest: Vec<(usize, Moments)> =
        in_bodies.filter_map(|index| Some((index, from_rooms(grid, rooms, measured, index)?))).collect();
    for (index, moments) in nearest {
        shown[index] = Some(moments);
    }
    // Deeper inside nobody looks; but no number may be missing.
    while shown.iter().any(Option::is_none) {
        let of_neighbours = |index: usize| {
            let neighbours = grid.neighbours(index).filter_map(|(neighbour, _)| shown[neighbour].as_ref());
            mean(neighbours.map(|moments| (1.0, moments)))
        };
        let open = (0..grid.len()).filter(|&index| shown[index].is_none());
        let next: Vec<(usize, Moments)> = open.filter_map(|index| Some((index, of_neighbours(index)?))).collect();
        if next.is_empty() {
            break;
        }
        for (index, moments) in next {
            shown[index] = Some(moments);
        }
    }
    shown.into_iter().map(Option::unwrap_or_default).collect()
}

/// What a probe in the air shows: its own light or, where that is darker, that of a neighbour behind a wall.
fn beside_walls(grid: &Grid, rooms: &Rooms, measured: &[Option<Moments>], index: usize) -> Option<Moments> {
    let own = measured[index].as_ref().filter(|_| rooms.is_in_air[index])?;
    let unseen = grid.neighbours(index).filter(|&(_, bit)| !rooms.sees(index, bit));
    let darker = unseen.filter_map(|(neighbour, _)| {
        let other = measured[neighbour].as_ref().filter(|_| rooms.is_in_air[neighbour])?;
        (other.luminance() < own.luminance() && rooms.are_parted(index, neighbour)).then_some(other)
    });
    Some(darkest(darker).unwrap_or(own).clone())
}

/// The light of the neighbours in the air; of the darkest room where they are in several.
fn from_rooms(grid: &Grid, rooms: &Rooms, measured: &[Option<Moments>], index: usize) -> Option<Moments> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (neighbour, _) in grid.neighbours(index).filter(|&(neighbour, _)| rooms.is_in_air[neighbour]) {
        match groups.iter_mut().find(|group| !rooms.are_parted(group[0], neighbour)) {
            Some(group) => group.push(neighbour),
            None => groups.push(vec![neighbour]),
        }
    }
    let nearness = |neighbour: usize| 1.0 / f64::from((grid.point(neighbour) - grid.point(index)).length_squared());
    let of_group = |group: &Vec<usize>| {
        mean(group.iter().filter_map(|&neighbour| Some((nearness(neighbour), measured[neighbour].as_ref()?))))
    };
    let means: Vec<Moments> = groups.iter().filter_map(of_group).collect();
    darkest(means.iter()).cloned()
}

fn darkest<'a>(of: impl Iterator<Item = &'a Moments>) -> Option<&'a Moments> {
    of.min_by(|a, b| a.luminance().total_cmp(&b.luminance()))
}

/// The weighted mean; `None` of nothing.
fn mean<'a>(of: impl Iterator<Item = (f64, &'a Moments)>) -> Option<Moments> {
    let (mut sum, mut total) = ([DVec3::ZERO; FACES], 0.0);
    for (weight, moments) in of {
        total += weight;
        for (sum, moment) in sum.iter_mut().zip(moments.0) {
            *sum += weight * moment;
        }
    }
    (total > 0.0).then(|| Moments(sum.map(|moment| moment / total)))
}

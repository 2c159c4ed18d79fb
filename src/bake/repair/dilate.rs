//! Filling the texels beside the charts, which texture filtering also reads. Owns what an uncovered or hidden texel
//! holds before seams are mended; covered texels are read and never written, and black is a value like any other.
//!
//! Rings grow around the measured texels. A texel of a ring goes by the nearest measured one, hence by one chart only,
//! also where two charts come close; a hidden texel goes by its own chart where that is in reach. Its value is the
//! plane through the measured texels around that nearest one, carried on: a lookup on a chart's border lies halfway
//! between a measured and a filled texel, and would flatten the light there if the filled one only repeated the other.
//! Light near corners falls off ever more slowly, so what is carried on never leaves the range of what is around it by
//! more than that range, nor below half of it. Last, the 4 × 4 blocks that texture compression keeps are completed.
//!
//! That rings should extrapolate is old; the plane is a weighted least-squares fit as in any textbook.

use super::{Field, TexelState};
use crate::bake::BakeError;
use crate::bake::workers::Workers;
use glam::{DMat3, DVec2, DVec3, Vec3};

/// Rings: bicubic filtering reads two texels beyond a chart, and neighbours keep twice that between them.
const PASSES: u32 = 4;

/// Texels to each side of the nearest measured one that the plane is put through.
const REACH: i32 = 2;

/// Passes for which a hidden texel leaves a foreign chart aside.
const PATIENCE: u32 = 2;

/// Width of that window [texels].
const WINDOW: usize = 2 * REACH as usize + 1;

/// How far a plane is carried on [texels]: to where a bicubic lookup reads.
const LONGEST: i32 = 2;

/// Weight, in texels, with which a plane would rather be level: so that a row of single texels has one.
const LEVEL: f64 = 2e-3;

/// Width and height of the blocks that texture compression keeps [texels].
const BLOCK: u32 = 4;

/// No texel.
const NONE: u32 = u32::MAX;

/// Which chart a texel shows: its own, or the one that it was filled from.
#[derive(Clone, Debug, Default)]
pub(super) struct Owners {
    /// The measured texel that it goes by, or [`NONE`].
    source: Vec<u32>,
}

impl Owners {
    /// The measured texel that one goes by, if it holds anything.
    pub(super) fn source(&self, index: usize) -> Option<usize> {
        let source = self.source[index];
        (source != NONE).then_some(source as usize)
    }
}

/// Fills up to [`PASSES`] rings of texels around the measured ones, and then their blocks, in place.
pub(super) fn dilate(field: &mut Field, workers: &Workers<'_>) -> Result<Owners, BakeError> {
    let count = field.value.len();
    let own = |index: usize| if field.is_measured(index) { index as u32 } else { NONE };
    let mut owners = Owners { source: (0..count).map(own).collect() };
    let mut last: Vec<usize> = (0..count).filter(|&index| field.is_measured(index)).collect();
    for pass in 0..PASSES {
        let empty = |&index: &usize| owners.source[index] == NONE;
        let beside = last.iter().flat_map(|&index| neighbours(field, index).chain([index]));
        let mut ring: Vec<usize> = beside.filter(|index| empty(index)).collect();
        ring.sort_unstable();
        ring.dedup();
        let filled = workers.gather_quietly(&ring, |&index, cancel| {
            // A hidden texel waits for its own chart.
            let source =
                nearest_source(field, &owners, index).filter(|(is_foreign, _)| !is_foreign || pass >= PATIENCE);
            let filled = source.map(|(_, source)| (source, carried_on(field, source, index)));
            (!cancel.is_cancelled()).then_some(filled)
        })?;
        for (&index, (source, value)) in ring.iter().zip(filled).filter_map(|(index, filled)| Some((index, filled?))) {
            owners.source[index] = source as u32;
            field.value[index] = value;
        }
        last = ring;
    }
    complete_blocks(field, &mut owners);
    Ok(owners)
}

/// The up to eight texels around one.
fn neighbours(field: &Field, index: usize) -> impl Iterator<Item = usize> + '_ {
    let steps = (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y])).filter(|step| *step != [0, 0]);
    steps.filter_map(move |step| field.step(index, step))
}

/// The texel that most nearly is the nearest measured one, by what the neighbours go by, and whether it is of another
/// chart than a hidden one.
fn nearest_source(field: &Field, owners: &Owners, index: usize) -> Option<(bool, usize)> {
    let is_hidden = field.state[index] == TexelState::Hidden;
    let sources = neighbours(field, index).map(|neighbour| owners.source[neighbour]).filter(|&source| source != NONE);
    let rank = |source: u32| {
        let is_foreign = is_hidden && field.chart[source as usize] != field.chart[index];
        (is_foreign, offset(field, source as usize, index).length_squared() as u64, source)
    };
    let (is_foreign, _, source) = sources.map(rank).min()?;
    Some((is_foreign, source as usize))
}

/// From one texel to another [texels].
fn offset(field: &Field, from: usize, to: usize) -> DVec2 {
    let width = field.size[0] as usize;
    let place = |index: usize| DVec2::new((index % width) as f64, (index / width) as f64);
    place(to) - place(from)
}

/// The measured texels around one, as far as one gets from it by links: steps from it, and numbers.
fn around(field: &Field, source: usize) -> Vec<([i32; 2], usize)> {
    let mut is_known = [false; WINDOW * WINDOW];
    let slot = |[x, y]: [i32; 2]| (y + REACH) as usize * WINDOW + (x + REACH) as usize;
    is_known[slot([0, 0])] = true;
    let mut found = vec![([0, 0], source)];
    let mut next = 0;
    while let Some(&([x, y], index)) = found.get(next) {
        next += 1;
        for step in (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y])) {
            let place: [i32; 2] = [x + step[0], y + step[1]];
            if place.iter().any(|along| along.abs() > REACH)
                || is_known[slot(place)]
                || !field.links[index].reaches(step)
            {
                continue;
            }
            let Some(other) = field.step(index, step).filter(|&other| field.is_measured(other)) else { continue };
            is_known[slot(place)] = true;
            found.push((place, other));
        }
    }
    found
}

/// The value at a texel by the plane through the measured ones around `source`.
fn carried_on(field: &Field, source: usize, index: usize) -> Vec3 {
    let way = offset(field, source, index);
    let way = way * (f64::from(LONGEST) / way.abs().max_element()).min(1.0);
    let around = around(field, source);
    let term = |[x, y]: [i32; 2]| DVec3::new(1.0, x.into(), y.into());
    let weight = |place: [i32; 2]| 1.0 / term(place).length_squared();
    let mut moments = DMat3::from_diagonal(DVec3::new(0.0, LEVEL, LEVEL));
    for &(place, _) in &around {
        let term = term(place);
        let scaled = term * weight(place);
        moments += DMat3::from_cols(term * scaled.x, term * scaled.y, term * scaled.z);
    }
    let target = moments.inverse() * DVec3::new(1.0, way.x, way.y);
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::ZERO);
    let mut value = DVec3::ZERO;
    for &(place, texel) in &around {
        let measured = field.value[texel].as_dvec3();
        (low, high) = (low.min(measured), high.max(measured));
        value += measured * (weight(place) * target.dot(term(place)));
    }
    let range = high - low;
    // Where all is the same the sum may still be a rounding off; the bounds are then the value itself.
    value.clamp(low - range.min(0.5 * low), high + range).as_vec3()
}

/// Gives what is still empty in a block that holds anything the value of the nearest in it.
fn complete_blocks(field: &mut Field, owners: &mut Owners) {
    let [width, height] = field.size;
    for top in (0..height).step_by(BLOCK as usize) {
        for left in (0..width).step_by(BLOCK as usize) {
            let rows = top..(top + BLOCK).min(height);
            let texels = rows.flat_map(|y| (left..(left + BLOCK).min(width)).map(move |x| (y * width + x) as usize));
            let (filled, empty): (Vec<usize>, Vec<usize>) = texels.partition(|&texel| owners.source[texel] != NONE);
            if filled.is_empty() {
                continue;
            }
            for texel in empty {
                let distance = |&other: &usize| (offset(field, other, texel).length_squared() as u64, other);
                let Some(nearest) = filled.iter().copied().min_by_key(distance) else { continue };
                field.value[texel] = field.value[nearest];
                owners.source[texel] = owners.source[nearest];
            }
        }
    }
}

#[cfg(test)]
#[path = "dilate/tests.rs"]
mod tests;

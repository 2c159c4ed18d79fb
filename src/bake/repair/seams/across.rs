//! What texels beside a chart hold where its surface goes on in another chart: the light there, read beyond the joint.
//! Owns the values of filled texels at joints before they are solved for; measured ones are read and never written.
//!
//! A texel beyond a chart's edge stands for the surface beyond the joint. The two triangles at the joint are unfolded
//! into one plane, in which that texel's centre falls somewhere on the other chart; what a bilinear lookup shows there
//! is what it gets, if all four texels of that hang together with the joint. So charts whose texels are in line show
//! the same light with nothing left to solve. (Carrying a chart's own light on, as is done where nothing adjoins, is
//! good to first order only, and where a shadow begins it is off by half the light.)

use super::super::lookup::Filtering;
use super::samples::{Reading, Sample};
use super::{Field, Place};
use glam::{DVec2, DVec3};
use std::collections::{BTreeMap, BTreeSet};

/// How far off the edge a texel's centre may lie inside it, for a texel that is none of the chart's [texels].
const INSIDE: f64 = 0.1;

/// How much of a lookup may be missing: where the texels of two charts are in line, a texel beyond the edge has a
/// weight by the rounding of the charts' places.
const MISSING: f64 = 0.1;

/// What may be read for the other side of a joint, one pass after the other.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// What was measured.
    Measured,
    /// And what was read in the pass before: where three charts meet, a texel beyond the corner of one stands for the
    /// third.
    Read,
    /// And what a chart's own light was carried on to: beyond the end of a joint, where nothing adjoins.
    CarriedOn,
}

/// What was read across a joint for one texel.
struct Read {
    /// Squared distance from the joint's point [texels²].
    distance: f64,
    value: DVec3,
}

/// Reads filled texels across the joints, each at the nearest point.
pub(super) fn read_across(fields: &mut [Field], samples: &[Sample]) {
    let mut reader = Reader { beyond: beyond(fields, samples), known: BTreeSet::new() };
    for pass in [Pass::Measured, Pass::Read, Pass::CarriedOn] {
        for (place, Read { value, .. }) in reader.read(fields, samples, pass) {
            let (page, texel) = place;
            fields[page as usize].value[texel as usize] = value.as_vec3();
            reader.known.insert(place);
        }
    }
}

/// Both sides of a sample, each with the other.
fn sides(sample: &Sample) -> [[&Reading; 2]; 2] {
    let [a, b] = &sample.sides;
    [[a, b], [b, a]]
}

/// The filled texels that lie beyond a joint.
fn beyond(fields: &[Field], samples: &[Sample]) -> BTreeSet<Place> {
    let of_side = |side: &Reading| {
        let field = &fields[side.page as usize];
        let is_beyond = |texel: u32| !field.is_measured(texel as usize) && way_beyond(field, side, texel).is_some();
        side.moving
            .iter()
            .copied()
            .filter(|&texel| is_beyond(texel))
            .map(|texel| (side.page, texel))
            .collect::<Vec<_>>()
    };
    samples.iter().flat_map(|sample| &sample.sides).flat_map(of_side).collect()
}

/// The way to a texel's centre beyond the edge: along the joint and out of the surface [m].
fn way_beyond(field: &Field, side: &Reading, texel: u32) -> Option<DVec2> {
    let way = side.metres * (centre(field, texel) - side.place);
    let limit = INSIDE * side.metres.determinant().abs().sqrt();
    (way.y <= limit).then_some(way)
}

struct Reader {
    /// Texels to read for.
    beyond: BTreeSet<Place>,
    /// Those that were.
    known: BTreeSet<Place>,
}

impl Reader {
    /// One pass, over all that is not known yet.
    fn read(&self, fields: &[Field], samples: &[Sample], pass: Pass) -> BTreeMap<Place, Read> {
        let mut found: BTreeMap<Place, Read> = BTreeMap::new();
        for [side, other] in samples.iter().flat_map(sides) {
            let field = &fields[side.page as usize];
            for &texel in &side.moving {
                let place = (side.page, texel);
                if !self.beyond.contains(&place) || self.known.contains(&place) {
                    continue;
                }
                let distance = (centre(field, texel) - side.place).length_squared();
                if found.get(&place).is_some_and(|read| read.distance <= distance) {
                    continue;
                }
                let Some(way) = way_beyond(field, side, texel) else { continue };
                let is_there = |texel: u32| {
                    other.hangs_together(texel)
                        && self.may_read(&fields[other.page as usize], (other.page, texel), pass)
                };
                if let Some(value) = across(&fields[other.page as usize], other, way, is_there) {
                    found.insert(place, Read { distance, value });
                }
            }
        }
        found
    }

    fn may_read(&self, field: &Field, place: Place, pass: Pass) -> bool {
        let (_, texel) = place;
        match pass {
            Pass::Measured => field.is_measured(texel as usize),
            Pass::Read => field.is_measured(texel as usize) || self.known.contains(&place),
            // Where each stands for the other, as about the pole of a sphere, neither says more.
            Pass::CarriedOn => !self.beyond.contains(&place) || self.known.contains(&place),
        }
    }
}

/// What the other side shows of a place beyond the edge of one [cd/m²].
fn across(field: &Field, other: &Reading, way: DVec2, is_there: impl Fn(u32) -> bool) -> Option<DVec3> {
    let point = other.place + other.metres.inverse() * DVec2::new(way.x, -way.y);
    let (mut value, mut weights) = (DVec3::ZERO, 0.0);
    for (texel, weight) in Filtering::Bilinear.taps(field.size, point).iter() {
        if is_there(texel as u32) {
            value += weight * field.value[texel].as_dvec3();
            weights += weight;
        }
    }
    (weights >= 1.0 - MISSING).then(|| value / weights)
}

/// Where a texel's centre is [texels].
fn centre(field: &Field, texel: u32) -> DVec2 {
    let [width, _] = field.size;
    DVec2::new(f64::from(texel % width) + 0.5, f64::from(texel / width) + 0.5)
}

//! What texels beside a chart hold where its surface goes on in another chart: the light there, read beyond the joint.
//! Owns the values of filled texels at joints before they are solved for; measured ones are read and never written.
//!
//! A texel beyond a chart's edge stands for the surface beyond the joint. The two triangles at the joint are unfolded
//! into one plane, in which that texel's centre falls somewhere on the other chart; what a bilinear lookup shows there
//! is what it gets, if all four texels of that hang together with the joint. So charts whose texels are in line show the
//! same light with nothing left to solve. (Carrying a chart's own light on, as is done where nothing adjoins, is good to
//! first order only, and where a shadow begins it is off by half the light.)

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
    let mut known = BTreeSet::new();
    for pass in [Pass::Measured, Pass::Read, Pass::CarriedOn] {
        for (place, Read { value, .. }) in read(fields, samples, &known, pass) {
            let (page, texel) = place;
            fields[page as usize].value[texel as usize] = value.as_vec3();
            known.insert(place);
        }
    }
}

/// One pass, over all that is not known yet.
fn read(fields: &[Field], samples: &[Sample], known: &BTreeSet<Place>, pass: Pass) -> BTreeMap<Place, Read> {
    let mut found: BTreeMap<Place, Read> = BTreeMap::new();
    let is_known =
        |page: u32, texel: u32| fields[page as usize].is_measured(texel as usize) || known.contains(&(page, texel));
    for sample in samples {
        let [a, b] = &sample.sides;
        for (side, other) in [(a, b), (b, a)] {
            let field = &fields[side.page as usize];
            for &texel in side.moving.iter().filter(|&&texel| !is_known(side.page, texel)) {
                let way = centre(field, texel) - side.place;
                let place = (side.page, texel);
                let distance = way.length_squared();
                if found.get(&place).is_some_and(|read| read.distance <= distance) {
                    continue;
                }
                let is_there =
                    |texel| other.hangs_together(texel) && (pass == Pass::CarriedOn || is_known(other.page, texel));
                if let Some(value) = across(&fields[other.page as usize], side, other, way, is_there) {
                    found.insert(place, Read { distance, value });
                }
            }
        }
    }
    found
}

/// What the other side shows of a place beyond the edge of one [cd/m²].
fn across(field: &Field, side: &Reading, other: &Reading, way: DVec2, is_there: impl Fn(u32) -> bool) -> Option<DVec3> {
    let [along, inwards] = (side.metres * way).to_array();
    let limit = INSIDE * side.metres.determinant().abs().sqrt();
    if inwards > limit {
        return None;
    }
    let point = other.place + other.metres.inverse() * DVec2::new(along, -inwards);
    let (mut value, mut weights) = (DVec3::ZERO, 0.0);
    for (texel, weight) in
        Filtering::Bilinear.taps(field.size, point).iter().filter(|&(texel, _)| is_there(texel as u32))
    {
        value += weight * field.value[texel].as_dvec3();
        weights += weight;
    }
    (weights >= 1.0 - MISSING).then(|| value / weights)
}

/// Where a texel's centre is [texels].
fn centre(field: &Field, texel: u32) -> DVec2 {
    let [width, _] = field.size;
    DVec2::new(f64::from(texel % width) + 0.5, f64::from(texel / width) + 0.5)
}

//! What texels beside a chart hold where its surface goes on in another chart: the light there, read beyond the joint.
//! Owns the values of filled texels at joints before they are solved for; measured ones are read and never written.
//!
//! A texel beyond a chart's edge stands for the surface beyond the joint. The two triangles at the joint are unfolded
//! into one plane, in which that texel's centre falls somewhere on the other chart; what a bilinear lookup shows there
//! is what it gets. (Carrying a chart's own light on, as is done where nothing adjoins, is good to first order only, and
//! where a shadow begins it is off by half the light.) All four texels of such a lookup must be measured and hang
//! together with the joint.

use super::super::lookup::Filtering;
use super::samples::{Reading, Sample};
use super::{Field, Place};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// How far off the edge a texel's centre may lie inside it, for a texel that is none of the chart's [texels].
const INSIDE: f64 = 0.1;

/// A texel with less than this weight is not read: where the texels of two charts are in line it is there by rounding.
const LEAST: f64 = 1e-3;

/// What was read across a joint for one texel.
struct Read {
    /// Squared distance from the joint's point [texels²].
    distance: f64,
    value: DVec3,
}

/// Reads filled texels across the joints, each at the nearest point.
pub(super) fn read_across(fields: &mut [Field], samples: &[Sample]) {
    let mut found: BTreeMap<Place, Read> = BTreeMap::new();
    for sample in samples {
        let [a, b] = &sample.sides;
        for (side, other) in [(a, b), (b, a)] {
            let field = &fields[side.page as usize];
            for &texel in side.moving.iter().filter(|&&texel| !field.is_measured(texel as usize)) {
                let way = centre(field, texel) - side.place;
                let place = (side.page, texel);
                let distance = way.length_squared();
                if found.get(&place).is_some_and(|known| known.distance <= distance) {
                    continue;
                }
                if let Some(value) = across(&fields[other.page as usize], side, other, way) {
                    found.insert(place, Read { distance, value });
                }
            }
        }
    }
    for ((page, texel), Read { value, .. }) in found {
        fields[page as usize].value[texel as usize] = value.as_vec3();
    }
}

/// What the other side shows of a place beyond the edge of one [cd/m²].
fn across(field: &Field, side: &Reading, other: &Reading, way: DVec2) -> Option<DVec3> {
    let [along, inwards] = (side.metres * way).to_array();
    let limit = INSIDE * side.metres.determinant().abs().sqrt();
    if inwards > limit {
        return None;
    }
    let point = other.place + other.metres.inverse() * DVec2::new(along, -inwards);
    let (mut value, mut weights) = (DVec3::ZERO, 0.0);
    for (texel, weight) in Filtering::Bilinear.taps(field.size, point).iter().filter(|(_, weight)| *weight > LEAST) {
        let is_there = field.is_measured(texel) && other.moving.contains(&(texel as u32));
        value += is_there.then(|| weight * field.value[texel].as_dvec3())?;
        weights += weight;
    }
    Some(value / weights)
}

/// Where a texel's centre is [texels].
fn centre(field: &Field, texel: u32) -> DVec2 {
    let [width, _] = field.size;
    DVec2::new(f64::from(texel % width) + 0.5, f64::from(texel / width) + 0.5)
}

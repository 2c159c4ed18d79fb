//! Which texels can be measured, where from, and which neighbours see each other.
//!
//! A texel may lie under a pillar, inside a wall that was pushed through it, or across the foot of a wall, with one
//! part in a lit room and the other in the dark. Its mean over all that is the light of no place, and filtering then
//! carries it to where it is seen: the dark edges and light leaks of lightmaps. So each texel gets an *anchor*, the
//! place on it that stands for the largest part that hangs together in sight, parts inside of bodies excepted; paths
//! start only where one can go from the anchor without passing through a surface. A texel that lies inside of bodies
//! altogether, and in the dark, is *hidden*: it has no value, and nothing reads it. *Links* say between which
//! neighbours one can pass, so that what mixes texels later on mixes no two rooms.
//!
//! The idea of asking rays along the surface is that of the bakers that move texels out of geometry (Bakery; Unity's
//! push-off); here nothing is moved by a length that someone has to choose.

use super::atlas::Atlas;
use super::gather::{KeyKind, key};
use super::sites::Covered;
use super::texel::Texel;
use super::workers::Workers;
use super::{BakeError, BakeSettings};
use crate::math::combine;
use crate::trace::{PathStart, Sobol, Tally, Tracer, Transport};
use glam::{DVec2, Vec3};
use std::cmp::Reverse;
use std::collections::HashMap;

/// Places on a texel of which one becomes its anchor.
const CANDIDATES: usize = 8;

/// Paths that look for light where a texel seems to lie inside a body, and bounces after which they give up.
const PROBES: u64 = 32;
const PROBE_BOUNCES: u32 = 32;

/// What a texel stands on.
#[derive(Clone, Debug)]
pub(super) struct Footing {
    /// The place that stands for the texel.
    pub(super) anchor: PathStart,
    /// More places of the same part, where not all of it can be seen from the anchor.
    pub(super) others: Box<[PathStart]>,
    /// Whether the texel lies inside of bodies, and in the dark.
    pub(super) is_hidden: bool,
    /// Whether a part of the texel that is seen cannot be reached from there.
    pub(super) is_split: bool,
    /// The neighbours that can be reached from here.
    pub(super) links: Links,
}

impl Footing {
    /// Whether one can go from the anchor to a place on the texel without passing through a surface.
    pub(super) fn reaches(&self, tracer: &Tracer, place: &PathStart) -> bool {
        tracer.is_open_between(&self.anchor, place)
            || self.others.iter().any(|other| tracer.is_open_between(other, place))
    }
}

/// The neighbours of a texel, in its own chart, that can be reached without passing through a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Links(u8);

/// Steps to four of the eight neighbours; the other four are their opposites.
const STEPS: [[i32; 2]; 4] = [[1, 0], [-1, 1], [0, 1], [1, 1]];

impl Links {
    /// Links in all directions.
    #[cfg(test)]
    pub(super) const ALL: Self = Self(0xff);

    /// Whether the neighbour at a step of −1, 0 or 1 along each axis can be reached.
    pub(super) fn reaches(self, step: [i32; 2]) -> bool {
        self.0 & Self::bit(step) != 0
    }

    pub(super) fn add(&mut self, step: [i32; 2]) {
        self.0 |= Self::bit(step);
    }

    /// A bit for each step; none for no step at all.
    fn bit([x, y]: [i32; 2]) -> u8 {
        let place = (y + 1) * 3 + x + 1;
        match place {
            0..=3 => 1 << place,
            5..=8 => 1 << (place - 1),
            _ => 0,
        }
    }
}

/// The footing of every texel, in their order.
pub(super) fn footings(
    tracer: &Tracer,
    atlas: &Atlas<'_>,
    texels: &[Covered],
    settings: &BakeSettings,
    workers: &Workers<'_>,
) -> Result<Vec<Footing>, BakeError> {
    let mut footings = workers.gather_quietly(texels, |covered, cancel| {
        if cancel.is_cancelled() { None } else { Some(footing(tracer, covered, settings)) }
    })?;
    let at: HashMap<(u32, u32), usize> =
        texels.iter().enumerate().map(|(number, texel)| ((texel.page, texel.index), number)).collect();
    let neighbour = |number: usize, [x, y]: [i32; 2]| {
        let Covered { page, index, chart, .. } = texels[number];
        let width = atlas.pages[page as usize][0];
        let column = (index % width).checked_add_signed(x).filter(|&column| column < width)?;
        let row = (index / width).checked_add_signed(y)?;
        let other = *at.get(&(page, row * width + column))?;
        (texels[other].chart == chart).then_some(other)
    };
    let numbers: Vec<usize> = (0..texels.len()).collect();
    let opened = workers.gather_quietly(&numbers, |&number, cancel| {
        let here = &footings[number];
        let open = |step| {
            let other = neighbour(number, step)?;
            let there = &footings[other];
            let is_seen = !here.is_hidden && !there.is_hidden;
            let is_reached = is_seen && (here.reaches(tracer, &there.anchor) || there.reaches(tracer, &here.anchor));
            is_reached.then_some(other)
        };
        (!cancel.is_cancelled()).then(|| STEPS.map(open))
    })?;
    for (number, opened) in opened.into_iter().enumerate() {
        for (step, other) in STEPS.into_iter().zip(opened) {
            let Some(other) = other else { continue };
            footings[number].links.add(step);
            footings[other].links.add(step.map(i32::wrapping_neg));
        }
    }
    Ok(footings)
}

/// A texel's footing, without links.
fn footing(tracer: &Tracer, covered: &Covered, settings: &BakeSettings) -> Footing {
    let parts = parts(tracer, &covered.texel);
    // Within a part all is inside of bodies or nothing.
    let enclosed: Vec<bool> = parts.iter().map(|part| tracer.is_enclosed(&part[0])).collect();
    let best = (0..parts.len()).max_by_key(|&part| (!enclosed[part], parts[part].len(), Reverse(part)));
    let best = best.unwrap_or(0);
    let anchor = parts[best][0];
    let is_hidden = enclosed[best] && is_dark(tracer, &anchor, covered.key, &settings.transport);
    let is_split = (0..parts.len()).any(|part| part != best && !enclosed[part]);
    // Where all is one part and in sight of its first place, that is enough.
    let others = if parts.len() == 1 && parts[0].len() == 1 { Box::default() } else { parts[best][1..].into() };
    Footing { anchor, others, is_hidden, is_split, links: Links::default() }
}

/// The parts of a texel: places between which one can go by way of one another. One place alone stands for the texel
/// if all the others can be seen from it.
fn parts(tracer: &Tracer, texel: &Texel) -> Vec<Vec<PathStart>> {
    let place = |index: usize| {
        // From the middle outwards (Roberts 2018).
        let place = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2) * index as f64 + 0.5;
        texel.inner_start(tracer, (place - place.floor()).as_vec2())
    };
    let places: Vec<PathStart> = (0..CANDIDATES).map(place).collect();
    if places.iter().all(|place| tracer.is_open_between(&places[0], place)) {
        return vec![vec![places[0]]];
    }
    let mut parts: Vec<Vec<PathStart>> = Vec::new();
    for place in places {
        let sees = |part: &Vec<PathStart>| part.iter().any(|other| tracer.is_open_between(other, &place));
        let (seen, mut rest): (Vec<_>, Vec<_>) = parts.into_iter().partition(sees);
        // What is seen from one place is one part.
        let mut joined: Vec<PathStart> = seen.into_iter().flatten().collect();
        joined.push(place);
        rest.push(joined);
        parts = rest;
    }
    parts
}

/// Whether a few short paths find no light at all.
fn is_dark(tracer: &Tracer, start: &PathStart, texel: u64, transport: &Transport) -> bool {
    let cap = transport.max_bounces.map_or(PROBE_BOUNCES, |bounces| bounces.min(PROBE_BOUNCES));
    let short = Transport { max_bounces: Some(cap), ..*transport };
    let probe = key(KeyKind::Probe, transport.seed, texel, 0);
    let mut tally = Tally::default();
    (0..PROBES).all(|path| {
        let sobol = Sobol::new(combine(probe, path >> 4), path);
        tracer.diffuse_radiance(start, &sobol, &short, &mut tally) == Vec3::ZERO
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_neighbour_has_a_link_of_its_own() {
        let steps = STEPS.into_iter().flat_map(|step| [step, step.map(i32::wrapping_neg)]);
        let mut links = Links::default();
        for step in steps.clone() {
            assert!(!links.reaches(step), "{step:?}");
            links.add(step);
            assert!(links.reaches(step), "{step:?}");
        }
        assert_eq!(links, Links::ALL);
        assert!(!links.reaches([0, 0]));
        assert_eq!(steps.count(), 8);
    }
}

//! Points along the joints at which two lookups should agree, and which texels may move for it. Owns the question
//! whether the surface is meant to be one across a joint; solves nothing.
//!
//! A joint is left alone where the receiving normals differ (a hard edge), where both sides lie on the same side of the
//! line (a fold, or a face that is there twice), where something stands between the two sides, and where the texels
//! beside it belong to another room or to none. Of the texels that the lookups read only those may move that hang
//! together with the joint by links: what lies beyond a wall keeps its light.

use super::super::dilate::Owners;
use super::super::lookup::{DisplayedRect, Filtering};
use super::borders::{Border, Joint};
use crate::bake::charts::Charts;
use crate::bake::repair::{Field, Surroundings, TexelState};
use crate::trace::PathStart;
use glam::{DMat2, DVec2, DVec3, Vec3};

/// Samples of a joint lie farther apart than this [texels of the finer side].
const CLOSEST: f64 = 0.02;

/// And no farther than this.
const FARTHEST: f64 = 0.2;

/// Where the light changes by more than this share of it from one to the next there are more between them, up to this
/// number of steps.
const STEEP: f64 = 0.01;
const MOST_BETWEEN: f64 = 12.0;

/// A joint that is shorter than this has a single one [texels of the finer side].
const SHORT: f64 = 0.2;

/// The least cosine between receiving normals across a joint: 5°.
const SMOOTH: f32 = 0.996_194_7;

/// How far beside the joint it is asked what stands on it [texels].
const ASIDE: f64 = 0.25;

/// The largest weight of the corner beyond the edge at such a place.
const MOST_ASIDE: f64 = 1.0 / 3.0;

/// The local value is at least this share of the brightest texel that the lookups read.
const LEAST_LOCAL: f64 = 0.02;

/// Lookups that lie closer on the same page are the same [texels].
const SAME_PLACE: f64 = 1e-3;

/// What lies within this of a lookup may be read for the other side [texels]: what fills its second ring there, and a
/// texel more for what is read between two.
const AROUND: f64 = 3.0;

/// A texel in a row of equations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// Page and texel.
    pub(super) texel: (u32, u32),
    /// Its weight in the one lookup less that in the other.
    pub(super) weight: f64,
}

/// How two lookups at one point differ.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// Before anything moves [cd/m²].
    pub(super) difference: DVec3,
    /// The mean of both [cd/m²].
    pub(super) mean: DVec3,
    /// What the local value is at least [cd/m²].
    pub(super) floor: f64,
    /// The texels that may move.
    pub(super) entries: Vec<Entry>,
}

/// How a page is read on one side of a point of a joint.
#[derive(Clone, Debug)]
pub(super) struct Reading {
    pub(super) page: u32,
    /// Where [texels].
    pub(super) place: DVec2,
    /// From texels to metres along the joint and into the surface on this side.
    pub(super) metres: DMat2,
    /// The texels that lookups there read and that may move.
    pub(super) moving: Vec<u32>,
    /// Those around them that hang together with them.
    pub(super) around: Vec<u32>,
}

impl Reading {
    /// Whether a texel hangs together with the joint.
    pub(super) fn hangs_together(&self, texel: u32) -> bool {
        self.moving.contains(&texel) || self.around.contains(&texel)
    }
}

/// A point of a joint.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    /// Which joint.
    pub(super) joint: u32,
    pub(super) sides: [Reading; 2],
    /// What the local value of both lookups is at least [cd/m²].
    pub(super) floor: f64,
    /// For each kind of filtering.
    pub(super) rows: [Row; 2],
}

impl Row {
    /// The local value before anything moves [cd/m²].
    pub(super) fn local(&self) -> f64 {
        self.mean.max_element().max(self.floor)
    }
}

impl Sample {
    /// The larger of both local values before anything moves [cd/m²].
    pub(super) fn local(&self) -> f64 {
        self.rows.iter().map(Row::local).fold(0.0, f64::max)
    }
}

/// What samples are made from.
pub(super) struct Sampling<'a> {
    pub(super) place: &'a Surroundings<'a>,
    pub(super) fields: &'a [Field],
    pub(super) owners: &'a [Owners],
    pub(super) borders: &'a [Border],
    pub(super) charts: Charts,
    /// By page and texel, the place in the list of sites.
    pub(super) sites: Vec<Vec<u32>>,
    /// By receiver.
    pub(super) rects: Vec<DisplayedRect>,
}

/// One side of a joint at a sample.
struct Side<'a> {
    border: &'a Border,
    page: u32,
    /// Where it is read [texels].
    place: DVec2,
    normal: Vec3,
    /// Across the edge, into the triangle, in the world.
    inwards: DVec3,
    /// What a step of a texel is in the world [m].
    steps: [DVec3; 2],
    /// A place on the triangle beside the joint.
    beside: PathStart,
    /// Where that is read [texels].
    place_beside: DVec2,
}

impl<'a> Sampling<'a> {
    /// The samples of a joint.
    pub(super) fn samples(&self, number: u32, joint: &Joint) -> Vec<Sample> {
        let [a, b] = joint.edges.map(|edge| &self.borders[edge as usize]);
        let sample = |at: f64| {
            let point = a.ends[0].lerp(a.ends[1], at);
            let sides = [self.side(a, at)?, self.side(b, b.parameter(point).clamp(0.0, 1.0))?];
            self.sample(number, &sides)
        };
        let even: Vec<(f64, Sample)> =
            places(a, b, joint).into_iter().filter_map(|at| Some((at, sample(at)?))).collect();
        let between = |pair: &[(f64, Sample)]| {
            let [(from, first), (to, second)] = [&pair[0], &pair[1]];
            let (dark, bright) = (first.local().min(second.local()), first.local().max(second.local()));
            let count = ((bright - dark) / (STEEP * dark)).clamp(1.0, MOST_BETWEEN) as u32;
            let (from, width) = (*from, to - from);
            (1..count).map(move |step| from + width * f64::from(step) / f64::from(count))
        };
        let more: Vec<f64> = even.windows(2).flat_map(between).collect();
        even.into_iter().map(|(_, sample)| sample).chain(more.into_iter().filter_map(sample)).collect()
    }

    /// A sample between two sides, if the surface is one there.
    fn sample(&self, joint: u32, sides: &[Side<'_>; 2]) -> Option<Sample> {
        let [a, b] = sides;
        let is_same = a.page == b.page && a.place.distance(b.place) < SAME_PLACE;
        if is_same || a.normal.dot(b.normal) < SMOOTH {
            return None;
        }
        // Sides of the line, seen from above.
        let along = a.border.ends[1] - a.border.ends[0];
        let across = (a.normal + b.normal).as_dvec3().cross(along);
        if a.inwards.dot(across) * b.inwards.dot(across) >= 0.0
            || !self.place.tracer.is_open_between(&a.beside, &b.beside)
        {
            return None;
        }
        let reading = |side: &Side<'_>| {
            let [right, down] = side.steps;
            let axes = [along.normalize(), side.inwards.normalize()];
            let metres = DMat2::from_cols_array_2d(&[right, down].map(|step| axes.map(|axis| axis.dot(step))));
            let [moving, around] = self.texels(side)?;
            Some(Reading { page: side.page, place: side.place, metres, moving, around })
        };
        Sample::new(joint, [reading(a)?, reading(b)?], self.fields)
    }
}

impl Sample {
    /// `None` where there is no light.
    pub(super) fn new(joint: u32, sides: [Reading; 2], fields: &[Field]) -> Option<Self> {
        let mut rows = Filtering::ALL.map(|filtering| Row::new(filtering, &sides, fields));
        // What the one lookup reads may move what the other does.
        let floor = rows.iter().map(|row| row.floor).fold(0.0, f64::max);
        rows.iter_mut().for_each(|row| row.floor = floor);
        (floor > 0.0 && floor.is_finite()).then_some(Self { joint, sides, rows, floor })
    }
}

impl Row {
    /// How the two sides differ by one kind of filtering.
    fn new(filtering: Filtering, sides: &[Reading; 2], fields: &[Field]) -> Self {
        let mut row = Self { difference: DVec3::ZERO, mean: DVec3::ZERO, floor: 0.0, entries: Vec::new() };
        for (side, sign) in sides.iter().zip([1.0, -1.0]) {
            let field = &fields[side.page as usize];
            for (texel, weight) in filtering.taps(field.size, side.place).iter() {
                let value = field.value[texel].as_dvec3();
                row.floor = row.floor.max(LEAST_LOCAL * value.max_element());
                row.difference += sign * weight * value;
                row.mean += 0.5 * weight * value;
                if side.moving.contains(&(texel as u32)) && weight != 0.0 {
                    row.entries.push(Entry { texel: (side.page, texel as u32), weight: sign * weight });
                }
            }
        }
        row
    }
}

impl<'a> Sampling<'a> {
    /// One side of a joint, at a place in parts of its edge.
    fn side(&self, border: &'a Border, at: f64) -> Option<Side<'a>> {
        let rectangle = &self.place.atlas.charts[border.receiver as usize];
        let number = rectangle.receiver.first_triangle + border.triangle;
        let world = self.place.tracer.vertices(number).map(Vec3::as_dvec3);
        let turn = [0, 1, 2].map(|step| (border.corner + step) % 3);
        let [from, to, beyond] = turn.map(|corner| world[corner]);
        let foot = border.parameter(beyond);
        let inwards = beyond - from.lerp(to, foot);
        let height = inwards.length();
        let mut aside = (ASIDE * border.texel / height).min(MOST_ASIDE);
        // Straight inwards, as far as the triangle goes.
        let second = |aside: f64| at - aside * foot;
        while aside > 1e-6 && (second(aside) < 0.0 || second(aside) > 1.0 - aside) {
            aside *= 0.5;
        }
        let second = second(aside).clamp(0.0, 1.0 - aside);
        let in_turn = [1.0 - aside - second, second, aside];
        let on_edge = [1.0 - at, at, 0.0];
        let normals = rectangle.receiver.vertices[border.triangle as usize]
            .map(|vertex| rectangle.receiver.normals[vertex as usize]);
        let start = |weights: [f64; 3]| {
            let mut by_corner = [0.0; 3];
            turn.iter().zip(weights).for_each(|(&corner, weight)| by_corner[corner] = weight as f32);
            self.place.tracer.start_on_smooth_triangle(number, [by_corner[1], by_corner[2]], normals)
        };
        let size = DVec2::new(rectangle.size[0].into(), rectangle.size[1].into());
        let texels = rectangle.triangle(border.triangle);
        let read = |weights: [f64; 3]| {
            let texel: DVec2 = turn.iter().zip(weights).map(|(&corner, weight)| weight * texels[corner]).sum();
            self.rects[border.receiver as usize].point(texel / size)
        };
        let places = texels.map(|texel| self.rects[border.receiver as usize].point(texel / size));
        let on_page = DMat2::from_cols(places[1] - places[0], places[2] - places[0]).inverse();
        let steps = [on_page.x_axis, on_page.y_axis]
            .map(|step| step.x * (world[1] - world[0]) + step.y * (world[2] - world[0]));
        (height.is_finite() && on_page.is_finite()).then(|| Side {
            border,
            page: rectangle.page,
            place: read(on_edge),
            normal: start(on_edge).normal(),
            inwards,
            steps,
            beside: start(in_turn),
            place_beside: read(in_turn),
        })
    }

    /// The texels around a side that hang together with the place beside the joint: those that lookups read, and more
    /// around them. `None` where the nearest is hidden, or of another room.
    fn texels(&self, side: &Side<'_>) -> Option<[Vec<u32>; 2]> {
        let field = &self.fields[side.page as usize];
        let owners = &self.owners[side.page as usize];
        let chart = self.charts.of(side.border.receiver, side.border.triangle);
        let taps = Filtering::Bicubic.taps(field.size, side.place);
        let width = field.size[0] as usize;
        let distance = |texel: usize| {
            let centre = DVec2::new((texel % width) as f64 + 0.5, (texel / width) as f64 + 0.5);
            centre.distance_squared(side.place_beside)
        };
        let texels = || taps.iter().map(|(texel, _)| texel);
        let covered = texels().filter(|&texel| field.state[texel] != TexelState::Empty && field.chart[texel] == chart);
        let nearest = covered.min_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)))?;
        if !field.is_measured(nearest) {
            return None;
        }
        let site = &self.place.sites[self.sites[side.page as usize][nearest] as usize];
        let is_open = self.place.tracer.is_open_between(&site.footing.anchor, &side.beside);
        is_open.then(|| {
            let moving = flood(field, owners, &texels().collect::<Vec<_>>(), nearest);
            let mut around = flood(field, owners, &near(side.place, field.size), nearest);
            around.retain(|texel| !moving.contains(texel));
            [moving, around]
        })
    }
}

/// Where along a joint lookups are compared, in parts of the first edge: wherever either passes from one set of texels
/// to the next, which is where two that are linear between such places differ most, and in between, for those that are
/// not.
fn places(a: &Border, b: &Border, joint: &Joint) -> Vec<f64> {
    let of_b = |at: f64| b.parameter(a.ends[0].lerp(a.ends[1], at));
    let (b_from, b_to) = (of_b(joint.from), of_b(joint.to));
    let share = joint.to - joint.from;
    let finer = (a.texels() * share).max(b.texels() * (b_to - b_from).abs());
    let mut ends = vec![joint.from, joint.to];
    let mut add = |border: &Border, from: f64, to: f64| {
        let [start, end] = [from, to].map(|at| border.places[0].lerp(border.places[1], at));
        for axis in 0..2 {
            let (low, high) = (start[axis].min(end[axis]), start[axis].max(end[axis]));
            let mut centre = (low - 0.5).ceil() + 0.5;
            while centre < high {
                ends.push(joint.from + share * (centre - start[axis]) / (end[axis] - start[axis]));
                centre += 1.0;
            }
        }
    };
    add(a, joint.from, joint.to);
    add(b, b_from, b_to);
    ends.sort_unstable_by(f64::total_cmp);
    if finer < SHORT {
        return vec![0.5 * (joint.from + joint.to)];
    }
    let closest = CLOSEST * share / finer;
    ends.dedup_by(|next, kept| *next - *kept < closest);
    let farthest = FARTHEST * share / finer;
    let between = |gap: &[f64]| {
        let (from, width) = (gap[0], gap[1] - gap[0]);
        let count = (width / farthest).ceil().max(1.0) as u32;
        (1..count).map(move |step| from + width * f64::from(step) / f64::from(count))
    };
    let between: Vec<f64> = ends.windows(2).flat_map(between).collect();
    ends.extend(between);
    ends.sort_unstable_by(f64::total_cmp);
    ends
}

/// Those of a few texels that hang together with one of them: measured ones by links, and what was filled from those.
fn flood(field: &Field, owners: &Owners, few: &[usize], from: usize) -> Vec<u32> {
    let mut found = vec![from];
    let mut next = 0;
    while let Some(&texel) = found.get(next) {
        next += 1;
        for step in (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y])) {
            let linked = field.links[texel].reaches(step).then(|| field.step(texel, step)).flatten();
            let linked = linked.filter(|other| field.is_measured(*other) && few.contains(other));
            if let Some(other) = linked.filter(|other| !found.contains(other)) {
                found.push(other);
            }
        }
    }
    let measured = found.len();
    for &texel in few.iter().filter(|&&texel| !field.is_measured(texel)) {
        let Some(source) = owners.source(texel) else { continue };
        // A source that is none of the few lies farther in than those; it may be anyone's.
        let is_ours =
            field.chart[source] == field.chart[from] && (found[..measured].contains(&source) || !few.contains(&source));
        if is_ours && !found.contains(&texel) {
            found.push(texel);
        }
    }
    found.into_iter().map(|texel| texel as u32).collect()
}

/// The texels whose centres lie near a place.
fn near(place: DVec2, [width, height]: [u32; 2]) -> Vec<usize> {
    let range =
        |at: f64, size: u32| (at - AROUND).ceil().max(0.0) as u32..((at + AROUND).floor().max(0.0) as u32).min(size);
    let rows = range(place.y, height);
    rows.flat_map(|row| range(place.x, width).map(move |column| (row * width + column) as usize)).collect()
}

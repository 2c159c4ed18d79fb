//! Walls that stand on a chart: texture filtering must not carry light across them.
//!
//! A floor that runs on under a wall is one chart. Its texels on either side of the wall are neighbours, and a bilinear
//! or bicubic lookup between them mixes both sides, however thin or thick the wall: light leaks into a dark room at the
//! foot of its walls. A chart cannot be bent around the wall, so one side must give way. Where the sides differ by more
//! than [`SAME`], the brighter one does, within the reach of the lookups: shade at the outer foot of a wall is
//! what one expects there, a bright rim in a dark room is not. It is held to the brightest of the other side nearby: no
//! leak is brighter than that.
//!
//! Two texels are on different sides if one cannot be reached from the other by links between neighbours within
//! [`WINDOW`] texels: so the leg of a table, around which one can go, is no wall. And there must be covered texels all
//! the way between them for a wall to stand on: two ends of a bent chart that come close on the page are no neighbours.
//! Nor is what is narrower than a texel a room: nothing gives way for slits of which no texel is in sight by half.

use super::dilate::Owners;
use super::{Field, TexelState};
use crate::math::{Portable, luminance};

/// How far a lookup reads: a bicubic one reads two texels to either side of the texel that it lies in.
const REACH: i32 = 2;

/// How far it is looked for a way around.
const WINDOW: i32 = 8;

/// A side of which less than this share of each texel is in sight, in [0, 1], is a slit: between books on a shelf, or
/// under a door. It is darker than what is beside it, and nobody looks into it; the board before the books is seen.
const LEAST_SEEN: f32 = 0.5;

/// Ratio of the sides' brightness up to which nothing is done, and from which the brighter side is held to the other.
const SAME: f64 = 2.0;
const OTHER: f64 = 8.0;

/// Holds the brighter side of walls to the darker one, in place.
pub(super) fn stop_light_at_walls(field: &mut Field) {
    let mut caps: Vec<(usize, f64)> = Vec::new();
    let mut walk = Walk::default();
    for here in (0..field.value.len()).filter(|&index| field.is_measured(index)) {
        let beyond = beyond(field, here, &mut walk);
        if beyond.is_empty() {
            continue;
        }
        if walk.reached.iter().all(|&index| field.seen[index] < LEAST_SEEN) {
            continue;
        }
        let level = level(field, &walk);
        for there in beyond {
            let brightness = luminance(field.value[there].as_dvec3());
            let cap = brightness.min(held_to(level, brightness));
            if cap < brightness {
                caps.push((there, cap));
            }
        }
    }
    hold(field, caps);
}

/// The same for what was filled in under a wall that is only a few texels wide, between its two sides, in place.
pub(super) fn stop_light_in_walls(field: &mut Field, owners: &Owners) {
    let mut caps: Vec<(usize, f64)> = Vec::new();
    let mut walk = Walk::default();
    for here in (0..field.value.len()).filter(|&index| field.is_measured(index)) {
        let is_inside =
            |index: &usize| field.state[*index] == TexelState::Hidden && field.chart[*index] == field.chart[here];
        let hidden: Vec<usize> = within(field, here, REACH).filter(is_inside).collect();
        if hidden.is_empty() {
            continue;
        }
        walk.reach(field, here, WINDOW);
        let level = level(field, &walk);
        for there in hidden {
            let is_of_this_side = owners.source(there).is_none_or(|source| walk.has_reached(source));
            let brightness = luminance(field.value[there].as_dvec3());
            if !is_of_this_side && held_to(level, brightness) < brightness {
                caps.push((there, held_to(level, brightness)));
            }
        }
    }
    hold(field, caps);
}

/// Holds texels to the least of their caps, in whatever order they were found.
fn hold(field: &mut Field, mut caps: Vec<(usize, f64)>) {
    caps.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    caps.dedup_by_key(|(index, _)| *index);
    for (index, cap) in caps {
        let brightness = luminance(field.value[index].as_dvec3());
        field.value[index] *= (cap / brightness) as f32;
    }
}

/// The texels at most `reach` from one along each axis.
fn within(field: &Field, centre: usize, reach: i32) -> impl Iterator<Item = usize> {
    let steps = (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |x| [x, y]));
    steps.filter_map(move |step| field.step(centre, step))
}

/// What is left of a brightness on the other side of a wall from a darker level.
fn held_to(level: f64, brightness: f64) -> f64 {
    if brightness <= SAME * level {
        return brightness;
    }
    if brightness >= OTHER * level {
        return level;
    }
    // Without a step between the two.
    let part = Portable::ln(brightness / level / SAME) / Portable::ln(OTHER / SAME);
    let part = part * part * (3.0 - 2.0 * part);
    level * Portable::exp((1.0 - part) * Portable::ln(brightness / level))
}

/// Measured texels of the same chart that lookups on this side may read and that lie on the other side of a wall.
fn beyond(field: &Field, here: usize, walk: &mut Walk) -> Vec<usize> {
    let apart = |walk: &Walk, index: usize| {
        field.is_measured(index) && field.chart[index] == field.chart[here] && !walk.has_reached(index)
    };
    // A short walk finds most neighbours where there is no wall.
    walk.reach(field, here, REACH);
    if !within(field, here, REACH).any(|index| apart(walk, index)) {
        return Vec::new();
    }
    let mut ground = Walk::default();
    ground.cover(field, here, REACH + 1);
    walk.reach(field, here, WINDOW);
    let apart = |walk: &Walk, index: usize| ground.has_reached(index) && apart(walk, index);
    let mut beyond: Vec<usize> = within(field, here, REACH).filter(|&index| apart(walk, index)).collect();
    // A texel across which the wall runs has a part on this side, from which lookups reach farther.
    let split: Vec<usize> =
        within(field, here, 1).filter(|&index| apart(walk, index) && field.is_split[index]).collect();
    for texel in split {
        beyond.extend(within(field, texel, REACH).filter(|&index| apart(walk, index)));
    }
    beyond.sort_unstable();
    beyond.dedup();
    beyond
}

/// How bright this side is: the brightest that can be reached within the window, and its error. Not how bright it is at
/// the wall's foot, or a shelf's board between two dark corners of lit compartments would cast shade on both sides.
fn level(field: &Field, walk: &Walk) -> f64 {
    let brightest = |&index: &usize| luminance((field.value[index] + 2.0 * field.stderr[index]).as_dvec3());
    walk.reached.iter().map(brightest).fold(0.0, f64::max)
}

/// The texels that can be reached from one of them.
#[derive(Default)]
struct Walk {
    reached: Vec<usize>,
}

impl Walk {
    /// Walks over links, at most `reach` texels away along each axis.
    fn reach(&mut self, field: &Field, from: usize, reach: i32) {
        self.walk(field, from, reach, |index, step| field.links[index].reaches(step));
    }

    /// Walks over what the chart covers, whatever stands on it, at most `reach` texels away along each axis.
    fn cover(&mut self, field: &Field, from: usize, reach: i32) {
        let is_ground =
            |index: usize| field.state[index] != TexelState::Empty && field.chart[index] == field.chart[from];
        self.walk(field, from, reach, |index, step| field.step(index, step).is_some_and(is_ground));
    }

    /// Walks from neighbour to neighbour, at most `reach` texels away along each axis.
    fn walk(&mut self, field: &Field, from: usize, reach: i32, may_step: impl Fn(usize, [i32; 2]) -> bool) {
        let width = field.size[0] as i32;
        let place = |index: usize| [index as i32 % width, index as i32 / width];
        let [x, y] = place(from);
        self.reached.clear();
        self.reached.push(from);
        let mut seen = vec![false; ((2 * reach + 1) * (2 * reach + 1)) as usize];
        let window = |index: usize| {
            let [column, row] = place(index);
            let [column, row] = [column - x, row - y];
            let is_near = column.abs() <= reach && row.abs() <= reach;
            is_near.then_some(((row + reach) * (2 * reach + 1) + column + reach) as usize)
        };
        seen[(reach * (2 * reach + 1) + reach) as usize] = true;
        let mut next = 0;
        while let Some(&index) = self.reached.get(next) {
            next += 1;
            for step in NEIGHBOURS.into_iter().filter(|&step| may_step(index, step)) {
                let Some(neighbour) = field.step(index, step) else { continue };
                let Some(place) = window(neighbour) else { continue };
                if !std::mem::replace(&mut seen[place], true) {
                    self.reached.push(neighbour);
                }
            }
        }
        self.reached.sort_unstable();
    }

    fn has_reached(&self, index: usize) -> bool {
        self.reached.binary_search(&index).is_ok()
    }
}

/// Steps to the eight neighbours.
const NEIGHBOURS: [[i32; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::validity::Links;
    use glam::Vec3;

    fn white(brightness: f32) -> Vec3 {
        Vec3::splat(brightness)
    }

    /// A chart of 16 × 16 texels, bright on the right of a wall between columns 7 and 8 that has a gap above `gap`.
    fn walled(dark: f32, bright: f32, gap: u32) -> Field {
        let mut field = Field::empty([16, 16]);
        for index in 0..256_usize {
            let [x, y] = [index as u32 % 16, index as u32 / 16];
            field.state[index] = TexelState::Measured;
            field.seen[index] = 1.0;
            field.value[index] = white(if x < 8 { dark } else { bright });
            let mut links = Links::default();
            for step in NEIGHBOURS {
                let crosses = matches!((x, step[0]), (7, 1) | (8, -1));
                let is_on_page = field.step(index, step).is_some();
                if is_on_page && (!crosses || y >= gap) {
                    links.add(step);
                }
            }
            field.links[index] = links;
        }
        field
    }

    #[test]
    fn the_bright_side_gives_way_within_reach() {
        let mut field = walled(0.0, 4.0, 99);
        stop_light_at_walls(&mut field);
        for index in 0..256 {
            let expected = if index % 16 < 10 { 0.0 } else { 4.0 };
            assert_eq!(field.value[index], white(expected), "{index}");
        }
    }

    /// The board before a row of books is no wall's bright side.
    #[test]
    fn a_slit_holds_nothing_down() {
        let mut field = walled(0.0, 4.0, 99);
        (0..256_usize).filter(|index| index % 16 < 8).for_each(|index| field.seen[index] = 0.2);
        let before = field.clone();
        stop_light_at_walls(&mut field);
        assert_eq!(field.value, before.value);
        // One texel in sight makes it a room, as far as one can walk to it.
        field.seen[16 * 8 + 7] = 1.0;
        stop_light_at_walls(&mut field);
        assert_eq!(field.value[16 * 8 + 8], white(0.0));
    }

    #[test]
    fn what_is_about_as_bright_stays() {
        let before = walled(1.0, 1.9, 99);
        let mut field = before.clone();
        stop_light_at_walls(&mut field);
        assert_eq!(field.value, before.value);
    }

    /// Around the end of a wall one can go, so there its sides are one place.
    #[test]
    fn the_end_of_a_wall_parts_nothing() {
        let mut field = walled(0.0, 4.0, 10);
        stop_light_at_walls(&mut field);
        for y in 0..16_usize {
            let is_held = field.value[16 * y + 8] == white(0.0);
            // Texels two rows from the end and more have no way around within the window.
            assert_eq!(is_held, y + (WINDOW as usize) < 10 || y < 4, "{y}: {}", field.value[16 * y + 8]);
        }
    }

    /// Where nothing is covered between two parts of a chart no wall stands.
    #[test]
    fn two_ends_of_a_bent_chart_are_no_neighbours() {
        let mut field = walled(0.0, 4.0, 99);
        for y in 0..16_usize {
            field.state[16 * y + 8] = TexelState::Empty;
            field.links[16 * y + 8] = Links::default();
        }
        let before = field.clone();
        stop_light_at_walls(&mut field);
        assert_eq!(field.value, before.value);
        // A wall as wide as a texel is covered, and hidden.
        let mut field = before;
        (0..16_usize).for_each(|y| field.state[16 * y + 8] = TexelState::Hidden);
        stop_light_at_walls(&mut field);
        assert_eq!(field.value[16 * 8 + 9], white(0.0));
    }

    #[test]
    fn there_is_no_step_in_how_much_gives_way() {
        let mut last = held_to(1.0, 1.0);
        for step in 0..2000 {
            let brightness = 1.0 + 0.005 * f64::from(step);
            let held = held_to(1.0, brightness);
            assert!((held - last).abs() < 0.01 && (1.0..=2.7).contains(&held), "{brightness}: {held}");
            last = held;
        }
        assert_eq!(held_to(0.0, 3.0), 0.0);
    }
}

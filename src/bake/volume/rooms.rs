//! Which probes share a room: those between which one can go, from neighbour to neighbour in sight.
//!
//! Bevy's lookup blends the eight probes around a place whatever stands between, so that a wall thinner than a cell would
//! let light through. A *wall* is what keeps two neighbours from seeing each other where the way around it is long; what
//! can be passed by going a few cells aside, as the edge of a table, is none. *Pockets* are rooms of a few probes or of less
//! than a cubic metre, as the inside of a cupboard: nothing moves there, and what is dark in them is not to darken the room around.

use super::grid::{Grid, steps};
use super::stand::Stand;
use crate::trace::Tracer;
use std::collections::{HashMap, VecDeque};

/// The longest way around what is no wall [cells].
const DETOUR: u32 = 12;

/// The most probes of a pocket, and the most air in it [m³].
const POCKET: usize = 7;
const POCKET_VOLUME: f32 = 1.0;

/// Which probes of a volume see each other.
pub(super) struct Rooms {
    grid: Grid,
    /// Per probe, the neighbours that it sees, by their bits. A probe in a pocket sees none.
    links: Vec<u32>,
    /// Per probe, whether it is one that counts: that stands somewhere, and in no pocket.
    pub(super) is_in_air: Vec<bool>,
    /// Per probe that counts, the number of its room.
    room: Vec<u32>,
}

impl Rooms {
    pub(super) fn new(grid: Grid, stands: &[Stand], links: Vec<u32>) -> Self {
        let is_in_air: Vec<bool> = stands.iter().map(|stand| stand.point().is_some()).collect();
        let mut rooms = Self { grid, links, is_in_air, room: vec![u32::MAX; stands.len()] };
        rooms.find_rooms();
        rooms
    }

    /// The neighbours that a probe sees, by their bits; only half of the directions, from which the others follow.
    pub(super) fn half_links(tracer: &Tracer, grid: &Grid, stands: &[Stand], index: usize) -> u32 {
        let Some(from) = stands[index].point() else { return 0 };
        let sees = |neighbour: usize| stands[neighbour].point().is_some_and(|to| tracer.is_open(from, to));
        let ahead = grid.neighbours(index).filter(|&(_, bit)| bit > 13);
        ahead.filter(|&(neighbour, _)| sees(neighbour)).fold(0, |links, (_, bit)| links | 1 << bit)
    }

    /// All links, from one half of them.
    pub(super) fn both_ways(grid: &Grid, mut links: Vec<u32>) -> Vec<u32> {
        for index in 0..links.len() {
            for (neighbour, bit) in grid.neighbours(index).filter(|&(_, bit)| bit > 13) {
                if links[index] >> bit & 1 == 1 {
                    links[neighbour] |= 1 << (26 - bit);
                }
            }
        }
        links
    }

    /// Numbers the rooms and takes pockets out of the air, unless there is nothing else.
    fn find_rooms(&mut self) {
        let mut sizes = Vec::new();
        for first in 0..self.room.len() {
            if !self.is_in_air[first] || self.room[first] != u32::MAX {
                continue;
            }
            let (number, mut size, mut open) = (sizes.len() as u32, 0, vec![first]);
            self.room[first] = number;
            while let Some(index) = open.pop() {
                size += 1;
                for neighbour in self.linked(index) {
                    if self.room[neighbour] == u32::MAX {
                        self.room[neighbour] = number;
                        open.push(neighbour);
                    }
                }
            }
            sizes.push(size);
        }
        let cell = self.grid.spacing().element_product();
        let is_pocket = |size: usize| size <= POCKET || size as f32 * cell < POCKET_VOLUME;
        if sizes.iter().all(|&size| is_pocket(size)) {
            return;
        }
        for index in 0..self.room.len() {
            if self.is_in_air[index] && is_pocket(sizes[self.room[index] as usize]) {
                self.leave_out(index);
            }
        }
    }

    /// Takes a probe out of the air.
    pub(super) fn leave_out(&mut self, index: usize) {
        self.is_in_air[index] = false;
        self.links[index] = 0;
    }

    /// Whether a probe sees the neighbour of this bit.
    pub(super) fn sees(&self, index: usize, bit: u32) -> bool {
        self.links[index] >> bit & 1 == 1
    }

    fn linked(&self, index: usize) -> impl Iterator<Item = usize> + use<> {
        let (grid, links) = (self.grid, self.links[index]);
        let is_linked = move |&(_, bit): &([i32; 3], u32)| links >> bit & 1 == 1;
        steps().filter(is_linked).filter_map(move |(step, _)| grid.step(index, step))
    }

    /// Whether a wall stands between two probes in the air that are near each other.
    pub(super) fn are_parted(&self, a: usize, b: usize) -> bool {
        self.room[a] != self.room[b] || self.steps_between(a, b).is_none()
    }

    /// Steps from one probe to another, up to [`DETOUR`].
    fn steps_between(&self, from: usize, to: usize) -> Option<u32> {
        let mut distance = HashMap::from([(from, 0)]);
        let mut open = VecDeque::from([from]);
        while let Some(index) = open.pop_front() {
            let steps = distance[&index];
            if index == to {
                return Some(steps);
            }
            // Each step brings one nearer by a cell at most.
            let apart = (self.grid.cell(index).as_ivec3() - self.grid.cell(to).as_ivec3()).abs().max_element() as u32;
            if steps + apart > DETOUR {
                continue;
            }
            for neighbour in self.linked(index) {
                distance.entry(neighbour).or_insert_with(|| {
                    open.push_back(neighbour);
                    steps + 1
                });
            }
        }
        None
    }
}

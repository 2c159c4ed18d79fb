//! Where probes can stand: in the air. One that lies inside of a body, where it sees the backs of surfaces, is moved out
//! if that is no farther than half a cell (the idea of Unity's "virtual offset" for adaptive probe volumes); else it has
//! no place, and its value is made of its neighbours'.

use super::grid::Grid;
use crate::trace::{Surroundings, Tracer};
use glam::Vec3;

/// The largest share of directions that end at a back from where it is air. Inside a body it is nearly all; close behind
/// a wall that has a front only it is a half, and below a ground that has no underside.
const MOST_BACKS: f32 = 0.4;

/// How far beyond a surface a probe is set, in the shortest side of its cell.
const CLEARANCE: f32 = 0.05;

/// Ways out that are tried, the shortest first.
const TRIES: usize = 8;

/// The least share of directions without anything, in a place that is open to the outside.
const OPEN: f32 = 0.25;

/// Where a probe stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stand {
    /// In the air.
    Air {
        /// Where [m, world].
        point: Vec3,
        /// Whether it was moved there out of a body.
        is_moved: bool,
        /// Whether much of what is around is nothing at all.
        is_open: bool,
    },
    /// Nowhere.
    Inside,
}

impl Stand {
    /// Where the probe of a cell stands.
    pub(super) fn new(tracer: &Tracer, grid: &Grid, index: usize) -> Self {
        let centre = grid.point(index);
        let around = tracer.surroundings(centre);
        if let Some(stand) = Self::at(centre, &around, false) {
            return stand;
        }
        let shortest = grid.spacing().min_element();
        let ways = around.ways_to_backs.iter().map(|way| *way + way.normalize_or_zero() * CLEARANCE * shortest);
        let near = ways.take_while(|way| way.length() <= 0.5 * shortest).take(TRIES);
        let mut out = near.map(|way| centre + way);
        out.find_map(|point| Self::at(point, &tracer.surroundings(point), true)).unwrap_or(Self::Inside)
    }

    /// At a point [m, world], if it lies in the air.
    fn at(point: Vec3, around: &Surroundings, is_moved: bool) -> Option<Self> {
        (around.backs <= MOST_BACKS).then_some(Self::Air { point, is_moved, is_open: around.open >= OPEN })
    }

    /// Where that is [m, world].
    pub(super) fn point(self) -> Option<Vec3> {
        match self {
            Self::Air { point, .. } => Some(point),
            Self::Inside => None,
        }
    }
}

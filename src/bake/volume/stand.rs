//! Where probes can stand: in the air. One that lies inside of a body, where it sees the backs of surfaces, is moved out
//! if that is no farther than half a cell (the idea of Unity's "virtual offset" for adaptive probe volumes); else it has
//! no place, and its value is made of its neighbours'.

use super::grid::Grid;
use crate::trace::Tracer;
use glam::Vec3;

/// The largest share of directions that end at a back from where it is air. A corner of three walls that have a front
/// only is seen from behind in an eighth of all, an edge in a quarter; inside a body it is nearly all.
const MOST_BACKS: f32 = 0.25;

/// How far beyond a surface a probe is set, in the shortest side of its cell.
const CLEARANCE: f32 = 0.05;

/// Ways out that are tried, the shortest first.
const TRIES: usize = 8;

/// Where a probe stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stand {
    /// In the middle of its cell [m, world].
    Centre(Vec3),
    /// Moved out of a body [m, world].
    Moved(Vec3),
    /// Nowhere.
    Inside,
}

impl Stand {
    /// Where the probe of a cell stands.
    pub(super) fn new(tracer: &Tracer, grid: &Grid, index: usize) -> Self {
        let centre = grid.point(index);
        let around = tracer.surroundings(centre);
        if around.backs <= MOST_BACKS {
            return Self::Centre(centre);
        }
        let shortest = grid.spacing().min_element();
        let ways = around.ways_to_backs.iter().map(|way| *way + way.normalize_or_zero() * CLEARANCE * shortest);
        let near = ways.take_while(|way| way.length() <= 0.5 * shortest).take(TRIES);
        let out = near.map(|way| centre + way).find(|&point| tracer.surroundings(point).backs <= MOST_BACKS);
        out.map_or(Self::Inside, Self::Moved)
    }

    /// Where that is [m, world].
    pub(super) fn point(self) -> Option<Vec3> {
        match self {
            Self::Centre(point) | Self::Moved(point) => Some(point),
            Self::Inside => None,
        }
    }
}

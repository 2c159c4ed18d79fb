//! A volume before it is measured: where its probes stand and which of them see each other; and what becomes of it once
//! they are.

use super::fill::fill;
use super::grid::Grid;
use super::measure::Moments;
use super::rooms::Rooms;
use super::stand::Stand;
use super::{ProbeState, Volume};
use crate::artefact::StableId;
use crate::bake::BakeError;
use crate::bake::workers::Workers;
use crate::math::AmbientCube;
use crate::trace::Tracer;
use glam::Vec3;

/// A volume before it is measured.
pub(super) struct Site {
    pub(super) id: StableId,
    pub(super) grid: Grid,
    pub(super) falloff: f32,
    pub(super) stands: Vec<Stand>,
    pub(super) rooms: Rooms,
}

impl Site {
    /// Where its probes stand that count.
    pub(super) fn points(&self) -> impl Iterator<Item = Vec3> {
        let in_air = self.stands.iter().zip(&self.rooms.is_in_air).filter(|(_, is_in_air)| **is_in_air);
        in_air.filter_map(|(stand, _)| stand.point())
    }

    /// The volume for what these probes have measured, in their order.
    pub(super) fn volume(mut self, moments: Vec<Moments>) -> Volume {
        let mut moments = moments.into_iter();
        let of_probe = |&is_in_air: &bool| if is_in_air { moments.next() } else { None };
        let measured: Vec<Option<Moments>> = self.rooms.is_in_air.iter().map(of_probe).collect();
        self.leave_the_void(&measured);
        let shown = fill(&self.grid, &self.rooms, &measured);
        let state = |(stand, is_in_air): (&Stand, &bool)| match (is_in_air, stand) {
            (true, Stand::Air { is_moved: false, .. }) => ProbeState::Measured,
            (true, Stand::Air { is_moved: true, .. }) => ProbeState::Moved,
            _ => ProbeState::Filled,
        };
        let Grid { centre, rotation, size, resolution } = self.grid;
        Volume {
            id: self.id,
            centre,
            rotation,
            size,
            resolution,
            falloff: self.falloff,
            cubes: shown.iter().map(|moments| AmbientCube::fit(&moments.0).faces.map(|face| face.as_vec3())).collect(),
            probes: self.stands.iter().zip(&self.rooms.is_in_air).map(state).collect(),
        }
    }

    /// Takes probes out of the air that no light reaches and around which much is nothing at all. That is the void outside
    /// of a level, where nobody goes; its dark would count as a dark room's beside the walls around the level.
    fn leave_the_void(&mut self, measured: &[Option<Moments>]) {
        let is_void = |index: usize| {
            let is_black = measured[index].as_ref().is_some_and(|moments| moments.luminance() == 0.0);
            is_black && matches!(self.stands[index], Stand::Air { is_open: true, .. })
        };
        let void: Vec<usize> = (0..self.stands.len()).filter(|&index| is_void(index)).collect();
        if void.len() < measured.iter().flatten().count() {
            for index in void {
                self.rooms.leave_out(index);
            }
        }
    }
}

/// Where the probes of a grid stand, and which of them share a room.
pub(super) fn survey(grid: Grid, tracer: &Tracer, workers: &Workers) -> Result<(Vec<Stand>, Rooms), BakeError> {
    let all: Vec<usize> = (0..grid.len()).collect();
    let stands = workers.gather_quietly(&all, |&index, _| Some(Stand::new(tracer, &grid, index)))?;
    let links = workers.gather_quietly(&all, |&index, _| Some(Rooms::half_links(tracer, &grid, &stands, index)))?;
    let rooms = Rooms::new(grid, &stands, Rooms::both_ways(&grid, links));
    Ok((stands, rooms))
}

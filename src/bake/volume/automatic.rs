//! Boxes that nobody has to place: around all that receives light, and cut where walls stand.
//!
//! A volume blends its probes whatever stands between, but a place is lit by the volumes that it lies in and by no other.
//! So one box around the scene is cut along the planes where most neighbouring probes are parted by a wall, in the
//! middle of the wall, until none is left or Bevy's limit of [`MOST_VOLUMES`] is reached: rooms, and the floors of a
//! house, get boxes of their own. What walls are left, as slanted ones, `fill` takes care of.

use super::grid::Grid;
use super::rooms::Rooms;
use super::stand::Stand;
use super::{MOST_VOLUMES, survey};
use crate::bake::BakeError;
use crate::bake::workers::Workers;
use crate::math::Portable;
use crate::scene::Scene;
use crate::trace::Tracer;
use glam::{Quat, Vec3};

/// Probes that all boxes together should have at most, and the finest spacing [m], where none was asked for.
const MOST_PROBES: f32 = 32_768.0;
const FINEST: f32 = 0.25;

/// How high above the lowest point the box reaches at least [m]: over open ground there is something that moves.
const HEADROOM: f32 = 3.0;

/// The fewest pairs of parted neighbours that make a wall, and the least share of all pairs across its plane. What is
/// less is slanted, or the wall of a small thing.
const LEAST_PAIRS: usize = 4;
const LEAST_SHARE: f32 = 0.2;

/// The most cells in a row without air that may be a wall.
const THICKEST: usize = 2;

/// A plane that parts rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    axis: usize,
    /// Where, from the low side of the box [m].
    at: f32,
    /// Pairs of neighbours that it parts.
    pairs: usize,
}

/// Boxes for a scene; none if no air was found.
pub(super) fn boxes(
    scene: &Scene,
    spacing: Option<f32>,
    tracer: &Tracer,
    workers: &Workers,
) -> Result<Vec<Grid>, BakeError> {
    let Some([low, high]) = bounds(scene) else { return Ok(Vec::new()) };
    let high = high.with_y(high.y.max(low.y + HEADROOM));
    let size = (high - low).max(Vec3::splat(1e-3));
    let finest = Portable::powf(size.element_product() / MOST_PROBES, 1.0 / 3.0).max(FINEST);
    let spacing = spacing.unwrap_or(finest);
    let whole = Grid::new(0.5 * (low + high), Quat::IDENTITY, size, spacing);
    let mut parts = Vec::new();
    parts.extend(Part::new(whole, tracer, workers)?);
    while parts.len() < MOST_VOLUMES {
        let worst = (0..parts.len()).filter(|&part| parts[part].cut.is_some());
        // Of equals the first: the order is that of the cuts, and the same every time.
        let worst = worst.max_by_key(|&part| (parts[part].cut.map_or(0, |cut| cut.pairs), parts.len() - part));
        let Some(worst) = worst else { break };
        let part = parts.remove(worst);
        let Some(cut) = part.cut else { break };
        for half in halves(&part.grid, cut, spacing) {
            parts.extend(Part::new(half, tracer, workers)?);
        }
    }
    Ok(parts.into_iter().map(|part| part.grid).collect())
}

/// Bounds of what receives light, or of everything where nothing is marked [m].
fn bounds(scene: &Scene) -> Option<[Vec3; 2]> {
    let has_receivers = scene.instances.iter().any(|instance| instance.lightmap.is_some());
    let counted = scene.instances.iter().filter(|instance| instance.lightmap.is_some() || !has_receivers);
    let points = counted.flat_map(|instance| {
        let positions = scene.meshes.get(instance.mesh).map_or(&[][..], |mesh| &mesh.positions);
        positions.iter().map(|&position| instance.world_from_local.transform_point3(position))
    });
    points.filter(|point| point.is_finite()).fold(None, |bounds: Option<[Vec3; 2]>, point| {
        Some(bounds.map_or([point; 2], |[low, high]| [low.min(point), high.max(point)]))
    })
}

/// A box and where it should be cut next.
struct Part {
    grid: Grid,
    cut: Option<Cut>,
}

impl Part {
    /// `None` for a box without air.
    fn new(grid: Grid, tracer: &Tracer, workers: &Workers) -> Result<Option<Self>, BakeError> {
        let (stands, rooms) = survey(grid, tracer, workers)?;
        if !rooms.is_in_air.contains(&true) {
            return Ok(None);
        }
        let mut cut: Option<Cut> = None;
        for axis in 0..3 {
            let pairs = across(&grid, &rooms, axis);
            let walls =
                workers.gather_quietly(&pairs, |&pair, _| Some(wall(&grid, &stands, &rooms, axis, pair, tracer)))?;
            let walls: Vec<f32> = walls.into_iter().flatten().collect();
            let layers = (grid.resolution[axis] as usize).saturating_sub(1).max(1);
            let least = (LEAST_SHARE * (pairs.len() / layers) as f32) as usize;
            let found = plane(&walls, grid.spacing()[axis]).filter(|&(_, pairs)| pairs >= least);
            let found = found.map(|(at, pairs)| Cut { axis, at, pairs });
            cut = found.filter(|found| cut.is_none_or(|cut| found.pairs > cut.pairs)).or(cut);
        }
        Ok(Some(Self { grid, cut }))
    }
}

/// Pairs of probes in the air along an axis with no air between them that has a probe.
fn across(grid: &Grid, rooms: &Rooms, axis: usize) -> Vec<[usize; 2]> {
    let next = |from: usize| {
        let ahead = (1..=THICKEST as i32 + 1).map_while(|along| {
            let mut step = [0; 3];
            step[axis] = along;
            grid.step(from, step)
        });
        ahead.into_iter().find(|&to| rooms.is_in_air[to])
    };
    let in_air = (0..grid.len()).filter(|&from| rooms.is_in_air[from]);
    in_air.filter_map(|from| Some([from, next(from)?])).collect()
}

/// Where along an axis the middle of the wall between two probes is, from the low side of the box [m]; `None` if none
/// stands there.
fn wall(grid: &Grid, stands: &[Stand], rooms: &Rooms, axis: usize, pair: [usize; 2], tracer: &Tracer) -> Option<f32> {
    let [from, to] = [stands[pair[0]].point()?, stands[pair[1]].point()?];
    let near = tracer.blocked_after(from, to)?;
    let far = 1.0 - tracer.blocked_after(to, from).unwrap_or(1.0 - near);
    if !rooms.are_parted(pair[0], pair[1]) {
        return None;
    }
    let place = from + (to - from) * (0.5 * (near + far));
    let local = grid.rotation.inverse() * (place - grid.centre) + 0.5 * grid.size;
    Some(local[axis])
}

/// The plane that most walls lie on, within a cell, and how many they are.
fn plane(walls: &[f32], spacing: f32) -> Option<(f32, usize)> {
    let mut walls = walls.to_vec();
    walls.sort_unstable_by(f32::total_cmp);
    let mut best = 0..0;
    let mut first = 0;
    for last in 0..walls.len() {
        while walls[last] - walls[first] > 0.5 * spacing {
            first += 1;
        }
        if last + 1 - first > best.len() {
            best = first..last + 1;
        }
    }
    (best.len() >= LEAST_PAIRS).then(|| (walls[best.start + best.len() / 2], best.len()))
}

/// Both sides of a cut.
fn halves(grid: &Grid, cut: Cut, spacing: f32) -> [Grid; 2] {
    let [mut low, mut high] = [grid.size; 2];
    low[cut.axis] = cut.at;
    high[cut.axis] -= cut.at;
    let mut offset = Vec3::ZERO;
    offset[cut.axis] = 0.5;
    let near = grid.centre - grid.rotation * (offset * (grid.size - low));
    let far = grid.centre + grid.rotation * (offset * (grid.size - high));
    [Grid::new(near, grid.rotation, low, spacing), Grid::new(far, grid.rotation, high, spacing)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_fill_the_whole() {
        let grid = Grid::new(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY, Vec3::new(4.0, 2.0, 3.0), 0.5);
        let [low, high] = halves(&grid, Cut { axis: 0, at: 1.0, pairs: 9 }, 0.5);
        assert_eq!((low.centre, low.size), (Vec3::new(-0.5, 2.0, 3.0), Vec3::new(1.0, 2.0, 3.0)));
        assert_eq!((high.centre, high.size), (Vec3::new(1.5, 2.0, 3.0), Vec3::new(3.0, 2.0, 3.0)));
    }

    #[test]
    fn the_plane_of_most_walls_is_found() {
        let walls = [0.1, 2.0, 2.01, 1.99, 2.02, 2.0, 3.1, 3.1, 3.1, 3.1, 0.9];
        assert_eq!(plane(&walls, 0.5), Some((2.0, 5)));
        assert_eq!(plane(&walls[..4], 0.5), None);
    }
}

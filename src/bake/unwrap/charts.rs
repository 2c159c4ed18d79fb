//! A surface cut into charts: few, compact ones where it can be, and simple ones where that would take too long.

use super::flatten::{Limits, alone, flatten};
use super::merge::merge;
use super::patch::{Chart, Patch};
use super::simple::simple;
use super::split::split;
use super::surface::Surface;
use super::work::Work;
use crate::bake::CancelToken;
use rayon::prelude::*;

/// Triangles beyond which nothing but the simple unwrap is tried.
const MOST_TRIANGLES: usize = 4_000_000;

/// How a mesh was unwrapped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnwrapMethod {
    /// Few, compact charts.
    #[default]
    Charts,
    /// One chart for each planar region, at worst one for each triangle: the limit on work was reached in some part.
    Simple,
}

/// The charts of a surface, in an order of its own; `None` once cancelled.
pub(super) fn charts(surface: &Surface, cancel: &CancelToken) -> Option<(Vec<Chart>, UnwrapMethod)> {
    let budget = if surface.len() > MOST_TRIANGLES { Budget::None } else { Budget::PerTriangle };
    charts_within(surface, budget, cancel)
}

/// How much work may go into good charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Budget {
    None,
    PerTriangle,
}

pub(super) fn charts_within(
    surface: &Surface,
    budget: Budget,
    cancel: &CancelToken,
) -> Option<(Vec<Chart>, UnwrapMethod)> {
    let patches = Patch::whole(surface);
    // Small parts are too many to be handed out one by one.
    let parts: Vec<Option<(Vec<Chart>, UnwrapMethod)>> = patches
        .into_par_iter()
        .with_min_len(16)
        .map(|patch| {
            let mut work = Work::new(if budget == Budget::None { 0 } else { patch.len() }, cancel);
            if budget == Budget::None {
                return simple(surface, &patch, cancel).map(|charts| (charts, UnwrapMethod::Simple));
            }
            of_patch(surface, patch, &mut work, cancel)
        })
        .collect();
    let mut all = Vec::new();
    let mut method = UnwrapMethod::Charts;
    for part in parts {
        let (charts, of_part) = part?;
        all.extend(charts);
        if of_part == UnwrapMethod::Simple {
            method = of_part;
        }
    }
    Some((all, method))
}

/// The charts of a connected patch.
fn of_patch(
    surface: &Surface,
    patch: Patch,
    work: &mut Work<'_>,
    cancel: &CancelToken,
) -> Option<(Vec<Chart>, UnwrapMethod)> {
    let mut charts = Vec::new();
    let mut method = UnwrapMethod::Charts;
    let mut open = vec![patch.clone()];
    let whole = patch;
    while let Some(patch) = open.pop() {
        if work.is_cancelled() {
            return None;
        }
        if patch.len() == 1 {
            charts.push(alone(surface, patch.triangles[0]));
        } else if let Some(chart) = flatten(surface, &patch, &Limits::ALONE, work) {
            charts.push(chart);
        } else if let Some(parts) = split(surface, &patch, work).filter(|parts| parts.len() > 1) {
            open.extend(parts.into_iter().rev());
        } else {
            method = UnwrapMethod::Simple;
            charts.extend(simple(surface, &patch, cancel)?);
        }
    }
    let charts = merge(surface, &whole, charts, &mut Work::new(whole.len(), cancel));
    (!cancel.is_cancelled()).then_some((charts, method))
}

#[cfg(test)]
mod tests {
    use super::super::shape::Shape;
    use super::*;
    use crate::scene::{Indices, Mesh};
    use glam::{Affine3A, Vec3};

    /// A sheet of quads over a square.
    fn sheet(count: u32, at: impl Fn(f32, f32) -> Vec3) -> Surface {
        let share = |step: u32| step as f32 / count as f32;
        let positions =
            (0..(count + 1) * (count + 1)).map(|point| at(share(point % (count + 1)), share(point / (count + 1))));
        let quad = |cell: u32| {
            let a = cell / count * (count + 1) + cell % count;
            [a, a + 1, a + count + 2, a, a + count + 2, a + count + 1]
        };
        let mesh = Mesh {
            positions: positions.collect(),
            indices: Indices::U32((0..count * count).flat_map(quad).collect()),
            normals: None,
            ..Mesh::default()
        };
        Surface::new(&mesh, &Shape::new(&Affine3A::IDENTITY))
    }

    fn hill(u: f32, v: f32) -> Vec3 {
        Vec3::new(u, v, 0.4 * (1.0 - (2.0 * u - 1.0).powi(2)) * (1.0 - (2.0 * v - 1.0).powi(2)))
    }

    fn assert_whole(surface: &Surface, charts: &[Chart]) {
        let mut triangles: Vec<u32> = charts.iter().flat_map(|chart| chart.triangles.iter().copied()).collect();
        triangles.sort_unstable();
        assert!(triangles.into_iter().eq(0..surface.len() as u32), "every triangle once");
        for chart in charts {
            assert!(chart.flat().all(|[a, b, c]| (b - a).perp_dot(c - a) > 0.0));
        }
    }

    #[test]
    fn a_hill_is_one_chart_and_many_simple_ones() {
        let surface = sheet(12, hill);
        let cancel = CancelToken::default();
        let (charts, method) = charts(&surface, &cancel).unwrap();
        assert_whole(&surface, &charts);
        assert_eq!((charts.len(), method), (1, UnwrapMethod::Charts));
        let (charts, method) = charts_within(&surface, Budget::None, &cancel).unwrap();
        assert_whole(&surface, &charts);
        assert!(charts.len() > 100 && method == UnwrapMethod::Simple, "{}", charts.len());
    }

    #[test]
    fn a_plane_is_one_chart_either_way() {
        let surface = sheet(12, |u, v| Vec3::new(u, v, 0.0));
        for budget in [Budget::PerTriangle, Budget::None] {
            let (charts, _) = charts_within(&surface, budget, &CancelToken::default()).unwrap();
            assert_whole(&surface, &charts);
            assert_eq!(charts.len(), 1);
        }
    }

    #[test]
    fn cancelled_is_none() {
        let cancel = CancelToken::default();
        cancel.cancel();
        assert!(charts(&sheet(12, hill), &cancel).is_none());
    }
}

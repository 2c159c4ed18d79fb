//! Cells put into as small a rectangle as can be found, or onto as many pages as they need. All in whole blocks.

use super::skyline::Skyline;
use crate::bake::CancelToken;
use std::cmp::Reverse;

/// Widths that are tried, over the root of the area.
const WIDTHS: [f64; 8] = [0.75, 0.87, 1.0, 1.05, 1.11, 1.18, 1.3, 1.5];

/// Cells beyond which one width must do.
const FEW: usize = 5000;

/// The corner of each cell in the smallest of several packings; `None` if `limit` × `limit` has no room for them, or
/// once cancelled.
pub(crate) fn smallest(cells: &[[u32; 2]], limit: u32, cancel: &CancelToken) -> Option<Vec<[u32; 2]>> {
    let area: f64 = cells.iter().map(|[width, height]| f64::from(*width) * f64::from(*height)).sum();
    let widest = cells.iter().map(|cell| cell[0]).max().unwrap_or(1);
    if widest > limit {
        return None;
    }
    let order = tallest_first(cells);
    let widths = if cells.len() > FEW { &WIDTHS[3..4] } else { &WIDTHS[..] };
    let mut widths: Vec<u32> = widths.iter().map(|share| ((share * area.sqrt()) as u32).clamp(widest, limit)).collect();
    widths.push(limit);
    widths.dedup();
    let mut least: Option<(u64, Vec<[u32; 2]>)> = None;
    for width in widths {
        // The whole page only where nothing narrower holds them.
        if width == limit && least.is_some() {
            continue;
        }
        if let Some((corners, taken)) = placed(cells, &order, [width, limit], cancel)
            && least.as_ref().is_none_or(|(least, _)| taken < *least)
        {
            least = Some((taken, corners));
        }
    }
    least.filter(|_| !cancel.is_cancelled()).map(|(_, corners)| corners)
}

/// Page and corner of each cell; none is wider or higher than `limit`. All pages but the last are as full as can be.
/// `None` once cancelled.
pub(crate) fn paged(cells: &[[u32; 2]], limit: u32, cancel: &CancelToken) -> Option<Vec<(u32, [u32; 2])>> {
    let mut places = vec![(0, [0; 2]); cells.len()];
    let mut rest: Vec<usize> = (0..cells.len()).collect();
    for page in 0.. {
        let of_rest: Vec<[u32; 2]> = rest.iter().map(|&index| cells[index]).collect();
        if let Some(corners) = smallest(&of_rest, limit, cancel) {
            rest.iter().zip(corners).for_each(|(&index, corner)| places[index] = (page, corner));
            break;
        }
        let mut skyline = Skyline::new(limit, limit);
        let mut is_placed = vec![false; rest.len()];
        for index in tallest_first(&of_rest) {
            if cancel.is_cancelled() {
                return None;
            }
            if let Some(corner) = skyline.place(of_rest[index]) {
                places[rest[index]] = (page, corner);
                is_placed[index] = true;
            }
        }
        let mut placed = is_placed.iter();
        rest.retain(|_| placed.next() == Some(&false));
    }
    Some(places)
}

fn tallest_first(cells: &[[u32; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by_key(|&index| (Reverse(cells[index][1]), Reverse(cells[index][0]), index));
    order
}

/// Corners on a strip, and the area that is taken; `None` if there is no room, or once cancelled.
fn placed(
    cells: &[[u32; 2]],
    order: &[usize],
    [width, limit]: [u32; 2],
    cancel: &CancelToken,
) -> Option<(Vec<[u32; 2]>, u64)> {
    let mut skyline = Skyline::new(width, limit);
    let mut corners = vec![[0; 2]; cells.len()];
    let mut size = [0; 2];
    for &index in order {
        if cancel.is_cancelled() {
            return None;
        }
        let corner = skyline.place(cells[index])?;
        corners[index] = corner;
        for axis in 0..2 {
            size[axis] = size[axis].max(corner[axis] + cells[index][axis]);
        }
    }
    Some((corners, u64::from(size[0]) * u64::from(size[1])))
}

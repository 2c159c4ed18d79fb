//! Which of several volumes counts where they overlap: the smallest.
//!
//! Bevy weighs all volumes that a place lies in alike, and divides by the sum of weights; there is no priority. But a
//! volume's weight rises from its faces inwards as (1 − 2|p|) / 2·falloff, p in [−½, ½], up to 1, and the falloff may be
//! as large as one likes: then the weight is next to nothing everywhere, which matters beside another volume alone.

use super::grid::Grid;
use glam::Vec3;

/// How much less a volume counts than one within it.
const STEP: f32 = 1000.0;

/// The falloff of each volume: [`STEP`] to the power of how many smaller volumes lie one in the other within it.
pub(super) fn falloffs(grids: &[Grid]) -> Vec<f32> {
    let mut by_size: Vec<usize> = (0..grids.len()).collect();
    by_size.sort_by(|&a, &b| grids[a].size.element_product().total_cmp(&grids[b].size.element_product()));
    let mut levels = vec![0; grids.len()];
    for (place, &index) in by_size.iter().enumerate() {
        let within = by_size[..place].iter().filter(|&&smaller| overlap(&grids[index], &grids[smaller]));
        levels[index] = within.map(|&smaller| levels[smaller] + 1).max().unwrap_or(0);
    }
    levels.into_iter().map(|level| if level == 0 { 0.0 } else { STEP.powi(level) }).collect()
}

/// Whether two boxes have space in common (the separating axis theorem, with the axes of both boxes; edges are left out,
/// so that near misses of slanted boxes count as overlapping).
fn overlap(a: &Grid, b: &Grid) -> bool {
    let axes = |of: &Grid| [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| of.rotation * axis);
    let reach = |of: &Grid, along: Vec3| -> f32 {
        axes(of).into_iter().zip((0.5 * of.size).to_array()).map(|(axis, half)| (axis * half).dot(along).abs()).sum()
    };
    let offset = b.centre - a.centre;
    // Boxes that share a face do not overlap, whatever the rounding of their corners.
    let is_apart = |along: Vec3| offset.dot(along).abs() >= (reach(a, along) + reach(b, along)) * (1.0 - 1e-5);
    !axes(a).into_iter().chain(axes(b)).any(is_apart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    #[test]
    fn the_smallest_counts() {
        let grid = |x: f32, size: f32| Grid::new(Vec3::X * x, Quat::IDENTITY, Vec3::splat(size), 1.0);
        assert_eq!(falloffs(&[grid(0.0, 9.0), grid(0.0, 3.0), grid(0.5, 1.0), grid(30.0, 4.0)]), [1e6, 1e3, 0.0, 0.0]);
        assert_eq!(falloffs(&[grid(0.0, 2.0), grid(2.0, 2.0)]), [0.0; 2], "side by side");
        let turned = Grid { rotation: Quat::from_rotation_y(0.7), ..grid(2.2, 2.0) };
        assert_eq!(falloffs(&[grid(0.0, 2.5), turned]), [1e3, 0.0]);
    }
}

//! The places of a volume's probes: the centres of equal cells that fill its box.

use glam::{Quat, UVec3, Vec3};

/// The most probes along each axis. A face of a probe is a texel of a texture of (x, 2y, 3z) texels, and WebGPU promises
/// 2048 along each side.
pub(super) const MOST_ALONG: UVec3 = UVec3::new(2048, 1024, 682);

/// How far probes stand beside the middle of their cells [cells]. Walls and boxes are placed at round numbers: a probe in
/// the very plane of a wall would see both of its sides.
const ASIDE: Vec3 = Vec3::new(0.0013, 0.0017, 0.0023);

/// A step to a neighbour and its bit in a set of neighbours.
pub(super) type Step = ([i32; 3], u32);

/// Cells of a box, numbered along x first, then y, then z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// The middle of the box [m].
    pub(super) centre: Vec3,
    pub(super) rotation: Quat,
    /// [m].
    pub(super) size: Vec3,
    pub(super) resolution: UVec3,
}

impl Grid {
    /// Cells no larger than `spacing` [m], as far as a texture has room for them.
    pub(super) fn new(centre: Vec3, rotation: Quat, size: Vec3, spacing: f32) -> Self {
        let resolution = (size / spacing - 1e-4).ceil().as_uvec3().clamp(UVec3::ONE, MOST_ALONG);
        Self { centre, rotation, size, resolution }
    }

    pub(super) fn len(&self) -> usize {
        self.resolution.to_array().into_iter().map(|along| along as usize).product()
    }

    /// Sides of a cell [m].
    pub(super) fn spacing(&self) -> Vec3 {
        self.size / self.resolution.as_vec3()
    }

    /// The middle of a cell, but for [`ASIDE`] [m, world].
    pub(super) fn point(&self, index: usize) -> Vec3 {
        let cell = self.cell(index).as_vec3() + 0.5 + ASIDE;
        self.centre + self.rotation * ((cell / self.resolution.as_vec3() - 0.5) * self.size)
    }

    pub(super) fn cell(&self, index: usize) -> UVec3 {
        let [x, y] = [self.resolution.x as usize, self.resolution.y as usize];
        UVec3::new((index % x) as u32, (index / x % y) as u32, (index / (x * y)) as u32)
    }

    pub(super) fn index(&self, cell: UVec3) -> usize {
        let [x, y, z] = cell.to_array().map(|along| along as usize);
        (z * self.resolution.y as usize + y) * self.resolution.x as usize + x
    }

    /// The cell at a step from another, if there is one.
    pub(super) fn step(&self, index: usize, step: [i32; 3]) -> Option<usize> {
        let cell = self.cell(index).as_ivec3() + glam::IVec3::from_array(step);
        let is_inside = cell.cmpge(glam::IVec3::ZERO).all() && cell.cmplt(self.resolution.as_ivec3()).all();
        is_inside.then(|| self.index(cell.as_uvec3()))
    }

    /// The 26 neighbours that a cell may have, each with its bit.
    pub(super) fn neighbours(&self, index: usize) -> impl Iterator<Item = (usize, u32)> + use<> {
        let grid = *self;
        steps().filter_map(move |(step, bit)| grid.step(index, step).map(|neighbour| (neighbour, bit)))
    }
}

/// The steps to all neighbours. Bits of opposite steps add up to 26.
pub(super) fn steps() -> impl Iterator<Item = Step> {
    let step = |number: u32| [number % 3, number / 3 % 3, number / 9].map(|along| along as i32 - 1);
    (0..27).filter(|&number| number != 13).map(move |number| (step(number), number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_fill_the_box() {
        let grid = Grid::new(Vec3::new(1.0, 2.0, 3.0), Quat::IDENTITY, Vec3::new(2.0, 1.0, 0.9), 0.5);
        assert_eq!(grid.resolution, UVec3::new(4, 2, 2));
        let [first, last] = [Vec3::new(0.25, 1.75, 2.775), Vec3::new(1.75, 2.25, 3.225)];
        assert!((grid.point(0) - first).length() < 2e-3 && (grid.point(15) - last).length() < 2e-3);
        assert!((0..16).all(|index| grid.index(grid.cell(index)) == index));
        assert_eq!(Grid::new(Vec3::ZERO, Quat::IDENTITY, Vec3::splat(1e5), 1.0).resolution, MOST_ALONG);
        assert_eq!(Grid::new(Vec3::ZERO, Quat::IDENTITY, Vec3::splat(0.1), 1.0).resolution, UVec3::ONE);
    }

    #[test]
    fn neighbours_of_a_corner_and_of_the_middle() {
        let grid = Grid::new(Vec3::ZERO, Quat::IDENTITY, Vec3::splat(3.0), 1.0);
        assert_eq!((grid.neighbours(0).count(), grid.neighbours(13).count()), (7, 26));
        for (neighbour, bit) in grid.neighbours(13) {
            assert!(grid.neighbours(neighbour).any(|back| back == (13, 26 - bit)));
        }
    }
}

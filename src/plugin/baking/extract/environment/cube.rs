//! A cube map as an equirectangular picture that gives the same light: each pixel is the mean over its solid angle of
//! texels that are constant each. Faces as Vulkan and the other interfaces have them, and left-handed as Bevy's are:
//! the shader negates z before it looks (bevy_pbr 0.19, environment_map.wgsl).

use crate::math::{Portable, luminance};
use bevy::math::Vec3;
use rayon::prelude::*;
use std::f32::consts::TAU;

/// Width of the finest picture that is made [pixels]; and of the coarsest, as few texels make big steps.
const WIDEST: u32 = 4096;
const NARROWEST: u32 = 256;

/// Looks into the cube along each side of a pixel.
const FEW: u32 = 4;

/// Looks into the cube for a pixel at the edge of something bright, where few would miss or add too much of it.
const MANY: u32 = 512;

/// As many times brighter than the mean is bright. Errors at the edges of all else are small and cancel.
const BRIGHT: f32 = 8.0;

/// A cube map: faces +X, -X, +Y, -Y, +Z, -Z, each row by row.
pub(super) struct Cube {
    /// Texels along an edge.
    pub(super) side: u32,
    pub(super) texels: Vec<Vec3>,
}

impl Cube {
    /// Width, height and radiance in the frame of an environment map.
    pub(super) fn equirectangular(&self) -> (u32, u32, Vec<Vec3>) {
        let width = self.side.saturating_mul(4).clamp(NARROWEST, WIDEST);
        let grid = Grid::new(width, FEW * (4 * self.side).div_ceil(width));
        let bright = self.near_bright();
        let of_row = |row: u32| {
            let (grid, bright) = (&grid, &bright);
            (0..width).map(move |column| self.mean(grid, bright, [column, row]))
        };
        let height = width / 2;
        let radiance = (0..height).into_par_iter().flat_map_iter(of_row).collect();
        (width, height, radiance)
    }

    /// Per texel, whether it or one around it is bright.
    fn near_bright(&self) -> Vec<bool> {
        let brightness = |texel: &Vec3| luminance(texel.as_dvec3()) as f32;
        let mean = self.texels.iter().map(brightness).sum::<f32>() / self.texels.len() as f32;
        let side = self.side as usize;
        let mut near = vec![false; self.texels.len()];
        let bright = self.texels.iter().enumerate().filter(|(_, texel)| brightness(texel) > BRIGHT * mean);
        for (number, _) in bright {
            let (face, row, column) = (number / (side * side), number / side % side, number % side);
            let place = |texel: usize, step: f32| (texel as f32 + 0.5 + step) * 2.0 / side as f32 - 1.0;
            let steps = [-1.0, 0.0, 1.0];
            for (across, down) in steps.into_iter().flat_map(|down| steps.map(|across| (across, down))) {
                near[self.texel(direction(face, place(column, across), place(row, down)))] = true;
            }
        }
        near
    }

    /// The mean over a pixel.
    fn mean(&self, grid: &Grid, bright: &[bool], pixel: [u32; 2]) -> Vec3 {
        let (mut sum, mut is_near_bright) = (Vec3::ZERO, false);
        for texel in grid.looks(pixel).map(|direction| self.texel(direction)) {
            sum += self.texels[texel];
            is_near_bright |= bright[texel];
        }
        if is_near_bright {
            let texels = (0..MANY).map(|look| self.texel(grid.direction(pixel, hammersley(look, MANY))));
            return texels.map(|texel| self.texels[texel]).sum::<Vec3>() / MANY as f32;
        }
        sum / (grid.fineness * grid.fineness) as f32
    }

    /// The texel in a direction of the cube's own left-handed frame.
    fn texel(&self, Vec3 { x, y, z }: Vec3) -> usize {
        let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
        let (face, across, down, depth) = if ax >= ay && ax >= az {
            if x >= 0.0 { (0, -z, -y, ax) } else { (1, z, -y, ax) }
        } else if ay >= az {
            if y >= 0.0 { (2, x, z, ay) } else { (3, x, -z, ay) }
        } else if z >= 0.0 {
            (4, x, -y, az)
        } else {
            (5, -x, -y, az)
        };
        let number = |place: f32| (((place / depth + 1.0) * 0.5 * self.side as f32) as u32).min(self.side - 1) as usize;
        let side = self.side as usize;
        (face * side + number(down)) * side + number(across)
    }
}

/// Where the looks into the cube for the pixels of an equirectangular picture go, in the cube's left-handed frame.
struct Grid {
    width: u32,
    /// Looks along each side of a pixel.
    fineness: u32,
    /// Sine and cosine of each meridian, `fineness` per column.
    meridians: Vec<[f32; 2]>,
    /// Sine and cosine of each angle from +Y, `fineness` per row.
    parallels: Vec<[f32; 2]>,
}

impl Grid {
    fn new(width: u32, fineness: u32) -> Self {
        let mut grid = Self { width, fineness, meridians: Vec::new(), parallels: Vec::new() };
        let middle = |look: u32| ((look % fineness) as f32 + 0.5) / fineness as f32;
        grid.meridians = (0..width * fineness).map(|look| grid.meridian(look / fineness, middle(look))).collect();
        grid.parallels = (0..width / 2 * fineness).map(|look| grid.parallel(look / fineness, middle(look))).collect();
        grid
    }

    fn meridian(&self, column: u32, share: f32) -> [f32; 2] {
        <[f32; 2]>::from(Portable::sin_cos(((column as f32 + share) / self.width as f32 - 0.5) * TAU))
    }

    /// Equal areas between two parallels are equal steps of the cosine.
    fn parallel(&self, row: u32, share: f32) -> [f32; 2] {
        let [top, bottom] = [row, row + 1].map(|row| Portable::cos(row as f32 * TAU / self.width as f32));
        let cosine = top + (bottom - top) * share;
        [(1.0 - cosine * cosine).max(0.0).sqrt(), cosine]
    }

    fn direction(&self, [column, row]: [u32; 2], [x, y]: [f32; 2]) -> Vec3 {
        towards(self.meridian(column, x), self.parallel(row, y))
    }

    fn looks(&self, [column, row]: [u32; 2]) -> impl Iterator<Item = Vec3> + '_ {
        let of = |angles: &'_ [[f32; 2]], pixel: u32| {
            let first = (pixel * self.fineness) as usize;
            first..(first + self.fineness as usize).min(angles.len())
        };
        let columns = of(&self.meridians, column);
        let parallels = &self.parallels[of(&self.parallels, row)];
        parallels.iter().flat_map(move |&parallel| {
            self.meridians[columns.clone()].iter().map(move |&meridian| towards(meridian, parallel))
        })
    }
}

/// The map's frame is right-handed, the cube is not.
fn towards([sin, cos]: [f32; 2], [sine, cosine]: [f32; 2]) -> Vec3 {
    Vec3::new(sine * cos, cosine, -sine * sin)
}

/// The direction of a place on the plane of a face, from -1 to 1 across and down; beyond that, of one on the next.
fn direction(face: usize, across: f32, down: f32) -> Vec3 {
    match face {
        0 => Vec3::new(1.0, -down, -across),
        1 => Vec3::new(-1.0, -down, across),
        2 => Vec3::new(across, 1.0, down),
        3 => Vec3::new(across, -1.0, -down),
        4 => Vec3::new(across, -down, 1.0),
        _ => Vec3::new(-across, -down, -1.0),
    }
}

/// Points of Hammersley's set (1960), moved off the edges of the square.
fn hammersley(index: u32, count: u32) -> [f32; 2] {
    let half = 0.5 / count as f32;
    [index as f32 / count as f32 + half, index.reverse_bits() as f32 / 2.0_f32.powi(32) + half]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_and_texels_are_inverse() {
        let cube = Cube { side: 5, texels: vec![Vec3::ZERO; 150] };
        for (face, row, column) in (0..6).flat_map(|f| (0..5).flat_map(move |r| (0..5).map(move |c| (f, r, c)))) {
            let place = |texel: usize| (texel as f32 + 0.5) * 0.4 - 1.0;
            assert_eq!(cube.texel(direction(face, place(column), place(row))), (face * 5 + row) * 5 + column);
        }
    }
}

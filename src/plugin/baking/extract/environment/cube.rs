//! A cube map as an equirectangular picture that gives the same light: each pixel is the mean over its solid angle of
//! texels that are constant each. Faces as Vulkan and the other interfaces have them, and left-handed as Bevy's are:
//! the shader negates z before it looks (bevy_pbr 0.19, environment_map.wgsl).

use crate::math::luminance;
use bevy::math::Vec3;
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// Width of the finest picture that is made [pixels]; and of the coarsest, as few texels make big steps.
const WIDEST: u32 = 4096;
const NARROWEST: u32 = 256;

/// Looks into the cube for a pixel among texels that are much alike, and for one among others.
const FEW: u32 = 16;
const MANY: u32 = 512;

/// Ratio of the brightest to the darkest of a texel and those around it from which on they are not alike.
const CONTRAST: f32 = 1.5;

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
        let height = width / 2;
        let rough = self.rough();
        let of_row = |row: u32| {
            // Equal areas between the two parallels are equal steps of the cosine.
            let parallels = [row, row + 1].map(|row| (row as f32 / height as f32 * PI).cos());
            let rough = &rough;
            (0..width).map(move |column| {
                let meridians = [column, column + 1].map(|column| (column as f32 / width as f32 - 0.5) * TAU);
                self.mean(rough, parallels, meridians)
            })
        };
        let radiance = (0..height).into_par_iter().flat_map_iter(of_row).collect();
        (width, height, radiance)
    }

    /// Per texel, whether it or one around it is much brighter than another.
    fn rough(&self) -> Vec<bool> {
        let side = self.side;
        let bright = |texel: usize| luminance(self.texels[texel].as_dvec3()) as f32;
        let texels = (0..6).flat_map(|face| (0..side).flat_map(move |r| (0..side).map(move |c| (face, r, c))));
        let is_rough = |(face, row, column): (usize, u32, u32)| {
            let place = |texel: u32, step: f32| (texel as f32 + 0.5 + step) * 2.0 / side as f32 - 1.0;
            let steps = [-1.0, 0.0, 1.0];
            let around = steps.into_iter().flat_map(|down| steps.map(|across| (across, down)));
            let around = around
                .map(|(across, down)| bright(self.texel(direction(face, place(column, across), place(row, down)))));
            let (low, high) = around.fold((f32::INFINITY, 0.0_f32), |(low, high), b| (low.min(b), high.max(b)));
            high > CONTRAST * low
        };
        texels.map(is_rough).collect()
    }

    /// The mean over what two parallels (by their cosines from +Y) and two meridians enclose.
    fn mean(&self, rough: &[bool], parallels: [f32; 2], meridians: [f32; 2]) -> Vec3 {
        // A picture coarser than the cube needs more looks to see every texel.
        let texels_across = self.side as f32 * (meridians[1] - meridians[0]) * 4.0 / TAU;
        let few = FEW * (texels_across * texels_across).ceil().max(1.0) as u32;
        let looks = |count: u32| {
            (0..count).map(move |look| {
                let [x, y] = hammersley(look, count);
                let cosine = parallels[0] + (parallels[1] - parallels[0]) * y;
                let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
                let (sin, cos) = (meridians[0] + (meridians[1] - meridians[0]) * x).sin_cos();
                // The map's frame is right-handed, the cube is not.
                self.texel(Vec3::new(sine * cos, cosine, -sine * sin))
            })
        };
        let count = if looks(few).any(|texel| rough[texel]) { few.max(MANY) } else { few };
        looks(count).map(|texel| self.texels[texel]).sum::<Vec3>() / count as f32
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

//! The ambient cube: irradiance from every side in six numbers, one for each direction of the axes (Mitchell, McTaggart
//! and Green 2006, "Shading in Valve's Source Engine", slide 28). A surface of normal n gets
//!
//! E(n)/π ≈ Σ_a n_a² f_a, with f_a of the face that n_a points to.
//!
//! Owns that sum, and the cube that comes nearest to given light: the one of least squares over all normals. Knows
//! nothing of textures.
//!
//! Let B_f(n) be what face f weighs for the normal n, and C_f(ω) the average over all normals of B_f(n) max(0, n·ω)/π.
//! Light of the radiance L then has the moments b_f = ∫ L(ω) C_f(ω) dω, and the cube of least squares solves G f = b with
//! the Gram matrix G of the six B_f. By the theorem of Funk and Hecke, with 1, 2/3 and 1/4 for what the clamped cosine
//! over π leaves of the bands 0, 1 and 2, and nothing of all other odd ones (Ramamoorthi and Hanrahan 2001), C has a form
//! without a series: n_x² has the bands 0 and 2, and of n_x|n_x|, which is odd, only the band 1 is left, which is 3/4 n_x.
//! Together
//!
//! C_±x(ω) = (1 ± ω_x)² / 8 / (4π).

use super::luminance;
use glam::{DVec3, Vec3};

/// The faces of a cube, in the order +X, −X, +Y, −Y, +Z, −Z.
pub const FACES: usize = 6;

/// Of the Gram matrix: a face with itself, and with one of another axis. With the face opposite it is zero, for no normal
/// points to both.
const SAME: f64 = 1.0 / 10.0;
const BESIDE: f64 = 1.0 / 60.0;

/// What a direction of light weighs in each moment: 4π C_f(ω), for light that is averaged over the sphere.
#[inline]
pub fn ambient_cube_weights(direction: Vec3) -> [f32; FACES] {
    let [x, y, z] = direction.to_array();
    [x, -x, y, -y, z, -z].map(|cos| (1.0 + cos) * (1.0 + cos) * 0.125)
}

/// E/π for each direction of the axes [cd/m²].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AmbientCube {
    /// In the order of [`FACES`].
    pub faces: [DVec3; FACES],
}

impl AmbientCube {
    /// The cube of least squares for these moments, which may have negative faces. It is linear in them.
    pub fn unbounded(moments: &[DVec3; FACES]) -> Self {
        let sum = moments.iter().sum::<DVec3>();
        // Of each axis the sum s of both faces has b₊ + b₋ = s (SAME − 2 BESIDE) + 2 BESIDE Σs, where Σb = Σs (SAME + 4 BESIDE).
        let all = sum / (SAME + 4.0 * BESIDE);
        let face = |face: usize| {
            let [own, other] = [moments[face], moments[face ^ 1]];
            let of_axis = (own + other - 2.0 * BESIDE * all) / (SAME - 2.0 * BESIDE);
            0.5 * (of_axis + (own - other) / SAME)
        };
        Self { faces: std::array::from_fn(face) }
    }

    /// The cube of least squares among those without a negative face.
    pub fn fit(moments: &[DVec3; FACES]) -> Self {
        let cube = Self::unbounded(moments);
        if cube.faces.iter().all(|face| face.min_element() >= 0.0) {
            return cube;
        }
        let channels: [[f64; FACES]; 3] = std::array::from_fn(|channel| fit_channel(&moments.map(|of| of[channel])));
        Self { faces: std::array::from_fn(|face| DVec3::from_array(channels.map(|of| of[face]))) }
    }

    /// E/π on a surface of a unit normal [cd/m²].
    pub fn at(&self, normal: Vec3) -> DVec3 {
        let normal = normal.as_dvec3().to_array();
        let of_axis = |axis: usize| {
            let cos = normal[axis];
            cos * cos * self.faces[2 * axis + usize::from(cos < 0.0)]
        };
        (0..3).map(of_axis).sum()
    }

    /// The average over all normals [cd/m²].
    pub fn mean(&self) -> DVec3 {
        self.faces.iter().sum::<DVec3>() / FACES as f64
    }

    /// The luminance of that average [cd/m²].
    pub fn luminance(&self) -> f64 {
        luminance(self.mean())
    }
}

/// One channel of the cube of least squares without negative faces.
///
/// Which faces are dark is not known beforehand. There are 2⁶ choices; the solution is the only one that has neither a
/// negative face nor one in the dark that would gain by light (the conditions of Karush, Kuhn and Tucker).
fn fit_channel(moments: &[f64; FACES]) -> [f64; FACES] {
    let gram = |a: usize, b: usize| match (a == b, a ^ 1 == b) {
        (true, _) => SAME,
        (_, true) => 0.0,
        _ => BESIDE,
    };
    // How far a solution is from meeting the conditions; rounding alone may keep it from doing so wholly.
    let amiss = |faces: &[f64; FACES]| -> f64 {
        let of_face = |face: usize| {
            let gain = moments[face] - (0..FACES).map(|other| gram(face, other) * faces[other]).sum::<f64>();
            let gain = if faces[face] > 0.0 { 0.0 } else { gain.max(0.0) };
            (-faces[face]).max(0.0) + gain / SAME
        };
        (0..FACES).map(of_face).sum()
    };
    let mut best = ([0.0; FACES], f64::INFINITY);
    for lit in 0..1_u32 << FACES {
        let is_lit = |face: usize| lit >> face & 1 == 1;
        let faces = solve_lit(moments, gram, is_lit);
        let amiss = amiss(&faces);
        if amiss < best.1 {
            best = (faces, amiss);
        }
    }
    best.0.map(|face| face.max(0.0))
}

/// Solves for the faces that are lit; the others are zero. The matrix is positive definite: no pivot is needed.
fn solve_lit(
    moments: &[f64; FACES],
    gram: impl Fn(usize, usize) -> f64,
    is_lit: impl Fn(usize) -> bool,
) -> [f64; FACES] {
    let mut rows: [[f64; FACES + 1]; FACES] = std::array::from_fn(|row| {
        std::array::from_fn(|column| match (is_lit(row), column) {
            (true, FACES) => moments[row],
            (true, _) if is_lit(column) => gram(row, column),
            _ => f64::from(u8::from(row == column)),
        })
    });
    for row in (0..FACES).filter(|&row| !is_lit(row)) {
        rows[row][FACES] = 0.0;
    }
    for pivot in 0..FACES {
        for row in pivot + 1..FACES {
            let (above, factor) = (rows[pivot], rows[row][pivot] / rows[pivot][pivot]);
            for (entry, above) in rows[row].iter_mut().zip(above) {
                *entry -= factor * above;
            }
        }
    }
    let mut faces = [0.0; FACES];
    for row in (0..FACES).rev() {
        let known: f64 = (row + 1..FACES).map(|column| rows[row][column] * faces[column]).sum();
        faces[row] = (rows[row][FACES] - known) / rows[row][row];
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{square_to_uniform_sphere, testing::Random};
    use glam::Vec2;
    use std::f64::consts::PI;

    /// Points of a sphere, evenly.
    fn directions(side: u32) -> impl Iterator<Item = Vec3> {
        (0..side * side).map(move |place| {
            let at = Vec2::new((place % side) as f32 + 0.5, (place / side) as f32 + 0.5) / side as f32;
            square_to_uniform_sphere(at)
        })
    }

    /// What a face weighs for a normal.
    fn basis(face: usize, normal: Vec3) -> f64 {
        let mut faces = [DVec3::ZERO; FACES];
        faces[face] = DVec3::ONE;
        AmbientCube { faces }.at(normal).x
    }

    /// The squared distance of a cube from E/π of some light, over all normals.
    fn misfit(cube: &AmbientCube, light: &dyn Fn(Vec3) -> f64, side: u32) -> f64 {
        let error = |normal: Vec3| (cube.at(normal).x - light(normal)).powi(2);
        directions(side).map(error).sum::<f64>() / f64::from(side * side)
    }

    #[test]
    fn weights_are_the_averages_that_they_stand_for() {
        let mut random = Random::new(5);
        for _ in 0..20 {
            let direction = random.direction();
            for (face, weight) in ambient_cube_weights(direction).into_iter().enumerate() {
                let of_normal = |normal: Vec3| basis(face, normal) * f64::from(normal.dot(direction).max(0.0)) / PI;
                // The average over normals, and 4π for light that is itself an average over the sphere.
                let integral = directions(500).map(of_normal).sum::<f64>() / 25e4 * 4.0 * PI;
                assert!((integral - f64::from(weight)).abs() < 2e-4, "{direction} {face}: {integral} {weight}");
            }
        }
    }

    #[test]
    fn gram_matrix_is_that_of_the_basis() {
        for a in 0..FACES {
            for b in 0..FACES {
                let product = directions(300).map(|normal| basis(a, normal) * basis(b, normal)).sum::<f64>() / 9e4;
                let expected = [BESIDE, SAME, 0.0][usize::from(a == b) + 2 * usize::from(a ^ 1 == b)];
                assert!((product - expected).abs() < 1e-4, "{a} {b}: {product}");
            }
        }
    }

    #[test]
    fn even_light_is_the_same_from_all_sides() {
        let cube = AmbientCube::fit(&[DVec3::new(1.0, 2.0, 0.5) / 6.0; FACES]);
        for face in cube.faces {
            assert!((face - DVec3::new(1.0, 2.0, 0.5)).length() < 1e-12, "{cube:?}");
        }
    }

    /// Light from one direction: no cube without negative faces comes nearer, whichever face is changed; and the fit
    /// beats E/π along the axes, which is what a baker without it would store.
    #[test]
    fn nothing_comes_nearer_than_the_fit() {
        let mut random = Random::new(11);
        for _ in 0..12 {
            let from = random.direction();
            let light = |normal: Vec3| f64::from(normal.dot(from).max(0.0)) / PI;
            let moments = ambient_cube_weights(from).map(|weight| DVec3::splat(f64::from(weight) / (4.0 * PI)));
            let cube = AmbientCube::fit(&moments);
            let best = misfit(&cube, &light, 100);
            assert!(cube.faces.iter().all(|face| face.min_element() >= 0.0), "{cube:?}");
            for face in 0..FACES {
                for step in [1e-2, -1e-2] {
                    let mut other = cube;
                    other.faces[face] = (other.faces[face] + step).max(DVec3::ZERO);
                    let changed = misfit(&other, &light, 100);
                    assert!(changed >= best - 1e-9, "{from}: face {face} by {step}: {changed} < {best}");
                }
            }
            let axes = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z];
            let samples = AmbientCube { faces: axes.map(|axis| DVec3::splat(light(axis))) };
            assert!(misfit(&samples, &light, 100) > best, "{from}");
        }
    }

    #[test]
    fn bounded_and_unbounded_agree_where_no_face_is_negative() {
        let mut random = Random::new(3);
        for _ in 0..50 {
            let moments: [DVec3; FACES] = std::array::from_fn(|_| DVec3::splat(0.15 + 0.03 * f64::from(random.unit())));
            let free = AmbientCube::unbounded(&moments);
            assert!(free.faces.iter().all(|face| face.x >= 0.0), "{free:?}");
            let solved = fit_channel(&moments.map(|of| of.x));
            for (solved, face) in solved.into_iter().zip(free.faces) {
                assert!((solved - face.x).abs() < 1e-12, "{solved} {face}");
            }
        }
    }
}

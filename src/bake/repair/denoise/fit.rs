//! A paraboloid and a plane through weighted texels, as they are in the middle.

use glam::Vec3;

/// Terms of a paraboloid: 1, x, y, x², xy, y².
const TERMS: usize = 6;

/// Those of a plane.
const TERMS_OF_A_PLANE: usize = 3;

/// What holds slopes and curvature where the texels do not, in weights of one texel at the window's rim. Little enough
/// to leave the few texels at the foot of something their slope.
const RIDGE: f64 = 0.00003;

/// A surface in the middle of its window.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fitted {
    pub(super) value: Vec3,
    /// Change from texel to texel, along the columns and the rows.
    pub(super) slope: [Vec3; 2],
    /// Variance of the value.
    pub(super) variance: Vec3,
    /// The share of the middle's own value in it.
    pub(super) own: f32,
}

/// What both halves are by the same weights.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fits {
    /// As paraboloids.
    pub(super) curved: [Fitted; 2],
    /// As planes.
    pub(super) flat: [Fitted; 2],
}

/// The terms at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place([f32; TERMS]);

impl Place {
    /// A place at a step from the middle of a window of some radius [texels].
    pub(super) fn new(step: [i32; 2], radius: f32) -> Self {
        let [x, y] = step.map(|step| step as f32 / radius);
        Self([1.0, x, y, x * x, x * y, y * y])
    }
}

/// A texel of a fit, with both halves' values.
#[derive(Clone, Copy, Debug)]
pub(super) struct Member {
    pub(super) weight: f32,
    pub(super) place: Place,
    pub(super) values: [Vec3; 2],
    /// Variance of a half.
    pub(super) variance: Vec3,
    /// That of all channels over the middle's.
    pub(super) ratio: f32,
}

/// Sums of a weighted least squares fit to both halves.
#[derive(Clone, Debug, Default)]
pub(super) struct Sums {
    /// Σ w b bᵀ and Σ w² r b bᵀ, their upper triangles; r is the ratio of a texel's variance to the middle's.
    normal: [[f32; TERMS]; TERMS],
    squared: [[f32; TERMS]; TERMS],
    /// What the halves' values are counted from: far sums of near numbers lose their digits.
    origin: [Vec3; 2],
    /// Σ w b (y − origin), of both halves.
    moments: [[Vec3; TERMS]; 2],
    /// Σ w v and Σ w r.
    variance: Vec3,
    ratio: f32,
}

type Matrix = [[f64; TERMS]; TERMS];

impl Sums {
    /// Sums of a fit about a texel with these values.
    pub(super) fn about(origin: [Vec3; 2]) -> Self {
        Self { origin, ..Self::default() }
    }

    /// Adds a texel.
    pub(super) fn add(&mut self, member: Member) {
        let Member { weight, place: Place(terms), values, variance, ratio } = member;
        let [first, second] = self.origin;
        let offsets = [values[0] - first, values[1] - second];
        for row in 0..TERMS {
            let weighted = weight * terms[row];
            for (column, term) in terms.iter().enumerate().skip(row) {
                self.normal[row][column] += weighted * term;
                self.squared[row][column] += ratio * weight * weighted * term;
            }
            for (moments, offset) in self.moments.iter_mut().zip(offsets) {
                moments[row] += offset * weighted;
            }
        }
        self.variance += variance * weight;
        self.ratio += ratio * weight;
    }

    /// Both halves in the middle of a window of some radius [texels].
    pub(super) fn fitted(&self, radius: f32) -> Fits {
        let factor = self.factor();
        let [curved, flat] = [TERMS, TERMS_OF_A_PLANE].map(|terms| self.fitted_to(terms, &factor, radius));
        Fits { curved, flat }
    }

    /// The same with the first terms only. The leading block of the factor is the factor of the leading block.
    fn fitted_to(&self, terms: usize, factor: &Matrix, radius: f32) -> [Fitted; 2] {
        let [value, along_x, along_y] = [0, 1, 2].map(|term| solve(factor, terms, term));
        let mut spread = 0.0;
        for (a, &by_row) in value.iter().enumerate() {
            for (b, &by_column) in value.iter().enumerate() {
                spread += by_row * by_column * f64::from(self.squared[a.min(b)][a.max(b)]);
            }
        }
        let variance = self.variance * (spread.max(0.0) as f32 / self.ratio);
        [0, 1].map(|half| {
            let (moments, origin) = (&self.moments[half], self.origin[half]);
            let sum = |row: [f64; TERMS]| (0..TERMS).map(|term| moments[term] * row[term] as f32).sum::<Vec3>();
            let slope = [sum(along_x) / radius, sum(along_y) / radius];
            Fitted { value: origin + sum(value), slope, variance, own: value[0] as f32 }
        })
    }

    /// Cholesky's factor of the normal matrix. The ridge keeps its diagonal from zero.
    fn factor(&self) -> Matrix {
        let mut factor = Matrix::default();
        for row in 0..TERMS {
            for column in 0..=row {
                let known: f64 = (0..column).map(|term| factor[row][term] * factor[column][term]).sum();
                let rest = f64::from(self.normal[column][row]) - known;
                factor[row][column] = match (row == column, row) {
                    (true, 0) => rest.sqrt(),
                    (true, _) => (rest.max(0.0) + RIDGE).sqrt(),
                    (false, _) => rest / factor[column][column],
                };
            }
        }
        factor
    }
}

/// A row of the inverse of a matrix's leading block, by its Cholesky factor: L y = e, Lᵀ x = y.
fn solve(factor: &Matrix, terms: usize, unit: usize) -> [f64; TERMS] {
    let mut y = [0.0; TERMS];
    for row in 0..terms {
        let known: f64 = (0..row).map(|column| factor[row][column] * y[column]).sum();
        y[row] = (f64::from(u8::from(row == unit)) - known) / factor[row][row];
    }
    let mut x = [0.0; TERMS];
    for row in (0..terms).rev() {
        let known: f64 = (row + 1..terms).map(|column| factor[column][row] * x[column]).sum();
        x[row] = (y[row] - known) / factor[row][row];
    }
    x
}

//! A paraboloid through weighted texels, as it is in the middle.

use glam::Vec3;

/// Terms of a paraboloid: 1, x, y, x², xy, y².
const TERMS: usize = 6;

/// What holds slopes and curvature where the texels do not, in weights of one texel at the window's rim.
const RIDGE: f64 = 0.003;

/// A paraboloid in the middle of its window.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fitted {
    pub(super) value: Vec3,
    /// Change from texel to texel, along the columns and the rows.
    pub(super) slope: [Vec3; 2],
    /// Variance of the value.
    pub(super) variance: Vec3,
}

impl Fitted {
    /// A texel by itself.
    pub(super) fn of_texel(value: Vec3, variance: Vec3) -> Self {
        Self { value, variance, slope: [Vec3::ZERO; 2] }
    }
}

/// The terms at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place([f32; TERMS]);

impl Place {
    /// The middle of a window.
    pub(super) const MIDDLE: Self = Self([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);

    /// A place at a step from the middle of a window of some radius [texels].
    pub(super) fn new(step: [i32; 2], radius: f32) -> Self {
        let [x, y] = step.map(|step| step as f32 / radius);
        Self([1.0, x, y, x * x, x * y, y * y])
    }
}

/// Sums of a weighted least squares fit.
#[derive(Clone, Debug, Default)]
pub(super) struct Sums {
    /// Σ w b bᵀ and Σ w² b bᵀ, their upper triangles.
    normal: [[f32; TERMS]; TERMS],
    squared: [[f32; TERMS]; TERMS],
    /// Σ w b y.
    moments: [Vec3; TERMS],
    /// Σ w v.
    variance: Vec3,
}

type Matrix = [[f64; TERMS]; TERMS];

impl Sums {
    /// Adds a texel.
    pub(super) fn add(&mut self, weight: f32, Place(terms): Place, value: Vec3, variance: Vec3) {
        for row in 0..TERMS {
            let weighted = weight * terms[row];
            for (column, term) in terms.iter().enumerate().skip(row) {
                self.normal[row][column] += weighted * term;
                self.squared[row][column] += weight * weighted * term;
            }
            self.moments[row] += value * weighted;
        }
        self.variance += variance * weight;
    }

    /// The paraboloid in the middle of a window of some radius [texels].
    pub(super) fn fitted(&self, radius: f32) -> Fitted {
        let factor = self.factor();
        let [value, along_x, along_y] = [0, 1, 2].map(|term| solve(&factor, term));
        let mut spread = 0.0;
        for (a, &by_row) in value.iter().enumerate() {
            for (b, &by_column) in value.iter().enumerate() {
                spread += by_row * by_column * f64::from(self.squared[a.min(b)][a.max(b)]);
            }
        }
        let sum = |row: [f64; TERMS]| (0..TERMS).map(|term| self.moments[term] * row[term] as f32).sum::<Vec3>();
        Fitted {
            value: sum(value),
            slope: [sum(along_x) / radius, sum(along_y) / radius],
            variance: self.variance * (spread.max(0.0) as f32 / self.normal[0][0]),
        }
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

/// A row of the inverse of a matrix by its Cholesky factor: L y = e, Lᵀ x = y.
fn solve(factor: &Matrix, unit: usize) -> [f64; TERMS] {
    let mut y = [0.0; TERMS];
    for row in 0..TERMS {
        let known: f64 = (0..row).map(|column| factor[row][column] * y[column]).sum();
        y[row] = (f64::from(u8::from(row == unit)) - known) / factor[row][row];
    }
    let mut x = [0.0; TERMS];
    for row in (0..TERMS).rev() {
        let known: f64 = (row + 1..TERMS).map(|column| factor[column][row] * x[column]).sum();
        x[row] = (y[row] - known) / factor[row][row];
    }
    x
}

//! What a sweep is: difficulties, and the error of each method at each. Prints itself as a table.

use bevy_kiln::math::Welford;

/// Whose curve it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Ours,
    Naive,
}

/// One method.
pub struct Curve {
    pub side: Side,
    /// Its name, as the table and the plot show it.
    pub name: &'static str,
    /// Relative error at each difficulty. No number where the method gave none.
    pub errors: Vec<f64>,
    /// Where the plot names it: left end of the text, in the plot's own square, from the lower left.
    pub label: [f64; 2],
}

/// An axis, whose numbers run by powers of ten.
pub struct Axis {
    pub title: &'static str,
    /// Power of ten where it begins and where it ends.
    pub decades: [i32; 2],
    /// Powers between two numbers.
    pub step: i32,
}

/// A sweep.
pub struct Sweep {
    /// Its name, which is that of its file.
    pub name: &'static str,
    /// What is hard.
    pub title: &'static str,
    /// What was done, for the table.
    pub about: String,
    pub difficulty: Axis,
    pub error: Axis,
    pub difficulties: Vec<f64>,
    pub curves: Vec<Curve>,
    /// Lines under the table.
    pub notes: Vec<String>,
}

/// How much is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    Full,
    /// Enough to see that every sweep runs.
    Quick,
}

impl Effort {
    /// A count, or a sixty-fourth of it.
    pub fn of(self, count: u32) -> u32 {
        match self {
            Self::Full => count,
            Self::Quick => count.div_ceil(64),
        }
    }
}

/// Root of the mean square of the relative errors of independent estimates: noise and bias together.
pub fn rms_error(estimates: impl IntoIterator<Item = f64>, truth: f64) -> f64 {
    let squares: Welford = estimates.into_iter().map(|estimate| (estimate / truth - 1.0).powi(2)).collect();
    squares.mean().sqrt()
}

impl Sweep {
    /// Prints the table.
    pub fn print(&self) {
        println!("## {}: {}\n\n{}\n", self.name, self.title, self.about);
        let width = |curve: &Curve| curve.name.chars().count().max(9) + 2;
        let names: String = self.curves.iter().map(|curve| format!("{:>1$}", curve.name, width(curve))).collect();
        println!("{:>34}{names}", self.difficulty.title);
        for (index, difficulty) in self.difficulties.iter().enumerate() {
            let errors = self.curves.iter().map(|curve| format!("{:>1$.1e}", curve.errors[index], width(curve)));
            println!("{difficulty:>34.3e}{}", errors.collect::<String>());
        }
        println!("\n{}", self.verdict());
        for note in &self.notes {
            println!("{note}");
        }
        println!();
    }

    /// The worst error of every method, and where a naive one does better than ours.
    fn verdict(&self) -> String {
        let worst = |curve: &Curve| curve.errors.iter().fold(0.0_f64, |a, &b| if b.is_nan() { b } else { a.max(b) });
        let mut text = String::from("Worst:");
        for curve in &self.curves {
            text += &format!(" {} {:.1e};", curve.name, worst(curve));
        }
        let Some(ours) = self.curves.iter().find(|curve| curve.side == Side::Ours) else { return text };
        for naive in self.curves.iter().filter(|curve| curve.side == Side::Naive) {
            // Two estimates of the same noise differ by less than this; and what is less than f32 can tell is none.
            let better = |index: &usize| {
                naive.errors[*index] < 0.7 * ours.errors[*index] && ours.errors[*index] > f64::from(f32::EPSILON)
            };
            let at: Vec<String> = (0..self.difficulties.len())
                .filter(better)
                .map(|index| {
                    format!("{:.3e} ({:.1}×)", self.difficulties[index], ours.errors[index] / naive.errors[index])
                })
                .collect();
            if !at.is_empty() {
                text += &format!("\n{} does better than ours at {}.", naive.name, at.join(", "));
            }
        }
        text
    }
}

//! How long the sum: the mean of a thousand to a billion samples, few of them bright and most of them dim, as paths
//! bring them. Every value is a whole multiple of 2⁻³⁹, so that the true mean is known to the last digit.

use crate::sweep::{Axis, Curve, Effort, Side, Sweep};
use bevy_kiln::bake::REPLICATES;
use bevy_kiln::math::mix64;
use half::f16;

/// Values between two looks, as powers of four.
const POWERS: std::ops::RangeInclusive<u32> = 5..=15;

/// All values in one unit.
const UNIT: f64 = 1.0 / (1_u64 << 39) as f64;

/// Errors at which the plot ends: what f64 cannot tell from none.
const NONE: f64 = 1e-17;

#[derive(Default)]
struct Sums {
    count: u64,
    exact: u128,
    /// As `src/bake/gather.rs` has it: one f64 sum for each replicate.
    ours: [f64; REPLICATES as usize],
    single: f32,
    half: f16,
}

pub fn sweep(effort: Effort) -> Sweep {
    let powers = POWERS.filter(|&power| effort == Effort::Full || power <= 10);
    let counts: Vec<u64> = powers.map(|power| 4_u64.pow(power)).collect();
    let mut sums = Sums::default();
    let mut errors = [const { Vec::new() }; 3];
    for &count in &counts {
        while sums.count < count {
            sums.push();
        }
        for (errors, error) in errors.iter_mut().zip(sums.errors()) {
            errors.push(error);
        }
    }
    let [ours, single, half] = errors;
    Sweep {
        name: "sums",
        title: "A billion samples",
        about: format!(
            "The mean of so many values in [0, 1), most of them dim; the true one by whole numbers. Ours: {REPLICATES}\n\
             sums in f64. Naive: one running sum in f32, or in half floats as in Godot's rgba16f accumulators.\n\
             An error of 0 is shown as {NONE:.0e}."
        ),
        difficulty: Axis { title: "samples", decades: [3, 9], step: 1 },
        error: Axis { title: "relative error", decades: [-17, 2], step: 4 },
        difficulties: counts.iter().map(|&count| count as f64).collect(),
        curves: vec![
            Curve { side: Side::Ours, name: "bevy_kiln: f64", errors: ours, label: [0.3, 0.2] },
            Curve { side: Side::Naive, name: "half-float sum (Godot)", errors: half, label: [0.06, 0.96] },
            Curve { side: Side::Naive, name: "f32 sum", errors: single, label: [0.5, 0.6] },
        ],
        notes: vec![],
    }
}

impl Sums {
    fn push(&mut self) {
        let bits = mix64(self.count);
        let (mantissa, shift) = (bits >> 40, bits & 15);
        let whole = mantissa << (15 - shift);
        let value = (whole as f64 * UNIT) as f32;
        self.exact += u128::from(whole);
        self.ours[(self.count % u64::from(REPLICATES)) as usize] += f64::from(value);
        self.single += value;
        // Once no value moves it any more there is no use in trying.
        if self.half.to_f32() < 2048.0 {
            self.half = f16::from_f32(self.half.to_f32() + value);
        }
        self.count += 1;
    }

    /// Relative errors of the three means.
    fn errors(&self) -> [f64; 3] {
        let count = self.count as f64;
        let truth = self.exact as f64 * UNIT / count;
        let replicates = f64::from(REPLICATES);
        let ours = self.ours.iter().map(|sum| sum / (count / replicates)).sum::<f64>() / replicates;
        [ours, f64::from(self.single) / count, f64::from(self.half.to_f32()) / count]
            .map(|mean| (mean / truth - 1.0).abs().max(NONE))
    }
}

//! The least squares of seams: texels move as little as their certainty allows so that lookups agree. Knows rows and
//! unknowns, no charts.
//!
//! Minimised is Σ ((a − b)/local)² over all lookups + Σ ((x − x₀)/(σ·local))²·τ² over the texels, σ being a texel's
//! relative standard error and τ the jump that is borne (Iwanicki 2013, "Lighting Technology of The Last of Us", has
//! seams of lightmaps as least squares; the weights are ours). Where that leaves more than what nobody sees, what is
//! left is added to what the lookup should make up for, and all is solved again from there (the method of multipliers,
//! Hestenes 1969, Powell 1969): the equations stay as well conditioned as they are. No texel leaves the
//! range of those that it is to agree with by more than its slack, nor falls below zero: one that would is held
//! on its bound in the next solution. The solver is that of conjugate gradients (Hestenes and Stiefel 1952)
//! with the diagonal as its preconditioner. All sums run in a fixed order.

use crate::bake::CancelToken;
use glam::DVec3;

/// The relative jump that costs as much as moving a texel by its standard error, τ.
const BORNE: f64 = 0.01;

/// Relative jumps below this are none.
const NO_JUMP: f64 = 1e-6;

/// The relative jump that is aimed at, and that above which what is left of it is made up for in the next round.
const TARGET: f64 = 4e-3;
const NOTED: f64 = 3e-3;

/// The most rounds.
const ROUNDS: usize = 60;

/// The local value goes by what is displayed now; from round to round it changes by no more than this factor.
const FASTEST: f64 = 2.0;

/// The relative jump above which lookups are taken for such as cannot agree, and how often some are left out before
/// all is left as it was.
const APART: f64 = 0.05;
const ATTEMPTS: usize = 2;

/// Rounds after which what has not got better by this factor will not.
const IDLE: usize = 24;
const BETTER: f64 = 0.95;

/// How far a measured texel, and one that was filled in, may go beyond the range of those that it is to agree with, in
/// that range. A filled one is seen through filtering only, where a measured one beside it takes most of it back.
pub(super) const SLACK_MEASURED: f64 = 0.5;
pub(super) const SLACK_FILLED: f64 = 3.0;

/// How often a round is solved again with what went beyond its bounds held there.
const HOLDS: usize = 3;

/// A row whose jump falls by less than this from round to round counts more in the next, and how much at the most.
const STUBBORN: f64 = 0.5;
const EXTRA: f64 = 4.0;
const MOST_EXTRA: f64 = 1e4;

/// Steps of one solution, and the reduction of the residual after which it is done.
const STEPS: usize = 300;
const REDUCTION: f64 = 1e-3;

/// An unknown: one texel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unknown {
    /// Before [cd/m²].
    pub(super) value: DVec3,
    /// How much a move costs, τ² of it [(cd/m²)⁻²].
    pub(super) stiffness: f64,
    /// How far it may go beyond the range of those that it is to agree with, in that range.
    pub(super) slack: f64,
    /// How far it may move at all [cd/m²].
    pub(super) reach: f64,
}

/// How two lookups differ: `difference + Σ weight·move`.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    /// Before [cd/m²].
    pub(super) difference: Vec<DVec3>,
    /// The mean of both lookups before [cd/m²].
    pub(super) mean: Vec<DVec3>,
    /// What the local value is at least [cd/m²].
    pub(super) floor: Vec<f64>,
    /// Where each row's entries end.
    pub(super) ends: Vec<u32>,
    /// Unknowns and weights.
    pub(super) entries: Vec<(u32, f32)>,
}

/// What a solution did.
pub(super) struct Solution {
    /// By how much each unknown moves [cd/m²].
    pub(super) moves: Vec<DVec3>,
    /// The relative jump at each row, before and after.
    pub(super) before: Vec<f64>,
    pub(super) after: Vec<f64>,
}

impl Rows {
    pub(super) fn push(
        &mut self,
        [difference, mean]: [DVec3; 2],
        floor: f64,
        entries: impl Iterator<Item = (u32, f64)>,
    ) {
        self.entries.extend(entries.map(|(unknown, weight)| (unknown, weight as f32)));
        self.ends.push(self.entries.len() as u32);
        self.difference.push(difference);
        self.mean.push(mean);
        self.floor.push(floor);
    }

    /// Some of the rows.
    fn only(&self, kept: &[usize]) -> Self {
        let mut only = Self::default();
        for &row in kept {
            let begin = if row == 0 { 0 } else { self.ends[row - 1] as usize };
            let entries = self.entries[begin..self.ends[row] as usize].iter();
            let entries = entries.map(|&(unknown, weight)| (unknown, f64::from(weight)));
            only.push([self.difference[row], self.mean[row]], self.floor[row], entries);
        }
        only
    }

    fn iter(&self) -> impl Iterator<Item = (usize, &[(u32, f32)])> + '_ {
        let begin = |row: usize| if row == 0 { 0 } else { self.ends[row - 1] as usize };
        (0..self.ends.len()).map(move |row| (row, &self.entries[begin(row)..self.ends[row] as usize]))
    }

    /// The differences where the unknowns have moved.
    fn left(&self, moves: &[DVec3]) -> Vec<DVec3> {
        self.iter().map(|(row, entries)| self.difference[row] + read(entries, moves)).collect()
    }

    /// The local values where the unknowns have moved: the strongest channel of the mean of both lookups.
    fn local(&self, moves: &[DVec3]) -> Vec<f64> {
        let local = |(row, entries): (usize, &[(u32, f32)])| {
            // The sign of a weight tells the side, and lookups have no negative ones.
            let moved: DVec3 =
                entries.iter().map(|&(unknown, weight)| moves[unknown as usize] * f64::from(weight.abs())).sum();
            (self.mean[row] + 0.5 * moved).max_element().max(self.floor[row])
        };
        self.iter().map(local).collect()
    }
}

/// Differences over the local values.
fn relative(left: &[DVec3], local: &[f64]) -> Vec<f64> {
    let relative = |(left, &local): (&DVec3, &f64)| if local > 0.0 { left.abs().max_element() / local } else { 0.0 };
    left.iter().zip(local).map(relative).collect()
}

fn read(entries: &[(u32, f32)], of: &[DVec3]) -> DVec3 {
    entries.iter().map(|&(unknown, weight)| of[unknown as usize] * f64::from(weight)).sum()
}

/// τ: how much the stiffness of a texel is that of its relative standard error.
pub(super) fn stiffness(relative_error: f64, local: f64) -> f64 {
    let cost = BORNE / (relative_error * local);
    cost * cost
}

/// Solves one group of seams; `None` if cancelled. Lookups that cannot be made to agree would drive texels anywhere, so
/// they are left out, and the rest is solved anew.
pub(super) fn solve(rows: &Rows, unknowns: &[Unknown], cancel: &CancelToken) -> Option<Solution> {
    let still = vec![DVec3::ZERO; unknowns.len()];
    let before = relative(&rows.difference, &rows.local(&still));
    let mut kept: Vec<usize> = (0..before.len()).collect();
    let mut moves = still.clone();
    for attempt in 0..=ATTEMPTS {
        let solution = solve_all(&rows.only(&kept), unknowns, cancel)?;
        let agree = |place: usize| solution.after[place] <= APART;
        let agreed: Vec<usize> = (0..kept.len()).filter(|&place| agree(place)).map(|place| kept[place]).collect();
        if agreed.len() == kept.len() {
            moves = solution.moves;
            break;
        }
        if attempt == ATTEMPTS {
            break;
        }
        kept = agreed;
    }
    let after = relative(&rows.left(&moves), &rows.local(&moves));
    Some(Solution { moves, before, after })
}

/// Solves one group of seams with all of its rows.
fn solve_all(rows: &Rows, unknowns: &[Unknown], cancel: &CancelToken) -> Option<Solution> {
    let mut moves = vec![DVec3::ZERO; unknowns.len()];
    let mut local = rows.local(&moves);
    let before = relative(&rows.difference, &local);
    let mut best = (moves.clone(), before.clone());
    if worst(&before) < NO_JUMP {
        return Some(Solution { moves, after: before.clone(), before });
    }
    let mut extra = vec![1.0; local.len()];
    let mut last = before.clone();
    let weight = |extra: f64, local: f64| if local > 0.0 { extra / (local * local) } else { 0.0 };
    let mut weights: Vec<f64> = local.iter().map(|&local| weight(1.0, local)).collect();
    let mut free = vec![DVec3::ONE; unknowns.len()];
    let bounds = Bounds::new(rows, unknowns);
    let mut goals = rows.difference.clone();
    let mut idle = 0;
    for _ in 0..ROUNDS {
        let everything = vec![DVec3::ONE; unknowns.len()];
        let pull = Problem { rows, unknowns, goals: &goals, weights: &weights, free: &everything }.downhill(&moves);
        bounds.release(&moves, &pull, &mut free);
        for _ in 0..HOLDS {
            let problem = Problem { rows, unknowns, goals: &goals, weights: &weights, free: &free };
            problem.descend(&mut moves, cancel)?;
            if !bounds.hold(&mut moves, &mut free) {
                break;
            }
        }
        let left = rows.left(&moves);
        let now = rows.local(&moves);
        let after = relative(&left, &now);
        // No faster, or weights and values chase each other.
        local.iter_mut().zip(now).for_each(|(local, now)| *local = now.clamp(*local / FASTEST, *local * FASTEST));
        let is_better = worst(&after) < BETTER * worst(&best.1);
        idle = if is_better { 0 } else { idle + 1 };
        if worst(&after) < worst(&best.1) {
            best = (moves.clone(), after.clone());
        }
        if idle >= IDLE {
            break;
        }
        if worst(&after) <= TARGET {
            break;
        }
        for row in 0..goals.len() {
            if after[row] > NOTED {
                goals[row] += left[row];
                if after[row] > TARGET.max(STUBBORN * last[row]) && extra[row] < MOST_EXTRA {
                    extra[row] *= EXTRA;
                }
            }
            // The pull of what was added stays what it was.
            let new = weight(extra[row], local[row]);
            if new != weights[row] && new > 0.0 {
                goals[row] = rows.difference[row] + (goals[row] - rows.difference[row]) * (weights[row] / new);
                weights[row] = new;
            }
        }
        last.clone_from(&after);
    }
    let (moves, after) = best;
    Some(Solution { moves, before, after })
}

fn worst(jumps: &[f64]) -> f64 {
    jumps.iter().copied().fold(0.0, f64::max)
}

/// How far each unknown may move, down and up: not out of the range of all that it is to agree with by more than
/// its slack, not farther than its own error bars and the light's slope around it make likely, and not below zero. What cannot be made to agree stays apart; it is not driven anywhere.
struct Bounds {
    low: Vec<DVec3>,
    high: Vec<DVec3>,
}

impl Bounds {
    fn new(rows: &Rows, unknowns: &[Unknown]) -> Self {
        let values = || unknowns.iter().map(|unknown| unknown.value);
        let (mut least, mut most): (Vec<DVec3>, Vec<DVec3>) = (values().collect(), values().collect());
        for (_, entries) in rows.iter() {
            let of = |&(unknown, _): &(u32, f32)| unknowns[unknown as usize].value;
            let low = entries.iter().map(of).fold(DVec3::INFINITY, DVec3::min);
            let high = entries.iter().map(of).fold(DVec3::ZERO, DVec3::max);
            for &(unknown, _) in entries {
                least[unknown as usize] = least[unknown as usize].min(low);
                most[unknown as usize] = most[unknown as usize].max(high);
            }
        }
        let slack = |index: usize| unknowns[index].slack * (most[index] - least[index]);
        let reach = |index: usize| DVec3::splat(unknowns[index].reach);
        let low =
            |index: usize| ((least[index] - slack(index)).max(DVec3::ZERO) - unknowns[index].value).max(-reach(index));
        let high = |index: usize| (most[index] + slack(index) - unknowns[index].value).min(reach(index));
        Self { low: (0..unknowns.len()).map(low).collect(), high: (0..unknowns.len()).map(high).collect() }
    }

    /// Puts on its bound what has gone beyond, to stay there; tells whether there was any.
    fn hold(&self, moves: &mut [DVec3], free: &mut [DVec3]) -> bool {
        let mut is_any = false;
        for (index, (step, free)) in moves.iter_mut().zip(free).enumerate() {
            let beyond = step.cmplt(self.low[index]) | step.cmpgt(self.high[index]);
            *step = step.clamp(self.low[index], self.high[index]);
            *free = DVec3::select(beyond, DVec3::ZERO, *free);
            is_any |= beyond.any();
        }
        is_any
    }

    /// Lets go of what is held on a bound where the pull is away from it again.
    fn release(&self, moves: &[DVec3], pull: &[DVec3], free: &mut [DVec3]) {
        for (index, free) in free.iter_mut().enumerate() {
            let inwards = (moves[index].cmple(self.low[index]) & pull[index].cmpgt(DVec3::ZERO))
                | (moves[index].cmpge(self.high[index]) & pull[index].cmplt(DVec3::ZERO));
            *free = DVec3::select(inwards, DVec3::ONE, *free);
        }
    }
}

/// One round.
struct Problem<'a> {
    rows: &'a Rows,
    unknowns: &'a [Unknown],
    /// What the moves of each row are to make up for.
    goals: &'a [DVec3],
    /// Of the rows.
    weights: &'a [f64],
    /// One where a channel of an unknown may move, else zero.
    free: &'a [DVec3],
}

impl Problem<'_> {
    /// The normal equations' left side, of a move.
    fn apply(&self, of: &[DVec3], result: &mut [DVec3]) {
        for ((result, &of), unknown) in result.iter_mut().zip(of).zip(self.unknowns) {
            *result = of * unknown.stiffness;
        }
        for (row, entries) in self.rows.iter() {
            self.scatter(row, entries, read(entries, of), result);
        }
        self.mask(result);
    }

    fn scatter(&self, row: usize, entries: &[(u32, f32)], value: DVec3, result: &mut [DVec3]) {
        let value = value * self.weights[row];
        for &(unknown, weight) in entries {
            result[unknown as usize] += value * f64::from(weight);
        }
    }

    fn mask(&self, of: &mut [DVec3]) {
        of.iter_mut().zip(self.free).for_each(|(of, &free)| *of *= free);
    }

    /// Minus the gradient where the unknowns have moved.
    fn downhill(&self, moves: &[DVec3]) -> Vec<DVec3> {
        let mut result: Vec<DVec3> =
            moves.iter().zip(self.unknowns).map(|(&step, unknown)| -step * unknown.stiffness).collect();
        for (row, entries) in self.rows.iter() {
            self.scatter(row, entries, -(self.goals[row] + read(entries, moves)), &mut result);
        }
        self.mask(&mut result);
        result
    }

    fn diagonal(&self) -> Vec<f64> {
        let mut diagonal: Vec<f64> = self.unknowns.iter().map(|unknown| unknown.stiffness).collect();
        for (row, entries) in self.rows.iter() {
            for &(unknown, weight) in entries {
                diagonal[unknown as usize] += self.weights[row] * f64::from(weight) * f64::from(weight);
            }
        }
        diagonal
    }

    /// Conjugate gradients from where the unknowns are; each channel for itself.
    fn descend(&self, moves: &mut [DVec3], cancel: &CancelToken) -> Option<()> {
        let diagonal = self.diagonal();
        let scaled = |of: &[DVec3]| -> Vec<DVec3> { of.iter().zip(&diagonal).map(|(&of, &by)| of / by).collect() };
        let mut residual = self.downhill(moves);
        let mut conditioned = scaled(&residual);
        let mut direction = conditioned.clone();
        let mut size = dot(&residual, &conditioned);
        let goal = size * (REDUCTION * REDUCTION);
        let mut image = vec![DVec3::ZERO; moves.len()];
        for _ in 0..STEPS {
            if cancel.is_cancelled() {
                return None;
            }
            if size.cmple(goal).all() {
                break;
            }
            self.apply(&direction, &mut image);
            let step = ratio(size, dot(&direction, &image));
            for index in 0..moves.len() {
                moves[index] += step * direction[index];
                residual[index] -= step * image[index];
            }
            conditioned = scaled(&residual);
            let smaller = dot(&residual, &conditioned);
            let keep = ratio(smaller, size);
            size = smaller;
            direction.iter_mut().zip(&conditioned).for_each(|(along, &new)| *along = new + keep * *along);
        }
        Some(())
    }
}

fn dot(a: &[DVec3], b: &[DVec3]) -> DVec3 {
    a.iter().zip(b).map(|(&a, &b)| a * b).sum()
}

/// Quotients, zero where there is nothing to divide by: a channel that is done, or dark.
fn ratio(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::select(b.cmpgt(DVec3::ZERO), a / b, DVec3::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unknown(value: f64, error: f64) -> Unknown {
        Unknown {
            value: DVec3::splat(value),
            stiffness: stiffness(error, 1.0),
            slack: SLACK_FILLED,
            reach: f64::INFINITY,
        }
    }

    fn two(values: [f64; 2], errors: [f64; 2]) -> Solution {
        let mut rows = Rows::default();
        let difference = DVec3::splat(values[0] - values[1]);
        rows.push([difference, DVec3::ONE], 0.0, [(0, 1.0), (1, -1.0)].into_iter());
        let unknowns = [unknown(values[0], errors[0]), unknown(values[1], errors[1])];
        solve(&rows, &unknowns, &CancelToken::default()).unwrap()
    }

    /// Two texels meet where the weighted mean of the two is, but for what is borne.
    #[test]
    fn the_less_certain_moves_more() {
        let Solution { moves, before, after } = two([1.0, 1.1], [0.01, 0.1]);
        assert!((before[0] - 0.1).abs() < 1e-12 && after[0] < TARGET, "{before:?} {after:?}");
        assert!((-moves[1].x / moves[0].x - 100.0).abs() < 1e-3, "{moves:?}");
    }

    #[test]
    fn equal_values_and_black_ones_do_not_move() {
        for value in [0.0, 0.7] {
            assert!(two([value; 2], [0.1, 0.1]).moves.iter().all(|step| *step == DVec3::ZERO));
        }
    }

    #[test]
    fn nothing_falls_below_zero() {
        // 2 a − b = 0 cannot hold with b − a = 3 unless both move; a would have to be negative.
        let mut rows = Rows::default();
        rows.push([DVec3::splat(4.0), DVec3::ONE], 1.0, [(0, 2.0), (1, 1.0)].into_iter());
        let unknowns = [unknown(0.5, 0.5), unknown(3.0, 0.001)];
        let solution = solve(&rows, &unknowns, &CancelToken::default()).unwrap();
        for (unknown, step) in unknowns.iter().zip(&solution.moves) {
            assert!((unknown.value + *step).min_element() >= 0.0, "{solution:?}", solution = solution.moves);
        }
    }
}

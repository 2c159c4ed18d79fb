//! What texels along seams must do so that lookups agree, as one convex problem. Knows rows and unknowns, no charts.
//!
//! Minimised is Σ ½ (d/e)² over the texels, d being how far one moves and e its error, plus for every lookup pair with
//! the difference u the penalty c · max(0, |u| − t): t is a jump that nobody sees, and c bounds how hard the pair may
//! pull (the loss of support vector regression, Vapnik 1995). So pairs that can agree do, and pairs that cannot pull
//! with a force that does not grow with the jump: they distort nothing, and nothing needs to know beforehand which
//! these are. No texel leaves its bounds. (Seams of lightmaps as least squares are Iwanicki's, "Lighting Technology of
//! The Last of Us", 2013; there every pair pulls as hard as it is far off.)
//!
//! Solved is the dual problem, one pair's pull after the other (Hildreth 1957; Hsieh et al. 2008): texels are where all
//! pulls together hold them, so that at any time all bounds hold, and stopping early only leaves jumps. All sums run
//! in a fixed order.

use crate::bake::CancelToken;
use glam::{BVec3, DVec3};

/// The relative jump that nobody sees.
const UNSEEN: f64 = 4e-3;

/// How far a pair can pull its texels, in their errors.
const STRENGTH: f64 = 10.0;

/// A pair that is left apart by more than this, relative, though it pulls as hard as it can, may pull so many times as
/// hard, once: at the dark foot of a shadow both sides are uncertain, and what is left is much to what is local.
const LEFT_APART: f64 = 8e-3;
const HARDER: f64 = 3.0;

/// A pair that is off by less than this more than what is unseen, in that, is done.
const CLOSE: f64 = 0.1;

/// The most sweeps over all pairs, and after how many it is asked anew which pairs need them.
const SWEEPS: usize = 8000;
const PERIOD: usize = 20;

/// If in that time no texel moves by more than this, in its error, none will.
const SETTLED: f64 = 2e-3;

/// An unknown: one texel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unknown {
    /// Before [cd/m²].
    pub(super) value: DVec3,
    /// How far off it may be [cd/m²].
    pub(super) error: f64,
    /// How far it may move [cd/m²].
    pub(super) reach: f64,
}

/// How two lookups differ: `difference + Σ weight·move`.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    /// Before [cd/m²].
    difference: Vec<DVec3>,
    /// The mean of both lookups before [cd/m²].
    mean: Vec<DVec3>,
    /// What the local value is at least [cd/m²].
    floor: Vec<f64>,
    /// Where each row's entries end.
    ends: Vec<u32>,
    /// Unknowns and weights.
    entries: Vec<(u32, f32)>,
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
        let begin = self.entries.len();
        for (unknown, weight) in entries {
            // Where a chart is slit both lookups may read the same texel.
            match self.entries[begin..].iter_mut().find(|(known, _)| *known == unknown) {
                Some((_, known)) => *known += weight as f32,
                None => self.entries.push((unknown, weight as f32)),
            }
        }
        self.ends.push(self.entries.len() as u32);
        self.difference.push(difference);
        self.mean.push(mean);
        self.floor.push(floor);
    }

    fn len(&self) -> usize {
        self.ends.len()
    }

    fn entries(&self, row: usize) -> &[(u32, f32)] {
        let begin = if row == 0 { 0 } else { self.ends[row - 1] as usize };
        &self.entries[begin..self.ends[row] as usize]
    }

    /// The difference where the unknowns have moved.
    fn left(&self, row: usize, moves: &[DVec3]) -> DVec3 {
        let read = |&(unknown, weight): &(u32, f32)| moves[unknown as usize] * f64::from(weight);
        self.difference[row] + self.entries(row).iter().map(read).sum::<DVec3>()
    }

    /// The local value where the unknowns have moved: the strongest channel of the mean of both lookups.
    fn local(&self, row: usize, moves: &[DVec3]) -> f64 {
        // The sign of a weight tells the side, and lookups have no negative ones.
        let read = |&(unknown, weight): &(u32, f32)| moves[unknown as usize] * f64::from(weight.abs());
        let moved: DVec3 = self.entries(row).iter().map(read).sum();
        (self.mean[row] + 0.5 * moved).max_element().max(self.floor[row])
    }

    /// Differences over the local values.
    fn jumps(&self, moves: &[DVec3]) -> Vec<f64> {
        let jump = |row: usize| {
            let local = self.local(row, moves);
            if local > 0.0 { self.left(row, moves).abs().max_element() / local } else { 0.0 }
        };
        (0..self.len()).map(jump).collect()
    }
}

/// Solves one group of seams; `None` if cancelled.
pub(super) fn solve(rows: &Rows, unknowns: &[Unknown], cancel: &CancelToken) -> Option<Solution> {
    let mut state = State::new(rows, unknowns);
    let before = rows.jumps(&state.moves);
    state.settle(cancel)?;
    if state.strengthen() {
        state.settle(cancel)?;
    }
    let after = rows.jumps(&state.moves);
    Some(Solution { moves: state.moves, before, after })
}

/// All pulls, and where they hold the texels.
struct State<'a> {
    rows: &'a Rows,
    unknowns: &'a [Unknown],
    bounds: Vec<[DVec3; 2]>,
    /// Of each row [1/(cd/m²)].
    pulls: Vec<DVec3>,
    /// The largest of each row [1/(cd/m²)].
    strengths: Vec<f64>,
    /// What a pull of one changes in the difference [(cd/m²)²].
    yields: Vec<f64>,
    /// The jump that nobody sees, of each row [cd/m²].
    unseen: Vec<f64>,
    /// Sum of all on each unknown [1/(cd/m²)].
    forces: Vec<DVec3>,
    /// Where that holds it [cd/m²].
    moves: Vec<DVec3>,
}

impl<'a> State<'a> {
    fn new(rows: &'a Rows, unknowns: &'a [Unknown]) -> Self {
        let squared = |&(unknown, weight): &(u32, f32)| (f64::from(weight) * unknowns[unknown as usize].error).powi(2);
        let yields: Vec<f64> = (0..rows.len()).map(|row| rows.entries(row).iter().map(squared).sum()).collect();
        Self {
            rows,
            unknowns,
            bounds: bounds(rows, unknowns),
            moves: vec![DVec3::ZERO; unknowns.len()],
            pulls: vec![DVec3::ZERO; rows.len()],
            strengths: yields.iter().map(|&yields: &f64| STRENGTH / yields.sqrt()).collect(),
            yields,
            unseen: vec![0.0; rows.len()],
            forces: vec![DVec3::ZERO; unknowns.len()],
        }
    }

    /// Lets all pull until nothing moves; `None` if cancelled.
    fn settle(&mut self, cancel: &CancelToken) -> Option<()> {
        for _ in 0..SWEEPS / PERIOD {
            let busy = self.busy();
            if busy.is_empty() {
                break;
            }
            let before = self.moves.clone();
            for _ in 0..PERIOD / 2 {
                if cancel.is_cancelled() {
                    return None;
                }
                // There and back again, so that both ends of a seam hear of each other.
                busy.iter().for_each(|&row| self.pull(row));
                busy.iter().rev().for_each(|&row| self.pull(row));
            }
            if self.is_settled(&before) {
                break;
            }
        }
        Some(())
    }

    /// Lets pairs that are left apart pull harder; whether there are any.
    fn strengthen(&mut self) -> bool {
        let jumps = self.rows.jumps(&self.moves);
        let mut is_any = false;
        for (row, jump) in jumps.into_iter().enumerate() {
            if jump > LEFT_APART && self.is_spent(row).any() {
                self.strengths[row] *= HARDER;
                is_any = true;
            }
        }
        is_any
    }

    /// In which channels a row pulls as hard as it can.
    fn is_spent(&self, row: usize) -> BVec3 {
        self.pulls[row].abs().cmpge(DVec3::splat(self.strengths[row]))
    }

    /// Whether no unknown has moved by what would matter.
    fn is_settled(&self, before: &[DVec3]) -> bool {
        let steps = self.moves.iter().zip(before).map(|(&now, &before)| (now - before).abs().max_element());
        steps.zip(self.unknowns).all(|(step, unknown)| step <= SETTLED * unknown.error)
    }

    /// The rows that pull or should; none if all are done.
    fn busy(&mut self) -> Vec<usize> {
        let mut is_done = true;
        for row in 0..self.rows.len() {
            self.unseen[row] = UNSEEN * self.rows.local(row, &self.moves);
        }
        let busy = (0..self.rows.len()).filter(|&row| {
            let unseen = self.unseen[row];
            let excess = self.rows.left(row, &self.moves).abs() - unseen;
            is_done &= (excess.cmple(DVec3::splat(CLOSE * unseen)) | self.is_spent(row)).all();
            self.yields[row] > 0.0 && (self.pulls[row] != DVec3::ZERO || excess.max_element() > 0.0)
        });
        let busy: Vec<usize> = busy.collect();
        if is_done { Vec::new() } else { busy }
    }

    /// Lets one row pull as hard as it takes to be unseen.
    fn pull(&mut self, row: usize) {
        let unseen = DVec3::splat(self.unseen[row]);
        let left = self.rows.left(row, &self.moves);
        let (before, yields) = (self.pulls[row], self.yields[row]);
        let up = (before + (left - unseen) / yields).max(DVec3::ZERO);
        let down = (before + (left + unseen) / yields).min(DVec3::ZERO);
        let strength = DVec3::splat(self.strengths[row]);
        let pull = (up + down).clamp(-strength, strength);
        let change = pull - before;
        if change == DVec3::ZERO {
            return;
        }
        self.pulls[row] = pull;
        for &(unknown, weight) in self.rows.entries(row) {
            let unknown = unknown as usize;
            let error = self.unknowns[unknown].error;
            let force = &mut self.forces[unknown];
            *force += change * f64::from(weight);
            let [low, high] = self.bounds[unknown];
            self.moves[unknown] = (-*force * (error * error)).clamp(low, high);
        }
    }
}

/// How far each unknown may move, down and up: no farther than its reach, and not out of the range of all that it is to
/// agree with.
fn bounds(rows: &Rows, unknowns: &[Unknown]) -> Vec<[DVec3; 2]> {
    let mut ranges: Vec<[DVec3; 2]> = unknowns.iter().map(|unknown| [unknown.value; 2]).collect();
    for row in 0..rows.len() {
        let values = || rows.entries(row).iter().map(|&(unknown, _)| unknowns[unknown as usize].value);
        let (low, high) = (values().fold(DVec3::INFINITY, DVec3::min), values().fold(DVec3::ZERO, DVec3::max));
        for &(unknown, _) in rows.entries(row) {
            let [least, most] = &mut ranges[unknown as usize];
            (*least, *most) = (least.min(low), most.max(high));
        }
    }
    let bound = |(range, unknown): ([DVec3; 2], &Unknown)| {
        let reach = DVec3::splat(unknown.reach);
        range.map(|end| (end - unknown.value).clamp(-reach, reach))
    };
    ranges.into_iter().zip(unknowns).map(bound).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unknown(value: f64, error: f64) -> Unknown {
        Unknown { value: DVec3::splat(value), error, reach: f64::INFINITY }
    }

    /// Pairs of texels that should be the same.
    fn same(unknowns: &[Unknown], pairs: &[[u32; 2]]) -> Rows {
        let mut rows = Rows::default();
        for &[a, b] in pairs {
            let [x, y] = [a, b].map(|number| unknowns[number as usize].value);
            rows.push([x - y, 0.5 * (x + y)], 0.0, [(a, 1.0), (b, -1.0)].into_iter());
        }
        rows
    }

    fn solved(unknowns: &[Unknown], pairs: &[[u32; 2]]) -> Solution {
        solve(&same(unknowns, pairs), unknowns, &CancelToken::default()).unwrap()
    }

    /// Two texels meet where the weighted mean of the two is, but for what is unseen.
    #[test]
    fn the_less_certain_moves_more() {
        let unknowns = [unknown(1.0, 0.01), unknown(1.1, 0.1)];
        let Solution { moves, before, after } = solved(&unknowns, &[[0, 1]]);
        assert!((before[0] - 0.1 / 1.05).abs() < 1e-12, "{before:?}");
        assert!(after[0] < (1.0 + CLOSE) * UNSEEN && after[0] > 0.9 * UNSEEN, "{after:?}");
        assert!((-moves[1].x / moves[0].x - 100.0).abs() < 1e-9, "{moves:?}");
    }

    #[test]
    fn equal_values_and_black_ones_do_not_move() {
        for value in [0.0, 0.7] {
            let solution = solved(&[unknown(value, 0.1), unknown(value, 0.1)], &[[0, 1]]);
            assert!(solution.moves.iter().all(|step| *step == DVec3::ZERO));
        }
    }

    /// Pairs that cannot agree pull with what they have, and nothing leaves the range of what it is to agree with.
    #[test]
    fn what_cannot_agree_drives_nothing_away() {
        // A certain dark one and a certain bright one, and an uncertain one that is to be the same as both.
        let unknowns = [unknown(0.1, 1e-3), unknown(2.0, 1e-3), unknown(1.0, 0.5)];
        let Solution { moves, after, .. } = solved(&unknowns, &[[0, 2], [1, 2]]);
        assert!(after.iter().any(|&jump| jump > 0.1), "{after:?}");
        for (unknown, step) in unknowns.iter().zip(&moves) {
            let value = (unknown.value + *step).x;
            assert!((0.1 - 1e-12..=2.0 + 1e-12).contains(&value), "{value}");
        }
        // The certain ones move by no more than their pairs' pull.
        let most = HARDER * STRENGTH / (1e-6_f64 + 0.25).sqrt() * 1e-6;
        assert!(moves[..2].iter().all(|step| step.x.abs() <= most * (1.0 + 1e-9)), "{moves:?}");
    }

    #[test]
    fn nothing_goes_beyond_its_reach() {
        let unknowns = [Unknown { reach: 0.02, ..unknown(1.0, 0.1) }, Unknown { reach: 0.03, ..unknown(1.5, 0.1) }];
        let Solution { moves, .. } = solved(&unknowns, &[[0, 1]]);
        assert_eq!([moves[0].x, moves[1].x], [0.02, -0.03]);
    }

    /// A chain of pairs, every other texel too dark: all meet in the middle.
    #[test]
    fn a_chain_evens_out() {
        let unknowns: Vec<Unknown> = (0..20).map(|place| unknown([1.0, 1.2][place % 2], 0.1)).collect();
        let pairs: Vec<[u32; 2]> = (0..19).map(|place| [place, place + 1]).collect();
        let Solution { moves, after, .. } = solved(&unknowns, &pairs);
        assert!(after.iter().all(|&jump| jump < (1.0 + CLOSE) * UNSEEN), "{after:?}");
        for (unknown, step) in unknowns.iter().zip(&moves) {
            assert!(((unknown.value + *step).x - 1.1).abs() < 0.01, "{moves:?}");
        }
    }
}

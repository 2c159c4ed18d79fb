//! Takes the noise out of measured texels, and leaves what their error bars do not allow to be noise.
//!
//! About each texel a paraboloid is fitted to the texels that look like it: those whose surroundings differ by no more
//! than noise (non-local means, Buades et al. 2005, with the variance taken out as in Rousselle et al. 2012). Which
//! those are is read from one half of the runs, and what is fitted is the other half (Rousselle et al. 2013; Bitterli
//! et al. 2016), so that no weight knows the noise that it weighs; the mean of both ways is the outcome. Light on a
//! surface is smooth almost everywhere, which the paraboloid keeps, right up to a chart's border; at the edge of a
//! shadow the texels beyond are not like those before it.
//!
//! It is done twice. A first, small window finds its likes in the measurement; a second, larger one compares the fits
//! of the first, which are less noisy and have slopes, so that texels of one slope are alike however far down they lie.
//! Which of the two is nearer to the truth is estimated (`select`). A texel that light only missed by chance counts as
//! noisy like those about it (`luck`).
//!
//! What it promises: a window is walked over links, so that nothing comes from another chart, from behind a wall, or
//! from a texel that is not measured. A channel without error keeps its bits. No texel moves by more than
//! [`REACH`] of its standard errors, nor out of the range of the texels that it is made of, so that none gets negative.
//!
//! Owns the method; changes values and residuals of measured texels and nothing else.

mod fit;
mod likeness;
mod luck;
mod select;
mod texels;
mod window;

#[cfg(test)]
mod tests;

use super::Field;
use crate::bake::gather::{Estimate, relative_error};
use crate::bake::report::Denoised;
use crate::bake::workers::Workers;
use crate::bake::{BakeError, CancelToken};
use crate::math::luminance;
use fit::{Fitted, Member, Place, Sums};
use glam::Vec3;
use likeness::Looks;
use texels::Texels;
use window::{Reached, Window};

/// How far a texel looks for others like it, first and then [texels].
const RADII: [f32; 2] = [7.5, 10.0];

/// How far a texel may be moved, in standard errors.
const REACH: f32 = 4.0;

/// Takes the noise out of the pages; says how much there was and how much is left.
pub(super) fn denoise(fields: &mut [Field], workers: &Workers<'_>) -> Result<Denoised, BakeError> {
    let before = relative_error(&estimates(fields));
    for field in fields.iter_mut() {
        denoise_page(field, workers)?;
    }
    Ok(Denoised { before, after: relative_error(&estimates(fields)) })
}

/// Measured texels with what is left of their errors.
fn estimates(fields: &[Field]) -> Vec<Estimate> {
    let of_field = |field: &Field| {
        let measured = (0..field.value.len()).filter(|&index| field.is_measured(index));
        let estimate = |index: usize| {
            let [whole, left] = [field.stderr[index], field.residual[index]].map(|error| luminance(error.as_dvec3()));
            // Channels err together in what is left as they did before.
            let share = if whole > 0.0 { left / whole } else { 0.0 };
            let luminance_error = share * f64::from(field.luminance_error[index]);
            Estimate { mean: field.value[index].as_dvec3(), luminance_error, ..Estimate::default() }
        };
        measured.map(estimate).collect::<Vec<_>>()
    };
    fields.iter().flat_map(of_field).collect()
}

/// A texel by those in a window that look like it.
#[derive(Clone, Copy, Debug, Default)]
struct Level {
    /// Each half by its own weights: for nothing but to find those that look like it.
    own: [Fitted; 2],
    /// Each half by the other half's weights.
    crossed: [Fitted; 2],
    /// The same as planes.
    flat: [Fitted; 2],
    /// Least and most of what it is made of.
    range: [Vec3; 2],
}

fn denoise_page(field: &mut Field, workers: &Workers<'_>) -> Result<(), BakeError> {
    let texels = Texels::new(field);
    let looks = [0, 1].map(|half| Looks::measured(&texels, half));
    let [small, large] = RADII;
    let small = level(&texels, &looks, small, workers)?;
    let looks = [0, 1].map(|half| Looks::fitted(&texels, small.iter().map(|level| level.own[half])));
    let large = level(&texels, &looks, large, workers)?;
    let kinship = kinship(&texels, &large);
    let best = select::best(&texels, [&small, &large], workers)?;
    let ranges = small.iter().zip(&large).map(|(small, large)| widest(small.range, large.range));
    for ((&index, [value, residual]), range) in texels.measured.iter().zip(best).zip(ranges) {
        // A half has twice the variance of the whole.
        let stderr = root(0.5 * texels.variance[index]);
        let is_exact = stderr.cmpeq(Vec3::ZERO);
        let value = allowed(field.value[index], REACH * stderr.max(field.stderr[index]), range, value);
        field.value[index] = Vec3::select(is_exact, field.value[index], value);
        field.residual[index] = Vec3::select(is_exact, Vec3::ZERO, kinship * residual);
    }
    Ok(())
}

/// How much more is left of the error than if no two texels erred together, as those do that share paths: what the two
/// independent halves differ by after denoising, over what they would, never below 1.
fn kinship(texels: &Texels, levels: &[Level]) -> f32 {
    let value = |index: usize| luminance(texels.mean(index).as_dvec3());
    let mean = texels.measured.iter().map(|&index| value(index)).sum::<f64>() / texels.measured.len().max(1) as f64;
    let [mut seen, mut told] = [0.0_f64; 2];
    for (&index, Level { crossed: [first, second], .. }) in texels.measured.iter().zip(levels) {
        // Relative, but not to what is nearly black.
        let weight = (value(index) + mean).powi(-2);
        let [off, variance] = [first.value - second.value, first.variance + second.variance];
        seen += weight * f64::from(off.length_squared());
        told += weight * f64::from(variance.element_sum());
    }
    if told > 0.0 { (seen / told).sqrt().max(1.0) as f32 } else { 1.0 }
}

fn live(cancel: &CancelToken) -> Option<()> {
    (!cancel.is_cancelled()).then_some(())
}

/// All measured texels by the texels that look like them.
fn level(texels: &Texels, looks: &[Looks<'_>; 2], radius: f32, workers: &Workers<'_>) -> Result<Vec<Level>, BakeError> {
    let window = Window::new(radius);
    workers.gather_quietly(&texels.measured, |&index, cancel| {
        live(cancel)?;
        Some(filter(texels, looks, &window.reach(texels, index), radius))
    })
}

/// What a texel is by the texels that look like it.
fn filter(texels: &Texels, looks: &[Looks<'_>; 2], reached: &[Reached], radius: f32) -> Level {
    let middle = reached[0].index;
    let variance = texels.variance[middle].element_sum();
    let member = |other: &Reached| {
        let index = other.index;
        let ratio = if variance > 0.0 { texels.variance[index].element_sum() / variance } else { 1.0 };
        let values = texels.halves.each_ref().map(|half| half[index]);
        let place = Place::new(other.step, radius);
        Member { weight: 1.0, place, values, variance: texels.variance[index], ratio }
    };
    let own = member(&reached[0]);
    let mut range = [own.values[0].min(own.values[1]), own.values[0].max(own.values[1])];
    let mut sums = [Sums::about(own.values), Sums::about(own.values)];
    for sums in &mut sums {
        sums.add(own);
    }
    for other in &reached[1..] {
        let member = member(other);
        // Of two that look alike the one with less noise says more.
        let certain = f32::min(1.0, 5.0 / (1.0 + member.ratio));
        let near = 1.0 - other.squared_distance() / (radius * radius);
        for (looks, sums) in looks.iter().zip(&mut sums) {
            let weight = near * certain * looks.likeness(middle, other.index, other.step);
            if weight > 0.0 {
                sums.add(Member { weight, ..member });
                let [first, second] = member.values;
                range = widest(range, [first.min(second), first.max(second)]);
            }
        }
    }
    let [by_first, by_second] = sums.map(|sums| sums.fitted(radius));
    Level {
        own: [by_first.curved[0], by_second.curved[1]],
        crossed: [by_second.curved[0], by_first.curved[1]],
        flat: [by_second.flat[0], by_first.flat[1]],
        range,
    }
}

fn widest([low, high]: [Vec3; 2], [other_low, other_high]: [Vec3; 2]) -> [Vec3; 2] {
    [low.min(other_low), high.max(other_high)]
}

/// A value no further from what was measured than it may be, and within the range of what it is made of.
fn allowed(measured: Vec3, reach: Vec3, [low, high]: [Vec3; 2], value: Vec3) -> Vec3 {
    let (low, high) = (low.max(measured - reach), high.min(measured + reach));
    value.max(low.min(measured)).min(high.max(measured))
}

fn root(squares: Vec3) -> Vec3 {
    Vec3::from(squares.to_array().map(f32::sqrt))
}

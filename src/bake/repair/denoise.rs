//! Takes the noise out of measured texels, and leaves what their error bars do not allow to be noise.
//!
//! About each texel a paraboloid is fitted to the texels that look like it: those whose surroundings differ by no more
//! than noise (non-local means, Buades et al. 2005, with the variance taken out as in Rousselle et al. 2012). Which
//! those are is read from one half of the runs, and what is fitted is the other half (Rousselle et al. 2013; Bitterli
//! et al. 2016), so that no weight knows the noise that it weighs; the mean of both ways is the outcome. Light on a
//! surface is smooth almost everywhere, which the paraboloid keeps, right up to a chart's border; at the edge of a
//! shadow the texels beyond are not like those before it.
//!
//! It is done twice. A first, small window fits each half by itself; a second, larger one compares those fits, which
//! are less noisy and have slopes, so that texels of one slope are alike however far down they lie.
//!
//! What it promises: a window is walked over links, so that nothing comes from another chart, from behind a wall, or
//! from a texel that is not measured. A channel without error keeps its bits. No texel moves by more than
//! [`REACH`] of its standard errors, nor out of the range of the texels that it is made of, so that none gets negative.
//!
//! Owns the method; changes values and residuals of measured texels and nothing else.

mod fit;
mod likeness;
mod texels;
mod window;

#[cfg(test)]
mod tests;

use super::Field;
use crate::bake::gather::{Estimate, relative_error};
use crate::bake::report::Denoised;
use crate::bake::workers::Workers;
use crate::bake::{BakeError, CancelToken};
use fit::{Fitted, Place, Sums};
use glam::Vec3;
use likeness::Looks;
use texels::Texels;
use window::{Reached, Window};

/// How far a texel looks for others like it, first and then [texels].
const RADII: [f32; 2] = [4.6, 8.0];

/// How far a texel may be moved, in standard errors.
const REACH: f32 = 4.0;

/// Takes the noise out of the pages; says how much there was and how much is left.
pub(super) fn denoise(fields: &mut [Field], workers: &Workers<'_>) -> Result<Denoised, BakeError> {
    let before = relative_error(&estimates(fields, |field| &field.stderr));
    for field in fields.iter_mut() {
        denoise_page(field, workers)?;
    }
    Ok(Denoised { before, after: relative_error(&estimates(fields, |field| &field.residual)) })
}

/// Measured texels with one of their layers of errors.
fn estimates(fields: &[Field], error: impl Fn(&Field) -> &Vec<Vec3>) -> Vec<Estimate> {
    let of_field = |field: &Field| {
        let measured = (0..field.value.len()).filter(|&index| field.is_measured(index));
        let estimate = |index: usize| Estimate {
            mean: field.value[index].as_dvec3(),
            stderr: error(field)[index].as_dvec3(),
            ..Estimate::default()
        };
        measured.map(estimate).collect::<Vec<_>>()
    };
    fields.iter().flat_map(of_field).collect()
}

/// A texel with half of the runs, as the other half weighs it.
#[derive(Clone, Copy, Debug, Default)]
struct Filtered {
    fitted: Fitted,
    /// Least and most of what it is made of.
    range: [Vec3; 2],
}

fn denoise_page(field: &mut Field, workers: &Workers<'_>) -> Result<(), BakeError> {
    let texels = Texels::new(field);
    let [first, second] = RADII.map(Window::new);
    let measured = [0, 1].map(|half| Looks::measured(&texels, half));
    let fits = filtered(&texels, &first, workers, |half, reached| {
        filter(&texels, &measured[half], half, reached, RADII[0]).fitted
    })?;
    let fitted = [0, 1].map(|half| Looks::fitted(&texels, fits.iter().map(|fits| fits[half])));
    let filtered = filtered(&texels, &second, workers, |half, reached| {
        filter(&texels, &fitted[half], 1 - half, reached, RADII[1])
    })?;
    for (&index, halves) in texels.measured.iter().zip(&filtered) {
        let [value, residual] = merged(&texels, field, index, halves);
        field.value[index] = value;
        field.residual[index] = residual;
    }
    Ok(())
}

fn live(cancel: &CancelToken) -> Option<()> {
    (!cancel.is_cancelled()).then_some(())
}

/// Something of each measured texel and each half, from the texels that can be reached.
fn filtered<T: Send>(
    texels: &Texels,
    window: &Window,
    workers: &Workers<'_>,
    work: impl Fn(usize, &[Reached]) -> T + Sync,
) -> Result<Vec<[T; 2]>, BakeError> {
    workers.gather_quietly(&texels.measured, |&index, cancel| {
        live(cancel)?;
        let reached = window.reach(texels, index);
        Some([0, 1].map(|half| work(half, &reached)))
    })
}

/// What a texel of one half is by the texels that look like it.
fn filter(texels: &Texels, looks: &Looks<'_>, half: usize, reached: &[Reached], radius: f32) -> Filtered {
    let measured = &texels.halves[half];
    let middle = reached[0].index;
    let own = measured[middle];
    let mut range = [own, own];
    let mut sums = Sums::default();
    sums.add(1.0, Place::MIDDLE, own, texels.variance[middle]);
    for other in &reached[1..] {
        let near = 1.0 - other.squared_distance() / (radius * radius);
        let weight = near * looks.likeness(middle, other.index, other.step);
        if weight > 0.0 {
            let value = measured[other.index];
            sums.add(weight, Place::new(other.step, radius), value, texels.variance[other.index]);
            range = [range[0].min(value), range[1].max(value)];
        }
    }
    Filtered { fitted: sums.fitted(radius), range }
}

/// The mean of both halves within what is allowed, and its standard error.
fn merged(texels: &Texels, field: &Field, index: usize, halves: &[Filtered; 2]) -> [Vec3; 2] {
    let [first, second] = halves;
    let measured = field.value[index];
    // A half has twice the variance of the whole.
    let reach = REACH * root(0.5 * texels.variance[index]).max(field.stderr[index]);
    let low = first.range[0].min(second.range[0]).max(measured - reach);
    let high = first.range[1].max(second.range[1]).min(measured + reach);
    let value = (0.5 * (first.fitted.value + second.fitted.value)).max(low.min(measured)).min(high.max(measured));
    let residual = root(0.25 * (first.fitted.variance + second.fitted.variance));
    let is_exact = field.stderr[index].cmpeq(Vec3::ZERO);
    [Vec3::select(is_exact, measured, value), Vec3::select(is_exact, Vec3::ZERO, residual)]
}

fn root(squares: Vec3) -> Vec3 {
    Vec3::from(squares.to_array().map(f32::sqrt))
}

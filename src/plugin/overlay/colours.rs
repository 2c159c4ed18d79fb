//! What is known of each texel of a bake, as colours.

use super::KilnOverlay;
use super::legend::{Swatch, swatch};
use crate::bake::{Page, TexelState};
use crate::math::{Portable, luminance};

/// A colour as a screen takes it, 8-bit sRGB.
pub(super) type Rgb = [u8; 3];

/// As asked.
pub(super) const GREEN: Rgb = [60, 170, 80];
const BLUE: Rgb = [50, 70, 180];
const CYAN: Rgb = [60, 160, 210];
const YELLOW: Rgb = [235, 200, 50];
const RED: Rgb = [210, 45, 40];
const MAGENTA: Rgb = [200, 50, 190];
const NOTHING: Rgb = [0, 0, 0];

/// How bright every second texel of the checkerboard is, in 8-bit sRGB, over the others.
const DIM: f64 = 0.7;

/// Colours of the density over that asked for, by powers of two.
const DENSITY: [(f64, Rgb); 5] = [(-2.0, RED), (-1.0, YELLOW), (0.0, GREEN), (1.0, CYAN), (2.0, BLUE)];

/// Colours of the error over that asked for.
const ERROR: [(f64, Rgb); 5] = [(0.0, BLUE), (0.5, CYAN), (1.0, GREEN), (2.0, YELLOW), (4.0, RED)];

/// What texels are held against.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    /// Texels per metre.
    pub(super) density: f32,
    /// Half the width of the interval that holds the truth in 95 of 100 cases, over the value.
    pub(super) error: f64,
    /// What a darker texel's error is over [cd/m²].
    pub(super) floor: f64,
}

/// The colour of a texel; none where texels are shown as light.
pub(super) fn of_texel(overlay: KilnOverlay, page: &Page, texel: usize, asked: Asked) -> Rgb {
    match overlay {
        KilnOverlay::TexelDensity => {
            let ratio = f64::from(page.density[texel] / asked.density);
            let colour = if ratio > 0.0 { ramp(&DENSITY, Portable::log2(ratio)) } else { NOTHING };
            let width = page.width as usize;
            let is_dim = (texel % width + texel / width) % 2 == 1;
            if is_dim { colour.map(|value| (f64::from(value) * DIM).round() as u8) } else { colour }
        }
        KilnOverlay::Charts => page.chart[texel].checked_sub(1).map_or(NOTHING, of_chart),
        KilnOverlay::Error => match page.state[texel] {
            TexelState::Measured => {
                let value = luminance(page.raw[texel].as_dvec3()).max(asked.floor);
                let error = if value > 0.0 { f64::from(page.half_width[texel]) / value } else { 0.0 };
                ramp(&ERROR, error / asked.error)
            }
            TexelState::Empty | TexelState::Hidden => NOTHING,
        },
        KilnOverlay::Validity => match page.state[texel] {
            TexelState::Measured if page.is_overlapped[texel] => RED,
            TexelState::Measured => GREEN,
            TexelState::Hidden => MAGENTA,
            TexelState::Empty => BLUE,
        },
        KilnOverlay::None | KilnOverlay::DirectOnly | KilnOverlay::IndirectOnly => NOTHING,
    }
}

/// What the colours mean.
pub(super) fn swatches(overlay: KilnOverlay) -> Vec<Swatch> {
    let along = |ramp: &[(f64, Rgb)], words: [&str; 5]| {
        let stops = ramp.iter().zip(words).map(|(&(_, colour), words)| swatch(colour, words));
        stops.chain([swatch(NOTHING, "not measured")]).collect()
    };
    match overlay {
        KilnOverlay::TexelDensity => along(&DENSITY, ["a quarter", "half", "as asked", "twice", "four times"]),
        KilnOverlay::Error => along(&ERROR, ["none", "half", "as asked", "twice", "four times and more"]),
        KilnOverlay::Validity => vec![
            swatch(GREEN, "measured"),
            swatch(MAGENTA, "inside of bodies, filled in"),
            swatch(BLUE, "not covered, filled in"),
            swatch(RED, "overlaps another chart"),
        ],
        KilnOverlay::None | KilnOverlay::Charts | KilnOverlay::DirectOnly | KilnOverlay::IndirectOnly => Vec::new(),
    }
}

/// Between the two stops next to `at`, or the one beyond which it lies.
fn ramp(stops: &[(f64, Rgb)], at: f64) -> Rgb {
    let next = stops.iter().position(|&(stop, _)| at <= stop);
    match next {
        Some(0) => stops[0].1,
        None => stops[stops.len() - 1].1,
        Some(next) => {
            let ((from, low), (to, high)) = (stops[next - 1], stops[next]);
            let share = (at - from) / (to - from);
            std::array::from_fn(|channel| {
                let (low, high) = (f64::from(low[channel]), f64::from(high[channel]));
                (low + (high - low) * share).round() as u8
            })
        }
    }
}

/// Hues a golden angle apart, so that charts with numbers that are near differ most.
fn of_chart(number: u32) -> Rgb {
    let hue = (f64::from(number) * 0.618_033_988_749_895).fract() * 6.0;
    [5.0, 3.0, 1.0].map(|offset| {
        let at = (offset + hue) % 6.0;
        let channel = at.min(4.0 - at).clamp(0.0, 1.0);
        (255.0 * 0.9 * (1.0 - 0.65 * channel)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const ASKED: Asked = Asked { density: 8.0, error: 0.02, floor: 0.1 };

    fn page() -> Page {
        Page {
            width: 2,
            height: 2,
            raw: vec![Vec3::ONE, Vec3::splat(0.01), Vec3::ONE, Vec3::ZERO],
            half_width: vec![0.02, 0.004, 1.0, 0.0],
            state: vec![TexelState::Measured, TexelState::Measured, TexelState::Hidden, TexelState::Empty],
            chart: vec![1, 2, 1, 0],
            density: vec![8.0, 4.0, 32.0, 0.0],
            is_overlapped: vec![false, true, false, false],
            ..Page::default()
        }
    }

    fn all(overlay: KilnOverlay) -> Vec<Rgb> {
        (0..4).map(|texel| of_texel(overlay, &page(), texel, ASKED)).collect()
    }

    #[test]
    fn each_texel_has_the_colour_of_what_it_is() {
        let dim = |colour: Rgb| colour.map(|value| (f64::from(value) * DIM).round() as u8);
        assert_eq!(all(KilnOverlay::TexelDensity), [GREEN, dim(YELLOW), dim(BLUE), NOTHING]);
        assert_eq!(all(KilnOverlay::Validity), [GREEN, RED, MAGENTA, BLUE]);
        // The second is darker than the floor, of which its width is 4 %.
        assert_eq!(all(KilnOverlay::Error), [GREEN, YELLOW, NOTHING, NOTHING]);
        let charts = all(KilnOverlay::Charts);
        assert!(charts[0] == charts[2] && charts[0] != charts[1] && charts[3] == NOTHING);
    }

    #[test]
    fn colours_run_between_the_stops_and_end_with_them() {
        assert_eq!(ramp(&[(0.0, [0, 0, 100]), (1.0, [100, 0, 0])], 0.25), [25, 0, 75]);
        assert_eq!((ramp(&ERROR, -1.0), ramp(&ERROR, 9.0), ramp(&ERROR, 2.0)), (BLUE, RED, YELLOW));
        let hues: std::collections::BTreeSet<Rgb> = (0..100).map(of_chart).collect();
        assert!(hues.len() > 90, "{}", hues.len());
        assert!(hues.iter().all(|colour| colour.iter().max() == Some(&230)), "{hues:?}");
    }
}

//! Photometric conversions as Bevy displays light. Names the formulas once; knows neither lights nor materials.

use super::Portable;
use std::f64::consts::PI;

/// The constant of the saturation-based exposure that Bevy uses: luminance that reaches white = 1.2 · 2^EV100 cd/m²
/// (Lagarde and de Rousiers 2014, "Moving Frostbite to Physically Based Rendering", section 5.1.2).
const WHITE_AT_EV100_0: f64 = 1.2;

/// The radiance [cd/m²] of a one-sided Lambertian rectangle of `width` × `height` [m] that gives `power` [lm]:
/// Φ/(π w h). Infinite where the area is 0.
#[inline]
pub fn rect_light_radiance(power: f64, width: f64, height: f64) -> f64 {
    power / (PI * width * height)
}

/// What a camera at `ev100` [EV at ISO 100] multiplies luminance by [m²/cd]: 1/(1.2 · 2^EV100).
#[inline]
pub fn exposure_from_ev100(ev100: f64) -> f64 {
    Portable::exp2(-ev100) / WHITE_AT_EV100_0
}

/// The EV at ISO 100 of a camera that multiplies luminance by `exposure` [m²/cd]: the inverse of
/// [`exposure_from_ev100`].
#[inline]
pub fn ev100_from_exposure(exposure: f64) -> f64 {
    -Portable::log2(exposure * WHITE_AT_EV100_0)
}

/// The radiance [cd/m²] at which a surface of `emissive` looks on the screen of a camera at `ev100`: Bevy adds
/// emissive after exposure, so the number stands for emissive · 1.2 · 2^EV100.
#[inline]
pub fn emissive_radiance_as_displayed(emissive: f64, ev100: f64) -> f64 {
    emissive / exposure_from_ev100(ev100)
}

/// The `emissive` that looks like `radiance` [cd/m²] at `ev100`: the inverse of [`emissive_radiance_as_displayed`].
#[inline]
pub fn emissive_displayed_from_radiance(radiance: f64, ev100: f64) -> f64 {
    radiance * exposure_from_ev100(ev100)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(value: f64, truth: f64, relative: f64) {
        assert!((value - truth).abs() <= relative * truth.abs(), "{value} for {truth}");
    }

    #[test]
    fn exposure_as_bevy_has_it() {
        // EV100 9.7 is Bevy's default; 0.0010019 was read off a running camera, 0.83333 at EV100 0.
        close(exposure_from_ev100(9.7), 0.001_001_9, 1e-4);
        close(exposure_from_ev100(0.0), 0.833_333_333_333_333_3, 1e-15);
        for ev in [-6.0, 0.0, 9.7, 15.0] {
            assert!((ev100_from_exposure(exposure_from_ev100(ev)) - ev).abs() < 1e-12);
        }
    }

    #[test]
    fn emissive_as_displayed() {
        close(emissive_radiance_as_displayed(0.4, 0.0), 0.48, 1e-15);
        close(emissive_radiance_as_displayed(1.0, 9.7), 998.1, 1e-4);
        close(emissive_displayed_from_radiance(emissive_radiance_as_displayed(3.0, 9.7), 9.7), 3.0, 1e-14);
    }

    #[test]
    fn a_rectangle_gives_back_its_lumens() {
        // Power of a one-sided Lambertian emitter: π L A.
        close(PI * rect_light_radiance(800.0, 0.5, 2.0) * 0.5 * 2.0, 800.0, 1e-14);
        close(rect_light_radiance(PI, 1.0, 1.0), 1.0, 1e-15);
    }
}

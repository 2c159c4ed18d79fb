//! How a picture's radiance becomes what a screen shows: exposure and a tone curve, both as Bevy has them.

use glam::{Mat3, Vec3};

/// How a picture is shown on a screen. Does not matter to formats that keep radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Exposure value at ISO 100: 1 is 1.2 · 2^EV100 cd/m² (Lagarde and de Rousiers 2014, Moving Frostbite to
    /// Physically Based Rendering, section 5.1.2), as in Bevy.
    pub ev100: f32,
    /// What becomes of values that no screen shows.
    pub tone: ToneCurve,
}

/// What becomes of exposed values that no screen shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// They are clipped; everything below 1 is as it was. Bevy's `Tonemapping::None`: for comparisons.
    Clip,
    /// Luminance l becomes l / (1 + l) (Reinhard et al. 2002, eq. 3). Bevy's `Tonemapping::ReinhardLuminance`.
    Reinhard,
    /// The fit by Stephen Hill (2016) of the film curve of the Academy Color Encoding System. Bevy's
    /// `Tonemapping::AcesFitted`.
    #[default]
    Aces,
}

impl ToneCurve {
    /// Exposed linear colour to linear colour on the screen, in [0, 1] after clipping.
    pub(super) fn apply(self, colour: Vec3) -> Vec3 {
        match self {
            Self::Clip => colour,
            Self::Reinhard => colour / (1.0 + colour.dot(LUMINANCE)),
            Self::Aces => aces(colour),
        }
    }
}

/// Rec. 709 weights of luminance.
const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

fn aces(colour: Vec3) -> Vec3 {
    // Rows: sRGB to the curve's own primaries, a little desaturated, and back.
    let to_curve =
        Mat3::from_cols_array_2d(&[[0.59719, 0.35458, 0.04823], [0.076, 0.90834, 0.01566], [0.0284, 0.13383, 0.83777]]);
    let from_curve = Mat3::from_cols_array_2d(&[
        [1.60475, -0.53108, -0.07367],
        [-0.10208, 1.10813, -0.00605],
        [-0.00327, -0.07276, 1.07602],
    ]);
    // So bright that the curve has long ended, and no square of it overflows.
    let value = to_curve.transpose() * colour.min(Vec3::splat(1e9));
    let curved =
        (value * (value + 0.024_578_6) - 0.000_090_537) / (value * (0.983_729 * value + 0.432_951) + 0.238_081);
    from_curve.transpose() * curved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_end_at_one_and_never_turn() {
        for tone in [ToneCurve::Clip, ToneCurve::Reinhard, ToneCurve::Aces] {
            let shown = |value: f32| tone.apply(Vec3::splat(value)).clamp(Vec3::ZERO, Vec3::ONE);
            let values: Vec<f32> = (-20..40).map(|step| 2.0_f32.powi(step)).collect();
            for pair in values.windows(2) {
                assert!(shown(pair[0]).cmple(shown(pair[1])).all(), "{tone:?} at {}", pair[0]);
            }
            assert!(shown(f32::MAX).min_element() > 0.98 && shown(0.0).max_element() < 1e-3, "{tone:?}");
        }
        assert!((ToneCurve::Reinhard.apply(Vec3::ONE) - 0.5).length() < 1e-6);
        // Middle grey and white of the fit, by its author's formula.
        assert!(
            (ToneCurve::Aces.apply(Vec3::splat(0.18)).y - 0.105_1).abs() < 2e-3,
            "{}",
            ToneCurve::Aces.apply(Vec3::splat(0.18))
        );
        assert!((ToneCurve::Aces.apply(Vec3::ONE).y - 0.6167).abs() < 5e-3, "{}", ToneCurve::Aces.apply(Vec3::ONE));
    }
}

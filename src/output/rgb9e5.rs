//! Three colours in 32 bits: 9-bit mantissas over a shared 5-bit exponent.
//!
//! The encoding is that of the OpenGL extension EXT_texture_shared_exponent (2004), which the Vulkan specification
//! takes over for E5B9G9R9, its rounding included. It expects values that were clamped before.

/// Bits of a mantissa.
const MANTISSA_BITS: i32 = 9;
/// Bias of the exponent.
const BIAS: i32 = 15;
/// Largest value: (2⁹ − 1)/2⁹ · 2^(31 − 15).
pub(super) const MAX: f32 = 65408.0;

/// The texel that is nearest to `colour`, whose channels must be in [0, [`MAX`]].
pub(super) fn encode(colour: [f32; 3]) -> u32 {
    // Twice the precision, so that adding one half cannot itself round up.
    let channels = colour.map(f64::from);
    let largest = colour.iter().fold(0.0_f32, |largest, &channel| largest.max(channel));
    let preliminary = floor_log2(largest).max(-BIAS - 1) + 1 + BIAS;
    let scale_for = |exponent: i32| 2.0_f64.powi(exponent - BIAS - MANTISSA_BITS);
    let quantise = |channel: f64, exponent: i32| (channel / scale_for(exponent) + 0.5).floor() as u32;
    // The largest mantissa may round up to 2⁹; then the next exponent takes it.
    let overflow = quantise(f64::from(largest), preliminary) >> MANTISSA_BITS;
    let exponent = preliminary + overflow as i32;
    let [red, green, blue] = channels.map(|channel| quantise(channel, exponent));
    (exponent as u32) << 27 | blue << 18 | green << 9 | red
}

/// ⌊log₂ value⌋ of a finite value ≥ 0; below the least normal number something below −[`BIAS`].
fn floor_log2(value: f32) -> i32 {
    (value.to_bits() >> 23) as i32 - 127
}

/// The colour that a texel stands for.
#[cfg(test)]
pub(super) fn decode(texel: u32) -> [f32; 3] {
    let scale = 2.0_f32.powi((texel >> 27) as i32 - BIAS - MANTISSA_BITS);
    [texel, texel >> 9, texel >> 18].map(|bits| (bits & 0x1ff) as f32 * scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texels worked out by hand from the specification's formulae.
    #[test]
    fn known_texels() {
        let texel = |exponent: u32, red: u32, green: u32, blue: u32| exponent << 27 | blue << 18 | green << 9 | red;
        let golden = [
            ([0.0, 0.0, 0.0], 0),
            ([1.0, 1.0, 1.0], texel(16, 256, 256, 256)),
            ([1.0, 0.5, 0.25], texel(16, 256, 128, 64)),
            ([0.5, 0.0, 0.0], texel(15, 256, 0, 0)),
            ([MAX, 0.0, MAX], texel(31, 511, 0, 511)),
            // 3 = 384 · 2⁻⁷; 1e-3 of that scale is 0.128, which rounds away.
            ([3.0, 0.001, 0.0], texel(17, 384, 0, 0)),
            // 511.75/512 rounds to 512/512, which needs the next exponent.
            ([0.999_511_7, 0.0, 0.0], texel(16, 256, 0, 0)),
            // Halves round up: 256.5 → 257.
            ([256.5 / 256.0, 0.0, 0.0], texel(16, 257, 0, 0)),
            // The least value, and half of it, and just below that half.
            ([2.0_f32.powi(-24), 0.0, 0.0], texel(0, 1, 0, 0)),
            ([2.0_f32.powi(-25), 0.0, 0.0], texel(0, 1, 0, 0)),
            ([2.0_f32.powi(-25).next_down(), 0.0, 0.0], 0),
            ([f32::MIN_POSITIVE / 2.0, 0.0, 0.0], 0),
        ];
        for (colour, expected) in golden {
            assert_eq!(encode(colour), expected, "{colour:?}");
        }
        assert_eq!(encode([1.0, 1.0, 1.0]), 0x8402_0100);
        assert_eq!(encode([MAX; 3]), u32::MAX);
    }

    #[test]
    fn every_texel_in_lowest_terms_is_a_fixed_point() {
        for exponent in 0..32_u32 {
            for mantissa in 0..512_u32 {
                let texel = exponent << 27 | 7 << 18 | 3 << 9 | mantissa;
                let colour = decode(texel);
                assert_eq!(decode(encode(colour)), colour);
                if exponent == 0 || mantissa >= 256 {
                    assert_eq!(encode(colour), texel);
                }
            }
        }
    }

    #[test]
    fn error_is_at_most_half_a_step_of_the_finest_exponent_that_fits() {
        let mut state = 7_u32;
        let mut random = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        for _ in 0..20_000 {
            let scale = 2.0_f32.powf(random() * 28.0 - 12.0);
            let colour = [random() * scale, random() * scale, random() * scale].map(|channel: f32| channel.min(MAX));
            let texel = encode(colour);
            let step = 2.0_f32.powi((texel >> 27) as i32 - BIAS - MANTISSA_BITS);
            for (channel, back) in colour.iter().zip(decode(texel)) {
                assert!((channel - back).abs() <= step * 0.5, "{colour:?} → {texel:x}");
            }
            let largest = colour[0].max(colour[1]).max(colour[2]);
            assert!(largest >= step * 255.5, "{colour:?} → {texel:x} wastes a bit");
        }
    }
}

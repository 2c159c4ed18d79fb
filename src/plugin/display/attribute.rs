//! Vertex attributes of any format as the numbers that a shader sees: what a format lacks is 0, and w is 1.

use bevy::math::Vec4;
use bevy::mesh::VertexAttributeValues as Values;

/// One vector per vertex; `None` for formats that a shader takes as integers or does not take as floats.
pub(crate) fn numbers(values: &Values) -> Option<Vec<Vec4>> {
    Some(match values {
        Values::Float32(v) => widen(v.iter().map(|&x| [x])),
        Values::Float32x2(v) => widen(v.iter().copied()),
        Values::Float32x3(v) => widen(v.iter().copied()),
        Values::Float32x4(v) => widen(v.iter().copied()),
        Values::Float16(v) => widen(v.iter().map(|x| [x.to_f32()])),
        Values::Float16x2(v) => widen(v.iter().map(|v| v.map(|x| x.to_f32()))),
        Values::Float16x4(v) => widen(v.iter().map(|v| v.map(|x| x.to_f32()))),
        Values::Float64(v) => widen(v.iter().map(|&x| [x as f32])),
        Values::Float64x2(v) => widen(v.iter().map(|v| v.map(|x| x as f32))),
        Values::Float64x3(v) => widen(v.iter().map(|v| v.map(|x| x as f32))),
        Values::Float64x4(v) => widen(v.iter().map(|v| v.map(|x| x as f32))),
        Values::Unorm8(v) => widen(v.iter().map(|&x| [unorm8(x)])),
        Values::Unorm8x2(v) => widen(v.iter().map(|v| v.map(unorm8))),
        Values::Unorm8x4(v) => widen(v.iter().map(|v| v.map(unorm8))),
        Values::Unorm8x4Bgra(v) => widen(v.iter().map(|&[b, g, r, a]| [r, g, b, a].map(unorm8))),
        Values::Unorm16(v) => widen(v.iter().map(|&x| [unorm16(x)])),
        Values::Unorm16x2(v) => widen(v.iter().map(|v| v.map(unorm16))),
        Values::Unorm16x4(v) => widen(v.iter().map(|v| v.map(unorm16))),
        Values::Snorm8(v) => widen(v.iter().map(|&x| [snorm8(x)])),
        Values::Snorm8x2(v) => widen(v.iter().map(|v| v.map(snorm8))),
        Values::Snorm8x4(v) => widen(v.iter().map(|v| v.map(snorm8))),
        Values::Snorm16(v) => widen(v.iter().map(|&x| [snorm16(x)])),
        Values::Snorm16x2(v) => widen(v.iter().map(|v| v.map(snorm16))),
        Values::Snorm16x4(v) => widen(v.iter().map(|v| v.map(snorm16))),
        Values::Unorm10_10_10_2(v) => widen(v.iter().map(|&x| unorm10(x))),
        _ => return None,
    })
}

fn widen<const N: usize>(values: impl Iterator<Item = [f32; N]>) -> Vec<Vec4> {
    let widened = values.map(|value| {
        let mut all = [0.0, 0.0, 0.0, 1.0];
        all[..N].copy_from_slice(&value);
        Vec4::from_array(all)
    });
    widened.collect()
}

fn unorm8(x: u8) -> f32 {
    f32::from(x) / 255.0
}

fn unorm16(x: u16) -> f32 {
    f32::from(x) / 65535.0
}

fn snorm8(x: i8) -> f32 {
    (f32::from(x) / 127.0).max(-1.0)
}

fn snorm16(x: i16) -> f32 {
    (f32::from(x) / 32767.0).max(-1.0)
}

fn unorm10(packed: u32) -> [f32; 4] {
    let ten = |shift: u32| (packed >> shift & 0x3ff) as f32 / 1023.0;
    [ten(0), ten(10), ten(20), (packed >> 30) as f32 / 3.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_number() {
        let one = |values: Values| numbers(&values).unwrap()[0];
        assert_eq!(one(Values::Unorm8x4(vec![[0, 51, 255, 102]])), Vec4::new(0.0, 0.2, 1.0, 0.4));
        assert_eq!(one(Values::Unorm8x4Bgra(vec![[0, 51, 255, 102]])), Vec4::new(1.0, 0.2, 0.0, 0.4));
        assert_eq!(one(Values::Unorm16x2(vec![[65535, 0]])), Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(one(Values::Snorm8x4(vec![[-128, 127, 0, 127]])), Vec4::new(-1.0, 1.0, 0.0, 1.0));
        assert_eq!(one(Values::Snorm16(vec![-32768])), Vec4::new(-1.0, 0.0, 0.0, 1.0));
        assert_eq!(one(Values::Float32x3(vec![[1.0, 2.0, 3.0]])), Vec4::new(1.0, 2.0, 3.0, 1.0));
        assert_eq!(one(Values::Float64x2(vec![[1.0, 2.0]])), Vec4::new(1.0, 2.0, 0.0, 1.0));
        let packed = 1023 | (3 << 30);
        assert_eq!(one(Values::Unorm10_10_10_2(vec![packed])), Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert!(numbers(&Values::Uint8x4(vec![[1; 4]])).is_none());
    }
}

//! Textures as the tracer looks them up: decoded to linear numbers, wrapped and filtered. Base level only: a bake's
//! own many samples are the filter.

use crate::math::Portable;
use crate::scene::{Filter, Texels, Texture, Wrap};
use glam::{Vec2, Vec4};
use std::sync::Arc;

/// A texture ready for lookups.
#[derive(Clone, Debug)]
pub(super) struct Decoded {
    size: [i32; 2],
    wrap: [Wrap; 2],
    filter: Filter,
    texels: Store,
}

/// Texels: eight-bit ones stay as they are, at a quarter of the memory, and are decoded by a table.
#[derive(Clone, Debug)]
enum Store {
    Bytes { texels: Arc<[[u8; 4]]>, colour: Box<[f32; 256]> },
    Floats(Arc<[[f32; 4]]>),
}

impl Decoded {
    /// Prepares a sound texture.
    pub(super) fn new(texture: &Texture) -> Self {
        let texels = match &texture.texels {
            Texels::Srgb8(texels) => Store::Bytes { texels: texels.clone(), colour: table(linear_from_srgb) },
            Texels::Linear8(texels) => Store::Bytes { texels: texels.clone(), colour: table(|value| value) },
            Texels::Float(texels) => Store::Floats(texels.clone()),
        };
        Self { size: [texture.width as i32, texture.height as i32], wrap: texture.wrap, filter: texture.filter, texels }
    }

    /// Memory that it holds [bytes].
    pub(super) fn memory_bytes(&self) -> u64 {
        match &self.texels {
            Store::Bytes { texels, .. } => size_of_val(&**texels) as u64,
            Store::Floats(texels) => size_of_val(&**texels) as u64,
        }
    }

    /// The value at a place; the unit square is the whole texture, v downwards.
    pub(super) fn at(&self, uv: Vec2) -> Vec4 {
        let place = |axis: usize| {
            // Large coordinates are brought near before they meet the size, so that f32 keeps their fraction.
            let coordinate = if uv[axis].is_finite() { uv[axis] } else { 0.0 };
            let near = match self.wrap[axis] {
                Wrap::Repeat => coordinate - coordinate.floor(),
                Wrap::Mirror => coordinate - 2.0 * (0.5 * coordinate).floor(),
                Wrap::Clamp => coordinate.clamp(-1.0, 2.0),
            };
            near * self.size[axis] as f32
        };
        let (x, y) = (place(0), place(1));
        if self.filter == Filter::Nearest {
            return self.texel(x.floor() as i32, y.floor() as i32);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (s, t) = (x - left, y - top);
        let (left, top) = (left as i32, top as i32);
        let upper = self.texel(left, top).lerp(self.texel(left + 1, top), s);
        let lower = self.texel(left, top + 1).lerp(self.texel(left + 1, top + 1), s);
        upper.lerp(lower, t)
    }

    fn texel(&self, x: i32, y: i32) -> Vec4 {
        let [x, y] = [(0, x), (1, y)].map(|(axis, index)| wrapped(index, self.size[axis], self.wrap[axis]));
        let index = (y * self.size[0] + x) as usize;
        match &self.texels {
            Store::Bytes { texels, colour } => {
                let [r, g, b, a] = texels[index];
                Vec4::new(colour[r as usize], colour[g as usize], colour[b as usize], f32::from(a) / 255.0)
            }
            Store::Floats(texels) => Vec4::from_array(texels[index]),
        }
    }
}

fn wrapped(index: i32, size: i32, wrap: Wrap) -> i32 {
    match wrap {
        Wrap::Repeat => index.rem_euclid(size),
        Wrap::Mirror => {
            let folded = index.rem_euclid(2 * size);
            folded.min(2 * size - 1 - folded)
        }
        Wrap::Clamp => index.clamp(0, size - 1),
    }
}

fn table(curve: impl Fn(f32) -> f32) -> Box<[f32; 256]> {
    Box::new(std::array::from_fn(|value| curve(value as f32 / 255.0)))
}

/// IEC 61966-2-1.
fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { Portable::powf((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texel (x, y) of a 4 × 2 texture holds (x, y, 0, 1).
    fn numbered(wrap: Wrap, filter: Filter) -> Decoded {
        let texels: Vec<[f32; 4]> = (0..8).map(|i| [(i % 4) as f32, (i / 4) as f32, 0.0, 1.0]).collect();
        Decoded::new(&Texture {
            name: "numbers".into(),
            width: 4,
            height: 2,
            texels: Texels::Float(texels.into()),
            wrap: [wrap; 2],
            filter,
        })
    }

    #[test]
    fn texel_centres_are_exact_and_between_them_it_is_linear() {
        let texture = numbered(Wrap::Clamp, Filter::Linear);
        for (x, y) in [(0, 0), (3, 0), (2, 1), (0, 1)] {
            let value = texture.at(Vec2::new((x as f32 + 0.5) / 4.0, (y as f32 + 0.5) / 2.0));
            assert_eq!(value, Vec4::new(x as f32, y as f32, 0.0, 1.0));
        }
        assert!((texture.at(Vec2::new(0.5, 0.5)) - Vec4::new(1.5, 0.5, 0.0, 1.0)).length() < 1e-6);
        assert_eq!(texture.at(Vec2::new(-7.0, 9.0)), Vec4::new(0.0, 1.0, 0.0, 1.0));
    }

    #[test]
    fn beyond_the_edge() {
        let near = |wrap, u: f32, x: f32| {
            let value = numbered(wrap, Filter::Nearest).at(Vec2::new(u, 0.25)).x;
            assert_eq!(value, x, "{wrap:?} at {u}");
        };
        // From −1 to 2, in the middle of each texel.
        let repeat = [0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0];
        let mirror = [3.0, 2.0, 1.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 2.0, 1.0, 0.0];
        let clamp = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0, 3.0];
        for (wrap, expected) in [(Wrap::Repeat, repeat), (Wrap::Mirror, mirror), (Wrap::Clamp, clamp)] {
            for (i, x) in expected.into_iter().enumerate() {
                near(wrap, -1.0 + (i as f32 + 0.5) / 4.0, x);
            }
        }
        // The seam of a repeated texture is filtered across.
        let seam = numbered(Wrap::Repeat, Filter::Linear).at(Vec2::new(1000.0, 0.25));
        assert!((seam.x - 1.5).abs() < 1e-3, "{seam}");
    }

    #[test]
    fn bytes_are_decoded() {
        let texture = |texels| {
            let (wrap, filter) = ([Wrap::Clamp; 2], Filter::Linear);
            Decoded::new(&Texture { name: "byte".into(), width: 1, height: 1, texels, wrap, filter })
        };
        let bytes: Arc<[[u8; 4]]> = Arc::from([[255, 128, 0, 128]]);
        let srgb = texture(Texels::Srgb8(bytes.clone())).at(Vec2::splat(0.3));
        assert!((srgb - Vec4::new(1.0, 0.215_86, 0.0, 0.501_96)).length() < 1e-4, "{srgb}");
        let linear = texture(Texels::Linear8(bytes)).at(Vec2::splat(f32::NAN));
        assert!((linear - Vec4::new(1.0, 0.501_96, 0.0, 0.501_96)).length() < 1e-4, "{linear}");
    }
}

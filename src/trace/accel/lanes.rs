//! Eight numbers at once: what the walk through the tree and the triangle test are written in, and the processors'
//! ways to do it. Every operation is IEEE 754's, lane by lane, so that all ways give the same bits; none is fused.
//!
//! AVX2 comes from the crate `pulp`, which keeps what is unsafe in it; it asks the processor once whether it is there.
//! On others the same functions run on arrays, of which a compiler makes what the target's baseline has (SSE2, NEON).

use std::array::from_fn;

/// How many numbers go together.
pub(super) const LANES: usize = 8;

/// A way to compute with eight numbers at once. A condition is a number whose bits are all ones or all zeros.
pub(super) trait Lanes: Copy {
    /// Eight numbers.
    type F: Copy;
    /// The same number eight times.
    fn splat(self, x: f32) -> Self::F;
    /// From memory.
    fn load(self, x: &[f32; LANES]) -> Self::F;
    /// To memory.
    fn store(self, x: Self::F) -> [f32; LANES];
    /// a + b.
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    /// a − b.
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    /// a · b.
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    /// a / b.
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    /// a where a < b, else b: b where either is no number.
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    /// a where a > b, else b: b where either is no number.
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    /// The bits that both have.
    fn and(self, a: Self::F, b: Self::F) -> Self::F;
    /// The bits that either has.
    fn or(self, a: Self::F, b: Self::F) -> Self::F;
    /// |a|.
    fn abs(self, a: Self::F) -> Self::F;
    /// Whether a = b.
    fn eq(self, a: Self::F, b: Self::F) -> Self::F;
    /// Whether a < b.
    fn lt(self, a: Self::F, b: Self::F) -> Self::F;
    /// Whether a ≤ b.
    fn le(self, a: Self::F, b: Self::F) -> Self::F;
    /// The sign bits, the first lane's lowest.
    fn signs(self, a: Self::F) -> u32;
}

/// On arrays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portable;

#[inline(always)]
fn each(a: [f32; LANES], b: [f32; LANES], f: impl Fn(f32, f32) -> f32) -> [f32; LANES] {
    from_fn(|lane| f(a[lane], b[lane]))
}

#[inline(always)]
fn condition(holds: bool) -> f32 {
    f32::from_bits(if holds { u32::MAX } else { 0 })
}

impl Lanes for Portable {
    type F = [f32; LANES];

    #[inline(always)]
    fn splat(self, x: f32) -> Self::F {
        [x; LANES]
    }

    #[inline(always)]
    fn load(self, x: &[f32; LANES]) -> Self::F {
        *x
    }

    #[inline(always)]
    fn store(self, x: Self::F) -> [f32; LANES] {
        x
    }

    #[inline(always)]
    fn add(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| a * b)
    }

    #[inline(always)]
    fn div(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| a / b)
    }

    #[inline(always)]
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn and(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| f32::from_bits(a.to_bits() & b.to_bits()))
    }

    #[inline(always)]
    fn or(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| f32::from_bits(a.to_bits() | b.to_bits()))
    }

    #[inline(always)]
    fn abs(self, a: Self::F) -> Self::F {
        from_fn(|lane| a[lane].abs())
    }

    #[inline(always)]
    fn eq(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| condition(a == b))
    }

    #[inline(always)]
    fn lt(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| condition(a < b))
    }

    #[inline(always)]
    fn le(self, a: Self::F, b: Self::F) -> Self::F {
        each(a, b, |a, b| condition(a <= b))
    }

    #[inline(always)]
    fn signs(self, a: Self::F) -> u32 {
        (0..LANES).fold(0, |bits, lane| bits | (a[lane].to_bits() >> 31) << lane)
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::{LANES, Lanes};
    use pulp::x86::V3;
    use std::arch::x86_64::{__m256, _CMP_EQ_OQ, _CMP_LE_OQ, _CMP_LT_OQ};

    impl Lanes for V3 {
        type F = __m256;

        #[inline(always)]
        fn splat(self, x: f32) -> __m256 {
            self.avx._mm256_set1_ps(x)
        }

        #[inline(always)]
        fn load(self, x: &[f32; LANES]) -> __m256 {
            pulp::cast(*x)
        }

        #[inline(always)]
        fn store(self, x: __m256) -> [f32; LANES] {
            pulp::cast(x)
        }

        #[inline(always)]
        fn add(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_add_ps(a, b)
        }

        #[inline(always)]
        fn sub(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_sub_ps(a, b)
        }

        #[inline(always)]
        fn mul(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_mul_ps(a, b)
        }

        #[inline(always)]
        fn div(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_div_ps(a, b)
        }

        #[inline(always)]
        fn min(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_min_ps(a, b)
        }

        #[inline(always)]
        fn max(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_max_ps(a, b)
        }

        #[inline(always)]
        fn and(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_and_ps(a, b)
        }

        #[inline(always)]
        fn or(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_or_ps(a, b)
        }

        #[inline(always)]
        fn abs(self, a: __m256) -> __m256 {
            self.avx._mm256_andnot_ps(self.avx._mm256_set1_ps(-0.0), a)
        }

        #[inline(always)]
        fn eq(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_cmp_ps::<_CMP_EQ_OQ>(a, b)
        }

        #[inline(always)]
        fn lt(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_cmp_ps::<_CMP_LT_OQ>(a, b)
        }

        #[inline(always)]
        fn le(self, a: __m256, b: __m256) -> __m256 {
            self.avx._mm256_cmp_ps::<_CMP_LE_OQ>(a, b)
        }

        #[inline(always)]
        fn signs(self, a: __m256) -> u32 {
            self.avx._mm256_movemask_ps(a) as u32
        }
    }
}

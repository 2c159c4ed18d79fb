//! Sines, powers and logarithms whose bits are the same on every machine.
//!
//! Sums, products, quotients and square roots are rounded in one way everywhere (IEEE 754). The functions here are
//! not: those of the standard library are the C library's, which differ from system to system and from version to
//! version, and the GNU library picks one of several by what the processor can do. Told to do without FMA, its 2.36
//! gives another last bit for one of 1400 sines in `f64` and for one of 2 000 000 exponentials in `f32`. A bake that
//! is to be the same on two machines must not call them. So all that shapes a result calls these, which are the `libm`
//! crate's translation of musl into Rust, compiled with the rest: within 1.3 units of the last place in `f32` (the
//! two-sided arc tangent; the others within 1). A bake takes as long with them: 0.99 of the time, the median of seven
//! pairs. Tests, and what only informs, may use the standard library's.
//!
//! One caller is left that is not ours: the tree of boxes takes log₂ and 2ⁿ for how coarse a box may be. A box holds
//! its triangles whichever way that is rounded.

use glam::Vec2;

/// What a number offers in the same bits everywhere. Written `Portable::sin(x)`, since `x.sin()` would be the standard
/// library's. Angles are radians.
pub trait Portable: Copy {
    /// Sine.
    fn sin(self) -> Self;
    /// Cosine.
    fn cos(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Tangent.
    fn tan(self) -> Self;
    /// The angle in [0, π] of which this is the cosine.
    fn acos(self) -> Self;
    /// The angle in (−π/2, π/2) of which this is the tangent.
    fn atan(self) -> Self;
    /// The angle in (−π, π] of the point whose ordinate this is and whose abscissa is `x`.
    fn atan2(self, x: Self) -> Self;
    /// The length of the hypotenuse of a right triangle, without overflow on the way.
    fn hypot(self, other: Self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// eˣ − 1, in full digits near 0.
    fn exp_m1(self) -> Self;
    /// 2ˣ.
    fn exp2(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// The natural logarithm of 1 + x, in full digits near 0.
    fn ln_1p(self) -> Self;
    /// The logarithm to the base 2.
    fn log2(self) -> Self;
    /// This to some power.
    fn powf(self, power: Self) -> Self;
}

/// The unit vector at an angle from the first axis towards the second [rad]: glam's `Vec2::from_angle`.
#[inline]
pub fn unit_at(angle: f32) -> Vec2 {
    let (sin, cos) = Portable::sin_cos(angle);
    Vec2::new(cos, sin)
}

macro_rules! portable {
    ($number:ty, $sincos:ident, {$($name:ident: $one:ident),*}, {$($name_of_two:ident: $two:ident),*}) => {
        impl Portable for $number {
            #[inline]
            fn sin_cos(self) -> ($number, $number) {
                libm::$sincos(self)
            }
            $(
                #[inline]
                fn $name(self) -> $number {
                    libm::$one(self)
                }
            )*
            $(
                #[inline]
                fn $name_of_two(self, other: $number) -> $number {
                    libm::$two(self, other)
                }
            )*
        }
    };
}

portable!(
    f32,
    sincosf,
    {
        sin: sinf, cos: cosf, tan: tanf, acos: acosf, atan: atanf, exp: expf, exp_m1: expm1f, exp2: exp2f, ln: logf,
        ln_1p: log1pf, log2: log2f
    },
    { atan2: atan2f, hypot: hypotf, powf: powf }
);

portable!(
    f64,
    sincos,
    {
        sin: sin, cos: cos, tan: tan, acos: acos, atan: atan, exp: exp, exp_m1: expm1, exp2: exp2, ln: log,
        ln_1p: log1p, log2: log2
    },
    { atan2: atan2, hypot: hypot, powf: pow }
);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::combine;
    use crate::math::testing::Random;

    type One = (&'static str, [f64; 2], fn(f64) -> f64, fn(f64) -> f64, fn(f32) -> f32);

    /// Each function with the range that it is asked for: the standard library's and this one's.
    const ONES: [One; 11] = [
        ("sin", [-7.0, 7.0], f64::sin, |x| Portable::sin(x), |x| Portable::sin(x)),
        ("cos", [-7.0, 7.0], f64::cos, |x| Portable::cos(x), |x| Portable::cos(x)),
        ("tan", [-1.5, 1.5], f64::tan, |x| Portable::tan(x), |x| Portable::tan(x)),
        ("acos", [-1.0, 1.0], f64::acos, |x| Portable::acos(x), |x| Portable::acos(x)),
        ("atan", [-50.0, 50.0], f64::atan, |x| Portable::atan(x), |x| Portable::atan(x)),
        ("exp", [-80.0, 80.0], f64::exp, |x| Portable::exp(x), |x| Portable::exp(x)),
        ("exp_m1", [-80.0, 1.0], f64::exp_m1, |x| Portable::exp_m1(x), |x| Portable::exp_m1(x)),
        ("exp2", [-100.0, 100.0], f64::exp2, |x| Portable::exp2(x), |x| Portable::exp2(x)),
        ("ln", [0.0, 1.0], f64::ln, |x| Portable::ln(x), |x| Portable::ln(x)),
        ("ln_1p", [-1.0, 1.0], f64::ln_1p, |x| Portable::ln_1p(x), |x| Portable::ln_1p(x)),
        ("log2", [0.0, 1e5], f64::log2, |x| Portable::log2(x), |x| Portable::log2(x)),
    ];

    type Two = (&'static str, [f64; 2], fn(f64, f64) -> f64, fn(f64, f64) -> f64, fn(f32, f32) -> f32);

    const TWOS: [Two; 3] = [
        ("atan2", [-3.0, 3.0], f64::atan2, |y, x| Portable::atan2(y, x), |y, x| Portable::atan2(y, x)),
        ("hypot", [-3.0, 3.0], f64::hypot, |x, y| Portable::hypot(x, y), |x, y| Portable::hypot(x, y)),
        ("powf", [0.0, 9.0], f64::powf, |x, p| Portable::powf(x, p), |x, p| Portable::powf(x, p)),
    ];

    /// The error of what an `f32` function says, in units of its last place.
    fn error(found: f32, truth: f64) -> f64 {
        let step = f64::from((truth as f32).abs().next_up()) - f64::from((truth as f32).abs());
        (f64::from(found) - truth).abs() / step
    }

    #[test]
    fn values_are_those_of_the_functions() {
        let mut random = Random::new(11);
        let mut draw = |[low, high]: [f64; 2]| f64::from((low + (high - low) * f64::from(random.unit())) as f32);
        let mut worst: Vec<(&str, f64)> = Vec::new();
        for (name, range, truth, double, single) in ONES {
            let errors = (0..20_000).map(|_| {
                let x = draw(range);
                assert!((double(x) - truth(x)).abs() <= 4e-16 * truth(x).abs(), "{name} of {x}");
                error(single(x as f32), truth(x))
            });
            worst.push((name, errors.fold(0.0, f64::max)));
        }
        for (name, range, truth, double, single) in TWOS {
            let errors = (0..20_000).map(|_| {
                let (x, y) = (draw(range), draw(range));
                assert!((double(x, y) - truth(x, y)).abs() <= 4e-16 * truth(x, y).abs(), "{name} of {x}, {y}");
                error(single(x as f32, y as f32), truth(x, y))
            });
            worst.push((name, errors.fold(0.0, f64::max)));
        }
        let bound = |name| if name == "atan2" { 1.3 } else { 1.0 };
        assert!(worst.iter().all(|(name, error)| *error < bound(*name)), "{worst:?}");
        // A function that is right to `f32` and no better would not be seen otherwise.
        assert!(worst.iter().all(|(_, error)| *error > 0.4), "{worst:?}");
        assert!(error((1.0 + 2e-7) * 0.3_f32.sin(), 0.3_f64.sin()) > 1.0);
    }

    #[test]
    fn both_at_once_are_each_alone() {
        let mut random = Random::new(12);
        for _ in 0..20_000 {
            let x = 14.0 * random.unit() - 7.0;
            assert_eq!(Portable::sin_cos(x), (Portable::sin(x), Portable::cos(x)));
            let x = f64::from(x) * 1.000_000_1;
            assert_eq!(Portable::sin_cos(x), (Portable::sin(x), Portable::cos(x)));
        }
    }

    /// The bits themselves, on whatever machine this runs.
    #[test]
    fn bits_are_held() {
        let mut random = Random::new(13);
        let mut hash = 0;
        for _ in 0..4096 {
            let (x, y) = (random.unit(), random.unit());
            for (_, range, _, double, single) in ONES {
                let x = range[0] + (range[1] - range[0]) * f64::from(x);
                hash = combine(hash, double(x).to_bits() ^ u64::from(single(x as f32).to_bits()));
            }
            for (_, _, _, double, single) in TWOS {
                hash = combine(hash, double(x.into(), y.into()).to_bits() ^ u64::from(single(x, y).to_bits()));
            }
        }
        assert_eq!(hash, 0xe194_7c46_117a_5a52, "{hash:#018x}");
    }
}

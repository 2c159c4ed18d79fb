//! How light is followed: the choices that change noise and, for a bounce cap, truth.

/// Which samples an estimate of light from sources is made of. All three have the same mean. Points and single
/// directions, which no ray can meet, are aimed at by all three.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Estimator {
    /// Light and surface samples together, weighted by multiple importance sampling (Veach and Guibas 1995).
    #[default]
    Mis,
    /// Points on the sources only.
    Light,
    /// Directions from the surface only.
    Bsdf,
}

/// How light is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Transport {
    /// Which samples make an estimate.
    pub estimator: Estimator,
    /// Bounces before a path is cut, which loses light: `Some(0)` is direct light only. `None` has no cap.
    pub max_bounces: Option<u32>,
    /// Changes every random number, and nothing else.
    pub seed: u64,
}

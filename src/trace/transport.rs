//! How light is followed: the choices that change noise and, for a bounce cap, truth.

use super::effects::ForcedEffects;

/// Which samples an estimate of light from sources is made of. All three have the same mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Estimator {
    /// Light and surface samples together, weighted by multiple importance sampling (Veach and Guibas 1995).
    #[default]
    Mis,
    /// Points on the sources only; and what mirrors and clear glass show, which has no other way.
    Light,
    /// Directions from the surface only; and points and single directions that shine, which no ray meets.
    Bsdf,
}

/// Whom the paths of a lightmap's texel serve. The mean is the same; a bake of shared paths has less noise for its time,
/// but for scenes whose noise is that of mirrors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sharing {
    /// A group of up to sixteen texels of one object, none beside another, that see where the light came from (Bekaert,
    /// Sbert and Halton 2002). What is matt about surfaces is shared; their gloss, what mirrors, metals and clear glass
    /// show, and all that is seen through something is each texel's own.
    #[default]
    Group,
    /// The texel alone: no two texels' errors have to do with each other.
    Alone,
}

/// How light is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transport {
    /// Which samples make an estimate.
    pub estimator: Estimator,
    /// Bounces before a path is cut, which loses light: `Some(0)` is direct light only. `None` has no cap.
    pub max_bounces: Option<u32>,
    /// Whom the paths of a lightmap's texel serve.
    pub sharing: Sharing,
    /// Changes every random number, and nothing else.
    pub seed: u64,
    /// The most that one path may bring [cd/m²]: takes out bright specks and, with them, light. `None` takes nothing.
    pub clamp: Option<f32>,
    /// Effects that are simulated, or not, whatever the scene calls for.
    pub effects: ForcedEffects,
}

//! Light transport compiled for what a scene calls for. A kernel is a set of groups of effects as a constant; what a
//! kernel lacks costs its rays nothing, not even a test. A scene is traced by the smallest kernel that has all that
//! its plan asks for.

use super::effects::{Effect, EffectSet};

/// Colours, glow and normals that change from place to place.
pub(super) const TEXTURED: u32 = 1;

/// Surfaces that scatter otherwise than Lambert's.
pub(super) const LAYERED: u32 = 2;

/// Surfaces that light passes straight.
pub(super) const PASSING: u32 = 4;

/// Sources at infinity other than a constant sky.
pub(super) const DISTANT: u32 = 8;

/// The groups and the effects that need them.
const GROUPS: [(u32, &[Effect]); 4] = [
    (TEXTURED, &[Effect::Textures, Effect::TexturedEmission, Effect::NormalMaps]),
    (
        LAYERED,
        &[
            Effect::NormalMaps,
            Effect::SpecularReflection,
            Effect::Clearcoat,
            Effect::Refraction,
            Effect::ClearPanes,
            Effect::DiffuseTransmission,
        ],
    ),
    (PASSING, &[Effect::ClearPanes, Effect::CutOuts, Effect::Transparency]),
    (DISTANT, &[Effect::DirectionalLights, Effect::EnvironmentMap]),
];

/// The smallest kernel that has all these effects.
pub(super) fn kernel_for(effects: EffectSet) -> u32 {
    let needs = |group: &&(u32, &[Effect])| group.1.iter().any(|&effect| effects.has(effect));
    GROUPS.iter().filter(needs).fold(0, |kernel, (group, _)| kernel | group)
}

/// Calls a function that is generic over the kernel with the kernel of a value.
macro_rules! with_kernel {
    ($kernel:expr, $K:ident => $call:expr) => {
        with_kernel!(@ $kernel, $K => $call; 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    };
    (@ $kernel:expr, $K:ident => $call:expr; $($value:literal)*) => {
        match $kernel {
            $($value => {
                const $K: u32 = $value;
                $call
            })*
            _ => unreachable!("a kernel is made of four groups"),
        }
    };
}
pub(super) use with_kernel;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kernel_has_what_is_asked_and_no_more() {
        let of = |effects: &[Effect]| kernel_for(effects.iter().copied().collect());
        assert_eq!(of(&[]), 0);
        assert_eq!(of(&[Effect::AreaLights, Effect::PointLights, Effect::ConstantSky, Effect::Interreflection]), 0);
        assert_eq!(of(&[Effect::Textures]), TEXTURED);
        assert_eq!(of(&[Effect::NormalMaps]), TEXTURED | LAYERED);
        assert_eq!(of(&[Effect::CutOuts, Effect::DirectionalLights]), PASSING | DISTANT);
        assert_eq!(of(&Effect::ALL), TEXTURED | LAYERED | PASSING | DISTANT);
        assert_eq!(with_kernel!(9, K => K), 9);
    }
}

//! The kinds of light transport that a scene may call for, each by its name, and sets of them.

/// A kind of light transport that a scene may call for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Effect {
    /// Light straight from glowing meshes and rectangular lights, with soft shadows.
    AreaLights,
    /// Light from point and spot lights, with soft shadows where they have a radius.
    PointLights,
    /// Light from suns, with soft shadows where they have a diameter.
    DirectionalLights,
    /// Light from a sky that is the same in every direction.
    ConstantSky,
    /// Light from a picture of the sky, found by its brightness.
    EnvironmentMap,
    /// Light that surfaces pass on to each other, without a last bounce.
    Interreflection,
    /// Colours of surfaces that change from place to place: textures and vertex colours.
    Textures,
    /// Glow that changes from place to place.
    TexturedEmission,
    /// Normals that change from place to place.
    NormalMaps,
    /// Reflection that prefers the mirror direction: gloss, metal, mirrors; caustics by them.
    SpecularReflection,
    /// A clear coat on top of other surfaces.
    Clearcoat,
    /// Light that is bent into bodies of glass and out of them; caustics by them.
    Refraction,
    /// Light straight through panes of no thickness, tinted.
    ClearPanes,
    /// Diffuse light that leaves on the other side, as of leaves and lampshades.
    DiffuseTransmission,
    /// Holes cut out by a mask.
    CutOuts,
    /// Surfaces that are there in part, or that only tint what passes.
    Transparency,
}

impl Effect {
    /// Every effect, in the order in which a plan lists them.
    pub const ALL: [Self; 16] = [
        Self::AreaLights,
        Self::PointLights,
        Self::DirectionalLights,
        Self::ConstantSky,
        Self::EnvironmentMap,
        Self::Interreflection,
        Self::Textures,
        Self::TexturedEmission,
        Self::NormalMaps,
        Self::SpecularReflection,
        Self::Clearcoat,
        Self::Refraction,
        Self::ClearPanes,
        Self::DiffuseTransmission,
        Self::CutOuts,
        Self::Transparency,
    ];

    /// Its name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::AreaLights => "area-lights",
            Self::PointLights => "point-lights",
            Self::DirectionalLights => "directional-lights",
            Self::ConstantSky => "constant-sky",
            Self::EnvironmentMap => "environment-map",
            Self::Interreflection => "interreflection",
            Self::Textures => "textures",
            Self::TexturedEmission => "textured-emission",
            Self::NormalMaps => "normal-maps",
            Self::SpecularReflection => "specular-reflection",
            Self::Clearcoat => "clearcoat",
            Self::Refraction => "refraction",
            Self::ClearPanes => "clear-panes",
            Self::DiffuseTransmission => "diffuse-transmission",
            Self::CutOuts => "cut-outs",
            Self::Transparency => "transparency",
        }
    }

    /// The effect of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|effect| effect.name() == name)
    }
}

impl std::fmt::Display for Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct EffectSet(u32);

impl EffectSet {
    /// No effect.
    pub const NONE: Self = Self(0);

    /// The set with an effect added.
    #[must_use]
    pub const fn with(self, effect: Effect) -> Self {
        Self(self.0 | 1 << effect as u32)
    }

    /// The set with an effect taken out.
    #[must_use]
    pub const fn without(self, effect: Effect) -> Self {
        Self(self.0 & !(1 << effect as u32))
    }

    /// Whether the effect is in it.
    pub const fn has(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u32 != 0
    }

    /// Whether any of the other set's effects is in it.
    pub const fn has_any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Its effects, in the order of [`Effect::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(move |&effect| self.has(effect))
    }
}

impl FromIterator<Effect> for EffectSet {
    fn from_iter<I: IntoIterator<Item = Effect>>(effects: I) -> Self {
        effects.into_iter().fold(Self::NONE, Self::with)
    }
}

/// What a person asks for beyond what the scene calls for. Where both name an effect, it is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ForcedEffects {
    /// On, whether the scene calls for them or not.
    pub on: EffectSet,
    /// Off, although the scene may call for them: the light is then not true.
    pub off: EffectSet,
}

impl ForcedEffects {
    /// What is simulated of what a scene calls for.
    pub fn apply(self, called: EffectSet) -> EffectSet {
        EffectSet((called.0 | self.on.0) & !self.off.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_lead_back() {
        for effect in Effect::ALL {
            assert_eq!(Effect::from_name(effect.name()), Some(effect));
        }
        assert_eq!(Effect::from_name("magic"), None);
    }

    #[test]
    fn sets_add_and_take_out() {
        let all: EffectSet = Effect::ALL.into_iter().collect();
        assert_eq!(all.iter().count(), Effect::ALL.len());
        let called = EffectSet::NONE.with(Effect::Textures).with(Effect::CutOuts);
        let forced =
            ForcedEffects { on: EffectSet::NONE.with(Effect::Refraction), off: EffectSet::NONE.with(Effect::CutOuts) };
        assert_eq!(forced.apply(called).iter().collect::<Vec<_>>(), [Effect::Textures, Effect::Refraction]);
        assert_eq!(called.without(Effect::Textures), EffectSet::NONE.with(Effect::CutOuts));
    }
}

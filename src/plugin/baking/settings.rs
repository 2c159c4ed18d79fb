//! How a Bevy scene is read: the questions to which its data alone has no answer.

use crate::math::Portable;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;

/// Exposure value at ISO 100 of a Bevy camera that nobody has touched.
const BEVY_EV100: f32 = 9.7;

/// In which unit `StandardMaterial::emissive` is taken.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum EmissiveUnit {
    /// What glows on the screen lights the room. Bevy adds `emissive` after the camera's exposure, so it stands
    /// for `1.2 · 2^ev100` times as many cd/m², as far as `emissive_exposure_weight` says.
    AsDisplayed {
        /// The camera's exposure value at ISO 100.
        ev100: f32,
    },
    /// As radiance [cd/m²], whatever the screen shows.
    Nits,
}

impl Default for EmissiveUnit {
    fn default() -> Self {
        Self::AsDisplayed { ev100: BEVY_EV100 }
    }
}

impl EmissiveUnit {
    /// What one unit of `emissive` is in cd/m², for a material with this `emissive_exposure_weight`.
    pub(crate) fn nits(self, exposure_weight: f32) -> f32 {
        match self {
            Self::Nits => 1.0,
            Self::AsDisplayed { ev100 } => {
                let inverse_exposure = 1.2 * Portable::exp2(ev100);
                inverse_exposure + (1.0 - inverse_exposure) * exposure_weight
            }
        }
    }
}

/// Whether `GlobalAmbientLight` goes into the lightmaps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum AmbientMode {
    /// Not baked. Bevy goes on adding it to everything; it starts at 80 cd/m² whether anyone wants it or not.
    #[default]
    Ignore,
    /// Baked as a sky that is the same in every direction, and then kept off lightmapped meshes.
    Bake,
}

/// Whether lights end at their range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub enum RangeWindow {
    /// As Bevy displays them: fading out towards their range.
    #[default]
    AsDisplayed,
    /// As light is: on and on.
    Ignore,
}

/// How a Bevy scene is read.
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Default, Debug, PartialEq, Clone)]
pub struct SceneSettings {
    /// In which unit emissive materials are taken.
    pub emissive: EmissiveUnit,
    /// Whether Bevy's global ambient light is baked.
    pub ambient: AmbientMode,
    /// Whether lights end at their range.
    pub range: RangeWindow,
    /// Radiance of a sky that is the same in every direction, linear Rec. 709 [cd/m²]. Black is no sky.
    pub sky_radiance: Vec3,
    /// A picture of the sky, on top of `sky_radiance` and instead of any that a camera has: equirectangular, its texels
    /// radiance [cd/m²], as Bevy loads it from an `.hdr` or `.exr` file; or a cube. Up is +Y, its middle +X, a quarter
    /// from its left edge -Z.
    pub environment: Option<Handle<Image>>,
    /// What takes part: meshes and lights on one of these render layers, which is layer 0 for all that have no
    /// `RenderLayers`. Within them every light shines on everything.
    pub layers: RenderLayers,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn emissive_as_displayed_undoes_the_exposure() {
        let unit = EmissiveUnit::default();
        // 1.2 · 2^9.7, by bc.
        assert!((unit.nits(0.0) - 998.09).abs() < 0.1, "{}", unit.nits(0.0));
        assert!((unit.nits(1.0) - 1.0).abs() < 1e-3);
        assert_eq!(EmissiveUnit::Nits.nits(0.0), 1.0);
    }
}

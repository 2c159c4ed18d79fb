//! What an overlay's colours mean, in words, for whoever shows it.

use super::KilnOverlay;
use super::colours::{Asked, Rgb, swatches};
use bevy::prelude::*;

/// One colour and what it means.
#[derive(Clone, Debug, PartialEq)]
pub struct Swatch {
    /// The colour.
    pub colour: Color,
    /// What it means.
    pub words: String,
}

/// What the overlay that is on shows. Empty where none is.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct KilnLegend {
    /// What is shown and in which measure, as a sentence; or why nothing is.
    pub sentence: String,
    /// Its colours, as they are before the camera maps tones.
    pub swatches: Vec<Swatch>,
}

impl KilnLegend {
    /// Only words.
    pub(super) fn note(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), swatches: Vec::new() }
    }

    /// That of an overlay.
    pub(super) fn of(overlay: KilnOverlay, asked: Asked) -> Self {
        let sentence = match overlay {
            KilnOverlay::None => String::new(),
            KilnOverlay::TexelDensity => {
                format!("Texels per metre, over those asked for ({}, or what an object has of its own)", asked.density)
            }
            KilnOverlay::Charts => "Charts, a colour for each".to_owned(),
            KilnOverlay::Error => {
                format!(
                    "95 % interval of each texel before repair, over that asked for (± {:.1} %)",
                    100.0 * asked.error
                )
            }
            KilnOverlay::Validity => "What each texel is".to_owned(),
            KilnOverlay::DirectOnly => "Direct light of what is baked, on white".to_owned(),
            KilnOverlay::IndirectOnly => "Light that has met more than one surface, on white".to_owned(),
        };
        Self { sentence, swatches: swatches(overlay) }
    }
}

pub(super) fn swatch([red, green, blue]: Rgb, words: &str) -> Swatch {
    Swatch { colour: Color::srgb_u8(red, green, blue), words: words.to_owned() }
}

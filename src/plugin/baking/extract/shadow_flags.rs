//! `NotShadowCaster`, `NotShadowReceiver` and `TransmittedShadowReceiver`: how Bevy draws shadows. Light has no such
//! thing: what blocks none cannot reflect any. So the first lets light through, and the others are named.

use super::{Extraction, ExtractionWarning, Thing};
use crate::scene::Alpha;
use bevy::light::{NotShadowCaster, NotShadowReceiver, TransmittedShadowReceiver};
use bevy::prelude::*;

/// The material with which a mesh takes part: the one that it has, or one like it that light passes.
pub(super) fn heed(world: &World, thing: &Thing, material: usize, out: &mut Extraction) -> usize {
    let mut name = |component, consequence| {
        let name = thing.name.clone();
        out.warnings.push(ExtractionWarning::ShadowFlag { name, component, consequence });
    };
    if world.get::<NotShadowReceiver>(thing.entity).is_some() {
        name("NotShadowReceiver", "baked light is in shadow there all the same");
    }
    if world.get::<TransmittedShadowReceiver>(thing.entity).is_some() {
        name("TransmittedShadowReceiver", "light is baked through it as its material says, without that component");
    }
    if world.get::<NotShadowCaster>(thing.entity).is_none() {
        return material;
    }
    name("NotShadowCaster", "it is baked as if light passed through it, so it reflects none; what glows still does");
    let mut passed = out.scene.materials[material].clone();
    // Of an opaque material alpha means nothing, and of what is added it is the share of the glow.
    if passed.alpha == Alpha::Opaque {
        passed.base_colour.w = 1.0;
        passed.base_colour_texture = None;
    }
    passed.alpha = Alpha::Add;
    out.scene.materials.push(passed);
    out.scene.materials.len() - 1
}

//! What takes no part because it is hidden, named by what hides it: a level may have a whole wing switched off.

use super::{Extraction, ExtractionWarning};
use crate::plugin::StableIds;
use bevy::prelude::*;
use std::collections::BTreeMap;

/// Names what hides the meshes and lights in [`Extraction::hidden`].
pub(super) fn name(world: &World, out: &mut Extraction) {
    let mut hiders: BTreeMap<Entity, usize> = BTreeMap::new();
    for entity in out.hidden.drain(..) {
        *hiders.entry(hider(world, entity)).or_default() += 1;
    }
    let ids = StableIds::new(world);
    let named = |(entity, count)| {
        let name = ids.of(entity).as_str().to_owned();
        ExtractionWarning::Hidden { name, count }
    };
    out.warnings.extend(hiders.into_iter().map(named));
}

/// The entity on or above a hidden one that hides it, as far up as all is hidden.
fn hider(world: &World, hidden: Entity) -> Entity {
    let is_hidden = |entity| world.get::<InheritedVisibility>(entity).is_some_and(|visibility| !visibility.get());
    let mut top = hidden;
    while let Some(above) = world.get::<ChildOf>(top).map(ChildOf::parent).filter(|&above| is_hidden(above)) {
        top = above;
    }
    top
}

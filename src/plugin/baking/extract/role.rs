//! What part a mesh takes in a bake, as the marks on it and above it say.

use crate::plugin::baking::markers::{LightBlocker, LightmapDensity, LightmapReceiver, NotBaked};
use crate::scene::LightmapRequest;
use bevy::prelude::*;

/// What a mark says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Gets a lightmap.
    Receiver,
    /// Blocks and reflects light.
    Blocker,
    /// Takes no part.
    Mover,
}

/// What all marks on and above a mesh come to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Marked {
    /// That of the nearest mark, if there is one.
    pub(super) role: Option<Role>,
    density: Option<f32>,
}

impl Marked {
    /// The lightmap of what gets one.
    pub(super) fn request(self) -> LightmapRequest {
        LightmapRequest { density: self.density }
    }
}

/// Looks from a mesh upwards.
pub(super) fn of(world: &World, mesh: Entity) -> Marked {
    let mut marked = Marked::default();
    let mut next = Some(mesh);
    while let Some(entity) = next {
        if marked.role.is_none() {
            let receiver = world.get::<LightmapReceiver>(entity);
            marked.density = marked.density.or(receiver.and_then(|receiver| receiver.density));
            marked.role = receiver
                .map(|_| Role::Receiver)
                .or(world.get::<LightBlocker>(entity).map(|_| Role::Blocker))
                .or(world.get::<NotBaked>(entity).map(|_| Role::Mover));
        }
        marked.density = marked.density.or(world.get::<LightmapDensity>(entity).map(|density| density.0));
        next = world.get::<ChildOf>(entity).map(ChildOf::parent);
    }
    marked
}

//! Which mesh an entity shows: its own, or the copy of it that a bake laid out anew. Entities with the same mesh and
//! the same layout share one copy, which goes when none of them shows it any more.

use super::relay::{CannotLayOut, laid_out};
use crate::artefact::MeshLayout;
use bevy::asset::AssetId;
use bevy::ecs::world::EntityRef;
use bevy::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// A layout that many entities share.
#[derive(Clone, Debug)]
pub(crate) struct SharedLayout {
    layout: Arc<MeshLayout>,
    /// What it is known by, so that the same layout of a second bake makes no second mesh.
    key: u64,
}

impl From<MeshLayout> for SharedLayout {
    fn from(layout: MeshLayout) -> Self {
        Self { key: layout.key(), layout: Arc::new(layout) }
    }
}

impl PartialEq for SharedLayout {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

/// What an entity wears instead of its own mesh.
#[derive(Component, Clone)]
pub(crate) struct LaidOut {
    own: Handle<Mesh>,
    /// Only a second bake asks for it.
    #[cfg(feature = "bake")]
    layout: SharedLayout,
    worn: Handle<Mesh>,
}

/// The copies that there are, by the mesh and the layout that they were made of.
#[derive(Resource, Default)]
pub(crate) struct LaidOutMeshes(HashMap<(AssetId<Mesh>, u64), AssetId<Mesh>>);

impl LaidOutMeshes {
    fn find_or_make(
        &mut self,
        meshes: &mut Assets<Mesh>,
        own: &Handle<Mesh>,
        layout: &SharedLayout,
    ) -> Result<Handle<Mesh>, CannotLayOut> {
        let key = (own.id(), layout.key);
        if let Some(copy) = self.0.get(&key).and_then(|&copy| meshes.get_strong_handle(copy)) {
            return Ok(copy);
        }
        let copy = laid_out(meshes.get(own).ok_or(CannotLayOut::Changed)?, &layout.layout)?;
        let copy = meshes.add(copy);
        self.0.retain(|_, &mut copy| meshes.contains(copy));
        self.0.insert(key, copy.id());
        Ok(copy)
    }
}

/// The mesh that an entity shows, or would if no bake had laid it out.
pub(crate) fn own_mesh(entity: EntityRef<'_>) -> Option<&Handle<Mesh>> {
    let mesh = &entity.get::<Mesh3d>()?.0;
    // A game may have given it another mesh since.
    let laid_out = entity.get::<LaidOut>().filter(|laid_out| laid_out.worn == *mesh);
    Some(laid_out.map_or(mesh, |laid_out| &laid_out.own))
}

/// The layout that an entity wears.
#[cfg(feature = "bake")]
pub(crate) fn worn_layout(entity: EntityRef<'_>) -> Option<&SharedLayout> {
    let mesh = entity.get::<Mesh3d>()?;
    entity.get::<LaidOut>().filter(|laid_out| laid_out.worn == mesh.0).map(|laid_out| &laid_out.layout)
}

/// A mesh with a layout, as its copy; made if no entity shows it yet. The mesh must be loaded.
pub(crate) fn lay_out(world: &mut World, own: Handle<Mesh>, layout: SharedLayout) -> Result<LaidOut, CannotLayOut> {
    world.init_resource::<LaidOutMeshes>();
    let worn = world.resource_scope(|world, mut copies: Mut<LaidOutMeshes>| {
        copies.find_or_make(&mut world.resource_mut::<Assets<Mesh>>(), &own, &layout)
    })?;
    Ok(LaidOut {
        own,
        #[cfg(feature = "bake")]
        layout,
        worn,
    })
}

/// Shows the copy of an entity's own mesh in its place.
pub(crate) fn put_on(entity: &mut EntityWorldMut, laid_out: LaidOut) {
    show(entity, &laid_out.worn);
    entity.insert(laid_out);
}

/// Shows an entity's own mesh again, if it wears another.
pub(crate) fn take_off(entity: &mut EntityWorldMut) {
    let Some(own) = own_mesh(EntityRef::from(&*entity)).cloned() else { return };
    show(entity, &own);
    entity.remove::<LaidOut>();
}

fn show(entity: &mut EntityWorldMut, mesh: &Handle<Mesh>) {
    if let Some(mut shown) = entity.get_mut::<Mesh3d>()
        && shown.0 != *mesh
    {
        shown.0 = mesh.clone();
    }
}

/// A mesh that was changed or loaded anew makes its old copies useless for whoever comes next.
pub(crate) fn forget_copies_of_changed(
    mut changes: MessageReader<AssetEvent<Mesh>>,
    copies: Option<ResMut<LaidOutMeshes>>,
) {
    let Some(mut copies) = copies else { return };
    for change in changes.read() {
        if let AssetEvent::Modified { id } = change {
            copies.0.retain(|(own, _), _| own != id);
        }
    }
}

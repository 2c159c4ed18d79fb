//! Materials of a game's own that show lightmaps as `StandardMaterial` does, and what the baker is to take them for.
//!
//! Bevy looks for what it must draw otherwise by the component that holds the material, and each kind of material has
//! another one; so a kind must be made known before a lightmap goes on it.

use bevy::ecs::world::EntityRef;
use bevy::pbr::Material;
use bevy::prelude::*;
#[cfg(feature = "bake")]
use std::sync::Arc;

/// Lets a bake know materials of the game's own.
pub trait BakedMaterialApp {
    /// Says what a bake is to take a material for. What has it then takes part like any other thing: it reflects, lets
    /// through and glows as that `StandardMaterial` would, and gets a lightmap.
    ///
    /// A lightmap shows where the shader adds it, as all do that end in Bevy's own, such as those of an
    /// `ExtendedMaterial` of the `StandardMaterial`; mark what has a shader that adds none as a `LightBlocker`. A
    /// shipped game says the same: there it lets lightmaps go on these materials.
    ///
    /// ```
    /// use bevy::pbr::{ExtendedMaterial, Material, MaterialExtension};
    /// use bevy::prelude::*;
    /// use bevy::render::render_resource::AsBindGroup;
    /// use bevy_kiln::prelude::*;
    ///
    /// /// Moss on top of a wall.
    /// #[derive(Asset, AsBindGroup, TypePath, Clone, Default)]
    /// struct Moss {}
    /// impl MaterialExtension for Moss {}
    ///
    /// /// A hologram, with a shader of its own from the ground up.
    /// #[derive(Asset, AsBindGroup, TypePath, Clone)]
    /// struct Hologram {
    ///     #[uniform(0)]
    ///     colour: LinearRgba,
    /// }
    /// impl Material for Hologram {}
    ///
    /// App::new()
    ///     .add_baked_material(|wall: &ExtendedMaterial<StandardMaterial, Moss>| wall.base.clone())
    ///     .add_baked_material(|hologram: &Hologram| StandardMaterial {
    ///         base_color: Color::BLACK,
    ///         emissive: hologram.colour,
    ///         ..default()
    ///     });
    /// ```
    fn add_baked_material<M: Material>(
        &mut self,
        describe: impl Fn(&M) -> StandardMaterial + Send + Sync + 'static,
    ) -> &mut Self;
}

impl BakedMaterialApp for App {
    fn add_baked_material<M: Material>(
        &mut self,
        describe: impl Fn(&M) -> StandardMaterial + Send + Sync + 'static,
    ) -> &mut Self {
        let kind = Kind {
            is_on: |entity| entity.contains::<MeshMaterial3d<M>>(),
            touch: touch::<M>,
            #[cfg(feature = "bake")]
            find: Arc::new(move |world, entity| find(world, entity, &describe)),
        };
        #[cfg(not(feature = "bake"))]
        drop(describe);
        self.world_mut().get_resource_or_init::<BakedMaterials>().0.push(kind);
        self
    }
}

/// The kinds that were made known, in that order; of two on one entity the first counts.
#[derive(Resource, Default)]
pub(super) struct BakedMaterials(Vec<Kind>);

/// One kind.
#[derive(Clone)]
struct Kind {
    is_on: fn(EntityRef<'_>) -> bool,
    touch: fn(&mut EntityWorldMut),
    #[cfg(feature = "bake")]
    find: Arc<Find>,
}

#[cfg(feature = "bake")]
type Find = dyn Fn(&World, Entity) -> Option<FoundMaterial> + Send + Sync;

/// A material of an entity as the baker is to take it.
#[cfg(feature = "bake")]
pub(crate) struct FoundMaterial {
    /// What it is known by.
    pub(crate) id: bevy::asset::UntypedAssetId,
    /// `None` while it is not loaded.
    pub(crate) material: Option<StandardMaterial>,
}

/// Whether an entity has a material with which a lightmap can be shown.
pub(super) fn shows_lightmaps(world: &World, entity: EntityRef<'_>) -> bool {
    let kinds = world.get_resource::<BakedMaterials>();
    entity.contains::<MeshMaterial3d<StandardMaterial>>()
        || kinds.is_some_and(|kinds| kinds.0.iter().any(|kind| (kind.is_on)(entity)))
}

/// Has Bevy look at an entity's materials again.
pub(super) fn touch_materials(entity: &mut EntityWorldMut) {
    touch::<StandardMaterial>(entity);
    let kinds = entity.world().get_resource::<BakedMaterials>();
    let touches: Vec<_> = kinds.map(|kinds| kinds.0.iter().map(|kind| kind.touch).collect()).unwrap_or_default();
    for touch in touches {
        touch(entity);
    }
}

/// A material of the game's own on an entity, if its kind is known.
#[cfg(feature = "bake")]
pub(crate) fn find_described(world: &World, entity: Entity) -> Option<FoundMaterial> {
    world.get_resource::<BakedMaterials>()?.0.iter().find_map(|kind| (kind.find)(world, entity))
}

#[cfg(feature = "bake")]
fn find<M: Material>(
    world: &World,
    entity: Entity,
    describe: &impl Fn(&M) -> StandardMaterial,
) -> Option<FoundMaterial> {
    let handle = &world.get::<MeshMaterial3d<M>>(entity)?.0;
    let material = world.get_resource::<Assets<M>>().and_then(|materials| materials.get(handle));
    Some(FoundMaterial { id: handle.id().untyped(), material: material.map(describe) })
}

fn touch<M: Material>(entity: &mut EntityWorldMut) {
    if let Some(mut material) = entity.get_mut::<MeshMaterial3d<M>>() {
        material.set_changed();
    }
}

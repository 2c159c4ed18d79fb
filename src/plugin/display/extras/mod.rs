//! What an artist has written on things in the modelling program: custom properties of Blender, which come as `extras`
//! in a glTF file. Here they are read where a scene has spawned, and the light mode is put on; what only a bake asks
//! for stays in [`KilnExtras`].
//!
//! Bevy's components of that kind are found by their names: whether a game reads glTF at all is up to the game.

mod keys;

#[cfg(feature = "bake")]
pub(crate) use keys::ExtrasFault;
pub(crate) use keys::KilnExtras;

use super::stable_id;
use bevy::ecs::component::ComponentId;
use bevy::ecs::query::QueryBuilder;
use bevy::ecs::reflect::{AppTypeRegistry, ReflectComponent};
use bevy::prelude::*;

/// Where a custom property was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Owner {
    /// On an object, a light or the whole scene.
    Thing,
    /// On what several objects may share.
    Mesh,
    /// The same.
    Material,
}

/// Bevy's components of extras (bevy_gltf 0.19, assets.rs); the nearer to the single thing the earlier.
const COMPONENTS: [(&str, Owner); 4] = [
    ("bevy_gltf::assets::GltfExtras", Owner::Thing),
    ("bevy_gltf::assets::GltfSceneExtras", Owner::Thing),
    ("bevy_gltf::assets::GltfMeshExtras", Owner::Mesh),
    ("bevy_gltf::assets::GltfMaterialExtras", Owner::Material),
];

/// One of them in a world that has it.
#[derive(Clone)]
struct Source {
    id: ComponentId,
    reflect: ReflectComponent,
    owner: Owner,
}

/// The query for what has not been read yet; made anew when a world gets another of the components.
#[derive(Default)]
pub(crate) struct Search {
    sources: Vec<Source>,
    unread: Option<QueryState<Entity, Without<KilnExtras>>>,
}

impl Search {
    fn unread(&mut self, world: &mut World) -> Vec<Entity> {
        if self.sources.len() < COMPONENTS.len() {
            let sources = sources(world);
            if sources.len() != self.sources.len() {
                let mut query = QueryBuilder::<Entity, Without<KilnExtras>>::new(world);
                query.or(|any| sources.iter().for_each(|source| _ = any.with_id(source.id)));
                self.unread = Some(query.build());
                self.sources = sources;
            }
        }
        self.unread.as_mut().map(|unread| unread.iter(world).collect()).unwrap_or_default()
    }
}

fn sources(world: &World) -> Vec<Source> {
    let Some(types) = world.get_resource::<AppTypeRegistry>() else { return Vec::new() };
    let types = types.read();
    let source = |&(path, owner): &(&str, Owner)| {
        let component = types.get_with_type_path(path)?;
        let (id, reflect) = (world.components().get_id(component.type_id())?, component.data::<ReflectComponent>()?);
        Some(Source { id, reflect: reflect.clone(), owner })
    };
    COMPONENTS.iter().filter_map(source).collect()
}

/// Reads the extras of what has spawned since the last frame.
pub(crate) fn read_extras(world: &mut World, mut search: Local<Search>) {
    for entity in search.unread(world) {
        let extras = read(world, entity, &search.sources);
        for fault in &extras.faults {
            warn!("\"{}\" {fault}", stable_id(world, entity));
        }
        let mut entity = world.entity_mut(entity);
        if let Some(mode) = extras.mode {
            // What the game itself has put there counts.
            entity.insert_if_new(mode);
        }
        entity.insert(extras);
    }
}

/// What is written on an entity. What one mesh or material says holds for all objects that show it, unless an object
/// says otherwise; that is the entity above, as Bevy gives each part of a mesh an entity of its own.
fn read(world: &World, entity: Entity, sources: &[Source]) -> KilnExtras {
    let written = |entity: Entity, owner: Owner| {
        let mut found = KilnExtras::default();
        for source in sources.iter().filter(|source| source.owner == owner) {
            let text = world.get_entity(entity).ok().and_then(|entity| text(&source.reflect, entity));
            found = found.or(text.map(|text| KilnExtras::parse(&text, owner)).unwrap_or_default());
        }
        found
    };
    let shared = written(entity, Owner::Mesh).or(written(entity, Owner::Material));
    let above = world.get::<ChildOf>(entity).map(|above| written(above.parent(), Owner::Thing));
    written(entity, Owner::Thing).or(shared.without(&above.unwrap_or_default()))
}

fn text(component: &ReflectComponent, entity: EntityRef) -> Option<String> {
    let value = component.reflect(entity)?.reflect_ref().as_struct().ok()?.field("value")?;
    value.try_downcast_ref::<String>().cloned()
}

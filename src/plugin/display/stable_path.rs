//! The name of an entity that stays the same from bake to bake: names from the scene's root down. A bake and the
//! game that shows it compute it here, so that they agree. It never looks at entity numbers.

use crate::artefact::StableId;
use bevy::ecs::world::EntityRef;
use bevy::prelude::*;
use bevy::world_serialization::{DynamicWorldRoot, WorldAssetRoot};

/// Stands for a name that is missing.
const UNNAMED: &str = "unnamed";

/// A name of your own for a thing and what is below it, where names from the file do not tell things apart: give
/// one to each copy of the same scene, and to meshes that you spawn without a `Name`.
#[derive(Component, Clone, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct KilnId(pub String);

/// The id of an entity: the nearest [`KilnId`] above or on it, or else the root of the scene file that it came
/// from, then the `Name`s down to it, with slashes between. Siblings of equal name are told apart by their order,
/// which for the primitives of one glTF mesh is their order in the file. What stands outside of all files starts
/// at the topmost ancestor.
///
/// Two entities may get the same id, as two copies of one file do; [`KilnId`] tells them apart.
pub fn stable_id(world: &World, entity: Entity) -> StableId {
    let mut parts = Vec::new();
    let mut next = Some(entity);
    while let Some(entity) = next {
        let Ok(entity) = world.get_entity(entity) else { break };
        if let Some(KilnId(own)) = entity.get::<KilnId>() {
            parts.push(own.clone());
            break;
        }
        let parent = entity.get::<ChildOf>().map(ChildOf::parent);
        let is_file_root = entity.contains::<WorldAssetRoot>() || entity.contains::<DynamicWorldRoot>();
        if is_file_root && !parts.is_empty() {
            break;
        }
        parts.push(label(world, &entity, parent));
        next = parent;
    }
    parts.reverse();
    StableId::new(parts.join("/"))
}

/// Whether every part of an id is a name that somebody gave.
pub(super) fn is_named(id: &StableId) -> bool {
    !id.as_str()
        .split('/')
        .any(|part| part.strip_prefix(UNNAMED).is_some_and(|rest| rest.is_empty() || rest.starts_with('[')))
}

/// The entity's name, numbered if siblings before it have the same one.
fn label(world: &World, entity: &EntityRef, parent: Option<Entity>) -> String {
    let name = entity.get::<Name>();
    let text = name.map_or(UNNAMED, Name::as_str);
    let siblings = parent.and_then(|parent| world.get::<Children>(parent));
    let twins_before = siblings.map_or(0, |siblings| {
        let before = siblings.iter().take_while(|&sibling| sibling != entity.id());
        before.filter(|&sibling| world.get::<Name>(sibling) == name).count()
    });
    if twins_before == 0 { text.to_owned() } else { format!("{text}[{twins_before}]") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_of_names_below_the_file_root() {
        let mut world = World::new();
        let root = world.spawn((Name::new("my level"), WorldAssetRoot::default())).id();
        let scene = world.spawn((Name::new("Scene"), ChildOf(root))).id();
        let twin_a = world.spawn((Name::new("wall"), ChildOf(scene))).id();
        let twin_b = world.spawn((Name::new("wall"), ChildOf(scene))).id();
        let nameless = world.spawn(ChildOf(twin_b)).id();
        let id = |entity| stable_id(&world, entity).as_str().to_owned();
        assert_eq!(id(root), "my level");
        assert_eq!(id(twin_a), "Scene/wall");
        assert_eq!(id(twin_b), "Scene/wall[1]");
        assert_eq!(id(nameless), "Scene/wall[1]/unnamed");
        let is_named = |entity| is_named(&stable_id(&world, entity));
        assert!(is_named(twin_b) && !is_named(nameless));
    }

    #[test]
    fn a_users_own_id_ends_the_path() {
        let mut world = World::new();
        let copy = world.spawn((KilnId("east".into()), WorldAssetRoot::default())).id();
        let wall = world.spawn((Name::new("wall"), ChildOf(copy))).id();
        let lamp = world.spawn((KilnId("lamp".into()), ChildOf(wall))).id();
        assert_eq!(stable_id(&world, wall).as_str(), "east/wall");
        assert_eq!(stable_id(&world, lamp).as_str(), "lamp");
    }

    #[test]
    fn what_is_outside_of_files_starts_at_the_top() {
        let mut world = World::new();
        let top = world.spawn(Name::new("room")).id();
        let floor = world.spawn((Name::new("floor"), ChildOf(top))).id();
        assert_eq!(stable_id(&world, floor).as_str(), "room/floor");
    }
}

//! The name of an entity that stays the same from bake to bake: names from the scene's root down. A bake and the
//! game that shows it compute it here, so that they agree. It never looks at entity numbers.

use crate::artefact::StableId;
use bevy::ecs::entity::EntityHashMap;
use bevy::ecs::world::EntityRef;
use bevy::prelude::*;
use bevy::world_serialization::{DynamicWorldRoot, WorldAssetRoot};
use std::cell::RefCell;
use std::collections::HashMap;

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
    StableIds::new(world).of(entity)
}

/// The same for many entities: siblings, of which a file may have thousands, are gone through once.
pub(crate) struct StableIds<'w> {
    world: &'w World,
    /// How many siblings of its name come before each entity of the families that were gone through.
    twins_before: RefCell<EntityHashMap<usize>>,
}

impl<'w> StableIds<'w> {
    pub(crate) fn new(world: &'w World) -> Self {
        Self { world, twins_before: RefCell::default() }
    }

    /// The id of an entity, see [`stable_id`].
    pub(crate) fn of(&self, entity: Entity) -> StableId {
        let mut parts = Vec::new();
        let mut next = Some(entity);
        while let Some(entity) = next {
            let Ok(entity) = self.world.get_entity(entity) else { break };
            if let Some(KilnId(own)) = entity.get::<KilnId>() {
                parts.push(own.clone());
                break;
            }
            let parent = entity.get::<ChildOf>().map(ChildOf::parent);
            let is_file_root = entity.contains::<WorldAssetRoot>() || entity.contains::<DynamicWorldRoot>();
            if is_file_root && !parts.is_empty() {
                break;
            }
            parts.push(self.label(&entity, parent));
            next = parent;
        }
        parts.reverse();
        StableId::new(parts.join("/"))
    }

    /// The entity's name, numbered if siblings before it have the same one.
    fn label(&self, entity: &EntityRef, parent: Option<Entity>) -> String {
        let text = entity.get::<Name>().map_or(UNNAMED, Name::as_str);
        match parent.map_or(0, |parent| self.twins_before(entity.id(), parent)) {
            0 => text.to_owned(),
            twins => format!("{text}[{twins}]"),
        }
    }

    fn twins_before(&self, entity: Entity, parent: Entity) -> usize {
        let mut known = self.twins_before.borrow_mut();
        if !known.contains_key(&entity) {
            let mut seen: HashMap<Option<&Name>, usize> = HashMap::new();
            for sibling in self.world.get::<Children>(parent).into_iter().flatten().copied() {
                let twins = seen.entry(self.world.get::<Name>(sibling)).or_default();
                known.insert(sibling, *twins);
                *twins += 1;
            }
        }
        known.get(&entity).copied().unwrap_or(0)
    }
}

/// Whether every part of an id is a name that somebody gave.
pub(super) fn is_named(id: &StableId) -> bool {
    !id.as_str()
        .split('/')
        .any(|part| part.strip_prefix(UNNAMED).is_some_and(|rest| rest.is_empty() || rest.starts_with('[')))
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
    fn families_that_are_gone_through_once_have_the_same_names() {
        let mut world = World::new();
        let root = world.spawn(WorldAssetRoot::default()).id();
        let names = ["a", "b", "a", "a", "b"];
        let children = names.map(|name| world.spawn((Name::new(name), ChildOf(root))).id());
        let below = children.map(|child| world.spawn(ChildOf(child)).id());
        let ids = StableIds::new(&world);
        for order in [[4, 0, 2, 1, 3], [0, 1, 2, 3, 4]] {
            let found = order.map(|index| ids.of(below[index]).as_str().to_owned());
            let expected = ["a", "b", "a[1]", "a[2]", "b[1]"].map(|name| format!("{name}/unnamed"));
            assert_eq!(found, order.map(|index| expected[index].clone()));
        }
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

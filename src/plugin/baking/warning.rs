//! What a person is told about a bake, with the entity that it is about, so that a tool can select it.
//!
//! Sentences name things by their stable ids in quotes, wherever in the baker they come from; here a name becomes the
//! entity that had it when the snapshot was taken.

use super::extract::Extraction;
use crate::plugin::StableIds;
use crate::plugin::display::KilnExtras;
use bevy::light::RectLight;
use bevy::prelude::*;
use std::collections::HashMap;
use std::fmt::Display;

/// One thing that was left out or changed.
#[derive(Clone, Debug, PartialEq, Eq, Reflect)]
#[reflect(Debug, PartialEq, Clone)]
pub struct KilnWarning {
    /// What happened and what to do, as a sentence.
    pub sentence: String,
    /// What it is about, where that is one mesh or light of the world.
    pub entity: Option<Entity>,
}

impl Display for KilnWarning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.sentence)
    }
}

/// The entities of a world by their stable ids.
pub(super) struct Names(HashMap<String, Entity>);

type Nameable =
    Or<(With<Mesh3d>, With<PointLight>, With<SpotLight>, With<DirectionalLight>, With<RectLight>, With<KilnExtras>)>;

impl Names {
    /// Those of everything that a snapshot may name, also of what it left out.
    pub(super) fn new(world: &mut World, extraction: &Extraction) -> Self {
        let mut query = world.query_filtered::<Entity, Nameable>();
        let ids = StableIds::new(world);
        let named = query.iter(world).map(|entity| (ids.of(entity).as_str().to_owned(), entity));
        let mut names: HashMap<String, Entity> = named.collect();
        // Of two with the same id, the one that takes part.
        names.extend(extraction.entities.iter().map(|(id, entity)| (id.as_str().to_owned(), *entity)));
        Self(names)
    }

    /// A sentence with the entity that it names.
    pub(super) fn warning(&self, sentence: impl Display) -> KilnWarning {
        let sentence = sentence.to_string();
        let entity = sentence.split('"').skip(1).step_by(2).find_map(|name| self.0.get(name)).copied();
        KilnWarning { sentence, entity }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_name_that_is_an_entity_is_meant() {
        let [first, second] = [1, 2].map(|index| Entity::from_raw_u32(index).unwrap());
        let names = Names([("a b".to_owned(), first), ("c".to_owned(), second)].into());
        for (sentence, entity) in [
            ("texture \"x\" of \"a b\" is not loaded", Some(first)),
            ("\"c\" shades \"a b\"", Some(second)),
            ("the ambient light is left out; c and a b are not meant", None),
            ("between\" c \"and", None),
            ("", None),
        ] {
            assert_eq!(names.warning(sentence), KilnWarning { sentence: sentence.to_owned(), entity });
        }
    }
}

//! A Bevy world as a [`Scene`]: the one way in, for the running game and for the command line. Reads, never
//! writes; what it cannot read becomes an [`ExtractionWarning`].
//!
//! Nothing depends on entity numbers: everything is ordered by its stable id, and equal ids by where they stand.

mod camera;
mod environment;
mod hidden;
mod light;
mod material;
mod mesh;
mod pose;
pub(super) mod reread;
mod role;
mod shadow_flags;
mod texture;
mod volume;
mod warning;

pub use reread::NotReread;
use role::Role;
pub use texture::Unreadable;
pub use warning::{ExtractionWarning, Unsimulated};

use super::events::BakeVolumes;
use super::markers::LightmapReceiver;
use super::settings::SceneSettings;
use crate::artefact::StableId;
use crate::bake::{BakeSettings, VolumeBox, VolumeBoxes, VolumeSettings};
use crate::plugin::StableIds;
use crate::plugin::display::{ExtrasFault, KilnExtras, fingerprint};
use crate::scene::{LightmapRequest, Scene, unique_ids};
use bevy::asset::{AssetPath, UntypedAssetId};
use bevy::camera::visibility::{RenderLayers, VisibilityRange};
use bevy::prelude::*;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A world as the baker sees it.
#[derive(Clone, Debug, Default)]
pub struct Extraction {
    /// The scene.
    pub scene: Scene,
    /// What was left out or taken for something simpler.
    pub warnings: Vec<ExtractionWarning>,
    /// Which entity each instance and each light is.
    pub entities: BTreeMap<StableId, Entity>,
    /// The boxes that are placed for irradiance volumes.
    pub volumes: Vec<VolumeBox>,
    /// Whether any mesh that is seen takes no part, as a thing that moves.
    pub has_movers: bool,
    /// Files of what is with the renderer only and may be read again.
    missed: Vec<AssetPath<'static>>,
    /// Meshes and lights that would take part if they were not hidden.
    hidden: Vec<Entity>,
    /// Names that several things have, by which a game does not know one of them again.
    twins: BTreeSet<String>,
    seen: Seen,
}

impl Extraction {
    /// What volumes are to be baked beside a lightmap, if any; with cells of this side [m] where none is placed.
    pub fn volume_settings(
        &self,
        lightmap: &BakeSettings,
        which: BakeVolumes,
        spacing: Option<f32>,
    ) -> Option<VolumeSettings> {
        let is_called_for = match which {
            BakeVolumes::WhereCalledFor => self.has_movers || !self.volumes.is_empty(),
            BakeVolumes::Always => true,
            BakeVolumes::Never => false,
        };
        let boxes = match self.volumes.as_slice() {
            [] => VolumeBoxes::Automatic { spacing },
            placed => VolumeBoxes::Given(placed.to_vec()),
        };
        is_called_for.then(|| VolumeSettings { boxes, ..VolumeSettings::beside(lightmap) })
    }
}

/// Where assets that were read already lie in the scene; `None` for one that could not be read.
#[derive(Clone, Debug, Default)]
struct Seen {
    meshes: HashMap<AssetId<Mesh>, Option<usize>>,
    textures: HashMap<AssetId<Image>, Option<usize>>,
    materials: HashMap<UntypedAssetId, usize>,
}

/// Reads the world as it stands; its transforms and visibility must have been propagated, as they are in `Last`.
pub fn extract_scene(world: &mut World, settings: &SceneSettings) -> Extraction {
    let mut out = Extraction::default();
    let lights = light::find(world, settings, &mut out);
    let meshes = find_meshes(world, settings, &mut out);
    volume::extract(world, settings, &mut out);
    hidden::name(world, &mut out);
    find_faulty_extras(world, &mut out.warnings);
    out.warnings.sort_by_cached_key(ToString::to_string);
    let things: Vec<Thing> = meshes.into_iter().chain(lights).collect();
    for thing in name_all(world, things, &mut out) {
        match thing.kind {
            Kind::Mesh(request) => mesh::extract(world, &thing, request, settings, &mut out),
            Kind::Light(kind) => light::extract(world, &thing, kind, settings, &mut out),
        }
        let known_again = fingerprint(world, thing.entity).filter(|_| !out.twins.contains(&thing.name));
        out.scene.fingerprints.extend(known_again.map(|fingerprint| (thing.id.clone(), fingerprint)));
        out.entities.insert(thing.id, thing.entity);
    }
    environment::extract(world, settings, &mut out);
    camera::extract(world, &mut out);
    out
}

/// Something that becomes a part of the scene.
struct Thing {
    id: StableId,
    /// What a person reads in a warning: the id before it was made unique.
    name: String,
    entity: Entity,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Mesh(Option<LightmapRequest>),
    Light(light::LightKind),
}

impl Kind {
    fn order(self) -> Option<light::LightKind> {
        match self {
            Self::Mesh(_) => None,
            Self::Light(kind) => Some(kind),
        }
    }
}

impl Thing {
    fn new(id: StableId, entity: Entity, kind: Kind) -> Self {
        Self { name: id.as_str().to_owned(), id, entity, kind }
    }
}

/// Orders things by id and makes the ids unique.
fn name_all(world: &World, mut things: Vec<Thing>, out: &mut Extraction) -> Vec<Thing> {
    things.sort_by_cached_key(|thing| {
        let place = world
            .get::<GlobalTransform>(thing.entity)
            .map_or([0; 16], |transform| transform.to_matrix().to_cols_array().map(f32::to_bits));
        (thing.id.clone(), thing.kind.order(), place, thing.entity)
    });
    for twins in things.chunk_by(|a, b| a.id == b.id).filter(|twins| twins.len() > 1) {
        let id = twins[0].name.clone();
        out.twins.insert(id.clone());
        out.warnings.push(ExtractionWarning::SameId { id, count: twins.len() });
    }
    let ids = unique_ids(things.iter().map(|thing| thing.id.clone()));
    for (thing, id) in things.iter_mut().zip(ids) {
        thing.id = id;
    }
    things
}

/// What was written on things in the modelling program and cannot be read.
fn find_faulty_extras(world: &mut World, warnings: &mut Vec<ExtractionWarning>) {
    let mut written = world.query::<(Entity, &KilnExtras)>();
    let ids = StableIds::new(world);
    for (entity, extras) in written.iter(world).filter(|(_, extras)| !extras.faults.is_empty()) {
        let name = ids.of(entity).as_str().to_owned();
        let faulty = |fault: &ExtrasFault| ExtractionWarning::Extras { name: name.clone(), fault: fault.to_string() };
        warnings.extend(extras.faults.iter().map(faulty));
    }
}

/// The meshes that take part, as their marks say.
fn find_meshes(world: &mut World, settings: &SceneSettings, out: &mut Extraction) -> Vec<Thing> {
    let only_marked = world.query_filtered::<(), With<LightmapReceiver>>().iter(world).next().is_some();
    let mut meshes = world.query_filtered::<Entity, With<Mesh3d>>();
    let meshes: Vec<Entity> = meshes.iter(world).collect();
    let (world, warnings) = (&*world, &mut out.warnings);
    let ids = StableIds::new(world);
    let mut things = Vec::new();
    for entity in meshes {
        let mark = role::of(world, entity);
        let mut request = match mark.role {
            Some(Role::Mover) => None,
            Some(Role::Blocker) => Some(None),
            Some(Role::Receiver) => Some(Some(mark.request())),
            None => (!only_marked).then(|| Some(mark.request())),
        };
        let is_visible = is_visible(world, entity);
        let Some(request) = &mut request else {
            out.has_movers |= is_visible;
            continue;
        };
        if !is_visible {
            out.hidden.push(entity);
            continue;
        }
        let id = ids.of(entity);
        let name = id.as_str().to_owned();
        if !is_on_layers(world, entity, settings) {
            warnings.push(ExtractionWarning::OtherLayers { name });
            continue;
        }
        if let Some(metres) = distant_lod(world, entity) {
            // Far off it has no lightmap to show.
            out.has_movers = true;
            warnings.push(ExtractionWarning::DistantLevelOfDetail { name, metres });
            continue;
        }
        if let Some(how) = pose::deformation(world, entity) {
            // A character that walks on must not leave its shadow behind.
            if mark.role.is_none() {
                out.has_movers = true;
                warnings.push(ExtractionWarning::Deformed { name, how });
                continue;
            }
            if request.take().is_some() {
                warnings.push(ExtractionWarning::Posed { name, how });
            }
        }
        things.push(Thing::new(id, entity, Kind::Mesh(*request)));
    }
    things
}

fn is_visible(world: &World, entity: Entity) -> bool {
    world.get::<InheritedVisibility>(entity).is_none_or(|visibility| visibility.get())
}

/// As for Bevy's cameras and lights: a thing without layers is on layer 0, and those above it have no say.
fn is_on_layers(world: &World, entity: Entity, settings: &SceneSettings) -> bool {
    let layers = world.get::<RenderLayers>(entity).cloned().unwrap_or_default();
    layers.intersects(&settings.layers)
}

/// From which distance on [m] a coarser level of detail is shown; `None` for what is seen from near.
fn distant_lod(world: &World, entity: Entity) -> Option<f32> {
    let range = world.get::<VisibilityRange>(entity)?;
    Some(range.start_margin.start).filter(|&metres| metres > 0.0)
}

//! Lights with Bevy's own radiometry (bevy_pbr 0.19, render/light.rs and pbr_lighting.wgsl).

mod directional;
mod punctual;
mod rect;

use super::{Extraction, ExtractionWarning, Kind, Thing, is_on_layers, is_visible};
use crate::plugin::baking::{RangeWindow, SceneSettings};
use crate::plugin::display::MutedLight;
use crate::plugin::{LightBaking, StableIds};
use bevy::light::{DirectionalLightTexture, PointLight, PointLightTexture, RectLight, SpotLight, SpotLightTexture};
use bevy::math::Affine3A;
use bevy::prelude::*;
use bevy::world_serialization::{DynamicWorldRoot, WorldAssetRoot};

/// Which of Bevy's lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LightKind {
    Rect,
    Point,
    Spot,
    Directional,
}

/// The range that Bevy's glTF loader gives to lights without one [m].
const LOADERS_RANGE: f32 = 20.0;

/// The lights that take part.
pub(super) fn find(world: &mut World, settings: &SceneSettings, out: &mut Extraction) -> Vec<Thing> {
    let mut lights = world.query::<(Entity, Has<RectLight>, Has<PointLight>, Has<SpotLight>, Has<DirectionalLight>)>();
    let mut found = Vec::new();
    for (entity, rect, point, spot, directional) in lights.iter(world) {
        let kinds = [
            (rect, LightKind::Rect),
            (point, LightKind::Point),
            (spot, LightKind::Spot),
            (directional, LightKind::Directional),
        ];
        found.extend(kinds.into_iter().filter(|(has, _)| *has).map(|(_, kind)| (entity, kind)));
    }
    let world = &*world;
    let is_asked_for = |entity| LightBaking::of(world, entity) != LightBaking::RealTime;
    let asked = found.into_iter().filter(|&(entity, _)| is_asked_for(entity));
    let (visible, hidden): (Vec<_>, Vec<_>) = asked.partition(|&(entity, _)| is_visible(world, entity));
    let is_taken = |&(entity, _): &(Entity, LightKind)| is_on_layers(world, entity, settings);
    let (taken, left): (Vec<_>, Vec<_>) = visible.into_iter().partition(is_taken);
    let ids = StableIds::new(world);
    let name = |(entity, _)| ids.of(entity).as_str().to_owned();
    out.warnings.extend(left.into_iter().map(|light| ExtractionWarning::OtherLayers { name: name(light) }));
    out.hidden.extend(hidden.into_iter().map(|(entity, _)| entity));
    taken.into_iter().map(|(entity, kind)| Thing::new(ids.of(entity), entity, Kind::Light(kind))).collect()
}

/// Adds one light.
pub(super) fn extract(world: &World, thing: &Thing, kind: LightKind, settings: &SceneSettings, out: &mut Extraction) {
    let reader = Reader { world, thing, settings };
    let light = match kind {
        LightKind::Rect => reader.rect(),
        LightKind::Point => reader.point(),
        LightKind::Spot => reader.spot(),
        LightKind::Directional => reader.directional(),
    };
    match LightBaking::of(world, thing.entity) {
        LightBaking::Baked => out.scene.off_in_real_time.insert(thing.id.clone()),
        LightBaking::MixedIndirect => out.scene.indirect_only.insert(thing.id.clone()),
        LightBaking::MixedDirect | LightBaking::RealTime => false,
    };
    out.scene.lights.extend(light);
    if let Some(component) = cookie(world, thing.entity, kind) {
        out.warnings.push(ExtractionWarning::LightPicture { name: thing.name.clone(), component });
    }
}

/// A light that is being read.
struct Reader<'a> {
    world: &'a World,
    thing: &'a Thing,
    settings: &'a SceneSettings,
}

impl Reader<'_> {
    /// What it was before a bake that is on show turned it down.
    fn muted(&self) -> Option<&MutedLight> {
        self.world.get::<MutedLight>(self.thing.entity)
    }

    fn affine(&self) -> Affine3A {
        self.world.get::<GlobalTransform>(self.thing.entity).copied().unwrap_or_default().affine()
    }

    /// Where it shines: along its local -Z.
    fn forward(&self) -> Vec3 {
        Vec3::from(-self.affine().matrix3.z_axis).normalize_or(Vec3::NEG_Z)
    }

    /// The range as asked for. The one that Bevy's glTF loader makes up where a file has none is no intention; one
    /// of exactly as much that is in the file cannot be told from it.
    fn range(&self, range: f32) -> Option<f32> {
        let made_up = range == LOADERS_RANGE && is_from_gltf(self.world, self.thing.entity);
        match self.settings.range {
            RangeWindow::AsDisplayed => Some(range).filter(|_| !made_up),
            RangeWindow::Ignore => None,
        }
    }
}

/// The component with which Bevy sends a light through a picture.
fn cookie(world: &World, light: Entity, kind: LightKind) -> Option<&'static str> {
    let (has, component) = match kind {
        LightKind::Rect => return None,
        LightKind::Point => (world.get::<PointLightTexture>(light).is_some(), "PointLightTexture"),
        LightKind::Spot => (world.get::<SpotLightTexture>(light).is_some(), "SpotLightTexture"),
        LightKind::Directional => (world.get::<DirectionalLightTexture>(light).is_some(), "DirectionalLightTexture"),
    };
    has.then_some(component)
}

/// Whether the nearest file that an entity is from is a glTF one.
fn is_from_gltf(world: &World, entity: Entity) -> bool {
    let mut next = Some(entity);
    while let Some(entity) = next {
        if let Some(root) = world.get::<WorldAssetRoot>(entity) {
            let path = root.0.path().map(|path| path.path().to_string_lossy().to_ascii_lowercase());
            return path.is_some_and(|path| path.ends_with(".glb") || path.ends_with(".gltf"));
        }
        if world.get::<DynamicWorldRoot>(entity).is_some() {
            return false;
        }
        next = world.get::<ChildOf>(entity).map(ChildOf::parent);
    }
    false
}

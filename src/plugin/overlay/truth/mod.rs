//! The frame beside the truth: what the game shows on the left, a path-traced picture of the same world from the same
//! camera on the right, with a divider that can be dragged.
//!
//! The picture gets better while it is looked at. It begins anew when the camera moves, and ends when a bake begins.

mod drag;
mod screen;
mod tracing;

use crate::bake::Picture;
use crate::plugin::baking::LastBake;
use crate::plugin::{BakeStatus, KilnSystems, KilnWork, NextBake, extract_scene};
use crate::scene::{Camera as Pinhole, Scene};
use crate::trace::Transport;
use bevy::math::Affine3A;
use bevy::prelude::*;
use std::sync::Arc;
use tracing::{News, Task, Tracing};

/// Asks for the picture beside the frame of the first active camera, of the world as it is at the end of the frame.
#[derive(Event, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct CompareWithTruth {
    /// Paths through each pixel in the end.
    pub samples: u32,
}

impl Default for CompareWithTruth {
    fn default() -> Self {
        Self { samples: 256 }
    }
}

/// Takes the picture away again and stops tracing it.
#[derive(Event, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Event, Default, Debug, PartialEq, Clone)]
pub struct StopComparing;

/// How far the picture is, and where it begins.
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[reflect(Resource, Default, Debug, PartialEq, Clone)]
pub struct KilnComparison {
    /// Share of the width that shows the game, in [0, 1]. May be set; the pointer drags it.
    pub divider: f32,
    /// Whether a comparison is on.
    pub is_on: bool,
    /// Whether a picture is on the screen.
    pub is_shown: bool,
    /// Paths that went through each pixel of it; 0 for the first look, a quarter of the size.
    pub paths: u32,
    /// As many as were asked for.
    pub asked: u32,
    /// Why there is no picture, as a sentence.
    pub failure: Option<String>,
}

impl Default for KilnComparison {
    fn default() -> Self {
        Self { divider: 0.5, is_on: false, is_shown: false, paths: 0, asked: 0, failure: None }
    }
}

impl KilnComparison {
    /// Whether the picture is as good as was asked for.
    pub fn is_done(&self) -> bool {
        self.is_on && self.paths > 0 && self.paths >= self.asked
    }
}

pub(super) fn plugin(app: &mut App) {
    screen::plugin(app);
    app.init_resource::<KilnComparison>()
        .init_resource::<Truth>()
        .register_type::<CompareWithTruth>()
        .register_type::<StopComparing>()
        .register_type::<KilnComparison>()
        .add_observer(ask)
        .add_observer(|_: On<StopComparing>, mut truth: ResMut<Truth>| truth.is_asked_to_stop = true)
        .add_systems(PreUpdate, follow.after(KilnSystems::Display))
        .add_systems(Update, drag::drag)
        .add_systems(Last, start.before(KilnSystems::Snapshot));
}

/// What is being compared.
#[derive(Resource, Default)]
struct Truth {
    asked: Option<CompareWithTruth>,
    is_asked_to_stop: bool,
    scene: Option<Arc<Scene>>,
    view: Option<View>,
    /// Whether nothing is traced from there yet.
    is_due: bool,
    tracing: Option<Tracing>,
    picture: Option<Box<Picture>>,
    quad: Option<Entity>,
}

/// From where a picture is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
struct View {
    camera: Entity,
    world_from_camera: Affine3A,
    vertical_fov: f32,
    size: UVec2,
}

fn ask(asked: On<CompareWithTruth>, mut truth: ResMut<Truth>) {
    (truth.asked, truth.is_asked_to_stop) = (Some(*asked.event()), false);
}

/// The view of the first active camera that has something to draw to.
fn view(world: &mut World) -> Result<View, &'static str> {
    let mut cameras = world.query_filtered::<(Entity, &Camera, &Projection, &GlobalTransform), With<Camera3d>>();
    let active = cameras.iter(world).filter_map(|(entity, camera, projection, place)| {
        let size = camera.physical_viewport_size().filter(|size| camera.is_active && size.min_element() > 0)?;
        Some((camera.order, entity, size, projection, place))
    });
    let first = active.min_by_key(|&(order, entity, ..)| (order, entity));
    let (_, camera, size, projection, place) = first.ok_or("there is no active Camera3d to compare with")?;
    let Projection::Perspective(projection) = projection else {
        return Err("the camera's projection is not a perspective; only such a picture can be traced");
    };
    let (_, rotation, translation) = place.to_scale_rotation_translation();
    let world_from_camera = Affine3A::from_rotation_translation(rotation, translation);
    Ok(View { camera, world_from_camera, vertical_fov: projection.fov, size })
}

/// Takes the world of a comparison that was asked for, and begins anew where the camera has moved; takes the picture out
/// of every snapshot.
fn start(world: &mut World) {
    let mut truth = world.remove_resource::<Truth>().unwrap_or_default();
    let is_snapshot = world.resource::<BakeStatus>().running().is_some_and(|running| running.is_waiting);
    if is_snapshot || truth.asked.is_some() {
        take_down(world, &mut truth);
    }
    if let Some(CompareWithTruth { samples }) = truth.asked.take() {
        super::take_off(world);
        let settings = LastBake::of(world).map(|last| last.settings().scene.clone());
        let settings = settings.unwrap_or_else(|| world.resource::<NextBake>().scene.clone());
        truth = Truth { scene: Some(Arc::new(extract_scene(world, &settings).scene)), ..Truth::default() };
        let mut comparison = world.resource_mut::<KilnComparison>();
        (comparison.is_on, comparison.paths, comparison.asked) = (true, 0, samples.max(1));
        comparison.failure = None;
    }
    if let Some(scene) = truth.scene.clone() {
        match view(world) {
            Err(reason) => fail(world, &mut truth, reason.to_owned()),
            Ok(seen) if truth.view != Some(seen) => {
                take_down(world, &mut truth);
                (truth.picture, truth.tracing, truth.view) = (None, None, Some(seen));
                truth.is_due = true;
            }
            // A camera that stands still is worth tracing for.
            Ok(seen) if std::mem::take(&mut truth.is_due) => match trace(world, scene, seen) {
                Ok(tracing) => truth.tracing = Some(tracing),
                Err(reason) => fail(world, &mut truth, reason),
            },
            Ok(_) => {}
        }
    }
    world.insert_resource(truth);
}

fn trace(world: &mut World, scene: Arc<Scene>, view: View) -> Result<Tracing, String> {
    let View { world_from_camera, vertical_fov, size, .. } = view;
    let settings = world.resource::<NextBake>().bake_settings();
    let mut comparison = world.resource_mut::<KilnComparison>();
    comparison.paths = 0;
    Tracing::start(Task {
        scene,
        camera: Pinhole { name: "the game's".to_owned(), world_from_camera, vertical_fov },
        size: size.to_array(),
        // What a bake leaves out for speed is a part of the truth.
        transport: Transport { max_bounces: None, clamp: None, ..settings.transport },
        samples: comparison.asked,
        threads: settings.threads,
    })
}

/// Shows what has come, and ends a comparison that is over.
fn follow(world: &mut World) {
    let mut truth = world.remove_resource::<Truth>().unwrap_or_default();
    let is_baking = world.resource::<BakeStatus>().running().is_some_and(|running| running.work == KilnWork::Bake);
    if is_baking || truth.is_asked_to_stop {
        take_down(world, &mut truth);
        truth = Truth { asked: truth.asked, ..Truth::default() };
        let mut comparison = world.resource_mut::<KilnComparison>();
        if comparison.is_on {
            (comparison.is_on, comparison.paths) = (false, 0);
        }
    }
    let all_news = truth.tracing.as_ref().map(Tracing::news).unwrap_or_default();
    for news in all_news {
        match news {
            News::Picture(picture, paths) => {
                take_down(world, &mut truth);
                truth.picture = Some(picture);
                world.resource_mut::<KilnComparison>().paths = paths;
            }
            News::Done => truth.tracing = None,
            News::Failed(reason) => fail(world, &mut truth, reason),
        }
    }
    let divider = world.resource::<KilnComparison>().divider.clamp(0.0, 1.0);
    match (&truth.picture, truth.view, truth.quad) {
        (Some(picture), Some(view), None) => {
            truth.quad = Some(screen::put_up(world, view.camera, picture, divider));
        }
        (_, _, Some(quad)) => screen::divide(world, quad, divider),
        _ => {}
    }
    let is_shown = truth.quad.is_some();
    if world.resource::<KilnComparison>().is_shown != is_shown {
        world.resource_mut::<KilnComparison>().is_shown = is_shown;
    }
    world.insert_resource(truth);
}

fn take_down(world: &mut World, truth: &mut Truth) {
    if let Some(quad) = truth.quad.take()
        && let Ok(quad) = world.get_entity_mut(quad)
    {
        quad.despawn();
    }
}

fn fail(world: &mut World, truth: &mut Truth, reason: String) {
    take_down(world, truth);
    *truth = Truth::default();
    let mut comparison = world.resource_mut::<KilnComparison>();
    (comparison.is_on, comparison.paths, comparison.failure) = (false, 0, Some(reason));
}

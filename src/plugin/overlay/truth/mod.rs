//! The frame beside the truth: what the game shows on the left, a path-traced picture of the same world from the same
//! camera on the right, with a divider that can be dragged.
//!
//! The picture gets better while it is looked at. It begins anew when the camera moves, and ends when a bake begins.

mod screen;
mod tracing;

use crate::bake::Picture;
use crate::plugin::baking::LastBake;
use crate::plugin::{BakeStatus, KilnSystems, KilnWork, NextBake, extract_scene};
use crate::scene::{Camera as Pinhole, Scene};
use crate::trace::Transport;
use bevy::math::Affine3A;
use bevy::prelude::*;
use bevy::window::PrimaryWindow;
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

/// Half the width of the strip in which the pointer takes hold of the divider [logical pixels].
const GRIP: f32 = 10.0;

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
        .add_systems(Update, drag)
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

/// The pointer takes hold of the divider and moves it.
fn drag(
    buttons: Option<Res<ButtonInput<MouseButton>>>,
    windows: Query<&Window, With<PrimaryWindow>>,
    cameras: Query<&Camera>,
    truth: Res<Truth>,
    mut comparison: ResMut<KilnComparison>,
    mut is_held: Local<bool>,
) {
    let camera = truth.quad.and(truth.view).and_then(|view| cameras.get(view.camera).ok());
    let (Some(buttons), Ok(window), Some(camera)) = (buttons, windows.single(), camera) else {
        *is_held = false;
        return;
    };
    let (Some(pointer), Some(place)) = (window.cursor_position(), camera.logical_viewport_rect()) else { return };
    if buttons.just_pressed(MouseButton::Left) {
        let divider = place.min.x + comparison.divider * place.width();
        *is_held = (pointer.x - divider).abs() <= GRIP && place.contains(pointer);
    }
    *is_held &= buttons.pressed(MouseButton::Left);
    if *is_held && place.width() > 0.0 {
        let divider = ((pointer.x - place.min.x) / place.width()).clamp(0.0, 1.0);
        if comparison.divider != divider {
            comparison.divider = divider;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::camera::{ComputedCameraValues, RenderTargetInfo};

    #[test]
    fn the_divider_follows_the_pointer_that_took_hold_of_it() {
        let mut world = World::new();
        // 200 x 100 logical pixels, with the divider in the middle.
        let target_info = Some(RenderTargetInfo { physical_size: UVec2::new(400, 200), scale_factor: 2.0 });
        let computed = ComputedCameraValues { target_info, ..default() };
        let camera = world.spawn(Camera { computed, ..default() }).id();
        let view =
            View { camera, world_from_camera: Affine3A::IDENTITY, vertical_fov: 1.0, size: UVec2::new(400, 200) };
        world.insert_resource(Truth { view: Some(view), quad: Some(camera), ..default() });
        world.init_resource::<KilnComparison>();
        world.init_resource::<ButtonInput<MouseButton>>();
        let window = world.spawn((Window::default(), PrimaryWindow)).id();
        let drag = world.register_system(drag);
        let point = |world: &mut World, x: f32, is_pressed: bool| {
            let place = Some(Vec2::new(x, 50.0));
            world.get_mut::<Window>(window).unwrap().set_cursor_position(place);
            let mut buttons = world.resource_mut::<ButtonInput<MouseButton>>();
            buttons.clear();
            if is_pressed {
                buttons.press(MouseButton::Left)
            } else {
                buttons.release(MouseButton::Left)
            }
            world.run_system(drag).unwrap();
            world.resource::<KilnComparison>().divider
        };
        assert_eq!(point(&mut world, 104.0, false), 0.5, "nothing is pressed");
        assert_eq!(point(&mut world, 50.0, true), 0.5, "pressed elsewhere");
        assert_eq!(point(&mut world, 100.0, true), 0.5, "pressed before it came here");
        assert_eq!(point(&mut world, 100.0, false), 0.5);
        assert_eq!(point(&mut world, 104.0, true), 0.52);
        assert_eq!(point(&mut world, 150.0, true), 0.75);
        assert_eq!(point(&mut world, 999.0, true), 1.0);
        assert_eq!(point(&mut world, 20.0, false), 1.0, "let go");
    }
}

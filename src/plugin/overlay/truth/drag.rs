//! The divider under the pointer, in the primary window.

use super::{KilnComparison, Truth};
use bevy::prelude::*;
use bevy::window::PrimaryWindow;

/// Half the width of the strip in which the pointer takes hold of the divider [logical pixels].
const GRIP: f32 = 10.0;

/// The pointer takes hold of the divider and moves it.
pub(super) fn drag(
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
    use super::super::View;
    use super::*;
    use bevy::camera::{ComputedCameraValues, RenderTargetInfo};
    use bevy::math::Affine3A;

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

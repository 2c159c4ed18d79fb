//! Lightmaps that come, change and go on entities that are being drawn: the pixels say what is really shown. One
//! app for all cases, since starting a renderer is slow.

use crate::renderer::{Screen, app, bake, show, spawn_camera};
use bevy::ecs::system::RunSystemOnce;
use bevy::prelude::*;
use bevy_kiln::prelude::*;

/// Rows of 32 pixels of 8 bytes need no padding.
const WIDTH: u32 = 32;
const HEIGHT: u32 = 8;

const LEFT: Vec3 = Vec3::new(0.5, 0.5, 0.5);
const RIGHT: Vec3 = Vec3::new(0.8, 0.4, 0.2);

/// Under a sky of one radiance L a floor that sees nothing else gets E = π·L, so its texels are L to the last bit of
/// their format and its pixels L · albedo · exposure.
#[test]
fn lightmaps_come_change_and_go_on_what_is_drawn() {
    let Some(mut app) = app() else { return };
    app.world_mut().run_system_once(spawn).unwrap();
    // 0.8 m high and 3.2 m wide on the floor.
    let above = Transform::from_xyz(0.0, 3.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    spawn_camera(app.world_mut(), [WIDTH, HEIGHT], 2.0 * (0.4f32 / 3.0).atan(), above);
    show(&mut app);
    check(&app, "before the first bake", Vec3::ZERO);

    let first = Vec3::new(1.0, 0.5, 0.25);
    bake_sky(&mut app, first, 4.0);
    check(&app, "baked", first);

    let second = Vec3::new(0.25, 0.75, 1.0);
    bake_sky(&mut app, second, 4.0);
    check(&app, "baked anew, in the same texture", second);

    let third = Vec3::new(0.125, 0.25, 0.75);
    bake_sky(&mut app, third, 7.0);
    check(&app, "baked anew, in a texture of another size", third);

    app.world_mut().trigger(ClearLightmaps);
    show(&mut app);
    check(&app, "cleared", Vec3::ZERO);

    bake_sky(&mut app, first, 7.0);
    check(&app, "baked after all was cleared", first);
}

/// Two squares of floor side by side.
fn spawn(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let mesh = Mesh::from(Plane3d::default().mesh().size(2.0, 2.0));
    let uv = mesh.attribute(Mesh::ATTRIBUTE_UV_0).unwrap().clone();
    let mesh = meshes.add(mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, uv));
    for (name, x, albedo) in [("left", -1.0, LEFT), ("right", 1.0, RIGHT)] {
        let base_color = Color::linear_rgb(albedo.x, albedo.y, albedo.z);
        let material = materials.add(StandardMaterial { base_color, reflectance: 0.0, ..default() });
        let place = Transform::from_xyz(x, 0.0, 0.0);
        commands.spawn((Name::new(name), Mesh3d(mesh.clone()), MeshMaterial3d(material), place));
    }
}

fn bake_sky(app: &mut App, sky_radiance: Vec3, density: f32) {
    let scene = SceneSettings { sky_radiance, ..default() };
    let format = LightmapFormat::Rgba16f;
    bake(app, BakeLightmaps { scene, goal: BakeGoal::Samples(16), density, format, ..default() });
}

fn check(app: &App, when: &str, texel: Vec3) {
    let screen = &app.world().resource::<Screen>().0;
    assert_eq!(screen.len(), (WIDTH * HEIGHT) as usize, "{when}: nothing was read back");
    for (side, x, albedo) in [("left", WIDTH / 4, LEFT), ("right", 3 * WIDTH / 4, RIGHT)] {
        let seen = screen[(HEIGHT / 2 * WIDTH + x) as usize];
        // 1/1.2 is the exposure at EV100 0.
        let expected = texel * albedo / 1.2;
        // Half floats twice, in the lightmap and in the target.
        let error = (seen - expected).abs();
        assert!(error.cmple(expected * 2e-3).all(), "{when}, {side}: {seen} for {expected}");
    }
}

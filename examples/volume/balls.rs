//! Balls that are carried around the room. They have no lightmap: they are what moves.

use crate::common::args::Args;
use bevy::light::IrradianceVolume;
use bevy::prelude::*;
use bevy_kiln::prelude::*;
use std::f32::consts::TAU;

const COUNT: u8 = 7;

/// The way around the room: an ellipse [m], in so many seconds.
const HALF_WIDTH: Vec3 = Vec3::new(2.1, 0.35, 1.1);
const HEIGHT: f32 = 1.45;
const PERIOD: f32 = 24.0;

/// Where on the way a ball is, in turns ahead of the first.
#[derive(Component)]
struct Carried(f32);

pub fn plugin(app: &mut App) {
    app.add_systems(Startup, spawn).add_systems(Update, (carry, switch));
}

fn spawn(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let ball = meshes.add(Sphere::new(0.17).mesh().uv(64, 32));
    for number in 0..COUNT {
        let ahead = f32::from(number) / f32::from(COUNT);
        let look = StandardMaterial { base_color: Color::hsl(360.0 * ahead, 0.25, 0.75), ..default() };
        commands.spawn((
            Name::new(format!("ball {number}")),
            Mesh3d(ball.clone()),
            MeshMaterial3d(materials.add(look)),
            Transform::default(),
            Carried(ahead),
        ));
    }
}

/// For a picture they stand still.
fn carry(time: Res<Time>, args: Res<Args>, mut balls: Query<(&mut Transform, &Carried)>) {
    let now = if args.screenshot.is_some() { 0.0 } else { time.elapsed_secs() / PERIOD };
    for (mut place, Carried(ahead)) in &mut balls {
        let turn = TAU * (now + ahead);
        let around = Vec3::new(turn.cos(), (3.0 * turn).sin(), turn.sin());
        place.translation = HALF_WIDTH * around + Vec3::Y * HEIGHT;
    }
}

fn switch(keys: Res<ButtonInput<KeyCode>>, mut volumes: Query<&mut IrradianceVolume, With<BakedVolume>>) {
    if keys.just_pressed(KeyCode::KeyV) {
        for mut volume in &mut volumes {
            volume.intensity = 1.0 - volume.intensity;
        }
    }
}

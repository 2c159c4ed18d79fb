//! What metal and glass mirror: a reflection probe of Bevy's around the rooms, three colours painted by hand. It is none
//! of the kiln's, which bakes light for what is matt; on lightmapped surfaces it adds gloss and nothing else.

use bevy::camera::visibility::RenderLayers;
use bevy::light::{EnvironmentMapLight, LightProbe};
use bevy::prelude::*;

/// Around both rooms [m].
const CENTRE: Vec3 = Vec3::new(1.6, 1.8, 0.0);
const SIZE: Vec3 = Vec3::new(13.0, 4.2, 7.0);

/// What white mirrors [cd/m²].
const BRIGHTNESS: f32 = 450.0;

pub fn plugin(app: &mut App) {
    app.add_systems(Startup, |mut commands: Commands, mut images: ResMut<Assets<Image>>| {
        let [ceiling, walls, floor] = [[0.95, 0.93, 0.9], [0.62, 0.47, 0.42], [0.3, 0.2, 0.13]];
        let [ceiling, walls, floor] = [ceiling, walls, floor].map(Color::srgb_from_array);
        let painted = EnvironmentMapLight::hemispherical_gradient(&mut images, ceiling, walls, floor);
        commands.spawn((
            Name::new("reflections"),
            LightProbe::default(),
            RenderLayers::from_layers(&[0, 1]),
            EnvironmentMapLight { intensity: BRIGHTNESS, affects_lightmapped_mesh_diffuse: false, ..painted },
            Transform::from_translation(CENTRE).with_scale(SIZE),
        ));
    });
}

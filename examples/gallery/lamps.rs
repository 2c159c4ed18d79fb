//! The gallery's two rectangular lights. They are not in its file, since glTF has no words for them.

use bevy::camera::visibility::RenderLayers;
use bevy::light::RectLight;
use bevy::prelude::*;

/// Where they hang [m].
const PLACES: [Vec3; 2] = [Vec3::new(-1.5, 3.48, 0.0), Vec3::new(2.0, 3.48, 0.0)];

/// Width and depth of each [m].
const SIZE: Vec2 = Vec2::new(1.75, 0.38);

/// What each sends out [lm].
const POWER: f32 = 7500.0;

const COLOUR: Color = Color::srgb(1.0, 0.95, 0.88);

pub fn plugin(app: &mut App) {
    app.add_systems(Startup, show).add_observer(hang);
}

/// The lights. The world's axes are theirs.
pub fn lights() -> impl Iterator<Item = impl Bundle> {
    PLACES.into_iter().enumerate().map(|(number, place)| {
        let light = RectLight { color: COLOUR, intensity: POWER, width: SIZE.x, height: SIZE.y, range: 20.0 };
        (Name::new(format!("ceiling light {number}")), light, facing(place, Dir3::NEG_Y))
    })
}

/// Below the scene's root, where a baked folder looks for what it knows. Below the first only: a copy on a render layer
/// of its own would share them (see `slider`).
fn hang(root: On<Add, WorldAssetRoot>, roots: Query<(), With<WorldAssetRoot>>, mut commands: Commands) {
    if roots.iter().count() > 1 {
        return;
    }
    for light in lights() {
        commands.spawn((light, ChildOf(root.entity)));
    }
}

fn show(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    // Bevy draws no light itself. Without a mark these panes take no part in the bake, which has the lights.
    let pane = meshes.add(Rectangle::from_size(SIZE));
    let glow = materials.add(StandardMaterial { base_color: Color::srgb(1.0, 0.96, 0.9), unlit: true, ..default() });
    for (number, place) in PLACES.into_iter().enumerate() {
        commands.spawn((
            Name::new(format!("pane of ceiling light {number}")),
            Mesh3d(pane.clone()),
            MeshMaterial3d(glow.clone()),
            // A rectangle looks along +Z, a light shines along -Z.
            facing(place, Dir3::Y),
            RenderLayers::from_layers(&[0, 1]),
        ));
    }
}

fn facing(place: Vec3, direction: Dir3) -> Transform {
    Transform::from_translation(place).looking_to(direction, Dir3::Z)
}

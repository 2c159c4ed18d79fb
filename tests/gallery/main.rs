//! The gallery of the examples, baked without a window: what the volume shows of its light, and what is baked again when
//! a lamp moves.

#[path = "../volumes/accuracy.rs"]
mod accuracy;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../examples/gallery/lamps.rs"]
#[allow(dead_code, reason = "the lights without what is seen of them")]
mod lamps;
mod moved_lamp;
mod volume;

use bevy::prelude::*;
use bevy_kiln::plugin::extract_scene;
use bevy_kiln::plugin::windowless::open_scene;
use bevy_kiln::prelude::*;
use bevy_kiln::scene::Scene;
use std::path::Path;

/// Radiance of the sky, as the example has it [cd/m²].
const SKY: Vec3 = Vec3::new(3000.0, 3800.0, 5000.0);

/// As the example opens it.
fn open() -> App {
    let mut app = open_scene(&Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/gallery.glb")).unwrap();
    for light in lamps::lights() {
        app.world_mut().spawn(light);
    }
    app.update();
    app
}

fn extract(app: &mut App) -> Scene {
    let settings = SceneSettings { sky_radiance: SKY, ..SceneSettings::default() };
    let extraction = extract_scene(app.world_mut(), &settings);
    assert_eq!(extraction.scene.lights.len(), 4, "a sun, a lamp and two at the ceiling");
    extraction.scene
}

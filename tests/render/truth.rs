//! The frame beside the truth, on the Cornell box: both sides of the divider agree, go the same way to the screen, and
//! one of them goes again.

use crate::compare::compare;
use crate::mask::walls;
use crate::overlay::{keep, with_overlays};
use crate::picture::Shown;
use crate::renderer::{Screen, app_with, bake, show, spawn_camera};
use bevy::camera::{Exposure, Hdr};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::world_serialization::WorldAssetRoot;
use bevy_kiln::plugin::{CompareWithTruth, KilnComparison, StopComparing, extract_scene};
use bevy_kiln::prelude::*;
use std::path::Path;

/// Rows of 8 bytes per pixel are whole multiples of 256 bytes.
const SIZE: [u32; 2] = [192, 192];

/// Frames in which a scene of a few kilobytes must load, and in which a small picture must be traced.
const PATIENCE: usize = 200_000;

/// The box, seen by the file's camera; its entity.
fn spawn(app: &mut App) -> Entity {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/cornell_box.glb");
    let scene = app.world().resource::<AssetServer>().load(GltfAssetLabel::Scene(0).from_asset(file));
    app.world_mut().spawn((WorldAssetRoot(scene), LightmapReceiver::default()));
    for _ in 0..PATIENCE {
        app.update();
        let world = app.world_mut();
        let mut cameras = world.query_filtered::<(Entity, &Projection, &GlobalTransform), With<Camera3d>>();
        if let Some((camera, Projection::Perspective(projection), place)) = cameras.iter(world).next() {
            let (fov, place) = (projection.fov, place.compute_transform());
            world.despawn(camera);
            return spawn_camera(world, SIZE, fov, place);
        }
    }
    panic!("the box does not load");
}

fn picture(app: &App) -> Shown {
    let linear = app.world().resource::<Screen>().0.iter().map(|pixel| pixel.as_dvec3()).collect();
    Shown { width: SIZE[0] as usize, height: SIZE[1] as usize, linear }
}

/// Whether columns of two pictures are the same to within a share of their value.
fn agree(a: &Shown, b: &Shown, columns: std::ops::Range<usize>, share: f64) -> bool {
    let pixels = a.linear.iter().zip(&b.linear).enumerate().filter(|(at, _)| columns.contains(&(at % a.width)));
    pixels.map(|(_, (a, b))| (*a - *b).abs().max_element() / b.max_element().max(1e-3)).all(|apart| apart <= share)
}

fn trace(app: &mut App) {
    app.world_mut().trigger(CompareWithTruth { samples: 64 });
    for _ in 0..PATIENCE {
        app.update();
        let comparison = app.world().resource::<KilnComparison>();
        assert_eq!(comparison.failure, None);
        if comparison.is_done() {
            return show(app);
        }
    }
    panic!("the picture is not traced");
}

#[test]
fn both_sides_of_the_divider_agree() {
    let Some(mut app) = app_with(with_overlays) else { return };
    let camera = spawn(&mut app);
    show(&mut app);
    let settings = SceneSettings { emissive: EmissiveUnit::AsDisplayed { ev100: 0.0 }, ..default() };
    let scene = extract_scene(app.world_mut(), &settings).scene;
    let walls = walls(&scene, &scene.cameras[0], SIZE.map(|side| side as usize));
    let asked = BakeLightmaps { scene: settings, goal: BakeGoal::Samples(64), ..default() };
    bake(&mut app, asked.clone());
    let game = picture(&app);

    trace(&mut app);
    let both = picture(&app);
    keep(&app, SIZE, "truth_both.png");
    let (middle, end) = (SIZE[0] as usize / 2, SIZE[0] as usize);
    assert!(agree(&both, &game, 0..middle, 0.0), "the left side is not the game's");
    assert!(!agree(&both, &game, middle + 2..end, 0.0), "there is nothing on the right side");

    app.world_mut().resource_mut::<KilnComparison>().divider = 0.0;
    show(&mut app);
    let truth = picture(&app);
    keep(&app, SIZE, "truth_alone.png");
    assert!(agree(&both, &truth, middle + 2..end, 0.0), "the divider moves the picture");
    let difference = compare(&game, &truth, &walls);
    println!("{difference:#?}");
    difference.verdict().unwrap();
    assert!(compare(&game, &truth.map(|_, value| value * 1.05), &walls).verdict().is_err());

    app.world_mut().entity_mut(camera).insert(Exposure { ev100: 1.0 });
    show(&mut app);
    let darker = truth.map(|_, value| value * 0.5);
    assert!(agree(&picture(&app), &darker, 0..end, 2e-3), "the picture is not exposed as the frame is");
    app.world_mut().entity_mut(camera).insert(Exposure { ev100: 0.0 });

    // Without Hdr the tones are mapped where things are drawn, to eight bits.
    app.world_mut().entity_mut(camera).remove::<Hdr>().insert(Tonemapping::Reinhard);
    show(&mut app);
    let mapped = truth.map(|_, value| value / (value + 1.0));
    let apart =
        picture(&app).linear.iter().zip(&mapped.linear).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max);
    assert!(apart < 0.006, "{apart} from what the camera's tone mapping makes of it");
    app.world_mut().entity_mut(camera).insert((Hdr, Tonemapping::None));

    app.world_mut().trigger(StopComparing);
    show(&mut app);
    assert!(agree(&picture(&app), &game, 0..end, 0.0), "the picture does not go");

    app.world_mut().trigger(CompareWithTruth { samples: 1 << 20 });
    show(&mut app);
    assert!(app.world().resource::<KilnComparison>().is_on);
    let again = bake(&mut app, asked);
    assert_eq!(again.warnings, [], "the picture was taken for a thing of the world");
    assert!(!app.world().resource::<KilnComparison>().is_on, "a bake ends it");
    assert!(agree(&picture(&app), &game, 0..end, 0.0));
}

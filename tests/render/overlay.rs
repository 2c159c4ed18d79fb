//! Overlays of what was baked, by their pixels: colours at known places, light apart, and all given back.

use crate::picture::Shown;
use crate::renderer::{Screen, app_with, bake, show, spawn_camera};
use bevy::color::ColorToComponents;
use bevy::light::RectLight;
use bevy::prelude::*;
use bevy_kiln::plugin::{KilnLegend, KilnOverlay, KilnOverlays};
use bevy_kiln::prelude::*;
use std::path::Path;

/// Rows of 8 bytes per pixel are whole multiples of 256 bytes.
const SIZE: [u32; 2] = [128, 96];

/// Column and row on the screen of a place on the floor, of where the box stands on it, and of one on the ceiling.
const FLOOR: [usize; 2] = [40, 73];
const UNDER_BOX: [usize; 2] = [87, 71];
const CEILING: [usize; 2] = [50, 23];

const ALBEDO: f32 = 0.5;

/// Frames in which direct light of a small scene must be baked.
const PATIENCE: usize = 20_000;

/// Writes what the screen shows where a person can look at it.
pub fn keep(app: &App, [width, height]: [u32; 2], name: &str) {
    let linear = app.world().resource::<Screen>().0.iter().map(|pixel| pixel.as_dvec3()).collect();
    let shown = Shown { width: width as usize, height: height as usize, linear };
    shown.save(&Path::new(env!("CARGO_TARGET_TMPDIR")).join(name));
}

pub fn with_overlays(app: &mut App) {
    app.add_plugins(KilnOverlays);
}

/// A floor with a box on it under a lamp, and a ceiling above the lamp, which shines down only.
fn spawn(world: &mut World) -> Entity {
    let square = Mesh::from(Plane3d::default().mesh().size(2.0, 2.0));
    let square = world.resource_mut::<Assets<Mesh>>().add(square);
    let cube = world.resource_mut::<Assets<Mesh>>().add(Mesh::from(Cuboid::from_length(0.5)));
    let base_color = Color::linear_rgb(ALBEDO, ALBEDO, ALBEDO);
    let material = StandardMaterial { base_color, reflectance: 0.0, ..default() };
    let material = MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(material));
    world.spawn((Name::new("floor"), Mesh3d(square.clone()), material.clone()));
    let over = Transform::from_xyz(0.0, 1.2, 0.0).with_rotation(Quat::from_rotation_x(std::f32::consts::PI));
    world.spawn((Name::new("ceiling"), Mesh3d(square), material.clone(), over));
    // A little sunk, so that the floor below is inside of it.
    let cube = world.spawn((Name::new("box"), Mesh3d(cube), material, Transform::from_xyz(0.6, 0.2, 0.0))).id();
    let down = Transform::from_xyz(0.0, 1.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::X);
    world.spawn((Name::new("lamp"), RectLight { intensity: 10.0, width: 0.5, height: 0.5, ..default() }, down));
    spawn_camera(world, SIZE, 0.8, Transform::from_xyz(0.0, 0.6, 3.0));
    cube
}

fn pixel(app: &App, [x, y]: [usize; 2]) -> Vec3 {
    app.world().resource::<Screen>().0[y * SIZE[0] as usize + x]
}

fn overlay(app: &mut App, overlay: KilnOverlay) {
    app.world_mut().trigger(overlay);
    show(app);
    keep(app, SIZE, &format!("overlay_{overlay:?}.png"));
}

/// The colour that the legend gives to these words.
fn colour(app: &App, words: &str) -> Vec3 {
    let legend = app.world().resource::<KilnLegend>();
    let swatch = legend.swatches.iter().find(|swatch| swatch.words == words);
    let colour = swatch.unwrap_or_else(|| panic!("no \"{words}\" in {legend:?}")).colour.to_linear();
    Vec3::new(colour.red, colour.green, colour.blue)
}

fn is_near(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() < 4e-3
}

#[test]
fn overlays_show_what_is_known_of_texels_and_go_again() {
    let Some(mut app) = app_with(with_overlays) else { return };
    let cube = spawn(app.world_mut());
    app.world_mut().trigger(KilnOverlay::Charts);
    show(&mut app);
    assert_eq!(app.world().resource::<KilnLegend>().sentence, "Nothing is baked yet");
    overlay(&mut app, KilnOverlay::None);
    let asked = BakeLightmaps { goal: BakeGoal::Error(0.1), format: LightmapFormat::Rgba16f, ..default() };
    bake(&mut app, asked.clone());
    // What stands on the floor is out of the way from here on.
    app.world_mut().entity_mut(cube).insert(Visibility::Hidden);
    show(&mut app);
    let without = app.world().resource::<Screen>().0.clone();
    keep(&app, SIZE, "overlay_None.png");

    overlay(&mut app, KilnOverlay::TexelDensity);
    let green = colour(&app, "as asked");
    // Every second texel is darker.
    let dim = Color::linear_rgb(green.x, green.y, green.z).to_srgba().to_vec3() * 0.7;
    let dim = Color::srgb(dim.x, dim.y, dim.z).to_linear().to_vec3();
    let (mut bright, mut dark) = (0, 0);
    for (x, y) in (34..60).flat_map(|x| (67..80).map(move |y| (x, y))) {
        let seen = pixel(&app, [x, y]);
        let is_bright = is_near(seen, green);
        assert!(is_bright || is_near(seen, dim), "{seen} at {x}, {y} for {green}");
        *if is_bright { &mut bright } else { &mut dark } += 1;
    }
    assert!(bright > 50 && dark > 50, "{bright} bright and {dark} dark pixels");

    overlay(&mut app, KilnOverlay::Charts);
    assert!(!is_near(pixel(&app, FLOOR), pixel(&app, CEILING)));
    assert_eq!(pixel(&app, FLOOR), pixel(&app, [FLOOR[0] + 9, FLOOR[1] - 3]), "one chart has one colour");

    overlay(&mut app, KilnOverlay::Error);
    let [floor, ceiling] = [pixel(&app, FLOOR), pixel(&app, CEILING)];
    // Held to what was asked, texels are no worse: of the colours up to "as asked" none has much red.
    for seen in [floor, ceiling] {
        assert!(seen != Vec3::ZERO && seen.x < 0.06, "{seen}");
    }

    overlay(&mut app, KilnOverlay::Validity);
    assert!(is_near(pixel(&app, FLOOR), colour(&app, "measured")));
    let hidden = colour(&app, "inside of bodies, filled in");
    assert!(is_near(pixel(&app, UNDER_BOX), hidden), "{} for {hidden}", pixel(&app, UNDER_BOX));

    app.world_mut().entity_mut(cube).insert(Visibility::Inherited);
    show(&mut app);
    app.world_mut().trigger(KilnOverlay::DirectOnly);
    wait_for_direct_light(&mut app);
    app.world_mut().entity_mut(cube).insert(Visibility::Hidden);
    overlay(&mut app, KilnOverlay::DirectOnly);
    let direct = [FLOOR, CEILING].map(|place| pixel(&app, place));
    overlay(&mut app, KilnOverlay::IndirectOnly);
    let indirect = [FLOOR, CEILING].map(|place| pixel(&app, place));
    assert!(direct[0].min_element() > 0.05, "{direct:?}");
    assert_eq!(direct[1], Vec3::ZERO, "the lamp shines away from the ceiling");
    assert!(indirect[1].min_element() > 0.005, "{indirect:?}");

    overlay(&mut app, KilnOverlay::None);
    assert!(app.world().resource::<Screen>().0 == without, "another picture than before");
    for ((place, direct), indirect) in [FLOOR, CEILING].into_iter().zip(direct).zip(indirect) {
        let both = ALBEDO * (direct + indirect);
        let seen = pixel(&app, place);
        assert!(((both - seen) / seen).abs().max_element() < 0.05, "{both} for {seen} at {place:?}");
    }

    app.world_mut().trigger(KilnOverlay::Charts);
    show(&mut app);
    let charts = pixel(&app, FLOOR);
    app.world_mut().entity_mut(cube).insert(Visibility::Inherited);
    let again = bake(&mut app, asked);
    assert_eq!(again.entities, 3, "{:?}", again.warnings);
    assert_eq!(again.warnings, [], "an overlay was taken for a thing of the world");
    assert_eq!(*app.world().resource::<KilnOverlay>(), KilnOverlay::None);
    assert!(!is_near(pixel(&app, FLOOR), charts));

    overlay(&mut app, KilnOverlay::Charts);
    app.world_mut().trigger(ClearLightmaps);
    show(&mut app);
    assert!(!is_near(pixel(&app, FLOOR), charts));
    assert_eq!(app.world().resource::<KilnLegend>().sentence, "Nothing is baked yet");
}

/// Until direct light is baked by itself.
fn wait_for_direct_light(app: &mut App) {
    for _ in 0..PATIENCE {
        app.update();
        let sentence = &app.world().resource::<KilnLegend>().sentence;
        if sentence.starts_with("Direct light of") {
            return;
        }
        assert!(!sentence.starts_with("Direct light cannot"), "{sentence}");
    }
    panic!("direct light is not baked");
}

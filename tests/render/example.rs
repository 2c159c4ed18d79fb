//! The example's window after a bake, against the core's path-traced picture from the same camera.

use crate::compare::compare;
use crate::mask::walls;
use crate::picture::Shown;
use crate::skip;
use crate::window::{lacks_a_renderer, program, text, under_a_display};
use bevy_kiln::bake::{CancelToken, PictureSettings, render_picture};
use bevy_kiln::plugin::extract_scene;
use bevy_kiln::plugin::windowless::open_scene;
use bevy_kiln::prelude::*;
use bevy_kiln::scene::{Camera, Scene};
use bevy_kiln::trace::Transport;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Exposure of a Bevy camera that nobody has touched.
const EV100: f32 = 9.7;

const EXAMPLE: &str = "cornell_box";

const SIZE: u32 = 360;

#[test]
fn the_window_shows_what_the_core_renders() {
    let folder = temp_dir::TempDir::new().unwrap();
    let file = folder.path().join("shot.png");
    let size = SIZE.to_string();
    let arguments = ["--size", &size, "--spp", "64", "--density", "16", "--screenshot"];
    let Some(mut command) = under_a_display(EXAMPLE) else { return };
    let output = command.args(arguments).arg(&file).output().unwrap();
    if lacks_a_renderer(&output) {
        return skip("there is no graphics driver; .ci/install-renderer.sh installs one");
    }
    assert!(output.status.success(), "{}", text(&output));
    let shot = Shown::from_file(&file);
    // A window manager may have had other ideas about the size.
    let size = [shot.width as u32, shot.height as u32];
    let (scene, camera) = scene();
    let reference = reference(&scene, &camera, size);
    let walls = walls(&scene, &camera, [shot.width, shot.height]);
    let difference = compare(&shot, &reference, &walls);
    println!("{difference:#?}");
    if let Err(fault) = difference.verdict() {
        let kept = keep(&shot, &reference);
        panic!("{fault}; the pictures are in {}", kept.display());
    }
    reject_planted_faults(&shot, &reference, &walls);
}

/// The pair that the README shows: the example's screenshot and `kiln render` from the same camera.
#[test]
fn the_pictures_in_the_repository_agree() {
    let pictures = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    let [shot, reference] = ["bevy", "reference"].map(|of| pictures.join(format!("cornell_box_{of}.png")));
    let (shot, reference) = (Shown::from_file(&shot), Shown::from_file(&reference));
    let (scene, camera) = scene();
    let walls = walls(&scene, &camera, [shot.width, shot.height]);
    let difference = compare(&shot, &reference, &walls);
    println!("{difference:#?}");
    difference.verdict().unwrap();
    reject_planted_faults(&shot, &reference, &walls);
}

/// The checker itself, on the very pictures that it has accepted.
fn reject_planted_faults(shot: &Shown, reference: &Shown, walls: &[Option<usize>]) {
    let verdict = |shot: &Shown, walls: &[Option<usize>]| compare(shot, reference, walls).verdict();
    let brighter = shot.map(|_, value| value * 1.05);
    assert!(verdict(&brighter, walls).unwrap_err().contains("the means differ"));
    let tinted = shot.map(|_, value| value * DVec3::new(1.0, 1.0, 0.95));
    assert!(verdict(&tinted, walls).unwrap_err().contains("the means differ"));
    // What one wall gains the others lose.
    let of_walls = pixels_of_walls(walls);
    let (&largest, pixels) = of_walls.iter().max_by_key(|(_, pixels)| pixels.len()).unwrap();
    let share = pixels.len() as f64 / walls.iter().flatten().count() as f64;
    let moved = shot.map(|pixel, value| {
        let is_it = walls[pixel] == Some(largest);
        value * if is_it { 1.08 } else { 1.0 - 0.08 * share / (1.0 - share) }
    });
    assert!(verdict(&moved, walls).unwrap_err().contains("the walls differ"));
    // Every wall upside down keeps its mean.
    let flipped = upside_down(shot, walls);
    assert!(verdict(&flipped, walls).unwrap_err().contains("the pictures differ"));
    assert!(verdict(shot, &vec![None; walls.len()]).unwrap_err().contains("too little"));
}

fn pixels_of_walls(walls: &[Option<usize>]) -> BTreeMap<usize, Vec<usize>> {
    let mut of_walls: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (pixel, wall) in walls.iter().enumerate().filter_map(|(pixel, wall)| Some((pixel, (*wall)?))) {
        of_walls.entry(wall).or_default().push(pixel);
    }
    of_walls
}

/// The pixels of each wall in the opposite order.
fn upside_down(shot: &Shown, walls: &[Option<usize>]) -> Shown {
    let mut flipped = shot.clone();
    for pixels in pixels_of_walls(walls).values() {
        for (&to, &from) in pixels.iter().zip(pixels.iter().rev()) {
            flipped.linear[to] = shot.linear[from];
        }
    }
    flipped
}

#[test]
fn what_it_needs_and_does_not_find_ends_in_a_sentence() {
    let Some(mut command) = under_a_display(EXAMPLE) else { return };
    let folder = temp_dir::TempDir::new().unwrap();
    let file = folder.path().join("shot.png");
    let output = command.env("BEVY_ASSET_ROOT", folder.path()).arg("--screenshot").arg(&file).output().unwrap();
    if lacks_a_renderer(&output) {
        return skip("there is no graphics driver; .ci/install-renderer.sh installs one");
    }
    assert_eq!(output.status.code(), Some(1), "{}", text(&output));
    assert!(text(&output).contains("cornell_box: scenes/cornell_box.glb cannot be opened"), "{}", text(&output));
    assert!(!file.exists());

    let without_display =
        Command::new(program(EXAMPLE)).env_remove("DISPLAY").arg("--screenshot").arg(&file).output().unwrap();
    assert_eq!(without_display.status.code(), Some(1), "{}", text(&without_display));
    assert!(text(&without_display).contains("It needs a display"), "{}", text(&without_display));

    let wrong = Command::new(program(EXAMPLE)).args(["--spp", "none"]).output().unwrap();
    assert_eq!(wrong.status.code(), Some(2));
    assert!(text(&wrong).contains("--spp takes a number from 1 to 1000000, not none"), "{}", text(&wrong));
}

fn scene() -> (Scene, Camera) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes/cornell_box.glb");
    let mut app = open_scene(&path).unwrap();
    let settings = SceneSettings { emissive: EmissiveUnit::AsDisplayed { ev100: EV100 }, ..SceneSettings::default() };
    let scene = extract_scene(app.world_mut(), &settings).scene;
    let camera = scene.cameras.iter().find(|camera| camera.name == "camera").expect("the file's camera").clone();
    (scene, camera)
}

fn reference(scene: &Scene, camera: &Camera, [width, height]: [u32; 2]) -> Shown {
    let transport = Transport { seed: 1, ..Transport::default() };
    let settings = PictureSettings { transport, width, height, samples_per_pixel: 64, threads: None };
    let picture = render_picture(scene, camera, &settings, &(), &CancelToken::default()).unwrap();
    Shown::exposed(&picture, f64::from(EV100))
}

/// Saves both pictures and their difference, half grey where there is none.
fn keep(shot: &Shown, reference: &Shown) -> PathBuf {
    let own = std::env::current_exe().unwrap();
    let folder = own.ancestors().nth(3).unwrap().join("render-test");
    std::fs::create_dir_all(&folder).unwrap();
    shot.save(&folder.join("shot.png"));
    reference.save(&folder.join("reference.png"));
    let difference = shot.map(|pixel, value| 0.5 + 2.0 * (value - reference.linear[pixel]));
    difference.save(&folder.join("difference.png"));
    folder
}

//! Every example starts, shows baked light and takes its picture. What is right about the light is for the other tests:
//! these look at what is in the picture. The pictures are kept for a person to look at.

use crate::picture::Shown;
use crate::skip;
use crate::window::{lacks_a_renderer, text, under_a_display};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Of the screen, from the upper left corner: left, top, right, bottom.
type Part = [f64; 4];

const ALL: Part = [0.0, 0.0, 1.0, 1.0];

fn pictures() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("examples");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs the example and keeps its picture by that name; `None` where there is nothing to draw with.
fn picture_of(example: &str, name: &str, arguments: &[&str]) -> Option<Shown> {
    let file = pictures().join(format!("{name}.png"));
    let mut command = under_a_display(example)?;
    command.args(arguments).arg("--screenshot").arg(&file);
    let output = command.env("BEVY_ASSET_ROOT", env!("CARGO_MANIFEST_DIR")).output().unwrap();
    if lacks_a_renderer(&output) {
        skip("there is no graphics driver; .ci/install-renderer.sh installs one");
        return None;
    }
    assert!(output.status.success(), "{example}: {}", text(&output));
    Some(Shown::from_file(&file))
}

/// Mean colour in linear light.
fn mean(shown: &Shown, part: Part) -> DVec3 {
    let inside = inside(shown, part);
    inside.iter().map(|&pixel| shown.linear[pixel]).sum::<DVec3>() / inside.len() as f64
}

fn inside(shown: &Shown, [left, top, right, bottom]: Part) -> Vec<usize> {
    let (width, height) = (shown.width as f64, shown.height as f64);
    let is_inside = |pixel: &usize| {
        let (x, y) = ((pixel % shown.width) as f64 / width, (pixel / shown.width) as f64 / height);
        (left..right).contains(&x) && (top..bottom).contains(&y)
    };
    (0..shown.linear.len()).filter(is_inside).collect()
}

/// Share of the pixels of which `is_so` holds.
fn share(shown: &Shown, part: Part, is_so: impl Fn(DVec3) -> bool) -> f64 {
    let inside = inside(shown, part);
    inside.iter().filter(|&&pixel| is_so(shown.linear[pixel])).count() as f64 / inside.len() as f64
}

#[test]
fn quickstart_lights_the_room_at_a_key() {
    let Some(shown) = picture_of("quickstart", "quickstart", &[]) else { return };
    // Its walls have no light but what was baked.
    let (red, green) = (mean(&shown, [0.25, 0.4, 0.3, 0.6]), mean(&shown, [0.72, 0.3, 0.76, 0.6]));
    assert!(red.x > 0.05 && red.x > 5.0 * red.y, "the left wall is {red}");
    assert!(green.y > 0.03 && green.y > 2.0 * green.x, "the right wall is {green}");
}

#[test]
fn the_gallery_is_lit_right_of_its_line_and_a_shipped_game_shows_the_same() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/baked/gallery");
    let Some(gallery) = picture_of("gallery", "gallery_folder", &["--folder", folder]) else { return };
    let Some(shipped) = picture_of("shipped", "shipped", &[]) else { return };
    assert_eq!([gallery.width, gallery.height], [shipped.width, shipped.height]);
    // Right of the line and its word, above what the shipped game writes; in fields, since one of the two dithers.
    let baked = [0.4, 0.05, 1.0, 0.9];
    let fields = (0..12).flat_map(|column| (0..10).map(move |row| (f64::from(column), f64::from(row))));
    let fields = fields.map(|(column, row)| {
        let (left, top) = (0.4 + 0.05 * column, 0.05 + 0.085 * row);
        [left, top, left + 0.05, top + 0.085]
    });
    let differences: Vec<f64> =
        fields.map(|field| (mean(&gallery, field) - mean(&shipped, field)).abs().max_element()).collect();
    let (mean_of_them, largest) =
        (differences.iter().sum::<f64>() / differences.len() as f64, differences.iter().copied().fold(0.0, f64::max));
    let light = mean(&shipped, baked).element_sum() / 3.0;
    assert!(light > 0.03, "the gallery is dark: {light}");
    // The sun's gloss stays real time, and the cascades of its shadow map are laid out for each view.
    assert!(mean_of_them < 0.005 * light && largest < 0.04 * light, "{mean_of_them}, {largest} of {light}");
    // Left of it the same room has another light.
    let before = [0.02, 0.05, 0.25, 0.9];
    let difference = (mean(&gallery, before) - mean(&shipped, before)).abs().max_element();
    assert!(difference > 0.1 * light, "{difference} of {light}");
}

#[test]
fn the_gallery_bakes() {
    let Some(shown) = picture_of("gallery", "gallery", &["--spp", "8", "--density", "4", "--size", "640x360"]) else {
        return;
    };
    assert!(mean(&shown, [0.4, 0.1, 1.0, 0.9]).min_element() > 0.02);
}

#[test]
fn the_editor_shows_its_panel_over_a_baked_scene() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes/cornell_box.glb");
    let Some(shown) = picture_of("editor", "editor", &[scene, "--error", "20%", "--density", "8"]) else { return };
    let is_red = |light: DVec3| light.x > 0.04 && light.x > 4.0 * light.y;
    assert!(share(&shown, ALL, is_red) > 0.03, "the red wall is not lit");
    let is_blue = |light: DVec3| light.z > 0.3 && light.z > 3.0 * light.x;
    assert!(share(&shown, [0.7, 0.0, 1.0, 0.3], is_blue) > 0.02, "there is no button to bake with");
}

#[test]
fn what_moves_is_lit_by_the_volume() {
    let bake = ["--spp", "8", "--density", "4", "--size", "640x360"];
    let Some(shown) = picture_of("volume", "volume", &bake) else { return };
    assert!(share(&shown, ALL, |light| light.min_element() > 0.02) > 0.5, "the room is dark");
}

#[test]
fn the_furnished_room_bakes() {
    let bake = ["--spp", "8", "--density", "4", "--size", "640x360", "--bicubic"];
    let Some(shown) = picture_of("furnished", "furnished", &bake) else { return };
    assert!(share(&shown, ALL, |light| light.min_element() > 0.02) > 0.5, "the room is dark");
}

//! The light meter and the lightmap against references that an independent renderer or a closed form made (source:
//! `tests/data/README.md`).

mod common;

use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Layout, bake_lightmap};
use bevy_kiln::trace::Transport;
use common::meter::read;
use common::{glb, table};
use glam::DVec3;
use std::path::Path;

/// Width and height of the map of the Cornell box [texels].
const SIZE: usize = 256;

/// Holds every point of a table and the mean over the scene against the reference.
fn assert_meter(name: &str, samples: u32) {
    let references = table::load(name);
    let points: Vec<_> = references.iter().map(|reference| reference.point).collect();
    let readings = read(&glb::load(name), &points, samples, Transport::default());
    let scene_mean: DVec3 =
        references.iter().map(|reference| reference.irradiance).sum::<DVec3>() / points.len() as f64;
    let mut bias = DVec3::ZERO;
    for (reference, reading) in references.iter().zip(&readings) {
        for channel in 0..3 {
            let (truth, value) = (reference.irradiance[channel], reading.irradiance[channel]);
            let (truth_error, error) = (reference.stderr[channel], reading.stderr[channel]);
            let place = format!("{name} at {}, channel {channel}", reference.point.position);
            bias[channel] += (value - truth) / points.len() as f64;
            if truth < 1e-3 * scene_mean[channel] {
                assert!(value < 1e-3 * scene_mean[channel], "{place} should be near black and is {value}");
                continue;
            }
            let allowed = 0.01 * truth + 4.0 * (error * error + truth_error * truth_error).sqrt();
            assert!((value - truth).abs() <= allowed, "{place}: {value} ± {error} against {truth} ± {truth_error}");
            assert!(error <= truth_error.max(0.0025 * truth), "{place}: {value} ± {error} is too noisy");
        }
    }
    let bias = bias / scene_mean;
    assert!(bias.abs().max_element() < 0.002, "{name}: mean bias {bias}");
}

#[test]
fn form_factor() {
    assert_meter("form_factor", 1 << 12);
}

#[test]
fn furnace() {
    assert_meter("furnace", 1 << 14);
}

#[test]
fn furnace_of_albedo_nine_tenths() {
    assert_meter("furnace_090", 1 << 14);
}

#[test]
fn furnace_of_albedo_ninety_nine_hundredths() {
    assert_meter("furnace_099", 1 << 14);
}

#[test]
fn cornell_box() {
    assert_meter("cornell", 1 << 18);
}

/// The whole atlas of the Cornell box, texel by texel. The reference's `A` is 1 where the texel's centre is covered.
#[test]
fn cornell_box_map() {
    let reference = Map::read("cornell_256_irradiance.exr");
    let settings = BakeSettings {
        goal: Goal::Samples(256),
        layout: Layout::Shared { size: SIZE as u32 },
        ..BakeSettings::default()
    };
    let lightmap = bake_lightmap(&glb::load("cornell"), &settings, &(), &CancelToken::default()).unwrap();
    let page = &lightmap.pages[0];
    let mean = |texels: &[usize], of: &dyn Fn(usize) -> DVec3| {
        texels.iter().map(|&index| of(index)).sum::<DVec3>() / texels.len() as f64
    };
    let covered: Vec<usize> = (0..page.raw.len()).filter(|&index| reference.covered[index]).collect();
    let level = mean(&covered, &|index| reference.irradiance[index]);
    let is_buried = |index: usize| reference.irradiance[index].cmplt(1e-3 * level).any();
    let (buried, lit): (Vec<usize>, Vec<usize>) = covered.iter().partition(|&&index| is_buried(index));
    let is_judged = |index: &usize| page.coverage[*index] > 0.5;
    let (judged, lost): (Vec<usize>, Vec<usize>) = lit.iter().partition(|&index| is_judged(index));

    // Of the reference's 40 709 texels 1071 lie under the two blocks, in the dark. We call those hidden, and a texel's
    // coverage is the part of it that is in sight. What is lost of the 39 638 lit ones are the 100 along the blocks'
    // feet of which less than half is in sight (61), or so little that none of the places looked at is (39).
    assert!(lit.len() > 39_000, "the reference has only {} lit texels", lit.len());
    assert!(judged.len() as f64 >= 0.99 * lit.len() as f64, "only {} of {} lit texels judged", judged.len(), lit.len());
    let (near_buried, near_lost) = (beside(&buried), beside(&lost));
    let astray = lost.iter().filter(|index| !near_buried[**index]).count();
    assert_eq!(astray, 0, "texels that are lost, are lit and have no buried neighbour");
    let unburied = buried.iter().filter(|&index| is_judged(index)).count();
    assert_eq!(unburied, 0, "texels that are buried and taken for seen");

    // The reference is the mean over the whole texel, buried part and all; ours is that over the part in sight, which
    // along the feet is less.
    let share = |index: usize| {
        let is_by_a_foot = near_buried[index] || near_lost[index];
        std::f64::consts::PI * if is_by_a_foot { f64::from(page.coverage[index]) } else { 1.0 }
    };
    let value = |index: usize| page.raw[index].as_dvec3() * share(index);
    let error = |index: usize| page.stderr[index].as_dvec3() * share(index);
    let truth = mean(&judged, &|index| reference.irradiance[index]);
    let bias = (mean(&judged, &value) - truth) / truth;
    assert!(bias.abs().max_element() < 1e-3, "mean bias {bias}");

    let disagrees = |index: &&usize| {
        let errors = error(**index) * error(**index) + reference.stderr[**index] * reference.stderr[**index];
        let bound = 5.0 * DVec3::from(errors.to_array().map(f64::sqrt));
        (value(**index) - reference.irradiance[**index]).abs().cmpgt(bound).any()
    };
    let outliers = judged.iter().filter(disagrees).count();
    assert!(outliers as f64 <= 1e-3 * judged.len() as f64, "{outliers} of {} texels disagree", judged.len());
}

/// Which texels of the map are one of these, or a neighbour of one.
fn beside(texels: &[usize]) -> Vec<bool> {
    let mut is_beside = vec![false; SIZE * SIZE];
    for &texel in texels {
        let (column, row) = (texel % SIZE, texel / SIZE);
        for y in row.saturating_sub(1)..=(row + 1).min(SIZE - 1) {
            is_beside[y * SIZE + column.saturating_sub(1)..=y * SIZE + (column + 1).min(SIZE - 1)].fill(true);
        }
    }
    is_beside
}

/// A map of reference irradiance.
struct Map {
    irradiance: Vec<DVec3>,
    stderr: Vec<DVec3>,
    covered: Vec<bool>,
}

impl Map {
    fn read(name: &str) -> Self {
        use exr::prelude::{ReadChannels, ReadLayers, read};
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .all_layers()
            .all_attributes()
            .from_file(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let channel = |name: &str| -> Vec<f64> {
            let mut channels = image.layer_data.iter().flat_map(|layer| {
                let prefix = layer.attributes.layer_name.as_ref().map(ToString::to_string).unwrap_or_default();
                layer.channel_data.list.iter().map(move |channel| (prefix.clone(), channel))
            });
            let is_it = |prefix: &str, channel: &str| channel == name || format!("{prefix}.{channel}") == name;
            let (_, found) = channels
                .find(|(prefix, channel)| is_it(prefix, &channel.name.to_string()))
                .unwrap_or_else(|| panic!("{} has no channel {name}", path.display()));
            found.sample_data.values_as_f32().map(f64::from).collect()
        };
        let colour = |prefix: &str| -> Vec<DVec3> {
            let [r, g, b] = ["R", "G", "B"].map(|name| channel(&format!("{prefix}{name}")));
            r.iter().zip(&g).zip(&b).map(|((r, g), b)| DVec3::new(*r, *g, *b)).collect()
        };
        Self {
            irradiance: colour(""),
            stderr: colour("stderr."),
            covered: channel("A").iter().map(|share| *share > 0.5).collect(),
        }
    }
}

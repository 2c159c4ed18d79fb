//! What no scene may break: floors of tiles by chance.

use crate::common::scenes::{SceneBuilder, grey};
use crate::judge::{Edges, TARGET, bake, on_threads, pairs, settings, worst_jump};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, Denoise, Lightmap, Page, TexelState};
use bevy_kiln::scene::{Light, PointLight, Scene};
use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Lookups at an object's edge read its outer texels to this depth.
const DEPTH: u32 = 2;

/// Two rows of tiles under a lamp.
#[derive(Clone, Debug)]
struct Floor {
    /// Widths of the tiles of each row, in eighths of a metre.
    rows: [Vec<u8>; 2],
    /// Where the lamp is, in quarters of a metre.
    lamp: [u8; 2],
    /// How high, in quarters of a metre.
    height: i8,
}

fn floors(height: std::ops::RangeInclusive<i8>) -> impl Strategy<Value = Floor> {
    let row = || proptest::collection::vec(3..=9_u8, 1..=4);
    (row(), row(), [0..=8_u8, 0..=8], height).prop_map(|(first, second, lamp, height)| Floor {
        rows: [first, second],
        lamp,
        height,
    })
}

impl Floor {
    fn scene(&self, strength: f32) -> Scene {
        let mut builder = SceneBuilder::default();
        for (number, row) in self.rows.iter().enumerate() {
            let mut at = 0.0;
            for (tile, &width) in row.iter().enumerate() {
                let width = f32::from(width) / 8.0;
                let corner = Vec3::new(at, 0.0, number as f32 * 0.75);
                let name = format!("tile {number} {tile}");
                builder = builder.quad(&name, corner, [Vec3::Z * 0.75, Vec3::X * width], grey(0.5));
                at += width;
            }
        }
        // A block, so that there are shadows.
        builder = builder.quad("block", Vec3::new(0.4, 0.3, 0.4), [Vec3::Z * 0.5, Vec3::X * 0.5], grey(0.5));
        let mut scene = builder.build();
        let last = scene.instances.len() - 1;
        scene.instances[last].lightmap = None;
        let [x, z] = self.lamp.map(|at| f32::from(at) / 4.0);
        scene.lights.push(Light::Point(PointLight {
            id: StableId::new("lamp"),
            name: "lamp".into(),
            position: Vec3::new(x, f32::from(self.height) / 4.0, z),
            intensity: strength * Vec3::new(1.0, 2.0, 0.5),
            radius: 0.1,
            range: None,
        }));
        scene
    }
}

/// Texels that lie deeper than lookups at edges read and are not what was measured.
fn touched_inside(lightmap: &Lightmap) -> usize {
    let within = |page: &Page, texel: usize| {
        let (x, y) = (texel as u32 % page.width, texel as u32 / page.width);
        let near = lightmap.placements.iter().any(|placement| {
            let low = [placement.uv_min[0] * page.width as f32, placement.uv_min[1] * page.height as f32];
            let high = [placement.uv_max[0] * page.width as f32, placement.uv_max[1] * page.height as f32];
            let deep = |at: u32, axis: usize| {
                let low = low[axis].round() as u32 + DEPTH;
                let high = high[axis].round() as u32;
                at >= low && at + DEPTH < high
            };
            deep(x, 0) && deep(y, 1)
        });
        near && page.state[texel] == TexelState::Measured
    };
    let changed = |page: &Page| {
        (0..page.raw.len()).filter(|&texel| within(page, texel) && page.radiance[texel] != page.raw[texel]).count()
    };
    lightmap.pages.iter().map(changed).sum()
}

/// Without denoising, so that what was measured is what seams and rings start from.
fn undenoised(samples: u32) -> BakeSettings {
    BakeSettings { denoise: Denoise::Off, ..settings(16.0, samples) }
}

fn bits(lightmap: &Lightmap) -> Vec<u32> {
    let values = lightmap.pages.iter().flat_map(|page| page.radiance.iter());
    values.flat_map(|value| value.to_array()).map(f32::to_bits).collect()
}

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 24,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(0x7365_616d),
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    /// Seams close, and nothing farther in is touched.
    #[test]
    fn seams_close_and_the_rest_is_what_was_measured(floor in floors(2..=8)) {
        let scene = floor.scene(100.0);
        let lightmap = bake(&scene, &undenoised(64));
        prop_assert_eq!(touched_inside(&lightmap), 0);
        let jump = worst_jump(&scene, &lightmap, &pairs(&scene, Edges::Smooth));
        prop_assert!(jump <= TARGET, "{}", jump);
        // The texels of these tiles are in line: what is read across joints leaves next to nothing to solve.
        let before = lightmap.report.seams.unwrap().before;
        prop_assert!(before.p99 < 0.05, "{}", before.p99);
        for page in &lightmap.pages {
            prop_assert!(page.radiance.iter().all(|value| value.is_finite() && value.min_element() >= 0.0));
        }
    }

    /// A million times the light, or a millionth, to the bit.
    #[test]
    fn strength_only_scales(floor in floors(2..=8)) {
        let of = |strength: f32| bake(&floor.scene(strength), &settings(16.0, 16));
        let plain = of(100.0);
        for scale in [2.0_f32.powi(20), 2.0_f32.powi(-20)] {
            let other = of(100.0 * scale);
            for (page, other) in plain.pages.iter().zip(&other.pages) {
                for (value, other) in page.radiance.iter().zip(&other.radiance) {
                    prop_assert_eq!(*value * scale, *other);
                }
            }
        }
    }

    /// Neither the order of objects nor the number of threads changes a bit.
    #[test]
    fn order_and_threads_change_nothing(floor in floors(2..=8)) {
        let scene = floor.scene(100.0);
        let settings = settings(16.0, 16);
        let expected = bits(&bake(&scene, &on_threads(&settings, 1)));
        let mut turned = scene.clone();
        turned.instances.reverse();
        prop_assert_eq!(&bits(&bake(&turned, &on_threads(&settings, 3))), &expected);
        prop_assert_eq!(&bits(&bake(&scene, &on_threads(&settings, 4))), &expected);
    }

    /// Tiles that no light reaches, the lamp being below them, stay black, covered and filled alike.
    #[test]
    fn black_stays_black(floor in floors(-8..=-2)) {
        let mut settings = settings(16.0, 16);
        settings.transport.max_bounces = Some(0);
        let lightmap = bake(&floor.scene(100.0), &settings);
        for page in &lightmap.pages {
            prop_assert!(page.radiance.iter().all(|value| *value == Vec3::ZERO));
            prop_assert!(page.coverage.contains(&1.0));
        }
    }
}

/// A blur of everything, as a repair without measure would do, is found.
#[test]
fn a_blur_is_seen() {
    let floor = Floor { rows: [vec![6, 7], vec![9]], lamp: [3, 2], height: 4 };
    let mut lightmap = bake(&floor.scene(100.0), &undenoised(16));
    assert_eq!(touched_inside(&lightmap), 0);
    let page = &mut lightmap.pages[0];
    let before = page.radiance.clone();
    (1..before.len()).for_each(|texel| page.radiance[texel] = 0.5 * (before[texel] + before[texel - 1]));
    assert!(touched_inside(&lightmap) > 20);
}

//! The bits of three bakes, held as literals: whatever changes a number of a bake changes a line here, so that nobody
//! does it without knowing. After a change of the method that is meant, print them anew with
//! `cargo test --test determinism -- --ignored --nocapture print_fingerprints` and say in the commit why they moved.

use crate::common::garden::garden;
use crate::common::glb;
use crate::fingerprint::Fingerprint;
use crate::vitrine::vitrine;
use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Layout, Lightmap, bake_lightmap};
use bevy_kiln::scene::Scene;
use std::num::NonZeroUsize;

/// A bake whose bits are held.
pub struct Held {
    pub name: &'static str,
    pub hash: u64,
    scene: fn() -> Scene,
    density: f32,
    layout: Layout,
}

/// Measured walls and lamp; something of every effect; glass, gloss and sky.
pub const HELD: [Held; 3] = [
    Held {
        name: "cornell",
        hash: 0x75ed_655a_da79_cd52,
        scene: || glb::load("cornell"),
        density: 1.0,
        layout: Layout::Shared { size: 32 },
    },
    Held { name: "garden", hash: 0x3533_4be0_9145_bbd8, scene: garden, density: 5.0, layout: Layout::Packed },
    Held { name: "vitrine", hash: 0x4f18_5d4c_16e0_b7ff, scene: vitrine, density: 4.0, layout: Layout::Packed },
];

impl Held {
    pub fn bake(&self, threads: usize) -> Lightmap {
        let settings = BakeSettings {
            goal: Goal::Samples(128),
            density: self.density,
            layout: self.layout,
            threads: NonZeroUsize::new(threads),
            ..BakeSettings::default()
        };
        bake_lightmap(&(self.scene)(), &settings, &(), &CancelToken::default()).unwrap()
    }
}

#[test]
fn the_bits_of_three_bakes() {
    let mut moved = Vec::new();
    for held in &HELD {
        let lightmap = held.bake(2);
        let fingerprint = Fingerprint::of(&lightmap);
        // Light in most texels, so that the bits say something.
        let texels = lightmap.pages.iter().flat_map(|page| page.raw.iter().zip(&page.coverage));
        let (lit, covered) = texels
            .filter(|(_, coverage)| **coverage > 0.0)
            .fold((0, 0), |(lit, covered), (raw, _)| (lit + u32::from(raw.min_element() > 0.0), covered + 1));
        assert!(covered > 100 && 2 * lit > covered, "{}: {lit} of {covered} texels have light", held.name);
        if fingerprint.hash() != held.hash {
            moved.push(format!("{} is {:#018x} and was {:#018x}", held.name, fingerprint.hash(), held.hash));
        }
    }
    assert!(moved.is_empty(), "the bits of bakes have moved: {moved:?}");
}

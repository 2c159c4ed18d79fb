//! Long references: luminance of each texel and its standard error, as text.

use crate::bake;
use crate::scenes::Case;
use bevy_kiln::bake::{Goal, TexelState};
use bevy_kiln::math::luminance;
use std::fmt::Write;
use std::path::PathBuf;

/// A texel of a reference.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    pub texel: usize,
    /// Luminance of E/π [cd/m²].
    pub value: f64,
    /// Half-width of its 95 % interval [cd/m²].
    pub half_width: f64,
}

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/data/calibration/{name}.csv"))
}

pub fn load(name: &str) -> Vec<Known> {
    let text = std::fs::read_to_string(path(name)).unwrap();
    let known = |line: &str| {
        let mut numbers = line.split(',');
        let mut next = || numbers.next().unwrap();
        Known { texel: next().parse().unwrap(), value: next().parse().unwrap(), half_width: next().parse().unwrap() }
    };
    text.lines().skip(1).map(known).collect()
}

/// Bakes and writes one.
pub fn make(case: &Case) {
    let lightmap = bake(case, Goal::Samples(case.long), 0);
    let page = &lightmap.pages[0];
    let mut text = String::from("texel,luminance,half_width\n");
    for texel in (0..page.raw.len()).filter(|&texel| page.state[texel] == TexelState::Measured) {
        let value = luminance(page.raw[texel].as_dvec3());
        writeln!(text, "{texel},{value:.6e},{:.3e}", page.half_width[texel]).unwrap();
    }
    std::fs::create_dir_all(path("").parent().unwrap()).unwrap();
    std::fs::write(path(case.name), text).unwrap();
    println!("{}: {:?}", case.name, lightmap.report.intervals);
}

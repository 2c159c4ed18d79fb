//! What one surface sends another it would get from it: A₁ F₁₂ = A₂ F₂₁. Measured as the mean irradiance of each
//! rectangle while the other glows, since E₂ = π L F₂₁.

use crate::Fault;
use crate::chance::{Search, finds, holds};
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::judge::{Mean, settle};
use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, bake_lightmap};
use bevy_kiln::scene::LightmapRequest;
use bevy_kiln::trace::Transport;
use glam::Vec3;
use proptest::prelude::*;
use std::fmt::{Display, Formatter};

/// Two rectangles that face each other more or less, and what may stand between them.
#[derive(Clone, Debug)]
struct Pair {
    /// Sides of the first, in eighths of a metre.
    first: [u8; 2],
    /// Sides of the second.
    second: [u8; 2],
    /// Corner of the second, in eighths; it lies 3/8 to 16/8 above the first.
    at: [i8; 3],
    /// By how much its edges climb, in eighths.
    climb: [i8; 2],
    /// Corner of a square in the way, in eighths.
    blocker: Option<[i8; 2]>,
}

fn pairs() -> impl Strategy<Value = Pair> {
    let side = || [2..=12_u8, 2..=12];
    let blocker = proptest::option::of([-4..=4_i8, -4..=4]);
    let at = (-8..=8_i8, 6..=16_i8, -8..=8_i8);
    (side(), side(), at, [-3..=3_i8, -3..=3], blocker).prop_map(|(first, second, (x, y, z), climb, blocker)| Pair {
        first,
        second,
        at: [x, y, z],
        climb,
        blocker,
    })
}

/// Texels along each side: their mean is that of the rectangle.
const TEXELS: f32 = 4.0;

impl Pair {
    fn edges(&self) -> [[Vec3; 2]; 2] {
        let [a, b] = self.first.map(|side| f32::from(side) / 8.0);
        let [c, d] = self.second.map(|side| f32::from(side) / 8.0);
        let [along, across] = self.climb.map(|climb| f32::from(climb) / 8.0);
        // The first looks up and the second down. A parallelogram, where both edges climb.
        [[Vec3::Z * b, Vec3::X * a], [Vec3::new(c, along, 0.0), Vec3::new(0.0, across, d)]]
    }

    /// Mean irradiance of one while the other glows, times its area.
    fn received(&self, receiver: usize, samples: u32) -> Mean {
        let edges = self.edges();
        let corners = [Vec3::ZERO, Vec3::from_array(self.at.map(f32::from)) / 8.0];
        let mut builder = SceneBuilder::default();
        for (number, name) in ["first", "second"].into_iter().enumerate() {
            let material = if number == receiver { grey(0.0) } else { glowing(0.0, 1.0) };
            builder = builder.quad(name, corners[number], edges[number], material);
        }
        if let Some(blocker) = self.blocker {
            let [x, z] = blocker.map(|eighths| f32::from(eighths) / 8.0);
            let edges = [Vec3::Z * 0.25, Vec3::X * 0.25];
            builder = builder.quad("blocker", Vec3::new(x, 0.2, z), edges, grey(0.0));
        }
        let mut scene = builder.build();
        let area = edges[receiver][0].cross(edges[receiver][1]).length();
        for (number, instance) in scene.instances.iter_mut().enumerate() {
            let longest = edges[receiver].map(Vec3::length).into_iter().fold(0.0, f32::max);
            instance.lightmap = instance
                .lightmap
                .filter(|_| number == receiver)
                .map(|_| LightmapRequest { density: Some(TEXELS / longest) });
        }
        let transport = Transport { seed: receiver as u64, ..Transport::default() };
        let settings = BakeSettings { transport, goal: Goal::Samples(samples), ..BakeSettings::default() };
        let lightmap = bake_lightmap(&scene, &settings, &(), &CancelToken::default()).unwrap();
        let page = &lightmap.pages[0];
        let covered: Vec<usize> = (0..page.raw.len()).filter(|&index| page.coverage[index] > 0.0).collect();
        let count = covered.len() as f64;
        let value = covered.iter().map(|&index| f64::from(page.raw[index].y)).sum::<f64>() / count;
        let error = covered.iter().map(|&index| f64::from(page.stderr[index].y).powi(2)).sum::<f64>().sqrt() / count;
        Mean { value, error }.times(f64::from(area))
    }
}

impl Display for Pair {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "- a rectangle of {:?}/8 m that looks up", self.first)?;
        writeln!(f, "- one of {:?}/8 m at {:?}/8 that looks down, climbing {:?}/8", self.second, self.at, self.climb)?;
        if let Some(blocker) = self.blocker {
            writeln!(f, "- a square at {blocker:?}/8 between them")?;
        }
        Ok(())
    }
}

fn reciprocity(pair: &Pair, fault: Fault) -> Result<(), String> {
    settle(0.008, |samples| {
        let planted = if fault == Fault::OnePercent { 1.01 } else { 1.0 };
        [pair.received(0, samples / 4), pair.received(1, samples / 4).times(planted)]
    })
}

#[test]
fn what_one_sends_the_other_would_send_back() {
    holds(16, pairs(), |pair| reciprocity(pair, Fault::None));
}

#[test]
fn one_percent_more_one_way_is_found() {
    finds(Search { cases: 2, shrinks: 8 }, pairs(), |pair| reciprocity(pair, Fault::OnePercent));
}

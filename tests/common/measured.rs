//! What a bake has measured, texel by texel, and how much of it is farther off a reference than was asked for.

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Lightmap, TexelState};
use bevy_kiln::math::luminance;
use glam::Vec3;
use std::collections::BTreeMap;

/// A measured texel: its value before repair and the standard error of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    pub raw: Vec3,
    pub stderr: Vec3,
}

/// By object and place in its rectangle.
pub type Texels = BTreeMap<(StableId, [u32; 2]), Measured>;

pub fn texels(lightmap: &Lightmap) -> Texels {
    let mut texels = Texels::new();
    for placement in &lightmap.placements {
        let page = &lightmap.pages[placement.page as usize];
        let corner =
            |uv: [f32; 2]| [(uv[0] * page.width as f32).round() as u32, (uv[1] * page.height as f32).round() as u32];
        let (low, high) = (corner(placement.uv_min), corner(placement.uv_max));
        for (row, column) in (low[1]..high[1]).flat_map(|row| (low[0]..high[0]).map(move |column| (row, column))) {
            let index = (row * page.width + column) as usize;
            if page.state[index] == TexelState::Measured {
                let measured = Measured { raw: page.raw[index], stderr: page.stderr[index] };
                texels.insert((placement.id.clone(), [column - low[0], row - low[1]]), measured);
            }
        }
    }
    texels
}

/// Share of the texels that are farther off a reference than `target`, over their value, the reference's own error
/// granted. The reference may be of a part of the objects.
pub fn exceeding(answer: &Lightmap, reference: &Texels, target: f64) -> f64 {
    let value = |measured: &Measured| luminance(measured.raw.as_dvec3());
    let floor = 0.1 * reference.values().map(value).sum::<f64>() / reference.len() as f64;
    let answer = texels(answer);
    assert!(!reference.is_empty() && answer.len() >= reference.len());
    let is_off = |(place, known): &(&(StableId, [u32; 2]), &Measured)| {
        let granted = luminance(known.stderr.as_dvec3());
        (value(&answer[*place]) - value(known)).abs() > target * value(known).max(floor) + granted
    };
    reference.iter().filter(is_off).count() as f64 / reference.len() as f64
}

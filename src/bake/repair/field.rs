//! The texels of one page with all that repair must know of each. Owns the layers' meaning and who is whose
//! neighbour; changes no value.

use crate::bake::gather::Estimate;
use crate::bake::sites::{Covered, Site};
use crate::bake::validity::Links;
use glam::Vec3;

/// What a texel of a page is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TexelState {
    /// No triangle covers it. What it holds was filled in for texture filtering.
    #[default]
    Empty,
    /// Covered, but inside of bodies and in the dark: nobody sees it. What it holds was filled in.
    Hidden,
    /// Covered and measured.
    Measured,
}

/// The texels of one page, row by row.
#[derive(Clone, Debug, Default)]
pub(in crate::bake) struct Field {
    /// Width and height [texels].
    pub(in crate::bake) size: [u32; 2],
    /// E/π, as repaired so far [cd/m²].
    pub(in crate::bake) value: Vec<Vec3>,
    /// Standard error of what was measured [cd/m²].
    pub(in crate::bake) stderr: Vec<Vec3>,
    /// Standard error of the luminance of what was measured [cd/m²].
    pub(in crate::bake) luminance_error: Vec<f32>,
    /// Standard error of `value` after denoising, as estimated [cd/m²].
    pub(in crate::bake) residual: Vec<Vec3>,
    /// What half of the runs measured: `2 value - half` is the other half's before repair, and the two are independent
    /// [cd/m²].
    pub(in crate::bake) half: Vec<Vec3>,
    /// What the texel is. All other layers but `value` count only where it is measured.
    pub(in crate::bake) state: Vec<TexelState>,
    /// Number of its chart in the bake, where it is covered.
    pub(in crate::bake) chart: Vec<u32>,
    /// The place in the traced frame that stands for it [m].
    pub(in crate::bake) position: Vec<Vec3>,
    /// Unit normal that receives there.
    pub(in crate::bake) normal: Vec<Vec3>,
    /// The neighbours, in its chart, that can be reached from it without passing through a surface.
    pub(in crate::bake) links: Vec<Links>,
    /// Share of its area that is covered and in sight, in [0, 1].
    pub(in crate::bake) seen: Vec<f32>,
    /// Whether a part of it that is seen cannot be reached from that place.
    pub(in crate::bake) is_split: Vec<bool>,
}

impl Field {
    /// A page of empty texels.
    pub(in crate::bake) fn empty(size: [u32; 2]) -> Self {
        let count = size[0] as usize * size[1] as usize;
        Self {
            size,
            value: vec![Vec3::ZERO; count],
            stderr: vec![Vec3::ZERO; count],
            luminance_error: vec![0.0; count],
            residual: vec![Vec3::ZERO; count],
            half: vec![Vec3::ZERO; count],
            state: vec![TexelState::Empty; count],
            chart: vec![0; count],
            position: vec![Vec3::ZERO; count],
            normal: vec![Vec3::ZERO; count],
            links: vec![Links::default(); count],
            seen: vec![0.0; count],
            is_split: vec![false; count],
        }
    }

    /// Notes what was measured of a texel.
    pub(in crate::bake) fn set_measured(&mut self, site: &Site, estimate: &Estimate) {
        let index = site.covered.index as usize;
        self.value[index] = estimate.mean.as_vec3();
        self.stderr[index] = estimate.stderr.as_vec3();
        self.luminance_error[index] = estimate.luminance_error as f32;
        self.residual[index] = self.stderr[index];
        self.half[index] = estimate.half.as_vec3();
        self.seen[index] = (site.covered.texel.coverage.min(1.0) * estimate.accepted) as f32;
        self.state[index] = TexelState::Measured;
        self.chart[index] = site.covered.chart;
        self.position[index] = site.footing.anchor.position();
        self.normal[index] = site.footing.anchor.normal();
        self.links[index] = site.footing.links;
        self.is_split[index] = site.footing.is_split;
    }

    /// Notes that nobody sees a texel.
    pub(in crate::bake) fn set_hidden(&mut self, covered: &Covered) {
        let index = covered.index as usize;
        self.state[index] = TexelState::Hidden;
        self.chart[index] = covered.chart;
    }

    /// Whether a texel was measured.
    pub(in crate::bake) fn is_measured(&self, index: usize) -> bool {
        self.state[index] == TexelState::Measured
    }

    /// The texel at a step from another, if it lies on the page.
    pub(in crate::bake) fn step(&self, index: usize, [x, y]: [i32; 2]) -> Option<usize> {
        let [width, height] = self.size;
        let column = (index as u32 % width).checked_add_signed(x).filter(|&column| column < width)?;
        let row = (index as u32 / width).checked_add_signed(y).filter(|&row| row < height)?;
        Some((row * width + column) as usize)
    }
}

//! What the denoiser knows of a page: two independent halves of each measurement, the variance that they have, and
//! between which neighbours it may walk.

use super::super::Field;
use super::luck;
use super::window::Window;
use glam::Vec3;

/// Neighbours whose normals are further apart than this cosine stand on two sides of an edge.
const SAME_SIDE: f32 = 0.7;

/// Two estimates of one variance from 16 runs each are seldom further apart than this factor.
const ALIKE: f32 = 6.0;

/// How far variances are averaged [texels].
const VARIANCE_RADIUS: f32 = 4.0;

/// Within how many texels a share of how many must be as certain as a texel that is to be trusted.
const TRUST_RADIUS: f32 = 3.0;
const TRUSTED: f32 = 0.2;

/// A page as the denoiser sees it, row by row. What is not measured has no links and is never looked at.
pub(super) struct Texels {
    pub(super) width: u32,
    /// Each half of the measurement.
    pub(super) halves: [Vec<Vec3>; 2],
    /// Variance of one half.
    pub(super) variance: Vec<Vec3>,
    /// Bits of the neighbours that may be walked to.
    pub(super) links: Vec<u8>,
    /// Indices of the measured texels.
    pub(super) measured: Vec<usize>,
}

/// Steps to the eight neighbours.
const STEPS: [[i32; 2]; 8] = [[-1, -1], [0, -1], [1, -1], [-1, 0], [1, 0], [-1, 1], [0, 1], [1, 1]];

impl Texels {
    pub(super) fn new(field: &Field) -> Self {
        let count = field.value.len();
        let measured: Vec<usize> = (0..count).filter(|&index| field.is_measured(index)).collect();
        let mut texels = Self {
            width: field.size[0],
            halves: [vec![Vec3::ZERO; count], vec![Vec3::ZERO; count]],
            variance: vec![Vec3::ZERO; count],
            links: vec![0; count],
            measured,
        };
        for &index in &texels.measured {
            texels.halves[0][index] = field.half[index];
            texels.halves[1][index] = 2.0 * field.value[index] - field.half[index];
            texels.variance[index] = 2.0 * field.stderr[index] * field.stderr[index];
            texels.links[index] = links(field, index);
        }
        let window = Window::new(VARIANCE_RADIUS);
        texels.variance = luck::variance_of_unlucky(&texels, &window);
        texels.variance = texels.trusted_variance(&Window::new(TRUST_RADIUS));
        texels.variance = texels.smooth_variance(&window);
        texels
    }

    /// What was measured.
    pub(super) fn mean(&self, index: usize) -> Vec3 {
        0.5 * (self.halves[0][index] + self.halves[1][index])
    }

    /// Whether all neighbours of a texel may be walked to.
    pub(super) fn is_whole(&self, index: usize) -> bool {
        self.links[index] == u8::MAX
    }

    /// The bit of a step in a set of links.
    pub(super) fn bit(step: [i32; 2]) -> u8 {
        STEPS.iter().position(|&other| other == step).map_or(0, |place| 1 << place)
    }

    /// The texel at a step from another, to which one could walk.
    pub(super) fn at(&self, index: usize, [x, y]: [i32; 2]) -> usize {
        let step = y as isize * self.width as isize + x as isize;
        index.wrapping_add_signed(step)
    }

    /// The neighbour behind a bit of the links, if it is set.
    pub(super) fn neighbour(&self, index: usize, number: usize) -> usize {
        self.at(index, STEPS[number])
    }

    /// Raises variances that are lower than most about them. Where light is rare a texel that little of it found is
    /// dark and its runs agree: it looks certain. Beyond the edge of a shadow there are more of its kind. (What has no
    /// error at all is `luck`'s.)
    fn trusted_variance(&self, window: &Window) -> Vec<Vec3> {
        let mut trusted = self.variance.clone();
        let mut around = Vec::new();
        for &index in &self.measured {
            let reached = window.reach(self, index);
            let lowest = (reached.len() as f32 * TRUSTED) as usize;
            for channel in (0..3).filter(|&channel| self.variance[index][channel] > 0.0) {
                around.clear();
                around.extend(reached.iter().map(|other| self.variance[other.index][channel]));
                let (_, least, _) = around.select_nth_unstable_by(lowest, f32::total_cmp);
                trusted[index][channel] = trusted[index][channel].max(*least);
            }
        }
        trusted
    }

    /// Averages each variance with those about it that may be estimates of the same.
    fn smooth_variance(&self, window: &Window) -> Vec<Vec3> {
        let mut smooth = self.variance.clone();
        for &index in &self.measured {
            let reached = window.reach(self, index);
            let own = self.variance[index];
            let (low, high) = (own / ALIKE, own * ALIKE);
            let (mut sum, mut count) = (Vec3::ZERO, Vec3::ZERO);
            for other in &reached {
                let variance = self.variance[other.index];
                let is_alike = variance.cmpge(low) & variance.cmple(high);
                sum += Vec3::select(is_alike, variance, Vec3::ZERO);
                count += Vec3::select(is_alike, Vec3::ONE, Vec3::ZERO);
            }
            smooth[index] = sum / count;
        }
        smooth
    }
}

/// The neighbours that may be walked to: linked, measured, and on the same side of a sharp edge.
fn links(field: &Field, index: usize) -> u8 {
    let may_walk = |step: [i32; 2]| {
        let Some(other) = field.step(index, step) else { return false };
        field.links[index].reaches(step)
            && field.is_measured(other)
            && field.chart[index] == field.chart[other]
            && field.normal[index].dot(field.normal[other]) > SAME_SIDE
    };
    STEPS.into_iter().filter(|&step| may_walk(step)).fold(0, |links, step| links | Texels::bit(step))
}

//! How far two pictures of the same walls are apart: by wall, all in all, and by small squares, since two pictures
//! may have equal means and nothing else in common.

use crate::picture::Shown;
use bevy_kiln::math::luminance;
use glam::DVec3;
use std::collections::BTreeMap;

/// Largest difference of the mean of all walls, and of the walls' means, as a share.
const WALLS: f64 = 0.02;

/// Largest mean difference of the squares' means. Contains the noise of both pictures and what texels blur.
const SQUARES: f64 = 0.02;

/// Side of a square [pixels].
const SQUARE: usize = 16;

/// Pixels in a square or a wall below which it is left out, as a share of the square or of the picture.
const LEAST_SQUARE: f64 = 0.5;
const LEAST_WALL: f64 = 0.002;

/// Share of the picture that must be compared. The box fills 0.9 of it.
const LEAST_COVERED: f64 = 0.6;

/// As many walls must be compared: floor, ceiling, back, left, right, and two sides and the top of the blocks.
const LEAST_WALLS: usize = 8;

/// A wall or a square that is darker than this is left out: eight bits have too few steps there.
const LEAST_MEAN: f64 = 0.005;

/// What eight bits hold; a wall pixel above is left out with those around it.
const CLIPPED: f64 = 0.9;

/// Differences as shares of the reference.
#[derive(Debug)]
pub struct Difference {
    /// Share of the picture that was compared.
    pub covered: f64,
    /// Of the mean of all, signed, per channel.
    pub overall: DVec3,
    /// Mean absolute difference of the walls' means, weighted by pixels and taken over channels.
    pub walls: f64,
    /// Each wall's largest difference over its channels, signed.
    pub by_wall: Vec<f64>,
    /// Mean absolute difference of the squares' luminance.
    pub squares: f64,
}

#[derive(Clone, Copy, Default)]
struct Sum {
    pixels: f64,
    shot: DVec3,
    reference: DVec3,
}

impl Sum {
    fn add(&mut self, shot: DVec3, reference: DVec3) {
        self.pixels += 1.0;
        self.shot += shot;
        self.reference += reference;
    }

    fn difference(&self) -> DVec3 {
        (self.shot - self.reference) / self.reference
    }

    /// The same, but 0 where it is too dark to tell.
    fn visible_difference(&self) -> DVec3 {
        let is_seen = (self.reference / self.pixels).cmpge(DVec3::splat(LEAST_MEAN));
        DVec3::select(is_seen, self.difference(), DVec3::ZERO)
    }
}

/// Compares the pixels that belong to a wall.
pub fn compare(shot: &Shown, reference: &Shown, walls: &[Option<usize>]) -> Difference {
    assert_eq!((shot.width, shot.height, walls.len()), (reference.width, reference.height, shot.linear.len()));
    let mut all = Sum::default();
    let mut by_wall: BTreeMap<usize, Sum> = BTreeMap::new();
    let mut by_square: BTreeMap<(usize, usize, usize), Sum> = BTreeMap::new();
    for (pixel, wall) in walls.iter().enumerate() {
        let Some(wall) = *wall else { continue };
        if is_clipped(reference, walls, pixel) {
            continue;
        }
        let (a, b) = (shot.linear[pixel], reference.linear[pixel]);
        let (x, y) = (pixel % shot.width / SQUARE, pixel / shot.width / SQUARE);
        all.add(a, b);
        by_wall.entry(wall).or_default().add(a, b);
        by_square.entry((wall, x, y)).or_default().add(a, b);
    }
    let picture = shot.linear.len() as f64;
    let of_walls: Vec<Sum> = by_wall.into_values().filter(|sum| sum.pixels >= LEAST_WALL * picture).collect();
    let largest = |d: DVec3| d.to_array().into_iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let least = LEAST_SQUARE * (SQUARE * SQUARE) as f64;
    let of_squares: Vec<f64> = by_square
        .into_values()
        .filter(|sum| sum.pixels >= least && luminance(sum.reference / sum.pixels) >= LEAST_MEAN)
        .map(|sum| luminance(sum.shot) / luminance(sum.reference) - 1.0)
        .collect();
    Difference {
        covered: all.pixels / picture,
        overall: all.difference(),
        walls: of_walls.iter().map(|sum| sum.visible_difference().abs().element_sum() / 3.0 * sum.pixels).sum::<f64>()
            / of_walls.iter().map(|sum| sum.pixels).sum::<f64>(),
        by_wall: of_walls.iter().map(|sum| largest(sum.visible_difference())).collect(),
        squares: of_squares.iter().map(|d| d.abs()).sum::<f64>() / of_squares.len() as f64,
    }
}

/// Whether the surroundings of a pixel come near what a screen can show. Their mean, so that noise decides little.
fn is_clipped(reference: &Shown, walls: &[Option<usize>], pixel: usize) -> bool {
    let (x, y) = (pixel % reference.width, pixel / reference.width);
    let around = (y.saturating_sub(2)..=y + 2).flat_map(|row| (x.saturating_sub(2)..=x + 2).map(move |c| (row, c)));
    let same = around.filter(|&(row, column)| row < reference.height && column < reference.width);
    let same = same.map(|(row, column)| row * reference.width + column).filter(|&other| walls[other] == walls[pixel]);
    let (count, sum) = same.fold((0.0, DVec3::ZERO), |(n, sum), other| (n + 1.0, sum + reference.linear[other]));
    (sum / count).max_element() > CLIPPED
}

impl Difference {
    /// Whether the pictures are the same, and enough of them was looked at to say so.
    pub fn verdict(&self) -> Result<(), String> {
        let faults = [
            (self.covered < LEAST_COVERED, "too little was compared"),
            (self.by_wall.len() < LEAST_WALLS, "too few walls were compared"),
            (!self.overall.abs().cmplt(DVec3::splat(WALLS)).all(), "the means differ"),
            (!is_below(self.walls, WALLS), "the walls differ"),
            (!is_below(self.squares, SQUARES), "the pictures differ"),
        ];
        let faults: Vec<&str> = faults.into_iter().filter(|(is_fault, _)| *is_fault).map(|(_, what)| what).collect();
        if faults.is_empty() { Ok(()) } else { Err(format!("{}: {self:?}", faults.join(", "))) }
    }
}

/// Not for what is no number.
fn is_below(value: f64, limit: f64) -> bool {
    value.is_finite() && value < limit
}

//! A chart relaxed until lengths are kept as well as they can be: as rigid as possible (Liu, Zhang, Xu, Gotsman and
//! Gortler 2008), by turns the best rotation of each triangle and, from those, the best place of each point.
//!
//! The second is a linear system with the cotangents as weights; it is solved by conjugate gradients (Hestenes and
//! Stiefel 1952) in a fixed order, so that its bits are the same everywhere. Cotangents are held above 0: the system
//! then is positive definite for every mesh, at the price of a little stretch at very obtuse triangles.

use super::flatten::{isometric, scaled};
use super::patch::Chart;
use super::surface::Surface;
use super::work::Work;
use glam::DVec2;

/// Turns of rotations and places.
const ROUNDS: usize = 6;

/// Steps of conjugate gradients in each.
const STEPS: usize = 24;

/// Cotangents are held within these.
const COTANGENTS: [f64; 2] = [0.05, 20.0];

/// Relaxes a chart; `None` where there is no work left.
pub(super) fn relax(surface: &Surface, mut chart: Chart, work: &mut Work<'_>) -> Option<Chart> {
    let system = System::new(surface, &chart);
    for _ in 0..ROUNDS {
        if !work.takes((STEPS * chart.triangles.len()) as u64) {
            return None;
        }
        let wanted = system.wanted(&chart.points);
        system.solve(&mut chart.points, wanted);
    }
    Some(scaled(surface, chart))
}

struct System {
    corners: Vec<[u32; 3]>,
    /// Each triangle with its lengths kept.
    rest: Vec<[DVec2; 3]>,
    /// Cotangent of the angle opposite the edge from corner k to the next.
    cotangents: Vec<[f64; 3]>,
    /// Edges with the sum of their cotangents.
    edges: Vec<(u32, u32, f64)>,
    diagonal: Vec<f64>,
}

impl System {
    fn new(surface: &Surface, chart: &Chart) -> Self {
        let rest: Vec<[DVec2; 3]> =
            chart.triangles.iter().map(|&triangle| isometric(surface.triangle(triangle))).collect();
        let [least, most] = COTANGENTS;
        let cotangents: Vec<[f64; 3]> = rest
            .iter()
            .map(|corners| {
                [0, 1, 2].map(|edge| {
                    let apex = corners[(edge + 2) % 3];
                    let [a, b] = [corners[edge] - apex, corners[(edge + 1) % 3] - apex];
                    (a.dot(b) / a.perp_dot(b)).clamp(least, most)
                })
            })
            .collect();
        let mut edges: Vec<(u32, u32, f64)> = Vec::with_capacity(3 * rest.len());
        for (corners, cotangents) in chart.corners.iter().zip(&cotangents) {
            for edge in 0..3 {
                let (a, b) = (corners[edge], corners[(edge + 1) % 3]);
                edges.push((a.min(b), a.max(b), cotangents[edge]));
            }
        }
        edges.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
        edges.dedup_by(|next, kept| {
            let same = (next.0, next.1) == (kept.0, kept.1);
            if same {
                kept.2 += next.2;
            }
            same
        });
        let mut diagonal = vec![0.0; chart.points.len()];
        for &(a, b, weight) in &edges {
            diagonal[a as usize] += weight;
            diagonal[b as usize] += weight;
        }
        Self { corners: chart.corners.clone(), rest, cotangents, edges, diagonal }
    }

    /// The right-hand side: what the edges would be if each triangle were only turned.
    fn wanted(&self, points: &[DVec2]) -> Vec<DVec2> {
        let mut wanted = vec![DVec2::ZERO; points.len()];
        for ((corners, rest), cotangents) in self.corners.iter().zip(&self.rest).zip(&self.cotangents) {
            let mut turn = DVec2::ZERO;
            for edge in 0..3 {
                let next = (edge + 1) % 3;
                let is = points[corners[edge] as usize] - points[corners[next] as usize];
                let was = rest[edge] - rest[next];
                turn += cotangents[edge] * DVec2::new(was.dot(is), was.perp_dot(is));
            }
            let turn = turn.try_normalize().unwrap_or(DVec2::X);
            for edge in 0..3 {
                let next = (edge + 1) % 3;
                let turned = cotangents[edge] * turn.rotate(rest[edge] - rest[next]);
                wanted[corners[edge] as usize] += turned;
                wanted[corners[next] as usize] -= turned;
            }
        }
        wanted
    }

    fn apply(&self, points: &[DVec2]) -> Vec<DVec2> {
        let mut result = vec![DVec2::ZERO; points.len()];
        for &(a, b, weight) in &self.edges {
            let pull = weight * (points[a as usize] - points[b as usize]);
            result[a as usize] += pull;
            result[b as usize] -= pull;
        }
        result
    }

    /// Conjugate gradients from where the points are, both coordinates at once.
    fn solve(&self, points: &mut [DVec2], wanted: Vec<DVec2>) {
        let mut rest: Vec<DVec2> = wanted.iter().zip(self.apply(points)).map(|(wanted, is)| *wanted - is).collect();
        let ahead = |rest: &[DVec2]| -> Vec<DVec2> {
            rest.iter().zip(&self.diagonal).map(|(rest, &diagonal)| *rest / diagonal.max(1e-30)).collect()
        };
        let dot = |a: &[DVec2], b: &[DVec2]| a.iter().zip(b).map(|(a, b)| a * b).sum::<DVec2>();
        let mut next = ahead(&rest);
        let mut direction = next.clone();
        let mut size = dot(&rest, &next);
        let enough = 1e-16 * dot(&wanted, &ahead(&wanted));
        for _ in 0..STEPS {
            if size.cmple(enough).all() {
                return;
            }
            let image = self.apply(&direction);
            let step = quotient(size, dot(&direction, &image));
            for index in 0..points.len() {
                points[index] += step * direction[index];
                rest[index] -= step * image[index];
            }
            next = ahead(&rest);
            let new_size = dot(&rest, &next);
            let share = quotient(new_size, size);
            size = new_size;
            for (direction, next) in direction.iter_mut().zip(&next) {
                *direction = *next + share * *direction;
            }
        }
    }
}

/// a / b by coordinate, 0 where b is none.
fn quotient(a: DVec2, b: DVec2) -> DVec2 {
    let one = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    DVec2::new(one(a.x, b.x), one(a.y, b.y))
}

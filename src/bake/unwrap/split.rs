//! A patch parted into compact pieces that each face one way.
//!
//! Seeds are chosen so that every normal is near one of theirs (the farthest first: Gonzalez 1985), pieces grow from
//! them along the surface, and seeds move to the middle of their pieces: Lloyd's way (1982) with proxies, after
//! Cohen-Steiner, Alliez and Desbrun (2004). A patch that faces one way and yet cannot be laid out is cut across its
//! length.

use super::patch::Patch;
use super::surface::{NONE, Surface};
use super::work::Work;
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Cosine of the angle within which every normal has a seed: 65°.
const COVERED: f64 = 0.42;

/// Most pieces at a time.
const MOST_PIECES: usize = 8;

/// How often seeds move.
const ROUNDS: usize = 3;

/// How much a step that faces away from a seed costs more than one that faces its way.
const TURN_COST: f64 = 24.0;

/// Parts a patch into at least two; `None` where there is no work left.
pub(super) fn split(surface: &Surface, patch: &Patch, work: &mut Work<'_>) -> Option<Vec<Patch>> {
    if !work.takes((12 * (ROUNDS + 1) * patch.len()) as u64) {
        return None;
    }
    let (axis, least) = patch.cone(surface);
    let mut seeds = if least < COVERED { by_normal(surface, patch, axis) } else { by_distance(surface, patch) };
    let mut labels = grown(surface, patch, &seeds);
    for _ in 0..ROUNDS {
        let moved = middles(surface, patch, &labels, seeds.len());
        if moved == seeds {
            break;
        }
        seeds = moved;
        labels = grown(surface, patch, &seeds);
    }
    Some(patch.split_by(&labels))
}

/// A triangle and the normal that its piece is to face.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seed {
    triangle: u32,
    normal: DVec3,
}

fn seed(surface: &Surface, patch: &Patch, triangle: u32) -> Seed {
    Seed { triangle, normal: surface.normals[patch.triangles[triangle as usize] as usize] }
}

/// Seeds such that every normal is near that of one.
fn by_normal(surface: &Surface, patch: &Patch, axis: DVec3) -> Vec<Seed> {
    let normal = |triangle: u32| surface.normals[patch.triangles[triangle as usize] as usize];
    let mut nearest: Vec<f64> = (0..patch.len() as u32).map(|triangle| normal(triangle).dot(axis)).collect();
    let mut seeds = Vec::new();
    while seeds.len() < MOST_PIECES {
        let (triangle, cosine) = least_of(&nearest);
        if seeds.len() >= 2 && cosine > COVERED {
            break;
        }
        if seeds.is_empty() {
            nearest.fill(-1.0);
        }
        let seed = seed(surface, patch, triangle);
        for (index, nearest) in nearest.iter_mut().enumerate() {
            *nearest = nearest.max(normal(index as u32).dot(seed.normal));
        }
        nearest[triangle as usize] = 2.0;
        seeds.push(seed);
    }
    seeds
}

/// The two ends of a patch.
fn by_distance(surface: &Surface, patch: &Patch) -> Vec<Seed> {
    let farthest = |from: u32| {
        let seed = Seed { triangle: from, normal: DVec3::ZERO };
        let away: Vec<f64> = walk(surface, patch, &[seed]).1.into_iter().map(|way| -way).collect();
        least_of(&away).0
    };
    let first = farthest(0);
    let second = farthest(first);
    [first, second].map(|triangle| seed(surface, patch, triangle)).to_vec()
}

fn least_of(values: &[f64]) -> (u32, f64) {
    let least = values.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    least.map_or((0, f64::INFINITY), |(index, &value)| (index as u32, value))
}

/// Which seed each triangle belongs to.
fn grown(surface: &Surface, patch: &Patch, seeds: &[Seed]) -> Vec<u32> {
    walk(surface, patch, seeds).0
}

/// The nearest seed of each triangle and how far it is, by Dijkstra's way (1959).
fn walk(surface: &Surface, patch: &Patch, seeds: &[Seed]) -> (Vec<u32>, Vec<f64>) {
    let mut labels = vec![NONE; patch.len()];
    let mut ways = vec![f64::INFINITY; patch.len()];
    let mut queue = BinaryHeap::new();
    for (label, seed) in seeds.iter().enumerate() {
        queue.push((Reverse(0_u64), Reverse(label as u32), Reverse(seed.triangle)));
    }
    let centre = |triangle: u32| surface.centre(patch.triangles[triangle as usize]);
    while let Some((Reverse(bits), Reverse(label), Reverse(triangle))) = queue.pop() {
        if labels[triangle as usize] != NONE {
            continue;
        }
        labels[triangle as usize] = label;
        ways[triangle as usize] = f64::from_bits(bits);
        let here = centre(triangle);
        for next in patch.neighbours(triangle).filter(|&next| labels[next as usize] == NONE) {
            let normal = surface.normals[patch.triangles[next as usize] as usize];
            let away = 1.0 - normal.dot(seeds[label as usize].normal);
            let way = f64::from_bits(bits) + (centre(next) - here).length() * (1.0 + TURN_COST * away * away);
            if way < ways[next as usize] {
                ways[next as usize] = way;
                queue.push((Reverse(way.to_bits()), Reverse(label), Reverse(next)));
            }
        }
    }
    // Only what does not hang together with any seed is left, and a patch hangs together.
    labels.iter_mut().filter(|label| **label == NONE).for_each(|label| *label = 0);
    (labels, ways)
}

/// The triangle in the middle of each piece, and the piece's normal.
fn middles(surface: &Surface, patch: &Patch, labels: &[u32], count: usize) -> Vec<Seed> {
    let mut sums = vec![(DVec3::ZERO, DVec3::ZERO, 0.0); count];
    for (&label, &triangle) in labels.iter().zip(&patch.triangles) {
        let area = surface.areas[triangle as usize];
        let sum = &mut sums[label as usize];
        sum.0 += area * surface.centre(triangle);
        sum.1 += area * surface.normals[triangle as usize];
        sum.2 += area;
    }
    let mut seeds: Vec<(f64, Seed)> =
        sums.iter().map(|sum| (f64::INFINITY, Seed { triangle: 0, normal: sum.1.normalize_or_zero() })).collect();
    for (index, (&label, &triangle)) in labels.iter().zip(&patch.triangles).enumerate() {
        let (centre, _, area) = sums[label as usize];
        let distance = (surface.centre(triangle) - centre / area).length_squared();
        let (least, seed) = &mut seeds[label as usize];
        if distance < *least {
            (*least, seed.triangle) = (distance, index as u32);
        }
    }
    seeds.into_iter().map(|(_, seed)| seed).collect()
}

//! Curved shapes whose charts are laid out by hand.

use bevy_kiln::scene::{Indices, Mesh};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Quads along each side of a chart.
const CELLS: u32 = 12;

/// A place on a surface and the normal there.
pub type Point = (Vec3, Vec3);

/// How a chart lies in its cell of UV1.
#[derive(Clone, Copy, Debug)]
pub enum Outline {
    /// A square turned by an angle.
    Square(f32),
    /// A disc, its radius the second parameter, its angle the first.
    Disc,
}

/// A surface over the unit square.
pub struct Patch {
    pub at: Box<dyn Fn(f32, f32) -> Point>,
    pub outline: Outline,
}

fn patch(at: impl Fn(f32, f32) -> Point + 'static, outline: Outline) -> Patch {
    Patch { at: Box::new(at), outline }
}

/// A mesh of patches, each of which is a chart of its own in a cell of UV1.
pub fn mesh(name: &str, patches: &[Patch]) -> Mesh {
    let columns = (patches.len() as f32).sqrt().ceil() as usize;
    let (mut positions, mut normals, mut uv1, mut indices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (number, patch) in patches.iter().enumerate() {
        let cell = Vec2::new((number % columns) as f32 + 0.5, (number / columns) as f32 + 0.5) / columns as f32;
        let first = positions.len() as u32;
        let around = match patch.outline {
            Outline::Square(_) => CELLS,
            Outline::Disc => 3 * CELLS,
        };
        for row in 0..=CELLS {
            for column in 0..=around {
                let [s, t] = [column as f32 / around as f32, row as f32 / CELLS as f32];
                let (position, normal) = (patch.at)(s, t);
                positions.push(position);
                normals.push(normal.normalize());
                let place = match patch.outline {
                    Outline::Square(turn) => {
                        0.84 * Vec2::from_angle(turn).rotate(Vec2::new(s, t) - 0.5) / (turn.sin().abs() + turn.cos())
                    }
                    Outline::Disc => 0.42 * t * Vec2::from_angle(TAU * s),
                };
                uv1.push(cell + place / columns as f32);
            }
        }
        for row in 0..CELLS {
            for column in 0..around {
                let corner = first + row * (around + 1) + column;
                let [a, b, c, d] = [corner, corner + 1, corner + around + 2, corner + around + 1];
                indices.extend([a, b, c, a, c, d]);
            }
        }
    }
    // Fronts follow the normals; what has no area is no triangle.
    let indices = indices.chunks(3).filter_map(|triangle| {
        let [a, b, c] = [0, 1, 2].map(|corner| positions[triangle[corner] as usize]);
        let normal = (b - a).cross(c - a);
        let [i, j, k] = [triangle[0], triangle[1], triangle[2]];
        let outwards: Vec3 = [i, j, k].into_iter().map(|vertex| normals[vertex as usize]).sum();
        let is_front = normal.dot(outwards) > 0.0;
        (normal.length() > 1e-7).then_some(if is_front { [i, j, k] } else { [i, k, j] })
    });
    let indices = indices.flatten().collect();
    Mesh {
        name: name.into(),
        indices: Indices::U32(indices),
        positions,
        normals: Some(normals),
        uv1: Some(uv1),
        ..Mesh::default()
    }
}

fn around(angle: f32) -> Vec3 {
    Vec3::new(angle.cos(), 0.0, angle.sin())
}

/// Six faces of a cube, blown up.
pub fn sphere() -> Vec<Patch> {
    let faces = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let face = |(number, normal): (usize, Vec3)| {
        let (u, v) = (normal.yzx(), normal.zxy());
        let at = move |s: f32, t: f32| {
            let [s, t] = [s, t].map(|along| ((along - 0.5) * FRAC_PI_2).tan());
            let direction = (normal + s * u + t * v).normalize();
            (0.5 * direction, direction)
        };
        patch(at, Outline::Square([0.0, 0.3, 0.7, 0.1, 0.5, 0.0][number]))
    };
    faces.into_iter().enumerate().map(face).collect()
}

use glam::Vec3Swizzles;

/// The side of a cylinder in three strips, from one height to another.
fn strips(low: f32, high: f32) -> Vec<Patch> {
    let strip = |number: u8| {
        let at = move |s: f32, t: f32| {
            let direction = around((f32::from(number) + s) * TAU / 3.0);
            (0.4 * direction + Vec3::Y * (low + (high - low) * t), direction)
        };
        patch(at, Outline::Square([0.0, 0.4, 0.0][usize::from(number)]))
    };
    (0..3).map(strip).collect()
}

/// Three strips, and two caps with edges as hard as they look.
pub fn cylinder() -> Vec<Patch> {
    let cap = |height: f32| {
        let normal = Vec3::Y * height.signum();
        patch(move |s, t| (0.4 * t * around(TAU * s) + Vec3::Y * height, normal), Outline::Disc)
    };
    strips(-0.6, 0.6).into_iter().chain([cap(-0.6), cap(0.6)]).collect()
}

/// Three strips, and two half spheres on discs.
pub fn capsule() -> Vec<Patch> {
    let cap = |sign: f32| {
        let at = move |s: f32, t: f32| {
            let (sin, cos) = (FRAC_PI_2 * t).sin_cos();
            let direction = sin * around(TAU * s) + Vec3::Y * (sign * cos);
            (0.4 * direction + Vec3::Y * (0.3 * sign), direction)
        };
        patch(at, Outline::Disc)
    };
    strips(-0.3, 0.3).into_iter().chain([cap(-1.0), cap(1.0)]).collect()
}

/// Four by two patches.
pub fn torus() -> Vec<Patch> {
    let piece = |number: u8| {
        let (i, j) = (f32::from(number % 4), f32::from(number / 4));
        let at = move |s: f32, t: f32| {
            let outwards = around((i + s) * FRAC_PI_2);
            let (sin, cos) = ((j + t) * PI).sin_cos();
            let normal = cos * outwards + sin * Vec3::Y;
            (0.5 * outwards + 0.22 * normal, normal)
        };
        patch(at, Outline::Square(if number == 2 { 0.35 } else { 0.0 }))
    };
    (0..8).map(piece).collect()
}

/// A straight piece, a bend of a quarter turn and another straight piece, each in three strips.
pub fn pipe() -> Vec<Patch> {
    let piece = |number: u8| {
        let (strip, part) = (f32::from(number % 3), number / 3);
        let at = move |s: f32, t: f32| {
            // Along the middle: a place, and the direction towards the middle of the bend.
            let (middle, inwards) = match part {
                0 => (Vec3::new(-0.5, -0.7 + 0.7 * t, 0.0), Vec3::X),
                1 => {
                    let (sin, cos) = (FRAC_PI_2 * t).sin_cos();
                    (0.5 * Vec3::new(-cos, sin, 0.0), Vec3::new(cos, -sin, 0.0))
                }
                _ => (Vec3::new(0.7 * t, 0.5, 0.0), Vec3::NEG_Y),
            };
            let (sin, cos) = ((strip + s) * TAU / 3.0 + 0.4).sin_cos();
            let normal = cos * inwards + sin * Vec3::Z;
            (middle + 0.2 * normal, normal)
        };
        patch(at, Outline::Square(if number % 4 == 1 { 0.25 } else { 0.0 }))
    };
    (0..9).map(piece).collect()
}

//! Meshes of very different kinds, made by rule.

use super::bevy_kiln::math::combine;
use super::bevy_kiln::scene::{Indices, Mesh, Topology};
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// A number in [0, 1) from a key.
pub fn unit(key: u64) -> f32 {
    (combine(0x0075_6e77_7261_7000, key) >> 40) as f32 / (1_u64 << 24) as f32
}

pub fn mesh(name: &str, positions: Vec<Vec3>, indices: Vec<u32>) -> Mesh {
    Mesh { name: name.into(), positions, indices: Indices::U32(indices), ..Mesh::default() }
}

/// A sheet of `columns` × `rows` quads over (u, v) in the unit square; its vertices are split nowhere but at its ends.
pub fn sheet(name: &str, [columns, rows]: [u32; 2], at: impl Fn(f32, f32) -> Vec3) -> Mesh {
    let mut positions = Vec::new();
    let mut indices = Vec::new();
    for row in 0..=rows {
        for column in 0..=columns {
            positions.push(at(column as f32 / columns as f32, row as f32 / rows as f32));
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let corner = row * (columns + 1) + column;
            let [a, b, c, d] = [corner, corner + 1, corner + columns + 2, corner + columns + 1];
            indices.extend([a, b, c, a, c, d]);
        }
    }
    mesh(name, positions, indices)
}

/// A closed sheet: what meets is made exactly one place, and every normal is smooth.
fn smooth(mut mesh: Mesh) -> Mesh {
    for position in &mut mesh.positions {
        *position = (*position * 4096.0).round() / 4096.0;
    }
    let key = |position: Vec3| position.to_array().map(|coordinate| (coordinate + 0.0).to_bits());
    let mut sums = std::collections::BTreeMap::<[u32; 3], Vec3>::new();
    let triangles: Vec<[u32; 3]> = mesh.triangles().collect();
    for corners in triangles {
        let [a, b, c] = corners.map(|vertex| mesh.positions[vertex as usize]);
        for corner in [a, b, c] {
            *sums.entry(key(corner)).or_default() += (b - a).cross(c - a);
        }
    }
    let normal = |position: &Vec3| sums.get(&key(*position)).map_or(Vec3::Y, |sum| sum.normalize_or(Vec3::Y));
    mesh.normals = Some(mesh.positions.iter().map(normal).collect());
    mesh
}

fn around(angle: f32) -> Vec3 {
    Vec3::new(angle.cos(), 0.0, angle.sin())
}

pub fn sphere(columns: u32, rows: u32) -> Mesh {
    smooth(sheet("sphere", [columns, rows], |u, v| (PI * v).sin() * around(-TAU * u) - Vec3::Y * (PI * v).cos()))
}

pub fn capsule(columns: u32) -> Mesh {
    smooth(sheet("capsule", [columns, 16], |u, v| {
        let row = v * 16.0;
        let (angle, lift) = if row <= 8.0 { (row / 8.0 - 1.0, -1.0) } else { ((row - 9.0).max(0.0) / 7.0, 1.0) };
        let angle = angle * PI / 2.0;
        0.5 * angle.cos() * around(-TAU * u) + Vec3::Y * (0.5 * angle.sin() + lift)
    }))
}

pub fn torus(columns: u32, rows: u32) -> Mesh {
    smooth(sheet("torus", [columns, rows], |u, v| {
        (1.0 + 0.4 * (TAU * v).cos()) * around(-TAU * u) + Vec3::Y * 0.4 * (TAU * v).sin()
    }))
}

pub fn tube(columns: u32) -> Mesh {
    smooth(sheet("tube", [columns, 3], |u, v| 0.5 * around(-TAU * u) + Vec3::Y * 2.0 * v))
}

pub fn cone(columns: u32) -> Mesh {
    smooth(sheet("cone", [columns, 1], |u, v| (1.0 - v) * around(-TAU * u) + Vec3::Y * 1.5 * v))
}

/// A pipe that bends by a right angle.
pub fn pipe(columns: u32, rows: u32) -> Mesh {
    smooth(sheet("pipe", [columns, rows], |u, v| {
        let out = around(PI / 2.0 * v);
        2.0 * out + 0.5 * ((TAU * u).cos() * out - (TAU * u).sin() * Vec3::Y)
    }))
}

/// A sheet bent to a half circle.
pub fn bent_sheet(columns: u32) -> Mesh {
    smooth(sheet("bent sheet", [columns, 4], |u, v| around(-PI * u) + Vec3::Y * 3.0 * v))
}

pub fn moebius(columns: u32) -> Mesh {
    sheet("Möbius strip", [columns, 3], |u, v| {
        let (turn, half) = (TAU * u, PI * u);
        let out = around(turn);
        out + 0.6 * (v - 0.5) * (half.cos() * out + half.sin() * Vec3::Y)
    })
}

pub fn terrain(side: u32) -> Mesh {
    smooth(sheet("terrain", [side, side], |u, v| {
        let height = (9.0 * u).sin() * (7.0 * v + 1.0).cos() + 0.3 * (31.0 * u + 17.0 * v).sin();
        Vec3::new(20.0 * u, height, 20.0 * (1.0 - v))
    }))
}

/// The six faces of a box, without normals, each of `cells`² quads.
pub fn cuboid(name: &str, low: Vec3, size: Vec3, cells: u32) -> Mesh {
    let mut all = mesh(name, vec![], vec![]);
    for axis in 0..3 {
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|unit| unit * size);
        let [u, v, w] = [[x, y, z], [y, z, x], [z, x, y]][axis];
        join(&mut all, &sheet("", [cells; 2], |a, b| low + w + a * u + b * v));
        join(&mut all, &sheet("", [cells; 2], |a, b| low + b * u + a * v));
    }
    all
}

/// Adds another mesh.
pub fn join(to: &mut Mesh, other: &Mesh) {
    let first = to.positions.len() as u32;
    let Indices::U32(indices) = &mut to.indices else { unreachable!("made here") };
    indices.extend(other.triangles().flatten().map(|vertex| vertex + first));
    to.positions.extend(&other.positions);
}

pub fn chair() -> Mesh {
    let mut chair = cuboid("chair", Vec3::new(0.0, 0.45, 0.0), Vec3::new(0.45, 0.04, 0.45), 1);
    for [x, z] in [[0.0, 0.0], [0.41, 0.0], [0.0, 0.41], [0.41, 0.41]] {
        join(&mut chair, &cuboid("", Vec3::new(x, 0.0, z), Vec3::new(0.04, 0.45, 0.04), 1));
    }
    join(&mut chair, &cuboid("", Vec3::new(0.0, 0.49, 0.41), Vec3::new(0.45, 0.5, 0.04), 1));
    chair
}

pub fn stairs(steps: u32) -> Mesh {
    let mut stairs = mesh("stairs", vec![], vec![]);
    for step in 0..steps {
        let low = Vec3::new(0.0, 0.0, 0.3 * step as f32);
        join(&mut stairs, &cuboid("", low, Vec3::new(1.2, 0.18 * (step + 1) as f32, 0.3), 1));
    }
    stairs
}

pub fn arch() -> Mesh {
    let mut arch = mesh("arch", vec![], vec![]);
    let ring = |u: f32, radius: f32, z: f32| -radius * Vec3::new((PI * u).cos(), -(PI * u).sin(), 0.0) + Vec3::Z * z;
    join(&mut arch, &sheet("", [24, 1], |u, v| ring(u, 1.0, 0.5 * v)));
    join(&mut arch, &sheet("", [24, 1], |u, v| ring(u, 1.4, 0.5 - 0.5 * v)));
    join(&mut arch, &sheet("", [24, 1], |u, v| ring(u, 1.4 - 0.4 * v, 0.5)));
    join(&mut arch, &sheet("", [24, 1], |u, v| ring(u, 1.0 + 0.4 * v, 0.0)));
    arch
}

/// Leaves of two triangles in every direction.
pub fn clutter(leaves: u64) -> Mesh {
    let mut all = mesh("clutter", vec![], vec![]);
    for leaf in 0..leaves {
        let number = |next: u64| unit(16 * leaf + next);
        let turn = Quat::from_xyzw(number(0) - 0.5, number(1) - 0.5, number(2) - 0.5, number(3) - 0.5).normalize();
        let centre = 6.0 * Vec3::new(number(4), number(5), number(6));
        let size = 0.1 + 0.2 * number(7);
        let corner = |x: f32, y: f32| centre + turn * (size * Vec3::new(x, 2.0 * y, 0.1 * (x + y)));
        let first = all.positions.len() as u32;
        all.positions.extend([corner(0.0, 0.0), corner(1.0, 0.3), corner(0.9, 1.0), corner(-0.1, 0.8)]);
        let Indices::U32(indices) = &mut all.indices else { unreachable!("made here") };
        indices.extend([0, 1, 2, 0, 2, 3].map(|corner| corner + first));
    }
    all
}

/// Crates of six faces of `cells`² quads, each turned its own way, beside each other.
pub fn crates(count: u64, cells: u32) -> Mesh {
    let mut all = mesh("crates", vec![], vec![]);
    let one = cuboid("", Vec3::splat(-0.5), Vec3::ONE, cells);
    for number in 0..count {
        let part = |next: u64| unit(0x1000_0000 + 8 * number + next);
        let turn = Quat::from_xyzw(part(0) - 0.5, part(1) - 0.5, part(2) - 0.5, part(3) - 0.5).normalize();
        let size = 0.3 * (0.5 + part(4));
        let mut crate_ = one.clone();
        for position in &mut crate_.positions {
            *position = turn * (size * *position) + Vec3::new((number % 64) as f32, 0.0, (number / 64) as f32);
        }
        join(&mut all, &crate_);
    }
    all
}

/// A fan of triangles a thousand times as long as wide.
pub fn needles(count: u32) -> Mesh {
    let mut positions = vec![Vec3::ZERO];
    positions.extend((0..=count).map(|index| 2.0 * around(index as f32 * 1e-3)));
    mesh("needles", positions, (0..count).flat_map(|index| [0, index + 2, index + 1]).collect())
}

/// A ball whose radius goes up and down at random.
pub fn bumpy(columns: u32, rows: u32) -> Mesh {
    let mut ball = sphere(columns, rows);
    for position in &mut ball.positions {
        let key = position.to_array().map(|coordinate| u64::from((coordinate + 0.0).to_bits()));
        *position *= 1.0 + 0.04 * unit(combine(combine(key[0], key[1]), key[2]));
    }
    let mut bumpy = smooth(ball);
    bumpy.name = "bumpy ball".into();
    bumpy
}

pub fn strip(length: u32) -> Mesh {
    let point = |index: u32| Vec3::new(0.25 * (index / 2) as f32, 0.0, (index % 2) as f32);
    let mut strip = mesh("strip", (0..length).map(point).collect(), (0..length).collect());
    strip.topology = Topology::TriangleStrip;
    strip
}

pub fn with_uv1(mut mesh: Mesh, uv1: impl Fn(usize, Vec3) -> Vec2) -> Mesh {
    mesh.uv1 = Some(mesh.positions.iter().enumerate().map(|(index, &position)| uv1(index, position)).collect());
    mesh
}

//! However a surface is cut, its light is the same.
//!
//! Rooms are measured in quarters of a metre, so that every cut falls on a number that `f32` has.

use crate::Fault;
use crate::chance::{Search, finds, holds};
use crate::common::meter::read;
use crate::judge::{Mean, same, settle};
use crate::sketch::{ALL, INDOORS, Shell, Sketch, sketches};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Lightmap, bake_lightmap};
use bevy_kiln::scene::{Indices, LightmapRequest, Mesh, Scene};
use bevy_kiln::trace::Transport;
use glam::{Vec2, Vec3};

/// Each triangle of a mesh as four, by the middles of its edges.
fn quartered(mesh: &Mesh) -> Mesh {
    let mut cut = mesh.clone();
    let mut indices = Vec::new();
    let uv1 = cut.uv1.as_mut().unwrap();
    for [a, b, c] in mesh.triangles() {
        let mut middle = |p: u32, q: u32| {
            let (p, q) = (p as usize, q as usize);
            cut.positions.push(0.5 * (cut.positions[p] + cut.positions[q]));
            uv1.push(0.5 * (uv1[p] + uv1[q]));
            cut.positions.len() as u32 - 1
        };
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        indices.extend([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]);
    }
    cut.indices = Indices::U32(indices);
    cut
}

fn all_quartered(scene: &Scene) -> Scene {
    let mut cut = scene.clone();
    cut.meshes = scene.meshes.iter().map(quartered).collect();
    cut
}

fn loses_a_piece(mut scene: Scene) -> Scene {
    if let Indices::U32(indices) = &mut scene.meshes[2].indices {
        indices.truncate(indices.len() - 3);
    }
    scene
}

/// By how much a cut may change what the same random numbers find at a point. Paths meet the same places but for
/// rounding and for the rim of each triangle: what rays leave keeps 64u of the largest coordinate off its edges, 12 µm
/// of 3 m, and light that falls with the square of a distance of 0.3 m changes by 2/0.3 of that.
const ROUNDING: f64 = 1e-4;

/// By how much it may change the mean, of some thousands of paths: now and then one passes on the other side of an edge
/// for that rounding, and is another path from there on.
const FEW_PATHS: f64 = 4e-3;

/// Walls and blocks cut, lamps not: the same random numbers, the same paths.
fn cut_in_four(sketch: &Sketch, fault: Fault) -> Result<(), String> {
    let scene = sketch.scene();
    let mut cut = all_quartered(&scene);
    for (mesh, whole) in cut.meshes.iter_mut().zip(&scene.meshes) {
        if whole.name.starts_with("lamp") {
            *mesh = whole.clone();
        }
    }
    let cut = if fault == Fault::PieceMissing { loses_a_piece(cut) } else { cut };
    let [whole, pieces] = [&scene, &cut]
        .map(|scene| read(scene, &sketch.points(), 256, Transport::default()))
        .map(|readings| readings.iter().map(|reading| reading.irradiance.y).collect::<Vec<f64>>());
    let is_same = |(whole, pieces): (&f64, &f64)| (whole - pieces).abs() <= ROUNDING * whole;
    let apart = whole.len() - whole.iter().zip(&pieces).filter(|&pair| is_same(pair)).count();
    if 4 * apart > whole.len() {
        return Err(format!("other paths at {apart} of {} points: {whole:?} and {pieces:?}", whole.len()));
    }
    let [whole, pieces] = [whole, pieces].map(|light| Mean { value: light.iter().sum(), error: 0.0 });
    same(whole, pieces, FEW_PATHS)
}

const SHELLS: &[Shell] = &[Shell::Closed, Shell::Open];

#[test]
fn triangles_cut_in_four() {
    holds(32, sketches(SHELLS, ALL), |sketch| cut_in_four(sketch, Fault::None));
}

#[test]
fn a_missing_piece_is_found() {
    let search = Search { cases: 8, shrinks: 24 };
    finds(search, sketches(&[Shell::Closed], ALL), |sketch| cut_in_four(sketch, Fault::PieceMissing));
}

/// Lamps cut too: other emitters, other paths, the same light.
#[test]
fn lamps_cut_in_four() {
    holds(6, sketches(&[Shell::Closed], INDOORS), |sketch| {
        let (scene, points) = (sketch.scene(), sketch.points());
        let cut = all_quartered(&scene);
        let seeds = [1, 2].map(|seed| Transport { seed, ..Transport::default() });
        settle(0.03, |samples| {
            [Mean::of(&scene, &points, samples, seeds[0]), Mean::of(&cut, &points, samples, seeds[1])]
        })
    });
}

/// The floor as four rectangles, each with a name and texels of its own.
fn floor_in_pieces(sketch: &Sketch) -> Scene {
    let mut scene = sketch.scene();
    let index = scene.instances.iter().position(|instance| instance.name == "-y").unwrap();
    let floor = scene.instances.remove(index);
    let half = 0.5 * sketch.far();
    for (number, corner) in [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].into_iter().enumerate() {
        let corner = Vec3::new(corner.x * half.x, 0.0, corner.y * half.z);
        let (u, v) = (Vec3::Z * half.z, Vec3::X * half.x);
        let mut mesh = scene.meshes[floor.mesh].clone();
        mesh.positions = vec![corner, corner + u, corner + u + v, corner + v];
        let name = format!("-y {number}");
        scene.meshes.push(mesh);
        let mut piece = floor.clone();
        (piece.id, piece.name, piece.mesh) = (StableId::new(name.clone()), name, scene.meshes.len() - 1);
        scene.instances.push(piece);
    }
    assert_eq!(scene.validate(), []);
    scene
}

fn bake(scene: &Scene, samples: u32, seed: u64) -> Lightmap {
    let mut scene = scene.clone();
    for instance in &mut scene.instances {
        instance.lightmap = instance.lightmap.filter(|_| !instance.name.starts_with("lamp"));
    }
    // A clamp that nothing reaches spares the energy balance, which takes longer than such a bake.
    let transport = Transport { seed, clamp: Some(1e30), ..Transport::default() };
    let settings = BakeSettings { goal: Goal::Samples(samples), density: 1.5, transport, ..BakeSettings::default() };
    bake_lightmap(&scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// Light and error of the texels of each object whose id begins so, spread over the whole texel.
fn texels(lightmap: &Lightmap, prefix: &str) -> Vec<[Vec3; 2]> {
    let mut texels = Vec::new();
    for place in lightmap.placements.iter().filter(|place| place.id.as_str().starts_with(prefix)) {
        let page = &lightmap.pages[place.page as usize];
        let texel =
            |uv: [f32; 2]| [(uv[0] * page.width as f32).round() as u32, (uv[1] * page.height as f32).round() as u32];
        let ([left, top], [right, bottom]) = (texel(place.uv_min), texel(place.uv_max));
        let places = (top..bottom).flat_map(|y| (left..right).map(move |x| (y * page.width + x) as usize));
        texels.extend(
            places.map(|index| [page.raw[index], page.stderr[index]].map(|light| light * page.coverage[index])),
        );
    }
    texels
}

fn mean_of(texels: &[[Vec3; 2]]) -> Mean {
    let count = texels.len() as f64;
    let value = texels.iter().map(|[value, _]| f64::from(value.y)).sum::<f64>() / count;
    let error = texels.iter().map(|[_, error]| f64::from(error.y).powi(2)).sum::<f64>().sqrt() / count;
    Mean { value, error }
}

/// A floor in pieces is as bright as a whole one.
fn in_pieces(sketch: &Sketch, fault: Fault) -> Result<(), String> {
    let (whole, mut pieces) = (sketch.scene(), floor_in_pieces(sketch));
    if fault == Fault::PieceMissing {
        pieces.instances.retain(|instance| instance.name != "-y 0");
    }
    settle(0.03, |samples| {
        [(&whole, 1), (&pieces, 2)].map(|(scene, seed)| mean_of(&texels(&bake(scene, samples / 8, seed), "-y")))
    })
}

#[test]
fn a_floor_in_pieces() {
    holds(4, sketches(&[Shell::Closed], INDOORS), |sketch| in_pieces(sketch, Fault::None));
}

#[test]
fn a_floor_with_a_hole_is_found() {
    let search = Search { cases: 8, shrinks: 4 };
    finds(search, sketches(&[Shell::Closed], INDOORS), |sketch| in_pieces(sketch, Fault::PieceMissing));
}

/// A black floor ends every path, so that what is left of it is where it blocks. That does not change where it is cut,
/// and nothing else changes a bit.
#[test]
fn what_a_black_floor_in_pieces_leaves_alone() {
    holds(24, sketches(SHELLS, ALL), |sketch| {
        let sketch = Sketch { walls: [sketch.walls[0], sketch.walls[1], 0, 5, 5, 5], ..sketch.clone() };
        let [whole, pieces] = [sketch.scene(), floor_in_pieces(&sketch)].map(|scene| bake(&scene, 16, 1));
        for wall in ["-x", "-z", "+z", "block"] {
            let (whole, pieces) = (texels(&whole, wall), texels(&pieces, wall));
            let apart = whole.iter().zip(&pieces).filter(|(a, b)| a != b).count();
            let is_missing = whole.is_empty() && wall != "block";
            if is_missing || whole.len() != pieces.len() || apart > 0 {
                return Err(format!("{apart} of {} texels of {wall} differ", whole.len()));
            }
        }
        Ok(())
    });
}

/// The planted fault of the test before: a floor that lacks a piece changes bits of the walls.
#[test]
fn bits_that_change_are_seen() {
    let search = Search { cases: 2, shrinks: 0 };
    finds(search, sketches(&[Shell::Closed], INDOORS), |sketch| {
        let sketch = Sketch { walls: [5; 6], ..sketch.clone() };
        let scenes = [sketch.scene(), loses_a_piece(sketch.scene())];
        let [whole, pieces] = scenes.map(|scene| texels(&bake(&scene, 16, 1), "-x"));
        if whole == pieces { Ok(()) } else { Err("texels differ".into()) }
    });
}

/// Pieces asked for by density: half the side, half the texels.
#[test]
fn pieces_have_the_texels_of_the_whole() {
    let request = LightmapRequest { density: Some(4.0) };
    holds(2, sketches(&[Shell::Closed], INDOORS), |sketch| {
        let count = |mut scene: Scene| {
            scene.instances.iter_mut().for_each(|instance| {
                instance.lightmap = instance.name.starts_with("-y").then_some(request);
            });
            texels(&bake(&scene, 16, 1), "-y").len()
        };
        let even = Sketch { size: [8, 8, 12], ..sketch.clone() };
        let [whole, pieces] = [count(even.scene()), count(floor_in_pieces(&even))];
        if whole == pieces && whole > 50 { Ok(()) } else { Err(format!("{whole} and {pieces} texels")) }
    });
}

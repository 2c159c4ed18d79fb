//! How processor time grows with what a scene and a bake are made of: texels, triangles, lights and bounces, each varied
//! alone over orders of magnitude. Prints a table for each; asserts nothing. The last column is the power that time
//! follows from one line to the next: 1 is linear, 0 is no growth.
//!
//! `cargo bench --bench growth -- [texels] [triangles] [lights] [bounces]`; ten million triangles take about 6 GB.

#[path = "../tests/common/mod.rs"]
mod common;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, CancelToken, Denoise, Goal, Layout, Lightmap, bake_lightmap};
use bevy_kiln::scene::{Indices, Instance, Mesh, Scene, Topology};
use bevy_kiln::trace::{Tracer, Transport};
use common::glb;
use common::scenes::{SceneBuilder, furnace, grey};
use cpu_time::ProcessTime;
use glam::{Affine3A, Vec2, Vec3};

/// Paths of each texel.
const PATHS: u32 = 64;

/// What was measured at one size.
struct Line {
    /// How much there is of what is varied.
    size: u64,
    /// Processor time of what grows [s].
    seconds: f64,
    /// What else is worth knowing.
    notes: String,
}

fn print(what: &str, grows: &str, lines: impl Iterator<Item = Line>) {
    println!("\n{what:>12}  {grows:>14}  power  ");
    let mut before: Option<Line> = None;
    for line in lines {
        let power = before.map_or_else(String::new, |before| {
            format!("{:5.2}", (line.seconds / before.seconds).ln() / (line.size as f64 / before.size as f64).ln())
        });
        println!("{:12}  {:12.3} s  {power:5}  {}", line.size, line.seconds, line.notes);
        before = Some(line);
    }
}

fn bake(scene: &Scene, layout: Layout, density: f32, transport: Transport) -> Lightmap {
    let goal = Goal::Samples(PATHS);
    let settings = BakeSettings { goal, layout, density, transport, denoise: Denoise::Off, ..BakeSettings::default() };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// The Cornell box in finer and finer maps: all of a bake's time but that of writing files.
fn texels() -> impl Iterator<Item = Line> {
    let scene = glb::load("cornell");
    [32, 64, 128, 256, 512, 1024].into_iter().map(move |size| {
        let clock = ProcessTime::now();
        let report = bake(&scene, Layout::Shared { size }, 1.0, Transport::default()).report;
        let notes = format!("tracing {:.3} s, {} rays", report.cpu_seconds, report.rays);
        Line { size: report.texels, seconds: clock.elapsed().as_secs_f64(), notes }
    })
}

/// A floor of 64 × 64 texels in a valley between mountains of so many triangles, the same whatever their number is. (A
/// cloud of loose triangles would be another matter: a ray crosses as many of its parts as there are along a line, so
/// that time grows with the cube root of their number.)
fn valley(triangles: u64) -> Scene {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-4.0, 0.0, -4.0), [Vec3::Z * 8.0, Vec3::X * 8.0], grey(0.5))
        .sky(Vec3::splat(10.0))
        .build();
    let side = (0.5 * triangles as f32).sqrt().round() as u32;
    let vertex = |index: u32| {
        let [x, z] = [index % (side + 1), index / (side + 1)].map(|along| 80.0 * (along as f32 / side as f32 - 0.5));
        let slope = (x.hypot(z) - 6.0).max(0.0);
        let rocks = (1.1 * x).sin() * (1.3 * z).sin() + 0.3 * (5.0 * x + z).sin() * (4.0 * z - x).sin();
        Vec3::new(x, 0.6 * slope + 0.3 * slope.min(3.0) * rocks - 0.1, z)
    };
    let quad = |index: u32| {
        let a = index / side * (side + 1) + index % side;
        let [b, c, d] = [a + 1, a + side + 2, a + side + 1];
        [a, d, c, a, c, b]
    };
    scene.meshes.push(Mesh {
        name: "mountains".into(),
        topology: Topology::TriangleList,
        positions: (0..(side + 1) * (side + 1)).map(vertex).collect(),
        indices: Indices::U32((0..side * side).flat_map(quad).collect()),
        ..Mesh::default()
    });
    scene.materials.push(grey(0.4));
    scene.instances.push(Instance {
        id: StableId::new("mountains"),
        name: "mountains".into(),
        mesh: scene.meshes.len() - 1,
        material: scene.materials.len() - 1,
        world_from_local: Affine3A::IDENTITY,
        lightmap: None,
    });
    scene
}

/// Time per ray, with that of making the tree told beside it.
fn triangles() -> impl Iterator<Item = Line> {
    [10_000, 100_000, 1_000_000, 10_000_000].into_iter().map(|count| {
        let scene = valley(count);
        let clock = ProcessTime::now();
        let tracer = Tracer::new(&scene);
        let building = clock.elapsed().as_secs_f64();
        drop(tracer);
        let report = bake(&scene, Layout::Shared { size: 64 }, 1.0, Transport::default()).report;
        let notes = format!(
            "for a million rays; {:.3} million rays, tree {:.2} s or {:.2} µs a triangle",
            report.rays as f64 / 1e6,
            building,
            1e6 * building / count as f64,
        );
        Line { size: count, seconds: 1e6 * report.cpu_seconds / report.rays as f64, notes }
    })
}

/// A hall of 40 × 5 × 40 m with so many lamps under its ceiling, which are as bright together whatever their number is.
fn lamps(count: u64) -> Scene {
    let mut hall =
        SceneBuilder::default().room(Vec3::ZERO, Vec3::new(40.0, 5.0, 40.0), std::array::from_fn(|_| grey(0.5)));
    let columns = (count as f32).sqrt().ceil() as u64;
    let step = 40.0 / columns as f32;
    for index in 0..count {
        let [x, z] = [index % columns, index / columns].map(|along| (along as f32 + 0.5) * step);
        let centre = Vec3::new(x, 4.9, z);
        let radiance = Vec3::splat(4e4 / count as f32);
        hall = hall.rect_light(&format!("lamp {index:05}"), centre, Vec3::NEG_Y, Vec2::splat(0.2), radiance);
    }
    hall.build()
}

/// Time per path, and the noise that is left: choosing among more lights by chance can cost error instead of time.
fn lights() -> impl Iterator<Item = Line> {
    [1, 10, 100, 1000, 10_000].into_iter().map(|count| {
        let report = bake(&lamps(count), Layout::Packed, 1.0, Transport::default()).report;
        let seconds = 1e6 * report.cpu_seconds / report.samples as f64;
        let notes =
            format!("for a million paths; standard error {:.2} % in the mean", 100.0 * report.relative_stderr.mean);
        Line { size: count, seconds, notes }
    })
}

/// A closed room whose walls send back nine tenths, with paths cut after so many bounces, and in the end by roulette
/// alone, which nothing but the guard of 2¹⁶ surfaces caps.
fn bounces() -> impl Iterator<Item = Line> {
    let scene = furnace(0.9);
    [Some(1), Some(2), Some(4), Some(8), Some(16), Some(32), Some(64), Some(128), None].into_iter().map(move |cap| {
        let transport = Transport { max_bounces: cap, ..Transport::default() };
        let report = bake(&scene, Layout::Packed, 16.0, transport).report;
        let notes = format!(
            "{} for a million paths of {:.1} rays",
            if cap.is_some() { "cap;" } else { "no cap but roulette;" },
            report.rays as f64 / report.samples as f64
        );
        let seconds = 1e6 * report.cpu_seconds / report.samples as f64;
        Line { size: cap.map_or(1 << 16, u64::from), seconds, notes }
    })
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let is_wanted = |what: &str| words.is_empty() || words.iter().any(|word| word == what);
    if is_wanted("texels") {
        print("texels", "cpu time", texels());
    }
    if is_wanted("triangles") {
        print("triangles", "cpu time", triangles());
    }
    if is_wanted("lights") {
        print("lights", "cpu time", lights());
    }
    if is_wanted("bounces") {
        print("bounces", "cpu time", bounces());
    }
}

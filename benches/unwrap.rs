//! What an unwrap takes, from a thousand to a million triangles: time, and the most memory held at once.
//!
//! `cargo bench --no-default-features --features bake --bench unwrap` prints a table; a number behind it is the largest
//! count of triangles, a word picks the meshes whose name has it. Time is the processor's, of all threads together, so
//! that what else the machine does hardly matters; memory is counted at each allocation, so that it is exact for one
//! thread. The scene itself counts in neither.

#![allow(unsafe_code, reason = "an allocator that counts must be one")]

#[allow(dead_code, reason = "the tests use all of it")]
#[path = "../tests/unwrap/shapes.rs"]
mod shapes;

extern crate bevy_kiln;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, CancelToken, unwrap_meshes};
use bevy_kiln::scene::{Instance, LightmapRequest, Material, Mesh, Scene};
use cpu_time::ProcessTime;
use glam::{Affine3A, Vec2, Vec3};
use std::alloc::{GlobalAlloc, Layout, System};
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Triangles of the meshes.
const COUNTS: [f64; 4] = [1e3, 1e4, 1e5, 1e6];

/// A family of meshes by how many triangles they should have.
type Family = (&'static str, fn(f64) -> Mesh);

const FAMILIES: [Family; 8] = [
    ("sphere", |count| shapes::sphere(count.sqrt() as u32, (count.sqrt() / 2.0) as u32)),
    ("torus", |count| shapes::torus(count.sqrt() as u32, (count.sqrt() / 2.0) as u32)),
    ("bumpy ball", |count| shapes::bumpy(count.sqrt() as u32, (count.sqrt() / 2.0) as u32)),
    ("terrain", |count| shapes::terrain((count / 2.0).sqrt() as u32)),
    ("box", |count| shapes::cuboid("box", Vec3::ZERO, Vec3::ONE, (count / 12.0).sqrt() as u32)),
    ("crates", |count| shapes::crates((count / 600.0).ceil() as u64, 7)),
    ("clutter", |count| shapes::clutter((count / 2.0) as u64)),
    ("own UV1", |count| {
        shapes::with_uv1(shapes::terrain((count / 2.0).sqrt() as u32), |_, at| Vec2::new(at.x, at.z) / 20.0)
    }),
];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let most = arguments.iter().find_map(|argument| argument.parse::<f64>().ok()).unwrap_or(1e6);
    let wanted = arguments.iter().find(|argument| argument.parse::<f64>().is_err());
    println!(
        "{:>10} {:>9} {:>8} {:>10} {:>9} {:>10}",
        "mesh", "triangles", "charts", "time [s]", "µs each", "bytes each"
    );
    for (name, family) in FAMILIES.into_iter().filter(|(name, _)| wanted.is_none_or(|wanted| name.contains(wanted))) {
        for count in COUNTS.into_iter().filter(|count| *count <= most) {
            measure(name, family(count));
        }
    }
}

fn measure(name: &str, mesh: Mesh) {
    let triangles = mesh.triangles().count() as f64;
    let scene = scene(mesh);
    // One thread: what several hold at once goes by when they run.
    let settings = BakeSettings { density: 16.0, threads: NonZeroUsize::new(1), ..BakeSettings::default() };
    let before = LIVE.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let clock = ProcessTime::now();
    let meshes = unwrap_meshes(&scene, &settings, &CancelToken::default()).expect("nothing stops it");
    let seconds = clock.elapsed().as_secs_f64();
    let bytes = (PEAK.load(Ordering::Relaxed) - before) as f64 / triangles;
    let charts = meshes.first().map_or("none".to_owned(), |mesh| mesh.charts.to_string());
    let each = 1e6 * seconds / triangles;
    println!("{name:>10} {triangles:>9} {charts:>8} {seconds:>10.3} {each:>9.2} {bytes:>10.0}");
}

fn scene(mesh: Mesh) -> Scene {
    let instance = Instance {
        id: StableId::new("one"),
        name: "one".into(),
        mesh: 0,
        material: 0,
        world_from_local: Affine3A::IDENTITY,
        lightmap: Some(LightmapRequest::default()),
    };
    let materials = vec![Material::diffuse("grey", Vec3::splat(0.5))];
    Scene { meshes: vec![mesh], materials, instances: vec![instance], ..Scene::default() }
}

/// Bytes that are allocated.
static LIVE: AtomicUsize = AtomicUsize::new(0);

/// The most that were allocated at once.
static PEAK: AtomicUsize = AtomicUsize::new(0);

/// The system's allocator, counted.
struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

impl Counting {
    fn add(size: usize) {
        let live = LIVE.fetch_add(size, Ordering::Relaxed) + size;
        PEAK.fetch_max(live, Ordering::Relaxed);
    }
}

// SAFETY: every call goes on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::add(layout.size());
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::add(layout.size());
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Old and new may live side by side while bytes are copied.
        Self::add(size);
        LIVE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

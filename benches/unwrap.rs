//! What an unwrap takes, from a thousand to a million triangles: time, and the most memory held at once.
//!
//! `cargo bench --no-default-features --features bake --bench unwrap` prints a table; a number behind it is the largest
//! count of triangles. Memory is the kernel's own count of resident pages and is told on Linux only.

#[allow(dead_code, reason = "the tests use all of it")]
#[path = "../tests/unwrap/shapes.rs"]
mod shapes;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, CancelToken, unwrap_meshes};
use bevy_kiln::scene::{Instance, LightmapRequest, Material, Mesh, Scene};
use glam::{Affine3A, Vec3};
use std::time::Instant;

/// Triangles of the meshes.
const COUNTS: [f64; 4] = [1e3, 1e4, 1e5, 1e6];

/// A family of meshes by how many triangles they should have.
type Family = (&'static str, fn(f64) -> Mesh);

const FAMILIES: [Family; 6] = [
    ("sphere", |count| shapes::sphere((count.sqrt()) as u32, (count.sqrt() / 2.0) as u32)),
    ("torus", |count| shapes::torus((count.sqrt()) as u32, (count.sqrt() / 2.0) as u32)),
    ("bumpy ball", |count| shapes::bumpy((count.sqrt()) as u32, (count.sqrt() / 2.0) as u32)),
    ("terrain", |count| shapes::terrain((count / 2.0).sqrt() as u32)),
    ("box", |count| shapes::cuboid("box", Vec3::ZERO, Vec3::ONE, (count / 12.0).sqrt() as u32)),
    ("clutter", |count| shapes::clutter((count / 2.0) as u64)),
];

fn main() {
    let most = std::env::args().skip(1).find_map(|argument| argument.parse::<f64>().ok()).unwrap_or(1e6);
    println!(
        "{:>10} {:>9} {:>8} {:>10} {:>9} {:>10}",
        "mesh", "triangles", "charts", "time [s]", "µs each", "bytes each"
    );
    for (name, family) in FAMILIES {
        for count in COUNTS.into_iter().filter(|count| *count <= most) {
            let mesh = family(count);
            let triangles = mesh.triangles().count() as f64;
            let scene = scene(mesh);
            // So many texels that a page is about full, whatever the size.
            let settings = BakeSettings { density: 16.0, ..BakeSettings::default() };
            let before = reset_peak();
            let clock = Instant::now();
            let meshes = unwrap_meshes(&scene, &settings, &CancelToken::default()).expect("nothing stops it");
            let seconds = clock.elapsed().as_secs_f64();
            let bytes = peak().zip(before).map(|(peak, before)| (peak - before) / triangles);
            let bytes = bytes.map_or("-".to_owned(), |bytes| format!("{bytes:.0}"));
            let charts = meshes.first().map_or("none".to_owned(), |mesh| mesh.charts.to_string());
            let each = 1e6 * seconds / triangles;
            println!("{name:>10} {triangles:>9} {charts:>8} {seconds:>10.3} {each:>9.2} {bytes:>10}");
        }
    }
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

/// The most memory that was resident since the last reset [bytes].
fn peak() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024.0 * line.split_whitespace().next()?.parse::<f64>().ok()?)
}

/// Starts counting anew; gives what is resident now.
fn reset_peak() -> Option<f64> {
    std::fs::write("/proc/self/clear_refs", "5").ok()?;
    peak()
}

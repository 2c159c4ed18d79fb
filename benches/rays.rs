//! Rays per second of processor time on one thread: nearest hit and any hit, for rays of neighbouring pixels and for
//! rays that leave surfaces in all directions, 64 from each point. Million rays a second = elements a second / 10⁶.

mod hall;

#[path = "../tests/common/glb.rs"]
mod glb;

use bevy_kiln::math::{Frame, combine, square_to_cosine_hemisphere};
use bevy_kiln::trace::Tracer;
use cpu_time::ThreadTime;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{Vec2, Vec3};
use std::hint::black_box;
use std::time::Duration;

/// Rays of one pass, per kind: a picture of 256 × 256, or 1024 points with 64 rays each.
const RAYS: u64 = 65_536;

/// Where a picture is taken from, looking at `target`, and what lights the scene.
struct View {
    name: &'static str,
    tracer: Tracer,
    eye: Vec3,
    target: Vec3,
    /// Shadow rays go there.
    lamp: Vec3,
    /// How far segments reach [m].
    reach: f32,
}

#[derive(Clone, Copy)]
struct Ray {
    origin: Vec3,
    direction: Vec3,
}

fn views() -> [View; 2] {
    [
        View {
            name: "cornell",
            tracer: Tracer::new(&glb::load("cornell")),
            eye: Vec3::new(2.78, 2.73, -8.0),
            target: Vec3::new(2.78, 2.73, 0.0),
            lamp: Vec3::new(2.78, 5.4, 2.79),
            reach: 6.0,
        },
        View {
            name: "hall",
            tracer: Tracer::new(&hall::hall()),
            eye: Vec3::new(1.0, 2.0, -22.0),
            target: Vec3::new(0.0, 3.5, 0.0),
            lamp: Vec3::new(9.0, 2.5, 8.0),
            reach: 20.0,
        },
    ]
}

/// Numbers in [0, 1) that belong to `index`.
fn square(seed: u64, index: u64) -> Vec2 {
    let bits = combine(seed, index);
    Vec2::new((bits >> 40) as f32, (bits & 0xff_ffff) as f32) / 16_777_216.0
}

impl View {
    /// Rays through the pixels of a square picture, row by row; the field of view is about 39°.
    fn camera(&self, side: u32) -> Vec<Ray> {
        let frame = Frame::new((self.target - self.eye).normalize());
        let pixels = (0..side).flat_map(|y| (0..side).map(move |x| Vec2::new(x as f32, y as f32)));
        let direction = |pixel: Vec2| {
            let plane = (pixel + 0.5) / side as f32 * 0.72 - 0.36;
            frame.world_from_local(plane.extend(1.0).normalize())
        };
        pixels.map(|pixel| Ray { origin: self.eye, direction: direction(pixel) }).collect()
    }

    /// Where these rays end, a little before the surface, and the surface's normal on their side.
    fn surface(&self, rays: &[Ray]) -> Vec<(Vec3, Vec3)> {
        let end = |ray: &Ray| {
            let hit = self.tracer.closest_hit(ray.origin, ray.direction)?;
            let normal = if hit.normal.dot(ray.direction) > 0.0 { -hit.normal } else { hit.normal };
            Some((ray.origin + ray.direction * hit.distance + normal * 1e-4, normal))
        };
        rays.iter().filter_map(end).collect()
    }

    /// 64 rays in all directions from each of 1024 points, point after point.
    fn diffuse(&self) -> Vec<Ray> {
        let points = self.surface(&self.camera(32));
        let ray = |index: u64| {
            let (origin, normal) = points[(index / 64) as usize % points.len()];
            let local = square_to_cosine_hemisphere(square(1, index));
            Ray { origin, direction: Frame::new(normal).world_from_local(local) }
        };
        (0..RAYS).map(ray).collect()
    }

    /// Segments from what the camera sees to the lamp.
    fn shadows(&self) -> Vec<[Vec3; 2]> {
        let points = self.surface(&self.camera(256));
        (0..RAYS as usize).map(|index| [points[index % points.len()].0, self.lamp]).collect()
    }

    /// Segments of all lengths along the diffuse rays.
    fn diffuse_segments(&self) -> Vec<[Vec3; 2]> {
        let end = |(index, ray): (usize, Ray)| ray.origin + ray.direction * (self.reach * square(2, index as u64).x);
        self.diffuse().into_iter().enumerate().map(|(index, ray)| [ray.origin, end((index, ray))]).collect()
    }
}

/// Processor time of so many passes: who else uses the machine does not count.
fn timed(count: u64, pass: impl Fn() -> usize) -> Duration {
    let clock = ThreadTime::now();
    for _ in 0..count {
        black_box(pass());
    }
    clock.elapsed()
}

fn rays(criterion: &mut Criterion) {
    for view in views() {
        let mut group = criterion.benchmark_group(view.name);
        group.throughput(Throughput::Elements(RAYS)).sample_size(10);
        group.warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(3));
        for (name, rays) in [("camera", view.camera(256)), ("diffuse", view.diffuse())] {
            let nearest = || rays.iter().filter_map(|ray| view.tracer.closest_hit(ray.origin, ray.direction)).count();
            assert!(nearest() > rays.len() / 4, "{}: {} of the {name} rays hit", view.name, nearest());
            group.bench_function(format!("closest/{name}"), |bencher| {
                bencher.iter_custom(|count| timed(count, nearest))
            });
        }
        for (name, segments) in [("camera", view.shadows()), ("diffuse", view.diffuse_segments())] {
            let visible = || segments.iter().filter(|[from, to]| view.tracer.is_visible(*from, *to)).count();
            let share = visible() as f64 / segments.len() as f64;
            assert!((0.05..0.95).contains(&share), "{}: {share} of the {name} segments are free", view.name);
            group.bench_function(format!("any/{name}"), |bencher| bencher.iter_custom(|count| timed(count, visible)));
        }
    }
}

criterion_group!(benches, rays);
criterion_main!(benches);

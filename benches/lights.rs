//! What it costs to choose a light and a point on it, over 10, 100, 1000 and 10 000 lights of one room, in processor
//! time on one thread. Nanoseconds per choice = time / [`CHOICES`].

use bevy_kiln::artefact::StableId;
use bevy_kiln::math::combine;
use bevy_kiln::scene::{Light, PointLight, RectLight, Scene};
use bevy_kiln::trace::Tracer;
use cpu_time::ThreadTime;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{Affine3A, Vec2, Vec3};
use std::hint::black_box;
use std::time::Duration;

/// Choices of one pass.
const CHOICES: u64 = 16_384;

/// Numbers in [0, 1) that belong to `index`.
fn numbers(seed: u64, index: u64) -> Vec3 {
    let bits = combine(seed, index);
    Vec3::new((bits >> 43) as f32, (bits >> 22 & 0x1f_ffff) as f32, (bits & 0x1f_ffff) as f32) / 2_097_152.0
}

/// A hall of 40 × 10 × 40 m with so many lamps in it: bulbs and panels.
fn hall(count: u64) -> Tracer {
    let light = |index: u64| {
        let (id, name) = (StableId::new(format!("{index:05}")), format!("lamp {index}"));
        let position = numbers(1, index) * Vec3::new(40.0, 6.0, 40.0) + Vec3::Y * 4.0;
        if index.is_multiple_of(2) {
            let intensity = Vec3::splat(1.0 + numbers(2, index).x);
            Light::Point(PointLight { id, name, position, intensity, radius: 0.05, range: None })
        } else {
            let turn = glam::Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2 + numbers(3, index).x);
            let world_from_local = Affine3A::from_rotation_translation(turn, position);
            let radiance = Vec3::splat(10.0);
            Light::Rect(RectLight { id, name, world_from_local, width: 0.3, height: 0.2, radiance, range: None })
        }
    };
    let scene = Scene { lights: (0..count).map(light).collect(), ..Scene::default() };
    assert_eq!(scene.validate(), []);
    Tracer::new(&scene)
}

/// How many of the choices find a light that shines.
fn choose(tracer: &Tracer) -> u64 {
    let aims = |index: u64| {
        let (place, u) = (numbers(4, index), numbers(5, index));
        let position = place * Vec3::new(40.0, 4.0, 40.0);
        tracer.aim(position, Vec3::Y, u.x, Vec2::new(u.y, u.z)).is_some()
    };
    (0..CHOICES).filter(|&index| aims(index)).count() as u64
}

fn lights(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("choose a light");
    group.throughput(Throughput::Elements(CHOICES)).sample_size(10);
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    for count in [1, 10, 100, 1000, 10_000] {
        let tracer = hall(count);
        assert!(choose(&tracer) > CHOICES / 10, "{} of {CHOICES} choices over {count} lights shine", choose(&tracer));
        group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
            bencher.iter_custom(|passes| {
                let clock = ThreadTime::now();
                for _ in 0..passes {
                    black_box(choose(&tracer));
                }
                clock.elapsed()
            });
        });
    }
}

criterion_group!(benches, lights);
criterion_main!(benches);

//! A path tracer for teaching, on nothing of the product but [`Tracer::closest_hit`] and the maps of `math`.
//!
//! It offers what the product leaves out on purpose, because it is slower or wrong: three ways to choose directions,
//! three ways to end a path, and two planted faults. What of it is right is a second opinion on the product, which
//! `tests/course.rs` asks for: it shares the rays and the maps, and neither light sampling, roulette, ray origins nor
//! random numbers.
//!
//! Diffuse surfaces only; light is found by meeting it. A hit does not say what was hit, so a closure tells the
//! surface by the point.

use bevy_kiln::bake::{BakeReport, Picture};
use bevy_kiln::math::{
    Frame, Welford, combine, square_to_cosine_hemisphere, square_to_uniform_hemisphere, square_to_uniform_sphere,
};
use bevy_kiln::scene::Camera;
use bevy_kiln::trace::Tracer;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// How far a ray starts off the surface that it leaves [m]. A length for scenes of a few metres: the product has a
/// bound on the error instead.
const LIFT: f32 = 1e-4;

/// The best chance of survival in roulette.
const MAX_SURVIVAL: f32 = 0.95;

/// A surface at a point.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Share of the light that it reflects.
    pub albedo: Vec3,
    /// Radiance that its front gives off [cd/m²].
    pub radiance: Vec3,
}

/// How a path's next direction is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Directions {
    /// Uniform over the sphere; half of them lie below the surface and bring nothing.
    UniformSphere,
    /// Uniform over the hemisphere.
    UniformHemisphere,
    /// By the cosine to the normal.
    Cosine,
    /// Wrong, too dim: by the cosine, which is then multiplied in once more. Reflects ⅔ of what it should.
    CosineTwice,
    /// Wrong, too bright: by the cosine, but divided by the uniform hemisphere's density. Reflects 4/3.
    WrongDensity,
}

/// How a path ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// After so many bounces.
    Cap(u32),
    /// By chance, survivors weighted by 1/p.
    Roulette,
    /// Wrong, too dim: by chance, survivors not weighted.
    RouletteWithoutWeight,
}

/// A scene with what the teacher must know of it.
pub struct Teacher<'a> {
    /// What rays meet.
    pub tracer: &'a Tracer,
    /// The surface at a point.
    pub patch_at: &'a (dyn Fn(Vec3) -> Patch + Sync),
    /// What a ray that meets nothing brings [cd/m²].
    pub sky: f32,
    /// How directions are chosen.
    pub directions: Directions,
    /// How paths end.
    pub ending: Ending,
}

/// Pseudo-random numbers: one sequence per key.
pub struct Random {
    key: u64,
    count: u64,
}

impl Random {
    /// The sequence that belongs to a key.
    pub fn new(key: u64) -> Self {
        Self { key, count: 0 }
    }

    /// The next number in [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.count += 1;
        (combine(self.key, self.count) >> 40) as f32 / 16_777_216.0
    }

    /// The next point of the unit square.
    pub fn square(&mut self) -> Vec2 {
        Vec2::new(self.unit(), self.unit())
    }
}

impl Directions {
    /// A direction in the surface's frame, and what light from it counts: cos θ / π over the density.
    pub fn sample(self, random: &mut Random) -> (Vec3, f32) {
        let u = random.square();
        match self {
            Self::UniformSphere => {
                let wi = square_to_uniform_sphere(u);
                (wi, 4.0 * wi.z.max(0.0))
            }
            Self::UniformHemisphere => {
                let wi = square_to_uniform_hemisphere(u);
                (wi, 2.0 * wi.z)
            }
            Self::Cosine => (square_to_cosine_hemisphere(u), 1.0),
            Self::CosineTwice => {
                let wi = square_to_cosine_hemisphere(u);
                (wi, wi.z)
            }
            Self::WrongDensity => {
                let wi = square_to_cosine_hemisphere(u);
                (wi, 2.0 * wi.z)
            }
        }
    }
}

impl Ending {
    /// The weight of a path that goes on from this bounce on a surface of this albedo; `None` if it ends.
    fn go_on(self, bounce: u32, albedo: Vec3, random: &mut Random) -> Option<f32> {
        let survival = albedo.max_element().min(MAX_SURVIVAL);
        match self {
            Self::Cap(bounces) => (bounce < bounces).then_some(1.0),
            Self::Roulette => (random.unit() < survival).then(|| survival.recip()),
            Self::RouletteWithoutWeight => (random.unit() < survival).then_some(1.0),
        }
    }
}

/// ∫₀² 3 sin x dx, the course's worked example: one sample by a uniform x. A cap keeps every sample; roulette keeps it
/// with the chance `survival`.
pub fn integral_sample(ending: Ending, survival: f64, random: &mut Random) -> f64 {
    let value = 6.0 * (2.0 * f64::from(random.unit())).sin();
    match ending {
        Ending::Cap(_) => value,
        _ if f64::from(random.unit()) >= survival => 0.0,
        Ending::Roulette => value / survival,
        Ending::RouletteWithoutWeight => value,
    }
}

impl Teacher<'_> {
    /// One sample of the radiance that arrives against `direction` at `origin` [cd/m²].
    pub fn radiance(&self, mut origin: Vec3, mut direction: Vec3, random: &mut Random) -> Vec3 {
        let (mut sum, mut throughput) = (Vec3::ZERO, Vec3::ONE);
        for bounce in 0.. {
            let Some(hit) = self.tracer.closest_hit(origin, direction) else {
                return sum + throughput * self.sky;
            };
            let point = origin + direction * hit.distance;
            let is_front = hit.normal.dot(direction) < 0.0;
            let normal = if is_front { hit.normal } else { -hit.normal };
            let patch = (self.patch_at)(point);
            if is_front {
                sum += throughput * patch.radiance;
            }
            let Some(weight) = self.ending.go_on(bounce, patch.albedo, random) else { return sum };
            let (wi, share) = self.directions.sample(random);
            throughput *= patch.albedo * share * weight;
            if throughput == Vec3::ZERO {
                return sum;
            }
            origin = point + normal * LIFT;
            direction = Frame::new(normal).world_from_local(wi);
        }
        sum
    }

    /// The green radiance [cd/m²] that arrives at a point, over all directions alike.
    pub fn inside(&self, point: Vec3, paths: u64, seed: u64) -> Welford {
        moments(paths, seed, |random| {
            let direction = square_to_uniform_sphere(random.square());
            f64::from(self.radiance(point, direction, random).y)
        })
    }

    /// A square picture. Its standard errors are left at zero.
    pub fn picture(&self, camera: &Camera, size: u32, samples: u32, seed: u64) -> Picture {
        let eye = Vec3::from(camera.world_from_camera.translation);
        let half = (0.5 * camera.vertical_fov).tan();
        let pixel = |pixel: u32| {
            let mut random = Random::new(combine(seed, u64::from(pixel)));
            let corner = Vec2::new((pixel % size) as f32, (pixel / size) as f32);
            let mut sum = Vec3::ZERO;
            for _ in 0..samples {
                let place = ((corner + random.square()) * 2.0 / size as f32 - 1.0) * half;
                let towards = Vec3::new(place.x, -place.y, -1.0);
                let direction = camera.world_from_camera.transform_vector3(towards).normalize();
                sum += self.radiance(eye, direction, &mut random);
            }
            sum / samples as f32
        };
        let radiance: Vec<Vec3> = (0..size * size).into_par_iter().map(pixel).collect();
        let stderr = vec![Vec3::ZERO; radiance.len()];
        Picture { width: size, height: size, radiance, stderr, report: BakeReport::default() }
    }
}

/// Mean and variance of independent paths, whatever the threads do.
pub fn moments(paths: u64, seed: u64, path: impl Fn(&mut Random) -> f64 + Sync) -> Welford {
    let value = |number: u64| path(&mut Random::new(combine(seed, number)));
    let values: Vec<f64> = (0..paths).into_par_iter().map(value).collect();
    values.into_iter().collect()
}

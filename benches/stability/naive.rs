//! Their side, as textbooks have it: a path tracer whose rays start a constant length off the surface, and whose paths
//! may be cut after so many bounces. Right in exact arithmetic, as the constant goes to 0 and the cap to infinity.
//!
//! A constant ray bias of 0.0005 scene units is Godot's (`lm_compute.glsl`), one of 0.01 Fyrox's; Godot's cap of
//! bounces is 3 if nothing else is set. Rays are the product's, so that nothing but the two constants differs.

use crate::numbers::Numbers;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::math::{Frame, combine, square_to_cosine_hemisphere};
use bevy_kiln::trace::Tracer;
use glam::Vec2;

/// Godot's ray bias [m].
pub const GODOT_BIAS: f32 = 0.0005;

/// Fyrox's ray bias [m].
pub const FYROX_BIAS: f32 = 0.01;

/// Throughput below which roulette begins, as in the product.
const ROULETTE_THROUGHPUT: f32 = 0.15;

/// When a path ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// By chance, so that no light is lost.
    Roulette,
    /// After so many bounces, as a baker's setting has it.
    Cap(u32),
}

/// A path tracer in rooms of one diffuse albedo whose fronts glow with 1 cd/m².
pub struct PathTracer<'t> {
    pub tracer: &'t Tracer,
    pub albedo: f32,
    /// How far off a surface rays start [m].
    pub bias: f32,
    pub ending: Ending,
}

impl PathTracer<'_> {
    /// Mean irradiance over points, so many paths each [lx].
    pub fn mean_irradiance(&self, points: &[MeterPoint], paths: u32, key: u64) -> f64 {
        let at_point = |(index, point)| {
            let numbers = |path| Numbers::new(combine(key, index), u64::from(path));
            (0..paths).map(|path| f64::from(self.radiance(point, numbers(path)))).sum::<f64>()
        };
        let sum: f64 = (0..).zip(points).map(at_point).sum();
        std::f64::consts::PI * sum / (paths as usize * points.len()) as f64
    }

    /// One sample of E/π at a point [cd/m²].
    fn radiance(&self, point: &MeterPoint, numbers: Numbers) -> f32 {
        let MeterPoint { mut position, mut normal } = *point;
        let (mut throughput, mut radiance) = (1.0_f32, 0.0_f32);
        for bounce in 0.. {
            let [u, v, survive, _] = numbers.draw(bounce);
            let direction = Frame::new(normal).world_from_local(square_to_cosine_hemisphere(Vec2::new(u, v)));
            let origin = position + normal * self.bias;
            let Some(hit) = self.tracer.closest_hit(origin, direction) else { break };
            let is_front = hit.normal.dot(direction) < 0.0;
            if is_front {
                radiance += throughput;
            }
            throughput *= self.albedo;
            let survival = match self.ending {
                Ending::Roulette => (throughput / ROULETTE_THROUGHPUT).min(1.0),
                Ending::Cap(bounces) if bounce >= bounces => 0.0,
                Ending::Cap(_) => 1.0,
            };
            if survive >= survival {
                break;
            }
            throughput /= survival;
            position = origin + direction * hit.distance;
            normal = if is_front { hit.normal } else { -hit.normal };
        }
        radiance
    }
}

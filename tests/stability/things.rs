//! Materials and bodies that several groups of cases use, and a look through a camera.

use crate::common::meter::on_walls;
use crate::common::scenes::{SceneBuilder, glowing};
use crate::judge::{light_by, mean_reads, no_path_was_lost};
use bevy_kiln::bake::{CancelToken, PictureSettings, render_picture};
use bevy_kiln::scene::{Camera, Interior, Material, Scattering, Scene, Standard};
use bevy_kiln::trace::{Estimator, Transport};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// A white surface that scatters in this way.
pub fn of(scattering: Scattering) -> Material {
    Material::scattering("thing", Vec3::ONE, scattering)
}

/// Bevy's material in white.
pub fn standard(standard: Standard) -> Material {
    of(Scattering::Standard(Box::new(standard)))
}

/// Glass that absorbs nothing.
pub const CLEAR: Interior = Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: f32::INFINITY };

/// A white metal, which reflects all.
pub fn metal(perceptual_roughness: f32) -> Material {
    standard(Standard { metallic: 1.0, perceptual_roughness, ..Standard::default() })
}

/// A body of clear glass.
pub fn glass(ior: f32, perceptual_roughness: f32) -> Material {
    let interior = CLEAR;
    standard(Standard { specular_transmission: 1.0, perceptual_roughness, ior, interior, ..Standard::default() })
}

/// Adds a box whose sides face outwards.
pub fn with_box(mut builder: SceneBuilder, name: &str, [low, high]: [Vec3; 2], material: &Material) -> SceneBuilder {
    let size = high - low;
    let [x, y, z] = [Vec3::X * size, Vec3::Y * size, Vec3::Z * size];
    let sides = [(low, [z, y]), (low + x, [y, z]), (low, [x, z]), (low + y, [z, x]), (low, [y, x]), (low + z, [x, y])];
    for (index, (corner, edges)) in sides.into_iter().enumerate() {
        builder = builder.quad(&format!("{name} {index}"), corner, edges, material.clone());
    }
    builder
}

/// A horizontal square of half a side `reach` at a height, facing up (`sign` = 1) or down (−1).
pub fn level(
    builder: SceneBuilder,
    name: &str,
    height: f32,
    [reach, sign]: [f32; 2],
    material: Material,
) -> SceneBuilder {
    let (z, x) = (2.0 * reach * Vec3::Z, 2.0 * reach * Vec3::X);
    let edges = if sign > 0.0 { [z, x] } else { [x, z] };
    builder.quad(name, Vec3::new(-reach, height, -reach), edges, material)
}

/// A closed room of side 2 around the origin whose walls are of albedo ½ and of radiance 1, whatever loses no light
/// may stand in it: E = π everywhere.
pub fn room_of_radiance_one() -> SceneBuilder {
    let side = || glowing(0.5, 0.5);
    SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()])
}

/// Whether E = π on the walls of a furnace of radiance 1, seen by surface samples, which have the least noise there.
pub fn furnace_of_one(scene: &Scene, samples: u32, tolerance: f64) -> Result<(), String> {
    let transport = Transport { estimator: Estimator::Bsdf, ..Transport::default() };
    let readings = light_by(scene, &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), samples, transport)?;
    mean_reads(&readings, PI, tolerance)
}

/// A sphere of triangles: an octahedron, each triangle cut in four `levels` times, facing outwards.
pub fn sphere(centre: Vec3, radius: f32, levels: u32) -> (Vec<Vec3>, Vec<u32>) {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut triangles = Vec::new();
    for (a, b) in [(x, z), (z, -x), (-x, -z), (-z, x)] {
        triangles.extend(
            [[b, a, y], [a, b, -y]]
                .map(|[a, b, c]| if (b - a).cross(c - a).dot(a + b + c) > 0.0 { [a, b, c] } else { [a, c, b] }),
        );
    }
    for _ in 0..levels {
        let cut = |&[a, b, c]: &[Vec3; 3]| {
            let [ab, bc, ca] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.iter().flat_map(cut).collect();
    }
    let positions: Vec<Vec3> = triangles.concat().into_iter().map(|vertex| centre + radius * vertex).collect();
    let indices = (0..positions.len() as u32).collect();
    (positions, indices)
}

/// What one pixel sees, and its standard error; an error if it is no light, or a path was lost.
pub fn seen(scene: &Scene, [eye, target]: [Vec3; 2], samples_per_pixel: u32) -> Result<(DVec3, DVec3), String> {
    let camera = Camera::look_at("eye", eye, target, 1e-6);
    let transport = Transport::default();
    let settings = PictureSettings { transport, width: 1, height: 1, samples_per_pixel, threads: None };
    let picture = render_picture(scene, &camera, &settings, &(), &CancelToken::default());
    let picture = picture.map_err(|error| error.to_string())?;
    no_path_was_lost(&picture.report)?;
    let (radiance, stderr) = (picture.radiance[0], picture.stderr[0]);
    if radiance.is_finite() && stderr.is_finite() && radiance.min_element() >= 0.0 {
        return Ok((radiance.as_dvec3(), stderr.as_dvec3()));
    }
    Err(format!("a pixel of {radiance} ± {stderr}"))
}

/// Whether one pixel sees this, its noise counted in.
pub fn sees(scene: &Scene, look: [Vec3; 2], samples: u32, truth: f64, tolerance: f64) -> Result<(), String> {
    let (radiance, stderr) = seen(scene, look, samples)?;
    let off = (radiance - truth).abs() + 4.0 * stderr;
    if off.max_element() <= tolerance {
        Ok(())
    } else {
        Err(format!("seen {radiance} ± {stderr}, not {truth:.5} ± {tolerance}"))
    }
}

/// Integral of a smooth function over [0, 1] by the midpoint rule.
pub fn integrate(f: impl Fn(f64) -> f64) -> f64 {
    let steps = 100_000;
    (0..steps).map(|i| f((f64::from(i) + 0.5) / f64::from(steps))).sum::<f64>() / f64::from(steps)
}

/// Unpolarised reflectance of a smooth interface (Born and Wolf 1999, § 1.5.2), 1 beyond the critical angle.
pub fn fresnel(cosine: f64, eta: f64) -> f64 {
    let sine_squared = (1.0 - cosine * cosine) / (eta * eta);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    let refracted = (1.0 - sine_squared).sqrt();
    let parallel = (eta * cosine - refracted) / (eta * cosine + refracted);
    let perpendicular = (cosine - eta * refracted) / (cosine + eta * refracted);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

//! A path-traced picture: the reference that a baked scene is held against.

use super::endless::{refuse_endless_paths, spread};
use super::gather::{Estimate, KeyKind, Paths, key};
use super::workers::Workers;
use super::{BakeError, BakeReport, BakeWarning, CancelToken, ProgressSink, Stage};
use crate::math::Portable;
use crate::scene::{Camera, Scene};
use crate::trace::{Compiled, Dimensions, Sampler, Transport};
use glam::{Vec2, Vec3};
use std::num::NonZeroUsize;
use std::time::Instant;

/// What a picture is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureSettings {
    /// How light is followed.
    pub transport: Transport,
    /// Width [pixels].
    pub width: u32,
    /// Height [pixels].
    pub height: u32,
    /// Paths through each pixel; rounded up to a multiple of [`REPLICATES`](super::REPLICATES).
    pub samples_per_pixel: u32,
    /// Threads that trace; `None` for all cores.
    pub threads: Option<NonZeroUsize>,
}

/// A picture in radiance, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width [pixels].
    pub width: u32,
    /// Height [pixels].
    pub height: u32,
    /// Radiance towards the camera, averaged over each pixel [cd/m²].
    pub radiance: Vec<Vec3>,
    /// Its standard error [cd/m²].
    pub stderr: Vec<Vec3>,
    /// What was done.
    pub report: BakeReport,
}

/// Takes a picture of a scene.
///
/// # Errors
///
/// [`BakeError::Settings`] for a size of zero, [`BakeError::KeepsLight`], [`BakeError::Cancelled`].
pub fn render_picture(
    scene: &Scene,
    camera: &Camera,
    settings: &PictureSettings,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Picture, BakeError> {
    let clock = Instant::now();
    let (width, height) = (settings.width, settings.height);
    if width == 0 || height == 0 || width.max(height) > 16384 {
        let reason = "a picture is 1 to 16384 pixels wide and high".to_owned();
        return Err(BakeError::Settings { setting: "size", reason });
    }
    if settings.samples_per_pixel == 0 {
        let reason = "a pixel needs at least one path; ask for 1 or more".to_owned();
        return Err(BakeError::Settings { setting: "spp", reason });
    }
    let workers = Workers::new(settings.threads, progress, cancel)?;
    workers.announce(Stage::Prepare)?;
    let Compiled { tracer, faults, census } = Compiled::for_camera(scene, &settings.transport);
    let eye = Vec3::from(camera.world_from_camera.translation);
    let pixels: Vec<u32> = (0..width * height).collect();
    refuse_endless_paths(scene, &tracer, &settings.transport, |probe, sobol, tally| {
        if let Some(pixel) = spread(&pixels, probe) {
            let middle = Vec2::new((pixel % width) as f32, (pixel / width) as f32) + 0.5;
            let direction = ray_direction(camera, middle, [width, height]);
            tracer.camera_radiance(eye, direction, sobol, &settings.transport, tally);
        }
    })?;
    let work = workers.gather(
        &pixels,
        |&pixel, cancel| {
            let corner = Vec2::new((pixel % width) as f32, (pixel / width) as f32);
            let key = key(KeyKind::Pixel, settings.transport.seed, 0, u64::from(pixel));
            let paths = Paths { key, count: settings.samples_per_pixel, clamp: settings.transport.clamp };
            Estimate::gather(paths, cancel, |sobol, tally| {
                let [u, v, ..] = sobol.draw(Dimensions::Start);
                let direction = ray_direction(camera, corner + Vec2::new(u, v), [width, height]);
                tracer.camera_radiance(eye, direction, sobol, &settings.transport, tally)
            })
        },
        Estimate::relative_stderr,
    )?;
    let warnings = faults.into_iter().map(BakeWarning::from);
    let warnings = warnings.chain(BakeWarning::of_transport(&settings.transport, &census));
    Ok(Picture {
        width,
        height,
        radiance: work.results.iter().map(|estimate| estimate.mean.as_vec3()).collect(),
        stderr: work.results.iter().map(|estimate| estimate.stderr.as_vec3()).collect(),
        report: BakeReport::of(&work, clock.elapsed(), &settings.transport, warnings),
    })
}

/// The unit direction in the world through a place on the picture; its centre is the camera's −Z.
pub(super) fn ray_direction(camera: &Camera, place: Vec2, [width, height]: [u32; 2]) -> Vec3 {
    let half_height = Portable::tan(0.5 * camera.vertical_fov);
    let size = Vec2::new(width as f32, height as f32);
    let centred = (place * 2.0 - size) / size.y * half_height;
    camera.world_from_camera.transform_vector3(Vec3::new(centred.x, -centred.y, -1.0)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_fan_out_from_the_view_direction() {
        let camera = Camera::look_at("c", Vec3::ZERO, Vec3::X, std::f32::consts::FRAC_PI_2);
        let near = |place: Vec2, direction: Vec3| {
            let ray = ray_direction(&camera, place, [200, 100]);
            assert!((ray - direction.normalize()).length() < 1e-6, "{ray} {direction}");
        };
        near(Vec2::new(100.0, 50.0), Vec3::X);
        near(Vec2::new(100.0, 0.0), Vec3::new(1.0, 1.0, 0.0));
        // Right of +X, with +Y up, is +Z.
        near(Vec2::new(200.0, 50.0), Vec3::new(1.0, 0.0, 2.0));
    }
}

//! A picture that is carried on, from few paths per pixel to many. Owns no standard errors: those are `picture`'s.

use super::endless::{refuse_endless_paths, spread};
use super::gather::{KeyKind, key};
use super::picture::ray_direction;
use super::workers::Workers;
use super::{BakeError, CancelToken};
use crate::scene::{Camera, Scene};
use crate::trace::{Compiled, Dimensions, Sampler, Sobol, Tally, Tracer, Transport};
use glam::{DVec3, Vec2, Vec3};
use std::num::NonZeroUsize;

/// Paths between two looks at the cancel switch.
const CANCEL_INTERVAL: u32 = 64;

/// What a picture is taken with.
pub(crate) struct FilmSettings {
    pub(crate) transport: Transport,
    /// Width and height [pixels].
    pub(crate) size: [u32; 2],
    pub(crate) threads: Option<NonZeroUsize>,
}

/// A picture in the making.
pub(crate) struct Film<'a> {
    tracer: Tracer,
    camera: &'a Camera,
    settings: FilmSettings,
    /// Per pixel, row 0 on top [cd/m²].
    sums: Vec<DVec3>,
    /// Paths through each pixel.
    count: u32,
    workers: Workers<'a>,
}

impl<'a> Film<'a> {
    /// Puts the film in.
    ///
    /// # Errors
    ///
    /// [`BakeError::Threads`] and [`BakeError::KeepsLight`].
    pub(crate) fn new(
        scene: &Scene,
        camera: &'a Camera,
        settings: FilmSettings,
        cancel: &'a CancelToken,
    ) -> Result<Self, BakeError> {
        let workers = Workers::new(settings.threads, &(), cancel)?;
        let tracer = Compiled::for_camera(scene, &settings.transport).tracer;
        let pixels = (settings.size[0] * settings.size[1]) as usize;
        let film = Self { tracer, camera, settings, sums: vec![DVec3::ZERO; pixels], count: 0, workers };
        let middles: Vec<u32> = (0..pixels as u32).collect();
        refuse_endless_paths(scene, &film.tracer, &film.settings.transport, |probe, sobol, tally| {
            if let Some(&pixel) = spread(&middles, probe) {
                film.look(film.corner(pixel) + 0.5, sobol, tally);
            }
        })?;
        Ok(film)
    }

    /// Carries it on until each pixel has so many paths.
    pub(crate) fn carry_on(&mut self, count: u32) -> Result<(), BakeError> {
        let pixels: Vec<u32> = (0..self.sums.len() as u32).collect();
        let seed = self.settings.transport.seed;
        let sums = self.workers.gather_quietly(&pixels, |&pixel, cancel| {
            let key = key(KeyKind::Pixel, seed, 0, u64::from(pixel));
            let (mut sum, mut tally) = (self.sums[pixel as usize], Tally::default());
            for index in self.count..count {
                if index % CANCEL_INTERVAL == 0 && cancel.is_cancelled() {
                    return None;
                }
                let sobol = Sobol::new(key, u64::from(index));
                let [u, v, ..] = sobol.draw(Dimensions::Start);
                let value = self.look(self.corner(pixel) + Vec2::new(u, v), &sobol, &mut tally);
                if value.is_finite() && value.min_element() >= 0.0 {
                    sum += value.as_dvec3();
                }
            }
            Some(sum)
        })?;
        self.sums = sums;
        self.count = self.count.max(count);
        Ok(())
    }

    /// Radiance of each pixel, row 0 on top [cd/m²].
    pub(crate) fn radiance(&self) -> Vec<Vec3> {
        self.sums.iter().map(|&sum| (sum / f64::from(self.count.max(1))).as_vec3()).collect()
    }

    fn corner(&self, pixel: u32) -> Vec2 {
        let [width, _] = self.settings.size;
        Vec2::new((pixel % width) as f32, (pixel / width) as f32)
    }

    fn look(&self, place: Vec2, sobol: &Sobol, tally: &mut Tally) -> Vec3 {
        let eye = Vec3::from(self.camera.world_from_camera.translation);
        let direction = ray_direction(self.camera, place, self.settings.size);
        self.tracer.camera_radiance(eye, direction, sobol, &self.settings.transport, tally)
    }
}

//! Pictures by the product, side by side, and how far one lies from another. Traces nothing itself.

use bevy_kiln::bake::{BakeReport, CancelToken, Picture, PictureSettings, render_picture};
use bevy_kiln::math::luminance;
use bevy_kiln::scene::{Camera, Scene};
use bevy_kiln::trace::{Estimator, Transport};
use glam::Vec3;

/// Pixels between pictures in a row.
const GAP: u32 = 2;

/// A picture to be taken.
pub struct Shot<'a> {
    /// Of what.
    pub scene: &'a Scene,
    /// From where.
    pub camera: &'a Camera,
    /// Width and height [pixels].
    pub size: [u32; 2],
    /// Paths through each pixel.
    pub samples: u32,
}

impl Shot<'_> {
    /// Takes it with both kinds of samples.
    pub fn take(&self) -> Picture {
        self.take_by(Estimator::Mis)
    }

    /// Takes it with one kind of samples.
    pub fn take_by(&self, estimator: Estimator) -> Picture {
        self.take_with(Transport { estimator, ..Transport::default() })
    }

    /// Takes it; the scene is known to be sound and the size to be in range.
    pub fn take_with(&self, transport: Transport) -> Picture {
        let [width, height] = self.size;
        let settings = PictureSettings { transport, width, height, samples_per_pixel: self.samples, threads: None };
        render_picture(self.scene, self.camera, &settings, &(), &CancelToken::default())
            .expect("a scene that was built here can be rendered")
    }
}

/// Pictures of one height side by side, on white.
pub fn row(pictures: &[Picture]) -> Picture {
    let height = pictures.iter().map(|picture| picture.height).max().unwrap_or(1);
    let width = pictures.iter().map(|picture| picture.width + GAP).sum::<u32>() - GAP;
    let mut whole = blank(width, height);
    let mut left = 0;
    for picture in pictures {
        for y in 0..picture.height {
            let from = (y * picture.width) as usize;
            let to = (y * width + left) as usize;
            let line = &picture.radiance[from..from + picture.width as usize];
            whole.radiance[to..to + line.len()].copy_from_slice(line);
        }
        left += picture.width + GAP;
    }
    whole
}

/// Every pixel `times` as wide and high.
pub fn enlarge(picture: &Picture, times: u32) -> Picture {
    let mut large = blank(picture.width * times, picture.height * times);
    let width = large.width;
    for (index, pixel) in large.radiance.iter_mut().enumerate() {
        let (x, y) = (index as u32 % width / times, index as u32 / width / times);
        *pixel = picture.radiance[(y * picture.width + x) as usize];
    }
    large
}

/// Root mean square difference of the pixels' luminance over the reference's mean luminance.
pub fn rms_error(picture: &Picture, reference: &Picture) -> f64 {
    let pairs = picture.radiance.iter().zip(&reference.radiance);
    let squares: f64 = pairs.map(|(&a, &b)| (luminance(a) - luminance(b)).powi(2)).sum();
    (squares / reference.radiance.len() as f64).sqrt() / mean_luminance(reference)
}

/// Mean over the pixels [cd/m²].
pub fn mean_luminance(picture: &Picture) -> f64 {
    picture.radiance.iter().map(|&radiance| luminance(radiance)).sum::<f64>() / picture.radiance.len() as f64
}

/// The slope of the straight line through the logarithms of (samples, error): −½ for independent samples.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(n, error)| (n.ln(), error.ln())).collect();
    let count = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|log| log.0), mean(|log| log.1));
    let covariance: f64 = logs.iter().map(|log| (log.0 - x) * (log.1 - y)).sum();
    covariance / logs.iter().map(|log| (log.0 - x).powi(2)).sum::<f64>()
}

fn blank(width: u32, height: u32) -> Picture {
    let pixels = (width * height) as usize;
    // Brighter than any exposure's white.
    let radiance = vec![Vec3::splat(1e6); pixels];
    Picture { width, height, radiance, stderr: vec![Vec3::ZERO; pixels], report: BakeReport::default() }
}

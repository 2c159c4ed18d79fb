//! Small pictures of the scene after more and more paths.

use super::StudySettings;
use super::budget::Budget;
use super::view::whole_view;
use crate::bake::{BakeError, CancelToken, Film, FilmSettings};
use crate::scene::Scene;
use crate::trace::{Tracer, Transport};
use glam::Vec3;
use std::time::Instant;

/// Width and height of each picture [pixels].
pub const PICTURE_SIZE: u32 = 96;

/// Weight of the pictures.
pub(super) const WEIGHT: f64 = 26.0;

/// Paths through each pixel.
const COUNTS: [u32; 5] = [10, 100, 1000, 10_000, 100_000];

/// Paths through each pixel between two looks at the clock, as a share of those so far.
const STEP: f64 = 0.25;

/// A small picture.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyPicture {
    /// Paths through each pixel.
    pub samples: u32,
    /// [`PICTURE_SIZE`] rows of as many pixels, row 0 on top [cd/m²].
    pub radiance: Vec<Vec3>,
}

/// Pictures of one view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strip {
    /// The camera, or how the view was found.
    pub camera: String,
    /// From few paths to many; each carries on the one before.
    pub pictures: Vec<StudyPicture>,
}

/// Takes the pictures that there is time for, and says which there was none for.
pub(super) fn strip(
    scene: &Scene,
    tracer: &Tracer,
    settings: &StudySettings,
    budget: &mut Budget<'_>,
    cancel: &CancelToken,
) -> Result<(Strip, Vec<String>), BakeError> {
    let part = budget.part("pictures", WEIGHT, 1.0);
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| whole_view(scene, tracer));
    let transport = Transport { estimator: crate::trace::Estimator::Mis, ..settings.bake.transport };
    let film = FilmSettings { transport, size: [PICTURE_SIZE; 2], threads: settings.bake.threads };
    let mut film = Film::new(scene, &camera, film, cancel)?;
    let (mut pictures, mut taken) = (Vec::new(), 0);
    let clock = Instant::now();
    for count in COUNTS {
        let per_path = clock.elapsed().as_secs_f64() / f64::from(taken.max(1));
        let is_affordable = taken == 0 || part.has_room(f64::from(count - taken) * per_path);
        if count > part.most() || !is_affordable {
            break;
        }
        // The first picture is taken however busy the machine is.
        while taken < count && (taken == 0 || part.goes_on()) {
            taken = count.min(taken + ((STEP * f64::from(taken)) as u32).max(COUNTS[0]));
            film.carry_on(taken)?;
            part.report(f64::from(taken) / f64::from(COUNTS[COUNTS.len() - 1].min(part.most())));
        }
        if taken < count {
            break;
        }
        pictures.push(StudyPicture { samples: count, radiance: film.radiance() });
    }
    let missing: Vec<String> = COUNTS[pictures.len()..].iter().map(u32::to_string).collect();
    let left_out = (!missing.is_empty()).then(|| {
        format!("Pictures of {} samples per pixel are left out: they would have taken too long.", missing.join(", "))
    });
    Ok((Strip { camera: camera.name, pictures }, left_out.into_iter().collect()))
}

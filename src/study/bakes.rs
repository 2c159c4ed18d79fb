//! Whole bakes, read at the receivers: denoised and repaired ones of more and more paths, and as measured ones that
//! were asked for smaller and smaller errors.

use super::StudySettings;
use super::budget::Part;
use super::curve::{Snapshot, Trail};
use super::technique::Technique;
use crate::bake::{
    BakeError, BakeSettings, CancelToken, Denoise, Goal, Lightmap, Progress, Receivers, Stage, bake_lightmap,
};
use crate::math::luminance;
use crate::scene::Scene;
use cpu_time::ProcessTime;
use std::sync::Mutex;
use std::time::Instant;

/// Paths per texel of the first bake, and how many times as many each further one has, at most about.
const FIRST: u32 = 16;
const GROWTH: u32 = 4;

/// Errors that are asked for.
const ERRORS: [f64; 9] = [1.0, 0.5, 0.25, 0.13, 0.07, 0.035, 0.018, 0.009, 0.0045];

/// What is baked, and where it is read.
pub(super) struct Studied<'a> {
    pub(super) scene: &'a Scene,
    pub(super) receivers: &'a Receivers<'a>,
}

/// What a person is told.
pub(super) fn name(technique: Technique) -> &'static str {
    match technique {
        Technique::Denoised => "denoised bakes",
        Technique::Shared => "bakes of shared paths",
        _ => "bakes to an error",
    }
}

/// Bakes with more and more paths as long as there is time for the next.
pub(super) fn bakes(
    studied: &Studied<'_>,
    technique: Technique,
    settings: &StudySettings,
    part: &Part<'_>,
    cancel: &CancelToken,
) -> Result<Trail, BakeError> {
    let mut snapshots: Vec<Snapshot> = Vec::new();
    let (mut paths, mut seconds) = (FIRST, 0.0);
    let mut errors = ERRORS.into_iter();
    while paths <= part.most() && (snapshots.is_empty() || part.has_room(f64::from(GROWTH) * seconds)) {
        part.report(f64::from(paths) / f64::from(part.most()));
        let bake = match (technique, errors.next()) {
            (Technique::Denoised, _) => {
                BakeSettings { goal: Goal::Samples(paths), denoise: Denoise::BuiltIn, ..settings.bake.clone() }
            }
            (Technique::Shared, _) => {
                BakeSettings { goal: Goal::Samples(paths), denoise: Denoise::Off, ..settings.bake.clone() }
            }
            (_, Some(error)) => {
                BakeSettings { goal: Goal::Error(error), denoise: Denoise::Off, ..settings.bake.clone() }
            }
            (_, None) => break,
        };
        let clock = Instant::now();
        let (lightmap, cpu_seconds) = bake_and_time(studied.scene, &bake, cancel)?;
        seconds = clock.elapsed().as_secs_f64();
        let value = |[page, index]: [u32; 2]| {
            let (page, index) = (&lightmap.pages[page as usize], index as usize);
            luminance(if technique == Technique::Denoised { page.radiance[index] } else { page.raw[index] })
        };
        let means = studied.receivers.places().map(value).collect();
        // In the mean, where texels have as many as they need.
        let taken = (lightmap.report.samples / lightmap.report.texels.max(1)) as u32;
        if snapshots.last().is_none_or(|last| taken > last.paths) {
            snapshots.push(Snapshot { paths: taken, cpu_seconds, means, variances: Vec::new() });
        }
        paths = taken.max(FIRST).saturating_mul(GROWTH);
    }
    Ok(Trail { technique, snapshots })
}

/// One bake, and the processor time of tracing and repairing it [s].
fn bake_and_time(scene: &Scene, settings: &BakeSettings, cancel: &CancelToken) -> Result<(Lightmap, f64), BakeError> {
    let repair: Mutex<Option<ProcessTime>> = Mutex::new(None);
    let listen = |progress: Progress| {
        if progress.stage == Stage::Repair
            && let Ok(mut began) = repair.lock()
        {
            began.get_or_insert_with(ProcessTime::now);
        }
    };
    let lightmap = bake_lightmap(scene, settings, &listen, cancel)?;
    let began = repair.lock().ok().and_then(|began| *began);
    let repair = began.map_or(0.0, |began| began.elapsed().as_secs_f64());
    let seconds = lightmap.report.cpu_seconds + repair;
    Ok((lightmap, seconds))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{box_of_light, settings};
    use super::*;
    use crate::trace::{Sharing, Transport};

    /// Receivers are measured as a bake measures its texels.
    #[test]
    fn receivers_are_texels_of_the_bake() {
        let (scene, cancel) = (box_of_light(), CancelToken::default());
        let settings = settings(64);
        let receivers = Receivers::new(&scene, &settings.bake, 50, &cancel).unwrap();
        let manner = Technique::Mis.manner(&settings);
        let mut sums = receivers.sums(0);
        for count in [16, 48, 64] {
            receivers.carry_on(receivers.tracer(), &manner, &mut sums, count).unwrap();
        }
        let transport = Transport { sharing: Sharing::Alone, ..settings.bake.transport };
        let bake = BakeSettings { goal: Goal::Samples(64), transport, ..settings.bake };
        let (lightmap, _) = bake_and_time(&scene, &bake, &cancel).unwrap();
        assert!(receivers.count() >= 45);
        for (sums, [page, index]) in sums.iter().zip(receivers.places()) {
            let page = &lightmap.pages[page as usize];
            let baked = luminance(page.raw[index as usize]);
            assert!((sums.mean() - baked).abs() <= 1e-6 * baked, "{} {baked}", sums.mean());
        }
        let mut others = receivers.sums(1);
        receivers.carry_on(receivers.tracer(), &manner, &mut others, 64).unwrap();
        assert!(others.iter().zip(&sums).all(|(other, sums)| other.mean() != sums.mean()), "other numbers");
    }
}

//! Whole bakes, denoised and repaired, read at the receivers.

use super::StudySettings;
use super::budget::Budget;
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

/// Paths per texel of the first bake, and how many times as many each further one has.
const FIRST: u32 = 16;
const GROWTH: u32 = 4;

/// Bakes with more and more paths as long as there is time for the next.
pub(super) fn bakes(
    scene: &Scene,
    receivers: &Receivers<'_>,
    settings: &StudySettings,
    budget: &mut Budget<'_>,
    cancel: &CancelToken,
) -> Result<Trail, BakeError> {
    let technique = Technique::Denoised;
    let part = budget.part("denoised bakes", technique.weight(), 1.0);
    let mut snapshots: Vec<Snapshot> = Vec::new();
    let (mut paths, mut seconds) = (FIRST, 0.0);
    while paths <= part.most() && (snapshots.is_empty() || part.has_room(f64::from(GROWTH) * seconds)) {
        part.report(f64::from(paths) / f64::from(part.most()));
        let clock = Instant::now();
        let (lightmap, cpu_seconds) = bake(scene, paths, &settings.bake, cancel)?;
        seconds = clock.elapsed().as_secs_f64();
        let value = |[page, index]: [u32; 2]| luminance(lightmap.pages[page as usize].radiance[index as usize]);
        let means = receivers.places().map(value).collect();
        snapshots.push(Snapshot { paths, cpu_seconds, means, variances: Vec::new() });
        paths = paths.saturating_mul(GROWTH);
    }
    Ok(Trail { technique, snapshots })
}

/// One bake, and the processor time of tracing and repairing it [s].
fn bake(
    scene: &Scene,
    paths: u32,
    settings: &BakeSettings,
    cancel: &CancelToken,
) -> Result<(Lightmap, f64), BakeError> {
    let settings = BakeSettings { goal: Goal::Samples(paths), denoise: Denoise::BuiltIn, ..settings.clone() };
    let repair: Mutex<Option<ProcessTime>> = Mutex::new(None);
    let listen = |progress: Progress| {
        if progress.stage == Stage::Repair
            && let Ok(mut began) = repair.lock()
        {
            began.get_or_insert_with(ProcessTime::now);
        }
    };
    let lightmap = bake_lightmap(scene, &settings, &listen, cancel)?;
    let began = repair.lock().ok().and_then(|began| *began);
    let repair = began.map_or(0.0, |began| began.elapsed().as_secs_f64());
    let seconds = lightmap.report.cpu_seconds + repair;
    Ok((lightmap, seconds))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{box_of_light, settings};
    use super::*;
    use crate::trace::Sharing;

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
        let mut alone = settings.bake.clone();
        alone.transport.sharing = Sharing::Alone;
        let (lightmap, _) = bake(&scene, 64, &alone, &cancel).unwrap();
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

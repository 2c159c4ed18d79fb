//! The judges of cases. Each says in a sentence what it saw where it disagrees.

use crate::case::Verdict;
use crate::common::meter::mean;
use crate::worlds::{level_room, room};
use bevy_kiln::bake::{BakeReport, BakeSettings, BakeWarning, CancelToken, Goal, Lightmap};
use bevy_kiln::bake::{MeterPoint, MeterReading, MeterSettings};
use bevy_kiln::bake::{bake_lightmap, measure_irradiance};
use bevy_kiln::math::luminance;
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Transport;
use glam::{DVec3, Vec3};

/// The light at points; an error if any of it is no number, or negative.
pub fn light_at(scene: &Scene, points: &[MeterPoint], samples: u32) -> Result<Vec<MeterReading>, String> {
    light_by(scene, points, samples, Transport::default())
}

/// The same, followed in a certain way.
pub fn light_by(
    scene: &Scene,
    points: &[MeterPoint],
    samples: u32,
    transport: Transport,
) -> Result<Vec<MeterReading>, String> {
    let settings = MeterSettings { transport, samples_per_point: samples, threads: None };
    let measured = measure_irradiance(scene, points, &settings, &(), &CancelToken::default());
    let measured = measured.map_err(|error| error.to_string())?;
    no_path_was_lost(&measured.report)?;
    let readings = measured.readings;
    for (index, reading) in readings.iter().enumerate() {
        if !is_light(reading.irradiance) || !is_light(reading.stderr) {
            return Err(format!("point {index} reads {} ± {}", shown(reading.irradiance), shown(reading.stderr)));
        }
    }
    Ok(readings)
}

/// A lightmap; an error if any of it is no number, or negative.
pub fn baked(scene: &Scene, settings: &BakeSettings) -> Result<Lightmap, String> {
    let lightmap = bake_lightmap(scene, settings, &(), &CancelToken::default()).map_err(|error| error.to_string())?;
    no_path_was_lost(&lightmap.report)?;
    for page in &lightmap.pages {
        for value in page.radiance.iter().chain(&page.raw).chain(&page.stderr) {
            if !is_light(value.as_dvec3()) {
                return Err(format!("a texel of {value}"));
            }
        }
        if let Some(coverage) = page.coverage.iter().find(|coverage| !(0.0..=1.0).contains(*coverage)) {
            return Err(format!("a texel's coverage of {coverage}"));
        }
    }
    Ok(lightmap)
}

/// Whether every path ended by itself and brought light: what is no number is left out of a mean, which would hide it.
pub fn no_path_was_lost(report: &BakeReport) -> Verdict {
    let is_loss =
        |warning: &&BakeWarning| matches!(warning, BakeWarning::NotLight { .. } | BakeWarning::Endless { .. });
    report.warnings.iter().find(is_loss).map_or(Ok(()), |warning| Err(warning.to_string()))
}

fn is_light(value: DVec3) -> bool {
    value.is_finite() && value.min_element() >= 0.0
}

/// Whether a reading is `truth` [lx] to the relative `tolerance`, its own noise counted in, in every channel.
pub fn reads(reading: &MeterReading, truth: f64, tolerance: f64) -> Verdict {
    reads_rgb(reading, DVec3::splat(truth), tolerance)
}

/// The same for a truth with a colour.
pub fn reads_rgb(reading: &MeterReading, truth: DVec3, tolerance: f64) -> Verdict {
    let errors = (reading.irradiance - truth).abs() + 4.0 * reading.stderr;
    if (0..3).all(|channel| errors[channel] <= tolerance * truth[channel]) {
        return Ok(());
    }
    Err(format!("E is {} ± {}, not {} to {tolerance}", shown(reading.irradiance), shown(reading.stderr), shown(truth)))
}

/// Whether all readings are `truth`, as [`reads`].
pub fn all_read(readings: &[MeterReading], truth: f64, tolerance: f64) -> Verdict {
    if readings.is_empty() {
        return Err("nothing was read".into());
    }
    readings.iter().try_for_each(|reading| reads(reading, truth, tolerance))
}

/// Whether the mean over readings is `truth`, as [`reads`].
pub fn mean_reads(readings: &[MeterReading], truth: f64, tolerance: f64) -> Verdict {
    reads(&mean_of(readings), truth, tolerance)
}

/// The mean over readings, and its noise.
pub fn mean_of(readings: &[MeterReading]) -> MeterReading {
    let [red, green, blue] = [0, 1, 2].map(|channel| mean(readings, channel));
    MeterReading {
        irradiance: DVec3::new(red.0, green.0, blue.0),
        stderr: DVec3::new(red.1, green.1, blue.1),
        samples: readings.iter().map(|reading| reading.samples).sum(),
    }
}

/// Whether nothing at all is read, anywhere.
pub fn all_dark(readings: &[MeterReading]) -> Verdict {
    ensure(!readings.is_empty(), || "nothing was read".into())?;
    readings.iter().try_for_each(|reading| {
        ensure(reading.irradiance == DVec3::ZERO, || format!("E is {}, not 0", reading.irradiance))
    })
}

/// Whether two readings of the same light agree to the relative `tolerance`, the noise of both counted in.
pub fn agree(a: &MeterReading, b: &MeterReading, tolerance: f64) -> Verdict {
    let [a_light, b_light] = [a, b].map(|reading| luminance(reading.irradiance));
    let noise = luminance(a.stderr).hypot(luminance(b.stderr));
    if b_light > 0.0 && (a_light - b_light).abs() + 4.0 * noise <= tolerance * b_light {
        return Ok(());
    }
    Err(format!("E is {} and {}, ± {noise:.2e}, not equal to {tolerance}", shown(a.irradiance), shown(b.irradiance)))
}

/// Whether readings are the same but for rounding: the same random numbers met the same scene.
pub fn same_but_for_rounding(a: &[MeterReading], b: &[MeterReading], tolerance: f64) -> Verdict {
    if a.is_empty() || a.len() != b.len() {
        return Err(format!("{} and {} readings", a.len(), b.len()));
    }
    for (a, b) in a.iter().zip(b) {
        let off = (a.irradiance - b.irradiance).abs();
        if (0..3).any(|channel| off[channel].is_nan() || off[channel] > tolerance * b.irradiance[channel]) {
            return Err(format!("E is {} and {}, not equal to {tolerance}", shown(a.irradiance), shown(b.irradiance)));
        }
    }
    Ok(())
}

/// A room, and what should have its light.
pub struct SameRoom<'a> {
    pub here: &'a Scene,
    pub there: &'a Scene,
    /// How much larger all lengths are there.
    pub scale: f32,
    /// Texels per metre here.
    pub density: f32,
    /// Of the mean texel, relative: random numbers are the same.
    pub tolerance: f64,
}

impl SameRoom<'_> {
    /// Whether both have as many texels and these the same mean; and to 3 % that of the level room, which has other
    /// random numbers but where points have no error off their walls.
    pub fn holds(&self) -> Verdict {
        let bake = |scene: &Scene, density: f32| {
            baked(scene, &BakeSettings { goal: Goal::Samples(64), density, ..BakeSettings::default() })
                .map(|lightmap| texels(&lightmap))
        };
        let (_, level) = bake(&level_room(), self.density)?;
        let (count, mean) = bake(self.here, self.density)?;
        let (other_count, other_mean) = bake(self.there, self.density / self.scale)?;
        ensure((mean / level - 1.0).abs() <= 0.03, || {
            format!("the mean texel is {mean:.5}, and {level:.5} of a level room")
        })?;
        ensure(count == other_count, || format!("{other_count} texels, not {count}"))?;
        ensure((other_mean / mean - 1.0).abs() <= self.tolerance, || {
            format!("the mean texel is {other_mean:.5}, not {mean:.5}")
        })
    }
}

/// How many texels there are, and the mean of red over them [cd/m²].
pub fn texels(lightmap: &Lightmap) -> (usize, f64) {
    let texels = lightmap.pages.iter().flat_map(|page| page.raw.iter().zip(&page.coverage));
    let texels: Vec<f64> = texels.filter(|(_, coverage)| **coverage > 0.0).map(|(raw, _)| f64::from(raw.x)).collect();
    (texels.len(), texels.iter().sum::<f64>() / texels.len() as f64)
}

/// Whether the scene has a fault whose sentence begins so.
pub fn is_refused(scene: &Scene, sentence: &str) -> Verdict {
    let faults: Vec<String> = scene.validate().iter().map(ToString::to_string).collect();
    if faults.iter().any(|fault| fault.starts_with(sentence)) {
        return Ok(());
    }
    Err(format!("nothing says \"{sentence}…\"; what is said: {faults:?}"))
}

/// A quantity of light in a few digits; one number if it is grey.
fn shown(light: DVec3) -> String {
    let digits = |value: f64| {
        if value == 0.0 || (1e-3..1e5).contains(&value.abs()) { format!("{value:.4}") } else { format!("{value:.3e}") }
    };
    let [red, green, blue] = light.to_array().map(digits);
    if red == green && green == blue { red } else { format!("({red}, {green}, {blue})") }
}

/// `Ok` if it holds, else the sentence.
pub fn ensure(holds: bool, otherwise: impl FnOnce() -> String) -> Verdict {
    if holds { Ok(()) } else { Err(otherwise()) }
}

/// The judges reject what is wrong: too noisy, biased, not a number.
pub fn rejects_what_is_wrong() -> Verdict {
    let reading = |value: f64, stderr: f64| MeterReading {
        irradiance: DVec3::splat(value),
        stderr: DVec3::splat(stderr),
        samples: 16,
    };
    let tinted = MeterReading { irradiance: Vec3::new(1.0, 1.0, 1.02).as_dvec3(), ..reading(1.0, 0.0) };
    let room = room();
    let mut brighter = room.clone();
    brighter.materials.iter_mut().for_each(|material| material.emitted_radiance *= 1.01);
    let same = |there: &Scene| SameRoom { here: &room, there, scale: 1.0, density: 3.3, tolerance: 5e-3 }.holds();
    let sound =
        [same(&room), reads(&reading(1.0, 1e-3), 1.0, 0.01), agree(&reading(1.0, 1e-3), &reading(1.001, 1e-3), 0.01)];
    let wrong = [
        reads(&reading(1.02, 1e-3), 1.0, 0.01),
        reads(&reading(1.0, 3e-3), 1.0, 0.01),
        reads(&reading(f64::NAN, 0.0), 1.0, 0.01),
        reads(&tinted, 1.0, 0.01),
        all_read(&[], 1.0, 0.01),
        mean_reads(&[], 1.0, 0.01),
        all_dark(&[]),
        all_dark(&[reading(0.0, 0.0), reading(1e-12, 0.0)]),
        all_dark(&[reading(f64::NAN, 0.0)]),
        mean_reads(&[reading(1.0, 1e-3), reading(1.04, 1e-3)], 1.0, 0.01),
        agree(&reading(1.02, 1e-3), &reading(1.0, 1e-3), 0.01),
        agree(&reading(1.0, 3e-3), &reading(1.0, 3e-3), 0.01),
        agree(&reading(0.0, 0.0), &reading(0.0, 0.0), 0.01),
        same_but_for_rounding(&[reading(1.0, 0.1)], &[reading(1.00001, 0.1)], 1e-6),
        same_but_for_rounding(&[reading(f64::NAN, 0.1)], &[reading(1.0, 0.1)], 1e-6),
        same_but_for_rounding(&[], &[], 1e-6),
        same(&brighter),
        is_refused(&Scene::default(), "mesh"),
        no_path_was_lost(&BakeReport { warnings: vec![BakeWarning::NotLight { paths: 1 }], ..BakeReport::default() }),
    ];
    for verdict in sound {
        verdict?;
    }
    match wrong.iter().position(Result::is_ok) {
        Some(index) => Err(format!("wrong number {index} passed")),
        None => Ok(()),
    }
}

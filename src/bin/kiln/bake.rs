//! `kiln bake`.

use crate::args::BakeArgs;
use crate::failure::Failure;
use crate::progress::Show;
use crate::scene;
use crate::talk::{Talk, warn};
use bevy_kiln::bake::{
    BakePlan, BakeReport, BakeSettings, CancelToken, Denoise, Jump, RelativeError, VolumeBake, VolumeSettings,
    bake_lightmap, bake_volumes,
};
use bevy_kiln::output::{ReferenceError, WrittenLightmap, compare_with_reference, write_bake};
use bevy_kiln::plugin::{BakeVolumes, Extraction};
use bevy_kiln::scene::Scene;
use bevy_kiln::trace::Effect;
use serde_json::json;

pub(crate) fn run(args: &BakeArgs, cancel: &CancelToken) -> Result<(), Failure> {
    let talk = Talk::beside(args.json);
    let denoise = if args.no_denoise { Denoise::Off } else { Denoise::default() };
    let settings = BakeSettings { denoise, ..scene::bake_settings(&args.scene, &args.layout, &args.goal)? };
    if args.output.is_file() {
        let path = args.output.display();
        return Err(Failure::Failed(format!("{path} is a file, not a folder; name another folder or move it away")));
    }
    let extraction = scene::open(&args.scene, cancel)?;
    let mut warnings: Vec<String> = extraction.warnings.iter().map(ToString::to_string).collect();
    warn(&warnings);
    let volume_settings = volume_settings(args, &extraction, &settings)?;
    let plan = BakePlan::for_scene(&extraction.scene, &settings, &(), cancel)?;
    talk.plan(&plan);
    warn(&plan.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
    let show = Show::new();
    let result = bake_lightmap(&extraction.scene, &settings, &show, cancel);
    show.end();
    let lightmap = result?;
    let volumes = match volume_settings {
        Some(settings) => volumes(&extraction.scene, &settings, cancel)?,
        None => VolumeBake::default(),
    };
    if cancel.is_cancelled() {
        return Err(Failure::Stopped);
    }
    let name = args.scene.scene.display().to_string();
    let written = write_bake(&lightmap, &volumes.volumes, &name, &args.output, args.format).map_err(Failure::failed)?;
    let report = &lightmap.report;
    let planned = |warning: &String| plan.warnings.iter().any(|known| known.to_string() == *warning);
    let of_volumes = volumes.report.warnings.iter().filter(|warning| !report.warnings.contains(warning));
    let late = report.warnings.iter().chain(of_volumes).chain(&written.warnings).map(ToString::to_string);
    let (known, late): (Vec<String>, Vec<String>) = late.partition(planned);
    warn(&late);
    warnings.extend(known.into_iter().chain(late));
    talk.report("texels", report);
    talk.repair(report);
    if !volumes.volumes.is_empty() {
        talk.report(&format!("probes in {} irradiance volumes", volumes.volumes.len()), &volumes.report);
    }
    if report.energy_balance.is_none() {
        talk.say("  energy balance: none (light escapes or is cut, or not all surfaces are diffuse)");
    }
    if let Some(error) = written.compression {
        let (format, [rms, worst]) = (args.format, [error.rms, error.worst].map(|error| 100.0 * error));
        talk.say(format_args!("  {format}: rms error {rms:.3} %, worst texel {worst:.3} %"));
    }
    let reference = args.reference.as_ref().map(|dir| compare_with_reference(&lightmap, dir)).transpose();
    let reference = reference.map_err(Failure::failed)?;
    if let Some(error) = reference {
        let [before, after] = [error.before, error.after].map(|error| 100.0 * error);
        talk.say(format_args!(
            "  against the reference: rms error {before:.2} % as measured, {after:.2} % as repaired"
        ));
    }
    talk.say(format_args!("wrote {} files into {}", written.files.len(), args.output.display()));
    if args.json {
        Talk::Out.say(summary(report, &volumes, &written, reference, &warnings));
    }
    Ok(())
}

/// What volumes are asked for, if any; refused before anything is traced if they cannot be.
fn volume_settings(
    args: &BakeArgs,
    extraction: &Extraction,
    settings: &BakeSettings,
) -> Result<Option<VolumeSettings>, Failure> {
    let which = if args.volumes.is_some() { BakeVolumes::Always } else { BakeVolumes::WhereCalledFor };
    let settings = extraction.volume_settings(settings, which, args.volumes.flatten());
    settings.as_ref().map_or(Ok(()), VolumeSettings::validate)?;
    Ok(settings)
}

/// The irradiance volumes beside the lightmap.
fn volumes(scene: &Scene, settings: &VolumeSettings, cancel: &CancelToken) -> Result<VolumeBake, Failure> {
    let show = Show::new();
    let result = bake_volumes(scene, settings, &show, cancel);
    show.end();
    Ok(result?)
}

fn summary(
    report: &BakeReport,
    volumes: &VolumeBake,
    written: &WrittenLightmap,
    reference: Option<ReferenceError>,
    warnings: &[String],
) -> serde_json::Value {
    let error = |error: &RelativeError| json!({ "mean": error.mean, "p95": error.p95, "max": error.max });
    json!({
        "texels": report.texels,
        "hidden": report.hidden,
        "pages": report.pages,
        "fill": report.fill,
        "unwrapped": report.unwrapped,
        "samples": report.samples,
        "rays": report.rays,
        "cpu_seconds": report.cpu_seconds,
        "wall_seconds": report.wall_seconds,
        "relative_stderr": error(&report.relative_stderr),
        "intervals": {
            "target": report.intervals.target,
            "floor": report.intervals.floor,
            "half_width": error(&report.intervals.half_width),
            "missed": report.intervals.missed,
        },
        "first_pass": report.first_pass.map(|first| {
            json!({ "texels": first.texels, "samples": first.samples, "rays": first.rays, "cpu_seconds": first.cpu_seconds })
        }),
        "denoised": report.denoised.map(|denoised| {
            json!({ "before": error(&denoised.before), "after": error(&denoised.after) })
        }),
        "seams": report.seams.map(|seams| {
            let jump = |jump: Jump| json!({ "p99": jump.p99, "max": jump.max });
            json!({ "joints": seams.joints, "before": jump(seams.before), "after": jump(seams.after) })
        }),
        "reference": reference.map(|error| json!({ "before": error.before, "after": error.after })),
        "volumes": volumes.volumes.iter().map(|volume| {
            json!({ "id": volume.id.as_str(), "centre": volume.centre.to_array(), "size": volume.size.to_array(), "probes": volume.resolution.to_array() })
        }).collect::<Vec<_>>(),
        "energy_balance": report.energy_balance,
        "clamped_light": report.clamped_light,
        "forced": {
            "on": report.forced.on.iter().map(Effect::name).collect::<Vec<_>>(),
            "off": report.forced.off.iter().map(Effect::name).collect::<Vec<_>>(),
        },
        "clamped": written.clamped,
        "compression": written.compression.map(|error| json!({ "rms": error.rms, "worst": error.worst })),
        "warnings": warnings,
        "files": written.files.iter().map(|file| file.display().to_string()).collect::<Vec<_>>(),
    })
}

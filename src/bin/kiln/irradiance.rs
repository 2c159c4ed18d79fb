//! `kiln irradiance`.

use crate::args::IrradianceArgs;
use crate::failure::Failure;
use crate::points::Table;
use crate::progress::Show;
use crate::scene;
use crate::talk::{Talk, warn};
use bevy_kiln::bake::{CancelToken, MeterSettings, measure_irradiance};
use std::io::Write;
use std::path::Path;

pub(crate) fn run(args: &IrradianceArgs, cancel: &CancelToken) -> Result<(), Failure> {
    let table = Table::read(&args.points)?;
    let extraction = scene::open_without_lightmaps(&args.scene, cancel)?;
    warn(&extraction.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
    let show = Show::new();
    let settings = MeterSettings {
        transport: scene::transport(&args.scene),
        samples_per_point: args.spp.get(),
        threads: args.scene.threads,
    };
    let result = measure_irradiance(&extraction.scene, &table.points, &settings, &show, cancel);
    show.end();
    let measured = result?;
    if cancel.is_cancelled() {
        return Err(Failure::Stopped);
    }
    warn(&measured.report.warnings.iter().map(ToString::to_string).collect::<Vec<_>>());
    let answer = table.answer(&measured.readings)?;
    match &args.output {
        Some(path) => write_whole(path, &answer)?,
        None => std::io::stdout()
            .write_all(&answer)
            .map_err(|error| Failure::Failed(format!("the answer cannot be written to standard output ({error})")))?,
    }
    Talk::beside(args.output.is_none()).report("points", &measured.report);
    Ok(())
}

/// Writes beside and renames, so that a file is whole or as it was.
fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |error: std::io::Error| {
        let path = path.display();
        Failure::Failed(format!("{path} cannot be written ({error}); see that its folder is there and has room"))
    };
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let beside = path.with_file_name(name);
    let written = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path));
    if written.is_err() {
        // What is left of it is of no use; that it may not be there at all is fine.
        let _ = std::fs::remove_file(&beside);
    }
    written.map_err(failed)
}

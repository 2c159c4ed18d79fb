//! A study as a folder: a page that is read in a minute, its plots, its pictures and a table of every point.

mod chart;
mod page;
mod pictures;
mod sheet;
mod table;
#[cfg(test)]
mod tests;
mod words;

use super::OutputError;
use super::png::write_rgb;
use super::safe_write::{Staged, make_folder};
use crate::study::Study;
use chart::{Chart, Subject};
use page::Files;
use sheet::{Bitmap, bitmap, svg};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes `study.md`, `study.csv`, the plots as SVG and PNG, and `strip.png` into a folder, which is made if it is
/// missing. `scene` is the scene's name on the page. Returns the files, the page first.
///
/// # Errors
///
/// [`OutputError`] where a file cannot be written; what was there before is then still there.
pub fn write_study(study: &Study, scene: &str, dir: &Path) -> Result<Vec<PathBuf>, OutputError> {
    make_folder(dir)?;
    let mut staged = Vec::new();
    let mut files = Files { plots: Vec::new(), has_strip: false };
    let mut drawings = Vec::new();
    for subject in Subject::ALL {
        let Some(chart) = Chart::new(subject, study) else { continue };
        let path = |ending: &str| dir.join(format!("{}.{ending}", subject.file()));
        let drawn = svg(&chart).map_err(|reason| malformed(&path("svg"), reason))?;
        drawings.push(text(&path("svg"), &drawn)?);
        let drawn = bitmap(&chart).map_err(|reason| malformed(&path("png"), reason))?;
        drawings.push(picture(&path("png"), drawn)?);
        files.plots.push(subject);
    }
    let path = dir.join("strip.png");
    if let Some(strip) = pictures::strip(&study.strip).map_err(|reason| malformed(&path, reason))? {
        drawings.push(picture(&path, strip)?);
        files.has_strip = true;
    }
    staged.push(text(&dir.join("study.md"), &page::page(study, scene, &files))?);
    staged.push(text(&dir.join("study.csv"), &table::csv(study))?);
    staged.append(&mut drawings);
    staged.into_iter().map(Staged::place).collect()
}

/// The sentence at the top of the page: what 1 % costs.
pub fn study_answer(study: &Study) -> String {
    page::answer(study)
}

fn malformed(path: &Path, reason: String) -> OutputError {
    OutputError::Malformed { path: path.to_owned(), reason }
}

fn text(path: &Path, text: &str) -> Result<Staged, OutputError> {
    Staged::write(path, |file| file.write_all(text.as_bytes()))
}

fn picture(path: &Path, picture: Bitmap) -> Result<Staged, OutputError> {
    let [width, height] = picture.size;
    Staged::write(path, |file| write_rgb(width, height, picture.pixels, file))
}

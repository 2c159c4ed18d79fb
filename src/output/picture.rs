//! A rendered picture as a file, in the format that its name asks for.

use super::safe_write::{Staged, make_folder};
use super::{OutputError, exr, png};
use crate::bake::Picture;
use std::path::Path;

/// The formats of a picture.
#[derive(Clone, Copy)]
enum PictureFormat {
    Png,
    Exr,
}

/// Writes a picture, in place of what has that name: `.png` exposed at `ev100`, clipped and sRGB-encoded, without a
/// tone curve; `.exr` linear radiance and its standard error [cd/m²], for which `ev100` does not matter. Folders
/// that are missing are made.
pub fn write_picture(picture: &Picture, path: &Path, ev100: f32) -> Result<(), OutputError> {
    let format = picture_format(path)?;
    check(picture, path)?;
    if matches!(format, PictureFormat::Png) && !ev100.is_finite() {
        return Err(OutputError::Exposure { path: path.to_owned(), ev100 });
    }
    make_folder(path.parent().unwrap_or(Path::new("")))?;
    let staged = Staged::write(path, |file| match format {
        PictureFormat::Png => png::write_picture(picture, ev100, file),
        PictureFormat::Exr => exr::write_picture(picture, file),
    })?;
    staged.place()?;
    Ok(())
}

fn picture_format(path: &Path) -> Result<PictureFormat, OutputError> {
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    match extension.as_deref() {
        Some("png") => Ok(PictureFormat::Png),
        Some("exr") => Ok(PictureFormat::Exr),
        _ => Err(OutputError::UnknownPicture { path: path.to_owned() }),
    }
}

fn check(picture: &Picture, path: &Path) -> Result<(), OutputError> {
    let pixels = picture.width as usize * picture.height as usize;
    if pixels == 0 || [picture.radiance.len(), picture.stderr.len()] != [pixels; 2] {
        let reason = format!(
            "a picture of {} × {} pixels has {} values and {} standard errors",
            picture.width,
            picture.height,
            picture.radiance.len(),
            picture.stderr.len()
        );
        return Err(OutputError::Malformed { path: path.to_owned(), reason });
    }
    Ok(())
}

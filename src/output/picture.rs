//! A rendered picture as a file, in the format that its name asks for.

use super::safe_write::{Staged, make_folder};
use super::{Look, OutputError, exr, png};
use crate::bake::Picture;
use std::path::Path;

/// The formats of a picture.
#[derive(Clone, Copy)]
enum PictureFormat {
    Png,
    Exr,
}

/// Writes a picture, in place of what has that name: `.png` as it looks, sRGB-encoded; `.exr` linear radiance and its
/// standard error [cd/m²], for which the look does not matter. Folders that are missing are made.
pub fn write_picture(picture: &Picture, path: &Path, look: Look) -> Result<(), OutputError> {
    let format = picture_format(path)?;
    check(picture, path)?;
    if matches!(format, PictureFormat::Png) && !look.ev100.is_finite() {
        return Err(OutputError::Exposure { path: path.to_owned(), ev100: look.ev100 });
    }
    make_folder(path.parent().unwrap_or(Path::new("")))?;
    let staged = Staged::write(path, |file| match format {
        PictureFormat::Png => png::write_picture(picture, look, file),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::BakeReport;
    use crate::output::ToneCurve;

    fn look(ev100: f32) -> Look {
        Look { ev100, tone: ToneCurve::Clip }
    }

    use glam::Vec3;
    use std::fs;

    fn picture() -> Picture {
        let (radiance, stderr) = (vec![Vec3::ONE; 6], vec![Vec3::ZERO; 6]);
        Picture { width: 3, height: 2, radiance, stderr, report: BakeReport::default() }
    }

    #[test]
    fn the_name_says_the_format() {
        let folder = temp_dir::TempDir::new().unwrap();
        for (name, start) in [("deep/er/a.png", &b"\x89PNG"[..]), ("b.EXR", &[0x76, 0x2f, 0x31, 0x01])] {
            let path = folder.path().join(name);
            write_picture(&picture(), &path, look(0.0)).unwrap();
            assert!(fs::read(&path).unwrap().starts_with(start), "{name}");
        }
        for name in ["a.jpg", "png", "a."] {
            let path = folder.path().join(name);
            assert_eq!(write_picture(&picture(), &path, look(0.0)), Err(OutputError::UnknownPicture { path }));
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "nothing else was left");
    }

    #[test]
    fn what_makes_no_picture_is_refused_by_name() {
        let folder = temp_dir::TempDir::new().unwrap();
        let path = folder.path().join("a.png");
        let error = write_picture(&picture(), &path, look(f32::INFINITY)).unwrap_err();
        assert_eq!(error, OutputError::Exposure { path: path.clone(), ev100: f32::INFINITY });
        let short = Picture { height: 3, ..picture() };
        assert!(matches!(write_picture(&short, &path, look(0.0)), Err(OutputError::Malformed { .. })));
        let empty = Picture { width: 0, radiance: vec![], stderr: vec![], ..picture() };
        assert!(matches!(write_picture(&empty, &path, look(0.0)), Err(OutputError::Malformed { .. })));
        assert!(!path.exists());
    }
}

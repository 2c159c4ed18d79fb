//! Files that are whole or not there: written beside their place under another name, then renamed into it.
//!
//! A [`Staged`] file is complete on the disk but not yet in its place. Several are staged before the first is
//! placed, so that a full disk leaves every old file as it was. Dropping one removes it.

use super::OutputError;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// How many names are tried for a file beside its place.
const NAME_TRIES: u32 = 1000;

/// A complete file beside its place.
#[derive(Debug)]
pub(super) struct Staged {
    beside: Option<PathBuf>,
    place: PathBuf,
}

impl Staged {
    /// Writes a file beside `place`; `write` gives its bytes.
    pub(super) fn write(
        place: &Path,
        write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<Self, OutputError> {
        if place.is_dir() {
            let reason = "it is a folder".to_owned();
            return Err(OutputError::Replace { path: place.to_owned(), reason });
        }
        let failed = |error: io::Error| OutputError::Write { path: place.to_owned(), reason: error.to_string() };
        let (beside, file) = create_beside(place).map_err(failed)?;
        let staged = Self { beside: Some(beside), place: place.to_owned() };
        let mut writer = BufWriter::new(file);
        write(&mut writer).map_err(failed)?;
        writer.flush().map_err(failed)?;
        // Without this a crash soon after the rename could leave an empty file where the old one was.
        writer.get_ref().sync_all().map_err(failed)?;
        Ok(staged)
    }

    /// Puts the file into its place, over what was there.
    pub(super) fn place(mut self) -> Result<PathBuf, OutputError> {
        if let Some(beside) = &self.beside {
            fs::rename(beside, &self.place)
                .map_err(|error| OutputError::Replace { path: self.place.clone(), reason: error.to_string() })?;
        }
        self.beside = None;
        Ok(self.place.clone())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        if let Some(beside) = &self.beside {
            // Nothing is lost if this fails, and the reason why the file was given up is already on its way.
            let _ = fs::remove_file(beside);
        }
    }
}

/// Makes the folder and those above it where they are missing.
pub(super) fn make_folder(path: &Path) -> Result<(), OutputError> {
    if path.as_os_str().is_empty() || path.is_dir() {
        return Ok(());
    }
    if let Some(file) = path.ancestors().find(|ancestor| ancestor.is_file()) {
        return Err(OutputError::FolderIsFile { path: file.to_owned() });
    }
    fs::create_dir_all(path).map_err(|error| OutputError::Folder { path: path.to_owned(), reason: error.to_string() })
}

/// Opens a new file in the folder of `place`, under a name that nothing else has.
fn create_beside(place: &Path) -> io::Result<(PathBuf, File)> {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let name = place.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it names no file"))?;
    for _ in 0..NAME_TRIES {
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let mut beside_name = OsString::from(".");
        beside_name.push(name);
        beside_name.push(format!(".{}-{number}.part", std::process::id()));
        let beside = place.with_file_name(beside_name);
        match OpenOptions::new().write(true).create_new(true).open(&beside) {
            Ok(file) => return Ok((beside, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::new(io::ErrorKind::AlreadyExists, "the folder is full of unfinished files that end in .part"))
}

#[cfg(test)]
mod tests {
    use super::super::test_pages::names;
    use super::*;

    fn write_text(place: &Path, text: &str) -> Result<PathBuf, OutputError> {
        Staged::write(place, |file| file.write_all(text.as_bytes()))?.place()
    }

    #[test]
    fn a_file_is_replaced_and_nothing_stays_beside_it() {
        let folder = temp_dir::TempDir::new().unwrap();
        let place = folder.path().join("a.txt");
        assert_eq!(write_text(&place, "old"), Ok(place.clone()));
        let staged = Staged::write(&place, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "old");
        assert_eq!(names(folder.path()).len(), 2);
        staged.place().unwrap();
        assert_eq!(fs::read_to_string(&place).unwrap(), "new");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_failing_write_leaves_the_old_file_alone() {
        let folder = temp_dir::TempDir::new().unwrap();
        let place = folder.path().join("a.txt");
        write_text(&place, "old").unwrap();
        let failed = Staged::write(&place, |file| {
            file.write_all(&[0; 100_000])?;
            Err(io::Error::other("no space left"))
        });
        let error = failed.unwrap_err();
        assert_eq!(error, OutputError::Write { path: place.clone(), reason: "no space left".into() });
        assert!(error.to_string().contains("a.txt"));
        assert_eq!(fs::read_to_string(&place).unwrap(), "old");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_place_that_cannot_be_taken_leaves_nothing_beside_it() {
        let folder = temp_dir::TempDir::new().unwrap();
        let place = folder.path().join("a.txt");
        fs::create_dir(&place).unwrap();
        fs::write(place.join("inside"), "kept").unwrap();
        assert!(matches!(write_text(&place, "new"), Err(OutputError::Replace { path, .. }) if path == place));
        assert_eq!(names(folder.path()), ["a.txt"]);
        assert_eq!(names(&place), ["inside"]);
        // The same where the place is taken only after the file was staged.
        let later = folder.path().join("b.txt");
        let staged = Staged::write(&later, |file| file.write_all(b"new")).unwrap();
        fs::create_dir(&later).unwrap();
        assert!(matches!(staged.place(), Err(OutputError::Replace { path, .. }) if path == later));
        assert_eq!(names(folder.path()), ["a.txt", "b.txt"]);
        assert!(matches!(write_text(Path::new(""), "new"), Err(OutputError::Write { .. })));
    }

    #[test]
    fn folders_are_made_where_missing() {
        let folder = temp_dir::TempDir::new().unwrap();
        let deep = folder.path().join("a/b/c");
        assert!(matches!(write_text(&deep.join("x"), "text"), Err(OutputError::Write { .. })));
        make_folder(&deep).unwrap();
        make_folder(&deep).unwrap();
        make_folder(Path::new("")).unwrap();
        write_text(&deep.join("x"), "text").unwrap();
        let file = deep.join("x");
        assert_eq!(make_folder(&file), Err(OutputError::FolderIsFile { path: file.clone() }));
        assert_eq!(make_folder(&file.join("below")), Err(OutputError::FolderIsFile { path: file }));
    }

    #[cfg(unix)]
    #[test]
    fn an_unwritable_folder_is_named() {
        use std::os::unix::fs::PermissionsExt;
        let folder = temp_dir::TempDir::new().unwrap();
        let locked = folder.path().join("locked");
        fs::create_dir(&locked).unwrap();
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
        // Whoever may write everywhere (root) cannot be refused; there the check would mean nothing.
        let refused = File::create(locked.join("probe")).is_err();
        let written = write_text(&locked.join("a.txt"), "text");
        let made = make_folder(&locked.join("below"));
        fs::set_permissions(&locked, fs::Permissions::from_mode(0o755)).unwrap();
        if refused {
            assert!(matches!(written, Err(OutputError::Write { path, .. }) if path == locked.join("a.txt")));
            assert!(matches!(made, Err(OutputError::Folder { path, .. }) if path == locked.join("below")));
            assert!(names(&locked).is_empty());
        } else {
            assert!(written.is_ok() && made.is_ok());
        }
    }
}

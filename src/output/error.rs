//! Why a file was not written. Every reason names the path and says what to do.

use std::path::PathBuf;
use thiserror::Error;

/// Why a result is not on disk. What was there before is still there.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The machine: the folder cannot be made.
    #[error("cannot make the folder {} ({reason}); name a folder that you may write to", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The settings: the folder's name is that of a file.
    #[error("{} is a file, not a folder; name another folder or move that file away", path.display())]
    FolderIsFile {
        /// The path.
        path: PathBuf,
    },
    /// The machine: the file cannot be written.
    #[error(
        "cannot write {} ({reason}); see that the disk has room and that you may write there, nothing old was touched",
        path.display()
    )]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The machine: the finished file cannot take its place.
    #[error(
        "{} cannot be replaced ({reason}); see that it is a file and not open elsewhere, then write again",
        path.display()
    )]
    Replace {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: String,
    },
    /// The settings: an extension that stands for no picture format.
    #[error("{} ends in no known picture format; end it in .png (exposed) or .exr (linear)", path.display())]
    UnknownPicture {
        /// The path asked for.
        path: PathBuf,
    },
    /// The settings: an exposure that makes no picture.
    #[error("{} cannot be exposed at EV100 {ev100}; give a finite number such as 9.7", path.display())]
    Exposure {
        /// The picture.
        path: PathBuf,
        /// The exposure asked for.
        ev100: f32,
    },
    /// The caller: data that contradict themselves.
    #[error("{} cannot be written: {reason}; bake or render again", path.display())]
    Malformed {
        /// The file that was to hold them.
        path: PathBuf,
        /// The contradiction.
        reason: String,
    },
}

//! Why a scene file cannot be opened: what Bevy's loaders say, sorted by what a person can do about it.

use super::PATIENCE;
use bevy::asset::io::AssetReaderError;
use bevy::asset::{AssetLoadError, ReadAssetBytesError};
use bevy::gltf::GltfError;
use bevy::image::ImageLoaderError;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a scene file cannot be opened.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum OpenError {
    /// There is no such file.
    #[error("there is no file {}; check the path", path.display())]
    Missing {
        /// The path asked for.
        path: PathBuf,
    },
    /// It is of a kind that is not read.
    #[error("{} is no scene that can be read; give a .glb, a .gltf or a .scn.ron file", path.display())]
    UnknownKind {
        /// The path asked for.
        path: PathBuf,
    },
    /// A picture of the sky of a kind that is not read.
    #[error("{} is no picture of a sky that can be read; give an .hdr or an .exr file", path.display())]
    UnknownPicture {
        /// The path asked for.
        path: PathBuf,
    },
    /// It cannot be read.
    #[error("{} cannot be loaded ({reason}); it may be damaged or cut short, export it again", path.display())]
    Broken {
        /// The path asked for.
        path: PathBuf,
        /// What the loader said.
        reason: String,
    },
    /// A file that it refers to is not there.
    #[error("{} needs {}, which is not there; put it there, or export all into one .glb", path.display(), part.display())]
    MissingPart {
        /// The path asked for.
        path: PathBuf,
        /// The file that is not there.
        part: PathBuf,
    },
    /// A picture in it cannot be read.
    #[error("{} has a picture that cannot be read ({reason}); save it anew, as PNG or JPEG, and export again", path.display())]
    BadPicture {
        /// The path asked for.
        path: PathBuf,
        /// What the loader said.
        reason: String,
    },
    /// It holds fans of triangles or loops of lines, which Bevy's loader refuses.
    #[error("{} has triangle fans or line loops, which Bevy does not read; export it as plain triangles", path.display())]
    UnknownPrimitive {
        /// The path asked for.
        path: PathBuf,
    },
    /// It requires an extension of glTF that Bevy does not read.
    #[error("{} requires {extension}, which Bevy does not read; export it without", path.display())]
    UnknownExtension {
        /// The path asked for.
        path: PathBuf,
        /// The extension.
        extension: String,
    },
    /// It holds no scene.
    #[error("{} holds no scene; export it with one", path.display())]
    NoScene {
        /// The path asked for.
        path: PathBuf,
    },
    /// Loading does not end.
    #[error("{} is still not loaded after {} s; see that the disk answers", path.display(), PATIENCE.as_secs())]
    TooSlow {
        /// The path asked for.
        path: PathBuf,
    },
}

impl OpenError {
    /// What a failure to load the scene `path` means to a person.
    pub(super) fn of_scene(path: &Path, error: &AssetLoadError) -> Self {
        let path = path.to_owned();
        let bad_picture = |reason: String| Self::BadPicture { path: path.clone(), reason };
        if let Some(part) = missing_part(error) {
            return Self::MissingPart { path, part };
        }
        if let AssetLoadError::AssetLoaderError(error) = error {
            match (error.error().downcast_ref::<GltfError>(), error.error().downcast_ref::<ImageLoaderError>()) {
                (Some(GltfError::UnsupportedPrimitive { .. }), _) => return Self::UnknownPrimitive { path },
                (Some(GltfError::ImageError(error)), _) => return bad_picture(first_line(error)),
                (_, Some(ImageLoaderError::FileTexture(error))) => return bad_picture(first_line(error)),
                _ => {}
            }
        }
        let reason = reason(error);
        match required_extension(&reason) {
            Some(extension) => Self::UnknownExtension { path, extension: extension.to_owned() },
            None => Self::Broken { path, reason },
        }
    }

    /// The same for a picture of the sky.
    pub(super) fn of_picture(path: &Path, error: &AssetLoadError) -> Self {
        Self::Broken { path: path.to_owned(), reason: reason(error) }
    }
}

/// The file that is not there: a picture, which is loaded for itself, or a buffer, which the glTF loader reads.
fn missing_part(error: &AssetLoadError) -> Option<PathBuf> {
    match error {
        AssetLoadError::AssetReaderError(AssetReaderError::NotFound(part)) => Some(part.clone()),
        AssetLoadError::AssetLoaderError(error) => match error.error().downcast_ref::<GltfError>() {
            Some(GltfError::ReadAssetBytesError(ReadAssetBytesError::AssetReaderError(
                AssetReaderError::NotFound(part),
            ))) => Some(part.clone()),
            _ => None,
        },
        _ => None,
    }
}

/// What went wrong, without the loader's type and without a stack trace.
fn reason(error: &AssetLoadError) -> String {
    match error {
        AssetLoadError::AssetLoaderError(error) => first_line(error.error()),
        other => first_line(other),
    }
}

fn first_line(error: &dyn std::fmt::Display) -> String {
    error.to_string().lines().next().unwrap_or_default().trim().trim_end_matches('.').to_owned()
}

/// The extension that a reader of glTF says is required and unknown; its error has no field for that.
fn required_extension(reason: &str) -> Option<&str> {
    let (_, rest) = reason.split_once("extensionsRequired[")?;
    let (_, rest) = rest.split_once(" = \"")?;
    let (extension, rest) = rest.split_once('"')?;
    rest.starts_with(": Unsupported").then_some(extension)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_required_extension_is_found_in_what_the_reader_says() {
        let said = r#"invalid glTF file: invalid glTF: extensionsRequired[0] = "KHR_draco": Unsupported extension;"#;
        assert_eq!(required_extension(said), Some("KHR_draco"));
        assert_eq!(required_extension("invalid glTF: meshes[0] = \"x\": Unsupported extension"), None);
    }
}

//! A file read a second time, by the loader that Bevy has for it: all meshes and images in it, by their labels.

use bevy::asset::io::Reader;
use bevy::asset::{Asset, AssetLoader, ErasedLoadedAsset, LoadContext, LoadDirectError};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;

/// What is in a file. The file itself has no label.
#[derive(Asset, TypePath, Default)]
pub(crate) struct SecondReading {
    meshes: HashMap<String, Mesh>,
    images: HashMap<String, Image>,
}

impl SecondReading {
    pub(super) fn mesh(&self, label: &str) -> Option<&Mesh> {
        self.meshes.get(label)
    }

    pub(super) fn image(&self, label: &str) -> Option<&Image> {
        self.images.get(label)
    }

    fn keep(&mut self, label: &str, part: &ErasedLoadedAsset) {
        if let Some(mesh) = part.get::<Mesh>() {
            self.meshes.insert(label.to_owned(), mesh.clone());
        }
        if let Some(image) = part.get::<Image>() {
            self.images.insert(label.to_owned(), image.clone());
        }
    }
}

/// Reads any file. It claims no extension: Bevy picks it by the kind of asset alone.
#[derive(Default, TypePath)]
pub(crate) struct FileLoader;

impl AssetLoader for FileLoader {
    type Asset = SecondReading;
    type Settings = ();
    type Error = LoadDirectError;

    async fn load(
        &self,
        _: &mut dyn Reader,
        (): &(),
        load_context: &mut LoadContext<'_>,
    ) -> Result<SecondReading, LoadDirectError> {
        let path = load_context.path().clone_owned();
        // A value that goes to nobody's `Assets`, so that its usages do not count.
        let file = load_context.load_builder().override_unapproved().load_untyped_value(path).await?;
        let mut out = SecondReading::default();
        out.keep("", &file);
        for label in file.iter_labels() {
            if let Some(part) = file.get_labeled(label) {
                out.keep(label, part);
            }
        }
        Ok(out)
    }
}

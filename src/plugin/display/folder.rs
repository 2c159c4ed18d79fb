//! A baked folder as a Bevy asset: its manifest and its textures.

use crate::artefact::{Manifest, ManifestError};
use bevy::asset::io::Reader;
use bevy::asset::{AssetLoader, AssetPath, LoadContext};
use bevy::image::{ImageAddressMode, ImageLoaderSettings, ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::*;
use std::path::PathBuf;
use thiserror::Error;

/// A baked folder. Load it by its manifest: `asset_server.load::<BakedFolder>("level/kiln.ron")`.
#[derive(Asset, TypePath, Debug)]
pub struct BakedFolder {
    /// Which texture belongs on which object.
    pub manifest: Manifest,
    /// The textures, in the manifest's order.
    #[dependency]
    pub pages: Vec<Handle<Image>>,
}

/// Why a baked folder cannot be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BakedFolderError {
    /// The manifest cannot be read from where it lies.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// The manifest is no UTF-8 text.
    #[error("kiln.ron is no text; bake the scene again")]
    NoText,
    /// The manifest cannot be used.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
}

/// Reads `kiln.ron`. It claims no file extension, so that it stands in the way of no other RON asset.
#[derive(Default, TypePath)]
pub(crate) struct BakedFolderLoader;

impl AssetLoader for BakedFolderLoader {
    type Asset = BakedFolder;
    type Settings = ();
    type Error = BakedFolderError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        (): &(),
        load_context: &mut LoadContext<'_>,
    ) -> Result<BakedFolder, BakedFolderError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes).map_err(|_| BakedFolderError::NoText)?;
        let manifest = Manifest::from_ron(&text)?;
        let here = load_context.path().clone_owned();
        let pages = manifest.pages.iter().map(|page| {
            let path = here.resolve_embed(&AssetPath::from(PathBuf::from(&page.file)));
            // KTX2 holds no sampler, and a game may have made `nearest` its default.
            let with_sampler = |settings: &mut ImageLoaderSettings| {
                settings.sampler = lightmap_sampler();
                settings.is_srgb = false;
            };
            load_context.load_builder().with_settings(with_sampler).load(path)
        });
        let pages = pages.collect();
        Ok(BakedFolder { manifest, pages })
    }
}

/// How a lightmap is sampled: linearly, and never from the other side of the texture.
pub(crate) fn lightmap_sampler() -> ImageSampler {
    ImageSampler::Descriptor(ImageSamplerDescriptor {
        label: Some("lightmap".into()),
        address_mode_u: ImageAddressMode::ClampToEdge,
        address_mode_v: ImageAddressMode::ClampToEdge,
        address_mode_w: ImageAddressMode::ClampToEdge,
        ..ImageSamplerDescriptor::linear()
    })
}

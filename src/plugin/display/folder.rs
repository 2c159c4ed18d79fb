//! A baked folder as a Bevy asset: its manifest, its textures and the layouts of its meshes.

use super::wear::SharedLayout;
use crate::artefact::{MESHES_FILE, Manifest, ManifestError, MeshLayout, MeshLayoutError, StableId};
use bevy::asset::io::Reader;
use bevy::asset::{AssetLoader, AssetPath, LoadContext, ReadAssetBytesError};
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
    /// The textures of the irradiance volumes, in the manifest's order.
    #[dependency]
    pub volumes: Vec<Handle<Image>>,
    /// The layouts of the meshes that the bake laid out anew, in their file's order.
    pub(crate) meshes: Vec<SharedLayout>,
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
    /// The file of the meshes is not beside the manifest, or cannot be read.
    #[error("{MESHES_FILE} cannot be read ({0}); copy the whole folder that the bake wrote")]
    NoMeshes(#[from] ReadAssetBytesError),
    /// The file of the meshes cannot be used.
    #[error(transparent)]
    Meshes(#[from] MeshLayoutError),
    /// A placement names a mesh that is not in the file.
    #[error("{MESHES_FILE} has no mesh {mesh}, which \"{id}\" is to show; copy the whole folder that the bake wrote")]
    MissingMesh {
        /// The object.
        id: StableId,
        /// The mesh asked for.
        mesh: u32,
    },
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
        let mut load = |file: &str| {
            let path = here.resolve_embed(&AssetPath::from(PathBuf::from(file)));
            // KTX2 holds no sampler, and a game may have made `nearest` its default.
            let with_sampler = |settings: &mut ImageLoaderSettings| {
                settings.sampler = lightmap_sampler();
                settings.is_srgb = false;
            };
            load_context.load_builder().with_settings(with_sampler).load(path)
        };
        let pages = manifest.pages.iter().map(|page| load(&page.file)).collect();
        let volumes = manifest.volumes.iter().map(|volume| load(&volume.file)).collect();
        let meshes = match &manifest.meshes {
            Some(file) => {
                let path = here.resolve_embed(&AssetPath::from(PathBuf::from(file)));
                MeshLayout::read_all(&load_context.read_asset_bytes(path).await?)?
            }
            None => Vec::new(),
        };
        check_meshes(&manifest, meshes.len())?;
        Ok(BakedFolder { manifest, pages, volumes, meshes: meshes.into_iter().map(SharedLayout::from).collect() })
    }
}

fn check_meshes(manifest: &Manifest, count: usize) -> Result<(), BakedFolderError> {
    for placement in &manifest.placements {
        if let Some(mesh) = placement.mesh.filter(|&mesh| mesh as usize >= count) {
            return Err(BakedFolderError::MissingMesh { id: placement.id.clone(), mesh });
        }
    }
    Ok(())
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

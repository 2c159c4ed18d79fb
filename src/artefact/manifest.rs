//! `kiln.ron`: which texture belongs on which object, in which unit, and how it was made.

use super::{Fingerprint, StableId};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// The manifest's file name inside a baked folder.
pub const MANIFEST_FILE: &str = "kiln.ron";

/// The version that this library writes, and the newest that it reads.
pub const MANIFEST_VERSION: u32 = 3;

/// Everything that a game must know to put a bake on its entities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of this format.
    pub version: u32,
    /// What wrote it: the package and its version.
    pub generator: String,
    /// The scene as it was asked for: a path, or the game's own word.
    pub scene: String,
    /// Unit of a texel; always `E/pi [cd/m^2]`.
    pub texel_unit: String,
    /// The textures.
    pub pages: Vec<Page>,
    /// Which part of which page each object shows.
    pub placements: Vec<Placement>,
    /// File name inside the folder of the meshes that the bake laid out anew; `None` if there are none. Since
    /// version 2.
    #[serde(default)]
    pub meshes: Option<String>,
    /// Lights whose direct light is in the texels and must not be added again.
    pub baked_lights: Vec<BakedLight>,
    /// Irradiance volumes. Since version 3.
    #[serde(default)]
    pub volumes: Vec<Volume>,
    /// What each thing that took part was like. Empty in files that were written before it was noted;
    /// older readers pass over it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub things: BTreeMap<StableId, Fingerprint>,
}

/// One irradiance volume.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Volume {
    /// Whose it is: the entity that asked for it, or a name that the bake found for it.
    pub id: StableId,
    /// File name inside the folder, of a three-dimensional texture of (x, 2y, 3z) texels for (x, y, z) probes.
    pub file: String,
    /// The middle of its box [m, world].
    pub centre: [f32; 3],
    /// From the box's own axes to the world's: a unit quaternion x, y, z, w.
    pub rotation: [f32; 4],
    /// The sides of its box [m].
    pub size: [f32; 3],
    /// Bevy's `LightProbe::falloff`, the same along each axis.
    pub falloff: f32,
}

/// One lightmap texture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Page {
    /// File name inside the folder.
    pub file: String,
    /// Width [texels].
    pub width: u32,
    /// Height [texels].
    pub height: u32,
}

/// Where an object's unit square of UV1 lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placement {
    /// The object.
    pub id: StableId,
    /// Index into [`Manifest::pages`].
    pub page: u32,
    /// Smallest corner in the page's own unit square; v grows downwards.
    pub uv_min: [f32; 2],
    /// Largest corner.
    pub uv_max: [f32; 2],
    /// Index into what [`Manifest::meshes`] holds; `None` for an object with lightmap coordinates of its own. Since
    /// version 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<u32>,
}

/// A light that the texels already hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BakedLight {
    /// The light.
    pub id: StableId,
}

/// Why a manifest cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ManifestError {
    /// It is no manifest.
    #[error("{MANIFEST_FILE} cannot be read ({reason}); bake the scene again")]
    Syntax {
        /// What the parser said.
        reason: String,
    },
    /// It is of a later version.
    #[error(
        "{MANIFEST_FILE} is of version {found}, this bevy_kiln reads up to {MANIFEST_VERSION}; update bevy_kiln or bake again"
    )]
    TooNew {
        /// Its version.
        found: u32,
    },
    /// A placement names a page that is not listed.
    #[error("{MANIFEST_FILE} puts \"{id}\" on page {page}, which is not there; bake the scene again")]
    MissingPage {
        /// The object.
        id: StableId,
        /// The page asked for.
        page: u32,
    },
    /// A placement names a mesh, and there is no file of meshes.
    #[error("{MANIFEST_FILE} puts \"{id}\" on a mesh of a file that it does not name; bake the scene again")]
    MissingMeshes {
        /// The object.
        id: StableId,
    },
}

impl Manifest {
    /// Reads and checks a manifest.
    pub fn from_ron(text: &str) -> Result<Self, ManifestError> {
        let manifest: Self =
            ron::from_str(text).map_err(|error| ManifestError::Syntax { reason: error.to_string() })?;
        if manifest.version > MANIFEST_VERSION {
            return Err(ManifestError::TooNew { found: manifest.version });
        }
        for placement in &manifest.placements {
            if placement.page as usize >= manifest.pages.len() {
                return Err(ManifestError::MissingPage { id: placement.id.clone(), page: placement.page });
            }
            if placement.mesh.is_some() && manifest.meshes.is_none() {
                return Err(ManifestError::MissingMeshes { id: placement.id.clone() });
            }
        }
        Ok(manifest)
    }

    /// The manifest as text, readable and stable so that it shows small differences under version control.
    pub fn to_ron(&self) -> String {
        let style = ron::ser::PrettyConfig::new().new_line("\n").depth_limit(3);
        ron::ser::to_string_pretty(self, style).expect("plain data serialises")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest() -> Manifest {
        Manifest {
            version: MANIFEST_VERSION,
            generator: "bevy_kiln 0".into(),
            scene: "a.glb".into(),
            texel_unit: "E/pi [cd/m^2]".into(),
            pages: vec![Page { file: "lightmap_0.ktx2".into(), width: 4, height: 8 }],
            placements: vec![
                Placement { id: StableId::new("a/b"), page: 0, uv_min: [0.25, 0.0], uv_max: [0.5, 1.0], mesh: Some(3) },
                Placement { id: StableId::new("a/c"), page: 0, uv_min: [0.0, 0.0], uv_max: [0.25, 1.0], mesh: None },
            ],
            meshes: Some("meshes.kiln".into()),
            baked_lights: vec![BakedLight { id: StableId::new("lamp") }],
            volumes: vec![Volume {
                id: StableId::new("volume/0"),
                file: "volume_0.ktx2".into(),
                centre: [1.0, 2.0, 3.0],
                rotation: [0.0, 0.0, 0.0, 1.0],
                size: [4.0, 3.0, 5.0],
                falloff: 0.0,
            }],
            things: [(StableId::new("lamp"), Fingerprint::new([0.1; 12], "a lamp"))].into(),
        }
    }

    #[test]
    fn round_trip() {
        assert_eq!(Manifest::from_ron(&manifest().to_ron()), Ok(manifest()));
    }

    #[test]
    fn what_cannot_be_used_is_refused_with_the_reason() {
        let newer = Manifest { version: MANIFEST_VERSION + 1, ..manifest() };
        assert_eq!(Manifest::from_ron(&newer.to_ron()), Err(ManifestError::TooNew { found: MANIFEST_VERSION + 1 }));
        let mut missing = manifest();
        missing.placements[0].page = 1;
        assert!(matches!(Manifest::from_ron(&missing.to_ron()), Err(ManifestError::MissingPage { page: 1, .. })));
        let nameless = Manifest { meshes: None, ..manifest() };
        assert_eq!(
            Manifest::from_ron(&nameless.to_ron()),
            Err(ManifestError::MissingMeshes { id: StableId::new("a/b") })
        );
        assert!(matches!(Manifest::from_ron("(version: 1"), Err(ManifestError::Syntax { .. })));
    }

    #[test]
    fn version_1_is_still_read() {
        let text = r#"(
            version: 1, generator: "bevy_kiln 0", scene: "a.glb", texel_unit: "E/pi [cd/m^2]",
            pages: [(file: "lightmap_0.ktx2", width: 4, height: 8)],
            placements: [(id: "a/c", page: 0, uv_min: (0.0, 0.0), uv_max: (0.25, 1.0))],
            baked_lights: [(id: "lamp")],
        )"#;
        let empty = Manifest { version: 1, meshes: None, volumes: Vec::new(), things: BTreeMap::new(), ..manifest() };
        let mut expected = empty;
        expected.placements.remove(0);
        assert_eq!(Manifest::from_ron(text), Ok(expected));
    }
}

//! What of a Bevy scene a bake leaves out or takes for something simpler, by name.

use thiserror::Error;

/// What this version does not simulate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Unsimulated {
    /// `base_color_texture`.
    BaseColourTexture,
    /// `emissive_texture`.
    EmissiveTexture,
    /// `metallic` and its texture.
    Metallic,
    /// `normal_map_texture`.
    NormalMap,
    /// `depth_map`.
    DepthMap,
    /// `specular_transmission`.
    SpecularTransmission,
    /// `diffuse_transmission`.
    DiffuseTransmission,
    /// `clearcoat`.
    Clearcoat,
    /// An alpha mode other than opaque.
    Alpha,
    /// `unlit`.
    Unlit,
}

impl std::fmt::Display for Unsimulated {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::BaseColourTexture => "base colour texture (taken as base_color)",
            Self::EmissiveTexture => "emissive texture (taken as emissive)",
            Self::Metallic => "metallic reflection (its diffuse rest alone reflects)",
            Self::NormalMap => "normal map",
            Self::DepthMap => "depth map",
            Self::SpecularTransmission => "specular transmission (taken as opaque)",
            Self::DiffuseTransmission => "diffuse transmission (taken as opaque)",
            Self::Clearcoat => "clearcoat",
            Self::Alpha => "transparency (taken as opaque)",
            Self::Unlit => "unlit (taken as lit)",
        })
    }
}

/// What of a Bevy scene a bake leaves out or takes for something simpler.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExtractionWarning {
    /// The vertices are no longer in main memory.
    #[error(
        "mesh \"{name}\" is in the render world only, so it is left out; load it with RenderAssetUsages::MAIN_WORLD \
         as well"
    )]
    RenderWorldOnly {
        /// The entity.
        name: String,
    },
    /// The mesh asset is not there.
    #[error("mesh \"{name}\" is not loaded, so it is left out; bake once it is")]
    MeshNotLoaded {
        /// The entity.
        name: String,
    },
    /// The mesh is no triangles.
    #[error("mesh \"{name}\" is made of {topology}, not of triangles, so it is left out")]
    NoTriangles {
        /// The entity.
        name: String,
        /// What it is made of.
        topology: String,
    },
    /// The mesh has no positions.
    #[error("mesh \"{name}\" has no positions, so it is left out")]
    NoPositions {
        /// The entity.
        name: String,
    },
    /// An attribute is not of the format that is read.
    #[error("mesh \"{name}\" has its {attribute} as {found} where {expected} is read, so {consequence}")]
    AttributeFormat {
        /// The entity.
        name: String,
        /// Which attribute.
        attribute: &'static str,
        /// Its format.
        found: &'static str,
        /// The format that is read.
        expected: &'static str,
        /// What follows.
        consequence: &'static str,
    },
    /// The mesh is skinned or morphed.
    #[error("mesh \"{name}\" is {how}, so it takes part in its rest shape and gets no lightmap")]
    Deformed {
        /// The entity.
        name: String,
        /// Skinned or morphed.
        how: &'static str,
    },
    /// The mesh is a coarser level of detail.
    #[error("mesh \"{name}\" is shown from a distance only (VisibilityRange), so it is left out")]
    DistantLevelOfDetail {
        /// The entity.
        name: String,
    },
    /// The mesh is coloured by vertex.
    #[error("mesh \"{name}\" has vertex colours, which are not simulated yet; its base_color alone counts")]
    VertexColours {
        /// The entity.
        name: String,
    },
    /// The mesh has no material that is understood.
    #[error(
        "mesh \"{name}\" has no StandardMaterial, so it is taken as mid-grey and gets no lightmap; mark what is not \
         part of the scene by giving the rest a LightmapReceiver"
    )]
    NoStandardMaterial {
        /// The entity.
        name: String,
    },
    /// The material asset is not there.
    #[error("the material of \"{name}\" is not loaded, so it is taken as mid-grey; bake once it is")]
    MaterialNotLoaded {
        /// The entity.
        name: String,
    },
    /// The material has properties that are not simulated.
    #[error("material \"{name}\" has what is not simulated yet: {}", list(what))]
    NotSimulated {
        /// The material, or the entity that it is on.
        name: String,
        /// The properties.
        what: Vec<Unsimulated>,
    },
    /// Some materials reflect specularly.
    #[error("{count} materials have a specular reflection (\"{first}\" is one), which is not simulated yet")]
    Specular {
        /// How many.
        count: usize,
        /// The first of them.
        first: String,
    },
    /// A light of a kind that is not baked.
    #[error("{kind} \"{name}\" is not baked yet; Bevy goes on adding its direct light")]
    LightNotBaked {
        /// The entity.
        name: String,
        /// Its kind.
        kind: &'static str,
    },
    /// Light from around that is not baked.
    #[error("{kind} of \"{name}\" is not baked yet, and Bevy keeps its diffuse part off lightmapped meshes")]
    EnvironmentNotBaked {
        /// The entity.
        name: String,
        /// Its kind.
        kind: &'static str,
    },
    /// Ambient light that Bevy goes on adding.
    #[error(
        "the ambient light ({brightness} cd/m²) is not baked and Bevy adds it to the lightmaps; bake it \
         (AmbientMode::Bake) or set GlobalAmbientLight's brightness to 0"
    )]
    AmbientStays {
        /// Its brightness [cd/m²].
        brightness: f32,
    },
    /// A camera that takes no perspective picture.
    #[error("camera \"{name}\" has no perspective projection, so no picture can be rendered from it")]
    NoPerspective {
        /// The entity.
        name: String,
    },
    /// Two things that cannot be told apart.
    #[error("{count} things are called \"{id}\"; give each a KilnId so that a game can tell them apart")]
    SameId {
        /// The id that they share.
        id: String,
        /// How many share it.
        count: usize,
    },
}

fn list(what: &[Unsimulated]) -> String {
    what.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

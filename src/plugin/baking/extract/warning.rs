//! What of a Bevy scene a bake leaves out or takes for something simpler, by name.

use super::reread::NotReread;
use super::texture::Unreadable;
use thiserror::Error;

/// What of a material is not simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Unsimulated {
    /// `depth_map`.
    DepthMap,
    /// `anisotropy_strength` and its texture.
    Anisotropy,
    /// `clearcoat_normal_texture`.
    ClearcoatNormalMap,
    /// `specular_texture` and `specular_tint_texture`.
    SpecularTextures,
}

impl std::fmt::Display for Unsimulated {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::DepthMap => "depth map (taken as flat)",
            Self::Anisotropy => "anisotropy (taken as equally rough in all directions)",
            Self::ClearcoatNormalMap => "normal map of the clear coat (taken as smooth)",
            Self::SpecularTextures => "specular textures (reflectance and specular_tint alone count)",
        })
    }
}

/// What of a Bevy scene a bake leaves out or takes for something simpler.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExtractionWarning {
    /// The vertices are no longer in main memory.
    #[error(
        "mesh \"{name}\" is in the render world only{why}, so it is left out; make or load it with \
         RenderAssetUsages::MAIN_WORLD as well"
    )]
    RenderWorldOnly {
        /// The entity.
        name: String,
        /// Why it was not read again.
        why: NotReread,
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
    #[error("mesh \"{name}\" has its {attribute} as {found}, which cannot be read, so {consequence}")]
    AttributeFormat {
        /// The entity.
        name: String,
        /// Which attribute.
        attribute: &'static str,
        /// Its format.
        found: &'static str,
        /// What follows.
        consequence: &'static str,
    },
    /// A vertex attribute has NaN or infinity in it.
    #[error(
        "mesh \"{name}\" has {attribute} that are not finite numbers (the first at vertex {vertex}), so it is baked \
         wrongly around there; repair the mesh and export it again"
    )]
    NonFiniteAttribute {
        /// The entity.
        name: String,
        /// Which attribute.
        attribute: &'static str,
        /// The first such vertex.
        vertex: usize,
    },
    /// The mesh is skinned or morphed, and no mark asks for it.
    #[error(
        "mesh \"{name}\" is {how}, so it is left out, as what moves should be; mark it as a LightBlocker to bake it as \
         it stands"
    )]
    Deformed {
        /// The entity.
        name: String,
        /// Skinned or morphed.
        how: &'static str,
    },
    /// The mesh is skinned or morphed and below a `LightmapReceiver`.
    #[error("mesh \"{name}\" is {how}, so it gets no lightmap; it blocks and reflects light as it stands")]
    Posed {
        /// The entity.
        name: String,
        /// Skinned or morphed.
        how: &'static str,
    },
    /// The pose of a skinned or morphed mesh cannot be read.
    #[error("mesh \"{name}\" {why}, so its pose is not known and it is left out")]
    PoseNotRead {
        /// The entity.
        name: String,
        /// What is wrong.
        why: &'static str,
    },
    /// The thing is on other render layers than those that are baked.
    #[error(
        "\"{name}\" is on render layers that are not baked, so it is left out; SceneSettings::layers says which are"
    )]
    OtherLayers {
        /// The entity.
        name: String,
    },
    /// How Bevy draws shadows there has no match in light.
    #[error("mesh \"{name}\" has {component}: {consequence}")]
    ShadowFlag {
        /// The entity.
        name: String,
        /// The component.
        component: &'static str,
        /// What is baked.
        consequence: &'static str,
    },
    /// The mesh is a coarser level of detail.
    #[error(
        "mesh \"{name}\" is shown from {metres} m on only (VisibilityRange), so it is left out, as the levels of one \
         object would shade each other; irradiance volumes light it (BakeVolumes), or let its nearest level be seen \
         from afar"
    )]
    DistantLevelOfDetail {
        /// The entity.
        name: String,
        /// Where it begins to be seen [m].
        metres: f32,
    },
    /// Something is hidden, with all that is below it.
    #[error(
        "\"{name}\" is hidden (Visibility), so it is left out with what is below it ({count} {} in all); show it while \
         baking if it is a part of the scene",
        if *count == 1 { "mesh or light" } else { "meshes and lights" }
    )]
    Hidden {
        /// The entity.
        name: String,
        /// How many meshes and lights are left out.
        count: usize,
    },
    /// The mesh has no material that is understood.
    #[error(
        "mesh \"{name}\" has no StandardMaterial, so it is taken as mid-grey and gets no lightmap; say what its \
         material looks like with App::add_baked_material, or mark it NotBaked if it is not part of the scene"
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
    #[error("material \"{name}\" has what is not simulated: {}", list(what))]
    NotSimulated {
        /// The material, or the entity that it is on.
        name: String,
        /// The properties.
        what: Vec<Unsimulated>,
    },
    /// A picture of a material cannot be read.
    #[error("the {what} of \"{name}\" {why}; until then the material does without it")]
    TextureNotRead {
        /// The material, or the entity that it is on.
        name: String,
        /// Which of its pictures.
        what: &'static str,
        /// Why not.
        why: Unreadable,
    },
    /// An extension of glTF that Bevy's loader does not read.
    #[error("the file uses {extension}, which Bevy does not read: it is neither shown nor baked")]
    ExtensionNotRead {
        /// The extension.
        extension: String,
    },
    /// A light that shines through a picture.
    #[error("light \"{name}\" shines through a picture ({component}), which is not simulated: it is baked without")]
    LightPicture {
        /// The entity.
        name: String,
        /// The component that holds the picture.
        component: &'static str,
    },
    /// Light from around that is not baked.
    #[error("{kind} of \"{name}\" is not baked, and Bevy keeps its diffuse part off lightmapped meshes; {instead}")]
    EnvironmentNotBaked {
        /// The entity.
        name: String,
        /// Its kind.
        kind: &'static str,
        /// What to do.
        instead: &'static str,
    },
    /// A picture of the sky cannot be read.
    #[error("the environment map of \"{name}\" {why}; until then it is not baked")]
    EnvironmentNotRead {
        /// The entity, or what asks for it.
        name: String,
        /// Why not.
        why: Unreadable,
    },
    /// Only a blurred picture of the sky can be read.
    #[error("the specular map of \"{name}\" {why}; its diffuse map stands in for it, which blurs its light")]
    EnvironmentBlurred {
        /// The entity.
        name: String,
        /// Why not.
        why: Unreadable,
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
    /// A custom property of a glTF file that cannot be read.
    #[error("\"{name}\" {fault}")]
    Extras {
        /// The entity.
        name: String,
        /// Which, and why.
        fault: String,
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

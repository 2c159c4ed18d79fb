//! What can be wrong with a scene, and with which part of it.

use thiserror::Error;

/// The part of a scene that a [`Fault`] is about, by the name that its author gave it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A shape.
    Mesh(String),
    /// A placed mesh.
    Instance(String),
    /// A surface description.
    Material(String),
    /// A picture that materials refer to.
    Texture(String),
    /// A light source.
    Light(String),
    /// The sky.
    Sky,
    /// The picture of the sky.
    Environment(String),
}

impl std::fmt::Display for Subject {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Mesh(name) => write!(f, "mesh \"{name}\""),
            Self::Instance(name) => write!(f, "instance \"{name}\""),
            Self::Material(name) => write!(f, "material \"{name}\""),
            Self::Texture(name) => write!(f, "texture \"{name}\""),
            Self::Light(name) => write!(f, "light \"{name}\""),
            Self::Sky => write!(f, "the sky"),
            Self::Environment(name) => write!(f, "environment map \"{name}\""),
        }
    }
}

/// One thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{subject} {kind}")]
pub struct Fault {
    /// What is at fault.
    pub subject: Subject,
    /// What is wrong with it.
    pub kind: FaultKind,
}

/// What is wrong with a [`Subject`]. Reads as the rest of a sentence that begins with its name.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FaultKind {
    /// A vertex position is NaN or infinite.
    #[error("has a position that is not a finite number (vertex {vertex}); repair the mesh and export it again")]
    NonFinitePosition {
        /// The first such vertex.
        vertex: usize,
    },
    /// An index points past the last vertex.
    #[error("has index {index} but only {vertex_count} vertices; export the mesh again")]
    IndexOutOfRange {
        /// The first such index.
        index: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// The number of indices (or of vertices, without indices) is no whole number of triangles.
    #[error("ends in the middle of a triangle ({count} corners); export the mesh again")]
    IncompleteTriangle {
        /// How many corners there are.
        count: usize,
    },
    /// There is no triangle with an area in it.
    #[error("has no triangle with an area")]
    NoTriangles,
    /// A vertex attribute has another length than the positions.
    #[error("has {count} {attribute} for {vertex_count} vertices; export the mesh again")]
    AttributeLength {
        /// Which attribute.
        attribute: &'static str,
        /// How many values it has.
        count: usize,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// It asks for a lightmap and has no UV1.
    #[error("has no UV1 (TEXCOORD_1), so it blocks and reflects light but gets no lightmap; add a second UV set")]
    MissingUv1,
    /// A UV1 coordinate is outside the unit square or not finite.
    #[error(
        "has a UV1 (TEXCOORD_1) outside the unit square (vertex {vertex}), so it gets no lightmap; lay it out again"
    )]
    Uv1OutsideUnitSquare {
        /// The first such vertex.
        vertex: usize,
    },
    /// The UV1 has no area, so no texel lies on the mesh.
    #[error("has a UV1 (TEXCOORD_1) without area, so it gets no lightmap; lay it out again")]
    Uv1WithoutArea,
    /// A lightmap density that is not positive and finite.
    #[error("asks for a lightmap of {density} texels per metre; ask for a positive number")]
    Density {
        /// What was asked for [1/m].
        density: f32,
    },
    /// A transform that is not finite or that flattens space.
    #[error("has a transform that cannot be inverted; give it a scale other than zero on every axis")]
    SingularTransform,
    /// A vertex so far away in the world that what is near could no longer be told apart.
    #[error(
        "has a vertex {distance:.1e} m from the world's origin, farther than the {limit:.0e} m that can be traced; bring \
         it nearer or make the world smaller"
    )]
    TooFar {
        /// The largest coordinate of the first such vertex [m].
        distance: f64,
        /// The farthest that is traced [m].
        limit: f64,
    },
    /// It refers to a mesh that is not there.
    #[error("refers to mesh number {index}, which is not there")]
    MissingMesh {
        /// The index asked for.
        index: usize,
    },
    /// It refers to a material that is not there.
    #[error("refers to material number {index}, which is not there")]
    MissingMaterial {
        /// The index asked for.
        index: usize,
    },
    /// Two instances or two lights share an id, so they could not be told apart.
    #[error("has the same id as another; give each its own name")]
    DuplicateId,
    /// It refers to a texture that is not there.
    #[error("refers to texture number {index}, which is not there")]
    MissingTexture {
        /// The index asked for.
        index: usize,
    },
    /// A texture whose size and texels do not go together. It is ignored.
    #[error("says {width} × {height} texels and has {texels}, so it is ignored; export it again")]
    TexelCount {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// How many texels it has.
        texels: usize,
    },
    /// A texture with NaN or infinity in it. It is ignored.
    #[error("has a texel that is not a finite number (at {x}, {y}), so it is ignored; repair the picture")]
    NonFiniteTexel {
        /// Column of the first such texel.
        x: u32,
        /// Its row.
        y: u32,
    },
    /// A number of a material that is NaN or outside what it can mean.
    #[error("has {what} of {value}, outside {low} to {high}; correct it")]
    OutOfRange {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f32,
        /// The smallest that has a meaning.
        low: f32,
        /// The largest.
        high: f32,
    },
    /// A transform of texture coordinates that is not finite.
    #[error("has a texture transform that is not a finite number; correct it")]
    BadUvTransform,
    /// A colour outside [0, 1], or not finite.
    #[error("has a base colour outside 0 to 1 and would make light out of nothing; correct the colour")]
    ColourOutOfRange,
    /// An emission that is negative or not finite.
    #[error("has an emission that is negative or not a finite number; correct it")]
    BadEmission,
    /// An emission with which light could not be computed.
    #[error("has an emission of {value:e}, above {limit:e}, where numbers end; give it less")]
    TooBright {
        /// Its strongest channel [cd/m², cd or lx].
        value: f32,
        /// The most that it may be, in the same unit.
        limit: f32,
    },
    /// A range that is not above zero; NaN would spread to every texel.
    #[error("has a range of {range} m, so it gives no light; give it one above zero")]
    BadRange {
        /// The range asked for [m].
        range: f32,
    },
    /// A light that is nowhere.
    #[error("has a position that is not a finite number; correct it")]
    NonFiniteLight,
    /// A radius that is negative or not finite.
    #[error("has a radius of {radius} m; give it one of zero or more")]
    BadRadius {
        /// The radius asked for [m].
        radius: f32,
    },
    /// A direction without length.
    #[error("has a direction of no length; give it one")]
    BadDirection,
    /// A cone that is none.
    #[error(
        "has a cone from {inner} to {outer} rad; give it an inner angle of at least 0, and an outer one of at least \
         that and at most π"
    )]
    BadCone {
        /// The angle within which it is not dimmed [rad].
        inner: f32,
        /// The angle beyond which it is dark [rad].
        outer: f32,
    },
    /// A disc that is no disc.
    #[error("has an angular diameter of {diameter} rad; give it one from 0 to π")]
    BadDiameter {
        /// The diameter asked for [rad].
        diameter: f32,
    },
    /// A picture without pixels, or with more or fewer than its size says.
    #[error("has {count} pixels for a size of {width} × {height}; load it again")]
    BadSize {
        /// Width [pixels].
        width: u32,
        /// Height [pixels].
        height: u32,
        /// How many pixels there are.
        count: usize,
    },
    /// A pixel that is negative or not finite.
    #[error(
        "has a pixel that is negative or not a finite number (the first at column {column}, row {row} from the top \
         left); correct it"
    )]
    BadPixel {
        /// Its column.
        column: usize,
        /// Its row.
        row: usize,
    },
    /// A pixel with which light could not be computed.
    #[error(
        "has a pixel brighter than {limit:e} cd/m², where numbers end (the first at column {column}, row {row} from \
         the top left); correct it"
    )]
    TooBrightPixel {
        /// Its column.
        column: usize,
        /// Its row.
        row: usize,
        /// The most that it may be [cd/m²].
        limit: f32,
    },
    /// A rotation that is none.
    #[error("has a rotation that is not a finite quaternion of length 1; correct it")]
    BadRotation,
    /// A light source without area.
    #[error("has no area, so it gives no light; give it a width and a height")]
    ZeroArea,
}

impl FaultKind {
    /// Whether the subject can still block and reflect light: it then loses its lightmap only.
    pub fn costs_only_the_lightmap(&self) -> bool {
        matches!(
            self,
            Self::MissingUv1 | Self::Uv1OutsideUnitSquare { .. } | Self::Uv1WithoutArea | Self::Density { .. }
        )
    }
}

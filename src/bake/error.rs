//! Why a bake did not happen, and what it left out, sorted by who must act.

use super::gather::Estimate;
use super::unwrap::Uv1Fault;
use crate::artefact::StableId;
use crate::scene::{Fault, Subject};
use crate::trace::{Census, Effect, EffectSet, MAX_VERTICES, Transport};
use thiserror::Error;

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BakeError {
    /// The scene: nothing in it gives light.
    #[error(
        "the scene has no light{because}: add a light or an emissive material, or give it a sky (--sky R,G,B or --environment)"
    )]
    NoLight {
        /// The first fault, in brackets, where a light was left out; else empty.
        because: String,
    },
    /// The scene: nothing in it can be baked.
    #[error("nothing in the scene can receive a lightmap: {reason}")]
    NothingToBake {
        /// Why not.
        reason: String,
    },
    /// The scene: light in it neither leaves nor is absorbed, so that it would grow for ever.
    #[error(
        "light goes on for more than {surfaces} surfaces without an end, the last of them of material \"{material}\", \
         because next to nothing is absorbed there and nothing gets out; lower the albedo (base colour) to 0.99 or \
         less, let clear glass absorb a little, or set a cap on bounces"
    )]
    KeepsLight {
        /// The material at which a path was given up.
        material: String,
        /// How many surfaces it had met.
        surfaces: u32,
    },
    /// The settings.
    #[error("{setting}: {reason}")]
    Settings {
        /// The setting at fault, by its name on the command line.
        setting: &'static str,
        /// What is wrong with it and what to do.
        reason: String,
    },
    /// The machine.
    #[error("cannot start the baking threads: {reason}")]
    Threads {
        /// What the system said.
        reason: String,
    },
    /// A person stopped it.
    #[error("cancelled")]
    Cancelled,
}

/// What a bake left out or changed, by name.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BakeWarning {
    /// A fault of the scene; what is at fault was left out.
    #[error("{0}; left out")]
    LeftOut(Fault),
    /// A fault of the scene that costs an object only its lightmap.
    #[error("{0}")]
    NoLightmap(Fault),
    /// A UV1 that cannot carry a lightmap; the mesh was unwrapped anew.
    #[error("{subject} has a UV1 (TEXCOORD_1) that {fault}, so it was unwrapped anew; lay it out again to keep yours")]
    Unwrapped {
        /// The mesh.
        subject: Subject,
        /// What is wrong with its own UV1.
        fault: Uv1Fault,
    },
    /// A mesh on which a good unwrap would have taken too long.
    #[error(
        "{subject} is too tangled for a good unwrap ({triangles} triangles, {charts} charts), so each of its planes \
         got a chart of its own; give it a second UV set or simplify it"
    )]
    SimpleUnwrap {
        /// The mesh.
        subject: Subject,
        /// How many triangles it has.
        triangles: u64,
        /// How many charts it got.
        charts: u64,
    },
    /// A mesh in so many pieces that no page has room for them.
    #[error(
        "{subject} falls into {charts} charts, which is more than a page of {limit} × {limit} texels has room for, so \
         it gets no lightmap; split it into several objects"
    )]
    TooManyCharts {
        /// The object.
        subject: Subject,
        /// How many charts it has.
        charts: u64,
        /// Largest page [texels].
        limit: u32,
    },
    /// A UV1 that cannot carry a lightmap and that a texture is looked up by, so that it cannot be laid out anew.
    #[error(
        "{subject} has a UV1 (TEXCOORD_1) that {fault}, and its material looks textures up by it, so it was kept as it \
         is; give the textures UV0"
    )]
    Uv1InUse {
        /// The object.
        subject: Subject,
        /// What is wrong with its UV1.
        fault: Uv1Fault,
    },
    /// An object that needs more texels than a page can have.
    #[error(
        "{subject} asks for {asked} texels per metre and got {got}, since a page has room for {limit} × {limit} texels; \
         split it into several objects for more"
    )]
    LoweredDensity {
        /// The object.
        subject: Subject,
        /// What it asked for [1/m].
        asked: f32,
        /// What it got [1/m].
        got: f32,
        /// Most texels along a side of a page [texels].
        limit: u32,
    },
    /// Parts of a UV1 lie over each other, so that they share texels.
    #[error(
        "{subject} has overlapping UV1 in {texels} texels, which mix the light of different places; lay it out again"
    )]
    OverlappingUv1 {
        /// The object, or the first of those that share a map.
        subject: Subject,
        /// How many texels.
        texels: u64,
    },
    /// An object whose UV1 covers no texel by enough to be measured.
    #[error(
        "{subject} covers less than a thousandth of any texel, so it gets no lightmap; ask for more texels per metre"
    )]
    NoTexels {
        /// The object.
        subject: Subject,
    },
    /// Texels that Bevy shows nothing of.
    #[error(
        "{texels} of {all} texels are on what shows no lightmap, since all of it is metal or lets light through \
         (materials: {materials}); make it a LightBlocker, or lower its metallic value where it should be matte: glTF \
         makes a mesh without a material a white metal"
    )]
    Unseen {
        /// How many texels.
        texels: u64,
        /// Of how many.
        all: u64,
        /// Names of the materials.
        materials: String,
    },
    /// Effects that a scene calls for and that a person forced off.
    #[error("forced off, so that their light is missing: {effects}")]
    ForcedOff {
        /// Their names.
        effects: String,
    },
    /// Light that no path finds: from lights without a size by way of perfectly smooth surfaces.
    #[error(
        "lights without a size ({lights}) shine neither through perfectly smooth bodies of glass nor off perfectly \
         smooth mirrors (materials: {materials}); give such a light a radius (a sun a SunDisk), or a pane no thickness"
    )]
    Unfindable {
        /// How many such lights.
        lights: u64,
        /// How many such materials.
        materials: u64,
    },
    /// Paths whose light was no number. Counted as dark.
    #[error(
        "{paths} paths brought light that is negative or not a finite number, and were left out, so that the light is \
         too dark there; look for numbers near the largest that a computer holds, as in textures of emission"
    )]
    NotLight {
        /// How many paths.
        paths: u64,
    },
    /// Paths that nothing ended.
    #[error(
        "{paths} paths met {surfaces} surfaces without an end and were cut, so that light may be missing; somewhere \
         next to nothing is absorbed and nothing gets out: lower the albedo (base colour) there to 0.99 or less"
    )]
    Endless {
        /// How many paths.
        paths: u64,
        /// After how many surfaces.
        surfaces: u32,
    },
    /// An irradiance volume that lies inside of bodies.
    #[error("irradiance volume \"{volume}\" has no probe in the air, so it was left out; move it or let it be larger")]
    NoAir {
        /// The volume.
        volume: StableId,
    },
    /// More irradiance volumes than Bevy shows.
    #[error(
        "there are {volumes} irradiance volumes, and Bevy shows the {limit} that are in view and whose middle is nearest \
         to the camera; merge some of them"
    )]
    TooManyVolumes {
        /// How many there are.
        volumes: usize,
        /// How many are shown.
        limit: usize,
    },
    /// Texel values beyond what a texture format can hold.
    #[error("{texels} texels are brighter than {format} can hold ({limit} cd/m²) and were clamped")]
    Clamped {
        /// How many texels.
        texels: u64,
        /// The format.
        format: &'static str,
        /// The largest value that it holds [cd/m²].
        limit: f32,
    },
}

impl BakeWarning {
    /// What a scene's lights and surfaces give reason to warn of, beside faults.
    pub(super) fn of_transport(transport: &Transport, census: &Census) -> impl Iterator<Item = Self> {
        let (lights, materials) = (census.unsized_lights(), census.smooth_materials());
        let unfindable = (lights > 0 && materials > 0).then_some(Self::Unfindable { lights, materials });
        Self::forced_off(transport, census.called()).into_iter().chain(unfindable)
    }

    /// What is to be said of paths.
    pub(super) fn of_paths(estimates: &[Estimate]) -> impl Iterator<Item = Self> {
        let sum = |count: fn(&Estimate) -> u64| estimates.iter().map(count).sum();
        let (not_light, endless): (u64, u64) = (sum(|estimate| estimate.not_light), sum(|estimate| estimate.endless));
        let not_light = (not_light > 0).then_some(Self::NotLight { paths: not_light });
        let endless = (endless > 0).then_some(Self::Endless { paths: endless, surfaces: MAX_VERTICES });
        not_light.into_iter().chain(endless)
    }

    /// The warning of effects that are called for and forced off, if there are any.
    fn forced_off(transport: &Transport, called: EffectSet) -> Option<Self> {
        let missing: Vec<&str> =
            called.iter().filter(|&effect| transport.effects.off.has(effect)).map(Effect::name).collect();
        (!missing.is_empty()).then(|| Self::ForcedOff { effects: missing.join(", ") })
    }
}

impl From<Fault> for BakeWarning {
    fn from(fault: Fault) -> Self {
        if fault.kind.costs_only_the_lightmap() { Self::NoLightmap(fault) } else { Self::LeftOut(fault) }
    }
}

//! The command line as data.

use crate::parse;
use bevy::camera::visibility::RenderLayers;
use bevy_kiln::bake::{Goal, LaterBounces};
use bevy_kiln::output::{OutputFormat, ToneCurve};
use bevy_kiln::plugin::EmissiveUnit;
use bevy_kiln::trace::Effect;
use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::Vec3;
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;
use std::time::Duration;

/// Bakes global illumination for Bevy.
#[derive(Debug, Parser)]
#[command(name = "kiln", version, about, propagate_version = true)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Bake the lightmaps of a scene into a folder
    Bake(BakeArgs),
    /// Say what would be simulated, what not, and why; and what it would cost
    Plan(PlanArgs),
    /// Measure the irradiance at given points, as a light meter does
    Irradiance(IrradianceArgs),
    /// Take a path-traced picture
    Render(RenderArgs),
    /// Join the shards of a bake
    #[command(hide = true)]
    Merge(AnythingArgs),
    /// Say what accuracy costs in time: table, plots, pictures
    Study(StudyArgs),
}

#[derive(Debug, Args)]
pub(crate) struct AnythingArgs {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pub(crate) rest: Vec<String>,
}

#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// The scene: a .glb, .gltf or .scn.ron file
    pub(crate) scene: PathBuf,
    /// What emission stands for: "nits" (radiance, cd/m²) or "displayed[=EV100]" (as it looks on screen)
    #[arg(long, value_name = "nits|displayed[=EV100]", default_value = "displayed=9.7", value_parser = parse::emissive)]
    pub(crate) emissive: EmissiveUnit,
    /// A sky that is the same in every direction (radiance, cd/m², linear)
    #[arg(long, value_name = "R,G,B", value_parser = parse::sky, allow_hyphen_values = true)]
    pub(crate) sky: Option<Vec3>,
    /// A picture of the sky: equirectangular, radiance in cd/m², +Y up, +X in the middle
    #[arg(long, value_name = "FILE.hdr|.exr")]
    pub(crate) environment: Option<PathBuf>,
    /// Which render layers take part
    #[arg(long, value_name = "N,...", default_value = "0", value_parser = parse::layers)]
    pub(crate) layers: RenderLayers,
    /// Let lights shine beyond their range
    #[arg(long)]
    pub(crate) no_range: bool,
    /// Cut paths after N bounces, which loses light: 0 is direct light only
    #[arg(long, value_name = "N|none", default_value = "none", value_parser = parse::max_bounces, allow_hyphen_values = true)]
    pub(crate) max_bounces: Bounces,
    /// Which samples estimates of light are made of
    #[arg(long, value_enum, default_value_t = EstimatorArg::Mis)]
    pub(crate) estimator: EstimatorArg,
    /// Changes every random number, and nothing else
    #[arg(long, value_name = "N", default_value = "0", value_parser = parse::seed, allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// The most that one path may bring (cd/m²): takes out bright specks and, with them, light
    #[arg(long, value_name = "RADIANCE", value_parser = parse::clamp, allow_hyphen_values = true)]
    pub(crate) clamp: Option<f32>,
    /// Simulate an effect although the scene does not call for it (see kiln plan for their names)
    #[arg(long, value_name = "EFFECT,...", value_delimiter = ',', value_parser = parse::effect)]
    pub(crate) with: Vec<Effect>,
    /// Leave an effect out although the scene calls for it: its light is then missing
    #[arg(long, value_name = "EFFECT,...", value_delimiter = ',', value_parser = parse::effect)]
    pub(crate) without: Vec<Effect>,
    /// Threads that trace [default: all cores]
    #[arg(long, value_name = "N", value_parser = parse::threads, allow_hyphen_values = true)]
    pub(crate) threads: Option<NonZeroUsize>,
}

/// A cap on bounces; its own type, as an `Option` would mean an absent argument.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounces(pub(crate) Option<u32>);

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum EstimatorArg {
    /// Light and surface samples, weighted
    Mis,
    /// Points on the sources only
    Light,
    /// Directions from the surface only
    Bsdf,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum ToneArg {
    /// Clip it: for comparisons
    None,
    /// Reinhard's curve on luminance
    Reinhard,
    /// The Academy's film curve
    Aces,
}

impl From<ToneArg> for ToneCurve {
    fn from(tone: ToneArg) -> Self {
        match tone {
            ToneArg::None => Self::Clip,
            ToneArg::Reinhard => Self::Reinhard,
            ToneArg::Aces => Self::Aces,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum LayoutArg {
    /// Each object has its own rectangle at the asked density
    Packed,
    /// TEXCOORD_1 is one atlas for the whole scene
    Shared,
}

#[derive(Debug, Args)]
pub(crate) struct LayoutArgs {
    /// Texels per metre of surface
    #[arg(long, value_name = "TEXELS_PER_METRE", default_value_t = 16.0, allow_hyphen_values = true)]
    pub(crate) density: f32,
    /// Where the texels go
    #[arg(long, value_enum, default_value_t = LayoutArg::Packed)]
    pub(crate) layout: LayoutArg,
    /// Width and height of a shared map [texels]
    #[arg(long, value_name = "N", required_if_eq("layout", "shared"))]
    pub(crate) size: Option<u32>,
    /// Largest width and height of a texture, 64 to 4096 [texels]
    #[arg(long, value_name = "N", default_value_t = 4096, allow_hyphen_values = true)]
    pub(crate) page_size: u32,
}

/// When a texel has been sampled enough.
#[derive(Debug, Args)]
pub(crate) struct GoalArgs {
    /// How wrong a texel may be: in 95 of 100 cases the truth is no farther off than this share of its value [default:
    /// 2%]
    #[arg(long, value_name = "E%", value_parser = parse::error, allow_hyphen_values = true, conflicts_with_all = ["time", "spp"])]
    pub(crate) error: Option<f64>,
    /// How long it may take, such as 90s, 5m or 1h: gives the smallest error that a pilot says can be had in it
    #[arg(long, value_name = "T", value_parser = parse::time, allow_hyphen_values = true, conflicts_with = "spp")]
    pub(crate) time: Option<Duration>,
    /// Paths that start in each texel, instead of an error
    #[arg(long, value_name = "N", value_parser = parse::count, allow_hyphen_values = true)]
    pub(crate) spp: Option<NonZeroU32>,
    /// End paths on texels of a short first pass instead of following them: several times as fast, and biased by less
    /// than 1 %
    #[arg(long)]
    pub(crate) fast: bool,
}

impl GoalArgs {
    pub(crate) fn later_bounces(&self) -> LaterBounces {
        if self.fast { LaterBounces::Reused } else { LaterBounces::Traced }
    }

    pub(crate) fn goal(&self) -> Goal {
        match (self.error, self.time, self.spp) {
            (Some(error), ..) => Goal::Error(error),
            (_, Some(time), _) => Goal::Time(time),
            (.., Some(paths)) => Goal::Samples(paths.get()),
            _ => Goal::default(),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct BakeArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The folder that gets the textures and kiln.ron
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) layout: LayoutArgs,
    #[command(flatten)]
    pub(crate) goal: GoalArgs,
    /// How texels are stored: rgb9e5, rgba16f, bc6h (compressed, a quarter of rgb9e5), or exr (rgb9e5 and f32 EXR
    /// besides)
    #[arg(long, value_name = "rgb9e5|rgba16f|bc6h|exr", default_value_t)]
    pub(crate) format: OutputFormat,
    /// End standard output with one JSON object
    #[arg(long)]
    pub(crate) json: bool,
    /// Say how far the bake is from this one: a folder of the same scene and density, with many more samples and
    /// --format exr
    #[arg(long, value_name = "DIR")]
    pub(crate) reference: Option<PathBuf>,
    /// Leave the noise in the texels
    #[arg(long)]
    pub(crate) no_denoise: bool,
    /// Bake irradiance volumes around the scene, for things that move, with probes this far apart [default: 0.25 m, or
    /// more in a large scene]
    #[arg(long, value_name = "METRES", num_args = 0..=1, require_equals = true)]
    pub(crate) volumes: Option<Option<f32>>,
    #[arg(long, hide = true)]
    pub(crate) resume: bool,
    #[arg(long, hide = true)]
    pub(crate) shard: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) layout: LayoutArgs,
    #[command(flatten)]
    pub(crate) goal: GoalArgs,
    /// End standard output with one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct IrradianceArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Table of points: columns x,y,z,nx,ny,nz by name, world metres
    #[arg(long, value_name = "P.csv")]
    pub(crate) points: PathBuf,
    /// Where the answer goes [default: standard output]
    #[arg(short, long, value_name = "OUT.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Paths that start from each point
    #[arg(long, value_name = "N", default_value = "256", value_parser = parse::count, allow_hyphen_values = true)]
    pub(crate) spp: NonZeroU32,
    #[arg(long, hide = true)]
    pub(crate) error: Option<String>,
    #[arg(long, hide = true)]
    pub(crate) time: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The picture: .png (exposed) or .exr (linear radiance)
    #[arg(short, long, value_name = "IMG")]
    pub(crate) output: PathBuf,
    /// A camera of the scene by name [default: its first]
    #[arg(long, value_name = "NAME", conflicts_with_all = ["eye", "target"])]
    pub(crate) camera: Option<String>,
    /// Where to look from [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::point, allow_hyphen_values = true, requires = "target")]
    pub(crate) eye: Option<Vec3>,
    /// Where to look at [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse::point, allow_hyphen_values = true, requires = "eye")]
    pub(crate) target: Option<Vec3>,
    /// Whole vertical opening angle [°]
    #[arg(long, value_name = "DEG", default_value = "45", value_parser = parse::fov, allow_hyphen_values = true)]
    pub(crate) fov: f32,
    /// Width and height [pixels]
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = parse::size)]
    pub(crate) size: (u32, u32),
    /// Paths that start in each pixel
    #[arg(long, value_name = "N", default_value = "256", value_parser = parse::count, allow_hyphen_values = true)]
    pub(crate) spp: NonZeroU32,
    /// Exposure of a .png: the camera's exposure value at ISO 100
    #[arg(long, value_name = "EV", default_value_t = 9.7, allow_hyphen_values = true)]
    pub(crate) ev100: f32,
    /// What becomes of what is brighter than a screen in a .png; the names are Bevy's
    #[arg(long, value_enum, default_value_t = ToneArg::Aces)]
    pub(crate) tonemapping: ToneArg,
    #[arg(long, hide = true)]
    pub(crate) error: Option<String>,
    #[arg(long, hide = true)]
    pub(crate) time: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct StudyArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The folder that gets study.md, its plots and its pictures
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) layout: LayoutArgs,
    /// How long it may take, such as 90s, 5m or 1h
    #[arg(long, value_name = "T", default_value = "20m", value_parser = parse::time, allow_hyphen_values = true)]
    pub(crate) time: Duration,
}

//! What is measured and where it is kept: lightmaps, irradiance volumes, light meters and pictures.
//!
//! A lightmap is made in five steps, [`bake_lightmap`] in a screen:
//!
//! 1. `unwrap` gives every mesh without a valid UV1 one, and the scene is compiled for rays; what is at fault is left
//!    out and named;
//! 2. `atlas` gives every object its rectangle of texels;
//! 3. `raster` finds the texels that each triangle covers, however little of them, and `sites` lists them;
//! 4. `tiles` samples texels until each is known well enough; `gather` traces the paths from the covered part of one, in
//!    independently scrambled replicates whose spread is its standard error; `survey` says beforehand what that takes;
//! 5. `repair` takes out the noise, keeps light from crossing walls, fills the texels beside the charts that texture
//!    filtering also reads, and mends seams.
//!
//! Every number is a function of the scene, the settings and the seed: threads and order cannot matter.

mod atlas;
mod baker;
mod balance;
mod charts;
mod endless;
mod error;
mod film;
mod gather;
mod goal;
mod layout;
mod lightmap;
mod live;
mod meter;
mod picture;
mod plan;
mod progress;
mod raster;
mod receivers;
mod repair;
mod report;
mod reuse;
mod settings;
mod sites;
mod survey;
mod texel;
mod tiles;
mod unseen;
mod unwrap;
mod validity;
mod volume;
mod workers;

pub use baker::Baker;
pub use error::{BakeError, BakeWarning};
pub(crate) use film::{Film, FilmSettings};
pub use gather::REPLICATES;
pub use goal::{DARK, Goal};
pub use layout::{TexelLayout, unwrap_meshes};
pub use lightmap::{Lightmap, Page, Placement, bake_lightmap};
pub use live::LiveSink;
pub use meter::{Measurement, MeterPoint, MeterReading, MeterSettings, measure_irradiance};
pub use picture::{Picture, PictureSettings, render_picture};
pub use plan::{BakePlan, PlannedEffect, Prediction};
pub use progress::{CancelToken, Progress, ProgressSink, Stage};
pub(crate) use receivers::{Manner, Numbers, Receivers, Sums, thread_count};
pub use repair::{Filtering, TexelState};
pub use report::{BakeReport, Denoised, Intervals, Jump, RelativeError, SeamReport};
pub use reuse::FirstPass;
pub use settings::{BakeSettings, Denoise, LaterBounces, Layout};
pub use unwrap::{LaidOutMesh, UnwrapMethod, Uv1Fault};
pub use volume::{MOST_VOLUMES, ProbeState, Volume, VolumeBake, VolumeBox, VolumeBoxes, VolumeSettings, bake_volumes};

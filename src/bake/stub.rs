#![allow(missing_docs)]
#![allow(unused_variables)]
use super::*;
use crate::scene::{Camera, Scene};
use crate::trace::Transport;
use glam::Vec3;
use std::num::NonZeroUsize;
pub fn bake_lightmap(
    scene: &Scene,
    settings: &BakeSettings,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Lightmap, BakeError> {
    Err(BakeError::Cancelled)
}
#[derive(Clone, Copy, Debug)]
pub struct MeterPoint {
    pub position: Vec3,
    pub normal: Vec3,
}
#[derive(Clone, Copy, Debug)]
pub struct MeterReading {
    pub irradiance: Vec3,
    pub stderr: Vec3,
    pub samples: u64,
}
pub struct Measurement {
    pub readings: Vec<MeterReading>,
    pub report: BakeReport,
}
pub fn measure_irradiance(
    scene: &Scene,
    points: &[MeterPoint],
    samples_per_point: u32,
    transport: &Transport,
    threads: Option<NonZeroUsize>,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Measurement, BakeError> {
    Err(BakeError::Cancelled)
}
pub struct PictureSettings {
    pub transport: Transport,
    pub width: u32,
    pub height: u32,
    pub samples_per_pixel: u32,
    pub threads: Option<NonZeroUsize>,
}
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub radiance: Vec<Vec3>,
    pub stderr: Vec<Vec3>,
    pub report: BakeReport,
}
pub fn render_picture(
    scene: &Scene,
    camera: &Camera,
    settings: &PictureSettings,
    progress: &dyn ProgressSink,
    cancel: &CancelToken,
) -> Result<Picture, BakeError> {
    Err(BakeError::Cancelled)
}
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    Diffuse,
}
impl std::fmt::Display for Effect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("diffuse")
    }
}
#[derive(Clone, Debug)]
pub struct PlannedEffect {
    pub effect: Effect,
    pub on: bool,
    pub reason: String,
}
#[derive(Clone, Debug)]
pub struct Prediction {
    pub error: f64,
    pub seconds: f64,
}
#[derive(Clone, Debug)]
pub struct BakePlan {
    pub effects: Vec<PlannedEffect>,
    pub texels: u64,
    pub pages: u32,
    pub memory_bytes: u64,
    pub predicted: Vec<Prediction>,
    pub warnings: Vec<BakeWarning>,
}
impl BakePlan {
    pub fn for_scene(scene: &Scene, settings: &BakeSettings) -> Result<BakePlan, BakeError> {
        Err(BakeError::Cancelled)
    }
}

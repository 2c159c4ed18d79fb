//! What the command line asks for.

use super::stage::Stage;
use bevy::prelude::Resource;
use bevy_kiln::prelude::LightmapFiltering;
use std::path::PathBuf;

/// What was asked for.
#[derive(Resource, Clone, Debug)]
pub struct Args {
    /// What is shown.
    pub stage: Stage,
    /// Paths from each texel.
    pub spp: u32,
    /// Texels per metre.
    pub density: f32,
    /// A bake of before, which is shown instead.
    pub folder: Option<PathBuf>,
    /// Where a bake is written to.
    pub save: Option<PathBuf>,
    /// How texels are filtered.
    pub filtering: LightmapFiltering,
    /// The camera's exposure value at ISO 100.
    pub ev100: f32,
    /// Where a picture goes; `None` for a run with a person.
    pub screenshot: Option<PathBuf>,
    /// Width and height of the picture [pixels].
    pub size: [u32; 2],
}

/// What to do.
pub enum Call {
    Run(Box<Args>),
    Help,
}

/// The options in words.
pub fn usage(stage: &Stage) -> String {
    let Stage { name, ev100, size: [width, height], .. } = stage;
    format!(
        "\
usage: {name} [--spp N] [--density D] [--folder DIR | --save DIR] [--bicubic] [--ev100 EV] [--screenshot FILE.png [--size N|WxH]]
  --spp N             paths from each texel (64)
  --density D         texels per metre (16)
  --folder DIR        show what the kiln command has baked, instead of baking
  --save DIR          write what is baked to a folder, as the kiln command does
  --bicubic           filter texels by cubic splines rather than linearly
  --ev100 EV          the camera's exposure value; less is brighter ({ev100})
  --screenshot FILE   bake, take a picture of the window, end
  --size N|WxH        width and height of that window in pixels ({width}x{height})"
    )
}

impl Args {
    /// Reads the arguments after the program's name. An error is a sentence.
    pub fn parse(stage: Stage, mut words: impl Iterator<Item = String>) -> Result<Call, String> {
        let filtering = LightmapFiltering::Bilinear;
        let Stage { ev100, size, .. } = stage;
        let mut args =
            Self { stage, spp: 64, density: 16.0, folder: None, save: None, filtering, ev100, screenshot: None, size };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
            match word.as_str() {
                "--help" | "-h" => return Ok(Call::Help),
                "--spp" => args.spp = number(&word, &value()?, [1.0, 1e6])? as u32,
                "--density" => args.density = number(&word, &value()?, [0.1, 1000.0])? as f32,
                "--folder" => args.folder = Some(PathBuf::from(value()?)),
                "--save" => args.save = Some(PathBuf::from(value()?)),
                "--bicubic" => args.filtering = LightmapFiltering::Bicubic,
                "--ev100" => args.ev100 = number(&word, &value()?, [-20.0, 30.0])? as f32,
                "--screenshot" => args.screenshot = Some(picture(value()?)?),
                "--size" => args.size = size_of(&word, &value()?)?,
                _ => return Err(format!("there is no argument {word}")),
            }
        }
        if args.folder.is_some() && args.save.is_some() {
            return Err("--folder shows a bake of before, and there is none to --save".into());
        }
        Ok(Call::Run(Box::new(args)))
    }
}

fn number(word: &str, text: &str, [least, most]: [f64; 2]) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("{word} takes a number from {least} to {most}, not {text}"))
}

/// One number for a square.
fn size_of(word: &str, text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once('x').unwrap_or((text, text));
    let side = |text| number(word, text, [16.0, 4096.0]).map(|side| side as u32);
    Ok([side(width)?, side(height)?])
}

fn picture(text: String) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    // Known now rather than after the bake.
    let is_png = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if is_png { Ok(path) } else { Err(format!("{} is no picture that can be written; end it in .png", path.display())) }
}

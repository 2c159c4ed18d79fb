//! What the command line asks for.

use bevy::prelude::Resource;
use std::path::PathBuf;

pub const USAGE: &str = "\
usage: cornell_box [--spp N] [--density D] [--screenshot FILE.png [--size N]]
  --spp N             paths from each texel (64)
  --density D         texels per metre (16)
  --screenshot FILE   bake, take a picture of the window, end
  --size N            width and height of that window in pixels (640)";

/// What was asked for.
#[derive(Resource, Clone, Debug)]
pub struct Args {
    /// Paths from each texel.
    pub spp: u32,
    /// Texels per metre.
    pub density: f32,
    /// Where a picture goes; `None` for a run with a person.
    pub screenshot: Option<PathBuf>,
    /// Width and height of the picture [pixels].
    pub size: u32,
}

/// What to do.
pub enum Call {
    Run(Args),
    Help,
}

impl Args {
    /// Reads the arguments after the program's name. An error is a sentence.
    pub fn parse(mut words: impl Iterator<Item = String>) -> Result<Call, String> {
        let mut args = Self { spp: 64, density: 16.0, screenshot: None, size: 640 };
        while let Some(word) = words.next() {
            if word == "--help" || word == "-h" {
                return Ok(Call::Help);
            }
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
            match word.as_str() {
                "--spp" => args.spp = number(&word, &value()?, 1.0, 1e6)? as u32,
                "--density" => args.density = number(&word, &value()?, 0.1, 1000.0)? as f32,
                "--screenshot" => args.screenshot = Some(picture(value()?)?),
                "--size" => args.size = number(&word, &value()?, 16.0, 4096.0)? as u32,
                _ => return Err(format!("there is no argument {word}")),
            }
        }
        Ok(Call::Run(args))
    }
}

fn number(word: &str, text: &str, least: f64, most: f64) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("{word} takes a number from {least} to {most}, not {text}"))
}

fn picture(text: String) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    // Known now rather than after the bake.
    let is_png = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if is_png { Ok(path) } else { Err(format!("{} is no picture that can be written; end it in .png", path.display())) }
}

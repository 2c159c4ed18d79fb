//! What the command line asks for.

use bevy::prelude::*;
use std::path::PathBuf;

const USAGE: &str = "\
usage: editor FILE.glb [--error E%] [--density D] [--screenshot FILE.png]
  --error E%          how far a texel may be off (5%)
  --density D         texels per metre; by default as many as make about a quarter of a million texels
  --screenshot FILE   bake, take a picture of the window, end";

/// What was asked for.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Args {
    /// The scene.
    pub file: PathBuf,
    /// Relative error at 95 %.
    pub error: f64,
    /// Texels per metre.
    pub density: Option<f32>,
}

impl Args {
    /// Reads the arguments after the program's name. An error is what to print.
    pub fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let (mut file, mut error, mut density) = (None, 0.05, None);
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value\n\n{USAGE}"));
            let number = |text: &str| {
                let number = text.trim_end_matches('%').parse::<f32>().ok().filter(|number| *number > 0.0);
                number.ok_or_else(|| format!("{word} takes a number above 0, not {text}\n\n{USAGE}"))
            };
            match word.as_str() {
                "--error" => error = f64::from(number(&value()?)?) / 100.0,
                "--density" => density = Some(number(&value()?)?),
                "--screenshot" => _ = value()?,
                "--help" | "-h" => return Err(USAGE.into()),
                _ if word.starts_with('-') => return Err(format!("there is no argument {word}\n\n{USAGE}")),
                _ => file = Some(std::path::absolute(&word).map_err(|error| format!("{word}: {error}"))?),
            }
        }
        let file = file.ok_or_else(|| format!("which scene? Name a .glb or .gltf\n\n{USAGE}"))?;
        if !file.is_file() {
            return Err(format!("{} is not there; name a .glb or .gltf", file.display()));
        }
        Ok(Self { file, error, density })
    }
}

//! What is promised and not there yet, refused by name rather than by a parser's puzzlement.

use crate::args::Verb;
use crate::failure::Failure;

/// Refuses what is not there yet.
pub(crate) fn refuse(verb: &Verb) -> Result<(), Failure> {
    let asked = match verb {
        Verb::Bake(args) => vec![
            (args.resume, "--resume", "bake from the start"),
            (args.shard.is_some(), "--shard", "bake the whole scene"),
        ],
        Verb::Plan(_) | Verb::Study(_) => Vec::new(),
        Verb::Irradiance(args) => vec![
            (args.error.is_some(), "--error", "ask for paths with --spp N"),
            (args.time.is_some(), "--time", "ask for paths with --spp N"),
        ],
        Verb::Render(args) => vec![
            (args.error.is_some(), "--error", "ask for paths with --spp N"),
            (args.time.is_some(), "--time", "ask for paths with --spp N"),
        ],
        Verb::Merge(_) => vec![(true, "kiln merge", "bake the whole scene with kiln bake")],
    };
    match asked.into_iter().find(|(is_asked, ..)| *is_asked) {
        None => Ok(()),
        Some((_, what, instead)) => Err(Failure::Arguments(format!("`{what}` is not there yet: {instead}"))),
    }
}

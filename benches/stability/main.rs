//! The stability report: hard cases at growing difficulty, the error of this baker beside that of the method which
//! other bakers or textbooks use. Prints a table for each sweep and draws `docs/pictures/stability`.
//!
//! ```sh
//! cargo bench --no-default-features --features bake --bench stability
//! ```
//!
//! `--quick` after `--`, and `cargo test --benches`, do a sixty-fourth of the work and write no picture; names of
//! sweeps make only these, and the picture of all only if all were made. Pictures and errors are the same from run to
//! run; processor times are printed only.

mod albedo;
mod cornell;
mod distance;
mod gap;
mod grazing;
mod meter;
mod naive;
mod numbers;
mod place;
mod plain_ggx;
mod plot;
mod roughness;
mod scale;
mod scenes;
mod sums;
mod sweep;

use std::path::Path;
use std::time::Instant;
use sweep::{Effort, Sweep};

/// A sweep's name and how it is made.
type Entry = (&'static str, fn(Effort) -> Sweep);

const SWEEPS: [Entry; 8] = [
    ("distance", distance::sweep),
    ("scale", scale::sweep),
    ("place", place::sweep),
    ("gap", gap::sweep),
    ("albedo", albedo::sweep),
    ("grazing", grazing::sweep),
    ("roughness", roughness::sweep),
    ("sums", sums::sweep),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // What cargo adds, such as --bench, is no name of a sweep and is passed over.
    let words: Vec<String> = std::env::args().skip(1).collect();
    let is_asked = |name: &str| words.iter().any(|word| word == name);
    let effort = if is_asked("--quick") || !is_asked("--bench") { Effort::Quick } else { Effort::Full };
    let all = !SWEEPS.iter().any(|(name, _)| is_asked(name)) && !is_asked("line4");
    let mut sweeps = Vec::new();
    for (name, make) in SWEEPS.iter().filter(|(name, _)| all || is_asked(name)) {
        let clock = Instant::now();
        let sweep = make(effort);
        sweep.print();
        println!("({name}: {:.1} s)\n", clock.elapsed().as_secs_f64());
        sweeps.push(sweep);
    }
    if all || is_asked("line4") {
        cornell::print(effort);
    }
    if effort == Effort::Full {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/pictures/stability");
        std::fs::create_dir_all(&folder)?;
        for sweep in &sweeps {
            std::fs::write(folder.join(format!("{}.svg", sweep.name)), plot::one(sweep)?)?;
        }
        if all {
            std::fs::write(folder.join("stability.svg"), plot::all(&sweeps)?)?;
        }
    }
    Ok(())
}

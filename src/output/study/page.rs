//! The page: what a person should know after a minute, in Markdown.

use super::chart::Subject;
use super::words::{capital, digits, grouped, percent, round, time};
use crate::study::{Cost, Curve, PRICED_ERRORS, Slope, Study, Technique};
use std::fmt::Write;

/// The error that the first sentence is about.
const ASKED: f64 = 0.01;

/// What there is beside the page.
pub(super) struct Files {
    pub(super) plots: Vec<Subject>,
    pub(super) has_strip: bool,
}

/// The page of a study of a scene of this name.
pub(super) fn page(study: &Study, scene: &str, files: &Files) -> String {
    let parts = [
        Some(format!("# What accuracy costs: {}\n\n**{}**", plain(scene), answer(study))),
        plot(files, Subject::Time, "Error against processor time"),
        Some(prices(study)),
        bounces(study, files),
        effects(study),
        strip(study, files),
        Some(conditions(study, files)),
        left_out(study),
    ];
    let mut page = parts.into_iter().flatten().collect::<Vec<_>>().join("\n\n");
    page.push('\n');
    page
}

/// The scene's name as letters: what is a sign in Markdown is escaped.
fn plain(name: &str) -> String {
    let is_sign = |letter: char| "\\`*_[]<>#|!".contains(letter);
    name.chars().flat_map(|letter| is_sign(letter).then_some('\\').into_iter().chain([letter])).collect()
}

/// One sentence.
pub(super) fn answer(study: &Study) -> String {
    let cost = |technique| study.curve(technique).and_then(|curve| curve.price(ASKED));
    let texels = grouped(study.conditions.texels as f64);
    let Some(own) = cost(study.of_a_bake()).and_then(|cost| Some((cost, cost.seconds()?))) else {
        return format!("What 1 % costs on these {texels} texels is not known: the study was too short.");
    };
    let mut text = format!("1 % costs {} of processor time on these {texels} texels", about(own.0, own.1));
    if let Some((denoised, seconds)) = cost(Technique::Denoised).and_then(|cost| Some((cost, cost.seconds()?))) {
        let _ = write!(text, ", {} denoised", about(denoised, seconds));
    }
    let rival = [Technique::Naive, Technique::Independent].into_iter().find_map(|technique| {
        let cost = cost(technique)?;
        Some((technique, cost, cost.seconds()?))
    });
    if let Some((technique, rival, seconds)) = rival {
        let _ = write!(text, "; {} takes {}", technique.name(), about(rival, seconds));
    }
    if let Some(slope) = study.curve(study.of_a_bake()).and_then(|curve| curve.slope) {
        let _ = write!(text, ". The error falls as paths to the power {}", signed(slope.value));
    }
    text + "."
}

fn about(cost: Cost, seconds: f64) -> String {
    match cost {
        Cost::Extrapolated(_) => format!("about {} (extrapolated)", time(seconds)),
        Cost::AtMost(_) => format!("at most {}", time(seconds)),
        Cost::Measured(_) | Cost::Never => time(seconds),
    }
}

fn signed(number: f64) -> String {
    format!("{number:.2}").replace('-', "−")
}

fn plot(files: &Files, subject: Subject, what: &str) -> Option<String> {
    let file = subject.file();
    files.plots.contains(&subject).then(|| format!("![{what}]({file}.svg)"))
}

/// The table of slopes and prices.
fn prices(study: &Study) -> String {
    let errors: Vec<String> = PRICED_ERRORS.iter().map(|&error| round(&percent(error))).collect();
    let mut text =
        format!("| technique | {} | slope |\n|---|{}---:|\n", errors.join(" | "), "---:|".repeat(errors.len()));
    for curve in study.curves.iter().filter(|curve| !matches!(curve.technique, Technique::Capped(_))) {
        let cells: Vec<String> = curve.prices.iter().map(|price| cell(price.cost)).collect();
        let name = capital(&curve.technique.name());
        let name = if curve.technique == study.of_a_bake() { format!("**{name}**") } else { name };
        let _ = writeln!(text, "| {name} | {} | {} |", cells.join(" | "), slope(curve.slope));
    }
    text.push_str(
        "\nProcessor time of the whole lightmap for a root mean square error of so many percent of the mean, by \
         luminance. *Italic*: beyond what was measured, by the slope. Slope: of log error over log paths, with its \
         standard error; −0.50 is plain Monte Carlo. The denoiser's time is that of all repair, and blur that it leaves \
         is in its error. Bakes share paths between texels where they can; all others are each texel for itself.",
    );
    if study.curve(Technique::Adaptive).is_some() {
        text.push_str(
            " An adaptive bake holds every texel, dark ones too, to a share of its own value, which this table, going by \
             the mean of all, does not ask for.",
        );
    }
    text
}

fn cell(cost: Cost) -> String {
    match cost {
        Cost::Measured(seconds) => time(seconds),
        Cost::AtMost(seconds) => format!("≤ {}", time(seconds)),
        Cost::Extrapolated(seconds) => format!("*{}*", time(seconds)),
        Cost::Never => "—".into(),
    }
}

fn slope(slope: Option<Slope>) -> String {
    slope.map_or_else(|| "—".into(), |slope| format!("{} ± {:.2}", signed(slope.value), slope.stderr))
}

fn bounces(study: &Study, files: &Files) -> Option<String> {
    let floors: Vec<(&Curve, _)> = study.curves.iter().filter_map(|curve| Some((curve, curve.floor?))).collect();
    if floors.is_empty() {
        return None;
    }
    let mut text = String::from("## A cap on bounces never gets there\n\n");
    if let Some(plot) = plot(files, Subject::Bounces, "Caps on bounces against roulette") {
        text.push_str(&plot);
        text.push_str("\n\n");
    }
    text.push_str("| paths | light that is missing | error that is left |\n|---|---:|---:|\n");
    for (curve, floor) in floors {
        let missing = if floor.missing.abs() < 5e-4 { "none to be seen".into() } else { percent(floor.missing) };
        let left = if floor.error < study.reference.error {
            format!("< {}", percent(study.reference.error))
        } else {
            percent(floor.error)
        };
        let _ = writeln!(text, "| {} | {missing} | {left} |", curve.technique.name());
    }
    text.push_str("| Russian roulette, no cap | none | none |");
    Some(text)
}

fn effects(study: &Study) -> Option<String> {
    if study.effects.is_empty() {
        return None;
    }
    let mut text = String::from(
        "## What each effect costs and brings\n\n| effect | time that it takes | light that it brings |\n|---|---:|---:|\n",
    );
    let share = |share: f64| format!("{:.0} %", 100.0 * share).replace("-0 ", "0 ").replace('-', "−");
    for effect in &study.effects {
        let _ = writeln!(text, "| {} | {} | {} |", effect.effect, share(effect.time), share(effect.light));
    }
    text.push_str(
        "\nShares of the whole, by leaving the effect out; they do not add up, since without a light what it lights costs \
         nothing either. What the scene does not call for is not simulated and takes no time.",
    );
    Some(text)
}

fn strip(study: &Study, files: &Files) -> Option<String> {
    let last = study.strip.pictures.last().filter(|_| files.has_strip)?;
    Some(format!(
        "## What it looks like\n\n![Pictures of more and more samples per pixel](strip.png)\n\nThe same picture carried \
         on to {} samples per pixel ({}), exposed alike.",
        grouped(f64::from(last.samples)),
        plain(&study.strip.camera)
    ))
}

fn conditions(study: &Study, files: &Files) -> String {
    let conditions = &study.conditions;
    let density = conditions.density.map_or_else(
        || "in the layout of its artist".into(),
        |density| format!("at {} per metre", digits(f64::from(density))),
    );
    let threads = if conditions.threads == 1 { "1 thread".into() } else { format!("{} threads", conditions.threads) };
    let reference = &study.reference;
    let mut text = format!(
        "## Conditions\n\n{} triangles; {} texels {density}, {} of them measured, spread evenly over all. The reference is \
         what a bake does with other random numbers, {} paths from each texel; its own error, {}, is taken out of the \
         others, and points that near it are left out of plots and slopes. {threads}; seed {}; the study took {}. Processor \
         time counts all threads, so that the clock shows about {} of it. Every point: [study.csv](study.csv).",
        grouped(conditions.triangles as f64),
        grouped(conditions.texels as f64),
        grouped(conditions.receivers as f64),
        grouped(f64::from(reference.paths)),
        percent(reference.error),
        conditions.seed,
        time(conditions.seconds),
        if conditions.threads == 1 { "all".into() } else { format!("1/{}", conditions.threads) },
    );
    if files.plots.contains(&Subject::Paths) {
        let file = Subject::Paths.file();
        let _ = write!(text, " Over paths instead of time: [plot]({file}.svg).");
    }
    let pictures: Vec<String> = files.plots.iter().map(|plot| format!("[{0}.png]({0}.png)", plot.file())).collect();
    if !pictures.is_empty() {
        let _ = write!(text, " The plots as pictures: {}.", pictures.join(", "));
    }
    text
}

fn left_out(study: &Study) -> Option<String> {
    let mut sentences: Vec<String> = study.left_out.clone();
    sentences.extend(study.warnings.iter().map(|warning| format!("Warning: {}.", plain(&warning.to_string()))));
    if sentences.is_empty() {
        return None;
    }
    let list: Vec<String> = sentences.iter().map(|sentence| format!("- {sentence}")).collect();
    Some(format!("## Left out\n\n{}", list.join("\n")))
}

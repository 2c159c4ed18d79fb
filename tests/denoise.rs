//! The denoiser against long references (`tests/data/README.md`): 64 samples and it against 512 without it whose paths
//! serve no other texel, and the contrast of contact shadows and shadow edges, in the mean of a few bakes with other
//! random numbers: of a single one either is a matter of luck. What is judged by contrast and error is itself judged: a
//! blur must fail the one, and what is not denoised the other.

mod common;
#[path = "denoise/judge.rs"]
mod judge;
#[path = "denoise/reference.rs"]
mod reference;
#[path = "denoise/scenes.rs"]
mod scenes;

use bevy_kiln::bake::{BakeSettings, CancelToken, Denoise, Goal, Layout, Lightmap, Page, bake_lightmap};
use bevy_kiln::trace::{Sharing, Transport};
use judge::{Error, Judge, blurred};
use reference::Reference;
use scenes::Case;

/// Samples per texel of the references: their errors are four times below the least that they judge.
const LONG: u32 = 8192;

/// And those of the scenes that are denoised best.
const LONGER: u32 = 16384;

/// Bakes of a case, each with its own random numbers.
const BAKES: u64 = 5;

fn bake(case: &Case, samples_per_texel: u32, denoise: Denoise, sharing: Sharing, number: u64) -> Lightmap {
    let settings = BakeSettings {
        goal: Goal::Samples(samples_per_texel),
        layout: Layout::Shared { size: case.size },
        transport: Transport { sharing, seed: u64::from(samples_per_texel) + number, ..Transport::default() },
        denoise,
        ..BakeSettings::default()
    };
    bake_lightmap(&case.scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// What was seen of one bake, or of a few in the mean.
#[derive(Debug)]
struct Seen {
    /// Of 64 samples, those denoised, and 512.
    raw: Error,
    denoised: Error,
    many: Error,
    /// Of shadow edges and contacts, denoised.
    contrasts: [f64; 2],
    /// Errors by the report, before and after.
    reported: [f64; 2],
    /// Denoised light over raw.
    total: f64,
    /// The reference's own error.
    reference: f64,
}

impl Seen {
    fn new(case: &Case, reference: &Reference, number: u64) -> Self {
        let few = bake(case, 64, Denoise::BuiltIn, Sharing::Group, number);
        let many = bake(case, 512, Denoise::Off, Sharing::Alone, number);
        let page = &few.pages[0];
        let judge = Judge::new(page, reference);
        let report = few.report.denoised.unwrap();
        assert!(!faults_of_contrast(judge.contrasts(&blurred(page, 1.5))).is_empty(), "a blur went unseen");
        Self {
            raw: judge.error(&page.raw),
            denoised: judge.error(&page.radiance),
            many: judge.error(&many.pages[0].radiance),
            contrasts: judge.contrasts(&page.radiance),
            reported: [report.before.mean, report.after.mean],
            total: judge.total(&page.radiance) / judge.total(&page.raw),
            reference: judge.error_of_reference(),
        }
    }

    fn mean(all: &[Self]) -> Self {
        let mean = |of: &dyn Fn(&Self) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
        let error = |of: fn(&Self) -> Error| Error {
            root: mean(&|seen| of(seen).root.powi(2)).sqrt(),
            relative: mean(&|seen| of(seen).relative),
        };
        Self {
            raw: error(|seen| seen.raw),
            denoised: error(|seen| seen.denoised),
            many: error(|seen| seen.many),
            contrasts: [0, 1].map(|kind| mean(&|seen| seen.contrasts[kind])),
            reported: [0, 1].map(|side| mean(&|seen| seen.reported[side])),
            total: mean(&|seen| seen.total),
            reference: mean(&|seen| seen.reference),
        }
    }
}

/// Contrasts that are off by more than a twentieth.
fn faults_of_contrast([edges, contacts]: [f64; 2]) -> Vec<String> {
    let off = |(name, contrast): (&str, f64)| {
        ((contrast - 1.0).abs() > 0.05).then(|| format!("{name}: {contrast:.3} of the reference's contrast"))
    };
    [("shadow edges", edges), ("contacts", contacts)].into_iter().filter_map(off).collect()
}

fn assert_case(case: &Case) {
    let reference = reference::load(case.name);
    let each: Vec<Seen> = (0..BAKES).map(|number| Seen::new(case, &reference, number)).collect();
    for Seen { raw, denoised, many, contrasts, .. } in &each {
        println!(
            "{}: root {:.4} {:.4} {:.4}, relative {:.4} {:.4} {:.4}, contrasts {contrasts:.3?}",
            case.name, raw.root, denoised.root, many.root, raw.relative, denoised.relative, many.relative
        );
    }
    let Seen { raw, denoised, many, contrasts, reported, total, reference: long } = Seen::mean(&each);
    println!("in the mean, raw 64, denoised 64, raw 512, reference ± {long:.4}:");
    println!("  root of the mean square: {:.4} {:.4} {:.4}", raw.root, denoised.root, many.root);
    println!("  mean relative: {:.4} {:.4} {:.4}", raw.relative, denoised.relative, many.relative);
    println!("  contrast of edges and contacts: {contrasts:.3?}");
    println!("  by the report: {reported:.4?}; total light: {:+.5}", total - 1.0);

    assert!(4.0 * long < many.root.min(denoised.root), "the reference is too noisy: {long}");
    assert!(denoised.root < many.root, "{denoised:?} is not below {many:?}");
    assert!(denoised.relative < many.relative, "{denoised:?} is not below {many:?}");
    assert_eq!(faults_of_contrast(contrasts), Vec::<String>::new());
    for (estimate, error) in reported.into_iter().zip([raw, denoised]) {
        assert!((estimate / error.relative - 1.0).abs() < 0.2, "{estimate} is no estimate of {error:?}");
    }
    // What was denoised is the light that was found, within a few of its standard errors.
    assert!((total - 1.0).abs() < 0.003, "the total moved by {total}");
    // The judge of errors itself.
    assert!(raw.root > many.root && raw.relative > many.relative);
}

#[test]
fn cornell_box() {
    assert_case(&scenes::cornell());
}

#[test]
fn room_with_a_patch_of_sun() {
    assert_case(&scenes::sunlit());
}

#[test]
fn round_things_under_many_lamps() {
    assert_case(&scenes::lamps());
}

/// Minutes per scene: `cargo test --no-default-features --features bake --test denoise -- --ignored make_references`,
/// with `DENOISE_ONLY` in the environment for one of them by name.
#[test]
#[ignore = "makes the references"]
fn make_references() {
    let only = std::env::var("DENOISE_ONLY").ok();
    for case in scenes::all().into_iter().filter(|case| only.as_deref().is_none_or(|only| only == case.name)) {
        let samples = if case.name == "sunlit" { LONG } else { LONGER };
        let lightmap = bake(&case, samples, Denoise::Off, Sharing::Group, 0);
        let page: &Page = &lightmap.pages[0];
        reference::save(case.name, page);
        println!("{}: {:?}", case.name, lightmap.report.relative_stderr);
    }
}

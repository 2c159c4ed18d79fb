//! `docs/albedo.md`: how much each lobe scatters, as measured. To write it anew after a change that is meant:
//! `cargo test --no-default-features --features bake --lib write_the_page -- --ignored`.

use super::super::ggx::{Ggx, half_vector};
use super::super::standard::{Standard, StandardParameters};
use super::super::{Bsdf, Phong};
use super::furnace::share;
use super::subject::{Subject, TABLES, WHITE, clearcoat, dielectric, outgoing, phong, schlick, specular, standard};
use glam::Vec3;
use std::fmt::Write;
use std::path::PathBuf;

const ROUGHNESSES: [f32; 6] = [0.0, 0.15, 0.25, 0.5, 0.75, 1.0];
const EXPONENTS: [f32; 5] = [0.0, 1.0, 10.0, 100.0, 1000.0];
const ANGLES: [f32; 5] = [0.0, 45.0, 60.0, 80.0, 89.0];

/// What a figure on the page may be off from the measurement: its last digit by one.
const OFF: f64 = 1.5e-3;

const INTRODUCTION: &str = "\
# How much each lobe scatters

Directional albedo: of the light that arrives from one direction, the share that is scattered, measured on the lobes
of `src/trace/bsdf/` by quadrature. 1 is all of it. Roughness is the perceptual one, the square root of α; below
α = 10⁻³ a surface counts as perfectly smooth. Angles are to the normal. What is refracted counts by its flux.

A test measures these figures again and fails where the page differs by more than its last digit. After a change that
is meant, write the page anew:

```
cargo test --no-default-features --features bake --lib write_the_page -- --ignored
```
";

/// A table of the page: a heading, what is to be known about it, and a subject for each row.
struct Table {
    heading: &'static str,
    text: &'static str,
    key: &'static str,
    rows: Vec<(String, Subject)>,
}

fn over_roughness(heading: &'static str, text: &'static str, make: impl Fn(f32) -> Subject) -> Table {
    let rows = ROUGHNESSES.map(|roughness| (format!("{roughness}"), make(roughness))).into();
    Table { heading, text, key: "roughness", rows }
}

fn rough(parameters: StandardParameters) -> impl Fn(f32) -> Subject {
    move |perceptual_roughness| standard("", &StandardParameters { perceptual_roughness, ..parameters })
}

/// What crosses a perfectly smooth pane is no scattering; here it counts.
fn with_straight(parameters: StandardParameters) -> impl Fn(f32) -> Subject {
    move |roughness| {
        let mut subject = rough(parameters)(roughness);
        let lobes = Standard::new(&StandardParameters { perceptual_roughness: roughness, ..parameters }, &TABLES);
        let sample = subject.sample;
        subject.sample = Box::new(move |wo, u| {
            let mut sample = sample(wo, u)?;
            if roughness == 0.0 {
                sample.weight += lobes.straight(wo.z);
            }
            Some(sample)
        });
        subject
    }
}

fn once(roughness: f32) -> Subject {
    let mut subject = specular(roughness, schlick([1.0; 3]));
    if let Some(ggx) = Ggx::new(roughness) {
        subject.evaluate = Box::new(move |wo, wi| {
            half_vector(wo, wi).map_or(Vec3::ZERO, |m| Vec3::splat(ggx.reflection(wo, wi, m).0))
        });
    }
    subject
}

fn glossy(exponent: f32) -> (String, Subject) {
    let lobe = Phong { diffuse: Vec3::ZERO, specular: Vec3::ONE, exponent };
    let mut subject = phong(exponent);
    subject.evaluate = Box::new(move |wo, wi| Bsdf::Phong(lobe).evaluate(wo, wi));
    (format!("{exponent}"), subject)
}

fn tables() -> Vec<Table> {
    let metal = StandardParameters { metallic: 1.0, ..WHITE };
    let varnished = |coat| {
        let parameters = StandardParameters { clearcoat: 1.0, reflectance: 0.0, ..WHITE };
        standard("", &StandardParameters { clearcoat_perceptual_roughness: coat, ..parameters })
    };
    let pane = StandardParameters { specular_transmission: 1.0, ..WHITE };
    vec![
        over_roughness("GGX, reflected once", "Facets that reflect all. What is missing has met a second facet.", once),
        over_roughness(
            "GGX with compensation",
            "The same with the light that was reflected more than once: a white metal (`specular.rs`).",
            rough(metal),
        ),
        over_roughness(
            "Bevy's material, a white dielectric",
            "A microfacet coat of F0 = 0.04 over a white base that gets what the coat leaves (`standard.rs`).",
            rough(WHITE),
        ),
        over_roughness("Clear coat by itself", "F0 = 0.04, strength 1 (`clearcoat.rs`).", |roughness| {
            clearcoat(roughness, 1.0)
        }),
        over_roughness(
            "Clear coat over white",
            "Over a white diffuse base. What is missing was reflected down again by the coat and is not followed.",
            varnished,
        ),
        over_roughness(
            "Thin pane, white",
            "Both sides together (`thin.rs`); of the smooth one, with what crosses straight.",
            with_straight(pane),
        ),
        over_roughness(
            "Glass from outside",
            "Index 1.5, both sides together, with the light that met more than one facet (`dielectric.rs`, \
             `again.rs`).",
            |roughness| dielectric(roughness, 1.5, Vec3::ONE),
        ),
        over_roughness("Glass from inside", "The same interface from its dense side.", |roughness| {
            dielectric(roughness, 1.0 / 1.5, Vec3::ONE)
        }),
        Table {
            heading: "Phong's glossy lobe",
            text: "Largest albedo 1 (`phong.rs`). What is missing would have gone below the surface.",
            key: "exponent",
            rows: EXPONENTS.map(glossy).into(),
        },
    ]
}

/// The figures of the page in its order.
fn measure(tables: &[Table]) -> Vec<f64> {
    let rows = tables.iter().flat_map(|table| &table.rows);
    rows.flat_map(|(_, subject)| ANGLES.map(|degrees| share(subject, outgoing(degrees)))).collect()
}

fn page(tables: &[Table], figures: &[f64]) -> String {
    let mut page = String::from(INTRODUCTION);
    let mut rows = figures.chunks(ANGLES.len());
    for table in tables {
        let heads = ANGLES.map(|degrees| format!(" {degrees}° |")).concat();
        let rules = "---:|".repeat(ANGLES.len() + 1);
        let _ = write!(page, "\n## {}\n\n{}\n\n| {} |{heads}\n|{rules}\n", table.heading, table.text, table.key);
        for (key, _) in &table.rows {
            let figures = rows.next().unwrap_or_default();
            let cells = figures.iter().map(|figure| format!(" {figure:.3} |")).collect::<String>();
            let _ = writeln!(page, "| {key} |{cells}");
        }
    }
    page
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/albedo.md")
}

/// The figures in the cells of a page, but for the keys of its rows, and the page without them.
fn read(page: &str) -> (Vec<f64>, String) {
    let mut figures = Vec::new();
    let mut rest = String::new();
    for line in page.lines() {
        for (number, cell) in line.split('|').enumerate() {
            match cell.trim().parse::<f64>() {
                Ok(figure) if number > 1 => figures.push(figure),
                _ => rest.push_str(cell),
            }
        }
        rest.push('\n');
    }
    (figures, rest)
}

/// Where a page differs from the measurement.
fn differences(written: &str, tables: &[Table], figures: &[f64]) -> Vec<String> {
    let (found, rest) = read(written);
    let mut differences = Vec::new();
    if rest != read(&page(tables, figures)).1 || found.len() != figures.len() {
        differences.push("the words of the page or the shape of its tables".into());
    }
    let off = found.iter().zip(figures).filter(|(found, figure)| (*found - *figure).abs() > OFF);
    differences.extend(off.map(|(found, figure)| format!("{found} but measured {figure:.4}")));
    differences
}

#[test]
fn the_page_is_as_measured() {
    let written = std::fs::read_to_string(path()).expect("docs/albedo.md can be read");
    let tables = tables();
    let figures = measure(&tables);
    let found = differences(&written, &tables, &figures);
    assert!(found.is_empty(), "docs/albedo.md differs; the page says how to write it anew: {found:#?}");
    // Planted: one figure off by two in its last digit, a word changed, a row missing.
    let mut wrong = figures.clone();
    wrong[17] += 0.0025;
    assert_eq!(differences(&page(&tables, &wrong), &tables, &figures).len(), 1);
    assert_eq!(differences(&written.replace("Thin pane", "Pane"), &tables, &figures).len(), 1);
    let row = written.lines().rfind(|line| line.starts_with('|')).expect("there is a table");
    assert!(!differences(&written.replace(row, ""), &tables, &figures).is_empty());
}

#[test]
#[ignore = "writes docs/albedo.md"]
fn write_the_page() {
    let tables = tables();
    std::fs::write(path(), page(&tables, &measure(&tables))).expect("docs/albedo.md can be written");
}

//! The files of a made-up study.

use super::*;
use crate::bake::BakeWarning;
use crate::study::{
    Conditions, Cost, Curve, EffectShare, Floor, PICTURE_SIZE, PRICED_ERRORS, Point, Price, Reference, Slope, Standing,
    Strip, StudyPicture, Technique,
};
use crate::trace::Effect;
use glam::Vec3;
use std::collections::BTreeSet;
use std::fs;

fn curve(technique: Technique, [seconds, error, power]: [f64; 3]) -> Curve {
    let point = |step: i32| {
        let paths = 16 << step;
        Point {
            paths,
            cpu_seconds: seconds * f64::from(1 << step),
            error: error * f64::from(1 << step).powf(power),
            standing: if step < 9 { Standing::Known } else { Standing::NearReference },
        }
    };
    let cost = |error: f64| if power < -0.1 { Cost::Extrapolated(1.0 / error) } else { Cost::Never };
    Curve {
        technique,
        points: (0..10).map(point).collect(),
        slope: Some(Slope { value: power, stderr: 0.01 }),
        slope_over_time: None,
        floor: matches!(technique, Technique::Capped(_)).then_some(Floor { error, missing: 0.9 * error }),
        prices: PRICED_ERRORS.into_iter().map(|error| Price { error, cost: cost(error) }).collect(),
    }
}

fn made_up() -> Study {
    let picture = |samples: u32| StudyPicture {
        samples,
        radiance: (0..PICTURE_SIZE * PICTURE_SIZE).map(|index| Vec3::splat((index % 96) as f32)).collect(),
    };
    Study {
        conditions: Conditions {
            texels: 12_345,
            receivers: 1024,
            density: Some(16.0),
            triangles: 36,
            threads: 2,
            seed: 0,
            seconds: 1200.0,
        },
        reference: Reference { mean: 1.0, paths: 100_000, error: 0.001, cpu_seconds: 1000.0 },
        curves: vec![
            curve(Technique::Mis, [0.4, 0.16, -0.6]),
            curve(Technique::Naive, [0.2, 1.9, -0.5]),
            curve(Technique::Light, [0.4, 0.17, -0.57]),
            curve(Technique::Independent, [0.4, 0.165, -0.5]),
            curve(Technique::Shared, [0.9, 0.08, -0.6]),
            curve(Technique::Capped(0), [0.1, 0.5, 0.0]),
            curve(Technique::Capped(4), [0.3, 0.05, 0.0]),
            curve(Technique::Denoised, [0.9, 0.05, -0.3]),
        ],
        effects: vec![EffectShare { effect: Effect::AreaLights, time: 0.5, light: 1.0 }],
        strip: Strip { camera: "cam|era".into(), pictures: [10, 100, 1000].map(picture).to_vec() },
        left_out: vec!["Nothing of note.".into()],
        warnings: vec![BakeWarning::NotLight { paths: 3 }],
    }
}

/// The values of an attribute or of links, between two marks.
fn between<'a>(text: &'a str, open: &str, close: char) -> Vec<&'a str> {
    text.split(open).skip(1).filter_map(|rest| rest.split(close).next()).collect()
}

/// Tags that open and close each other, and nothing outside of the first: enough for files that a program wrote.
fn is_xml(text: &str) -> bool {
    let mut open = Vec::new();
    for (index, tag) in text.split('<').enumerate().skip(1) {
        let Some((tag, after)) = tag.split_once('>') else { return false };
        if tag.starts_with('?') || tag.starts_with('!') || tag.ends_with('/') {
        } else if let Some(name) = tag.strip_prefix('/') {
            if open.pop() != Some(name.trim()) {
                return false;
            }
        } else {
            open.push(tag.split_whitespace().next().unwrap_or_default());
        }
        let is_quoted = tag.matches('"').count() % 2 == 0;
        let is_escaped = !after.replace("&amp;", "").replace("&lt;", "").replace("&gt;", "").contains('&');
        if !is_quoted || !is_escaped || (index > 1 && open.is_empty() && !after.trim().is_empty()) {
            return false;
        }
    }
    open.is_empty() && text.trim_start().starts_with('<')
}

#[test]
fn the_page_has_all_that_it_links_to_and_links_to_all() {
    let folder = temp_dir::TempDir::new().unwrap();
    let dir = folder.path().join("deep/er");
    let files = write_study(&made_up(), "a_scene.glb", &dir).unwrap();
    let names: BTreeSet<String> =
        fs::read_dir(&dir).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    let written = files.iter().map(|file| file.file_name().unwrap().to_str().unwrap().to_owned());
    assert_eq!(written.collect::<BTreeSet<_>>(), names);
    let page = fs::read_to_string(dir.join("study.md")).unwrap();
    let links: BTreeSet<String> = between(&page, "](", ')').into_iter().map(str::to_owned).collect();
    let beside: BTreeSet<String> = names.iter().filter(|name| *name != "study.md").cloned().collect();
    assert_eq!(links, beside, "{page}");
    assert_eq!(beside.len(), 8);
    assert!(
        page.starts_with("# What accuracy costs: a\\_scene.glb\n\n**1 % costs about 100 s (extrapolated)"),
        "{page}"
    );
    for part in [
        "| **Shared paths (bake --spp)** |",
        "| MIS, Sobol |",
        "−0.60 ± 0.01",
        "direct light only | 45 % | 50 %",
        "area-lights | 50 % | 100 %",
        "cam\\|era",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
    // Rows of a table are as long as its head.
    for table in page.split("\n\n").filter(|part| part.starts_with('|')) {
        let columns: BTreeSet<usize> = table.lines().map(|line| line.replace("\\|", "").matches('|').count()).collect();
        assert_eq!(columns.len(), 1, "{table}");
    }
}

#[test]
fn drawings_are_drawings() {
    let folder = temp_dir::TempDir::new().unwrap();
    write_study(&made_up(), "scene", folder.path()).unwrap();
    for subject in Subject::ALL {
        let svg = fs::read_to_string(folder.path().join(format!("{}.svg", subject.file()))).unwrap();
        assert!(is_xml(&svg), "{}", subject.file());
        let is_label = |name: &str| svg.contains(name);
        match subject {
            Subject::Bounces => assert!(is_label("direct light only") && !is_label("light sampling")),
            Subject::Time | Subject::Paths => assert!(is_label("light sampling") && !is_label("cut after")),
        }
        let png = fs::read(folder.path().join(format!("{}.png", subject.file()))).unwrap();
        let picture = image::load_from_memory(&png).unwrap().into_rgb8();
        assert_eq!((picture.width(), picture.height()), (1440, 840));
        let colours: BTreeSet<[u8; 3]> = picture.pixels().map(|pixel| pixel.0).collect();
        assert!(colours.contains(&[255; 3]) && colours.len() > 50, "{}", colours.len());
    }
    let strip = image::load_from_memory(&fs::read(folder.path().join("strip.png")).unwrap()).unwrap().into_rgb8();
    // In the last column of the first picture, 12 pixels in, is its brightest.
    let bright = strip.get_pixel(12 + 287, 12 + 100).0;
    assert!(bright[0] > 240 && strip.get_pixel(12, 12 + 100).0 == [0; 3], "{bright:?}");
}

#[test]
fn planted_faults_in_xml_are_caught() {
    assert!(is_xml("<?xml version=\"1.0\"?><svg a=\"b\"><text>x &lt; y</text><line/></svg>"));
    for broken in ["<svg>", "<svg><text></svg></text>", "<svg a=\"b></svg>", "<svg>a & b</svg>", "x"] {
        assert!(!is_xml(broken), "{broken}");
    }
}

#[test]
fn the_table_has_every_point() {
    let study = made_up();
    let csv = table::csv(&study);
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0], ["technique", "paths", "cpu_seconds", "error", "standing"]);
    assert_eq!(rows.len(), 1 + 80);
    assert!(rows.iter().all(|row| row.len() == 5));
    assert_eq!(rows[1][..2], ["mis", "16"]);
    assert!((rows[1][3].parse::<f64>().unwrap() - 0.16).abs() < 1e-6);
    assert_eq!(csv.matches("near_reference").count(), 8);
}

/// What was too short to be known is said, and nothing is drawn of it.
#[test]
fn an_empty_study_has_a_page() {
    let folder = temp_dir::TempDir::new().unwrap();
    let mut study = made_up();
    study.curves.iter_mut().for_each(|curve| {
        curve.points.iter_mut().for_each(|point| point.standing = Standing::NearReference);
        curve.prices.iter_mut().for_each(|price| price.cost = Cost::Never);
        curve.slope = None;
    });
    study.strip.pictures.clear();
    let files = write_study(&study, "scene", folder.path()).unwrap();
    assert_eq!(files.len(), 2);
    assert!(study_answer(&study).contains("the study was too short"));
}

#[test]
fn a_file_in_the_way_is_named() {
    let folder = temp_dir::TempDir::new().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "mine").unwrap();
    assert_eq!(write_study(&made_up(), "scene", &file), Err(OutputError::FolderIsFile { path: file.clone() }));
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}

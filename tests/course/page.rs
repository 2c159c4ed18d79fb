//! docs/course.md: what it names is there.

use std::path::{Path, PathBuf};

/// What the page's links lead to, but for the web.
fn links(page: &str) -> Vec<&str> {
    page.split("](").skip(1).filter_map(|rest| rest.split(')').next()).filter(|link| !link.contains("://")).collect()
}

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs")
}

fn page() -> String {
    std::fs::read_to_string(docs().join("course.md")).expect("docs/course.md is there")
}

/// All Rust code under a folder.
fn code(folder: &Path) -> String {
    let mut all = String::new();
    for entry in std::fs::read_dir(folder).expect("a folder of this repository") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            all += &code(&path);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            all += &std::fs::read_to_string(path).expect("Rust code");
        }
    }
    all
}

#[test]
fn links_lead_somewhere() {
    let page = page();
    let links = links(&page);
    assert!(links.len() > 20, "{links:?}");
    for link in links {
        assert!(docs().join(link).exists(), "{link} leads nowhere");
    }
}

#[test]
fn tests_that_it_names_are_there() {
    let page = page();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let code = code(&root.join("src")) + &code(&root.join("tests"));
    let names = page.split('`').skip(1).step_by(2).filter(|name| name.contains('_') && !name.contains([' ', '/', ':']));
    let names: Vec<&str> = names.collect();
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        assert!(code.contains(&format!("fn {name}()")), "there is no test {name}");
    }
}

#[test]
fn pictures_are_shown_and_small() {
    let page = page();
    let mut bytes = 0;
    for entry in std::fs::read_dir(docs().join("pictures/course")).expect("the pictures are there") {
        let entry = entry.expect("a picture");
        bytes += entry.metadata().expect("a size").len();
        let name = entry.file_name().into_string().expect("a plain name");
        assert!(links(&page).contains(&format!("pictures/course/{name}").as_str()), "{name} is not shown");
    }
    assert!((1..2_000_000).contains(&bytes), "{bytes} bytes");
}

//! `kiln study` from outside.

use super::{assert_fails, data, kiln, text};

#[test]
fn a_study_of_seconds_leaves_a_page() {
    let folder = temp_dir::TempDir::new().unwrap();
    let dir = folder.path().join("study");
    let mut command = kiln();
    command.arg("study").arg(data("cornell.glb")).arg("-o").arg(&dir);
    command.args(["--emissive", "nits", "--time", "2s", "--density", "2"]);
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let stdout = text(&output.stdout);
    assert!(stdout.contains("1 % costs") || stdout.contains("too short"), "{stdout}");
    let page = std::fs::read_to_string(dir.join("study.md")).unwrap();
    assert!(page.starts_with("# What accuracy costs: cornell.glb\n"), "{page}");
    for file in ["study.csv", "error_over_time.svg", "error_over_time.png", "bounces.svg", "strip.png"] {
        assert!(dir.join(file).is_file(), "{file}");
    }
    let csv = std::fs::read_to_string(dir.join("study.csv")).unwrap();
    assert!(csv.lines().count() > 10, "{csv}");
    let told = text(&output.stderr);
    assert!(told.contains("reference") && told.contains("pictures"), "{told}");
}

#[test]
fn a_study_needs_a_folder() {
    let folder = temp_dir::TempDir::new().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "mine").unwrap();
    let mut command = kiln();
    command.arg("study").arg(data("cornell.glb")).arg("-o").arg(&file);
    assert_fails(&command.output().unwrap(), 1, "is a file, not a folder");
}

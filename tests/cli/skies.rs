//! `--environment`: pictures of the sky from files.

use super::glb::Glb;
use super::{assert_fails, data, kiln, run, text};
use std::path::{Path, PathBuf};
use temp_dir::TempDir;

/// A black picture of the sky but for one pixel, in the format of Greg Ward's Radiance.
fn sky(folder: &TempDir, mantissas: [u8; 4]) -> PathBuf {
    let file = folder.path().join("sky.hdr");
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
    for pixel in 0..8 {
        // The upper half's second quarter from the left, which is towards -Z.
        bytes.extend(if pixel == 1 { mantissas } else { [0; 4] });
    }
    std::fs::write(&file, bytes).unwrap();
    file
}

#[test]
fn a_sky_from_a_file_is_taken_by_every_verb_and_a_bad_one_is_a_sentence() {
    let folder = temp_dir::TempDir::new().unwrap();
    let scene = data("cornell.glb");
    let scene = scene.to_str().unwrap();
    let good = sky(&folder, [128, 64, 32, 129]);
    let output = run(&["plan", scene, "--environment", good.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let broken = folder.path().join("broken.exr");
    std::fs::write(&broken, b"no picture").unwrap();
    let points = folder.path().join("points.csv");
    std::fs::write(&points, "x,y,z,nx,ny,nz\n0,0,0,0,1,0\n").unwrap();
    let (points, out) = (points.to_str().unwrap(), folder.path().join("out.png"));
    for (file, sentence) in [
        (Path::new("no/such.hdr"), "there is no file no/such.hdr"),
        (&data("README.md"), "README.md is no picture of a sky that can be read"),
        (&broken, "broken.exr cannot be loaded"),
    ] {
        let file = file.to_str().unwrap();
        for verb in [
            &["plan", scene][..],
            &["bake", scene, "-o", "nowhere"],
            &["irradiance", scene, "--points", points],
            &["render", scene, "-o", out.to_str().unwrap()],
        ] {
            let arguments: Vec<&str> = verb.iter().copied().chain(["--environment", file]).collect();
            assert_fails(&run(&arguments), 1, sentence);
        }
    }
}

/// The lit octant has up, +X and -Z for its edges: ∫ cos dω = π/4 on a surface that faces any of them, 0 on their
/// backs.
#[test]
fn a_sky_from_a_file_lies_the_right_way_round_and_is_radiance() {
    let folder = temp_dir::TempDir::new().unwrap();
    let mut glb = Glb::read(&data("punctual.glb"));
    glb.json["scenes"][0]["nodes"] = serde_json::json!([0]);
    let scene = folder.path().join("floor.glb");
    glb.write(&scene);
    let points = folder.path().join("points.csv");
    std::fs::write(&points, "x,y,z,nx,ny,nz\n0,1,0,0,1,0\n0,1,0,1,0,0\n0,1,0,0,0,-1\n0,1,0,0,0,1\n").unwrap();
    let measure = |sky: &Path| {
        let mut command = kiln();
        command.arg("irradiance").arg(&scene).arg("--points").arg(&points).arg("--environment").arg(sky);
        command.args(["--max-bounces", "0", "--spp", "4096"]).output().unwrap()
    };
    let output = measure(&sky(&folder, [128, 64, 32, 129]));
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let stdout = text(&output.stdout);
    let rows: Vec<Vec<f64>> =
        stdout.lines().skip(1).map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    for (row, share) in rows.iter().zip([1.0, 1.0, 1.0, 0.0]) {
        for (channel, radiance) in [1.0, 0.5, 0.25].into_iter().enumerate() {
            let expected = share * radiance * std::f64::consts::FRAC_PI_4;
            let (seen, stderr) = (row[6 + channel], row[9 + channel]);
            assert!((seen - expected).abs() + 4.0 * stderr <= 0.01 * radiance, "{seen} is not {expected}");
        }
    }
    assert_eq!(rows.len(), 4);
}

#[test]
fn a_pixel_that_is_no_number_is_named() {
    let folder = temp_dir::TempDir::new().unwrap();
    let sky = folder.path().join("spoilt.exr");
    let pixel = |x: usize, y: usize| if (x, y) == (3, 1) { (f32::NAN, 1.0, 1.0) } else { (1.0_f32, 1.0_f32, 1.0_f32) };
    exr::prelude::write_rgb_file(&sky, 4, 2, pixel).unwrap();
    let mut command = kiln();
    command
        .arg("bake")
        .arg(data("cornell.glb"))
        .arg("-o")
        .arg(folder.path().join("out"))
        .arg("--environment")
        .arg(&sky);
    let output = command.args(["--density", "1", "--spp", "16"]).output().unwrap();
    let stderr = text(&output.stderr);
    assert!(stderr.contains("spoilt.exr\" has a pixel that is negative or not a finite number"), "{stderr}");
    assert!(stderr.contains("column 3, row 1") && !stderr.contains("panicked"), "{stderr}");
}

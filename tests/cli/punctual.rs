//! `kiln irradiance` on a scene whose lights come from its file: a sun, a point light and a sky, by closed form.

use super::{data, kiln, text};
use temp_dir::TempDir;

/// The table's columns of irradiance, and those of its standard error in what the command adds.
const IRRADIANCE: std::ops::Range<usize> = 6..9;

fn rows(table: &str) -> Vec<Vec<f64>> {
    table.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect()
}

/// 3 cos 30° + 5 cos θ/d² + π/4 at every point within 1 %, four standard errors included, and without noise from the
/// lights, of which each is found by every path.
#[test]
fn sun_point_light_and_sky_match_their_table() {
    let folder = TempDir::new().unwrap();
    // The points alone: what is asked must not be what is compared with.
    let table = std::fs::read_to_string(data("punctual.csv")).unwrap();
    let six = |line: &str| line.split(',').take(6).collect::<Vec<_>>().join(",");
    let points = folder.path().join("points.csv");
    std::fs::write(&points, table.lines().map(six).collect::<Vec<_>>().join("\n")).unwrap();
    let mut command = kiln();
    command.arg("irradiance").arg(data("punctual.glb")).arg("--points").arg(&points);
    command.args(["--no-range", "--sky", "0.25,0.25,0.25", "--emissive", "nits", "--spp", "1024"]);
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let (found, truth) = (rows(&text(&output.stdout)), rows(&table));
    assert_eq!(found.len(), truth.len());
    assert!(truth.len() > 20);
    for (found, truth) in found.iter().zip(&truth) {
        for channel in IRRADIANCE {
            let (value, stderr, expected) = (found[channel], found[channel + 3], truth[channel]);
            assert!((value - expected).abs() + 4.0 * stderr <= 0.01 * expected, "{value} ± {stderr} for {expected}");
        }
    }
}

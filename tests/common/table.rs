//! Reference irradiance from the tables in `tests/data`.

use bevy_kiln::bake::MeterPoint;
use glam::{DVec3, Vec3};
use std::path::Path;

/// One row of a reference table.
pub struct Reference {
    pub point: MeterPoint,
    /// Irradiance [lx].
    pub irradiance: DVec3,
    /// Its standard error [lx].
    pub stderr: DVec3,
}

/// The table `tests/data/<name>.csv`.
pub fn load(name: &str) -> Vec<Reference> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name).with_extension("csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("x,y,z,nx,ny,nz,e_r,e_g,e_b,se_r,se_g,se_b"));
    let rows: Vec<Reference> = lines.map(row).collect();
    assert!(!rows.is_empty(), "{name} is empty");
    rows
}

fn row(line: &str) -> Reference {
    let values: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
    let vector = |at: usize| DVec3::from_slice(&values[at..at + 3]);
    let position: Vec3 = vector(0).as_vec3();
    Reference { point: MeterPoint { position, normal: vector(3).as_vec3() }, irradiance: vector(6), stderr: vector(9) }
}

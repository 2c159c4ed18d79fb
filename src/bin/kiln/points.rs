//! The table of a light meter's points, and the same table with the answers.

use crate::failure::Failure;
use bevy_kiln::bake::{MeterPoint, MeterReading};
use csv::StringRecord;
use glam::Vec3;
use std::path::Path;

/// What each point is given by.
const INPUT: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// What the answer adds; columns of the question that are called so are replaced.
const ANSWER: [&str; 7] = ["e_r", "e_g", "e_b", "se_r", "se_g", "se_b", "samples"];

/// A table of points as it was read.
pub(crate) struct Table {
    header: StringRecord,
    rows: Vec<StringRecord>,
    pub(crate) points: Vec<MeterPoint>,
}

impl Table {
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let shown = path.display();
        let failed = |reason: String| Failure::Failed(format!("{shown}: {reason}"));
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_path(path)
            .map_err(|error| failed(format!("it cannot be read ({error}); check the path")))?;
        let header = reader.headers().map_err(|error| failed(format!("it is no table ({error})")))?.clone();
        let mut columns = [0; INPUT.len()];
        for (column, name) in columns.iter_mut().zip(INPUT) {
            let found = header.iter().position(|title| title.trim_start_matches('\u{feff}') == name);
            *column = found.ok_or_else(|| {
                failed(format!("it has no column \"{name}\"; name its columns x,y,z,nx,ny,nz in the first row"))
            })?;
        }
        let (mut rows, mut points) = (Vec::new(), Vec::new());
        for (index, row) in reader.records().enumerate() {
            let number = index + 1;
            let row = row.map_err(|error| failed(format!("row {number} cannot be read ({error})")))?;
            points.push(point(&row, columns).map_err(|reason| failed(format!("row {number}: {reason}")))?);
            rows.push(row);
        }
        if points.is_empty() {
            return Err(failed("it has no points; give at least one row".to_owned()));
        }
        Ok(Self { header, rows, points })
    }

    /// The table with the answers added.
    pub(crate) fn answer(&self, readings: &[MeterReading]) -> Result<Vec<u8>, Failure> {
        let kept: Vec<usize> =
            (0..self.header.len()).filter(|&column| !ANSWER.contains(&&self.header[column])).collect();
        let mut writer = csv::Writer::from_writer(Vec::new());
        let failed = |error: csv::Error| Failure::Failed(format!("the answer cannot be put into a table ({error})"));
        writer.write_record(kept.iter().map(|&column| &self.header[column]).chain(ANSWER)).map_err(failed)?;
        for (row, reading) in self.rows.iter().zip(readings) {
            let (e, se) = (reading.irradiance, reading.stderr);
            let numbers = [e.x, e.y, e.z, se.x, se.y, se.z].map(nine_digits);
            let asked = kept.iter().map(|&column| row[column].to_owned());
            writer.write_record(asked.chain(numbers).chain([reading.samples.to_string()])).map_err(failed)?;
        }
        writer.into_inner().map_err(|error| Failure::Failed(format!("the answer cannot be put into a table ({error})")))
    }
}

fn point(row: &StringRecord, columns: [usize; INPUT.len()]) -> Result<MeterPoint, String> {
    let mut numbers = [0.0_f32; INPUT.len()];
    for ((number, column), name) in numbers.iter_mut().zip(columns).zip(INPUT) {
        let text = row.get(column).unwrap_or_default();
        *number = text
            .parse()
            .ok()
            .filter(|number: &f32| number.is_finite())
            .ok_or_else(|| format!("{name} is \"{text}\" where a finite number is needed"))?;
    }
    let [x, y, z, nx, ny, nz] = numbers;
    // In f64, so that neither a tiny nor a huge normal is lost in its square.
    let normal = glam::DVec3::new(f64::from(nx), f64::from(ny), f64::from(nz)).try_normalize();
    let normal = normal.ok_or("its normal (nx, ny, nz) has no length")?;
    Ok(MeterPoint { position: Vec3::new(x, y, z), normal: normal.as_vec3() })
}

/// A number to nine significant digits, which hold any f32.
fn nine_digits(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return number.to_string();
    }
    let scientific = format!("{number:.8e}");
    // The exponent after rounding to nine digits, which may carry into the next power of ten.
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()).unwrap_or(0);
    match usize::try_from(8 - exponent) {
        Ok(decimals) if exponent >= -5 => format!("{number:.decimals$}"),
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nine_significant_digits() {
        assert_eq!(nine_digits(1.0 / 3.0), "0.333333333");
        assert_eq!(nine_digits(200.0 / 3.0), "66.6666667");
        assert_eq!(nine_digits(0.999_999_999_9), "1.00000000");
        assert_eq!(nine_digits(1.234_567_891_2e-9), "1.23456789e-9");
        assert_eq!(nine_digits(1.234_567_891_2e12), "1.23456789e12");
        assert_eq!(nine_digits(0.0), "0");
        for number in [1.0e-7_f32, 0.1, 16_777_215.0, 1.0e20] {
            assert_eq!(nine_digits(f64::from(number)).parse::<f32>(), Ok(number));
        }
    }
}

//! Every point of a study as a table for programs.

use crate::study::{Standing, Study};
use std::fmt::Write;

/// Columns: technique, paths from each texel, processor time of the whole lightmap [s], error (root mean square over
/// the mean, a share), `known` or `near_reference`.
pub(super) fn csv(study: &Study) -> String {
    let mut text = String::from("technique,paths,cpu_seconds,error,standing\n");
    for curve in &study.curves {
        for point in &curve.points {
            let standing = match point.standing {
                Standing::Known => "known",
                Standing::NearReference => "near_reference",
            };
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{},{},{:.6e},{:.6e},{standing}",
                curve.technique.key(),
                point.paths,
                point.cpu_seconds,
                point.error
            );
        }
    }
    text
}

//! Shapes and placements of triangles: thin, tiny, huge, of no area, on top of each other, many, badly described.

use crate::case::Case;

pub const CASES: &[Case] = &[];

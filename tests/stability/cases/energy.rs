//! Light that goes on and on: what is given off must be absorbed, however long the paths.

use crate::case::Case;

pub const CASES: &[Case] = &[];

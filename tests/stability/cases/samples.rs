//! Random numbers: more of them, in more dimensions, for more neighbours than a sequence was made for.

use crate::case::Case;

pub const CASES: &[Case] = &[];

//! Where a receiver is, seen from a light: near, far, on it, beside it, behind it, at a grazing angle.

use crate::case::Case;

pub const CASES: &[Case] = &[];

//! Lobes at their limits: mirrors that are nearly none, glass that is nearly none, glass in glass.

use crate::case::Case;

pub const CASES: &[Case] = &[];

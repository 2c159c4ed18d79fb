//! The statistical checks of `src/math/testing.rs`, for integration tests: `#[path = "common/statistics.rs"] mod
//! statistics;`, or a `mod statistics;` of `tests/common/mod.rs`.

use bevy_kiln::math::chi_squared_survival;

#[allow(dead_code, reason = "each test program uses some of the checks")]
#[path = "../../src/math/testing.rs"]
mod testing;

#[allow(unused_imports, reason = "each test program uses some of the checks")]
pub(crate) use testing::*;

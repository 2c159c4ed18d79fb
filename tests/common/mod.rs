//! What several test files share: scenes by hand and from files, reference tables, and the statistics that judge.
#![allow(dead_code, reason = "each test file uses a part of it")]

pub mod display;
pub mod fresnel;
pub mod garden;
pub mod glb;
pub mod measured;
pub mod meter;
pub mod scenes;
pub mod statistics;
pub mod table;
pub mod volume;

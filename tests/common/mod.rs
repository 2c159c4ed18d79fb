//! What several test files share: scenes by hand and from files, and the statistics that judge them.
#![allow(dead_code, reason = "each test file uses a part of it")]

pub mod glb;
pub mod scenes;
pub mod table;

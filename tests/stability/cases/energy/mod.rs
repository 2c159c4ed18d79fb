//! Light that goes on and on: what is given off must be absorbed, however long the paths.

mod balance;
mod endless;
mod stacks;
mod surfaces;
mod walls;

use crate::case::Case;

pub const CASES: &[&[Case]] = &[walls::CASES, endless::CASES, surfaces::CASES, stacks::CASES, balance::CASES];

const CUT: &str = "a cap on bounces (Godot 5 to 16, Unity 2 to 100) cuts the tail off";

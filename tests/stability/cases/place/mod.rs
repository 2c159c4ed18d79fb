//! Size and place of the world: light does not know how large a scene is, where it stands or how bright it is.

mod moved;
mod power;
mod scale;

use crate::case::Case;

pub const CASES: &[&[Case]] = &[scale::CASES, moved::CASES, power::CASES];

//! Pictures that come in (skies, textures) and pictures that go out (texels in formats of small range).

use crate::case::Case;

pub const CASES: &[Case] = &[];

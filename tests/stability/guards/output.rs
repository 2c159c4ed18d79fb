//! Guards of texel formats.

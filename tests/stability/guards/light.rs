//! Guards of light sampling: densities and choices that stay finite, near and far.

//! Guards of lobes and shading frames.

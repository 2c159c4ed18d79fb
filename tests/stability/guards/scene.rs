//! Guards of scenes: what is refused by name before anything is traced.

//! Guards of pictures that are looked up.

//! What no scene may break.

//! Scenes by hand.

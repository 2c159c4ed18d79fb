//! What the examples have in common that open a scene of this repository, bake it and look on: a window, a camera that
//! goes around, keys, words on the screen, and a picture for a run without a person. What a [`Stage`] does not say is
//! the same for all.

pub mod args;
mod bake;
mod folder;
mod overlay;
pub mod room;
mod run;
mod shoot;
mod stage;

pub use run::run;
pub use stage::Stage;

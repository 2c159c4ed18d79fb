//! Seams: what is displayed on the two sides of a chart's edge is the same light, on curved meshes and across pieces
//! that touch, and nothing else is touched for it.
//!
//! Each law is a checker of a finished lightmap; beside each stands a test that plants a fault and asks that the
//! checker find it.

mod common;

#[path = "seams/charted.rs"]
mod charted;
#[path = "seams/curved.rs"]
mod curved;
#[path = "seams/judge.rs"]
mod judge;
#[path = "seams/modular.rs"]
mod modular;
#[path = "seams/properties.rs"]
mod properties;

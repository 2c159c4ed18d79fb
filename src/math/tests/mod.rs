//! Tests of what needs the statistical checks, and of these checks.

mod harness;
mod polygon;
mod spherical;
mod warp;

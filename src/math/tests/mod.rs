//! Tests of what needs the statistical checks, and of these checks.

mod polygon;
mod spherical;

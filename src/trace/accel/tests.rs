//! The tree and the triangle test: against exhaustive search, against f64, and against holes.

mod oracle;
mod watertight;

//! The tree and the triangle test: against exhaustive search, against f64, against holes, and from afar.

mod edges;
mod far;
mod oracle;
mod watertight;

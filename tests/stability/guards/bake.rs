//! Guards of sums, reports and what a bake refuses.

//! Guards of the random numbers.

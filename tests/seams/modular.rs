//! Walls and floors in pieces.

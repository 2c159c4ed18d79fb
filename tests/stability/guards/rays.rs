//! Guards of rays: where they start, what they meet.

use crate::guard::{Edit, Guard};

pub static TREE_UNITS: Guard = Guard {
    name: "tree units",
    does: "the tree's own absolute length (obvhs drops boxes nearer than 1e-4) is made a trillionth of the scene: all \
           lengths are scaled by a power of two, which rounds nothing",
    edits: &[Edit {
        file: "src/trace/accel.rs",
        text: "2.0_f32.powi((30 - exponent).clamp(-90, 120))",
        instead: "2.0_f32.powi(0 * exponent)",
    }],
};

pub static ORIGIN_MOVE: Guard = Guard {
    name: "origin moved by its error",
    does: "a ray starts off its surface by the bound on the start's rounding error along the normal, in each axis \
           (Wächter and Binder 2019; Pharr, Jakob and Humphreys 2023, § 6.8)",
    edits: &[Edit {
        file: "src/trace/surface.rs",
        text: "let distance = self.error.dot(normal.abs());",
        instead: "let distance = 0.0; if true { return position; }",
    }],
};

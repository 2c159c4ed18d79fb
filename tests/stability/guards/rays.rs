//! Guards of rays: where they start, what they meet, where they end.

use crate::guard::{Edit, Guard};

pub static TREE_UNITS: Guard = Guard {
    name: "tree units",
    does: "the tree knows no length: lengths are scaled by a power of two, which rounds nothing, to a scene of 2^30, and a \
           box is entered however near its end is; taken out, boxes that end within 1e-4 m are dropped (obvhs)",
    edits: &[
        Edit {
            file: "src/trace/accel.rs",
            text: "2.0_f32.powi((30 - exponent).clamp(-90, 120))",
            instead: "2.0_f32.powi(0 * exponent)",
        },
        Edit {
            file: "src/trace/accel/walk.rs",
            text: "(lanes.signs(lanes.le(enter, leave)), enter)",
            instead: "(lanes.signs(lanes.and(lanes.le(enter, leave), lanes.lt(lanes.splat(1e-4), leave))), enter)",
        },
    ],
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

pub static NO_CONSTANT: Guard = Guard {
    name: "no constant ray bias",
    does: "that distance is a bound on an error, in units in the last place of the triangle's coordinates, and no \
           length in metres; taken out, it is Fyrox's 10 mm",
    edits: &[Edit {
        file: "src/trace/surface.rs",
        text: "let distance = self.error.dot(normal.abs());",
        instead: "let distance = 0.01;",
    }],
};

pub static SHADOW_LENGTH: Guard = Guard {
    name: "shadow rays go all the way",
    does: "a shadow ray has its lamp's own point as its end, and what lies near that end is judged by the side of the \
           plane, in f64; taken out, it stops a ten-thousandth short (pbrt's ShadowEpsilon)",
    edits: &[Edit {
        file: "src/trace/accel.rs",
        text: "self.search(origin, direction, Some((end, distance)), stops)",
        instead: "self.search(origin, direction, Some((end, distance * (1.0 - 1e-4))), stops)",
    }],
};

pub static NO_LEAST_AREA: Guard = Guard {
    name: "no triangle is too small",
    does: "a triangle is missed only if its area, seen along the ray, is exactly 0; taken out, twice that area below \
           1e-5 m² is a miss, as in Godot's lightmapper",
    edits: &[
        Edit {
            file: "src/trace/accel.rs",
            text: "2.0_f32.powi((30 - exponent).clamp(-90, 120))",
            instead: "2.0_f32.powi(0 * exponent)",
        },
        Edit {
            file: "src/trace/triangle.rs",
            text: "if determinant == 0.0 {",
            instead: "if determinant.abs() < 1e-5 {",
        },
        Edit {
            file: "src/trace/accel/packet.rs",
            text: "let t = lanes.mul(sum, inverse);",
            // All bits are no number.
            instead: "let t = lanes.or(lanes.mul(sum, inverse), lanes.lt(lanes.splat(1e5), lanes.abs(inverse)));",
        },
    ],
};

pub static WATERTIGHT: Guard = Guard {
    name: "edges belong to both",
    does: "a ray misses a triangle only if its three edge functions have both signs; neighbours compute that of their \
           common edge from the same products (Woop, Benthin and Wald 2013), so that none passes between; taken out, \
           what is within 1e-5 of an edge is a miss",
    edits: &[
        Edit {
            file: "src/trace/triangle.rs",
            text: "if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {",
            instead: "if u.abs().min(v.abs()).min(w.abs()) < 1e-5 * (u + v + w).abs() \
                      || (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {",
        },
        Edit {
            file: "src/trace/accel/packet.rs",
            text: "let crossed = !(mixed | zeros) & ((1 << LANES) - 1);",
            instead: "let least = lanes.min(lanes.min(lanes.abs(u), lanes.abs(v)), lanes.abs(w)); \
                      let sum = lanes.abs(lanes.add(lanes.add(u, v), w)); \
                      let thin = lanes.signs(lanes.lt(least, lanes.mul(lanes.splat(1e-5), sum))); \
                      let crossed = !(mixed | zeros | thin) & ((1 << LANES) - 1);",
        },
    ],
};

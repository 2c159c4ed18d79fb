//! Guards of what rays meet: beside where they start and where they end, on edges, and far away.

use crate::guard::{Edit, Guard};

const ACCEL: &str = "src/trace/accel.rs";
const WALK: &str = "src/trace/accel/walk.rs";
const TRIANGLE: &str = "src/trace/triangle.rs";

pub static ERROR_PER_AXIS: Guard = Guard {
    name: "an error for each axis",
    does: "a start's error is bounded on each axis alone, 32u·max v: a level floor at height 0 is left by next to nothing \
           however far it reaches",
    edits: &[Edit {
        file: "src/trace/surface.rs",
        text: "vertices.iter().fold(Vec3::ZERO, |size, vertex| size.max(vertex.abs()))",
        instead: "Vec3::splat(vertices.iter().fold(0.0_f32, |size, vertex| size.max(vertex.abs().max_element())))",
    }],
};

pub static ERROR_BOUND: Guard = Guard {
    name: "a bound that is derived",
    does: "the move along the normal is 32u of each coordinate's size, the next power of two above the 19.3u that \
           interpolation, the move itself and the rounded direction need together (Higham 2002, lemma 3.1)",
    edits: &[Edit { file: "src/trace/surface.rs", text: "16.0 * f32::EPSILON * v", instead: "0.5 * f32::EPSILON * v" }],
};

pub static SIDE_IN_F64: Guard = Guard {
    name: "sides told apart in f64",
    does: "whether a hit that lies within the error of its distance is before the ray's start or behind it is decided by \
           the side of the plane that the start is on, in f64",
    edits: &[Edit {
        file: ACCEL,
        text: "plane_distance(self.position, self.inwards, triangle) > 0.0",
        instead: "plane_distance(self.position, self.inwards, triangle) > f64::INFINITY",
    }],
};

pub static BEHIND_THE_START: Guard = Guard {
    name: "nothing behind the start",
    does: "a crossing counts only if it lies before the ray's start for certain",
    edits: &[Edit { file: WALK, text: "(certain & 1 << lane != 0 ||", instead: "(possible & 1 << lane != 0 ||" }],
};

pub static BEFORE_THE_END: Guard = Guard {
    name: "nothing at the end",
    does: "what lies within rounding of a shadow ray's end, as the lamp itself does, blocks it only if it lies on the \
           ray's side of that end, by its plane in f64",
    edits: &[Edit {
        file: WALK,
        text: "end.is_behind(distance - t, t_error + end_error(distance), triangle)",
        instead: "end.is_behind(distance - t, 0.0 * t_error, triangle)",
    }],
};

pub static ANSWER_BELOW_THE_END: Guard = Guard {
    name: "an answer that stands",
    does: "what is known to lie before a shadow ray's end is not held against the ray's length once more, which rounding \
           could deny",
    edits: &[Edit {
        file: WALK,
        text: "crossing.t.is_finite()",
        instead: "crossing.t < end.map_or(f32::INFINITY, |(_, distance)| distance)",
    }],
};

pub static PADDING: Guard = Guard {
    name: "padded boxes",
    does: "boxes are 16ε of the scene's reach larger on every side: what the slab test and the triangle test may round \
           together",
    edits: &[Edit {
        file: ACCEL,
        text: "let padding = PADDING * f32::EPSILON * reach;",
        instead: "let padding = 0.0 * PADDING;",
    }],
};

pub static NO_MINUS_ZERO: Guard = Guard {
    name: "one sign for −0",
    does: "which sides of boxes are near is told by the sign of the very inverse that they are multiplied with: −∞ for −0",
    edits: &[Edit {
        file: WALK,
        text: "near: [x.is_sign_negative().into(), y.is_sign_negative().into(), z.is_sign_negative().into()],",
        instead: "near: [(d.x < 0.0).into(), (d.y < 0.0).into(), (d.z < 0.0).into()],",
    }],
};

pub static EXACT_EDGES: Guard = Guard {
    name: "edge functions exact at zero",
    does: "where an edge function rounds to 0 all three are evaluated in f64, in which products of f32 are exact (Woop, \
           Benthin and Wald 2013)",
    edits: &[Edit { file: TRIANGLE, text: "if u == 0.0 || v == 0.0 || w == 0.0 {", instead: "if false {" }],
};

pub static ERROR_OF_T: Guard = Guard {
    name: "a bound on each distance",
    does: "each crossing's distance has a bound on its own rounding (Pharr, Jakob and Humphreys 2023, § 6.8.4), below which \
           f64 decides",
    edits: &[
        Edit { file: TRIANGLE, text: "let t_error = 3.0 *", instead: "let t_error = 0.0 *" },
        Edit { file: "src/trace/accel/packet.rs", text: "times(lanes, 3.0, sum)", instead: "times(lanes, 0.0, sum)" },
    ],
};

pub static TRACED_FRAME: Guard = Guard {
    name: "a frame near the scene",
    does: "where all vertices have one sign and the farthest is at most twice as far as the nearest, the nearest is \
           subtracted, which is exact (Sterbenz 1974, theorem 4.3.1)",
    edits: &[
        Edit { file: "src/trace/traced.rs", text: "(true, _) => low,", instead: "(true, _) => 0.0 * low," },
        Edit { file: "src/trace/traced.rs", text: "(_, true) => high,", instead: "(_, true) => 0.0 * high," },
    ],
};

pub static FAR_ORIGINS: Guard = Guard {
    name: "rays from afar come nearer first",
    does: "a ray that starts beyond 1.5 reaches of the scene is moved along its line to it, in f64",
    edits: &[Edit {
        file: "src/trace/accel/far.rs",
        text: "(origin * self.scale).abs().max_element() > NEAR * self.reach",
        instead: "(origin * self.scale).abs().max_element() > f32::INFINITY * NEAR",
    }],
};

pub static FAR_TARGETS: Guard = Guard {
    name: "shadow rays to afar are cut",
    does: "of a segment that ends millions of reaches away only the part near the scene is looked at, in f64",
    edits: &[Edit {
        file: "src/trace/accel/far.rs",
        text: "(target * self.scale).abs().max_element() > TOO_FAR * self.reach",
        instead: "(target * self.scale).abs().max_element() > f32::INFINITY * TOO_FAR",
    }],
};

pub static METER_ROUNDING: Guard = Guard {
    name: "a meter's own rounding",
    does: "a point far from the world's origin counts as on a surface if only its own rounding to f32 keeps it off",
    edits: &[Edit {
        file: "src/trace/path/start.rs",
        text: "let rounding = self.traced_from_world.rounding(position_world).dot(normal.abs());",
        instead: "let rounding = 0.0 * self.traced_from_world.rounding(position_world).x;",
    }],
};

pub static NEAREST_SURFACE: Guard = Guard {
    name: "a meter on the nearest surface",
    does: "a point counts as on the surface that it lies on within its rounding, else on the nearest in reach",
    edits: &[Edit {
        file: "src/trace/path/start.rs",
        text: "meet(position + normal * fine, -normal, 2.0 * fine);",
        instead: "meet(position + normal * (fine + coarse), -normal, 2.0 * coarse);",
    }],
};

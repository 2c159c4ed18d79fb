//! Guards of light sampling: densities and choices that stay finite, near and far.

use crate::guard::{Edit, Guard};

pub static FULL_SUMS: Guard = Guard {
    name: "samples summed in f64",
    does: "the light of samples is summed in f64, whatever its size; no half-float lies between",
    edits: &[Edit {
        file: "src/bake/gather/runs.rs",
        text: "run.sum += kept.as_dvec3();",
        instead: "run.sum += Vec3::from_array(kept.to_array().map(|c| half::f16::from_f32(c).to_f32())).as_dvec3();",
    }],
};

pub static SOLID_ANGLE: Guard = Guard {
    name: "flat lamps sampled by solid angle",
    does: "points on a flat lamp are drawn by the solid angle that it fills at the receiver (Ureña, Fajardo and King \
           2013; Arvo 1995), so that no sample counts for more than radiance times that angle, however near it is",
    edits: &[
        Edit {
            file: "src/trace/light/seen.rs",
            text: ".map_or(Self::ByArea, Self::Rectangle)",
            instead: ".map_or(Self::ByArea, |_| Self::ByArea)",
        },
        Edit {
            file: "src/trace/light/seen.rs",
            text: ".map_or(Self::ByArea, Self::Triangle)",
            instead: ".map_or(Self::ByArea, |_| Self::ByArea)",
        },
    ],
};

pub static SOLID_ANGLE_EXACT: Guard = Guard {
    name: "solid angle without differences",
    does: "a rectangle's solid angle is one inverse tangent of sums of one sign, in f64 (Van Oosterom and Strackee \
           1983), good to 3e-7 of itself at any distance; taken out, it is the sum of four angles less 2π in f32",
    edits: &[
        Edit {
            file: "src/math/spherical_rectangle.rs",
            text: "2.0 * Portable::atan2(n * (d1 + d2), d1 * d2 - n * n)",
            instead: "{ let _ = (n, d1, d2); let z2 = self.distance * self.distance; \
                      let angle = |a: f64, b: f64| f64::from((-(a * b) / ((z2 + a * a) * (z2 + b * b)).sqrt()) as f32)\
                      .acos() as f32; let sum = angle(-self.y0, self.x1) + angle(self.x1, self.y1) \
                      + angle(self.y1, -self.x0) + angle(-self.x0, -self.y0); \
                      f64::from(sum - std::f32::consts::TAU) }",
        },
        Edit {
            file: "src/math/spherical_rectangle.rs",
            text: "if !(SMALLEST_SOLID_ANGLE..TAU).contains(&solid_angle) {",
            instead: "if SMALLEST_SOLID_ANGLE.is_nan() || solid_angle > TAU {",
        },
    ],
};

pub static LAMP_END: Guard = Guard {
    name: "shadow rays end before their lamp",
    does: "the end of a shadow ray is brought back to its lamp's plane in f64 and then moved off by the bound on the \
           lamp's own error; and a lamp lies off its own plane by as much, so that neither a lamp's own triangles nor \
           the ceiling that it is set into block it",
    edits: &[
        Edit {
            file: "src/trace/light/emitter.rs",
            text: "let target = self.end_before(receiver, offset, towards_receiver);",
            instead: "let target = receiver + offset + towards_receiver * self.error.dot(self.normal.abs());",
        },
        Edit {
            file: "src/trace/light/compile.rs",
            text: "let corner = corner + normal * error.dot(normal.abs());",
            instead: "",
        },
    ],
};

pub static BULBS: Guard = Guard {
    name: "bulbs near and far",
    does: "1 − cos of a sphere's cone is sin²/(1 + cos), which does not cancel; a sphere around the receiver shrinks \
           until it touches it; 1/d² of a point has no least distance",
    edits: &[
        Edit {
            file: "src/trace/light/sphere.rs",
            text: "height: sine_squared / (1.0 + cosine) })",
            instead: "height: f64::from(1.0 - cosine as f32).max(0.0 * sine_squared) })",
        },
        Edit {
            file: "src/trace/light/sphere.rs",
            text: "let radius = f64::from(radius).min(distance);",
            instead: "let radius = f64::from(radius);",
        },
        Edit {
            file: "src/trace/light/emitter.rs",
            text: "(f64::from(self.dimming(receiver)) / offset.length_squared());",
            instead: "(f64::from(self.dimming(receiver)) / offset.length_squared().max(1e-4));",
        },
    ],
};

pub static ONE_SIDED: Guard = Guard {
    name: "backs are dark",
    does: "a one-sided lamp gives light only where its normal faces the receiver",
    edits: &[Edit {
        file: "src/trace/light/emitter.rs",
        text: "if self.double_sided || self.normal.dot(wi) < 0.0 {",
        instead: "if true || self.normal.dot(wi) < 0.0 {",
    }],
};

pub static HORIZON: Guard = Guard {
    name: "whole lamps at the horizon",
    does: "a lamp is passed over only if no part of it is above the receiver's horizon: the angle that it fills is \
           taken from the angle to its centre (Conty Estevez and Kulla 2018)",
    edits: &[
        Edit {
            file: "src/trace/light/bounds.rs",
            text: "Angle::of_cosine(normal.dot(towards)).less(seen);",
            instead: "Angle::of_cosine(normal.dot(towards));",
        },
        Edit {
            file: "src/trace/light/distant.rs",
            text: "if nearest < -1e-6 { 0.0 }",
            instead: "if nearest.min(cosine) < -1e-6 { 0.0 }",
        },
    ],
};

pub static DELTA: Guard = Guard {
    name: "a sun too small is a direction",
    does: "a sun below 2e-5 rad is a single direction, which has no density and which light sampling alone finds",
    edits: &[Edit {
        file: "src/trace/light/distant.rs",
        text: "let is_delta = half < SMALLEST_HALF_ANGLE;",
        instead: "let is_delta = half < 0.0 * SMALLEST_HALF_ANGLE;",
    }],
};

pub static DIMMING: Guard = Guard {
    name: "windows end at nothing",
    does: "what is left of a lamp's light by its cone and by its range is held to 0 to 1 before it is squared",
    edits: &[
        Edit {
            file: "src/trace/light/emitter.rs",
            text: "((cosine - outer) * scale).clamp(0.0, 1.0);",
            instead: "(cosine - outer) * scale;",
        },
        Edit {
            file: "src/trace/light/emitter.rs",
            text: "(1.0 - relative * relative).clamp(0.0, 1.0);",
            instead: "1.0 - relative * relative;",
        },
    ],
};

pub static TWO_WAYS: Guard = Guard {
    name: "lamps found in two ways",
    does: "every vertex samples its lamps by solid angle and goes on in a direction that may meet them, weighted by the \
           power heuristic (Veach and Guibas 1995); taken out, lamps are sampled by area alone",
    edits: &[
        Edit {
            file: "src/trace/light/seen.rs",
            text: ".map_or(Self::ByArea, Self::Rectangle)",
            instead: ".map_or(Self::ByArea, |_| Self::ByArea)",
        },
        Edit {
            file: "src/trace/light/seen.rs",
            text: ".map_or(Self::ByArea, Self::Triangle)",
            instead: ".map_or(Self::ByArea, |_| Self::ByArea)",
        },
        Edit { file: "src/trace/transport.rs", text: "    #[default]\n    Mis,", instead: "    Mis," },
        Edit { file: "src/trace/transport.rs", text: "    Light,\n", instead: "    #[default]\n    Light,\n" },
    ],
};

pub static SPHERE_CONE: Guard = Guard {
    name: "a near sphere is a cone",
    does: "a sphere is seen as the cone of its tangents, 1 − cos = sin²/(1 + cos) with sin = r/d (Wang 1992); taken out, \
           as a disc of πr²/d²",
    edits: &[Edit {
        file: "src/trace/light/sphere.rs",
        text: "height: sine_squared / (1.0 + cosine) })",
        instead: "height: 0.5 * sine_squared + 0.0 * cosine })",
    }],
};

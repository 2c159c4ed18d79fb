//! Guards of the bake: sums, ends, refusals.

use crate::guard::{Edit, Guard};

pub static ENDLESS_REFUSED: Guard = Guard {
    name: "endless light refused",
    does: "before a bake 64 paths from sources and 64 from receivers are followed; if one of them meets 65536 surfaces, \
           the scene is refused with the material's name: it has no steady state that a bake would reach",
    edits: &[Edit {
        file: "src/bake/endless.rs",
        text: "if let Some(surface) = tally.kept_by {",
        instead: "if let Some(surface) = tally.kept_by.filter(|_| false) {",
    }],
};

pub static LIGHT_ONLY: Guard = Guard {
    name: "light only",
    does: "a path's value that is negative or not finite is not added to a mean; it is counted and reported",
    edits: &[Edit {
        file: "src/bake/gather/runs.rs",
        text: "if !is_light(value) {",
        instead: "if !is_light(value) && self.tally.rays == 0 {",
    }],
};

pub static SUM_IN_F64: Guard = Guard {
    name: "sums in f64",
    does: "paths are added up in f64 in 16 runs: n additions are off by at most n · 2⁻⁵³ of the sum, 1.1e-7 for 1e9 \
           paths (Higham 2002, § 4.2)",
    edits: &[Edit {
        file: "src/bake/gather/runs.rs",
        text: "run.sum += kept.as_dvec3();",
        instead: "run.sum = (run.sum.as_vec3() + kept).as_dvec3();",
    }],
};

pub static NO_LIGHT_REFUSED: Guard = Guard {
    name: "no light refused",
    does: "a bake without any light is refused with what to do about it",
    edits: &[Edit {
        file: "src/bake/lightmap.rs",
        text: "    if !tracer.has_light() {\n",
        instead: "    if false {\n",
    }],
};

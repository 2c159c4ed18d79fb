//! Guards of paths: roulette, ends, absorption.

use crate::guard::{Edit, Guard};

pub static SURVIVAL_AT_MOST_ONE: Guard = Guard {
    name: "survival at most 1",
    does: "a path's chance to live on is held to 1 (Arvo and Kirk 1990): where it carries more than the throughput at \
           which roulette begins, the division by the chance would take what nobody stands in for",
    edits: &[Edit {
        file: "src/trace/path/walk.rs",
        text: "(carried / ROULETTE_THROUGHPUT).min(1.0)",
        instead: "carried / ROULETTE_THROUGHPUT",
    }],
};

pub static NO_BEST_CHANCE: Guard = Guard {
    name: "survival up to 1",
    does: "a path that carries its share lives on for sure: no best chance below 1, by which the weights of those that \
           are left would grow as (1/q)ⁿ and their second moment with the albedo a as (a²/q)ⁿ",
    edits: &[Edit {
        file: "src/trace/path/walk.rs",
        text: "(carried / ROULETTE_THROUGHPUT).min(1.0)",
        instead: "(carried / ROULETTE_THROUGHPUT).min(0.95)",
    }],
};

pub static SURVIVORS_STAND_IN: Guard = Guard {
    name: "survivors stand in",
    does: "what survives roulette is divided by the chance, so that it is on average what went in",
    edits: &[Edit { file: "src/trace/path/walk.rs", text: "            self.throughput /= survival;\n", instead: "" }],
};

pub static LENGTH_BOUND: Guard = Guard {
    name: "length bound",
    does: "a path ends after 65536 vertices, which one that loses 4.5e-4 at each reaches with a chance below 1e-12; \
           paths so cut are counted and reported",
    edits: &[Edit {
        file: "src/trace/path/walk.rs",
        text: "if self.number >= MAX_VERTICES {",
        instead: "if self.number == u32::MAX {",
    }],
};

pub static WEIGHTS: Guard = Guard {
    name: "weights sum to 1",
    does: "light that a path meets counts by how else it could have been found (Veach and Guibas 1995): in full in a \
           mirror, where no light sample finds it",
    edits: &[
        Edit {
            file: "src/trace/path/walk.rs",
            text: "(Density::Delta, _) | (_, Estimator::Bsdf) => 1.0,",
            instead: "(_, Estimator::Bsdf) => 1.0,\n            (Density::Delta, _) => 0.9,",
        },
        Edit {
            file: "src/trace/path/walk.rs",
            text: "power_heuristic(own, pdf(&ray.context))",
            instead: "power_heuristic(own, 0.0 * pdf(&ray.context))",
        },
    ],
};

pub static CAP: Guard = Guard {
    name: "cap on bounces",
    does: "a cap of k bounces adds the light of k + 1 segments and nothing beyond",
    edits: &[Edit { file: "src/trace/path/walk.rs", text: "self.number >= cap)", instead: "self.number > cap)" }],
};

pub static NUMBER_DEALT_ANEW: Guard = Guard {
    name: "a number dealt anew",
    does: "one random number decides at every pane on a ray: what is left of it is stretched over [0, 1) again",
    edits: &[Edit { file: "src/trace/path/walk.rs", text: "                u_pass /= chance;\n", instead: "" }],
};

pub static BODY_LEARNT: Guard = Guard {
    name: "a body learnt from behind",
    does: "a path that meets a body's surface from behind before it crossed any has been in the body from its start, \
           and is dimmed on its way there",
    edits: &[Edit {
        file: "src/trace/path/walk.rs",
        text: "if K & LAYERED != 0 && !self.knows_body {",
        instead: "if K & LAYERED != 0 && !self.knows_body && hit.t < 0.0 {",
    }],
};

pub static NO_ZERO_TIMES_INFINITY: Guard = Guard {
    name: "absorption without 0 · ∞",
    does: "a channel that a body does not absorb is left alone whatever the way, so that 0 · ∞ is not computed",
    edits: &[Edit {
        file: "src/trace/path/walk.rs",
        text: "if absorption == 0.0 { 1.0 } else",
        instead: "if false { 1.0 } else",
    }],
};

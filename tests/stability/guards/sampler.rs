//! Guards of the random numbers.

use crate::guard::{Edit, Guard};

pub static BLOCKS: Guard = Guard {
    name: "a seed for each 2^16 samples",
    does: "the Sobol sequence (Burley 2020) ends at 2^16 samples; each further block of as many is another one, under a \
           seed hashed from the block's number",
    edits: &[Edit {
        file: "src/trace/sampler/sobol.rs",
        text: "let key = if block == 0 { key } else { combine(combine(key, BLOCKS), block) };",
        instead: "let _ = block;",
    }],
};

pub static ROUNDS: Guard = Guard {
    name: "a seed for each 256 dimensions",
    does: "the sequence has 256 dimensions, enough for 32 vertices; each later round of them is another sequence, under \
           a seed hashed from the round's number",
    edits: &[Edit {
        file: "src/trace/sampler/sobol.rs",
        text: "let seed = if round == 0 { self.seed } else { seed32(combine(combine(self.key, ROUNDS), u64::from(round))) };",
        instead: "let (seed, _) = (self.seed, round);",
    }],
};

pub static LIGHT_DIMENSIONS: Guard = Guard {
    name: "dimensions of its own for each light sample",
    does: "numbers that one path multiplies with each other come from different dimensions",
    edits: &[Edit {
        file: "src/trace/sampler/mod.rs",
        text: "Self::Light { vertex } => 2 * vertex + 2,",
        instead: "Self::Light { vertex } => [2, 0][(vertex as usize).min(1)].max(2 * vertex.saturating_sub(1)),",
    }],
};

pub static START_DIMENSIONS: Guard = Guard {
    name: "dimensions of its own for the place in a texel",
    does: "where a path starts in its texel and where it goes from there come from different dimensions",
    edits: &[Edit { file: "src/trace/sampler/mod.rs", text: "Self::Start => 1,", instead: "Self::Start => 0," }],
};

pub static SCRAMBLE: Guard = Guard {
    name: "Owen-scrambled Sobol points",
    does: "points of one estimate are spread evenly in all their dimensions together (Owen 1997; Burley 2020)",
    edits: &[Edit {
        file: "src/trace/sampler/sobol.rs",
        text: "sobol_burley::sample_4d(self.index, set, seed)",
        instead: "sobol_burley::sample_4d(0, set, seed32(combine(u64::from(seed), u64::from(self.index))))",
    }],
};

const KEY: &str = "combine(combine(combine(seed, kind as u64), object), place)";

pub static KEY_OF_PLACE: Guard = Guard {
    name: "keys made of the place",
    does: "every texel, pixel and point has numbers of its own, by a hash of where it is (SplitMix64's finaliser)",
    edits: &[Edit {
        file: "src/bake/gather.rs",
        text: KEY,
        instead: "combine(combine(combine(seed, kind as u64), object), place - place)",
    }],
};

pub static KEY_OF_OBJECT: Guard = Guard {
    name: "keys made of the object",
    does: "texels at the same place of two objects have numbers of their own, by a hash of the object's stable id; so \
           have two meter points, by a hash of all bits of their positions",
    edits: &[Edit {
        file: "src/bake/gather.rs",
        text: KEY,
        instead: "combine(combine(combine(seed, kind as u64), object - object), place)",
    }],
};

pub static KEY_OF_SEED: Guard = Guard {
    name: "keys made of the seed",
    does: "another seed gives other numbers everywhere, by the same hash",
    edits: &[Edit {
        file: "src/bake/gather.rs",
        text: KEY,
        instead: "combine(combine(combine(seed - seed, kind as u64), object), place)",
    }],
};

pub static KEY_OF_REPLICATE: Guard = Guard {
    name: "a scramble for each replicate",
    does: "an estimate is the mean of 16 runs with scrambles of their own; only their spread is an honest error (Owen \
           1997)",
    edits: &[Edit {
        file: "src/bake/gather/runs.rs",
        text: "let numbers = numbers(combine(self.key, number.into()), run.index);",
        instead: "let numbers = numbers(combine(self.key, (number / 8).into()), run.index);",
    }],
};

pub static WHOLE_REPLICATES: Guard = Guard {
    name: "samples rounded up to whole replicates",
    does: "every replicate has a sample: its mean is never 0/0",
    edits: &[Edit {
        file: "src/bake/gather/runs.rs",
        text: "u64::from(count.div_ceil(REPLICATES))",
        instead: "u64::from(count / REPLICATES)",
    }],
};

pub static CANCEL: Guard = Guard {
    name: "a look at the cancel switch every 64 paths",
    does: "an estimate that would take hours ends when it is asked to",
    edits: &[Edit {
        file: "src/bake/gather/runs.rs",
        text: "if self.runs[number as usize].index.is_multiple_of(CANCEL_INTERVAL) && cancel.is_cancelled() {",
        instead: "if CANCEL_INTERVAL == 0 && cancel.is_cancelled() {",
    }],
};

//! Guards of what is written.

use crate::guard::{Edit, Guard};

pub static HELD_TO_FORMAT: Guard = Guard {
    name: "held to the format",
    does: "a value is brought to the nearest that its format holds, NaN and −0 to 0, and every texel so changed is \
           counted and reported",
    edits: &[
        Edit {
            file: "src/output/texels.rs",
            text: "    value.max(0.0).min(limit) + 0.0\n",
            instead: "    value.min(limit * f32::INFINITY)\n",
        },
        Edit {
            file: "src/output/texels.rs",
            text: "changed.count() as u64",
            instead: "changed.filter(|_| limits_nothing()).count() as u64",
        },
        Edit {
            file: "src/output/texels.rs",
            text: "/// The nearest value in [0, limit]; zero for what is not a number.\n",
            instead: "fn limits_nothing() -> bool {\n    false\n}\n\n/// The same.\n",
        },
    ],
};

pub static ROUNDED_AS_SPECIFIED: Guard = Guard {
    name: "rounded as specified",
    does: "mantissas are rounded to nearest under the finest exponent that fits, the smallest exponent taking what is \
           below (EXT_texture_shared_exponent 2004); half floats keep their denormals",
    edits: &[
        Edit {
            file: "src/output/rgb9e5.rs",
            text: "floor_log2(largest).max(-BIAS - 1) + 1 + BIAS;",
            instead: "floor_log2(largest).max(-BIAS) + 1 + BIAS;",
        },
        Edit {
            file: "src/output/rgb9e5.rs",
            text: "(channel / scale_for(exponent) + 0.5).floor() as u32;",
            instead: "(channel / scale_for(exponent)).floor() as u32;",
        },
        Edit {
            file: "src/output/texels.rs",
            text: ".map(|value| f16::from_f32(value).to_le_bytes())",
            instead: ".map(|value| f16::from_f32(if value < 6.1e-5 { 0.0 } else { value }).to_le_bytes())",
        },
    ],
};

//! The name that a thing keeps from bake to bake.

use serde::{Deserialize, Serialize};

/// A name that stays the same from bake to bake, over threads, orders and entity numbers: a path of names, from
/// the root down.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct StableId(String);

impl StableId {
    /// The id with this text.
    pub fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// The text of the id.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// A 64-bit key of the text: FNV-1a (Fowler, Noll and Vo 1991), the same on every machine.
    pub fn key(&self) -> u64 {
        self.0.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
    }
}

impl std::fmt::Display for StableId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn key_is_the_published_fnv_1a() {
        assert_eq!(StableId::new("").key(), 0xcbf2_9ce4_8422_2325);
        assert_eq!(StableId::new("a").key(), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(StableId::new("foobar").key(), 0x8594_4171_f739_67e8);
    }
}

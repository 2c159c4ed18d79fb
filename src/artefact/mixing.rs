//! Mixing 32-bit words into 64 bits, for what must be recognised on another machine. No guard against malice.

/// Takes words one by one. Each step maps the state and the word one to one, so that a change of a single word
/// always changes the result.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixer {
    state: u64,
    words: u64,
}

impl Default for Mixer {
    /// Starts where FNV-1a does (Fowler, Noll and Vo 1991).
    fn default() -> Self {
        Self { state: 0xcbf2_9ce4_8422_2325, words: 0 }
    }
}

impl Mixer {
    /// Takes a word as FNV-1a takes a byte, with a multiplier that spreads wider and the high half folded back.
    pub(super) fn add(&mut self, word: u32) {
        // The odd constant next to 2⁶⁴ over the golden ratio (Knuth, The Art of Computer Programming 3, 6.4).
        self.state = (self.state ^ u64::from(word)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.state ^= self.state >> 32;
        self.words += 1;
    }

    /// Takes many words.
    pub(super) fn add_all(&mut self, words: impl IntoIterator<Item = u32>) {
        words.into_iter().for_each(|word| self.add(word));
    }

    /// Takes bytes, four to a word, the least first; the last word is filled up with zeros.
    pub(super) fn add_bytes(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(4) {
            let mut word = [0; 4];
            word[..chunk.len()].copy_from_slice(chunk);
            self.add(u32::from_le_bytes(word));
        }
    }

    /// The result, with a number of the caller's and the count of words; the last mixing is Stafford's thirteenth
    /// variant (2011), which SplitMix64 ends with (Steele, Lea and Flood 2014).
    pub(super) fn finish(mut self, number: u64) -> u64 {
        for number in [number, self.words] {
            self.add(number as u32);
            self.add((number >> 32) as u32);
        }
        let mut bits = self.state;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ bits >> 31
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_bits_change_with_each_bit() {
        let hash = |bit: usize| {
            let mut mixer = Mixer::default();
            let mut words = [3_u32; 8];
            if let Some(word) = words.get_mut(bit / 32) {
                *word ^= 1 << (bit % 32);
            }
            mixer.add_all(words);
            mixer.finish(0)
        };
        let unchanged = hash(256);
        let changed: u32 = (0..256).map(|bit| (hash(bit) ^ unchanged).count_ones()).sum();
        // 16384 fair coins: a mean of 8192 and a deviation of 64.
        assert!((8192 - 320..8192 + 320).contains(&changed), "{changed}");
        assert!((0..256).all(|bit| (hash(bit) ^ unchanged).count_ones() >= 12));
    }
}

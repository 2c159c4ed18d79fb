//! Keys to seeds: mixes numbers so that close keys give unrelated seeds. Not a cryptographic hash and not a source
//! of random numbers. The mixer is the finaliser of SplitMix64 (Steele, Lea and Flood 2014, variant 13 of Stafford
//! 2011).

/// The fraction of the golden ratio in 64 bits: SplitMix64's step, which takes 0 away from its fixed point.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Mixes a key: a bijection in which each bit of the input turns each bit of the output with probability ½.
#[inline]
pub const fn mix64(key: u64) -> u64 {
    let mut z = key.wrapping_add(GOLDEN);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// One key from two, in which order matters: chain it for more.
#[inline]
pub const fn combine(first: u64, second: u64) -> u64 {
    mix64(mix64(first) ^ second)
}

/// A 32-bit seed from a key.
#[inline]
pub const fn seed32(key: u64) -> u32 {
    (mix64(key) >> 32) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The keys that occur: small counts, their neighbours, and large numbers.
    fn keys() -> impl Iterator<Item = u64> {
        (0..4096_u64).map(|i| if i % 2 == 0 { i / 2 } else { i.wrapping_mul(0x1234_5678_9abc_def1) })
    }

    /// How often each output bit turns when each input bit does, over [`keys`]: the largest distance from ½.
    fn worst_avalanche(hash: impl Fn(u64) -> u64, bits_in: u32, bits_out: u32) -> f64 {
        let mut turned = vec![0_u32; (bits_in * bits_out) as usize];
        for key in keys() {
            for i in 0..bits_in {
                let change = hash(key) ^ hash(key ^ 1 << i);
                for o in 0..bits_out {
                    turned[(i * bits_out + o) as usize] += (change >> o & 1) as u32;
                }
            }
        }
        turned.iter().map(|&t| (f64::from(t) / 4096.0 - 0.5).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn every_bit_turns_every_bit_half_of_the_time() {
        // 4096 fair coins: a standard deviation of 0.0078; the worst of 4096 such lies within 5 of them.
        assert!(worst_avalanche(mix64, 64, 64) < 0.045);
        assert!(worst_avalanche(|k| combine(k, 7), 64, 64) < 0.045);
        assert!(worst_avalanche(|k| combine(7, k), 64, 64) < 0.045);
        assert!(worst_avalanche(|k| u64::from(seed32(k)), 64, 32) < 0.045);
    }

    #[test]
    fn the_avalanche_test_sees_a_bad_hash() {
        assert!(worst_avalanche(|k| k.wrapping_mul(GOLDEN), 64, 64) > 0.4);
        assert!(worst_avalanche(|k| k ^ (k >> 31), 64, 64) > 0.4);
    }

    #[test]
    fn mixing_is_splitmix64() {
        // The first outputs for seed 1234567, as published with the reference code.
        assert_eq!(mix64(1_234_567), 6_457_827_717_110_365_317);
        assert_eq!(mix64(1_234_567_u64.wrapping_add(GOLDEN)), 3_203_168_211_198_807_973);
    }

    #[test]
    fn small_keys_do_not_collide_and_order_matters() {
        let mut seen: Vec<u64> = (0..300).flat_map(|a| (0..300).map(move |b| combine(a, b))).collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), 90_000);
    }
}

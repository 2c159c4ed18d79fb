//! What a mesh is known by: a hash of its shape, so that a game sees whether its mesh is still the one that was baked.

use super::mixing::Mixer;
use serde::{Deserialize, Serialize};

/// 64 bits over a mesh's positions and triangles. It is the same on every machine; of two different shapes it tells
/// all but one in 2⁶⁴ apart. What does not bear on a layout (normals, colours, how wide the indices are, whether the
/// triangles come as a list or as a strip) is not in it.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct MeshHash(u64);

impl MeshHash {
    /// The hash of the shape with these vertices [m], by their bits as f32, and these triangles, each as three
    /// indices of vertices.
    pub fn of(positions: impl IntoIterator<Item = [f32; 3]>, triangles: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let mut mixer = Mixer::default();
        let mut vertices = 0_u64;
        for position in positions {
            mixer.add_all(position.map(f32::to_bits));
            vertices += 1;
        }
        for triangle in triangles {
            mixer.add_all(triangle);
        }
        // Says where the vertices end and the triangles begin.
        Self(mixer.finish(vertices))
    }

    /// The hash with these bits.
    pub(super) fn from_bits(bits: u64) -> Self {
        Self(bits)
    }

    /// Its bits.
    pub fn bits(self) -> u64 {
        self.0
    }
}

impl std::fmt::Debug for MeshHash {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "MeshHash({:016x})", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const QUAD: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [2, 1, 3]];

    #[test]
    fn it_is_the_same_on_every_machine() {
        // Both were worked out by another program.
        assert_eq!(MeshHash::of(QUAD, TRIANGLES).bits(), 0xbafc_364c_a6df_5c57);
        assert_eq!(MeshHash::of([], []).bits(), 0xbb4c_a624_8b5f_fa44);
    }

    #[test]
    fn every_bit_of_the_shape_counts() {
        let mut seen = BTreeSet::from([MeshHash::of(QUAD, TRIANGLES)]);
        let mut count = 1;
        for (vertex, axis, bit) in (0..4).flat_map(|v| (0..3).flat_map(move |a| (0..32).map(move |b| (v, a, b)))) {
            let mut moved = QUAD;
            moved[vertex][axis] = f32::from_bits(moved[vertex][axis].to_bits() ^ 1 << bit);
            seen.insert(MeshHash::of(moved, TRIANGLES));
            count += 1;
        }
        for (triangle, corner, bit) in (0..2).flat_map(|t| (0..3).flat_map(move |c| (0..32).map(move |b| (t, c, b)))) {
            let mut other = TRIANGLES;
            other[triangle][corner] ^= 1 << bit;
            seen.insert(MeshHash::of(QUAD, other));
            count += 1;
        }
        assert_eq!(seen.len(), count);
    }

    #[test]
    fn vertices_and_triangles_are_not_taken_for_each_other() {
        let words = [[1_u32, 2, 3], [4, 5, 6], [7, 8, 9]];
        let hashes: BTreeSet<MeshHash> = (0..=3)
            .map(|vertices| {
                let positions = words[..vertices].iter().map(|words| words.map(f32::from_bits));
                MeshHash::of(positions, words[vertices..].iter().copied())
            })
            .collect();
        assert_eq!(hashes.len(), 4);
        assert_ne!(MeshHash::of(QUAD, [TRIANGLES[0], TRIANGLES[1]]), MeshHash::of(QUAD, [TRIANGLES[1], TRIANGLES[0]]));
    }
}

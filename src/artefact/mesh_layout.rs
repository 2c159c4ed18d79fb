//! `meshes.kiln`: the second texture coordinates that a bake gave to meshes without usable ones. Such a mesh must be
//! split where its charts end, so that the file says how to build the mesh with them from the game's own.
//!
//! All numbers are little-endian: `KILNMESH`, the version and the count of meshes as u32; of each mesh its hash as
//! u64, the counts of its vertices and indices as u32, the vertices as u32, the coordinates as pairs of f32, the
//! indices as u32; last, a check sum of all before as u64.

use super::MeshHash;
use super::mixing::Mixer;
use thiserror::Error;

/// The file's name inside a baked folder.
pub const MESHES_FILE: &str = "meshes.kiln";

/// The version that this library writes, and the newest that it reads.
pub const MESHES_VERSION: u32 = 1;

/// What the file starts with.
const MAGIC: [u8; 8] = *b"KILNMESH";
/// The least size of a file: what stands before the meshes and the check sum behind them [bytes].
const FRAME: usize = 8 + 4 + 4 + 8;

/// How a mesh with lightmap coordinates is built from the one that was baked.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshLayout {
    /// The mesh that was baked.
    pub hash: MeshHash,
    /// For each vertex of the new mesh, the vertex of the old one that it copies.
    pub vertices: Vec<u32>,
    /// For each vertex of the new mesh its lightmap coordinates, in the unit square; v grows downwards.
    pub uv1: Vec<[f32; 2]>,
    /// The triangles of the new mesh, three indices each.
    pub indices: Vec<u32>,
}

/// Why a mesh layout cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum MeshLayoutError {
    /// It is no such file.
    #[error("{MESHES_FILE} is not what its name says; bake the scene again")]
    NoLayouts,
    /// It is of a later version.
    #[error(
        "{MESHES_FILE} is of version {found}, this bevy_kiln reads up to {MESHES_VERSION}; update bevy_kiln or bake \
         again"
    )]
    TooNew {
        /// Its version.
        found: u32,
    },
    /// It is shorter or longer than it says, or its check sum is wrong.
    #[error("{MESHES_FILE} is cut off or damaged; copy it again or bake the scene again")]
    Damaged,
    /// A mesh has more or fewer coordinates than vertices.
    #[error("mesh {mesh} of {MESHES_FILE} has {uv1} coordinates for {vertices} vertices; bake the scene again")]
    Unequal {
        /// Its number.
        mesh: usize,
        /// Its vertices.
        vertices: usize,
        /// Its coordinates.
        uv1: usize,
    },
    /// The corners of a mesh make no triangles.
    #[error("mesh {mesh} of {MESHES_FILE} has {corners} corners, which make no triangles; bake the scene again")]
    NoTriangles {
        /// Its number.
        mesh: usize,
        /// Its corners.
        corners: usize,
    },
    /// A corner of a mesh is a vertex that is not there.
    #[error("mesh {mesh} of {MESHES_FILE} uses vertex {index} of {vertices}; bake the scene again")]
    NoSuchVertex {
        /// Its number.
        mesh: usize,
        /// The vertex asked for.
        index: u32,
        /// Its vertices.
        vertices: usize,
    },
    /// A coordinate of a mesh is no number.
    #[error("mesh {mesh} of {MESHES_FILE} has no finite coordinates at vertex {vertex}; bake the scene again")]
    NotFinite {
        /// Its number.
        mesh: usize,
        /// The vertex.
        vertex: usize,
    },
    /// A mesh or the number of meshes is beyond what the file can count.
    #[error("mesh {mesh} is too large for {MESHES_FILE}, which counts to 4294967295; split the mesh")]
    TooLarge {
        /// Its number.
        mesh: usize,
    },
}

impl MeshLayout {
    /// The meshes of a file, checked: every index is of a vertex, every coordinate is a number.
    pub fn read_all(bytes: &[u8]) -> Result<Vec<Self>, MeshLayoutError> {
        if bytes.get(..MAGIC.len()) != Some(&MAGIC[..]) {
            return Err(MeshLayoutError::NoLayouts);
        }
        let mut reader = Reader(&bytes[MAGIC.len()..]);
        let version = reader.u32()?;
        if version > MESHES_VERSION {
            return Err(MeshLayoutError::TooNew { found: version });
        }
        let check_sum_at = bytes.len().checked_sub(8).filter(|_| bytes.len() >= FRAME);
        let (body, check_sum) = bytes.split_at(check_sum_at.ok_or(MeshLayoutError::Damaged)?);
        if version == 0 || check_sum != check_sum_of(body).to_le_bytes() {
            return Err(MeshLayoutError::Damaged);
        }
        let mut reader = Reader(&body[MAGIC.len() + 4..]);
        let count = reader.u32()?;
        // Not `with_capacity`: the count may be any number, what is there is not.
        let mut layouts = Vec::new();
        for mesh in 0..count as usize {
            let layout = reader.layout()?;
            layout.check(mesh)?;
            layouts.push(layout);
        }
        if reader.0.is_empty() { Ok(layouts) } else { Err(MeshLayoutError::Damaged) }
    }

    /// The file of these meshes, checked as [`read_all`](Self::read_all) checks them.
    pub fn write_all(layouts: &[Self]) -> Result<Vec<u8>, MeshLayoutError> {
        let count = |length: usize, mesh| u32::try_from(length).map_err(|_| MeshLayoutError::TooLarge { mesh });
        let mut bytes = MAGIC.to_vec();
        bytes.extend(MESHES_VERSION.to_le_bytes());
        bytes.extend(count(layouts.len(), layouts.len())?.to_le_bytes());
        for (mesh, layout) in layouts.iter().enumerate() {
            layout.check(mesh)?;
            bytes.extend(layout.hash.bits().to_le_bytes());
            bytes.extend(count(layout.vertices.len(), mesh)?.to_le_bytes());
            bytes.extend(count(layout.indices.len(), mesh)?.to_le_bytes());
            bytes.extend(layout.vertices.iter().flat_map(|vertex| vertex.to_le_bytes()));
            bytes.extend(layout.uv1.as_flattened().iter().flat_map(|coordinate| coordinate.to_le_bytes()));
            bytes.extend(layout.indices.iter().flat_map(|index| index.to_le_bytes()));
        }
        let check_sum = check_sum_of(&bytes);
        bytes.extend(check_sum.to_le_bytes());
        Ok(bytes)
    }

    /// What two layouts have in common if they are the same: 64 bits over all that is in them.
    pub fn key(&self) -> u64 {
        let mut mixer = Mixer::default();
        mixer.add_all(self.vertices.iter().copied());
        mixer.add_all(self.uv1.as_flattened().iter().map(|coordinate| coordinate.to_bits()));
        mixer.add_all(self.indices.iter().copied());
        mixer.finish(self.hash.bits())
    }

    fn check(&self, mesh: usize) -> Result<(), MeshLayoutError> {
        let (vertices, uv1, corners) = (self.vertices.len(), self.uv1.len(), self.indices.len());
        if vertices != uv1 {
            return Err(MeshLayoutError::Unequal { mesh, vertices, uv1 });
        }
        if !corners.is_multiple_of(3) {
            return Err(MeshLayoutError::NoTriangles { mesh, corners });
        }
        if let Some(&index) = self.indices.iter().find(|&&index| index as usize >= vertices) {
            return Err(MeshLayoutError::NoSuchVertex { mesh, index, vertices });
        }
        match self.uv1.iter().position(|uv| !uv.iter().all(|coordinate| coordinate.is_finite())) {
            Some(vertex) => Err(MeshLayoutError::NotFinite { mesh, vertex }),
            None => Ok(()),
        }
    }
}

fn check_sum_of(bytes: &[u8]) -> u64 {
    let mut mixer = Mixer::default();
    mixer.add_bytes(bytes);
    mixer.finish(bytes.len() as u64)
}

/// What is not read yet.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], MeshLayoutError> {
        let (taken, rest) = self.0.split_first_chunk().ok_or(MeshLayoutError::Damaged)?;
        self.0 = rest;
        Ok(*taken)
    }

    fn u32(&mut self) -> Result<u32, MeshLayoutError> {
        self.take().map(u32::from_le_bytes)
    }

    /// `count` values of `N` bytes, which must be there before room is made for them.
    fn many<const N: usize, T>(&mut self, count: u32, value: fn([u8; N]) -> T) -> Result<Vec<T>, MeshLayoutError> {
        let length = usize::try_from(count).ok().and_then(|count| count.checked_mul(N));
        let taken = length.and_then(|length| self.0.split_at_checked(length));
        let (taken, rest) = taken.ok_or(MeshLayoutError::Damaged)?;
        self.0 = rest;
        Ok(taken.as_chunks().0.iter().map(|bytes| value(*bytes)).collect())
    }

    fn layout(&mut self) -> Result<MeshLayout, MeshLayoutError> {
        let hash = MeshHash::from_bits(u64::from_le_bytes(self.take()?));
        let (vertices, indices) = (self.u32()?, self.u32()?);
        Ok(MeshLayout {
            hash,
            vertices: self.many(vertices, u32::from_le_bytes)?,
            uv1: self.many(vertices, |[a, b, c, d, e, f, g, h]| {
                [f32::from_le_bytes([a, b, c, d]), f32::from_le_bytes([e, f, g, h])]
            })?,
            indices: self.many(indices, u32::from_le_bytes)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layouts() -> Vec<MeshLayout> {
        let split = MeshLayout {
            hash: MeshHash::from_bits(0x0123_4567_89ab_cdef),
            vertices: vec![0, 1, 2, 2, 1, 3],
            uv1: vec![[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [1.0, 0.25], [-0.0, 1.0], [0.125, 0.75]],
            indices: vec![0, 1, 2, 3, 4, 5],
        };
        let empty = MeshLayout { vertices: vec![], uv1: vec![], indices: vec![], ..split.clone() };
        let shared = MeshLayout { indices: vec![5, 4, 3, 0, 0, 0, 2, 3, 1], ..split.clone() };
        vec![split, empty, shared]
    }

    /// A file with the check sum that belongs to it.
    fn sealed(body: &[u8]) -> Vec<u8> {
        [body, &check_sum_of(body).to_le_bytes()].concat()
    }

    fn body() -> Vec<u8> {
        let mut bytes = MeshLayout::write_all(&layouts()).unwrap();
        bytes.truncate(bytes.len() - 8);
        bytes
    }

    #[test]
    fn round_trip() {
        for layouts in [layouts(), vec![], vec![layouts()[1].clone()]] {
            assert_eq!(MeshLayout::read_all(&MeshLayout::write_all(&layouts).unwrap()), Ok(layouts));
        }
        assert_eq!(body().len() + 8, FRAME + 3 * 16 + 2 * 6 * 12 + (6 + 9) * 4);
        assert_eq!(body()[..20], *b"KILNMESH\x01\0\0\0\x03\0\0\0\xef\xcd\xab\x89");
    }

    #[test]
    fn what_was_cut_off_or_damaged_is_refused() {
        let whole = MeshLayout::write_all(&layouts()).unwrap();
        for length in 0..whole.len() {
            let expected = if length < 8 { MeshLayoutError::NoLayouts } else { MeshLayoutError::Damaged };
            assert_eq!(MeshLayout::read_all(&whole[..length]), Err(expected), "{length} bytes");
        }
        for at in 0..whole.len() * 8 {
            let mut flipped = whole.clone();
            flipped[at / 8] ^= 1 << (at % 8);
            assert!(MeshLayout::read_all(&flipped).is_err(), "bit {at}");
        }
        assert_eq!(MeshLayout::read_all(&[&whole[..], &[0]].concat()), Err(MeshLayoutError::Damaged));
        assert_eq!(MeshLayout::read_all(b"GIF89a, or something else"), Err(MeshLayoutError::NoLayouts));
    }

    /// Damage that a check sum cannot show, since whoever made it made a new one.
    #[test]
    fn no_word_of_a_sealed_file_can_break_the_reader() {
        for at in (8..body().len()).step_by(4) {
            for word in [0, 1, 2, 6, 7, 0x7fff_ffff, 0x7f80_0000, 0xffff_ffff_u32] {
                let mut bytes = body();
                bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
                if let Ok(layouts) = MeshLayout::read_all(&sealed(&bytes)) {
                    assert!(layouts.iter().enumerate().all(|(mesh, layout)| layout.check(mesh).is_ok()));
                }
            }
        }
        let longer = [&body()[..], &[0; 4]].concat();
        assert_eq!(MeshLayout::read_all(&sealed(&longer)), Err(MeshLayoutError::Damaged));
    }

    #[test]
    fn a_later_version_is_refused_whatever_follows() {
        let mut bytes = body();
        bytes[8] = 2;
        for bytes in [sealed(&bytes), bytes[..12].to_vec()] {
            let error = MeshLayout::read_all(&bytes).unwrap_err();
            assert_eq!(error, MeshLayoutError::TooNew { found: 2 });
            assert!(error.to_string().contains("version 2, this bevy_kiln reads up to 1"), "{error}");
        }
        bytes[8] = 0;
        assert_eq!(MeshLayout::read_all(&sealed(&bytes)), Err(MeshLayoutError::Damaged));
    }

    #[test]
    fn contradictions_are_refused_by_writer_and_reader() {
        let change = |change: fn(&mut MeshLayout)| {
            let mut layouts = layouts();
            change(&mut layouts[2]);
            MeshLayout::write_all(&layouts).unwrap_err()
        };
        let unequal = MeshLayoutError::Unequal { mesh: 2, vertices: 6, uv1: 5 };
        assert_eq!(change(|layout| layout.uv1.truncate(5)), unequal);
        let corners = MeshLayoutError::NoTriangles { mesh: 2, corners: 8 };
        assert_eq!(change(|layout| layout.indices.truncate(8)), corners);
        let vertex = MeshLayoutError::NoSuchVertex { mesh: 2, index: 6, vertices: 6 };
        assert_eq!(change(|layout| layout.indices[8] = 6), vertex);
        let number = MeshLayoutError::NotFinite { mesh: 2, vertex: 4 };
        assert_eq!(change(|layout| layout.uv1[4][1] = f32::NAN), number);
        // The last index of the file, then the last coordinate of the last mesh.
        let mut bytes = body();
        let end = bytes.len();
        bytes[end - 4] = 6;
        assert_eq!(MeshLayout::read_all(&sealed(&bytes)), Err(vertex));
        let mut bytes = body();
        bytes[end - 9 * 4 - 4..end - 9 * 4].copy_from_slice(&f32::INFINITY.to_le_bytes());
        let number = MeshLayoutError::NotFinite { mesh: 2, vertex: 5 };
        assert_eq!(MeshLayout::read_all(&sealed(&bytes)), Err(number));
    }

    #[test]
    fn a_key_tells_layouts_apart() {
        let [split, empty, shared] = layouts().try_into().unwrap();
        assert_eq!(split.key(), split.clone().key());
        let mut other_mesh = split.clone();
        other_mesh.hash = MeshHash::from_bits(1);
        let mut moved = split.clone();
        moved.uv1[5][1] = 0.75_f32.next_up();
        let mut copied = split.clone();
        copied.vertices[5] = 2;
        let keys: std::collections::BTreeSet<u64> =
            [split, empty, shared, other_mesh, moved, copied].iter().map(MeshLayout::key).collect();
        assert_eq!(keys.len(), 6);
    }
}

//! Triangle meshes and their placed instances.

use crate::artefact::{MeshHash, StableId};
use glam::{Affine3A, Vec2, Vec3, Vec4};

/// How corners make triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Topology {
    /// Three corners each.
    #[default]
    TriangleList,
    /// Each corner makes a triangle with the two before it; every second one is turned round.
    TriangleStrip,
}

/// Which vertex each corner is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Indices {
    /// Corner i is vertex i.
    #[default]
    None,
    /// 16-bit indices.
    U16(Vec<u16>),
    /// 32-bit indices.
    U32(Vec<u32>),
}

/// A shape in its own frame. Fronts are counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The name by which a person knows it.
    pub name: String,
    /// How corners make triangles.
    pub topology: Topology,
    /// Which vertex each corner is.
    pub indices: Indices,
    /// One per vertex [m].
    pub positions: Vec<Vec3>,
    /// Shading normals, one per vertex; without them each triangle is flat.
    pub normals: Option<Vec<Vec3>>,
    /// Texture coordinates (TEXCOORD_0), one per vertex; v grows downwards as in glTF.
    pub uv0: Option<Vec<Vec2>>,
    /// Lightmap coordinates (TEXCOORD_1), one per vertex, in the unit square; v grows downwards as in glTF.
    pub uv1: Option<Vec<Vec2>>,
    /// Linear colours that multiply the material's base colour, one per vertex.
    pub colours: Option<Vec<Vec4>>,
    /// Tangents for normal maps, one per vertex: a direction in the mesh's frame and, in w, the sign of the bitangent
    /// w · (normal × tangent). Where they are missing, the tracer makes them (MikkTSpace).
    pub tangents: Option<Vec<Vec4>>,
}

impl Mesh {
    /// How many corners the indices (or, without any, the vertices) make.
    pub fn corner_count(&self) -> usize {
        match &self.indices {
            Indices::None => self.positions.len(),
            Indices::U16(indices) => indices.len(),
            Indices::U32(indices) => indices.len(),
        }
    }

    /// The vertex at a corner.
    pub fn vertex(&self, corner: usize) -> u32 {
        match &self.indices {
            Indices::None => u32::try_from(corner).unwrap_or(u32::MAX),
            Indices::U16(indices) => u32::from(indices[corner]),
            Indices::U32(indices) => indices[corner],
        }
    }

    /// The triangles as vertex triples, each counter-clockwise seen from its front.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let count = match self.topology {
            Topology::TriangleList => self.corner_count() / 3,
            Topology::TriangleStrip => self.corner_count().saturating_sub(2),
        };
        (0..count).map(|triangle| match self.topology {
            Topology::TriangleList => [0, 1, 2].map(|corner| self.vertex(3 * triangle + corner)),
            Topology::TriangleStrip if triangle % 2 == 0 => [0, 1, 2].map(|corner| self.vertex(triangle + corner)),
            Topology::TriangleStrip => [1, 0, 2].map(|corner| self.vertex(triangle + corner)),
        })
    }

    /// What its shape is known by when a baked layout meets it again.
    pub fn hash(&self) -> MeshHash {
        MeshHash::of(self.positions.iter().map(Vec3::to_array), self.triangles())
    }
}

/// A lightmap that an instance asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightmapRequest {
    /// Texels per metre of the surface in the world; `None` for the bake's own.
    pub density: Option<f32>,
}

/// A mesh placed in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Stable from bake to bake and unique in the scene: what its texels' random numbers are keyed by.
    pub id: StableId,
    /// The name by which a person knows it.
    pub name: String,
    /// Index into [`Scene::meshes`](super::Scene::meshes).
    pub mesh: usize,
    /// Index into [`Scene::materials`](super::Scene::materials).
    pub material: usize,
    /// Mesh frame to world: any invertible transform, mirrored and sheared ones included.
    pub world_from_local: Affine3A,
    /// The lightmap it asks for; `None` for a thing that only blocks and reflects.
    pub lightmap: Option<LightmapRequest>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad(topology: Topology, indices: Indices) -> Mesh {
        Mesh {
            name: "quad".into(),
            topology,
            indices,
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y],
            ..Mesh::default()
        }
    }

    #[test]
    fn list_and_strip_face_the_same_way() {
        let list = quad(Topology::TriangleList, Indices::U16(vec![0, 1, 2, 2, 1, 3]));
        let strip = quad(Topology::TriangleStrip, Indices::None);
        for mesh in [list, strip] {
            let triangles: Vec<_> = mesh.triangles().collect();
            assert_eq!(triangles.len(), 2);
            for [a, b, c] in triangles {
                let [a, b, c] = [a, b, c].map(|vertex| mesh.positions[vertex as usize]);
                assert!((b - a).cross(c - a).z > 0.0);
            }
        }
    }

    #[test]
    fn the_hash_is_of_the_shape_alone() {
        let list = quad(Topology::TriangleList, Indices::U16(vec![0, 1, 2, 2, 1, 3]));
        let wide = Mesh {
            indices: Indices::U32(vec![0, 1, 2, 2, 1, 3]),
            uv1: Some(vec![Vec2::ZERO; 4]),
            name: "other".into(),
            ..list.clone()
        };
        assert_eq!(list.hash(), wide.hash());
        assert_eq!(list.hash(), quad(Topology::TriangleStrip, Indices::None).hash());
        let turned = quad(Topology::TriangleList, Indices::U16(vec![0, 1, 2, 2, 3, 1]));
        assert_ne!(list.hash(), turned.hash());
        let moved = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE], ..list.clone() };
        assert_ne!(list.hash(), moved.hash());
    }
}

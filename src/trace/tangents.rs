//! Tangents for meshes that have a normal map and none of their own: Mikkelsen's tangent space (MikkTSpace), as Bevy
//! and the programs that bake normal maps make it, by the crate `bevy_mikktspace`, which is free of the engine.

use crate::math::Portable;
use crate::scene::Mesh;
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};

/// Tangents of a mesh by these texture coordinates, one per vertex, in the convention of
/// [`Mesh::tangents`](crate::scene::Mesh::tangents). Where coordinates or normals are missing there is no tangent:
/// zeros.
pub(super) fn tangents(mesh: &Mesh, uv: Option<&[Vec2]>) -> Vec<Vec4> {
    let zeros = vec![Vec4::ZERO; mesh.positions.len()];
    let (Some(normals), Some(uv)) = (&mesh.normals, uv) else {
        return zeros;
    };
    let mut corners = Corners { mesh, normals, uv, triangles: mesh.triangles().collect(), tangents: zeros.clone() };
    match generate_tangents(&mut corners) {
        Ok(()) => corners.tangents,
        Err(_) => zeros,
    }
}

struct Corners<'a> {
    mesh: &'a Mesh,
    normals: &'a [Vec3],
    uv: &'a [Vec2],
    triangles: Vec<[u32; 3]>,
    tangents: Vec<Vec4>,
}

impl Corners<'_> {
    fn vertex(&self, triangle: usize, corner: usize) -> usize {
        self.triangles[triangle][corner] as usize
    }
}

/// The algorithm's own arithmetic, in the same bits on every machine.
struct PortableOps;

impl Ops for PortableOps {
    fn sqrt(x: f32) -> f32 {
        x.sqrt()
    }

    fn acos(x: f32) -> f32 {
        // Rounded once from twice the digits, as the original does.
        Portable::acos(f64::from(x)) as f32
    }
}

impl Geometry<PortableOps> for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.triangles.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, triangle: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(triangle, corner)].to_array()
    }

    fn normal(&self, triangle: usize, corner: usize) -> [f32; 3] {
        self.normals[self.vertex(triangle, corner)].to_array()
    }

    fn tex_coord(&self, triangle: usize, corner: usize) -> [f32; 2] {
        self.uv[self.vertex(triangle, corner)].to_array()
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, triangle: usize, corner: usize) {
        let vertex = self.vertex(triangle, corner);
        let [x, y, z, sign] = space.unwrap_or_default().tangent_encoded();
        // The algorithm counts v upwards, glTF downwards.
        self.tangents[vertex] = Vec4::new(x, y, z, -sign);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Indices, Topology};

    /// On a square whose u runs along x and whose v runs along −y (upwards, as pictures do), the tangent is +x and the
    /// bitangent w · (n × t) is +y, so that green in a glTF normal map is up in the picture.
    #[test]
    fn a_square() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
        let uv: Vec<Vec2> = positions.iter().map(|p| Vec2::new(p.x, 1.0 - p.y)).collect();
        let mesh = Mesh {
            topology: Topology::TriangleList,
            indices: Indices::U16(vec![0, 1, 2, 0, 2, 3]),
            positions,
            normals: Some(vec![Vec3::Z; 4]),
            ..Mesh::default()
        };
        for tangent in tangents(&mesh, Some(&uv)) {
            assert!((tangent.truncate() - Vec3::X).length() < 1e-6, "{tangent}");
            let bitangent = tangent.w * Vec3::Z.cross(tangent.truncate());
            assert!((bitangent - Vec3::Y).length() < 1e-6, "{tangent}");
        }
        assert_eq!(tangents(&mesh, None), [Vec4::ZERO; 4]);
    }
}

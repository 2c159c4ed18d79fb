//! A Bevy mesh and the layout that a bake made for it: whether they belong together, and the mesh that comes of both.

use super::attribute::numbers;
use crate::artefact::{MeshHash, MeshLayout};
use bevy::mesh::{Indices, MeshAccessError, PrimitiveTopology, VertexAttributeValues as Values};
use bevy::prelude::*;

/// Why a mesh cannot be laid out as at the bake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CannotLayOut {
    /// Its vertices are with the renderer only.
    RenderWorldOnly,
    /// It is not the mesh that was baked.
    Changed,
}

impl From<MeshAccessError> for CannotLayOut {
    fn from(error: MeshAccessError) -> Self {
        match error {
            MeshAccessError::ExtractedToRenderWorld => Self::RenderWorldOnly,
            MeshAccessError::NotFound => Self::Changed,
        }
    }
}

/// The mesh with a layout: every vertex attribute copied to where the layout has its vertices, and UV1 beside them.
/// Morph targets are left out, as what has them shows no lightmap. A mesh without UV0 gets one of zeros: Bevy's shader
/// (0.19) does not compile for a mesh that has UV1 alone.
pub(crate) fn laid_out(source: &Mesh, layout: &MeshLayout) -> Result<Mesh, CannotLayOut> {
    if hash(source)? != layout.hash {
        return Err(CannotLayOut::Changed);
    }
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, source.asset_usage);
    mesh.enable_raytracing = source.enable_raytracing;
    for (attribute, values) in source.try_attributes()? {
        if attribute.id != Mesh::ATTRIBUTE_UV_1.id {
            mesh.insert_attribute(*attribute, copied(values, &layout.vertices).ok_or(CannotLayOut::Changed)?);
        }
    }
    if !mesh.contains_attribute(Mesh::ATTRIBUTE_UV_0) {
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0_f32; 2]; layout.vertices.len()]);
    }
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_1, layout.uv1.clone());
    mesh.insert_indices(indices(layout));
    Ok(mesh)
}

/// What the baker knows the mesh by. It reads positions and triangles as this does.
fn hash(mesh: &Mesh) -> Result<MeshHash, CannotLayOut> {
    let positions = numbers(mesh.try_attribute(Mesh::ATTRIBUTE_POSITION)?).ok_or(CannotLayOut::Changed)?;
    let corners: Vec<u32> = match mesh.try_indices_option()? {
        None => (0..u32::try_from(positions.len()).unwrap_or(u32::MAX)).collect(),
        Some(Indices::U16(indices)) => indices.iter().copied().map(u32::from).collect(),
        Some(Indices::U32(indices)) => indices.clone(),
    };
    let positions = positions.iter().map(|position| position.truncate().to_array());
    match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => Ok(MeshHash::of(positions, corners.as_chunks().0.iter().copied())),
        PrimitiveTopology::TriangleStrip => {
            let turned = corners.array_windows().enumerate().map(|(triangle, &[a, b, c])| {
                // Every second triangle of a strip is turned round.
                if triangle % 2 == 0 { [a, b, c] } else { [b, a, c] }
            });
            Ok(MeshHash::of(positions, turned))
        }
        _ => Err(CannotLayOut::Changed),
    }
}

fn indices(layout: &MeshLayout) -> Indices {
    let narrow: Result<Vec<u16>, _> = layout.indices.iter().map(|&index| u16::try_from(index)).collect();
    narrow.map_or_else(|_| Indices::U32(layout.indices.clone()), Indices::U16)
}

/// The values of these vertices, in the same format; `None` if one is not there.
fn copied(values: &Values, vertices: &[u32]) -> Option<Values> {
    fn pick<T: Copy>(values: &[T], vertices: &[u32]) -> Option<Vec<T>> {
        vertices.iter().map(|&vertex| values.get(vertex as usize).copied()).collect()
    }
    macro_rules! of_every_format {
        ($($format:ident)*) => {
            match values {
                $(Values::$format(values) => Values::$format(pick(values, vertices)?),)*
            }
        };
    }
    Some(of_every_format!(
        Uint8 Uint8x2 Uint8x4 Sint8 Sint8x2 Sint8x4 Unorm8 Unorm8x2 Unorm8x4 Snorm8 Snorm8x2 Snorm8x4
        Uint16 Uint16x2 Uint16x4 Sint16 Sint16x2 Sint16x4 Unorm16 Unorm16x2 Unorm16x4 Snorm16 Snorm16x2 Snorm16x4
        Float16 Float16x2 Float16x4 Float32 Float32x2 Float32x3 Float32x4 Float64 Float64x2 Float64x3 Float64x4
        Uint32 Uint32x2 Uint32x3 Uint32x4 Sint32 Sint32x2 Sint32x3 Sint32x4 Unorm10_10_10_2 Unorm8x4Bgra
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::asset::RenderAssetUsages;
    use bevy::mesh::MeshVertexAttribute;
    use bevy::mesh::VertexFormat;

    const POSITIONS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

    fn quad(topology: PrimitiveTopology, indices: Option<Indices>) -> Mesh {
        let mesh = Mesh::new(topology, RenderAssetUsages::MAIN_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, POSITIONS.to_vec());
        match indices {
            Some(indices) => mesh.with_inserted_indices(indices),
            None => mesh,
        }
    }

    fn list() -> Mesh {
        quad(PrimitiveTopology::TriangleList, Some(Indices::U16(vec![0, 1, 2, 2, 1, 3])))
    }

    fn cut() -> MeshLayout {
        MeshLayout {
            hash: MeshHash::of(POSITIONS, [[0, 1, 2], [2, 1, 3]]),
            vertices: vec![0, 1, 2, 2, 1, 3],
            uv1: vec![[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 1.0], [1.0, 0.5], [1.0, 1.0]],
            indices: vec![0, 1, 2, 3, 4, 5],
        }
    }

    #[test]
    fn a_layout_is_known_again_whatever_the_indices_and_the_order() {
        let wide = quad(PrimitiveTopology::TriangleList, Some(Indices::U32(vec![0, 1, 2, 2, 1, 3])));
        let strip = quad(PrimitiveTopology::TriangleStrip, None);
        for mesh in [list(), wide, strip] {
            assert_eq!(hash(&mesh), Ok(cut().hash));
            let new = laid_out(&mesh, &cut()).unwrap();
            assert_eq!(new.primitive_topology(), PrimitiveTopology::TriangleList);
            assert_eq!(new.asset_usage, RenderAssetUsages::MAIN_WORLD);
            assert_eq!(new.indices(), Some(&Indices::U16(vec![0, 1, 2, 3, 4, 5])));
            assert_eq!(new.attribute(Mesh::ATTRIBUTE_UV_0), Some(&Values::Float32x2(vec![[0.0; 2]; 6])));
        }
    }

    #[test]
    fn another_mesh_is_refused() {
        let mut moved = list();
        moved.insert_attribute(Mesh::ATTRIBUTE_POSITION, POSITIONS.map(|[x, y, z]| [x, y, z + 1.0]).to_vec());
        let lines = quad(PrimitiveTopology::LineList, None);
        let bare = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default());
        let mut ragged = list();
        ragged.insert_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0; 2]; 3]);
        for mesh in [moved, lines, bare, ragged] {
            assert_eq!(laid_out(&mesh, &cut()), Err(CannotLayOut::Changed));
        }
        let mut gone = list();
        gone.take_gpu_data().unwrap();
        assert_eq!(laid_out(&gone, &cut()), Err(CannotLayOut::RenderWorldOnly));
    }

    #[test]
    fn every_attribute_is_copied_in_its_format() {
        let bone = MeshVertexAttribute::new("Bone", 4711, VertexFormat::Uint8x4);
        let weight = MeshVertexAttribute::new("Weight", 4712, VertexFormat::Float32);
        let mut mesh = list()
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 4])
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.0, 0.5], [1.0, 1.5], [2.0, 2.5], [3.0, 3.5]])
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, vec![[9.0, 9.0]; 4])
            .with_inserted_attribute(bone, Values::Uint8x4((0..4).map(|vertex| [vertex, 1, 2, 3]).collect()))
            .with_inserted_attribute(weight, vec![0.0_f32, 0.25, 0.5, 0.75]);
        mesh.enable_raytracing = false;
        let new = laid_out(&mesh, &cut()).unwrap();
        assert_eq!(new.attributes().count(), 6);
        assert!(!new.enable_raytracing);
        let uv0 = [[0.0, 0.5], [1.0, 1.5], [2.0, 2.5], [2.0, 2.5], [1.0, 1.5], [3.0, 3.5]];
        assert_eq!(new.attribute(Mesh::ATTRIBUTE_UV_0), Some(&Values::Float32x2(uv0.to_vec())));
        let bones = [0, 1, 2, 2, 1, 3].map(|vertex| [vertex, 1, 2, 3]);
        assert_eq!(new.attribute(bone), Some(&Values::Uint8x4(bones.to_vec())));
        let weights = [0.0, 0.25, 0.5, 0.5, 0.25, 0.75];
        assert_eq!(new.attribute(weight), Some(&Values::Float32(weights.to_vec())));
        assert_eq!(new.attribute(Mesh::ATTRIBUTE_UV_1), Some(&Values::Float32x2(cut().uv1)));
        let corners = cut().vertices.iter().map(|&vertex| POSITIONS[vertex as usize]).collect();
        assert_eq!(new.attribute(Mesh::ATTRIBUTE_POSITION), Some(&Values::Float32x3(corners)));
    }

    #[test]
    fn indices_are_as_wide_as_they_must_be() {
        let wide = MeshLayout { indices: vec![0, 65535, 65536], ..cut() };
        assert_eq!(indices(&wide), Indices::U32(vec![0, 65535, 65536]));
        let narrow = MeshLayout { indices: vec![0, 65535, 1], ..cut() };
        assert_eq!(indices(&narrow), Indices::U16(vec![0, 65535, 1]));
    }
}

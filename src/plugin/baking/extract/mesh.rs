//! `Mesh3d` into meshes and instances.

use super::{Extraction, ExtractionWarning, Thing, material};
use crate::plugin::baking::SceneSettings;
use crate::scene::{self, Instance, LightmapRequest, Topology};
use bevy::mesh::morph::MeshMorphWeights;
use bevy::mesh::skinning::SkinnedMesh;
use bevy::mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;

/// Adds one entity's mesh, if it is not there yet, and its instance.
pub(super) fn extract(
    world: &World,
    thing: &Thing,
    mut request: Option<LightmapRequest>,
    settings: &SceneSettings,
    out: &mut Extraction,
) {
    let Some(mesh) = world.get::<Mesh3d>(thing.entity) else { return };
    let Some(mesh) = place_mesh(world, thing, &mesh.0, out) else { return };
    if let Some(how) = deformation(world, thing.entity) {
        out.warnings.push(ExtractionWarning::Deformed { name: thing.name.clone(), how });
        request = None;
    }
    let placed = material::place(world, thing, settings, out);
    let transform = world.get::<GlobalTransform>(thing.entity).copied().unwrap_or_default();
    out.scene.instances.push(Instance {
        id: thing.id.clone(),
        name: thing.name.clone(),
        mesh,
        material: placed.index,
        world_from_local: transform.affine(),
        lightmap: request.filter(|_| placed.shows_lightmaps),
    });
}

fn deformation(world: &World, entity: Entity) -> Option<&'static str> {
    if world.get::<SkinnedMesh>(entity).is_some() {
        Some("skinned")
    } else if world.get::<MeshMorphWeights>(entity).is_some() {
        Some("morphed")
    } else {
        None
    }
}

/// The index of an asset's mesh in the scene; reads it at its first use.
fn place_mesh(world: &World, thing: &Thing, handle: &Handle<Mesh>, out: &mut Extraction) -> Option<usize> {
    if let Some(&known) = out.seen.meshes.get(&handle.id()) {
        return known;
    }
    let index = match read(world, thing, handle, &mut out.warnings) {
        Ok(mesh) => {
            out.scene.meshes.push(mesh);
            Some(out.scene.meshes.len() - 1)
        }
        Err(warning) => {
            out.warnings.push(warning);
            None
        }
    };
    out.seen.meshes.insert(handle.id(), index);
    index
}

fn read(
    world: &World,
    thing: &Thing,
    handle: &Handle<Mesh>,
    warnings: &mut Vec<ExtractionWarning>,
) -> Result<scene::Mesh, ExtractionWarning> {
    let name = thing.name.clone();
    let Some(mesh) = world.get_resource::<Assets<Mesh>>().and_then(|meshes| meshes.get(handle)) else {
        return Err(ExtractionWarning::MeshNotLoaded { name });
    };
    let topology = match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => Topology::TriangleList,
        PrimitiveTopology::TriangleStrip => Topology::TriangleStrip,
        other => return Err(ExtractionWarning::NoTriangles { name, topology: format!("{other:?}") }),
    };
    let gone = |_| ExtractionWarning::RenderWorldOnly { name: name.clone() };
    let indices = match mesh.try_indices_option().map_err(gone)? {
        None => scene::Indices::None,
        Some(Indices::U16(indices)) => scene::Indices::U16(indices.clone()),
        Some(Indices::U32(indices)) => scene::Indices::U32(indices.clone()),
    };
    let attribute = |attribute: MeshVertexAttribute| mesh.try_attribute_option(attribute).map_err(gone);
    let positions = match attribute(Mesh::ATTRIBUTE_POSITION)? {
        None => return Err(ExtractionWarning::NoPositions { name }),
        Some(VertexAttributeValues::Float32x3(positions)) => positions.iter().map(|&p| Vec3::from(p)).collect(),
        Some(other) => return Err(format_warning(&name, "positions", other)),
    };
    let normals = match attribute(Mesh::ATTRIBUTE_NORMAL)? {
        None => None,
        Some(VertexAttributeValues::Float32x3(normals)) => Some(normals.iter().map(|&n| Vec3::from(n)).collect()),
        Some(other) => {
            warnings.push(format_warning(&name, "normals", other));
            None
        }
    };
    let uv1 = match attribute(Mesh::ATTRIBUTE_UV_1)? {
        None => None,
        Some(VertexAttributeValues::Float32x2(uv1)) => Some(uv1.iter().map(|&uv| Vec2::from(uv)).collect()),
        Some(other) => {
            warnings.push(format_warning(&name, "UV1", other));
            None
        }
    };
    if attribute(Mesh::ATTRIBUTE_COLOR)?.is_some() {
        warnings.push(ExtractionWarning::VertexColours { name: name.clone() });
    }
    Ok(scene::Mesh { name, topology, indices, positions, normals, uv1, ..scene::Mesh::default() })
}

fn format_warning(name: &str, attribute: &'static str, found: &VertexAttributeValues) -> ExtractionWarning {
    let (expected, consequence) = match attribute {
        "positions" => ("Float32x3", "it is left out"),
        "normals" => ("Float32x3", "it is taken as flat-shaded"),
        _ => ("Float32x2", "it gets no lightmap"),
    };
    let name = name.to_owned();
    ExtractionWarning::AttributeFormat { name, attribute, found: found.enum_variant_name(), expected, consequence }
}

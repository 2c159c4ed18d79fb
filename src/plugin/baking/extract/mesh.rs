//! `Mesh3d` into meshes and instances.

use super::{Extraction, ExtractionWarning, NotReread, Thing, material, pose, reread, shadow_flags};
use crate::plugin::baking::SceneSettings;
use crate::plugin::display::{numbers, own_mesh};
use crate::scene::{self, Instance, LightmapRequest, Topology};
use bevy::math::Affine3A;
use bevy::mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;

/// Adds one entity's mesh, if it is not there yet, and its instance.
pub(super) fn extract(
    world: &World,
    thing: &Thing,
    request: Option<LightmapRequest>,
    settings: &SceneSettings,
    out: &mut Extraction,
) {
    // Not what an earlier bake made of it, so that a second bake is the same as the first.
    let Some(mesh) = world.get_entity(thing.entity).ok().and_then(own_mesh) else { return };
    let placed = if pose::deformation(world, thing.entity).is_some() {
        place_posed(world, thing, mesh, out)
    } else {
        let affine = world.get::<GlobalTransform>(thing.entity).copied().unwrap_or_default().affine();
        place_mesh(world, thing, mesh, out).map(|mesh| (mesh, affine))
    };
    let Some((mesh, world_from_local)) = placed else { return };
    let placed = material::place(world, thing, settings, out);
    let material = shadow_flags::heed(world, thing, placed.index, out);
    out.scene.instances.push(Instance {
        id: thing.id.clone(),
        name: thing.name.clone(),
        mesh,
        material,
        world_from_local,
        lightmap: request.filter(|_| placed.shows_lightmaps),
    });
}

/// A mesh of its own for a thing that is posed, and its place in the world.
fn place_posed(world: &World, thing: &Thing, handle: &Handle<Mesh>, out: &mut Extraction) -> Option<(usize, Affine3A)> {
    let posed = find(world, thing, handle, out).and_then(|source| {
        let mut mesh = read(thing, source, &mut out.warnings)?;
        let place = pose::strike(world, thing.entity, source, &mut mesh);
        let not_read = |why| ExtractionWarning::PoseNotRead { name: thing.name.clone(), why };
        place.map(|place| (mesh, place)).map_err(not_read)
    });
    match posed {
        Ok((mesh, place)) => {
            out.scene.meshes.push(mesh);
            Some((out.scene.meshes.len() - 1, place))
        }
        Err(warning) => {
            out.warnings.push(warning);
            None
        }
    }
}

/// The index of an asset's mesh in the scene; reads it at its first use.
fn place_mesh(world: &World, thing: &Thing, handle: &Handle<Mesh>, out: &mut Extraction) -> Option<usize> {
    if let Some(&known) = out.seen.meshes.get(&handle.id()) {
        return known;
    }
    let found = find(world, thing, handle, out);
    let index = match found.and_then(|mesh| read(thing, mesh, &mut out.warnings)) {
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

/// The asset, with its vertices.
fn find<'w>(
    world: &'w World,
    thing: &Thing,
    handle: &Handle<Mesh>,
    out: &mut Extraction,
) -> Result<&'w Mesh, ExtractionWarning> {
    let name = thing.name.clone();
    match reread::mesh(world, handle, &mut out.missed) {
        None => Err(ExtractionWarning::MeshNotLoaded { name }),
        Some(Err(why)) => Err(ExtractionWarning::RenderWorldOnly { name, why }),
        Some(Ok(mesh)) => Ok(mesh),
    }
}

fn read(thing: &Thing, mesh: &Mesh, warnings: &mut Vec<ExtractionWarning>) -> Result<scene::Mesh, ExtractionWarning> {
    let name = thing.name.clone();
    let topology = match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => Topology::TriangleList,
        PrimitiveTopology::TriangleStrip => Topology::TriangleStrip,
        other => return Err(ExtractionWarning::NoTriangles { name, topology: format!("{other:?}") }),
    };
    let gone = |_| ExtractionWarning::RenderWorldOnly { name: name.clone(), why: NotReread::NotAsked };
    let indices = match mesh.try_indices_option().map_err(gone)? {
        None => scene::Indices::None,
        Some(Indices::U16(indices)) => scene::Indices::U16(indices.clone()),
        Some(Indices::U32(indices)) => scene::Indices::U32(indices.clone()),
    };
    let attribute = |attribute: MeshVertexAttribute| mesh.try_attribute_option(attribute).map_err(gone);
    let Some(positions) = attribute(Mesh::ATTRIBUTE_POSITION)? else {
        return Err(ExtractionWarning::NoPositions { name });
    };
    let Some(positions) = three(positions) else { return Err(format_warning(&name, "positions", positions)) };
    let mut optional = |which: MeshVertexAttribute, what: &'static str| -> Result<Option<_>, ExtractionWarning> {
        let Some(values) = attribute(which)? else { return Ok(None) };
        let numbers = numbers(values);
        match &numbers {
            None => warnings.push(format_warning(&name, what, values)),
            // A faulty UV1 costs the mesh its lightmap, and the scene's own check says so.
            Some(numbers) if what != "UV1" => warnings.extend(not_finite(&name, what, numbers)),
            Some(_) => {}
        }
        Ok(numbers)
    };
    let normals = optional(Mesh::ATTRIBUTE_NORMAL, "normals")?;
    let uv0 = optional(Mesh::ATTRIBUTE_UV_0, "UV0")?;
    let uv1 = optional(Mesh::ATTRIBUTE_UV_1, "UV1")?;
    let colours = optional(Mesh::ATTRIBUTE_COLOR, "colours")?;
    let tangents = optional(Mesh::ATTRIBUTE_TANGENT, "tangents")?;
    Ok(scene::Mesh {
        name,
        topology,
        indices,
        positions,
        normals: normals.map(|normals| normals.iter().map(|normal| normal.truncate()).collect()),
        uv0: uv0.map(|uv| uv.iter().map(|uv| uv.xy()).collect()),
        uv1: uv1.map(|uv| uv.iter().map(|uv| uv.xy()).collect()),
        colours,
        tangents,
    })
}

fn not_finite(name: &str, attribute: &'static str, numbers: &[Vec4]) -> Option<ExtractionWarning> {
    let vertex = numbers.iter().position(|number| !number.is_finite())?;
    Some(ExtractionWarning::NonFiniteAttribute { name: name.to_owned(), attribute, vertex })
}

fn three(values: &VertexAttributeValues) -> Option<Vec<Vec3>> {
    Some(numbers(values)?.iter().map(|position| position.truncate()).collect())
}

fn format_warning(name: &str, attribute: &'static str, found: &VertexAttributeValues) -> ExtractionWarning {
    let consequence = match attribute {
        "positions" => "it is left out",
        "normals" => "it is taken as flat-shaded",
        "UV0" => "its textures are not laid out on it",
        "UV1" => "it gets no lightmap",
        "colours" => "its material's colour alone counts",
        _ => "they are made anew",
    };
    let name = name.to_owned();
    ExtractionWarning::AttributeFormat { name, attribute, found: found.enum_variant_name(), consequence }
}

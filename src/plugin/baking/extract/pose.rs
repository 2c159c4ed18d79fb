//! Skinned and morphed meshes in the pose in which they stand: a blocker's shape, frozen. Morph targets first, then the
//! joints, as Bevy's vertex shader has it (bevy_pbr 0.19, morph.wgsl and skinning.wgsl): linear blend skinning
//! (Magnenat-Thalmann, Laperrière and Thalmann 1988). Who may take part is not decided here.

use crate::scene;
use bevy::math::{Affine3A, Mat3};
use bevy::mesh::VertexAttributeValues;
use bevy::mesh::morph::{MeshMorphWeights, MorphAttributes, MorphWeights};
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::prelude::*;

/// How an entity's mesh changes its shape, if it does.
pub(super) fn deformation(world: &World, entity: Entity) -> Option<&'static str> {
    if world.get::<SkinnedMesh>(entity).is_some() {
        Some("skinned")
    } else if world.get::<MeshMorphWeights>(entity).is_some() {
        Some("morphed")
    } else {
        None
    }
}

/// Brings `posed`, which is `source` in its rest shape, into the pose of an entity; its place in the world, or what is
/// wrong with the pose.
pub(super) fn strike(
    world: &World,
    entity: Entity,
    source: &Mesh,
    posed: &mut scene::Mesh,
) -> Result<Affine3A, &'static str> {
    if let Some(weights) = world.get::<MeshMorphWeights>(entity) {
        let weights = match weights {
            MeshMorphWeights::Value { weights } => weights,
            MeshMorphWeights::Reference(holder) => {
                world.get::<MorphWeights>(*holder).ok_or("has no MorphWeights where it looks for them")?.weights()
            }
        };
        let targets = match source.try_has_morph_targets() {
            Ok(true) => source.get_morph_targets().unwrap_or_default(),
            Ok(false) => return Err("has weights of morph targets and no morph targets"),
            Err(_) => return Err("has its morph targets in the render world only"),
        };
        morph(posed, targets, weights)?;
    }
    let Some(skin) = world.get::<SkinnedMesh>(entity) else {
        return Ok(world.get::<GlobalTransform>(entity).copied().unwrap_or_default().affine());
    };
    let bindposes = world.get_resource::<Assets<SkinnedMeshInverseBindposes>>();
    let bindposes = bindposes.and_then(|poses| poses.get(&skin.inverse_bindposes)).ok_or("has no bind poses yet")?;
    if bindposes.len() < skin.joints.len() {
        return Err("has fewer bind poses than joints");
    }
    let joint = |(&joint, &bindpose): (&Entity, &Mat4)| {
        world.get::<GlobalTransform>(joint).map(|joint| joint.to_matrix() * bindpose)
    };
    let joints: Option<Vec<Mat4>> = skin.joints.iter().zip(bindposes.iter()).map(joint).collect();
    let indices = source.try_attribute_option(Mesh::ATTRIBUTE_JOINT_INDEX).ok().flatten();
    let weights = source.try_attribute_option(Mesh::ATTRIBUTE_JOINT_WEIGHT).ok().flatten();
    let (Some(VertexAttributeValues::Uint16x4(indices)), Some(VertexAttributeValues::Float32x4(weights))) =
        (indices, weights)
    else {
        return Err("has no joint indices and weights that can be read");
    };
    skin_vertices(posed, &joints.ok_or("has joints that are no longer there")?, indices, weights)?;
    Ok(Affine3A::IDENTITY)
}

/// Adds the displacements: all vertices of the first target, then all of the next.
fn morph(mesh: &mut scene::Mesh, targets: &[MorphAttributes], weights: &[f32]) -> Result<(), &'static str> {
    let vertices = mesh.positions.len();
    if vertices == 0 || !targets.len().is_multiple_of(vertices) || targets.len() / vertices < weights.len() {
        return Err("has fewer morph targets than weights for them");
    }
    for (target, &weight) in targets.chunks_exact(vertices).zip(weights) {
        for (position, by) in mesh.positions.iter_mut().zip(target) {
            *position += weight * by.position;
        }
        for (normal, by) in mesh.normals.iter_mut().flatten().zip(target) {
            *normal += weight * by.normal;
        }
        for (tangent, by) in mesh.tangents.iter_mut().flatten().zip(target) {
            *tangent += (weight * by.tangent).extend(0.0);
        }
    }
    for normal in mesh.normals.iter_mut().flatten() {
        *normal = normal.normalize_or(*normal);
    }
    Ok(())
}

/// Takes every vertex into the world by the weighted sum of its joints' matrices.
fn skin_vertices(
    mesh: &mut scene::Mesh,
    joints: &[Mat4],
    indices: &[[u16; 4]],
    weights: &[[f32; 4]],
) -> Result<(), &'static str> {
    let vertices = mesh.positions.len();
    if indices.len() < vertices || weights.len() < vertices {
        return Err("has fewer joint weights than vertices");
    }
    for (vertex, (indices, weights)) in indices.iter().zip(weights).enumerate().take(vertices) {
        let mut world_from_local = Mat4::ZERO;
        for (&joint, &weight) in indices.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let joint = joints.get(usize::from(joint)).ok_or("has weights for joints that it does not have")?;
            world_from_local += *joint * weight;
        }
        mesh.positions[vertex] = world_from_local.transform_point3(mesh.positions[vertex]);
        let directions = Mat3::from_mat4(world_from_local);
        if let Some(normal) = mesh.normals.as_mut().and_then(|normals| normals.get_mut(vertex)) {
            let turned = directions.inverse().transpose() * *normal;
            *normal = if turned.is_finite() { turned.normalize_or(*normal) } else { *normal };
        }
        if let Some(tangent) = mesh.tangents.as_mut().and_then(|tangents| tangents.get_mut(vertex)) {
            *tangent = (directions * tangent.truncate()).normalize_or(tangent.truncate()).extend(tangent.w);
        }
    }
    Ok(())
}

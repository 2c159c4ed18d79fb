//! A reader for the reference scenes, which are plain .glb files: one buffer, no textures, no hierarchy. It is here
//! so that the core can be tested without Bevy, whose own loader the plugin uses.

use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{Indices, Instance, LightmapRequest, Material, Mesh, Scene, Topology};
use glam::{Affine3A, Vec2, Vec3};
use serde_json::Value;
use std::path::Path;

/// The scene in `tests/data/<name>.glb`, with emission taken as radiance.
pub fn load(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name).with_extension("glb");
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    parse(&bytes)
}

/// The scene in a .glb file.
pub fn parse(bytes: &[u8]) -> Scene {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let json_length = word(12);
    let json: Value = serde_json::from_slice(&bytes[20..20 + json_length]).unwrap();
    let buffer = &bytes[20 + json_length + 8..];
    let list = |key: &str| json[key].as_array().cloned().unwrap_or_default();
    let materials = list("materials").iter().map(material).collect();
    let mut scene = Scene { materials, ..Scene::default() };
    for node in list("nodes") {
        let mesh = &json["meshes"][node["mesh"].as_u64().unwrap() as usize];
        let name = node["name"].as_str().unwrap().to_owned();
        for primitive in mesh["primitives"].as_array().unwrap() {
            let attribute = |key: &str| floats(&json, buffer, primitive["attributes"].get(key)?);
            let three = |values: Vec<f32>| values.chunks(3).map(Vec3::from_slice).collect::<Vec<_>>();
            let uv1 = attribute("TEXCOORD_1").map(|values| values.chunks(2).map(Vec2::from_slice).collect::<Vec<_>>());
            scene.instances.push(Instance {
                id: StableId::new(name.clone()),
                name: name.clone(),
                mesh: scene.meshes.len(),
                material: primitive["material"].as_u64().unwrap() as usize,
                world_from_local: Affine3A::IDENTITY,
                lightmap: Some(LightmapRequest::default()),
            });
            scene.meshes.push(Mesh {
                name: name.clone(),
                topology: Topology::TriangleList,
                indices: Indices::U32(integers(&json, buffer, &primitive["indices"])),
                positions: three(attribute("POSITION").unwrap()),
                normals: attribute("NORMAL").map(three),
                uv1,
                ..Mesh::default()
            });
        }
    }
    scene
}

fn material(json: &Value) -> Material {
    let colour =
        |value: &Value| Vec3::from_array([0, 1, 2].map(|channel| value[channel].as_f64().unwrap_or(0.0) as f32));
    let strength = json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"].as_f64().unwrap_or(1.0);
    Material {
        name: json["name"].as_str().unwrap().to_owned(),
        base_colour: colour(&json["pbrMetallicRoughness"]["baseColorFactor"]).extend(1.0),
        emitted_radiance: colour(&json["emissiveFactor"]) * strength as f32,
        double_sided: json["doubleSided"].as_bool().unwrap_or(false),
        ..Material::default()
    }
}

fn view<'a>(json: &Value, buffer: &'a [u8], accessor: &Value) -> (&'a [u8], usize) {
    let accessor = &json["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let at = |value: &Value| value["byteOffset"].as_u64().unwrap_or(0) as usize;
    (&buffer[at(view) + at(accessor)..], accessor["count"].as_u64().unwrap() as usize)
}

fn floats(json: &Value, buffer: &[u8], accessor: &Value) -> Option<Vec<f32>> {
    let (bytes, count) = view(json, buffer, accessor);
    let kind = json["accessors"][accessor.as_u64()? as usize]["type"].as_str()?.to_owned();
    let width = if kind == "VEC3" { 3 } else { 2 };
    Some(bytes.chunks(4).take(count * width).map(|word| f32::from_le_bytes(word.try_into().unwrap())).collect())
}

fn integers(json: &Value, buffer: &[u8], accessor: &Value) -> Vec<u32> {
    let (bytes, count) = view(json, buffer, accessor);
    let kind = json["accessors"][accessor.as_u64().unwrap() as usize]["componentType"].as_u64().unwrap();
    match kind {
        5125 => bytes.chunks(4).take(count).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect(),
        5123 => bytes.chunks(2).take(count).map(|word| u16::from_le_bytes(word.try_into().unwrap()).into()).collect(),
        other => panic!("component type {other}"),
    }
}

//! A .glb in two parts, to be spoilt for tests.

use serde_json::Value;
use std::path::Path;

/// A binary glTF: its JSON and its one buffer.
pub(crate) struct Glb {
    /// The JSON chunk.
    pub(crate) json: Value,
    /// The binary chunk.
    pub(crate) buffer: Vec<u8>,
}

impl Glb {
    /// Reads a file.
    pub(crate) fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap();
        let length = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (json_end, json) = (20 + length(12), &bytes[20..20 + length(12)]);
        let buffer = bytes[json_end + 8..json_end + 8 + length(json_end)].to_vec();
        Self { json: serde_json::from_slice(json).unwrap(), buffer }
    }

    /// Writes a file.
    pub(crate) fn write(&self, path: &Path) {
        let mut json = serde_json::to_vec(&self.json).unwrap();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bytes = Vec::new();
        let word = |number: usize| u32::try_from(number).unwrap().to_le_bytes();
        bytes.extend(b"glTF");
        bytes.extend(word(2));
        bytes.extend(word(12 + 8 + json.len() + 8 + self.buffer.len()));
        bytes.extend(word(json.len()));
        bytes.extend(b"JSON");
        bytes.extend(&json);
        bytes.extend(word(self.buffer.len()));
        bytes.extend(b"BIN\0");
        bytes.extend(&self.buffer);
        std::fs::write(path, bytes).unwrap();
    }

    /// The first primitive of the mesh of this name.
    pub(crate) fn primitive(&mut self, mesh: &str) -> &mut Value {
        let meshes = self.json["meshes"].as_array_mut().unwrap();
        let mesh = meshes.iter_mut().find(|candidate| candidate["name"] == mesh).unwrap();
        &mut mesh["primitives"][0]
    }

    /// The bytes that an accessor reads.
    pub(crate) fn accessor(&mut self, index: u64) -> &mut [u8] {
        let accessor = &self.json["accessors"][usize::try_from(index).unwrap()];
        let view = &self.json["bufferViews"][usize::try_from(accessor["bufferView"].as_u64().unwrap()).unwrap()];
        let start = usize::try_from(view["byteOffset"].as_u64().unwrap_or(0)).unwrap();
        let length = usize::try_from(view["byteLength"].as_u64().unwrap()).unwrap();
        &mut self.buffer[start..start + length]
    }
}

//! Faulty files as a person has them: pictures that are damaged or gone, extensions that nobody reads, vertices that
//! are no numbers.

use super::glb::Glb;
use super::{assert_fails, assert_left_out, bake_spoilt, data, run, text, warnings};
use serde_json::json;

/// Puts a picture on the floor: the fields of an image that say where it is.
fn picture(glb: &mut Glb, image: serde_json::Value) {
    glb.json["images"] = json!([image]);
    glb.json["textures"] = json!([{ "source": 0 }]);
    let material = glb.primitive("floor")["material"].as_u64().unwrap() as usize;
    glb.json["materials"][material]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
}

/// Adds bytes to the buffer; the number of their view.
fn view(glb: &mut Glb, bytes: &[u8]) -> usize {
    let offset = glb.buffer.len();
    glb.buffer.extend(bytes);
    glb.buffer.resize(glb.buffer.len().next_multiple_of(4), 0);
    glb.json["buffers"][0]["byteLength"] = glb.buffer.len().into();
    let views = glb.json["bufferViews"].as_array_mut().unwrap();
    views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }));
    views.len() - 1
}

#[test]
fn pictures_that_cannot_be_read_are_said_to_be_pictures() {
    for (what, bytes) in [("cut short", &b"\x89PNG\r\n\x1a\n1234"[..]), ("no picture", b"hello"), ("empty", b"")] {
        let (folder, output) = bake_spoilt(|glb| {
            let view = view(glb, bytes);
            picture(glb, json!({ "mimeType": "image/png", "bufferView": view }));
        });
        assert_fails(&output, 1, "spoilt.glb has a picture that cannot be read");
        assert!(!text(&output.stderr).contains("feature"), "{what}: {}", text(&output.stderr));
        assert!(!folder.path().join("out").exists());
    }
}

#[test]
fn a_picture_that_is_not_there_is_named() {
    let (_folder, output) = bake_spoilt(|glb| picture(glb, json!({ "uri": "gone.png" })));
    assert_fails(&output, 1, "gone.png, which is not there; put it there");
    assert!(text(&output.stderr).contains("spoilt.glb needs"), "{}", text(&output.stderr));
}

#[test]
fn extensions_that_are_not_read_are_named() {
    let (_folder, output) = bake_spoilt(|glb| glb.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]));
    assert_fails(&output, 1, "requires KHR_draco_mesh_compression, which Bevy does not read; export it without");
    let spoilt = bake_spoilt(|glb| {
        glb.json["extensionsUsed"] = json!(["KHR_materials_sheen", "KHR_materials_emissive_strength"]);
    });
    assert_left_out(&spoilt, "the file uses KHR_materials_sheen");
    assert!(warnings(&spoilt.1).iter().all(|warning| !warning.contains("emissive_strength")));
}

#[test]
fn fans_of_triangles_are_said_not_to_be_read() {
    const TRIANGLE_FAN: u32 = 6;
    let (_folder, output) = bake_spoilt(|glb| glb.primitive("floor")["mode"] = TRIANGLE_FAN.into());
    assert_fails(&output, 1, "spoilt.glb has triangle fans or line loops, which Bevy does not read");
}

#[test]
fn a_normal_that_is_no_number_is_named() {
    let spoilt = bake_spoilt(|glb| {
        let normals = glb.primitive("floor")["attributes"]["NORMAL"].as_u64().unwrap();
        glb.accessor(normals)[12..16].copy_from_slice(&f32::NAN.to_le_bytes());
    });
    assert_left_out(&spoilt, "floor.white\" has normals that are not finite numbers (the first at vertex 1)");
}

#[test]
fn numbers_that_are_none_get_a_sentence() {
    let scene = data("cornell.glb");
    let scene = scene.to_str().unwrap();
    for (arguments, sentence) in [
        (["--error", "2"], "such as 2% or 0.02"),
        (["--error", "-2%"], "such as 2% or 0.02"),
        (["--time", "5"], "such as 90s, 5m"),
        (["--spp", "0"], "a whole number from 1"),
        (["--spp", "-4"], "a whole number from 1"),
        (["--threads", "0"], "leave it out for all cores"),
        (["--seed", "-1"], "a whole number from 0"),
        (["--max-bounces", "-1"], "or none for no cap"),
        (["--layers", "two"], "with commas between: 0,2"),
    ] {
        let output = run(&["plan", scene, arguments[0], arguments[1]]);
        assert_fails(&output, 2, sentence);
    }
}

/// glTF takes what has no material for a white metal, of which a lightmap shows nothing.
#[test]
fn what_shows_no_lightmap_is_named() {
    let spoilt = bake_spoilt(|glb| {
        for mesh in glb.json["meshes"].as_array_mut().unwrap().iter_mut().filter(|mesh| mesh["name"] != "light") {
            mesh["primitives"][0].as_object_mut().unwrap().remove("material");
        }
    });
    assert_left_out(&spoilt, "texels are on what shows no lightmap");
}

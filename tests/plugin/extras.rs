//! What an artist writes on things in Blender: from the custom properties in a glTF file to what a bake takes, in a
//! game, on the command line, and in a game that only shows a bake.

use super::*;
use bevy::light::{DirectionalLight, PointLight};
use bevy_kiln::bake::VolumeBox;
use bevy_kiln::plugin::windowless::open_scene;
use serde_json::{Value, json};
use temp_dir::TempDir;

/// A floor of 2 m × 2 m, as a file's buffer: positions, normals, UV0, indices.
pub(super) fn floor() -> Vec<u8> {
    let corners = [[-1.0_f32, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]];
    let positions = corners.into_iter().flat_map(|[x, z]| [x, 0.0, z]);
    let normals = corners.into_iter().flat_map(|_| [0.0, 1.0, 0.0]);
    let uv0 = corners.into_iter().flat_map(|[x, z]| [0.5 + 0.5 * x, 0.5 + 0.5 * z]);
    let numbers = positions.chain(normals).chain(uv0).flat_map(f32::to_le_bytes);
    numbers.chain([0_u16, 1, 2, 0, 2, 3].into_iter().flat_map(u16::to_le_bytes)).collect()
}

/// A file in which each of these nodes is; meshes 0 and 1 are floors, the second with a density and a role of its own;
/// light 0 is a point light, light 1 a sun with a mode of its own.
pub(super) fn file(nodes: &Value) -> Value {
    let primitive =
        json!({ "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 }, "indices": 3, "material": 0 });
    let vector = |offset: usize| {
        json!({ "bufferView": 0, "byteOffset": offset, "componentType": 5126, "count": 4, "type": "VEC3",
            "min": [-1, 0, -1], "max": [1, 0, 1] })
    };
    let list = nodes.as_array().unwrap();
    let is_child = |index: &usize| {
        list.iter().any(|node| node["children"].as_array().is_some_and(|children| children.contains(&json!(index))))
    };
    let scene: Vec<usize> = (0..list.len()).filter(|index| !is_child(index)).collect();
    json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "point", "name": "bulb", "intensity": 100.0 },
            { "type": "directional", "name": "sun", "intensity": 1000.0, "extras": { "kiln_mode": "real_time" } },
        ] } },
        "scene": 0,
        "scenes": [{ "name": "level", "nodes": scene }],
        "nodes": nodes,
        "meshes": [
            { "name": "floor", "primitives": [primitive] },
            { "name": "tile", "primitives": [primitive], "extras": { "kiln_density": 3, "kiln_block": true } },
        ],
        "materials": [{ "name": "stone" }],
        "buffers": [{ "uri": "floor.bin", "byteLength": floor().len() }],
        "bufferViews": [{ "buffer": 0, "byteLength": 128 }, { "buffer": 0, "byteOffset": 128, "byteLength": 12 }],
        "accessors": [
            vector(0),
            vector(48),
            { "bufferView": 0, "byteOffset": 96, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
    })
}

fn written(nodes: &Value) -> TempDir {
    let folder = TempDir::new().unwrap();
    std::fs::write(folder.path().join("floor.bin"), floor()).unwrap();
    std::fs::write(folder.path().join("room.gltf"), file(nodes).to_string()).unwrap();
    folder
}

fn extracted(nodes: &Value) -> Extraction {
    let folder = written(nodes);
    let mut app = open_scene(&folder.path().join("room.gltf")).unwrap();
    extract_scene(app.world_mut(), &SceneSettings::default())
}

/// What each mesh is to get, by its node's name: nothing, or a lightmap of this density.
fn roles(extraction: &Extraction) -> Vec<(String, Option<Option<f32>>)> {
    let of = |instance: &bevy_kiln::scene::Instance| {
        let node = instance.name.split('/').nth(1).unwrap_or_default().to_owned();
        (node, instance.lightmap.map(|request| request.density))
    };
    extraction.scene.instances.iter().map(of).collect()
}

fn said(extraction: &Extraction) -> Vec<String> {
    extraction.warnings.iter().map(ToString::to_string).collect()
}

fn role(name: &str, role: Option<Option<f32>>) -> (String, Option<Option<f32>>) {
    (name.to_owned(), role)
}

#[test]
fn roles_and_densities_are_as_written() {
    let found = extracted(&json!([
        { "name": "a", "mesh": 0, "extras": { "kiln_receive": true } },
        { "name": "b", "mesh": 0, "extras": { "kiln_receive": 1, "kiln_density": 40.5 } },
        { "name": "c", "mesh": 0, "extras": { "kiln_block": true } },
        { "name": "d", "mesh": 0, "extras": { "kiln_receive": false } },
        { "name": "e", "mesh": 0, "extras": { "kiln_receive": false, "kiln_block": 1 } },
        { "name": "f", "mesh": 0 },
    ]));
    let expected = [role("a", Some(None)), role("b", Some(Some(40.5))), role("c", None), role("e", None)];
    assert_eq!(roles(&found), expected);
    assert!(found.has_movers);
    assert_eq!(said(&found), [""; 0]);
}

#[test]
fn without_a_receiver_all_receive_but_what_says_otherwise() {
    let found = extracted(&json!([
        { "name": "a", "mesh": 0 },
        { "name": "b", "mesh": 0, "extras": { "kiln_density": 8 } },
        { "name": "c", "mesh": 0, "extras": { "kiln_receive": 0 } },
    ]));
    assert_eq!(roles(&found), [role("a", Some(None)), role("b", Some(Some(8.0)))]);
    assert!(found.has_movers, "what is said to move is lit by volumes");
}

#[test]
fn the_nearest_holds_and_an_object_has_the_last_word_over_its_mesh() {
    let found = extracted(&json!([
        { "name": "house", "children": [1, 2, 3, 4], "extras": { "kiln_receive": true, "kiln_density": 4 } },
        { "name": "a", "mesh": 0 },
        { "name": "b", "mesh": 0, "extras": { "kiln_density": 16 } },
        { "name": "c", "mesh": 1 },
        { "name": "d", "mesh": 1, "extras": { "kiln_receive": true } },
    ]));
    let of = |instance: &bevy_kiln::scene::Instance| {
        let node = instance.name.split('/').nth(2).unwrap_or_default();
        role(node, instance.lightmap.map(|request| request.density))
    };
    let below: Vec<_> = found.scene.instances.iter().map(of).collect();
    let expected =
        [role("a", Some(Some(4.0))), role("b", Some(Some(16.0))), role("c", None), role("d", Some(Some(3.0)))];
    assert_eq!(below, expected);
}

#[test]
fn a_cube_is_the_box_of_a_volume() {
    let found = extracted(&json!([
        { "name": "a", "mesh": 0 },
        { "name": "room", "extras": { "kiln_volume": true }, "translation": [1, 2, 3], "scale": [4, 1, 2] },
        { "name": "none", "extras": { "kiln_volume": false } },
    ]));
    let [VolumeBox { id, centre, size, spacing, .. }] = found.volumes.as_slice() else { panic!("{:?}", found.volumes) };
    assert_eq!(
        (id.as_str(), *centre, *size),
        ("level/room/volume", Vec3::new(1.0, 2.0, 3.0), Vec3::new(8.0, 2.0, 4.0))
    );
    assert_eq!(*spacing, None);
}

#[test]
fn lights_have_the_mode_that_is_written_on_them_or_on_their_object() {
    let light = |index: usize| json!({ "KHR_lights_punctual": { "light": index } });
    let nodes = json!([
        { "name": "a", "extensions": light(0), "extras": { "kiln_mode": "baked" } },
        { "name": "b", "extensions": light(0), "extras": { "kiln_mode": "Mixed Indirect" } },
        { "name": "c", "extensions": light(0) },
        { "name": "d", "extensions": light(1) },
    ]);
    let found = extracted(&nodes);
    let names = |ids: &mut dyn Iterator<Item = &bevy_kiln::artefact::StableId>| -> Vec<String> {
        ids.map(|id| id.as_str().to_owned()).collect()
    };
    assert_eq!(
        names(&mut found.scene.lights.iter().map(|light| light.id())),
        ["level/a/bulb", "level/b/bulb", "level/c/bulb"]
    );
    assert_eq!(names(&mut found.scene.off_in_real_time.iter()), ["level/a/bulb"]);
    assert_eq!(names(&mut found.scene.indirect_only.iter()), ["level/b/bulb"]);
    assert_eq!(said(&found), [""; 0]);
}

/// The command line writes a folder, and a game that knows nothing of the bake shows it: a light of which nothing is
/// left to real time must be off there too.
#[test]
fn a_shipped_game_turns_off_what_is_only_baked() {
    let light = json!({ "KHR_lights_punctual": { "light": 0 } });
    let folder = written(&json!([
        { "name": "ground", "mesh": 0, "extras": { "kiln_recieve": true } },
        { "name": "lamp", "translation": [0, 1, 0], "extensions": light, "extras": { "kiln_mode": "baked" } },
    ]));
    let mut command = Command::new(env!("CARGO_BIN_EXE_kiln"));
    command.arg("bake").arg(folder.path().join("room.gltf")).arg("-o").arg(folder.path().join("baked"));
    let output = command.args(["--spp", "4", "--density", "4"]).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    let fault = "\"level/ground\" has a custom property kiln_recieve, which there is not; there are kiln_receive, ";
    assert_eq!(errors.matches(fault).count(), 1, "{errors}");

    let mut game = app(folder.path());
    let handle: Handle<Gltf> = game.world().resource::<AssetServer>().load("room.gltf");
    run_until(&mut game, "the file", |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&handle));
    let scene = game.world().resource::<Assets<Gltf>>().get(&handle).unwrap().scenes[0].clone();
    let baked: Handle<BakedFolder> = game.world().resource::<AssetServer>().load("baked/kiln.ron");
    let root = game.world_mut().spawn((WorldAssetRoot(scene), BakedLightmaps(baked))).id();
    run_until(&mut game, "the lightmap", |world| count::<Lightmap>(world) == 1);
    let power = |world: &mut World| world.query::<&PointLight>().single(world).unwrap().intensity;
    assert_eq!(power(game.world_mut()), 0.0);
    game.world_mut().entity_mut(root).remove::<BakedLightmaps>();
    game.update();
    assert!(power(game.world_mut()) > 0.0);
    assert_eq!(count::<DirectionalLight>(game.world_mut()), 0);
}

/// What the game itself has put on a thing counts, and the marks are there in the frame in which the scene spawns.
#[test]
fn a_mark_of_the_games_own_counts() {
    let light = json!({ "KHR_lights_punctual": { "light": 0 } });
    let folder = written(&json!([
        { "name": "ground", "mesh": 0, "extras": { "kiln_receive": true } },
        { "name": "lamp", "extensions": light, "extras": { "kiln_mode": "baked" } },
    ]));
    let mut game = app(folder.path());
    fn own(named: On<Insert, Name>, names: Query<&Name>, mut commands: Commands) {
        if names.get(named.entity).is_ok_and(|name| name.as_str() == "lamp") {
            commands.entity(named.entity).insert(LightBaking::MixedIndirect);
        }
    }
    game.add_observer(own);
    let handle: Handle<Gltf> = game.world().resource::<AssetServer>().load("room.gltf");
    run_until(&mut game, "the file", |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&handle));
    let scene = game.world().resource::<Assets<Gltf>>().get(&handle).unwrap().scenes[0].clone();
    game.world_mut().spawn(WorldAssetRoot(scene));
    run_until(&mut game, "the scene", |world| count::<Mesh3d>(world) == 1);
    let world = game.world_mut();
    assert_eq!(count::<LightmapReceiver>(world), 1);
    assert_eq!(*world.query::<&LightBaking>().single(world).unwrap(), LightBaking::MixedIndirect);
}

//! Meshes and images that Bevy has handed to the renderer: a bake reads their files again, and names what has none.

use super::extras::{file, floor};
use super::*;
use image::ExtendedColorType::Rgba8;
use serde_json::json;
use temp_dir::TempDir;

/// Takes away the data of all meshes and images as the render world does with those that are for it alone.
fn hand_over(world: &mut World) -> (usize, usize) {
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    let mut taken = (0, 0);
    for (_, mesh) in meshes.iter_mut() {
        taken.0 += usize::from(mesh.take_gpu_data().is_ok());
    }
    let mut images = world.resource_mut::<Assets<Image>>();
    for (_, image) in images.iter_mut() {
        taken.1 += usize::from(image.data.take().is_some());
    }
    taken
}

fn sentences(warnings: &[bevy_kiln::plugin::KilnWarning]) -> Vec<&str> {
    warnings.iter().map(|warning| warning.sentence.as_str()).collect()
}

/// A red floor by a picture beside the file, a blue one by a picture inside it, and a lamp.
fn coloured() -> TempDir {
    let folder = TempDir::new().unwrap();
    let picture = |colour: [u8; 4]| {
        let path = folder.path().join("picture.png");
        image::save_buffer(&path, &[colour; 4].concat(), 2, 2, Rgba8).unwrap();
        std::fs::read(path).unwrap()
    };
    let blue = picture([20, 20, 230, 255]);
    picture([230, 20, 20, 255]);
    let mut room = file(&json!([
        { "name": "red", "mesh": 0 },
        { "name": "blue", "mesh": 1, "translation": [2.5, 0, 0], "extras": { "kiln_receive": true } },
        { "name": "wall", "mesh": 0, "rotation": [0, 0, 0.707_106_77, 0.707_106_77], "translation": [1.2, 0, 0],
          "extras": { "kiln_receive": true } },
        { "name": "lamp", "translation": [0, 1, 0], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
    ]));
    let buffer = [floor(), blue.clone()].concat();
    room["buffers"][0]["byteLength"] = buffer.len().into();
    let view = json!({ "buffer": 0, "byteOffset": floor().len(), "byteLength": blue.len() });
    room["bufferViews"].as_array_mut().unwrap().push(view);
    room["images"] = json!([{ "uri": "picture.png" }, { "bufferView": 2, "mimeType": "image/png" }]);
    room["textures"] = json!([{ "source": 0 }, { "source": 1 }]);
    let material = |texture: usize| {
        let matte = json!({ "metallicFactor": 0, "baseColorTexture": { "index": texture } });
        json!({ "pbrMetallicRoughness": matte })
    };
    room["materials"] = json!([material(0), material(1)]);
    room["meshes"][1]["primitives"][0]["material"] = 1.into();
    room["nodes"][0]["extras"] = json!({ "kiln_receive": true });
    std::fs::write(folder.path().join("floor.bin"), buffer).unwrap();
    std::fs::write(folder.path().join("room.gltf"), room.to_string()).unwrap();
    folder
}

fn spawned(folder: &TempDir, file: &'static str) -> App {
    let mut game = app(folder.path());
    game.insert_resource(GlobalAmbientLight::NONE);
    let handle: Handle<Gltf> = game.world().resource::<AssetServer>().load(file);
    run_until(&mut game, "the file", |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&handle));
    let scene = game.world().resource::<Assets<Gltf>>().get(&handle).unwrap().scenes[0].clone();
    game.world_mut().spawn(WorldAssetRoot(scene));
    // The handle of the file goes; what the scene shows stays.
    run_until(&mut game, "the scene", |world| count::<Mesh3d>(world) == 3);
    game
}

fn scene(app: &mut App) -> Extraction {
    extract_scene(app.world_mut(), &SceneSettings::default())
}

fn packed() -> BakeLightmaps {
    BakeLightmaps { layout: LightmapLayout::Packed, density: 4.0, ..small() }
}

#[test]
fn a_bake_reads_again_what_is_with_the_renderer() {
    let folder = coloured();
    let mut whole = spawned(&folder, "room.gltf");
    assert_eq!(scene(&mut whole).scene.textures.len(), 2);
    whole.world_mut().trigger(packed());
    let expected = run_until_baked(&mut whole, 1);
    assert_eq!(sentences(&expected.warnings), [""; 0]);

    let mut app = spawned(&folder, "room.gltf");
    let (meshes, images) = hand_over(app.world_mut());
    assert!(meshes >= 2 && images >= 2, "{meshes} {images}");
    // Without a second reading next to nothing is left.
    let Extraction { scene, warnings, .. } = scene(&mut app);
    assert!(scene.instances.is_empty(), "{:?}", scene.instances);
    assert!(warnings.iter().all(|warning| warning.to_string().contains("is in the render world only, so")));
    app.world_mut().trigger(packed());
    let found = run_until_baked(&mut app, 1);
    assert!(
        found.lightmap.pages == expected.lightmap.pages && found.lightmap.placements == expected.lightmap.placements
    );
    // What was laid out anew cannot be shown without the vertices, and that is said.
    let said = sentences(&found.warnings);
    assert!(said.iter().all(|sentence| sentence.contains("in the render world only")), "{said:?}");
    // The game's own images are as they were; what was read for the bake went nowhere.
    app.update();
    let is_gone = |world: &mut World| {
        let mut images = world.resource_mut::<Assets<Image>>();
        images.iter_mut().all(|(_, image)| image.data.is_none() || image.texture_descriptor.size.width > 2)
    };
    assert!(is_gone(app.world_mut()));
}

#[test]
fn the_game_goes_on_while_files_are_read_and_can_stop_it() {
    let folder = coloured();
    let mut app = spawned(&folder, "room.gltf");
    hand_over(app.world_mut());
    app.world_mut().trigger(packed());
    app.update();
    let running = app.world().resource::<BakeStatus>().running().unwrap();
    assert!(running.is_waiting, "{running:?}");
    app.world_mut().trigger(CancelBake);
    run_until(&mut app, "the end", |world| world.resource::<Heard>().failed.len() == 1);
    assert!(app.world().resource::<Heard>().failed[0].cancelled);
    app.world_mut().resource_mut::<Heard>().failed.clear();
    app.world_mut().trigger(packed());
    run_until_baked(&mut app, 1);
}

#[test]
fn what_was_made_in_code_is_named_and_the_rest_is_baked() {
    let folder = coloured();
    let mut app = spawned(&folder, "room.gltf");
    let world = app.world_mut();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let image = world.resource_mut::<Assets<Image>>().add(Image::default());
    let material = StandardMaterial { base_color_texture: Some(image), ..default() };
    let material = MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(material));
    let box_and_plane = (Name::new("made"), Mesh3d(mesh), material.clone(), LightmapReceiver::default());
    world.spawn(box_and_plane);
    hand_over(world);
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    world.spawn((Name::new("dressed"), Mesh3d(mesh), material, LightBlocker));
    world.trigger(packed());
    let found = run_until_baked(&mut app, 1);
    assert_eq!(found.lightmap.placements.len(), 3);
    let said = sentences(&found.warnings);
    for sentence in [
        "mesh \"made\" is in the render world only, and it was made in code, so that there is no file to read it from \
         again, so it is left out; make or load it with RenderAssetUsages::MAIN_WORLD as well",
        "the base colour texture of \"dressed\" is in the render world only, and it was made in code, so that there is \
         no file to read it from again; make or load it with RenderAssetUsages::MAIN_WORLD as well; until then the \
         material does without it",
    ] {
        assert!(said.contains(&sentence), "{said:?}");
    }
}

#[test]
fn a_file_that_is_gone_or_has_changed_is_named() {
    let folder = coloured();
    let mut app = spawned(&folder, "room.gltf");
    hand_over(app.world_mut());
    std::fs::remove_file(folder.path().join("picture.png")).unwrap();
    // All floors are a tenth higher.
    let path = folder.path().join("floor.bin");
    let mut bytes = std::fs::read(&path).unwrap();
    (0..4).for_each(|corner| bytes[12 * corner + 4..12 * corner + 8].copy_from_slice(&0.1_f32.to_le_bytes()));
    std::fs::write(path, bytes).unwrap();
    app.world_mut().trigger(packed());
    run_until(&mut app, "the end", |world| world.resource::<BakeStatus>().running().is_none());
    let outcome = app.world().resource::<BakeStatus>().outcomes().next().unwrap();
    let said = sentences(&outcome.warnings);
    let changed = "is in the render world only, and its file has something else by now, or is read with settings \
        of its own, so it is left out";
    assert_eq!(said.iter().filter(|sentence| sentence.contains(changed)).count(), 2, "{said:?}");
}

//! A shipped game and the folder that it shows: whether both are of one scene, a folder that is baked again while the
//! game runs, and how its textures are sampled.

use super::extras::{file, floor};
use super::*;
use bevy::light::PointLight;
use serde_json::{Value, json};
use temp_dir::TempDir;

fn nodes() -> Value {
    let light = json!({ "KHR_lights_punctual": { "light": 0 } });
    json!([
        { "name": "ground", "mesh": 0 },
        { "name": "block", "mesh": 0, "translation": [0, 0.5, 0], "scale": [0.3, 0.3, 0.3],
          "extras": { "kiln_block": true } },
        { "name": "lamp", "translation": [0, 1, 0], "extensions": light, "extras": { "kiln_mode": "baked" } },
    ])
}

pub(crate) fn room() -> Value {
    let mut room = file(&nodes());
    room["nodes"][0]["extras"] = json!({ "kiln_receive": true });
    room
}

pub(crate) fn write(folder: &TempDir, room: &Value) {
    std::fs::write(folder.path().join("floor.bin"), floor()).unwrap();
    std::fs::write(folder.path().join("room.gltf"), room.to_string()).unwrap();
}

pub(crate) fn bake(folder: &TempDir, options: &[&str]) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_kiln"));
    command.arg("bake").arg(folder.path().join("room.gltf")).arg("-o").arg(folder.path().join("baked"));
    let output = command.args(["--spp", "4", "--format", "rgba16f"]).args(options).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The room's file once it is read, ready to be spawned.
pub(crate) fn loaded(game: &mut App) -> WorldAssetRoot {
    let handle: Handle<Gltf> = game.world().resource::<AssetServer>().load("room.gltf");
    run_until(game, "the file", |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&handle));
    WorldAssetRoot(game.world().resource::<Assets<Gltf>>().get(&handle).unwrap().scenes[0].clone())
}

/// The scene with its folder, as a game shows it; the root is put elsewhere, as a game may.
fn shown(mut game: App) -> (App, Entity) {
    let root = run_until_shown(&mut game, 1);
    (game, root)
}

/// The same in a game that has begun, with so many lightmaps.
pub(crate) fn run_until_shown(game: &mut App, lightmaps: usize) -> Entity {
    let scene = loaded(game);
    let baked: Handle<BakedFolder> = game.world().resource::<AssetServer>().load("baked/kiln.ron");
    let place = Transform::from_xyz(30.0, -4.0, 0.1).with_rotation(Quat::from_rotation_y(1.0));
    let root = game.world_mut().spawn((scene, BakedLightmaps(baked), place)).id();
    run_until(game, "the lightmaps", |world| count::<Lightmap>(world) == lightmaps);
    root
}

fn changed(folder: &TempDir) -> Vec<String> {
    let (game, root) = shown(app(folder.path()));
    let applied = game.world().get::<AppliedLightmaps>(root).unwrap();
    applied.changed_since_bake().iter().map(|id| id.as_str().to_owned()).collect()
}

#[test]
fn what_is_not_as_it_was_at_the_bake_is_named() {
    let folder = TempDir::new().unwrap();
    write(&folder, &room());
    bake(&folder, &["--density", "4"]);
    assert_eq!(changed(&folder), [""; 0], "as it was");
    type Change = fn(&mut Value);
    let changes: [(Change, &[&str]); 6] = [
        (|room| room["nodes"][1]["translation"] = json!([0, 0.6, 0]), &["level/block/floor.stone"]),
        (|room| room["nodes"][0]["scale"] = json!([1, 1, 1.01]), &["level/ground/floor.stone"]),
        (
            |room| room["materials"][0]["pbrMetallicRoughness"] = json!({ "baseColorFactor": [1, 0.9, 1, 1] }),
            &["level/block/floor.stone", "level/ground/floor.stone"],
        ),
        (|room| room["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = json!(101), &["level/lamp/bulb"]),
        (|room| room["nodes"][2]["extras"]["kiln_mode"] = json!("mixed_direct"), &["level/lamp/bulb"]),
        // The light of another name is another light, of which nobody knows anything.
        (|room| room["extensions"]["KHR_lights_punctual"]["lights"][0]["name"] = json!("candle"), &[]),
    ];
    for (index, (change, expected)) in changes.into_iter().enumerate() {
        let mut other = room();
        change(&mut other);
        write(&folder, &other);
        assert_eq!(changed(&folder), expected, "change {index}");
    }
    // A folder that was written before it was noted shows as ever.
    let manifest = folder.path().join("baked/kiln.ron");
    let text = std::fs::read_to_string(&manifest).unwrap();
    let start = text.find("    things: {").expect("the manifest says what things were like");
    std::fs::write(&manifest, format!("{})", &text[..start])).unwrap();
    assert_eq!(changed(&folder), [""; 0]);
}

/// A sun without a name, a lantern and a stage with one, as code adds them to a scene file.
pub(crate) fn add_in_code(world: &mut World) -> Entity {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(2.0, 2.0));
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default());
    let stage = (Name::new("stage"), Mesh3d(mesh), MeshMaterial3d(material), LightmapReceiver::default());
    world.spawn((stage, Transform::from_xyz(5.0, 0.0, 0.0)));
    world.spawn((Name::new("lantern"), PointLight::default(), Transform::from_xyz(5.0, 1.0, 0.0)));
    sun(world, Vec3::new(-0.5, -1.0, -0.3))
}

fn sun(world: &mut World, towards: Vec3) -> Entity {
    world.spawn((DirectionalLight::default(), Transform::default().looking_to(towards, Vec3::Y))).id()
}

/// Bakes the room and what code adds to it, which holds a point light, in a game; the number of lightmaps.
pub(crate) fn bake_in_game(folder: &TempDir, add: impl FnOnce(&mut World)) -> usize {
    let mut editor = app(folder.path());
    let scene = loaded(&mut editor);
    editor.world_mut().spawn(scene);
    add(editor.world_mut());
    run_until(&mut editor, "the scene", |world| count::<PointLight>(world) == 2);
    let packed = BakeLightmaps { layout: LightmapLayout::Packed, density: 4.0, ..small() };
    editor.world_mut().trigger(packed);
    run_until_baked(&mut editor, 1).save(folder.path().join("baked")).unwrap();
    count::<Lightmap>(editor.world_mut())
}

#[test]
fn what_a_game_adds_in_code_is_found_again() {
    let folder = TempDir::new().unwrap();
    write(&folder, &room());
    let lightmaps = bake_in_game(&folder, |world| {
        add_in_code(world);
    });
    assert_eq!(lightmaps, 2);

    let mut game = app(folder.path());
    let world = game.world_mut();
    let baked = add_in_code(world);
    // What was never baked: other suns, a crate, and a lantern that is carried, of the same name as the baked one.
    let carried = world.spawn((Name::new("lantern"), PointLight::default(), LightBaking::RealTime)).id();
    let others = [sun(world, Vec3::NEG_Y), sun(world, Vec3::new(0.5, -1.0, 0.3))];
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let crate_ = world.spawn(Mesh3d(mesh)).id();
    run_until_shown(&mut game, 2);
    let lights_the_baked =
        |sun: Entity| game.world().get::<DirectionalLight>(sun).unwrap().affects_lightmapped_mesh_diffuse;
    assert!(!lights_the_baked(baked), "it would light the room twice");
    assert!(others.into_iter().all(lights_the_baked));
    let lantern = game.world().get::<PointLight>(carried).unwrap();
    assert!(lantern.affects_lightmapped_mesh_diffuse && lantern.intensity > 0.0);
    assert!(!game.world().entity(crate_).contains::<Lightmap>());
    let mut roots = game.world_mut().query::<(Entity, &AppliedLightmaps)>();
    let (root, applied) = roots.single(game.world()).unwrap();
    assert_eq!((applied.len(), applied.changed_since_bake()), (5, &[][..]), "ground, lamp, stage, lantern, sun");
    game.world_mut().entity_mut(root).remove::<BakedLightmaps>();
    game.update();
    assert!(game.world().get::<DirectionalLight>(baked).unwrap().affects_lightmapped_mesh_diffuse);
    assert_eq!(count::<Lightmap>(game.world_mut()), 0);
}

#[test]
fn a_folder_that_is_baked_again_is_shown_anew() {
    let folder = TempDir::new().unwrap();
    write(&folder, &room());
    bake(&folder, &["--density", "4"]);
    let (mut game, root) = shown(app(folder.path()));
    let before = texels(game.world_mut());
    let power = |world: &mut World| world.query::<&PointLight>().single(world).unwrap().intensity;
    assert_eq!(power(game.world_mut()), 0.0);

    // Bevy's watcher asks for the same when a file changes.
    bake(&folder, &["--density", "9", "--seed", "3"]);
    let server = game.world().resource::<AssetServer>().clone();
    for file in ["baked/kiln.ron", "baked/lightmap_0.ktx2"] {
        server.reload(file);
    }
    let mut bare = 0;
    let sizes = |texels: &BTreeMap<String, Vec<u8>>| -> Vec<usize> { texels.values().map(Vec::len).collect() };
    // The manifest may come before the texture, which is then put on once more.
    run_until(&mut game, "frames without a lightmap, then the new one", |world| {
        // Bevy never sees another texture on an entity that has one; there must be frames without.
        bare += usize::from(count::<Lightmap>(world) == 0);
        bare >= 3 && count::<Lightmap>(world) == 1 && sizes(&texels(world)) != sizes(&before)
    });
    for _ in 0..10 {
        game.update();
    }
    assert_eq!(count::<Lightmap>(game.world_mut()), 1);
    assert_eq!(game.world().get::<AppliedLightmaps>(root).unwrap().len(), 2, "the ground and the lamp");
    assert_eq!(power(game.world_mut()), 0.0);
    game.world_mut().entity_mut(root).remove::<BakedLightmaps>();
    game.update();
    assert_eq!(count::<Lightmap>(game.world_mut()), 0);
    assert!(power(game.world_mut()) > 0.0, "the lamp is given back as it was, not as it was muted");
}

#[test]
fn textures_are_sampled_linearly_in_a_game_whose_default_is_nearest() {
    let folder = TempDir::new().unwrap();
    write(&folder, &room());
    bake(&folder, &["--density", "4", "--volumes=1"]);
    let mut game = App::new();
    let plugins = WindowlessPlugins { asset_folder: folder.path().to_owned() };
    game.add_plugins(plugins.set(ImagePlugin::default_nearest())).add_plugins(KilnPlugin);
    game.finish();
    game.cleanup();
    let (mut game, root) = shown(game);
    let folder = game.world().get::<BakedLightmaps>(root).unwrap().0.clone();
    run_until(&mut game, "all textures", |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&folder));
    let world = game.world();
    let folder = world.resource::<Assets<BakedFolder>>().get(&folder).unwrap();
    let textures: Vec<&Handle<Image>> = folder.pages.iter().chain(&folder.volumes).collect();
    assert!(folder.pages.len() == 1 && !folder.volumes.is_empty());
    for texture in textures {
        let ImageSampler::Descriptor(sampler) = &world.resource::<Assets<Image>>().get(texture).unwrap().sampler else {
            panic!("the game's default holds")
        };
        let filters = [sampler.mag_filter, sampler.min_filter].map(|filter| format!("{filter:?}"));
        assert_eq!(filters, ["Linear", "Linear"]);
    }
}

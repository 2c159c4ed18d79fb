//! The plugin in a running app without a renderer: a bake from its trigger to its components, and back.
#![cfg(feature = "cli")]

#[path = "plugin/arrivals.rs"]
mod arrivals;
#[path = "plugin/command.rs"]
mod command;
#[path = "plugin/custom_materials.rs"]
mod custom_materials;
#[path = "plugin/environments.rs"]
mod environments;
#[path = "plugin/extras.rs"]
mod extras;
#[path = "plugin/filtering.rs"]
mod filtering;
#[allow(dead_code, reason = "the command line's tests use the rest of it")]
#[path = "support/glb.rs"]
mod glb;
#[path = "plugin/late_textures.rs"]
mod late_textures;
#[path = "plugin/left_out.rs"]
mod left_out;
#[path = "plugin/light_baking.rs"]
mod light_baking;
#[path = "plugin/lights.rs"]
mod lights;
#[path = "plugin/live.rs"]
mod live;
#[path = "plugin/materials.rs"]
mod materials;
#[path = "plugin/meshes.rs"]
mod meshes;
#[path = "plugin/render_world.rs"]
mod render_world;
#[path = "plugin/shipping.rs"]
mod shipping;
#[path = "plugin/volumes.rs"]
mod volumes;

#[cfg(feature = "remote")]
#[path = "plugin/remote.rs"]
mod remote;

use bevy::ecs::system::RunSystemOnce;
use bevy::gltf::Gltf;
use bevy::image::ImageSampler;
use bevy::light::RectLight;
use bevy::pbr::Lightmap;
use bevy::prelude::*;
use bevy::world_serialization::WorldAssetRoot;
use bevy_kiln::bake::bake_lightmap;
use bevy_kiln::plugin::windowless::WindowlessPlugins;
use bevy_kiln::plugin::{AppliedLightmaps, BakeId, Extraction, KilnEnding, KilnWork, extract_scene};
use bevy_kiln::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Longest wait for anything; only a fault makes a test wait that long.
const PATIENCE: Duration = Duration::from_secs(120);

/// What the plugin has said.
#[derive(Resource, Default)]
struct Heard {
    finished: Vec<BakeFinished>,
    failed: Vec<BakeFailed>,
    progress: usize,
}

fn data(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file)
}

fn app(asset_folder: &Path) -> App {
    let mut app = App::new();
    app.add_plugins(WindowlessPlugins { asset_folder: asset_folder.to_owned() })
        .add_plugins(KilnPlugin)
        .init_resource::<Heard>()
        .add_observer(|event: On<BakeFinished>, mut heard: ResMut<Heard>| heard.finished.push(event.event().clone()))
        .add_observer(|event: On<BakeFailed>, mut heard: ResMut<Heard>| heard.failed.push(event.event().clone()))
        .add_observer(|_: On<BakeProgress>, mut heard: ResMut<Heard>| heard.progress += 1);
    app.finish();
    app.cleanup();
    app
}

fn run_until(app: &mut App, what: &str, mut done: impl FnMut(&mut World) -> bool) {
    let start = Instant::now();
    while !done(app.world_mut()) {
        assert!(start.elapsed() < PATIENCE, "waited in vain for {what}");
        app.update();
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn run_until_baked(app: &mut App, count: usize) -> BakeFinished {
    run_until(app, "the bake", |world| {
        let heard = world.resource::<Heard>();
        assert!(heard.failed.is_empty(), "{:?}", heard.failed);
        heard.finished.len() == count
    });
    app.world().resource::<Heard>().finished[count - 1].clone()
}

/// The Cornell box, spawned from its file as a game does.
fn cornell(folder: &Path) -> App {
    let mut app = app(folder);
    let handle: Handle<Gltf> = app.world().resource::<AssetServer>().load("cornell.glb");
    run_until(&mut app, "the file", |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&handle));
    let scene = app.world().resource::<Assets<Gltf>>().get(&handle).unwrap().scenes[0].clone();
    app.world_mut().spawn((Name::new("a name of the game's own"), WorldAssetRoot(scene)));
    run_until(&mut app, "the scene", |world| count::<Mesh3d>(world) == 8);
    app
}

/// A floor under a rectangular light, spawned by hand.
fn lit_floor() -> App {
    let mut app = app(&data(""));
    app.world_mut().run_system_once(spawn_lit_floor).unwrap();
    app.update();
    app
}

fn spawn_lit_floor(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mesh = Mesh::from(Plane3d::default().mesh().size(2.0, 2.0));
    let uv = mesh.attribute(Mesh::ATTRIBUTE_UV_0).unwrap().clone();
    let mesh = meshes.add(mesh.with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, uv));
    let material = materials.add(StandardMaterial { reflectance: 0.0, ..default() });
    commands.spawn((Name::new("floor"), Mesh3d(mesh), MeshMaterial3d(material)));
    let down = Transform::from_xyz(0.0, 1.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::X);
    commands.spawn((Name::new("lamp"), RectLight { intensity: 100.0, ..default() }, down));
}

fn count<C: Component>(world: &mut World) -> usize {
    world.query_filtered::<(), With<C>>().iter(world).count()
}

/// A bake that shows nothing before its end: what is on the screen at which frame would hang on the clock else.
fn small() -> BakeLightmaps {
    BakeLightmaps {
        view: BakeView::WhenDone,
        scene: SceneSettings { emissive: EmissiveUnit::Nits, ..default() },
        goal: BakeGoal::Samples(16),
        layout: LightmapLayout::Shared { size: 32 },
        format: LightmapFormat::Rgba16f,
        ..default()
    }
}

/// Everything that a bake may change, by stable name and ready to be compared.
fn snapshot(world: &mut World) -> Vec<String> {
    let mut lines = Vec::new();
    let mut lightmaps = world.query::<(Entity, &Lightmap)>();
    lines.extend(lightmaps.iter(world).map(|(entity, lightmap)| {
        format!("{entity} {:?} {:?} {}", lightmap.image.id(), lightmap.uv_rect, lightmap.bicubic_sampling)
    }));
    let mut lights = world.query::<(Entity, &RectLight)>();
    lines.extend(lights.iter(world).map(|(entity, light)| format!("{entity} {light:?}")));
    lines.push(format!("{:?}", world.resource::<GlobalAmbientLight>()));
    let mut archetypes = world.query_filtered::<EntityRef, With<Transform>>();
    lines.extend(
        archetypes.iter(world).map(|entity| format!("{} {}", entity.id(), entity.archetype().component_count())),
    );
    lines.sort();
    lines
}

/// The texels that each lightmapped entity shows, by its name.
fn texels(world: &mut World) -> BTreeMap<String, Vec<u8>> {
    let mut lightmaps = world.query::<(&Name, &Lightmap)>();
    let images = world.resource::<Assets<Image>>();
    let shown = lightmaps.iter(world).map(|(name, lightmap)| {
        let image = images.get(&lightmap.image).unwrap_or_else(|| panic!("{name} has no image"));
        (name.as_str().to_owned(), image.data.clone().unwrap())
    });
    shown.collect()
}

#[test]
fn a_trigger_becomes_lightmaps_on_entities() {
    let mut app = cornell(&data(""));
    app.world_mut().trigger(small());
    let finished = run_until_baked(&mut app, 1);
    assert_eq!(finished.entities, 7, "all but the lamp, which has no UV1");
    assert_eq!(finished.samples, 16 * finished.texels);
    assert!(app.world().resource::<Heard>().progress > 0);
    assert!(finished.warnings.iter().any(|warning| warning.sentence.contains("light.light\" has no UV1")));
    let shown = texels(app.world_mut());
    assert_eq!(shown.len(), 7);
    assert!(shown.values().all(|texels| texels.len() == 32 * 32 * 8 && texels.iter().any(|&byte| byte != 0)));
}

#[test]
fn cancelling_leaves_the_world_as_it_was() {
    let mut app = cornell(&data(""));
    let before = snapshot(app.world_mut());
    app.world_mut().trigger(BakeLightmaps { goal: BakeGoal::Samples(1 << 24), ..small() });
    app.update();
    // A second bake is refused while this one runs.
    app.world_mut().trigger(small());
    app.world_mut().flush();
    assert!(app.world().resource::<Heard>().failed[0].reason.contains("a bake is running"));
    app.world_mut().trigger(CancelBake);
    run_until(&mut app, "the end of the bake", |world| world.resource::<Heard>().failed.len() == 2);
    let heard = app.world().resource::<Heard>();
    assert!(heard.failed[1].cancelled && heard.finished.is_empty());
    assert_eq!(snapshot(app.world_mut()), before);
    // And the kiln takes the next one.
    app.world_mut().resource_mut::<Heard>().failed.clear();
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
}

#[test]
fn a_bake_that_cannot_be_says_why_and_changes_nothing() {
    let mut app = cornell(&data(""));
    let before = snapshot(app.world_mut());
    app.world_mut().trigger(BakeLightmaps { density: -1.0, ..small() });
    run_until(&mut app, "the refusal", |world| !world.resource::<Heard>().failed.is_empty());
    let heard = app.world().resource::<Heard>();
    assert!(heard.failed[0].reason.contains("density") && !heard.failed[0].cancelled, "{:?}", heard.failed);
    assert_eq!(snapshot(app.world_mut()), before);
}

#[test]
fn nothing_is_lit_twice_and_clearing_restores_everything() {
    let mut app = lit_floor();
    let before = snapshot(app.world_mut());
    let scene = SceneSettings { ambient: AmbientMode::Bake, ..default() };
    app.world_mut().trigger(BakeLightmaps { scene: scene.clone(), ..small() });
    run_until_baked(&mut app, 1);
    let world = app.world_mut();
    assert_eq!(world.query::<&RectLight>().single(world).unwrap().intensity, 0.0);
    assert!(!world.resource::<GlobalAmbientLight>().affects_lightmapped_meshes);
    assert_eq!(count::<Lightmap>(world), 1);
    // A second bake sees the light that the first one has turned down.
    app.world_mut().trigger(BakeLightmaps { scene, seed: 1, ..small() });
    let second = run_until_baked(&mut app, 2);
    assert_eq!(second.lightmap.baked_lights.len(), 1);
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    assert_eq!(snapshot(app.world_mut()), before);
}

#[test]
fn a_second_bake_of_the_same_size_shows_in_the_same_texture() {
    let mut app = lit_floor();
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
    let image = |app: &mut App| {
        let world = app.world_mut();
        world.query::<&Lightmap>().single(world).unwrap().image.id()
    };
    let (first_image, first) = (image(&mut app), texels(app.world_mut()));
    app.world_mut().trigger(BakeLightmaps { seed: 7, ..small() });
    run_until_baked(&mut app, 2);
    assert_eq!(image(&mut app), first_image);
    assert_ne!(texels(app.world_mut()), first);
}

#[test]
fn a_second_bake_of_another_size_goes_on_once_the_first_is_off_the_screen() {
    let mut app = lit_floor();
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
    app.world_mut().trigger(BakeLightmaps { layout: LightmapLayout::Shared { size: 16 }, ..small() });
    run_until_baked(&mut app, 2);
    // Bevy never sees another image on an entity that has one; there must be frames without.
    assert_eq!(count::<Lightmap>(app.world_mut()), 0);
    let mut frames = 0;
    run_until(&mut app, "the new lightmap", |world| {
        frames += 1;
        count::<Lightmap>(world) == 1
    });
    assert!(frames >= 3, "{frames}");
    assert!(texels(app.world_mut()).values().all(|texels| texels.len() == 16 * 16 * 8));
}

#[test]
fn each_step_touches_the_material_in_its_own_frame() {
    #[derive(Resource, Default)]
    struct Seen(Vec<(bool, bool)>);
    type Drawn<'a> = (Has<Lightmap>, Ref<'a, MeshMaterial3d<StandardMaterial>>);
    // Where Bevy itself looks for what it must draw otherwise.
    fn watch(drawn: Query<Drawn>, mut seen: ResMut<Seen>) {
        seen.0.extend(drawn.iter().map(|(has, material)| (has, material.is_changed())));
    }
    let mut app = lit_floor();
    app.init_resource::<Seen>().add_systems(PostUpdate, watch);
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
    app.world_mut().trigger(BakeLightmaps { layout: LightmapLayout::Shared { size: 16 }, ..small() });
    run_until_baked(&mut app, 2);
    run_until(&mut app, "the new lightmap", |world| count::<Lightmap>(world) == 1);
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    app.update();
    let seen = std::mem::take(&mut app.world_mut().resource_mut::<Seen>().0);
    let changes = seen.windows(2).filter(|pair| pair[0].0 != pair[1].0).count();
    assert_eq!(changes, 4, "on, off, on, off");
    assert!(seen.windows(2).all(|pair| pair[0].0 == pair[1].0 || pair[1].1), "{seen:?}");
}

#[test]
fn marks_say_what_receives_and_what_takes_part() {
    let mut app = cornell(&data(""));
    let by_name = |world: &mut World, wanted: &str| {
        let mut names = world.query::<(Entity, &Name)>();
        names.iter(world).find(|(_, name)| name.as_str() == wanted).unwrap().0
    };
    let roles = |world: &mut World| -> BTreeMap<String, Option<Option<f32>>> {
        let instances = extract_scene(world, &SceneSettings::default()).scene.instances;
        instances.into_iter().map(|i| (i.name, i.lightmap.map(|request| request.density))).collect()
    };
    let world = app.world_mut();
    assert!(roles(world).values().all(|role| *role == Some(None)) && roles(world).len() == 8);
    let block = by_name(world, "tall_block");
    world.entity_mut(block).insert(LightBlocker);
    assert_eq!(roles(world)["cornell/tall_block/tall_block.white"], None);
    assert_eq!(roles(world).len(), 8);
    let floor = by_name(world, "floor");
    world.entity_mut(floor).insert(LightmapReceiver { density: Some(3.0) });
    let expected: BTreeMap<String, Option<Option<f32>>> = [
        ("cornell/floor/floor.white".to_owned(), Some(Some(3.0))),
        ("cornell/tall_block/tall_block.white".to_owned(), None),
    ]
    .into();
    assert_eq!(roles(world), expected);
}

#[test]
fn what_cannot_be_read_is_named_and_the_rest_goes_on() {
    use bevy::asset::RenderAssetUsages;
    use bevy::mesh::PrimitiveTopology;
    fn spawn(
        mut commands: Commands,
        mut meshes: ResMut<Assets<Mesh>>,
        mut materials: ResMut<Assets<StandardMaterial>>,
        mut images: ResMut<Assets<Image>>,
    ) {
        let material = MeshMaterial3d(materials.add(StandardMaterial {
            anisotropy_strength: 0.5,
            depth_map: Some(images.add(Image::default())),
            ..default()
        }));
        let mut gone = Mesh::from(Cuboid::default());
        gone.take_gpu_data().unwrap();
        commands.spawn((Name::new("gone"), Mesh3d(meshes.add(gone)), material.clone()));
        let lines = Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::default());
        commands.spawn((Name::new("lines"), Mesh3d(meshes.add(lines)), material.clone()));
        commands.spawn((Name::new("bare"), Mesh3d(meshes.add(Cuboid::default()))));
        commands.spawn((Name::new("wood"), Mesh3d(meshes.add(Sphere::default())), material));
    }
    let mut app = lit_floor();
    app.world_mut().run_system_once(spawn).unwrap();
    app.update();
    let Extraction { scene, warnings, .. } = extract_scene(app.world_mut(), &SceneSettings::default());
    let names: Vec<&str> = scene.instances.iter().map(|instance| instance.name.as_str()).collect();
    assert_eq!(names, ["bare", "floor", "wood"]);
    let warnings: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    for sentence in [
        "\"gone\" is in the render world only",
        "\"lines\" is made of LineList",
        "\"bare\" has no StandardMaterial",
        "material \"wood\" has what is not simulated: depth map (taken as flat), anisotropy",
        "the ambient light (80 cd/m²)",
    ] {
        assert_eq!(warnings.iter().filter(|warning| warning.contains(sentence)).count(), 1, "{sentence}: {warnings:?}");
    }
    assert_eq!(warnings.len(), 5, "{warnings:?}");
}

#[test]
fn the_game_and_the_command_line_bake_the_same_bits_and_a_shipped_game_shows_them() {
    let folder = temp_dir::TempDir::new().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_kiln"));
    command.arg("bake").arg(data("cornell.glb")).arg("-o").arg(folder.path().join("baked"));
    command.args(["--layout", "shared", "--size", "32", "--spp", "16", "--emissive", "nits", "--format", "rgba16f"]);
    let output = command.args(["--threads", "1"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    let mut game = cornell(&data(""));
    game.world_mut().trigger(BakeLightmaps { threads: 2, ..small() });
    run_until_baked(&mut game, 1);
    let baked_in_game = texels(game.world_mut());

    std::fs::copy(data("cornell.glb"), folder.path().join("cornell.glb")).unwrap();
    let mut shipped = cornell(folder.path());
    let baked: Handle<BakedFolder> = shipped.world().resource::<AssetServer>().load("baked/kiln.ron");
    let world = shipped.world_mut();
    let root = world.query_filtered::<Entity, With<WorldAssetRoot>>().single(world).unwrap();
    world.entity_mut(root).insert(BakedLightmaps(baked.clone()));
    run_until(&mut shipped, "the folder", |world| {
        world.resource::<AssetServer>().is_loaded_with_dependencies(&baked) && count::<Lightmap>(world) == 7
    });
    assert_eq!(texels(shipped.world_mut()), baked_in_game);
    // KTX2 holds no sampler, and a game of blocks may have made `nearest` its default.
    let world = shipped.world_mut();
    let mut shown = world.query::<&Lightmap>();
    let images = world.resource::<Assets<Image>>();
    for lightmap in shown.iter(world) {
        let ImageSampler::Descriptor(sampler) = &images.get(&lightmap.image).unwrap().sampler else { panic!() };
        let filters = [sampler.mag_filter, sampler.min_filter].map(|filter| format!("{filter:?}"));
        assert_eq!(filters, ["Linear", "Linear"]);
    }

    let world = shipped.world_mut();
    world.entity_mut(root).remove::<BakedLightmaps>();
    shipped.update();
    assert_eq!(count::<Lightmap>(shipped.world_mut()), 0);
}

#[test]
fn the_snapshot_is_the_scene_that_the_core_bakes() {
    let mut app = cornell(&data(""));
    let settings = small();
    let scene = extract_scene(app.world_mut(), &settings.scene).scene;
    let core = bake_lightmap(&scene, &settings.bake_settings(), &(), &bevy_kiln::bake::CancelToken::default()).unwrap();
    app.world_mut().trigger(settings);
    let finished = run_until_baked(&mut app, 1);
    assert_eq!(finished.lightmap.pages, core.pages);
    assert_eq!(finished.lightmap.placements, core.placements);
}

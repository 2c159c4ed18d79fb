//! Meshes that a bake laid out anew, in a game that shows the baked folder: on, shared, off again, and refused where
//! they are not the ones that were baked.

use super::{app, count, run_until, run_until_baked, small, texels};
use bevy::asset::LoadState;
use bevy::ecs::system::RunSystemOnce;
use bevy::light::RectLight;
use bevy::mesh::{Indices, VertexAttributeValues};
use bevy::pbr::Lightmap;
use bevy::prelude::*;
use bevy_kiln::artefact::{MESHES_FILE, StableId};
use bevy_kiln::bake::{self, BakeReport, LaidOutMesh, Page};
use bevy_kiln::output::{OutputFormat, write_lightmap};
use bevy_kiln::plugin::extract_scene;
use bevy_kiln::prelude::*;
use std::path::Path;
use temp_dir::TempDir;

/// Two crates of one mesh, a floor with a UV1 of its own, and the root above them.
fn spawn(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let material = MeshMaterial3d(materials.add(StandardMaterial::default()));
    let crate_mesh = meshes.add(Cuboid::default());
    let floor = Mesh::from(Plane3d::default().mesh().size(2.0, 2.0));
    let uv = floor.attribute(Mesh::ATTRIBUTE_UV_0).unwrap().clone();
    let floor = meshes.add(floor.with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, uv));
    let root = commands.spawn((Name::new("room"), Transform::default(), Visibility::default())).id();
    for (name, mesh) in [("east", crate_mesh.clone()), ("west", crate_mesh), ("floor", floor)] {
        commands.spawn((Name::new(name), Mesh3d(mesh), material.clone(), ChildOf(root)));
    }
}

fn game(folder: &Path) -> App {
    let mut app = app(folder);
    app.world_mut().run_system_once(spawn).unwrap();
    app.update();
    app
}

/// The crates' mesh with every triangle on its own, as a bake might have it; `shift` makes it another one.
fn apart(app: &mut App, shift: f32) -> LaidOutMesh {
    let scene = extract_scene(app.world_mut(), &SceneSettings::default()).scene;
    let east = scene.instances.iter().find(|instance| instance.name == "room/east").unwrap();
    let mesh = &scene.meshes[east.mesh];
    let vertices: Vec<u32> = mesh.triangles().flatten().collect();
    let corners = vertices.len() as u32;
    LaidOutMesh {
        source: east.mesh,
        hash: mesh.hash(),
        uv1: (0..corners).map(|corner| Vec2::new(corner as f32 / corners as f32, shift)).collect(),
        indices: (0..corners).collect(),
        vertices,
        charts: corners / 3,
        ..LaidOutMesh::default()
    }
}

/// Writes a folder in which both crates show `mesh`, and the floor its own.
fn write(dir: &Path, mesh: LaidOutMesh) {
    let texels = 8 * 4;
    let page = Page {
        width: 8,
        height: 4,
        radiance: vec![Vec3::ONE; texels],
        coverage: vec![1.0; texels],
        raw: vec![Vec3::ONE; texels],
        stderr: vec![Vec3::ZERO; texels],
        ..Page::default()
    };
    let placement = |name: &str, mesh| bake::Placement {
        id: StableId::new(format!("room/{name}")),
        page: 0,
        uv_min: [0.0, 0.0],
        uv_max: [0.5, 1.0],
        mesh,
    };
    let lightmap = bake::Lightmap {
        pages: vec![page],
        placements: vec![placement("east", Some(0)), placement("floor", None), placement("west", Some(0))],
        meshes: vec![mesh],
        baked_lights: Vec::new(),
        report: BakeReport::default(),
    };
    write_lightmap(&lightmap, "room", dir, OutputFormat::Rgb9e5).unwrap();
}

fn entity(app: &mut App, name: &str) -> Entity {
    let world = app.world_mut();
    let mut names = world.query::<(Entity, &Name)>();
    names.iter(world).find(|(_, found)| found.as_str() == name).unwrap().0
}

fn mesh_of(app: &mut App, name: &str) -> Handle<Mesh> {
    let entity = entity(app, name);
    app.world().get::<Mesh3d>(entity).unwrap().0.clone()
}

fn show(app: &mut App, folder: &'static str) -> Handle<BakedFolder> {
    let baked: Handle<BakedFolder> = app.world().resource::<AssetServer>().load(folder);
    let root = entity(app, "room");
    app.world_mut().entity_mut(root).insert(BakedLightmaps(baked.clone()));
    baked
}

fn run_until_found(app: &mut App, things: usize) {
    run_until(app, "the folder", |world| {
        world.query::<&bevy_kiln::plugin::AppliedLightmaps>().single(world).is_ok_and(|applied| applied.len() == things)
    });
}

#[test]
fn a_shipped_game_wears_the_meshes_of_its_bake_and_gets_its_own_back() {
    let folder = TempDir::new().unwrap();
    let mut app = game(folder.path());
    let layout = apart(&mut app, 0.25);
    write(&folder.path().join("baked"), layout.clone());
    let before = ["east", "west", "floor"].map(|name| mesh_of(&mut app, name));
    let meshes_before = app.world().resource::<Assets<Mesh>>().len();
    show(&mut app, "baked/kiln.ron");
    run_until_found(&mut app, 3);

    let [east, west, floor] = ["east", "west", "floor"].map(|name| mesh_of(&mut app, name));
    assert_eq!(count::<Lightmap>(app.world_mut()), 3);
    assert_eq!(floor, before[2], "it has a UV1 of its own");
    assert_eq!(east, west, "one copy for both");
    assert_ne!(east, before[0]);
    let meshes = app.world().resource::<Assets<Mesh>>();
    assert_eq!(meshes.len(), meshes_before + 1);
    let (own, worn) = (meshes.get(&before[0]).unwrap(), meshes.get(&east).unwrap());
    assert_eq!(worn.count_vertices(), 36);
    assert_eq!(worn.indices(), Some(&Indices::U16((0..36).collect())));
    let uv1: Vec<[f32; 2]> = layout.uv1.iter().map(Vec2::to_array).collect();
    assert_eq!(worn.attribute(Mesh::ATTRIBUTE_UV_1), Some(&VertexAttributeValues::Float32x2(uv1)));
    let positions = |mesh: &Mesh| mesh.attribute(Mesh::ATTRIBUTE_POSITION).unwrap().as_float3().unwrap().to_vec();
    let (own, worn) = (positions(own), positions(worn));
    assert!(layout.vertices.iter().zip(&worn).all(|(&vertex, position)| own[vertex as usize] == *position));

    let root = entity(&mut app, "room");
    app.world_mut().entity_mut(root).remove::<BakedLightmaps>();
    app.update();
    assert_eq!(count::<Lightmap>(app.world_mut()), 0);
    assert_eq!(["east", "west", "floor"].map(|name| mesh_of(&mut app, name)), before);
    drop((east, west));
    run_until(&mut app, "the copy's end", |world| world.resource::<Assets<Mesh>>().len() == meshes_before);
}

#[test]
fn a_later_bake_reads_the_meshes_as_they_were() {
    let folder = TempDir::new().unwrap();
    let mut app = game(folder.path());
    let layout = apart(&mut app, 0.25);
    write(&folder.path().join("baked"), layout.clone());
    let snapshot = |app: &mut App| format!("{:?}", extract_scene(app.world_mut(), &SceneSettings::default()).scene);
    let before = snapshot(&mut app);
    let own = mesh_of(&mut app, "east");
    show(&mut app, "baked/kiln.ron");
    run_until_found(&mut app, 3);
    assert_ne!(mesh_of(&mut app, "east"), own);
    assert_eq!(snapshot(&mut app), before);
    assert_eq!(apart(&mut app, 0.25), layout);
}

#[test]
fn another_folder_brings_another_layout_of_the_same_mesh() {
    let folder = TempDir::new().unwrap();
    let mut app = game(folder.path());
    let [first, second] = [0.25, 0.75].map(|shift| apart(&mut app, shift));
    write(&folder.path().join("day"), first);
    let layout = second.clone();
    write(&folder.path().join("night"), second);
    let own = mesh_of(&mut app, "east");
    show(&mut app, "day/kiln.ron");
    run_until_found(&mut app, 3);
    let day = mesh_of(&mut app, "east");
    let night = show(&mut app, "night/kiln.ron");
    run_until(&mut app, "the other folder", |world| {
        world.resource::<AssetServer>().is_loaded_with_dependencies(&night) && count::<Lightmap>(world) == 3
    });
    run_until_found(&mut app, 3);
    let shown = mesh_of(&mut app, "east");
    assert!(shown != day && shown != own);
    let uv1: Vec<[f32; 2]> = layout.uv1.iter().map(Vec2::to_array).collect();
    let meshes = app.world().resource::<Assets<Mesh>>();
    let shown = meshes.get(&shown).unwrap().attribute(Mesh::ATTRIBUTE_UV_1);
    assert_eq!(shown, Some(&VertexAttributeValues::Float32x2(uv1)));
    let root = entity(&mut app, "room");
    app.world_mut().entity_mut(root).remove::<BakedLightmaps>();
    app.update();
    assert_eq!(mesh_of(&mut app, "east"), own);
}

#[test]
fn a_mesh_that_changed_since_its_bake_shows_no_lightmap() {
    let folder = TempDir::new().unwrap();
    let mut app = game(folder.path());
    write(&folder.path().join("baked"), apart(&mut app, 0.25));
    let (own, west) = (mesh_of(&mut app, "east"), entity(&mut app, "west"));
    // The artist has made one of the crates higher.
    let higher = app.world_mut().resource_mut::<Assets<Mesh>>().add(Cuboid::new(1.0, 2.0, 1.0));
    app.world_mut().entity_mut(west).insert(Mesh3d(higher.clone()));
    show(&mut app, "baked/kiln.ron");
    run_until_found(&mut app, 3);
    assert_eq!(count::<Lightmap>(app.world_mut()), 2);
    assert!(app.world().get::<Lightmap>(west).is_none());
    assert_eq!(mesh_of(&mut app, "west"), higher);
    assert_ne!(mesh_of(&mut app, "east"), own);
}

#[test]
fn a_mesh_that_is_not_loaded_yet_is_waited_for() {
    let folder = TempDir::new().unwrap();
    let mut app = game(folder.path());
    write(&folder.path().join("baked"), apart(&mut app, 0.25));
    let (own, west) = (mesh_of(&mut app, "east"), entity(&mut app, "west"));
    let meshes = app.world_mut().resource_mut::<Assets<Mesh>>();
    let late = meshes.reserve_handle();
    let same = meshes.get(&own).unwrap().clone();
    app.world_mut().entity_mut(west).insert(Mesh3d(late.clone()));
    show(&mut app, "baked/kiln.ron");
    run_until_found(&mut app, 2);
    app.update();
    assert_eq!(mesh_of(&mut app, "west"), late);
    app.world_mut().resource_mut::<Assets<Mesh>>().insert(&late, same).unwrap();
    run_until_found(&mut app, 3);
    assert!(app.world().get::<Lightmap>(west).is_some());
    assert_ne!(mesh_of(&mut app, "west"), late);
}

#[test]
fn a_damaged_or_missing_file_of_meshes_is_named() {
    let folder = TempDir::new().unwrap();
    let mut app = game(folder.path());
    let layout = apart(&mut app, 0.25);
    for name in ["cut", "gone"] {
        write(&folder.path().join(name), layout.clone());
    }
    let cut = folder.path().join("cut").join(MESHES_FILE);
    let bytes = std::fs::read(&cut).unwrap();
    std::fs::write(&cut, &bytes[..bytes.len() / 2]).unwrap();
    std::fs::remove_file(folder.path().join("gone").join(MESHES_FILE)).unwrap();
    for (path, sentence) in
        [("cut/kiln.ron", "meshes.kiln is cut off or damaged"), ("gone/kiln.ron", "meshes.kiln cannot be read")]
    {
        let baked = show(&mut app, path);
        run_until(&mut app, "the refusal", |world| world.resource::<AssetServer>().load_state(&baked).is_failed());
        let state = app.world().resource::<AssetServer>().load_state(&baked);
        let LoadState::Failed(error) = state else { panic!("{state:?}") };
        assert!(error.to_string().contains(sentence), "{error}");
        assert_eq!(count::<Lightmap>(app.world_mut()), 0);
    }
}

/// A lamp above the room, which is left where it was.
fn light_up(app: &mut App) {
    let down = Transform::from_xyz(0.0, 3.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::X);
    app.world_mut().spawn((Name::new("lamp"), RectLight { intensity: 100.0, ..default() }, down));
    app.update();
}

/// What the mesh that an entity shows is made of.
fn shape_of(app: &mut App, name: &str) -> Mesh {
    let mesh = mesh_of(app, name);
    app.world().resource::<Assets<Mesh>>().get(&mesh).unwrap().clone()
}

#[test]
fn baking_twice_gives_the_same_bits_and_a_shipped_game_shows_the_same_meshes() {
    let asked = || BakeLightmaps { layout: LightmapLayout::Packed, density: 4.0, ..small() };
    let folder = TempDir::new().unwrap();
    let mut app = game(folder.path());
    light_up(&mut app);
    let own = ["east", "west", "floor"].map(|name| mesh_of(&mut app, name));
    app.world_mut().trigger(asked());
    let first = run_until_baked(&mut app, 1);
    assert_eq!(first.entities, 3);
    let worn = mesh_of(&mut app, "east");
    assert!(worn != own[0] && worn == mesh_of(&mut app, "west"));

    app.world_mut().trigger(asked());
    let second = run_until_baked(&mut app, 2);
    assert_eq!(second.lightmap.pages, first.lightmap.pages);
    assert_eq!(second.lightmap.meshes, first.lightmap.meshes);
    assert_eq!(mesh_of(&mut app, "east"), worn, "the same mesh needs no other copy");

    write_lightmap(&first.lightmap, "room", &folder.path().join("baked"), OutputFormat::Rgba16f).unwrap();
    let mut shipped = game(folder.path());
    show(&mut shipped, "baked/kiln.ron");
    run_until_found(&mut shipped, 3);
    for name in ["east", "west", "floor"] {
        assert_eq!(shape_of(&mut shipped, name), shape_of(&mut app, name), "{name}");
    }
    let shown = |app: &mut App| texels(app.world_mut());
    run_until(&mut shipped, "the textures", |world| {
        let mut lightmaps = world.query::<&Lightmap>();
        lightmaps.iter(world).all(|lightmap| world.resource::<Assets<Image>>().contains(&lightmap.image))
    });
    assert_eq!(shown(&mut shipped), shown(&mut app));

    app.world_mut().trigger(ClearLightmaps);
    app.update();
    assert_eq!(["east", "west", "floor"].map(|name| mesh_of(&mut app, name)), own);
    assert_eq!(count::<Lightmap>(app.world_mut()), 0);
}

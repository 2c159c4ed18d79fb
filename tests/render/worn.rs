//! A baked folder on things without a UV1, drawn: their meshes change under the renderer, the texels come from a
//! compressed texture, and all of it goes again.

use crate::renderer::{EXPOSURE, Screen, app, show, spawn_camera};
use bevy::ecs::system::RunSystemOnce;
use bevy::prelude::*;
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeReport, LaidOutMesh, Lightmap, Page, Placement};
use bevy_kiln::output::{OutputFormat, write_lightmap};
use bevy_kiln::plugin::extract_scene;
use bevy_kiln::prelude::*;
use std::path::Path;
use temp_dir::TempDir;

/// Rows of 32 pixels of 8 bytes need no padding.
const WIDTH: u32 = 32;
const HEIGHT: u32 = 8;

/// What the two halves of the page hold [cd/m²].
const DARK: Vec3 = Vec3::new(1.0, 0.5, 0.25);
const BRIGHT: Vec3 = Vec3::new(2.0, 4.0, 1.0);

#[test]
fn worn_meshes_are_drawn_with_the_texels_of_their_bake() {
    let Some(mut app) = app() else { return };
    app.world_mut().run_system_once(spawn).unwrap();
    let above = Transform::from_xyz(0.0, 3.0, 0.0).looking_to(Vec3::NEG_Y, Vec3::NEG_Z);
    spawn_camera(app.world_mut(), [WIDTH, HEIGHT], 2.0 * (0.4f32 / 3.0).atan(), above);
    show(&mut app);
    check(&app, "before", [Vec3::ZERO; 2]);

    for format in [OutputFormat::Rgba16f, OutputFormat::Bc6h] {
        let folder = TempDir::new().unwrap();
        write(&mut app, folder.path(), format);
        let path = folder.path().join("kiln.ron");
        let baked: Handle<BakedFolder> = app.world().resource::<AssetServer>().load(path);
        let root = root(&mut app);
        app.world_mut().entity_mut(root).insert(BakedLightmaps(baked.clone()));
        for frame in 0.. {
            show(&mut app);
            if app.world().resource::<AssetServer>().is_loaded_with_dependencies(&baked) {
                break;
            }
            assert!(frame < 1000, "the folder does not load");
        }
        show(&mut app);
        check(&app, &format!("{format}"), [DARK, BRIGHT]);
        app.world_mut().entity_mut(root).remove::<BakedLightmaps>();
        show(&mut app);
        check(&app, "taken off", [Vec3::ZERO; 2]);
    }
}

/// Two squares of floor without UV1, side by side, of one mesh.
fn spawn(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    let mesh = meshes.add(Plane3d::default().mesh().size(2.0, 2.0));
    let material = materials.add(StandardMaterial { base_color: Color::WHITE, reflectance: 0.0, ..default() });
    let root = commands.spawn((Name::new("room"), Transform::default(), Visibility::default())).id();
    for (name, x) in [("left", -1.0), ("right", 1.0)] {
        let place = Transform::from_xyz(x, 0.0, 0.0);
        commands.spawn((Name::new(name), Mesh3d(mesh.clone()), MeshMaterial3d(material.clone()), place, ChildOf(root)));
    }
}

fn root(app: &mut App) -> Entity {
    let world = app.world_mut();
    world.query_filtered::<Entity, (With<Name>, With<Children>)>().single(world).unwrap()
}

/// A folder with a page of two halves, one for each square, and both triangles of the squares on their own.
fn write(app: &mut App, dir: &Path, format: OutputFormat) {
    let scene = extract_scene(app.world_mut(), &SceneSettings::default()).scene;
    assert_eq!(scene.meshes.len(), 1);
    let mesh = &scene.meshes[0];
    let vertices: Vec<u32> = mesh.triangles().flatten().collect();
    let laid_out = LaidOutMesh {
        source: 0,
        hash: mesh.hash(),
        // Far from the other half, whose texels a filter would mix in.
        uv1: vertices.iter().map(|&vertex| 0.25 + 0.5 * mesh.uv0.as_ref().unwrap()[vertex as usize]).collect(),
        indices: (0..vertices.len() as u32).collect(),
        vertices,
        charts: 2,
        ..LaidOutMesh::default()
    };
    let texels: Vec<Vec3> = (0..32 * 16).map(|at| if at % 32 < 16 { DARK } else { BRIGHT }).collect();
    let page = Page {
        width: 32,
        height: 16,
        coverage: vec![1.0; texels.len()],
        raw: texels.clone(),
        stderr: vec![Vec3::ZERO; texels.len()],
        radiance: texels,
        ..Page::default()
    };
    let placement = |name: &str, u: f32| Placement {
        id: StableId::new(format!("room/{name}")),
        page: 0,
        uv_min: [u, 0.0],
        uv_max: [u + 0.5, 1.0],
        mesh: Some(0),
    };
    let lightmap = Lightmap {
        pages: vec![page],
        placements: vec![placement("left", 0.0), placement("right", 0.5)],
        meshes: vec![laid_out],
        baked_lights: Vec::new(),
        report: BakeReport::default(),
    };
    write_lightmap(&lightmap, "room", dir, format).unwrap();
}

fn check(app: &App, when: &str, texels: [Vec3; 2]) {
    let screen = &app.world().resource::<Screen>().0;
    assert_eq!(screen.len(), (WIDTH * HEIGHT) as usize, "{when}: nothing was read back");
    for (x, texel) in [WIDTH / 4, 3 * WIDTH / 4].into_iter().zip(texels) {
        let seen = screen[(HEIGHT / 2 * WIDTH + x) as usize];
        let expected = texel * EXPOSURE as f32;
        // The coarsest ends of blocks of one colour are within 0.4 %.
        assert!((seen - expected).abs().cmple(expected * 5e-3).all(), "{when}: {seen} for {expected}");
    }
}

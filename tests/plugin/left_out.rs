//! What a scene leaves out or freezes: skinned and morphed meshes, other render layers, Bevy's shadow flags.

use super::{app, data};
use bevy::camera::visibility::{RenderLayers, VisibilityRange};
use bevy::light::{NotShadowCaster, NotShadowReceiver, PointLight, TransmittedShadowReceiver};
use bevy::mesh::VertexAttributeValues;
use bevy::mesh::morph::{MeshMorphWeights, MorphAttributes, MorphWeights};
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::prelude::*;
use bevy_kiln::plugin::{Extraction, extract_scene};
use bevy_kiln::prelude::*;
use bevy_kiln::scene::{Alpha, Instance};
use std::f32::consts::FRAC_PI_2;

/// An app with a plain cube, and what `spawn` adds to it, as a bake reads it.
fn extract_as(settings: &SceneSettings, spawn: impl FnOnce(&mut World)) -> Extraction {
    let mut app = app(&data(""));
    app.insert_resource(GlobalAmbientLight::NONE);
    let cube = Mesh::from(Cuboid::default());
    thing(app.world_mut(), "cube", cube);
    spawn(app.world_mut());
    app.update();
    extract_scene(app.world_mut(), settings)
}

fn extract(spawn: impl FnOnce(&mut World)) -> Extraction {
    extract_as(&SceneSettings::default(), spawn)
}

/// Spawns a mesh with a material.
fn thing(world: &mut World, name: &'static str, mesh: Mesh) -> Entity {
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default());
    world.spawn((Name::new(name), Mesh3d(mesh), MeshMaterial3d(material))).id()
}

fn names(extraction: &Extraction) -> Vec<&str> {
    extraction.scene.instances.iter().map(|instance| instance.name.as_str()).collect()
}

fn said(extraction: &Extraction) -> Vec<String> {
    extraction.warnings.iter().map(ToString::to_string).collect()
}

fn instance<'a>(extraction: &'a Extraction, name: &str) -> &'a Instance {
    extraction.scene.instances.iter().find(|instance| instance.name == name).unwrap()
}

/// Positions and normals in the world.
fn in_world(extraction: &Extraction, name: &str) -> Vec<(Vec3, Vec3)> {
    let instance = instance(extraction, name);
    let mesh = &extraction.scene.meshes[instance.mesh];
    let normals = mesh.normals.as_ref().unwrap();
    let world = instance.world_from_local;
    let directions = world.matrix3.inverse().transpose();
    let of =
        |(position, normal): (&Vec3, &Vec3)| (world.transform_point3(*position), (directions * *normal).normalize());
    mesh.positions.iter().zip(normals).map(of).collect()
}

fn assert_close(found: &[(Vec3, Vec3)], expected: &[(Vec3, Vec3)]) {
    assert_eq!(found.len(), expected.len());
    for ((position, normal), (place, up)) in found.iter().zip(expected) {
        assert!(position.distance(*place) < 1e-5, "{position} for {place}");
        assert!(normal.distance(*up) < 1e-5, "{normal} for {up}");
    }
}

/// A triangle in the plane z = 0, whose vertices hang on the first joint, the second, and both alike.
fn triangle() -> Mesh {
    let positions = vec![[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 0.0]];
    Mesh::new(bevy::mesh::PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0, 0.0, 1.0]; 3])
}

/// The triangle on two joints: the first stands at (10, 0, 0), the second above it at y = 1, bent by a right angle
/// about Z.
fn bent(world: &mut World, bindposes: usize) -> Entity {
    let weights = vec![[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0]];
    let joints = vec![[0, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]];
    let mesh = triangle()
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_INDEX, VertexAttributeValues::Uint16x4(joints))
        .with_inserted_attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT, weights);
    let root = world.spawn((Transform::from_xyz(10.0, 0.0, 0.0), Visibility::default())).id();
    let turn = Quat::from_rotation_z(FRAC_PI_2);
    let upper = world.spawn((Transform::from_xyz(0.0, 1.0, 0.0).with_rotation(turn), ChildOf(root))).id();
    let mut poses = vec![Mat4::IDENTITY, Mat4::from_translation(Vec3::NEG_Y)];
    poses.truncate(bindposes);
    let poses = SkinnedMeshInverseBindposes::from(poses);
    let inverse_bindposes = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>().add(poses);
    let body = thing(world, "body", mesh);
    // As in Bevy, where the mesh itself stands does not count.
    let elsewhere = Transform::from_xyz(0.0, 0.0, 77.0);
    world.entity_mut(body).insert((SkinnedMesh { inverse_bindposes, joints: vec![root, upper] }, elsewhere));
    body
}

#[test]
fn what_is_skinned_or_morphed_is_left_out_by_name_unless_marked() {
    let found = extract(|world| {
        bent(world, 2);
        let face = thing(world, "face", triangle());
        world.entity_mut(face).insert(MeshMorphWeights::Value { weights: vec![0.0] });
    });
    assert_eq!(names(&found), ["cube"]);
    let sentence = |name: &str, how: &str| {
        format!(
            "mesh \"{name}\" is {how}, so it is left out, as what moves should be; mark it as a LightBlocker to bake \
             it as it stands"
        )
    };
    assert_eq!(said(&found), [sentence("body", "skinned"), sentence("face", "morphed")]);
}

#[test]
fn a_marked_skinned_mesh_blocks_light_in_its_pose() {
    let found = extract(|world| {
        let body = bent(world, 2);
        world.entity_mut(body).insert(LightBlocker);
    });
    assert_eq!(said(&found), [""; 0]);
    assert_eq!(instance(&found, "body").lightmap, None);
    // By hand: the first stays on its joint. The second is 1 above its joint, which turns up into -X. The third is
    // (1, 0) from its joint, which turns into (0, 1), so at (10, 2); the other has it at (11, 1); half way between.
    let expected = [(10.0, 0.0), (9.0, 1.0), (10.5, 1.5)].map(|(x, y)| (Vec3::new(x, y, 0.0), Vec3::Z));
    assert_close(&in_world(&found, "body"), &expected);
}

#[test]
fn below_a_receiver_it_is_posed_and_named() {
    let found = extract(|world| {
        let body = bent(world, 2);
        world.entity_mut(body).insert(LightmapReceiver::default());
    });
    assert_eq!(instance(&found, "body").lightmap, None);
    let sentence = "mesh \"body\" is skinned, so it gets no lightmap; it blocks and reflects light as it stands";
    assert_eq!(said(&found), [sentence]);
}

#[test]
fn a_broken_skin_is_named_and_left_out() {
    let found = extract(|world| {
        let body = bent(world, 1);
        world.entity_mut(body).insert(LightBlocker);
    });
    assert_eq!(names(&found), ["cube"]);
    let why = "mesh \"body\" has fewer bind poses than joints, so its pose is not known and it is left out";
    assert_eq!(said(&found), [why]);
}

#[test]
fn a_marked_morphed_mesh_blocks_light_in_its_shape() {
    let target = |by: Vec3, normal| [MorphAttributes::new(by, normal, Vec3::ZERO); 3];
    let targets = [target(Vec3::X, Vec3::ZERO), target(Vec3::new(0.0, 0.0, 4.0), Vec3::new(4.0, 0.0, 0.0))].concat();
    let found = extract(|world| {
        let mut mesh = triangle();
        mesh.set_morph_targets(targets);
        let face = thing(world, "face", mesh);
        let holder = world.spawn(MorphWeights::new(vec![1.0, 0.25], None).unwrap()).id();
        let raised = Transform::from_xyz(0.0, 5.0, 0.0);
        world.entity_mut(face).insert((MeshMorphWeights::Reference(holder), LightBlocker, raised));
    });
    assert_eq!(said(&found), [""; 0]);
    // By hand: 1 · (1, 0, 0) + ¼ · (0, 0, 4) on each, and 5 up; the normal is that of (0, 0, 1) + ¼ · (4, 0, 0).
    let slanted = Vec3::new(1.0, 0.0, 1.0).normalize();
    let expected = [(0.0, 0.0), (0.0, 2.0), (1.0, 1.0)].map(|(x, y)| (Vec3::new(x + 1.0, y + 5.0, 1.0), slanted));
    assert_close(&in_world(&found, "face"), &expected);
}

#[test]
fn weights_without_targets_are_named() {
    let found = extract(|world| {
        let face = thing(world, "face", triangle());
        world.entity_mut(face).insert((MeshMorphWeights::Value { weights: vec![1.0] }, LightBlocker));
    });
    let why =
        "mesh \"face\" has weights of morph targets and no morph targets, so its pose is not known and it is left out";
    assert_eq!(said(&found), [why]);
    assert_eq!(names(&found), ["cube"]);
}

/// A cube and a lamp on layer 3, and a cube on layers 0 and 3.
fn layered(world: &mut World) {
    for (name, layers) in [("weapon", RenderLayers::layer(3)), ("both", RenderLayers::from_layers(&[0, 3]))] {
        let entity = thing(world, name, Mesh::from(Cuboid::default()));
        world.entity_mut(entity).insert(layers);
    }
    world.spawn((Name::new("lamp"), PointLight::default(), RenderLayers::layer(3)));
}

#[test]
fn other_layers_are_left_out_by_name_unless_asked_for() {
    let left_out = |name: &str| {
        format!(
            "\"{name}\" is on render layers that are not baked, so it is left out; SceneSettings::layers says which are"
        )
    };
    let found = extract(layered);
    assert_eq!(names(&found), ["both", "cube"]);
    assert_eq!(found.scene.lights.len(), 0);
    assert_eq!(said(&found), [left_out("lamp"), left_out("weapon")]);

    let third = extract_as(&SceneSettings { layers: RenderLayers::layer(3), ..default() }, layered);
    assert_eq!(names(&third), ["both", "weapon"]);
    assert_eq!(third.scene.lights.len(), 1);
    assert_eq!(said(&third), [left_out("cube")]);
}

#[test]
fn light_passes_what_casts_no_shadow_and_the_other_flags_are_named() {
    let found = extract(|world| {
        let shade = thing(world, "shade", Mesh::from(Cuboid::default()));
        world.entity_mut(shade).insert(NotShadowCaster);
        let wall = thing(world, "wall", Mesh::from(Cuboid::default()));
        world.entity_mut(wall).insert((NotShadowReceiver, TransmittedShadowReceiver));
    });
    let alpha = |name| found.scene.materials[instance(&found, name).material].alpha;
    assert_eq!([alpha("cube"), alpha("shade"), alpha("wall")], [Alpha::Opaque, Alpha::Add, Alpha::Opaque]);
    assert_eq!(
        said(&found),
        [
            "mesh \"shade\" has NotShadowCaster: it is baked as if light passed through it, so it reflects none; what \
             glows still does",
            "mesh \"wall\" has NotShadowReceiver: baked light is in shadow there all the same",
            "mesh \"wall\" has TransmittedShadowReceiver: light is baked through it as its material says, without that \
             component",
        ]
    );
}

#[test]
fn of_the_levels_of_an_object_the_nearest_is_baked_and_the_others_are_named() {
    let found = extract(|world| {
        let from = [0.0..0.0, 20.0..25.0, 70.0..75.0];
        let to = [20.0..25.0, 70.0..75.0, 150.0..160.0];
        for ((name, start_margin), end_margin) in ["near", "far", "farther"].into_iter().zip(from).zip(to) {
            let level = thing(world, name, Mesh::from(Cuboid::default()));
            world.entity_mut(level).insert(VisibilityRange { start_margin, end_margin, use_aabb: false });
        }
    });
    assert_eq!(names(&found), ["cube", "near"]);
    assert!(instance(&found, "near").lightmap.is_some());
    assert!(found.has_movers, "without a lightmap they need a volume");
    let sentence = |name: &str, metres: u32| {
        format!(
            "mesh \"{name}\" is shown from {metres} m on only (VisibilityRange), so it is left out, as the levels of \
             one object would shade each other; irradiance volumes light it (BakeVolumes), or let its nearest level be \
             seen from afar"
        )
    };
    assert_eq!(said(&found), [sentence("far", 20), sentence("farther", 70)]);
}

#[test]
fn what_is_hidden_is_named_by_what_hides_it() {
    let found = extract(|world| {
        let wing = world.spawn((Name::new("wing"), Transform::default(), Visibility::Hidden)).id();
        for name in ["table", "chair"] {
            let entity = thing(world, name, Mesh::from(Cuboid::default()));
            world.entity_mut(entity).insert(ChildOf(wing));
        }
        // What is to be seen whatever is above it takes part.
        let sign = thing(world, "sign", Mesh::from(Cuboid::default()));
        world.entity_mut(sign).insert((ChildOf(wing), Visibility::Visible));
        world.spawn((Name::new("lamp"), PointLight::default(), Visibility::Hidden));
        // Nobody asks for these.
        world.spawn((Name::new("torch"), PointLight::default(), Visibility::Hidden, LightBaking::RealTime));
        let mover = thing(world, "mover", Mesh::from(Cuboid::default()));
        world.entity_mut(mover).insert((NotBaked, Visibility::Hidden));
    });
    assert_eq!(names(&found), ["cube", "wing/sign"]);
    assert_eq!(found.scene.lights.len(), 0);
    assert!(!found.has_movers);
    let sentence = |name: &str, what: &str| {
        format!(
            "\"{name}\" is hidden (Visibility), so it is left out with what is below it ({what} in all); show it while \
             baking if it is a part of the scene"
        )
    };
    assert_eq!(said(&found), [sentence("lamp", "1 mesh or light"), sentence("wing", "2 meshes and lights")]);
}

//! Materials of the game's own: described to the baker, they take part like others; without, they are named.

use super::*;
use bevy::pbr::{ExtendedMaterial, Material, MaterialExtension};
use bevy::render::render_resource::AsBindGroup;
use bevy_kiln::scene::Material as Baked;

#[derive(Asset, AsBindGroup, TypePath, Clone, Default)]
struct Moss {}

impl MaterialExtension for Moss {}

type Mossy = ExtendedMaterial<StandardMaterial, Moss>;

#[derive(Asset, AsBindGroup, TypePath, Clone)]
struct Hologram {
    #[uniform(0)]
    colour: LinearRgba,
}

impl Material for Hologram {}

const GREEN: Color = Color::linear_rgb(0.1, 0.6, 0.1);

/// A lit floor, a mossy wall of two stones with one material, and a hologram, as a game spawns them.
fn garden() -> App {
    let mut app = lit_floor();
    app.insert_resource(GlobalAmbientLight::NONE).init_asset::<Mossy>().init_asset::<Hologram>();
    let world = app.world_mut();
    let mut mesh = Mesh::from(Cuboid::default());
    let uv = mesh.attribute(Mesh::ATTRIBUTE_UV_0).unwrap().clone();
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_1, uv);
    let mesh = Mesh3d(world.resource_mut::<Assets<Mesh>>().add(mesh));
    let base = StandardMaterial { base_color: GREEN, reflectance: 0.0, ..default() };
    let moss = world.resource_mut::<Assets<Mossy>>().add(Mossy { base, extension: Moss {} });
    for (name, x) in [("stone", 3.0), ("stone b", 5.0)] {
        world.spawn((Name::new(name), mesh.clone(), MeshMaterial3d(moss.clone()), Transform::from_xyz(x, 0.0, 0.0)));
    }
    let colour = LinearRgba::rgb(0.0, 2.0, 4.0);
    let hologram = MeshMaterial3d(world.resource_mut::<Assets<Hologram>>().add(Hologram { colour }));
    world.spawn((Name::new("ghost"), mesh, hologram, LightBlocker, Transform::from_xyz(-3.0, 0.0, 0.0)));
    let marked: Vec<Entity> = world.query_filtered::<Entity, With<Mesh3d>>().iter(world).collect();
    for entity in marked {
        world.entity_mut(entity).insert_if_new(LightmapReceiver::default());
    }
    let ghost = world.query_filtered::<Entity, With<LightBlocker>>().single(world).unwrap();
    world.entity_mut(ghost).remove::<LightmapReceiver>();
    app.update();
    app
}

fn describe(app: &mut App) {
    app.add_baked_material(|moss: &Mossy| moss.base.clone()).add_baked_material(|hologram: &Hologram| {
        StandardMaterial { base_color: Color::BLACK, emissive: hologram.colour, ..default() }
    });
}

fn extracted(app: &mut App) -> (Extraction, Vec<String>) {
    let settings = SceneSettings { emissive: EmissiveUnit::Nits, ..default() };
    let found = extract_scene(app.world_mut(), &settings);
    let said = found.warnings.iter().map(ToString::to_string).collect();
    (found, said)
}

fn material<'a>(found: &'a Extraction, name: &str) -> &'a Baked {
    let instance = found.scene.instances.iter().find(|instance| instance.name == name).unwrap();
    &found.scene.materials[instance.material]
}

#[test]
fn described_materials_take_part_as_described() {
    let mut app = garden();
    describe(&mut app);
    let (found, said) = extracted(&mut app);
    assert_eq!(said, [""; 0]);
    assert_eq!(material(&found, "stone").base_colour, Vec4::new(0.1, 0.6, 0.1, 1.0));
    assert_eq!(material(&found, "ghost").emitted_radiance, Vec3::new(0.0, 2.0, 4.0));
    let of = |name: &str| found.scene.instances.iter().find(|instance| instance.name == name).unwrap().material;
    assert_eq!(of("stone"), of("stone b"), "one material is read once");
    app.world_mut().trigger(small());
    let baked = run_until_baked(&mut app, 1);
    assert_eq!(baked.entities, 3);
    let shown: Vec<String> = texels(app.world_mut()).into_keys().collect();
    assert_eq!(shown, ["floor", "stone", "stone b"]);
}

#[test]
fn without_a_description_they_are_named_and_the_sentence_says_how_to_give_one() {
    let mut app = garden();
    let (found, said) = extracted(&mut app);
    let sentence = |name: &str| {
        format!(
            "mesh \"{name}\" has no StandardMaterial, so it is taken as mid-grey and gets no lightmap; say what its \
             material looks like with App::add_baked_material, or mark it NotBaked if it is not part of the scene"
        )
    };
    assert_eq!(said, ["ghost", "stone", "stone b"].map(sentence));
    assert_eq!(material(&found, "stone").base_colour, Vec4::new(0.5, 0.5, 0.5, 1.0));
    assert!(found.scene.instances.iter().all(|instance| instance.lightmap.is_some() == (instance.name == "floor")));
}

#[test]
fn a_described_material_that_is_not_loaded_is_named() {
    let mut app = garden();
    describe(&mut app);
    let world = app.world_mut();
    let moss: Vec<_> = world.resource::<Assets<Mossy>>().ids().collect();
    for id in moss {
        world.resource_mut::<Assets<Mossy>>().remove(id);
    }
    let (_, said) = extracted(&mut app);
    assert_eq!(said, ["the material of \"stone\" is not loaded, so it is taken as mid-grey; bake once it is"]);
}

/// Bevy draws an entity anew only where it sees its material changed, of whichever kind that is.
#[test]
fn each_step_touches_a_material_of_the_games_own() {
    #[derive(Resource, Default)]
    struct Seen(Vec<(bool, bool)>);
    type Drawn<'a> = (Has<Lightmap>, Ref<'a, MeshMaterial3d<Mossy>>, &'a Name);
    fn watch(drawn: Query<Drawn>, mut seen: ResMut<Seen>) {
        let stone = drawn.iter().filter(|(.., name)| name.as_str() == "stone");
        seen.0.extend(stone.map(|(has, material, _)| (has, material.is_changed())));
    }
    let mut app = garden();
    describe(&mut app);
    app.init_resource::<Seen>().add_systems(PostUpdate, watch);
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
    app.world_mut().trigger(BakeLightmaps { layout: LightmapLayout::Shared { size: 16 }, ..small() });
    run_until_baked(&mut app, 2);
    run_until(&mut app, "the new lightmap", |world| count::<Lightmap>(world) == 3);
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    app.update();
    let seen = std::mem::take(&mut app.world_mut().resource_mut::<Seen>().0);
    let changes = seen.windows(2).filter(|pair| pair[0].0 != pair[1].0).count();
    assert_eq!(changes, 4, "on, off, on, off");
    assert!(seen.windows(2).all(|pair| pair[0].0 == pair[1].0 || pair[1].1), "{seen:?}");
}

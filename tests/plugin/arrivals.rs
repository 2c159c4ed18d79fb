//! What a game spawns after its folder is shown: found when it comes, or when it becomes what was baked, though other
//! things of the folder never come.

use super::shipping::{add_in_code, bake_in_game, room, run_until_shown, write};
use super::*;
use bevy::light::PointLight;
use temp_dir::TempDir;

#[test]
fn what_comes_late_is_found_though_others_never_come() {
    let folder = TempDir::new().unwrap();
    write(&folder, &room());
    bake_in_game(&folder, |world| {
        add_in_code(world);
        let statue = world.resource_mut::<Assets<Mesh>>().add(Sphere::new(0.2));
        let look = MeshMaterial3d(world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default()));
        world.spawn((Name::new("statue"), Mesh3d(statue), look, LightmapReceiver::default()));
    });

    let mut game = app(folder.path());
    let root = run_until_shown(&mut game, 1);
    let applied = |game: &App| game.world().get::<AppliedLightmaps>(root).unwrap().len();
    let pass = |game: &mut App| (0..3).for_each(|_| game.update());
    pass(&mut game);
    assert_eq!(applied(&game), 2, "the ground and its lamp");

    let mesh = game.world_mut().resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(2.0, 2.0));
    let material = game.world_mut().resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default());
    pass(&mut game);
    let stage = (Mesh3d(mesh), MeshMaterial3d(material), Transform::from_xyz(5.0, 0.0, 0.0));
    let stage = game.world_mut().spawn(stage).id();
    pass(&mut game);
    assert_eq!(applied(&game), 2, "it has no name");
    game.world_mut().entity_mut(stage).insert(Name::new("stage"));
    pass(&mut game);
    assert_eq!((applied(&game), count::<Lightmap>(game.world_mut())), (3, 2));

    // What is the game's own lights in real time, until it is so no longer.
    let lantern = (Name::new("lantern"), PointLight::default(), LightBaking::RealTime);
    let lantern = game.world_mut().spawn(lantern).id();
    let direction = Transform::default().looking_to(Vec3::new(-0.5, -1.0, -0.3), Vec3::Y);
    let sun = game.world_mut().spawn((DirectionalLight::default(), direction, LightBaking::RealTime)).id();
    pass(&mut game);
    assert_eq!(applied(&game), 3);
    game.world_mut().entity_mut(lantern).insert(LightBaking::MixedDirect);
    pass(&mut game);
    assert_eq!(applied(&game), 4);
    game.world_mut().entity_mut(sun).remove::<LightBaking>();
    pass(&mut game);
    assert_eq!(applied(&game), 5, "all but the statue");
}

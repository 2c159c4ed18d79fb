//! Lightmaps are filtered as the resource says, before and after it changes; those of the game are left alone.

use super::*;

/// Each lightmap's entity and whether it is bicubic.
fn filterings(world: &mut World) -> BTreeMap<Entity, bool> {
    let mut lightmaps = world.query::<(Entity, &Lightmap)>();
    lightmaps.iter(world).map(|(entity, lightmap)| (entity, lightmap.bicubic_sampling)).collect()
}

/// Runs until all of `count` lightmaps are on, and says how many frames that took.
fn frames_until_on(app: &mut App, count: usize) -> usize {
    let mut frames = 0;
    run_until(app, "the lightmaps", |world| {
        frames += 1;
        filterings(world).len() == count
    });
    frames
}

#[test]
fn a_bake_is_filtered_as_chosen_and_as_chosen_later() {
    let mut app = lit_floor();
    let before = snapshot(app.world_mut());
    // Chosen before anything is shown.
    app.insert_resource(LightmapFiltering::Bicubic);
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
    let shown = filterings(app.world_mut());
    assert!(shown.len() == 1 && shown.values().all(|bicubic| *bicubic), "{shown:?}");
    let bicubic = snapshot(app.world_mut());
    // The game's own, which no change may touch.
    let own = app.world_mut().spawn(Lightmap { bicubic_sampling: true, ..default() }).id();

    app.insert_resource(LightmapFiltering::Bilinear);
    app.update();
    assert_eq!(filterings(app.world_mut()), [(own, true)].into(), "Bevy must see frames without it");
    assert!(frames_until_on(&mut app, 2) >= 3);
    let shown = filterings(app.world_mut());
    assert!(shown.iter().all(|(entity, bicubic)| *bicubic == (*entity == own)), "{shown:?}");

    // Nothing is taken off where nothing is to be changed.
    app.insert_resource(LightmapFiltering::Bilinear);
    app.update();
    assert_eq!(filterings(app.world_mut()), shown);

    // Two changes in a row end at the last.
    app.insert_resource(LightmapFiltering::Bicubic);
    app.update();
    app.insert_resource(LightmapFiltering::Bilinear);
    app.update();
    app.insert_resource(LightmapFiltering::Bicubic);
    frames_until_on(&mut app, 1);
    frames_until_on(&mut app, 2);
    app.world_mut().despawn(own);
    assert_eq!(snapshot(app.world_mut()), bicubic);

    app.world_mut().trigger(ClearLightmaps);
    app.update();
    assert_eq!(snapshot(app.world_mut()), before);
}

#[test]
fn a_folder_is_filtered_as_chosen_and_a_bake_on_top_gives_it_back_as_chosen_since() {
    let folder = temp_dir::TempDir::new().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_kiln"));
    command.arg("bake").arg(data("cornell.glb")).arg("-o").arg(folder.path().join("baked"));
    let output = command.args(["--layout", "shared", "--size", "16", "--spp", "1"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    std::fs::copy(data("cornell.glb"), folder.path().join("cornell.glb")).unwrap();

    let mut app = cornell(folder.path());
    app.insert_resource(LightmapFiltering::Bicubic);
    let baked: Handle<BakedFolder> = app.world().resource::<AssetServer>().load("baked/kiln.ron");
    let world = app.world_mut();
    let root = world.query_filtered::<Entity, With<WorldAssetRoot>>().single(world).unwrap();
    world.entity_mut(root).insert(BakedLightmaps(baked));
    frames_until_on(&mut app, 7);
    let all = |world: &mut World, wanted: bool| filterings(world).values().all(|bicubic| *bicubic == wanted);
    assert!(all(app.world_mut(), true));

    // A bake of another size over it, and a change meanwhile.
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
    frames_until_on(&mut app, 7);
    assert!(all(app.world_mut(), true));
    app.insert_resource(LightmapFiltering::Bilinear);
    app.update();
    frames_until_on(&mut app, 7);
    assert!(all(app.world_mut(), false));
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    frames_until_on(&mut app, 7);
    assert!(all(app.world_mut(), false), "the folder's lightmaps are back, with what was chosen since");
}

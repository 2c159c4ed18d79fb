//! Bakes and plans as jobs: their numbers, their status, pauses and warnings, and the keys.

use super::*;

#[derive(Resource, Default)]
struct Planned(Vec<BakePlanned>);

fn heeding(mut app: App) -> App {
    app.init_resource::<Planned>()
        .add_observer(|event: On<BakePlanned>, mut planned: ResMut<Planned>| planned.0.push(event.event().clone()));
    app
}

fn status(app: &App) -> &BakeStatus {
    app.world().resource::<BakeStatus>()
}

fn long() -> BakeLightmaps {
    BakeLightmaps { goal: BakeGoal::Samples(1 << 24), threads: 1, ..small() }
}

fn entity(app: &mut App, wanted: &str) -> Entity {
    let world = app.world_mut();
    let mut names = world.query::<(Entity, &Name)>();
    names.iter(world).find(|(_, name)| name.as_str() == wanted).unwrap().0
}

#[test]
fn a_plan_is_made_beside_the_game_and_changes_nothing() {
    let mut app = heeding(cornell(&data("")));
    let before = snapshot(app.world_mut());
    let bake = BakeLightmaps { goal: BakeGoal::Error(0.05), ..small() };
    app.world_mut().trigger(PlanBake { bake: bake.clone() });
    app.world_mut().flush();
    let running = status(&app).running().unwrap();
    assert!(running.is_waiting && running.work == KilnWork::Plan && running.id == BakeId(1));
    run_until(&mut app, "the plan", |world| !world.resource::<Planned>().0.is_empty());
    let planned = app.world().resource::<Planned>().0[0].clone();
    let here = bake.plan(app.world_mut()).unwrap();
    assert_eq!(
        (planned.job, planned.plan.texels, planned.plan.memory_bytes),
        (BakeId(1), here.texels, here.memory_bytes)
    );
    assert!(planned.plan.predicted.len() > 1 && planned.plan.effects.iter().any(|effect| effect.on));
    // The lamp cannot have a lightmap, and the warning knows which entity that is.
    let lamp = planned.warnings.iter().find(|warning| warning.sentence.contains("light.light\" has no UV1")).unwrap();
    let name = app.world().get::<Name>(lamp.entity.unwrap()).unwrap();
    assert_eq!(name.as_str(), "light.light");
    assert_eq!(snapshot(app.world_mut()), before);
    assert!(status(&app).running().is_none());
    assert_eq!(status(&app).plan(), Some(&planned.plan));
}

#[test]
fn jobs_are_numbered_and_one_runs_at_a_time() {
    let mut app = heeding(lit_floor());
    app.world_mut().trigger(long());
    app.update();
    app.world_mut().trigger(PlanBake { bake: small() });
    app.world_mut().flush();
    let refused = app.world().resource::<Heard>().failed[0].clone();
    assert_eq!((refused.job, refused.cancelled), (BakeId(2), false));
    assert!(refused.reason.contains("a bake is running (job 1)"), "{refused:?}");
    app.world_mut().trigger(CancelBake);
    run_until(&mut app, "the end", |world| world.resource::<BakeStatus>().running().is_none());
    let ending = &status(&app).outcome(BakeId(1)).unwrap().ending;
    assert!(matches!(ending, KilnEnding::Failed { cancelled: true, .. }), "{ending:?}");
    app.world_mut().resource_mut::<Heard>().failed.clear();
    app.world_mut().trigger(small());
    let finished = run_until_baked(&mut app, 1);
    assert_eq!(finished.job, BakeId(3));
    let latest = status(&app).outcomes().next().unwrap();
    assert!(latest.id == BakeId(3) && latest.warnings == finished.warnings);
    assert!(matches!(latest.ending, KilnEnding::Baked { entities: 1, .. }), "{latest:?}");
}

#[test]
fn a_job_that_has_not_begun_and_a_plan_can_be_cancelled() {
    for plan in [false, true] {
        let mut app = lit_floor();
        if plan {
            app.world_mut().trigger(PlanBake { bake: small() });
        } else {
            app.world_mut().trigger(small());
        }
        app.world_mut().trigger(CancelBake);
        run_until(&mut app, "the end", |world| world.resource::<Heard>().failed.len() == 1);
        let heard = app.world().resource::<Heard>();
        assert!(heard.failed[0].cancelled && heard.finished.is_empty());
        assert!(status(&app).running().is_none());
    }
}

#[test]
fn a_paused_bake_stands_still_and_makes_the_same_bits() {
    let settings = BakeLightmaps { goal: BakeGoal::Samples(2048), threads: 2, ..small() };
    let mut straight = cornell(&data(""));
    straight.world_mut().trigger(settings.clone());
    run_until_baked(&mut straight, 1);

    let mut app = cornell(&data(""));
    app.world_mut().trigger(settings);
    run_until(&mut app, "some progress", |world| {
        world.resource::<BakeStatus>().running().is_some_and(|running| running.relative_stderr.is_some())
    });
    app.world_mut().trigger(PauseBake);
    app.world_mut().flush();
    assert!(status(&app).running().is_some_and(|running| running.is_paused), "it ended before it could be paused");
    // Until the threads have ended what they are at, which takes them a tile's time; then nothing comes any more.
    let look = |app: &mut App| {
        for _ in 0..300 {
            app.update();
            std::thread::sleep(Duration::from_millis(1));
        }
        let running = status(app).running().expect("a paused bake ended");
        (running.fraction, running.seconds)
    };
    let mut seen = look(&mut app);
    for _ in 0..100 {
        let now = look(&mut app);
        if now == seen {
            break;
        }
        seen = now;
    }
    assert_eq!(look(&mut app), seen);
    assert!(app.world().resource::<Heard>().finished.is_empty());
    app.world_mut().trigger(ResumeBake);
    run_until_baked(&mut app, 1);
    assert_eq!(texels(app.world_mut()), texels(straight.world_mut()));
}

#[test]
fn a_paused_bake_can_be_cancelled() {
    let mut app = lit_floor();
    app.world_mut().trigger(long());
    app.world_mut().trigger(PauseBake);
    app.update();
    app.update();
    assert!(status(&app).running().is_some_and(|running| running.is_paused));
    app.world_mut().trigger(CancelBake);
    run_until(&mut app, "the end", |world| world.resource::<BakeStatus>().running().is_none());
}

#[test]
fn keys_bake_hold_stop_and_clear() {
    let mut app = lit_floor();
    // Added as an app's builder does before it runs.
    KilnShortcuts.build(&mut app);
    // Without a keyboard nothing happens, and nothing breaks.
    app.world_mut().remove_resource::<ButtonInput<KeyCode>>();
    app.update();
    app.init_resource::<ButtonInput<KeyCode>>();
    let command = if cfg!(target_os = "macos") { KeyCode::SuperLeft } else { KeyCode::ControlRight };
    let chord = |app: &mut App, with: &[KeyCode], is_over: bool| {
        let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
        keys.reset_all();
        with.iter().for_each(|&key| keys.press(key));
        keys.press(KeyCode::KeyB);
        if is_over {
            keys.release_all();
        }
        app.update();
        let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
        keys.reset_all();
        app.update();
    };
    let press = |app: &mut App, with: &[KeyCode]| chord(app, with, false);
    press(&mut app, &[]);
    press(&mut app, &[KeyCode::ShiftLeft]);
    assert!(status(&app).running().is_none(), "B alone is the game's");
    app.world_mut().resource_mut::<NextBake>().0 = long();
    press(&mut app, &[command]);
    assert_eq!(status(&app).running().map(|running| running.is_paused), Some(false));
    press(&mut app, &[command, KeyCode::ShiftLeft]);
    assert_eq!(status(&app).running().map(|running| running.is_paused), Some(true));
    press(&mut app, &[command, KeyCode::ShiftLeft]);
    assert_eq!(status(&app).running().map(|running| running.is_paused), Some(false));
    // A slow frame may see keys go down and up at once.
    chord(&mut app, &[command], true);
    run_until(&mut app, "the end", |world| world.resource::<BakeStatus>().running().is_none());
    app.world_mut().resource_mut::<Heard>().failed.clear();
    app.world_mut().resource_mut::<NextBake>().0 = small();
    press(&mut app, &[command]);
    run_until_baked(&mut app, 1);
    assert_eq!(count::<Lightmap>(app.world_mut()), 1);
    press(&mut app, &[command, KeyCode::AltRight]);
    assert_eq!(count::<Lightmap>(app.world_mut()), 0);
}

#[test]
fn a_warning_of_what_is_left_out_knows_its_entity() {
    let mut app = heeding(lit_floor());
    let bare = app.world_mut().resource_mut::<Assets<Mesh>>().add(Mesh::from(Cuboid::default()));
    app.world_mut().spawn((Name::new("bare"), Mesh3d(bare)));
    app.world_mut().trigger(PlanBake { bake: BakeLightmaps { layout: LightmapLayout::Packed, ..small() } });
    run_until(&mut app, "the plan", |world| !world.resource::<Planned>().0.is_empty());
    let bare = entity(&mut app, "bare");
    let warnings = &app.world().resource::<Planned>().0[0].warnings;
    let of_bare =
        warnings.iter().find(|warning| warning.sentence.contains("\"bare\" has no StandardMaterial")).unwrap();
    assert_eq!(of_bare.entity, Some(bare));
    let ambient = warnings.iter().find(|warning| warning.sentence.contains("the ambient light")).unwrap();
    assert_eq!(ambient.entity, None);
}

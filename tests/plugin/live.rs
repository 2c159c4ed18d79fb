//! A bake on screen while it runs, and baking again what a change reaches.

use super::*;

/// Shown on its way.
fn seen(goal: BakeGoal) -> BakeLightmaps {
    BakeLightmaps { goal, view: BakeView::Live, threads: 1, ..small() }
}

fn endless() -> BakeLightmaps {
    seen(BakeGoal::Samples(1 << 20))
}

fn run_until_shown(app: &mut App) {
    run_until(app, "the first picture", |world| count::<Lightmap>(world) == 7);
}

#[test]
fn texels_are_shown_as_they_come_and_go_when_the_bake_is_stopped() {
    let mut app = cornell(&data(""));
    let before = snapshot(app.world_mut());
    app.world_mut().trigger(seen(BakeGoal::Samples(4096)));
    run_until_shown(&mut app);
    assert!(app.world().resource::<Heard>().finished.is_empty(), "shown while it runs");
    let coarse = texels(app.world_mut());
    assert!(coarse.values().all(|texels| texels.iter().any(|&byte| byte != 0)));
    run_until(&mut app, "finer texels", |world| texels(world) != coarse);
    assert!(app.world().resource::<Heard>().finished.is_empty(), "texels before the end");
    app.world_mut().trigger(CancelBake);
    run_until(&mut app, "the end of the bake", |world| world.resource::<Heard>().failed.len() == 1);
    assert_eq!(snapshot(app.world_mut()), before);
}

#[test]
fn a_stopped_bake_gives_back_what_the_one_before_had_made() {
    let mut app = cornell(&data(""));
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 1);
    let (shown, before) = (texels(app.world_mut()), snapshot(app.world_mut()));
    app.world_mut().trigger(BakeLightmaps { seed: 1, ..endless() });
    run_until(&mut app, "other texels", |world| texels(world) != shown);
    app.world_mut().trigger(CancelBake);
    run_until(&mut app, "the end of the bake", |world| world.resource::<Heard>().failed.len() == 1);
    assert_eq!(texels(app.world_mut()), shown);
    assert_eq!(snapshot(app.world_mut()), before);
}

#[test]
fn whoever_wants_nothing_before_the_end_sees_nothing() {
    let mut app = cornell(&data(""));
    let before = snapshot(app.world_mut());
    let asked = BakeLightmaps { goal: BakeGoal::Samples(256), view: BakeView::WhenDone, ..small() };
    app.world_mut().trigger(asked);
    run_until(&mut app, "the end of the bake", |world| {
        let is_done = !world.resource::<Heard>().finished.is_empty();
        assert!(is_done || snapshot(world) == before);
        is_done
    });
    assert_eq!(count::<Lightmap>(app.world_mut()), 7);
}

#[test]
fn what_no_change_reaches_is_kept() {
    let mut app = cornell(&data(""));
    app.world_mut().trigger(small());
    let first = run_until_baked(&mut app, 1);
    assert_eq!(first.kept, 0);
    let shown = texels(app.world_mut());
    app.world_mut().trigger(small());
    let second = run_until_baked(&mut app, 2);
    assert_eq!((second.kept, second.texels), (first.texels, first.texels));
    assert_eq!(texels(app.world_mut()), shown);

    // All of the box sees a wall that is painted.
    let paint = |mut materials: ResMut<Assets<StandardMaterial>>| {
        let ids: Vec<_> = materials.ids().collect();
        for id in ids {
            if let Some(mut material) = materials.get_mut(id) {
                material.base_color = Color::linear_rgb(0.1, 0.1, 0.1);
            }
        }
    };
    app.world_mut().run_system_once(paint).unwrap();
    app.world_mut().trigger(small());
    let third = run_until_baked(&mut app, 3);
    assert!(third.kept < third.texels / 10, "{} of {}", third.kept, third.texels);

    // From nothing: the same, measured.
    app.world_mut().trigger(BakeLightmaps { scope: BakeScope::Everything, ..small() });
    let all = run_until_baked(&mut app, 4);
    assert_eq!(all.kept, 0);
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    app.world_mut().trigger(small());
    assert_eq!(run_until_baked(&mut app, 5).kept, 0, "cleared is forgotten");
}

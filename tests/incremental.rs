//! Baking again after a change: what is kept is kept for a reason, what is measured again has the bits of a bake from
//! nothing, and whatever was kept the error is the one that was asked for. And watching a bake, which changes none.

mod common;

use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{
    BakeSettings, Baker, CancelToken, Denoise, Goal, Lightmap, LiveSink, Page, Progress, ProgressSink, TexelState,
    bake_lightmap,
};
use bevy_kiln::math::luminance;
use bevy_kiln::scene::{Light, RectLight, Scene};
use common::measured::{Measured, exceeding, texels};
use common::scenes::{SceneBuilder, grey};
use glam::{Vec2, Vec3};
use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::sync::Mutex;

/// Half-width of the intervals that are asked for, over the value.
const TARGET: f64 = 0.1;

/// Share of the texels that may be off by more, from docs/accuracy.md.
const EXCEEDING: f64 = 0.07;

/// Paths of each texel of a reference.
const LONG: u32 = 2048;

/// A room with a partition, which leaves a door free, and a second room that is closed; a lamp in each of the three.
fn rooms() -> Scene {
    let [x, y, z] = [Vec3::X, Vec3::Y * 2.0, Vec3::Z * 2.0];
    let room = |builder: SceneBuilder, name: &str, from: f32, to: f32| {
        let (low, length) = (x * from, x * (to - from));
        builder
            .quad(&format!("{name} floor"), low, [z, length], grey(0.6))
            .quad(&format!("{name} ceiling"), low + y, [length, z], grey(0.6))
            .quad(&format!("{name} west"), low, [y, z], grey(0.6))
            .quad(&format!("{name} east"), low + length, [z, y], grey(0.6))
            .quad(&format!("{name} back"), low, [length, y], grey(0.6))
            .quad(&format!("{name} front"), low + z, [y, length], grey(0.6))
    };
    let lamp = |builder: SceneBuilder, name: &str, at: Vec3| {
        builder.rect_light(name, at, Vec3::NEG_Y, Vec2::splat(0.4), Vec3::splat(50.0))
    };
    let builder = room(SceneBuilder::default(), "open", 0.0, 4.0)
        .quad("partition, west side", x * 2.0, [z * 0.85, y], grey(0.6))
        .quad("partition, east side", x * 2.02, [y, z * 0.85], grey(0.6))
        .quad("jamb", x * 2.0 + z * 0.85, [x * 0.02, y], grey(0.6));
    let builder = room(builder, "closed", 4.1, 6.0);
    let builder = lamp(builder, "lamp west", Vec3::new(0.8, 1.9, 0.7));
    let builder = lamp(builder, "lamp middle", Vec3::new(3.0, 1.9, 1.0));
    lamp(builder, "lamp closed", Vec3::new(5.0, 1.9, 1.0)).build()
}

/// A box of 0.4 m on the floor of the middle room, without its underside.
fn with_chair(scene: Scene) -> Scene {
    let [x, y, z] = [Vec3::X * 0.4, Vec3::Y * 0.4, Vec3::Z * 0.4];
    let low = Vec3::new(3.2, 0.0, 0.5);
    let mut chair = SceneBuilder::default()
        .quad("chair top", low + y, [z, x], grey(0.3))
        .quad("chair west", low, [z, y], grey(0.3))
        .quad("chair east", low + x, [y, z], grey(0.3))
        .quad("chair back", low, [y, x], grey(0.3))
        .quad("chair front", low + z, [x, y], grey(0.3))
        .build();
    let mut scene = scene;
    for instance in &mut chair.instances {
        instance.mesh += scene.meshes.len();
        instance.material += scene.materials.len();
    }
    scene.meshes.append(&mut chair.meshes);
    scene.materials.append(&mut chair.materials);
    scene.instances.append(&mut chair.instances);
    scene
}

fn lamp<'a>(scene: &'a mut Scene, name: &str) -> &'a mut RectLight {
    let is_it = |light: &&mut Light| light.name() == name;
    match scene.lights.iter_mut().find(is_it) {
        Some(Light::Rect(light)) => light,
        other => panic!("{name}: {other:?}"),
    }
}

fn settings(goal: Goal) -> BakeSettings {
    BakeSettings { goal, density: 4.0, denoise: Denoise::Off, ..BakeSettings::default() }
}

fn to_error() -> BakeSettings {
    settings(Goal::Error(TARGET))
}

fn bake(baker: &mut Baker, scene: &Scene) -> Lightmap {
    baker.bake(scene, &to_error(), &(), &CancelToken::default()).unwrap()
}

fn from_nothing(scene: &Scene, settings: &BakeSettings) -> Lightmap {
    bake_lightmap(scene, settings, &(), &CancelToken::default()).unwrap()
}

/// Changes a scene.
type Edit = fn(&mut Scene);

fn is_of(name: &str) -> impl Fn(&(&(StableId, [u32; 2]), &Measured)) -> bool + '_ {
    move |((id, _), _)| id.as_str().starts_with(name)
}

#[test]
fn without_a_change_all_is_kept() {
    let mut baker = Baker::default();
    let scene = rooms();
    let first = bake(&mut baker, &scene);
    assert_eq!(first.report.kept, None);
    let second = bake(&mut baker, &scene);
    assert_eq!(second.report.kept, Some(second.report.texels));
    assert_eq!(first.pages, second.pages);
    assert_eq!(first.pages, from_nothing(&scene, &to_error()).pages);
    // Other settings, or a baker that has forgotten, measure all.
    let other = baker.bake(&scene, &settings(Goal::Error(0.2)), &(), &CancelToken::default()).unwrap();
    assert_eq!(other.report.kept, None);
    baker.forget();
    assert_eq!(bake(&mut baker, &scene).report.kept, None);
}

#[test]
fn a_lamp_in_a_closed_room_is_of_no_interest_elsewhere() {
    let mut baker = Baker::default();
    let before = texels(&bake(&mut baker, &rooms()));
    let mut scene = rooms();
    lamp(&mut scene, "lamp closed").world_from_local.translation.z += 0.5;
    let again = bake(&mut baker, &scene);
    let all = texels(&again);
    let in_open = all.iter().filter(|texel| !is_of("closed")(texel)).count();
    assert_eq!(again.report.kept, Some(in_open as u64), "of {}", all.len());
    assert!(all.iter().filter(|texel| !is_of("closed")(texel)).all(|(place, texel)| before[place] == *texel));
    let fresh = texels(&from_nothing(&scene, &to_error()));
    assert!(all.iter().filter(is_of("closed")).all(|(place, texel)| fresh[place] == *texel));
}

#[test]
fn whatever_is_kept_the_error_is_the_one_that_was_asked_for() {
    let edits: [(&str, Edit); 4] = [
        ("a lamp moves", |scene| lamp(scene, "lamp west").world_from_local.translation.x -= 0.3),
        ("a lamp dims", |scene| lamp(scene, "lamp middle").radiance *= 0.7),
        ("a wall is painted", |scene| {
            let wall = scene.instances.iter().find(|instance| instance.name == "open east").unwrap().material;
            scene.materials[wall] = grey(0.2);
        }),
        ("a chair comes", |scene| *scene = with_chair(std::mem::take(scene))),
    ];
    let mut baker = Baker::default();
    bake(&mut baker, &rooms());
    let unchanged = from_nothing(&rooms(), &to_error());
    let (mut shares, mut stale) = (Vec::new(), Vec::new());
    for (name, edit) in edits {
        let mut scene = rooms();
        edit(&mut scene);
        let reference = texels(&from_nothing(&scene, &settings(Goal::Samples(LONG))));
        // Each from the scene before, which the baker is told again.
        bake(&mut baker, &rooms());
        let again = bake(&mut baker, &scene);
        let kept = again.report.kept.unwrap();
        let exceeding = exceeding(&again, &reference, TARGET);
        println!("{name}: kept {kept} of {}, {:.1} % exceeding", again.report.texels, 100.0 * exceeding);
        assert!(exceeding <= EXCEEDING, "{name}: {exceeding}");
        assert!(kept > 0 && kept < again.report.texels, "{name}");
        shares.push(kept as f64 / again.report.texels as f64);
        // A baker that keeps everything is found out.
        if texels(&unchanged).len() == reference.len() {
            stale.push(self::exceeding(&unchanged, &reference, TARGET));
        }
    }
    println!("kept {shares:.2?}; a stale map: {stale:.2?} exceeding");
    assert!(stale.len() == 3 && stale.iter().all(|&share| share > EXCEEDING), "{stale:?}");
}

/// Each of these steps alone may be kept, and many of them may not.
#[test]
fn small_changes_add_up() {
    let mut baker = Baker::default();
    let mut scene = rooms();
    bake(&mut baker, &scene);
    let mut kept = Vec::new();
    for _ in 0..6 {
        for name in ["lamp west", "lamp middle", "lamp closed"] {
            lamp(&mut scene, name).radiance *= 0.985;
        }
        let again = bake(&mut baker, &scene);
        kept.push(again.report.kept.unwrap() as f64 / again.report.texels as f64);
    }
    println!("kept {kept:.2?}");
    assert!(kept[0] > 0.9, "1.5 % is a part of what was asked for: {kept:?}");
    assert!(kept.iter().any(|&share| share < 0.1), "9 % is not: {kept:?}");
    let reference = texels(&from_nothing(&scene, &settings(Goal::Samples(LONG))));
    let last = bake(&mut baker, &scene);
    assert!(exceeding(&last, &reference, TARGET) <= EXCEEDING);
}

/// Hears everything.
#[derive(Default)]
struct Watcher {
    heard: Mutex<Heard>,
}

#[derive(Default)]
struct Heard {
    previews: Vec<Lightmap>,
    measured: Vec<(u32, Vec<(u32, Vec3)>)>,
}

/// Beyond the closed room.
const VIEWPOINT: Vec3 = Vec3::new(20.0, 1.0, 1.0);

impl ProgressSink for Watcher {
    fn report(&self, _: Progress) {}

    fn live(&self) -> Option<&dyn LiveSink> {
        Some(self)
    }
}

impl LiveSink for Watcher {
    fn viewpoint(&self) -> Option<Vec3> {
        Some(VIEWPOINT)
    }

    fn preview(&self, coarse: Lightmap) {
        let mut heard = self.heard.lock().unwrap();
        assert!(heard.measured.is_empty());
        heard.previews.push(coarse);
    }

    fn measured(&self, page: u32, texels: &[(u32, Vec3)]) {
        self.heard.lock().unwrap().measured.push((page, texels.to_vec()));
    }
}

#[test]
fn a_bake_that_is_watched_is_the_same() {
    let scene = rooms();
    let unwatched = from_nothing(&scene, &to_error());
    let watcher = Watcher::default();
    let settings = BakeSettings { threads: NonZeroUsize::new(1), ..to_error() };
    let watched = bake_lightmap(&scene, &settings, &watcher, &CancelToken::default()).unwrap();
    assert_eq!(watched.pages, unwatched.pages);

    let heard = watcher.heard.into_inner().unwrap();
    let sizes: Vec<[u32; 2]> = watched.pages.iter().map(|page| [page.width, page.height]).collect();
    let [coarse] = &heard.previews[..] else { panic!("{} previews", heard.previews.len()) };
    assert_eq!(coarse.placements, watched.placements);
    assert_eq!((&coarse.meshes, &coarse.baked_lights), (&watched.meshes, &watched.baked_lights));
    let mut seen = BTreeMap::new();
    for (page, texels) in &heard.measured {
        for &(index, value) in texels {
            assert_eq!(watched.pages[*page as usize].raw[index as usize], value);
            assert!(seen.insert((*page, index), ()).is_none(), "told twice");
        }
    }
    assert_eq!(seen.len() as u64, watched.report.texels);
    // All texels of the closed room come before all others.
    let of_closed: Vec<_> =
        watched.placements.iter().filter(|placement| placement.id.as_str().starts_with("closed")).collect();
    let is_of_closed = |(page, texels): &(u32, Vec<(u32, Vec3)>)| {
        let [width, height] = sizes[*page as usize];
        let texel = Vec2::new((texels[0].0 % width) as f32, (texels[0].0 / width) as f32) + 0.5;
        let uv = texel / Vec2::new(width as f32, height as f32);
        let is_within =
            |uv_min: [f32; 2], uv_max: [f32; 2]| uv.cmpge(uv_min.into()).all() && uv.cmple(uv_max.into()).all();
        of_closed.iter().any(|rect| rect.page == *page && is_within(rect.uv_min, rect.uv_max))
    };
    let order: Vec<bool> = heard.measured.iter().map(is_of_closed).collect();
    assert!(order.iter().any(|closed| *closed) && order.iter().any(|closed| !closed));
    assert!(order.is_sorted_by(|a, b| a >= b), "{order:?}");
    // The preview is the light in coarse: its mean is that of the finished map.
    let mean = |pages: &[Page]| {
        let of_page = |page: &Page| {
            let measured = page.state.iter().zip(&page.radiance).filter(|(state, _)| **state == TexelState::Measured);
            measured.map(|(_, value)| luminance(value.as_dvec3())).sum::<f64>()
        };
        pages.iter().map(of_page).sum::<f64>() / watched.report.texels as f64
    };
    let [coarse, fine] = [coarse, &watched].map(|lightmap| mean(&lightmap.pages));
    assert!((coarse / fine - 1.0).abs() < 0.03, "{coarse} {fine}");
}

/// Held for a while now and then, a bake is the same.
#[test]
fn a_bake_that_was_paused_is_the_same() {
    /// Pauses at every second report until another thread lets it go on.
    struct Restless {
        token: CancelToken,
        reports: Mutex<u32>,
        pauses: std::sync::mpsc::SyncSender<()>,
    }
    impl ProgressSink for Restless {
        fn report(&self, _: Progress) {
            let mut reports = self.reports.lock().unwrap();
            *reports += 1;
            if reports.is_multiple_of(2) {
                self.token.pause();
                self.pauses.send(()).unwrap();
            }
        }
    }
    let scene = rooms();
    let settings = settings(Goal::Samples(64));
    let undisturbed = from_nothing(&scene, &settings);
    let token = CancelToken::default();
    let (pauses, paused) = std::sync::mpsc::sync_channel(64);
    let theirs = token.clone();
    let waker = std::thread::spawn(move || paused.iter().inspect(|()| theirs.resume()).count());
    let restless = Restless { token: token.clone(), reports: Mutex::default(), pauses };
    let disturbed = bake_lightmap(&scene, &settings, &restless, &token).unwrap();
    drop(restless);
    assert!(waker.join().unwrap() > 2, "it was never paused");
    assert_eq!(disturbed.pages, undisturbed.pages);

    // And one that is paused can be stopped.
    token.pause();
    token.cancel();
    assert!(bake_lightmap(&scene, &settings, &(), &token).is_err());
}

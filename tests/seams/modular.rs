//! Walls and floors in pieces that touch: each piece an object with a rectangle of its own.

use crate::common::scenes::{SceneBuilder, grey};
use crate::judge::{Edges, Look, TARGET, bake, pairs, settings, unrepaired, worst_jump};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Filtering, Lightmap};
use bevy_kiln::scene::{Light, PointLight, Scene};
use glam::{Vec2, Vec3};

/// A piece of a wall: a corner and a size, in shares of the wall.
type Piece = (Vec2, Vec2);

/// Width and height of the wall [m].
const WALL: Vec2 = Vec2::new(2.0, 1.0);

/// The difference between two bakes that is asked for: 2 % of the local value.
const ERROR_TARGET: f32 = 0.02;

/// Four pieces, with a joint from side to side and one that ends on it.
const FOUR: [Piece; 4] = [
    (Vec2::new(0.0, 0.0), Vec2::new(0.37, 1.0)),
    (Vec2::new(0.37, 0.0), Vec2::new(0.63, 0.45)),
    (Vec2::new(0.37, 0.45), Vec2::new(0.28, 0.55)),
    (Vec2::new(0.65, 0.45), Vec2::new(0.35, 0.55)),
];

fn lamp(position: Vec3, radius: f32) -> Light {
    Light::Point(PointLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        position,
        intensity: Vec3::new(40.0, 36.0, 30.0),
        radius,
        range: None,
    })
}

/// A wall in the plane z = 0 in pieces, far from the origin, so that their corners round.
fn wall(pieces: &[Piece]) -> Scene {
    let corner = Vec3::new(37.1, 1.3, -12.7);
    let mut builder = SceneBuilder::default();
    for (number, (from, size)) in pieces.iter().enumerate() {
        let (from, size) = (*from * WALL, *size * WALL);
        let name = format!("piece {number}");
        builder = builder.quad(&name, corner + from.extend(0.0), [Vec3::X * size.x, Vec3::Y * size.y], grey(0.5));
    }
    let mut scene = builder.build();
    scene.lights.push(lamp(corner + Vec3::new(1.1, 0.7, 0.9), 0.15));
    scene
}

/// What is shown of a point of the wall.
fn shown(scene: &Scene, pieces: &[Piece], lightmap: &Lightmap, filtering: Filtering, at: Vec2) -> Vec3 {
    let look = Look::new(scene, lightmap, filtering);
    let number = pieces.iter().position(|(from, size)| at.cmpge(*from).all() && at.cmple(*from + *size).all()).unwrap();
    let (from, size) = pieces[number];
    look.at((number, (at - from) / size))
}

/// Points of the wall, those on both sides of its joints among them.
fn points() -> impl Iterator<Item = Vec2> {
    let even = (0..61 * 41).map(|key| Vec2::new((key % 61) as f32 / 60.0, (key / 61) as f32 / 40.0));
    let beside = (0..200).flat_map(|key| {
        let along = (key as f32 + 0.5) / 200.0;
        [-1e-4, 1e-4].into_iter().flat_map(move |off| [Vec2::new(0.37 + off, along), Vec2::new(along, 0.45 + off)])
    });
    even.chain(beside)
}

/// The largest difference between the wall in one piece and in four, over the local value.
fn apart(four: (&Scene, &Lightmap), one: (&Scene, &Lightmap)) -> f32 {
    let whole = [(Vec2::ZERO, Vec2::ONE)];
    let both = [Filtering::Bilinear, Filtering::Bicubic];
    both.into_iter()
        .flat_map(|filtering| points().map(move |at| (filtering, at)))
        .map(|(filtering, at)| {
            let a = shown(four.0, &FOUR, four.1, filtering, at);
            let b = shown(one.0, &whole, one.1, filtering, at);
            (a - b).abs().max_element() / b.max_element()
        })
        .fold(0.0, f32::max)
}

/// Line 2 of what was asked for: no difference above the error target, and no step at the joints.
#[test]
fn a_wall_in_four_pieces_looks_like_one() {
    let (four, one) = (wall(&FOUR), wall(&[(Vec2::ZERO, Vec2::ONE)]));
    let settings = settings(24.0, 4096);
    let (in_four, in_one) = (bake(&four, &settings), bake(&one, &settings));
    let noise = in_four.report.relative_stderr.max.max(in_one.report.relative_stderr.max);
    let difference = apart((&four, &in_four), (&one, &in_one));
    let bare = apart((&four, &unrepaired(&in_four)), (&one, &unrepaired(&in_one)));
    let pairs = pairs(&four, Edges::Smooth);
    let (step, step_before) = (worst_jump(&four, &in_four, &pairs), worst_jump(&four, &unrepaired(&in_four), &pairs));
    println!(
        "wall: difference {:.2} % (unrepaired {:.2} %), step {:.2} % (unrepaired {:.2} %), noise at most {:.2} %",
        100.0 * difference,
        100.0 * bare,
        100.0 * step,
        100.0 * step_before,
        100.0 * noise
    );
    assert!(step <= TARGET && step_before > TARGET, "{step} {step_before}");
    assert!(difference <= ERROR_TARGET, "{difference}");
    assert!(bare > ERROR_TARGET, "a wall without repair must not pass: {bare}");
}

/// Two floor tiles, and a wall as thick as `thickness` on their joint; a lamp on one side. Nothing reflects.
fn parted(thickness: f32, shift: f32) -> Scene {
    let tile = |builder: SceneBuilder, name: &str, x: f32| {
        builder.quad(name, Vec3::new(x, 0.0, 0.0), [Vec3::Z, Vec3::X], grey(0.0))
    };
    let mut builder = tile(tile(SceneBuilder::default(), "dark", -1.0), "lit", 0.0);
    let (low, high) = (Vec3::new(shift - 0.5 * thickness, -0.1, -9.0), Vec3::new(shift + 0.5 * thickness, 9.0, 10.0));
    let corner = |number: u32| {
        let pick = |axis: usize| if number >> axis & 1 == 0 { low[axis] } else { high[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices = faces.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    builder = builder.mesh("wall", corners, indices, None, grey(0.0));
    let mut scene = builder.build();
    scene.lights.push(lamp(Vec3::new(0.6, 1.0, 0.5), 0.05));
    scene
}

/// The brightest that is shown of the dark tile, over the mean of the lit one's texels.
fn leak(scene: &Scene, lightmap: &Lightmap) -> f32 {
    let both = [Filtering::Bilinear, Filtering::Bicubic];
    let mut brightest = 0.0_f32;
    for look in both.map(|filtering| Look::new(scene, lightmap, filtering)) {
        for key in 0..101 * 11 {
            let uv = Vec2::new((key / 101) as f32 / 10.0, (key % 101) as f32 / 100.0);
            brightest = brightest.max(look.at((0, uv)).max_element());
        }
    }
    let page = &lightmap.pages[0];
    brightest / page.raw.iter().fold(0.0, |most, value| value.max_element().max(most))
}

#[test]
fn no_light_crosses_a_wall_on_a_joint() {
    for (thickness, shift) in [(0.05, 0.0), (0.01, 0.0), (0.2, 0.0), (0.01, 0.004)] {
        let scene = parted(thickness, shift);
        let lightmap = bake(&scene, &settings(16.0, 64));
        assert_eq!(leak(&scene, &lightmap), 0.0, "{thickness} {shift}");
        // Were the wall not there the tiles would be joined; and light that crosses is found.
        let mut open = scene.clone();
        open.instances.retain(|instance| instance.name != "wall");
        let joined = bake(&open, &settings(16.0, 64));
        assert!(joined.report.seams.is_some() && lightmap.report.seams.is_none());
        let mut crossed = lightmap.clone();
        let page = &mut crossed.pages[0];
        let dark: Vec<usize> = (0..page.raw.len()).filter(|&texel| page.radiance[texel] == Vec3::ZERO).collect();
        dark.into_iter().for_each(|texel| page.radiance[texel] = Vec3::splat(1e-3));
        assert!(leak(&scene, &crossed) > 0.0);
    }
}

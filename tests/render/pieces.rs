//! A wall in one piece and the same wall in four that touch, each with charts of its own, drawn with both filterings:
//! no line may be seen where they touch.

use crate::renderer::{Screen, app, bake, show, spawn_camera};
use bevy::prelude::*;
use bevy_kiln::math::luminance;
use bevy_kiln::prelude::*;

/// Rows of 8 bytes per pixel are whole multiples of 256 bytes.
const WIDTH: usize = 256;
const HEIGHT: usize = 128;

/// Height that the picture shows [m].
const SHOWN: f32 = 1.1;

/// From the wall to the camera [m].
const DISTANCE: f32 = 3.0;

/// The wall: left, right, lower and upper end [m].
const WHOLE: [f32; 4] = [-1.0, 1.0, 0.0, 1.0];

/// The same in pieces: one joint from below to above, one from there to the right, and one that ends on it.
const FOUR: [[f32; 4]; 4] =
    [[-1.0, -0.26, 0.0, 1.0], [-0.26, 1.0, 0.0, 0.45], [-0.26, 0.3, 0.45, 1.0], [0.3, 1.0, 0.45, 1.0]];

/// Largest root mean square of the difference between the walls, at the joints and elsewhere, over the local value.
/// This is the noise of two bakes after 512 paths and their denoiser; measured are 0.5 % and 0.4 %.
const NOISE: f64 = 0.01;

/// Largest mean difference, over the length of a joint, between a band and its surroundings, and between its two
/// sides: below what an eye sees, which is about one in a hundred. Measured are 0.4 % at the joints and 0.2 % beside.
const LINE: f64 = 0.007;

/// A joint's pixels: those in `across` are what its sides are, `along` is its length.
#[derive(Clone, Copy, Debug)]
struct Joint {
    is_upright: bool,
    at: f32,
    along: [f32; 2],
}

/// Where the pieces touch.
fn joints() -> [Joint; 3] {
    [
        Joint { is_upright: true, at: -0.26, along: [0.0, 1.0] },
        Joint { is_upright: false, at: 0.45, along: [-0.26, 1.0] },
        Joint { is_upright: true, at: 0.3, along: [0.45, 1.0] },
    ]
}

/// Places beside the joints, parallel to them, where pieces do not touch.
fn beside() -> Vec<Joint> {
    let shifts = [-0.2, -0.15, -0.1, 0.1, 0.15, 0.2];
    joints().iter().flat_map(|joint| shifts.map(|shift| Joint { at: joint.at + shift, ..*joint })).collect()
}

/// A pixel's column or row, from metres.
fn column(x: f32) -> f32 {
    WIDTH as f32 / 2.0 + x * HEIGHT as f32 / SHOWN
}

fn row(y: f32) -> f32 {
    HEIGHT as f32 / 2.0 - (y - 0.5) * HEIGHT as f32 / SHOWN
}

/// Where the wall fills a pixel and its neighbours.
fn is_wall(x: usize, y: usize) -> bool {
    let [left, right, low, high] = WHOLE;
    let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
    x > column(left) + 2.0 && x < column(right) - 2.0 && y > row(high) + 2.0 && y < row(low) - 2.0
}

impl Joint {
    /// How far a pixel lies to the joint's right or below it [pixels]; `None` beyond its ends.
    fn distance(&self, x: usize, y: usize) -> Option<f32> {
        let (x, y) = (x as f32 + 0.5, y as f32 + 0.5);
        let [from, to] = self.along;
        let (across, along, ends) = if self.is_upright {
            (x - column(self.at), y, [row(to), row(from)])
        } else {
            (y - row(self.at), x, [column(from), column(to)])
        };
        (along > ends[0] + 2.0 && along < ends[1] - 2.0).then_some(across)
    }
}

/// What tells the walls apart, as shares.
#[derive(Debug)]
struct Apart {
    /// Pixels at the joints and elsewhere.
    pixels: [usize; 2],
    /// Root mean squares of the difference there.
    rms: [f64; 2],
    /// The worst joint's mean within two pixels of it, less that of its surroundings; and the same at the places
    /// beside the joints.
    line: [f64; 2],
    /// The worst joint's mean on one side less that on the other; and beside.
    step: [f64; 2],
}

fn compare(four: &[f64], one: &[f64]) -> Apart {
    let difference: Vec<f64> = four.iter().zip(one).map(|(four, one)| four / one - 1.0).collect();
    let wall = || (0..WIDTH * HEIGHT).map(|at| (at, at % WIDTH, at / WIDTH)).filter(|&(_, x, y)| is_wall(x, y));
    let near = |x, y| joints().iter().any(|joint| joint.distance(x, y).is_some_and(|d| d.abs() < 3.0));
    let (mut pixels, mut squares) = ([0; 2], [0.0; 2]);
    for (at, x, y) in wall() {
        let elsewhere = usize::from(!near(x, y));
        pixels[elsewhere] += 1;
        squares[elsewhere] += difference[at] * difference[at];
    }
    let mean = |joint: &Joint, is_meant: &dyn Fn(f32) -> bool| {
        let meant = wall().filter(|&(_, x, y)| joint.distance(x, y).is_some_and(is_meant));
        let (sum, count) = meant.fold((0.0, 0), |(sum, count), (at, ..)| (sum + difference[at], count + 1));
        sum / f64::from(count)
    };
    let worst = |of: &dyn Fn(&Joint) -> f64| {
        [joints().to_vec(), beside()].map(|places| {
            places.iter().map(|place| of(place).abs()).fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a })
        })
    };
    Apart {
        pixels,
        rms: [0, 1].map(|place| (squares[place] / pixels[place] as f64).sqrt()),
        line: worst(&|joint| mean(joint, &|d| d.abs() < 2.0) - mean(joint, &|d| (4.0..10.0).contains(&d.abs()))),
        step: worst(&|joint| mean(joint, &|d| (0.0..4.0).contains(&d)) - mean(joint, &|d| (-4.0..0.0).contains(&d))),
    }
}

impl Apart {
    fn verdict(&self) -> Result<(), String> {
        let [joints, elsewhere] = self.rms;
        let faults = [
            (self.pixels[0] < 1000 || self.pixels[1] < 10_000, "too little was compared"),
            (!is_below(elsewhere, NOISE), "the walls differ"),
            (!is_below(joints, NOISE), "the walls differ where pieces touch"),
            (!is_below(self.line[0], LINE), "a line is seen"),
            (!is_below(self.step[0], LINE), "a step is seen"),
        ];
        let faults: Vec<&str> = faults.into_iter().filter(|(is_fault, _)| *is_fault).map(|(_, what)| what).collect();
        if faults.is_empty() { Ok(()) } else { Err(format!("{}: {self:?}", faults.join(", "))) }
    }
}

/// Not for what is no number.
fn is_below(value: f64, limit: f64) -> bool {
    value.is_finite() && value < limit
}

#[test]
fn a_wall_in_pieces_shows_no_line() {
    let Some(mut app) = app() else { return };
    spawn_stage(app.world_mut());
    let one = pictures(&mut app, &[WHOLE]);
    let four = pictures(&mut app, &FOUR);
    for (filtering, (four, one)) in ["bilinear", "bicubic"].iter().zip(four.iter().zip(&one)) {
        let apart = compare(four, one);
        println!("{filtering}: {apart:?}");
        apart.verdict().unwrap_or_else(|fault| panic!("{filtering}: {fault}"));
        reject_planted_faults(four, one);
    }
    // The second picture was really filtered otherwise.
    assert!(four[0].iter().zip(&four[1]).any(|(a, b)| (a / b - 1.0).abs() > 1e-3));
}

/// The checker itself, on the very pictures that it has accepted.
fn reject_planted_faults(four: &[f64], one: &[f64]) {
    let planted = |change: &dyn Fn(usize, usize) -> f64| {
        let changed: Vec<f64> = four.iter().enumerate().map(|(at, v)| v * change(at % WIDTH, at / WIDTH)).collect();
        compare(&changed, one).verdict().expect_err("a planted fault was accepted")
    };
    for joint in joints() {
        let within = |x, y, from: f32, to: f32| joint.distance(x, y).is_some_and(|d| (from..to).contains(&d));
        let line = planted(&|x, y| if within(x, y, -1.0, 1.0) { 0.97 } else { 1.0 });
        assert!(line.contains("a line is seen"), "{line}");
        let step = planted(&|x, y| if within(x, y, 0.0, 1e3) { 1.01 } else { 1.0 });
        assert!(step.contains("a step is seen"), "{step}");
    }
    let blotches = planted(&|x, y| 1.0 + 0.03 * f64::from(u8::from(x / 16 % 2 == y / 16 % 2)));
    assert!(blotches.contains("the walls differ"), "{blotches}");
    let black = planted(&|x, y| if x == 128 && y == 30 { f64::NAN } else { 1.0 });
    assert!(black.contains("the walls differ"), "{black}");
}

/// A floor that only reflects, a lamp with an extent, and a camera.
fn spawn_stage(world: &mut World) {
    let floor = world.resource_mut::<Assets<Mesh>>().add(Cuboid::new(3.0, 0.1, 1.5));
    let material = white(world);
    let place = Transform::from_xyz(0.0, -0.05, 0.75);
    world.spawn((Name::new("floor"), Mesh3d(floor), MeshMaterial3d(material), place, LightBlocker));
    let lamp = PointLight { intensity: 400.0, radius: 0.1, range: 1e4, ..default() };
    world.spawn((Name::new("lamp"), lamp, Transform::from_xyz(0.1, 0.8, 0.9)));
    let place = Transform::from_xyz(0.0, 0.5, DISTANCE).looking_to(Vec3::NEG_Z, Vec3::Y);
    let fov = 2.0 * (SHOWN / 2.0 / DISTANCE).atan();
    spawn_camera(world, [WIDTH as u32, HEIGHT as u32], fov, place);
}

fn white(world: &mut World) -> Handle<StandardMaterial> {
    let material = StandardMaterial { base_color: Color::WHITE.with_luminance(0.5), reflectance: 0.0, ..default() };
    world.resource_mut::<Assets<StandardMaterial>>().add(material)
}

/// The luminance of a wall in pieces, baked: bilinear and bicubic.
fn pictures(app: &mut App, pieces: &[[f32; 4]]) -> [Vec<f64>; 2] {
    let material = white(app.world_mut());
    let mut wall = Vec::new();
    for (number, [left, right, low, high]) in pieces.iter().enumerate() {
        let world = app.world_mut();
        // A slab without any UVs, which the bake lays out. Bevy's shader does not compile for one that has UV1 alone.
        let mut slab = Mesh::from(Cuboid::new(right - left, high - low, 0.1));
        slab.remove_attribute(Mesh::ATTRIBUTE_UV_0);
        let slab = world.resource_mut::<Assets<Mesh>>().add(slab);
        let place = Transform::from_xyz((left + right) / 2.0, (low + high) / 2.0, -0.05);
        let look = MeshMaterial3d(material.clone());
        wall.push(world.spawn((Name::new(format!("piece {number}")), Mesh3d(slab), look, place)).id());
        world.entity_mut(wall[number]).insert(LightmapReceiver::default());
    }
    app.insert_resource(LightmapFiltering::Bilinear);
    let format = LightmapFormat::Rgba16f;
    let done = bake(app, BakeLightmaps { goal: BakeGoal::Samples(512), density: 16.0, format, ..default() });
    assert_eq!((done.entities, done.warnings), (pieces.len(), vec![]));
    let bilinear = picture(app);
    app.insert_resource(LightmapFiltering::Bicubic);
    show(app);
    let bicubic = picture(app);
    app.world_mut().trigger(ClearLightmaps);
    for piece in wall {
        app.world_mut().despawn(piece);
    }
    show(app);
    [bilinear, bicubic]
}

fn picture(app: &App) -> Vec<f64> {
    let screen = &app.world().resource::<Screen>().0;
    assert_eq!(screen.len(), WIDTH * HEIGHT, "nothing was read back");
    screen.iter().map(|pixel| luminance(pixel.as_dvec3())).collect()
}

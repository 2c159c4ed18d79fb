//! The frame by itself, and what it does to rooms far away.

use super::TracedFromWorld;
use crate::artefact::StableId;
use crate::math::square_to_uniform_sphere;
use crate::math::testing::Random;
use crate::scene::{Indices, Instance, Light, Material, Mesh, PointLight, RectLight, Scene, SpotLight};
use crate::trace::Tally;
use crate::trace::sampler::{Dimensions, Sampler, Sobol};
use crate::trace::testing::{Shape, of_any_size};
use crate::trace::{Tracer, Transport};
use glam::{Affine3A, Vec2, Vec3};

fn around(vertices: &[Vec3]) -> TracedFromWorld {
    TracedFromWorld::around(vertices.iter().copied())
}

#[test]
fn what_is_about_the_origin_stays() {
    let home = TracedFromWorld::default();
    assert_eq!(around(&[]), home);
    assert_eq!(around(&[Vec3::ZERO]), home);
    assert_eq!(around(&[Vec3::ZERO, Vec3::ONE]), home);
    assert_eq!(around(&[Vec3::splat(-1e-6), Vec3::splat(1e6)]), home);
    // Half as large as it is far, and a little more.
    assert_eq!(around(&[Vec3::splat(1.0), Vec3::splat(2.001)]), home);
    assert_eq!(around(&[Vec3::splat(-2.001), Vec3::splat(-1.0)]), home);
    assert_eq!(around(&[Vec3::splat(f32::MAX), Vec3::splat(1.0)]), home);
    for number in [0.0, -0.0, 1e-45, 1.0, f32::MAX] {
        assert_eq!(home.point(Vec3::splat(number)).to_array().map(f32::to_bits), [number.to_bits(); 3]);
        assert_eq!(home.rounding(Vec3::splat(number)), Vec3::ZERO);
    }
}

#[test]
fn each_axis_goes_by_itself() {
    let frame = around(&[Vec3::new(1000.0, -1.0, -7.0), Vec3::new(1001.0, 1.0, -9.0)]);
    assert_eq!(frame.origin().as_vec3(), Vec3::new(1000.0, 0.0, -7.0));
    assert_eq!(frame.point(Vec3::new(1001.0, 0.5, -9.0)), Vec3::new(1.0, 0.5, -2.0));
    assert_eq!(frame.rounding(Vec3::new(1000.5, 0.5, -7.5)), Vec3::new(3.0517578e-5, 0.0, 2.3841858e-7));
}

/// No vertex is rounded, over all sizes that f32 has, and the scene then lies as near as it is large.
#[test]
fn no_vertex_is_rounded() {
    let mut random = Random::new(1);
    let mut moved = 0;
    for _ in 0..20_000 {
        let distance = of_any_size(&mut random, -37.0, 37.0) * if random.unit() < 0.5 { -1.0 } else { 1.0 };
        let reach = of_any_size(&mut random, -8.0, 0.5);
        let vertices: Vec<Vec3> =
            (0..8).map(|_| Vec3::splat(distance) * (1.0 + reach * Vec3::new(random.unit(), 0.5, 0.0))).collect();
        let frame = around(&vertices);
        moved += u32::from(frame.origin().x != 0.0);
        let traced = vertices.iter().map(|&vertex| frame.point(vertex));
        for (world, traced) in vertices.iter().zip(traced) {
            assert_eq!(world.as_dvec3() - frame.origin(), traced.as_dvec3(), "{vertices:?}");
        }
        let [low, high] = [Vec3::min, Vec3::max].map(|pick| vertices.iter().copied().reduce(pick).unwrap_or_default());
        let traced = vertices.iter().fold(Vec3::ZERO, |far, &vertex| far.max(frame.point(vertex).abs()));
        assert!(traced.cmple(2.0 * (high - low)).all(), "{vertices:?}: {traced}");
    }
    assert!((10_000..20_000).contains(&moved), "{moved}");
}

/// A room with a box in it, a glowing one, and a lamp of every kind: 0.55 m large, its corner at `place`.
fn room(place: Vec3) -> Scene {
    let white = Material::diffuse("white", Vec3::splat(0.7));
    let glowing = Material { emitted_radiance: Vec3::new(3.0, 2.0, 1.0), ..white.clone() };
    let root = Affine3A::from_translation(place);
    let mut scene = Shape::cube().scene(white, root * Affine3A::from_scale(Vec3::splat(0.55)));
    scene.materials.push(glowing);
    let turn = Affine3A::from_rotation_y(0.3) * Affine3A::from_scale(Vec3::new(0.1, -0.2, 0.15));
    for (name, material, at) in [("box", 0, Vec3::new(0.1, 0.25, 0.2)), ("glow", 1, Vec3::new(0.3, 0.45, 0.35))] {
        let world_from_local = root * Affine3A::from_translation(at) * turn;
        scene.instances.push(Instance {
            id: StableId::new(name),
            material,
            world_from_local,
            ..scene.instances[0].clone()
        });
    }
    let facing_down = Affine3A::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    let bulb = |name: &str, at: Vec3, radius| PointLight {
        id: StableId::new(name),
        name: name.into(),
        position: place + at,
        intensity: Vec3::splat(0.1),
        radius,
        range: Some(4.0),
    };
    scene.lights = vec![
        Light::Rect(RectLight {
            id: StableId::new("pane"),
            name: "pane".into(),
            world_from_local: root * Affine3A::from_translation(Vec3::new(0.2, 0.54, 0.2)) * facing_down,
            width: 0.1,
            height: 0.07,
            radiance: Vec3::splat(2.0),
            range: None,
        }),
        Light::Point(bulb("bulb", Vec3::new(0.1, 0.4, 0.1), 0.02)),
        Light::Spot(SpotLight {
            bulb: bulb("spot", Vec3::new(0.4, 0.5, 0.1), 0.0),
            direction: Vec3::NEG_Y,
            inner_angle: 0.3,
            outer_angle: 0.6,
        }),
    ];
    scene
}

/// The same room at home, as the world's f32 has bent it: each triangle where the tracer has it, moved by `offset`.
fn at_home(far: &Scene, offset: Vec3) -> Scene {
    let tracer = Tracer::new(far);
    let origin = tracer.traced_from_world.origin();
    let home = |world: Vec3| (world.as_dvec3() - origin).as_vec3() + offset;
    let mut scene = far.clone();
    let mut instances: Vec<usize> = (0..far.instances.len()).collect();
    instances.sort_by(|&a, &b| far.instances[a].id.cmp(&far.instances[b].id));
    let triangles: Vec<[Vec3; 3]> = tracer.triangles.iter().map(|triangle| triangle.vertices).collect();
    scene.meshes = Vec::new();
    for (chunk, &instance) in triangles.chunks(12).zip(&instances) {
        scene.instances[instance].mesh = scene.meshes.len();
        scene.instances[instance].world_from_local = Affine3A::IDENTITY;
        scene.meshes.push(Mesh {
            indices: Indices::U32((0..36).collect()),
            positions: chunk.as_flattened().iter().map(|&vertex| vertex + offset).collect(),
            ..far.meshes[0].clone()
        });
    }
    for light in &mut scene.lights {
        match light {
            Light::Rect(light) => {
                light.world_from_local.translation = home(light.world_from_local.translation.into()).into();
            }
            Light::Point(light) => light.position = home(light.position),
            Light::Spot(light) => light.bulb.position = home(light.bulb.position),
            Light::Directional(_) => {}
        }
    }
    scene
}

/// Everything that can be asked of a tracer from outside, at a point in the room, by its bits.
fn answers(tracer: &Tracer, [point, other]: [Vec3; 2], index: u64) -> Vec<u32> {
    let sampler = Sobol::new(3, index);
    let [u, v, w, _] = sampler.draw(Dimensions::Start);
    let direction = square_to_uniform_sphere(Vec2::new(u, v));
    let transport = Transport::default();
    let hit = tracer.closest_hit(point, direction).expect("the room is closed");
    let aim = tracer.aim(point, direction, w, Vec2::new(v, u));
    let looked = tracer.camera_radiance(point, direction, &sampler, &transport, &mut Tally::default());
    // Off all surfaces, on all sides, by more than the rounding of a point far away, which start_at makes allowance
    // for.
    let traced = tracer.traced_from_world.point(point);
    let is_free = |towards: Vec3| tracer.accel.closest(traced, towards, 0.04).is_none();
    let steps = [-1.0, 0.0, 1.0];
    let around = steps.into_iter().flat_map(|x| steps.into_iter().flat_map(move |y| steps.map(|z| Vec3::new(x, y, z))));
    let is_clear = around.filter_map(Vec3::try_normalize).all(is_free);
    let start =
        if is_clear { tracer.start_at(point, direction) } else { tracer.start_on_triangle(3, [0.3, 0.3], Vec3::Y) };
    let measured = tracer.diffuse_radiance(&start, &sampler, &transport, &mut Tally::default());
    let mut answers = vec![hit.distance, aim.map_or(0.0, |aim| aim.pdf.unwrap_or(1.0))];
    for vector in [hit.normal, aim.map_or(Vec3::ZERO, |aim| aim.direction), looked, measured] {
        answers.extend(vector.to_array());
    }
    answers.push(if tracer.is_visible(point, other) { 1.0 } else { 0.0 });
    answers.into_iter().map(f32::to_bits).collect()
}

/// A room 100 km away on one axis, on two and on three, where f32 counts in steps of 8 mm, is to the bit the room at
/// home that these steps make of it: its triangles and their error bounds, its light, whatever is asked of it.
#[test]
fn a_room_far_away_is_the_room_at_home() {
    for place in [Vec3::new(1e5, 0.0, 0.0), Vec3::new(0.0, -1e5, 1e5), Vec3::splat(-1e5), Vec3::new(1e5, 0.3, -5e3)] {
        let far = room(place);
        let far_tracer = Tracer::new(&far);
        let origin = far_tracer.traced_from_world.origin();
        let home_tracer = Tracer::new(&at_home(&far, Vec3::ZERO));
        assert_eq!(home_tracer.triangle_count(), far_tracer.triangle_count());
        for (home, far) in home_tracer.triangles.iter().zip(&far_tracer.triangles) {
            assert_eq!((home.vertices, home.normal, home.error), (far.vertices, far.normal, far.error), "{place}");
        }
        let mut random = Random::new(1);
        let mut lit = 0;
        for index in 0..500 {
            // On f32's grid in the world.
            let mut point = || {
                let inside = 0.05 + 0.45 * Vec3::new(random.unit(), random.unit(), random.unit());
                (place.as_dvec3() + inside.as_dvec3()).as_vec3()
            };
            let world = [point(), point()];
            let home = world.map(|point| (point.as_dvec3() - origin).as_vec3());
            let found = answers(&far_tracer, world, index);
            lit += u32::from(f32::from_bits(found[8]) > 0.0);
            assert_eq!(found, answers(&home_tracer, home, index), "{place}: {index}");
        }
        assert!(lit > 100, "{lit}");
    }
}

/// Where at home the room stands does not matter either, to rounding: 1/8 off, on both sides of the origin.
#[test]
fn light_does_not_ask_where_the_room_stands() {
    let far = room(Vec3::splat(1e5));
    let origin = Tracer::new(&far).traced_from_world.origin();
    let offset = Vec3::new(-0.125, -0.25, -0.375);
    let (far_tracer, home_tracer) = (Tracer::new(&far), Tracer::new(&at_home(&far, offset)));
    let light = |tracer: &Tracer, point: Vec3| {
        let path = |index| {
            let start = tracer.start_at(point, Vec3::Y);
            tracer.diffuse_radiance(&start, &Sobol::new(9, index), &Transport::default(), &mut Tally::default()).y
        };
        f64::from((0..8192).map(path).sum::<f32>() / 8192.0)
    };
    for inside in [Vec3::new(0.25, 0.25, 0.25), Vec3::new(0.0625, 0.3125, 0.4375)] {
        let [far, home] =
            [light(&far_tracer, (origin + inside.as_dvec3()).as_vec3()), light(&home_tracer, inside + offset)];
        assert!((far / home - 1.0).abs() < 1e-3, "{far} {home}");
    }
}

/// A point on a slanted wall far away cannot lie on it, and still counts as lying on it: none reads the dark outside.
#[test]
fn points_on_a_wall_far_away_count_as_on_it() {
    let glowing = Material { emitted_radiance: Vec3::ONE, ..Material::diffuse("wall", Vec3::splat(0.5)) };
    let turn = Affine3A::from_translation(Vec3::new(1e5, -1e5, 1e5)) * Affine3A::from_rotation_y(0.7);
    let scene = Shape::cube().scene(glowing, turn * Affine3A::from_scale(Vec3::splat(4.0)));
    let tracer = Tracer::new(&scene);
    let mut random = Random::new(1);
    for index in 0..2000 {
        let triangle = index % 12;
        let [a, b, c] = tracer.vertices(triangle).map(Vec3::as_dvec3);
        let [s, t] = [0, 1].map(|_| f64::from(0.1 + 0.3 * random.unit()));
        let world = (tracer.traced_from_world.origin() + a + (b - a) * s + (c - a) * t).as_vec3();
        let normal = tracer.normal(triangle);
        let start = tracer.start_at(world, normal);
        assert_eq!(start.normal(), normal);
        let off = (start.origin().as_dvec3() - a).dot((b - a).cross(c - a).normalize());
        // On a floor at traced height 0 itself, before any other wall.
        assert!((0.0..1e-4).contains(&off) && (off > 0.0 || normal.abs() == Vec3::Y), "{world} is {off} off");
    }
}

//! Closed shapes let no ray out: not between triangles, not at vertices, not along symmetry planes, not in corners.

use crate::math::testing::Random;
use crate::trace::accel::Accel;
use crate::trace::testing::{Shape, escapes};
use glam::{Affine3A, Quat, Vec3};

/// A closed convex shape and points inside of it.
struct Vessel {
    name: &'static str,
    shape: Shape,
    centre: Vec3,
    /// Points within this distance of the centre are inside.
    radius: f32,
}

fn vessels() -> Vec<Vessel> {
    let scaled = |vertex: Vec3| 0.01 * vertex + Vec3::new(1000.0, -1000.0, 1000.0);
    let sphere = Shape::icosphere(3);
    let cube = Shape::cube();
    let turn = Quat::from_scaled_axis(Vec3::new(0.3, -1.1, 0.7));
    let vessel = |name, shape, centre, radius| Vessel { name, shape, centre, radius };
    vec![
        vessel("sphere far away", sphere.moved(scaled), scaled(Vec3::ZERO), 0.009),
        vessel("cube far away", cube.moved(scaled), scaled(Vec3::splat(0.5)), 0.0045),
        vessel("turned cube", cube.moved(|vertex| turn * vertex), turn * Vec3::splat(0.5), 0.45),
        vessel("sphere", sphere, Vec3::ZERO, 0.9),
        vessel("cube", cube, Vec3::splat(0.5), 0.45),
    ]
}

/// Rays out of a vessel that find no wall, by both kinds of query.
struct Leaks {
    closest: u32,
    blocked: u32,
    rays: u32,
}

/// Aims from inside at points of the walls, at points of their edges, at their vertices and along the axes.
fn leaks(vessel: &Vessel, triangles: &[[Vec3; 3]], seed: u64) -> Leaks {
    let accel = Accel::new(triangles);
    let mut random = Random::new(seed);
    let mut leaks = Leaks { closest: 0, blocked: 0, rays: 0 };
    let mut aim = |from: Vec3, direction: Vec3| {
        leaks.rays += 1;
        leaks.closest += u32::from(accel.closest(from, direction, f32::INFINITY).is_none());
        leaks.blocked += u32::from(!accel.is_blocked(from, from + 8.0 * vessel.radius * direction));
    };
    for [a, b, c] in vessel.shape.corners() {
        for _ in 0..40 {
            let from = vessel.centre + vessel.radius * random.unit() * random.direction();
            let u = crate::math::square_to_triangle(random.square());
            let s = random.unit();
            for target in
                [a + u.x * (b - a) + u.y * (c - a), a + s * (b - a), b + s * (c - b), c + s * (a - c), a, b, c]
            {
                aim(from, (target - from).normalize());
                // From the centre, rays at edges run within planes of symmetry.
                aim(vessel.centre, (target - vessel.centre).normalize());
            }
        }
    }
    let signs = [1.0, -1.0, 0.0, -0.0, 0.5, -0.5];
    for x in signs {
        for y in signs {
            for z in signs {
                if let Some(direction) = Vec3::new(x, y, z).try_normalize() {
                    aim(vessel.centre, direction);
                    for _ in 0..10 {
                        let offset = vessel.radius * random.unit() * random.direction();
                        aim(vessel.centre + offset, direction);
                        aim(vessel.centre + offset * Vec3::X, direction);
                        aim(vessel.centre + offset * (Vec3::X + Vec3::Z), direction);
                    }
                }
            }
        }
    }
    leaks
}

#[test]
fn no_ray_leaves_a_closed_shape() {
    for vessel in vessels() {
        let found = leaks(&vessel, &vessel.shape.corners(), 1);
        assert_eq!([found.closest, found.blocked], [0, 0], "{} of {} rays", vessel.name, found.rays);
        assert!(found.rays > 10_000, "{}", found.rays);
    }
}

/// Planted: one triangle is missing, or is a little smaller than its place.
#[test]
fn a_hole_is_found() {
    for vessel in vessels() {
        for index in [0, 7] {
            let mut triangles = vessel.shape.corners();
            triangles.remove(index);
            let found = leaks(&vessel, &triangles, 2);
            assert!(found.closest > 10 && found.blocked > 10, "{}", vessel.name);

            let mut triangles = vessel.shape.corners();
            let middle = (triangles[index][0] + triangles[index][1] + triangles[index][2]) / 3.0;
            triangles[index] = triangles[index].map(|vertex| middle + 0.9 * (vertex - middle));
            let found = leaks(&vessel, &triangles, 3);
            assert!(found.closest > 0 && found.blocked > 0, "{}", vessel.name);
        }
    }
}

/// Rays that leave one wall in a corner start beside the other, nearer than any bound on rounding.
#[test]
fn no_walk_leaves_a_cube() {
    let turned = Affine3A::from_rotation_y(0.7) * Affine3A::from_scale(Vec3::new(3.0, -2.0, 5.0));
    for (name, world_from_local, bounces) in [
        ("unit", Affine3A::IDENTITY, 1_000_000),
        ("centred", Affine3A::from_translation(Vec3::splat(-0.5)), 200_000),
        ("millimetres", Affine3A::from_scale(Vec3::splat(1e-3)), 200_000),
        ("kilometres", Affine3A::from_scale(Vec3::splat(1e3)), 200_000),
        ("turned, mirrored", turned, 200_000),
    ] {
        let tracer = Shape::cube().tracer(world_from_local);
        assert_eq!(tracer.triangle_count(), 12);
        assert_eq!(escapes(&tracer, bounces, 1), 0, "{name}");
    }
    assert_eq!(escapes(&Shape::icosphere(3).tracer(Affine3A::IDENTITY), 200_000, 1), 0, "sphere");
}

/// Far from the origin a room is only so many f32 wide, but rays are traced in a frame of their own: no more is lost
/// there than at home. Traced in the world's own numbers, this walk lost 613 of its 200 000 rays.
#[test]
fn no_walk_leaves_a_cube_far_away() {
    for (name, place) in [
        ("along all axes", Vec3::splat(1000.0)),
        ("along one", Vec3::new(0.0, -1000.0, 0.0)),
        ("along two", Vec3::new(1000.0, 0.3, -1000.0)),
    ] {
        let world_from_local = Affine3A::from_translation(place) * Affine3A::from_scale(Vec3::splat(0.01));
        assert_eq!(escapes(&Shape::cube().tracer(world_from_local), 200_000, 1), 0, "{name}");
    }
}

/// The cube with its floor in strips around a square of side 0.02 at `corner`, and that square, whole or halved.
fn cube_with_a_patch(corner: Vec3, is_whole: bool) -> Shape {
    let Shape { mut positions, mut triangles } = Shape::cube();
    triangles.retain(|triangle| triangle.iter().any(|&vertex| positions[vertex as usize].y > 0.0));
    assert_eq!(triangles.len(), 10);
    let mut add = |[x0, x1]: [f32; 2], [z0, z1]: [f32; 2], is_whole: bool| {
        let first = positions.len() as u32;
        positions.extend([(x0, z0), (x0, z1), (x1, z1), (x1, z0)].map(|(x, z)| Vec3::new(x, 0.0, z)));
        triangles.push([first, first + 1, first + 2]);
        if is_whole {
            triangles.push([first, first + 2, first + 3]);
        }
    };
    let (x, z) = ([corner.x, corner.x + 0.02], [corner.z, corner.z + 0.02]);
    // Strips without area are left out when the scene is compiled.
    add([0.0, x[0]], [0.0, 1.0], true);
    add([x[1], 1.0], [0.0, 1.0], true);
    add(x, [0.0, z[0]], true);
    add(x, [z[1], 1.0], true);
    add(x, z, is_whole);
    Shape { positions, triangles }
}

/// Planted: a hole of 1/30 000 of the walls, in the middle of one and in a corner.
#[test]
fn a_walk_finds_a_tiny_hole() {
    for corner in [Vec3::new(0.4, 0.0, 0.2), Vec3::ZERO] {
        let walk = |is_whole| escapes(&cube_with_a_patch(corner, is_whole).tracer(Affine3A::IDENTITY), 1_000_000, 5);
        assert_eq!(walk(true), 0);
        let found = walk(false);
        assert!((5..200).contains(&found), "{found}");
    }
}

//! What a point is told about its surroundings, in places where the answer is plain.

use crate::scene::Material;
use crate::trace::Tracer;
use crate::trace::path::PathStart;
use crate::trace::testing::Shape;
use glam::{Affine3A, Vec3};

fn tracer(shape: &Shape) -> Tracer {
    Tracer::new(&shape.scene(Material::diffuse("grey", Vec3::splat(0.5)), Affine3A::IDENTITY))
}

/// Two shapes in one.
fn both(a: &Shape, b: &Shape) -> Shape {
    let first = a.positions.len() as u32;
    let moved = b.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + first));
    Shape {
        positions: a.positions.iter().chain(&b.positions).copied().collect(),
        triangles: a.triangles.iter().copied().chain(moved).collect(),
    }
}

fn turned_over(shape: &Shape) -> Shape {
    Shape { triangles: shape.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..shape.clone() }
}

/// A cuboid with its fronts outwards.
fn cuboid(low: Vec3, high: Vec3) -> Shape {
    let cube = turned_over(&Shape::cube());
    Shape { positions: cube.positions.iter().map(|&corner| low + corner * (high - low)).collect(), ..cube }
}

/// The square from −1 to 1 at height 0.
fn floor() -> Shape {
    let positions = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| Vec3::new(x, 0.0, z));
    Shape { positions: positions.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]] }
}

/// A start on a horizontal surface at height 0, seen from above.
fn on_floor(tracer: &Tracer, x: f32, z: f32) -> PathStart {
    let hit = tracer.accel.closest(Vec3::new(x, 1e-3, z), Vec3::NEG_Y, 1.0).unwrap();
    tracer.start_on_triangle(hit.triangle, hit.barycentric, Vec3::Y)
}

#[test]
fn a_wall_parts_and_a_step_does_not() {
    // From just below the floor to a height, across it between the two points.
    let open = |height: Option<f32>| {
        let wall = |height| cuboid(Vec3::new(-0.005, -0.1, -1.0), Vec3::new(0.005, height, 1.0));
        let tracer = tracer(&height.map_or_else(floor, |height| both(&floor(), &wall(height))));
        tracer.is_open_between(&on_floor(&tracer, -0.1, 0.3), &on_floor(&tracer, 0.1, 0.3))
    };
    assert!(open(None));
    assert!(open(Some(0.02)), "lower than half the distance, nearly");
    assert!(!open(Some(0.2)));
    assert!(!open(Some(3.0)));
}

#[test]
fn a_wall_that_only_touches_the_floor_parts() {
    for bottom in [0.0, -1e-4, -0.5] {
        let wall = cuboid(Vec3::new(-0.005, bottom, -1.0), Vec3::new(0.005, 1.0, 1.0));
        let tracer = tracer(&both(&floor(), &wall));
        let [left, right] = [-0.02, 0.02].map(|x| on_floor(&tracer, x, 0.1));
        assert!(!tracer.is_open_between(&left, &right), "{bottom}");
        let other = on_floor(&tracer, -0.3, -0.2);
        assert!(tracer.is_open_between(&left, &other) && tracer.is_open_between(&other, &left));
    }
}

/// The chord of a convex surface runs through the body, the way over it does not.
#[test]
fn convex_surfaces_do_not_part_themselves() {
    for levels in 0..4 {
        let tracer = tracer(&turned_over(&Shape::icosphere(levels)));
        for triangle in 0..tracer.triangle_count() as u32 {
            let start = |triangle| tracer.start_on_triangle(triangle, [0.3, 0.3], tracer.normal(triangle));
            let here = start(triangle);
            for other in 0..tracer.triangle_count() as u32 {
                let shares = |vertex: &Vec3| tracer.vertices(triangle).contains(vertex);
                if tracer.vertices(other).iter().filter(|vertex| shares(vertex)).count() == 2 {
                    assert!(tracer.is_open_between(&here, &start(other)), "{levels}: {triangle} and {other}");
                }
            }
        }
    }
}

#[test]
fn inside_is_where_backs_are_seen() {
    let room = Shape { positions: Shape::cube().positions.iter().map(|&p| 4.0 * p - 2.0).collect(), ..Shape::cube() };
    let crate_ = cuboid(Vec3::new(-0.4, -2.1, -0.4), Vec3::new(0.4, -1.2, 0.4));
    // Without the side that it stands on: a hidden face that artists leave out.
    let mut lidless = cuboid(Vec3::new(-0.4, -2.0, -0.4), Vec3::new(0.4, -1.2, 0.4));
    lidless.triangles.retain(|triangle| triangle.iter().any(|&vertex| lidless.positions[vertex as usize].y > -1.9));
    for body in [crate_, lidless] {
        let tracer = tracer(&both(&room, &body));
        let at = |x: f32| PathStart::free(Vec3::new(x, -1.999, 0.1), Vec3::Y);
        assert!(tracer.is_enclosed(&at(0.1)));
        assert!(!tracer.is_enclosed(&at(0.5)), "beside it");
        assert!(!tracer.is_enclosed(&at(-1.9)));
    }
    // Where another body reaches into the one that a point is in.
    let two = both(
        &cuboid(Vec3::splat(-1.0), Vec3::splat(1.0)),
        &cuboid(Vec3::new(0.05, -0.5, -3.0), Vec3::new(0.5, 0.5, 3.0)),
    );
    let tracer = tracer(&two);
    assert!(tracer.is_enclosed(&PathStart::free(Vec3::new(0.0, 0.0, 0.0), Vec3::X)));
    assert!(!tracer.is_enclosed(&PathStart::free(Vec3::new(1.1, 0.0, 0.0), Vec3::X)));
}

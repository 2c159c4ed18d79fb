//! Which pixels show the inside of a diffuse wall: found by rays, so that no noise decides.

use bevy_kiln::scene::{Camera, Scene};
use bevy_kiln::trace::Tracer;
use glam::{Vec2, Vec3};

/// Pixels on every side that must show the same wall.
const MARGIN: usize = 2;

/// Per pixel, the number of the flat wall that it and its neighbours show; `None` at edges, on what glows and where
/// there is nothing.
pub fn walls(scene: &Scene, camera: &Camera, [width, height]: [usize; 2]) -> Vec<Option<usize>> {
    let tracer = Tracer::new(scene);
    let lamps = lamps(scene);
    let eye = Vec3::from(camera.world_from_camera.translation);
    let mut planes: Vec<(Vec3, f32)> = Vec::new();
    let mut seen = Vec::with_capacity(width * height);
    for pixel in 0..width * height {
        let centre = Vec2::new((pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
        let direction = direction(camera, centre, Vec2::new(width as f32, height as f32));
        seen.push(tracer.closest_hit(eye, direction).and_then(|hit| {
            let place = eye + direction * hit.distance;
            let is_lamp = lamps.iter().any(|[low, high]| place.cmpge(*low).all() && place.cmple(*high).all());
            (!is_lamp).then(|| number(&mut planes, hit.normal, hit.normal.dot(place)))
        }));
    }
    let inside = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let is_whole = (MARGIN..width - MARGIN).contains(&x) && (MARGIN..height - MARGIN).contains(&y);
        is_whole
            && (y - MARGIN..=y + MARGIN)
                .all(|row| (x - MARGIN..=x + MARGIN).all(|column| seen[row * width + column] == seen[pixel]))
    };
    (0..seen.len()).map(|pixel| seen[pixel].filter(|_| inside(pixel))).collect()
}

/// A plane's number; new ones are added.
fn number(planes: &mut Vec<(Vec3, f32)>, normal: Vec3, offset: f32) -> usize {
    let same = |plane: &(Vec3, f32)| (plane.0 - normal).length() < 1e-3 && (plane.1 - offset).abs() < 5e-3;
    planes.iter().position(same).unwrap_or_else(|| {
        planes.push((normal, offset));
        planes.len() - 1
    })
}

/// Boxes around what glows [m].
fn lamps(scene: &Scene) -> Vec<[Vec3; 2]> {
    let glowing = scene.instances.iter().filter(|i| scene.materials[i.material].emitted_radiance != Vec3::ZERO);
    let boxes = glowing.map(|instance| {
        let corners = scene.meshes[instance.mesh].positions.iter();
        let corners: Vec<Vec3> = corners.map(|&corner| instance.world_from_local.transform_point3(corner)).collect();
        let low = corners.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let high = corners.iter().copied().reduce(Vec3::max).unwrap_or_default();
        [low - 0.01, high + 0.01]
    });
    boxes.collect()
}

fn direction(camera: &Camera, place: Vec2, size: Vec2) -> Vec3 {
    let centred = (place * 2.0 - size) / size.y * (0.5 * camera.vertical_fov).tan();
    camera.world_from_camera.transform_vector3(Vec3::new(centred.x, -centred.y, -1.0)).normalize()
}

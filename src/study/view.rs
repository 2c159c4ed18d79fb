//! A view of a scene that has no camera: the one of a few that shows most of what is there from its front.

use crate::math::Portable;
use crate::scene::{Camera, Scene};
use crate::trace::Tracer;
use glam::{Affine3A, Vec3};

/// Rays along each side of a trial picture.
const RAYS: i32 = 12;

/// Whole vertical opening angle [rad].
const FOV: f32 = 0.9;

/// Where to look from, in half sizes of the scene's box about its middle: from its upper corners within and from
/// outside on all sides. A closed room shows its walls' backs from outside, and an open one its inside.
const EYES: [[f32; 3]; 10] = [
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.8, 0.6, 1.0],
    [-0.8, 0.6, -1.0],
    [0.85, 0.7, 0.85],
    [-0.85, 0.7, 0.85],
    [0.85, 0.7, -0.85],
    [-0.85, 0.7, -0.85],
];

/// How many of them stand outside, and how far away as a share of what would show all of the box.
const OUTSIDE: usize = 6;

/// A camera that sees as much as possible.
pub(super) fn whole_view(scene: &Scene, tracer: &Tracer) -> Camera {
    let [low, high] = bounds(scene);
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let camera = |(index, eye): (usize, [f32; 3])| {
        let direction = Vec3::from_array(eye);
        let eye = if index < OUTSIDE {
            // So far that the nearest side fills the picture's height.
            let back = Portable::tan(0.5 * FOV).recip() * half.max_element();
            middle + half * direction + direction.normalize_or(Vec3::Z) * back
        } else {
            middle + half * direction
        };
        Camera::look_at("a view of the whole scene", eye, middle - 0.15 * half * Vec3::Y, FOV)
    };
    let mut best: Option<(f32, Camera)> = None;
    for camera in EYES.into_iter().enumerate().map(camera) {
        let score = seen(tracer, &camera, high - low);
        if best.as_ref().is_none_or(|(most, _)| score > *most) {
            best = Some((score, camera));
        }
    }
    best.map_or_else(|| Camera::look_at("origin", Vec3::ONE, Vec3::ZERO, FOV), |(_, camera)| camera)
}

/// How much a coarse picture shows: the share of its rays that meet a surface from its front, times how much of the
/// scene's length, height and depth these places span.
fn seen(tracer: &Tracer, camera: &Camera, size: Vec3) -> f32 {
    let eye = Vec3::from(camera.world_from_camera.translation);
    let half_height = Portable::tan(0.5 * camera.vertical_fov);
    let ray = |cell: i32| {
        let place = |index: i32| (2.0 * index as f32 + 1.0) / RAYS as f32 - 1.0;
        let local = Vec3::new(place(cell % RAYS) * half_height, place(cell / RAYS) * half_height, -1.0);
        camera.world_from_camera.transform_vector3(local).normalize()
    };
    let (mut count, mut low, mut high) = (0.0, Vec3::INFINITY, Vec3::NEG_INFINITY);
    for direction in (0..RAYS * RAYS).map(ray) {
        let Some(hit) = tracer.closest_hit(eye, direction).filter(|hit| hit.normal.dot(direction) < 0.0) else {
            continue;
        };
        let place = eye + hit.distance * direction;
        (count, low, high) = (count + 1.0, low.min(place), high.max(place));
    }
    if count == 0.0 {
        return 0.0;
    }
    let span = (high - low) / size.max(Vec3::splat(f32::MIN_POSITIVE));
    count * span.min(Vec3::ONE).element_sum()
}

/// The box around all that is there [m].
fn bounds(scene: &Scene) -> [Vec3; 2] {
    let mut bounds = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    for instance in &scene.instances {
        let Some(mesh) = scene.meshes.get(instance.mesh) else { continue };
        let place: Affine3A = instance.world_from_local;
        for point in mesh.positions.iter().map(|&point| place.transform_point3(point)).filter(|point| point.is_finite())
        {
            bounds = [bounds[0].min(point), bounds[1].max(point)];
        }
    }
    if bounds[0].cmple(bounds[1]).all() { bounds } else { [Vec3::NEG_ONE, Vec3::ONE] }
}

#[cfg(test)]
mod tests {
    use super::super::testing::box_of_light;
    use super::*;

    /// A closed room is seen from within, and what stands before an open one from outside.
    #[test]
    fn a_room_is_looked_into() {
        let closed = box_of_light();
        let eye = |scene: &Scene| Vec3::from(whole_view(scene, &Tracer::new(scene)).world_from_camera.translation);
        assert!(eye(&closed).abs().max_element() < 1.0, "{}", eye(&closed));
        for axis in 0..3 {
            let mut open = closed.clone();
            let is_wall = |z: f32| {
                (0..6).find(|&side: &usize| {
                    let normal = closed.instances[side].world_from_local.transform_vector3(Vec3::Y);
                    normal[axis] * z > 0.5
                })
            };
            let Some(wall) = is_wall(-1.0).filter(|_| axis != 1) else { continue };
            open.instances.remove(wall);
            assert!(eye(&open)[axis] > 1.0, "{axis}: {}", eye(&open));
        }
    }
}

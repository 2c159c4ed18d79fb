//! A view of a scene that has no camera: the one of a few that shows most of what is there from its front.

use crate::math::Portable;
use crate::scene::{Camera, Scene};
use crate::trace::Tracer;
use glam::{Affine3A, Vec3};

/// Rays along each side of a trial picture.
const RAYS: i32 = 12;

/// Whole vertical opening angle [rad].
const FOV: f32 = 0.9;

/// Where to look from, in half sizes of the scene's box about its middle: from its upper corners within and from outside
/// on all sides. A closed room shows its walls' backs from outside, and an open one its inside.
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
    let mut best: Option<(usize, Camera)> = None;
    for camera in EYES.into_iter().enumerate().map(camera) {
        let score = fronts(tracer, &camera);
        if best.as_ref().is_none_or(|(most, _)| score > *most) {
            best = Some((score, camera));
        }
    }
    best.map_or_else(|| Camera::look_at("origin", Vec3::ONE, Vec3::ZERO, FOV), |(_, camera)| camera)
}

/// How many rays of a coarse picture meet a surface from its front.
fn fronts(tracer: &Tracer, camera: &Camera) -> usize {
    let eye = Vec3::from(camera.world_from_camera.translation);
    let half_height = Portable::tan(0.5 * camera.vertical_fov);
    let ray = |cell: i32| {
        let place = |index: i32| (2.0 * index as f32 + 1.0) / RAYS as f32 - 1.0;
        let local = Vec3::new(place(cell % RAYS) * half_height, place(cell / RAYS) * half_height, -1.0);
        camera.world_from_camera.transform_vector3(local).normalize()
    };
    let is_front =
        |direction: &Vec3| tracer.closest_hit(eye, *direction).is_some_and(|hit| hit.normal.dot(*direction) < 0.0);
    (0..RAYS * RAYS).map(ray).filter(is_front).count()
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

//! Worlds for cases of place, distance and shape: a room, lights of every kind, and the same under another root.

use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{DirectionalLight, Light, PointLight, RectLight, Scene, SpotLight};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

/// A turn after which no side of a box lies along an axis.
pub fn askew() -> Quat {
    Quat::from_axis_angle(Vec3::new(0.48, 0.6, 0.64), 1.0)
}

/// The same scene under another root that scales alike in all directions: lights grow with it, so that their light
/// stays.
pub fn under(mut scene: Scene, root: Affine3A) -> Scene {
    for instance in &mut scene.instances {
        instance.world_from_local = root * instance.world_from_local;
    }
    let scale = root.matrix3.x_axis.length();
    let (direction, position) =
        (|way: Vec3| root.transform_vector3(way).normalize(), |place: Vec3| root.transform_point3(place));
    let bulb = |bulb: &mut PointLight| {
        bulb.position = position(bulb.position);
        bulb.radius *= scale;
        bulb.range = bulb.range.map(|range| range * scale);
        bulb.intensity *= scale * scale;
    };
    for light in &mut scene.lights {
        match light {
            Light::Rect(lamp) => lamp.world_from_local = root * lamp.world_from_local,
            Light::Point(lamp) => bulb(lamp),
            Light::Spot(lamp) => {
                bulb(&mut lamp.bulb);
                lamp.direction = direction(lamp.direction);
            }
            Light::Directional(sun) => sun.direction = direction(sun.direction),
        }
    }
    scene
}

/// Points under the same root.
pub fn points_under(points: &[MeterPoint], root: Affine3A) -> Vec<MeterPoint> {
    points
        .iter()
        .map(|point| at(root.transform_point3(point.position), root.transform_vector3(point.normal).normalize()))
        .collect()
}

/// The scene, whose meshes stand in world space, as f32 rounds its vertices once it is moved by `offset`; at home.
pub fn rounded_by(mut scene: Scene, offset: DVec3) -> Scene {
    for position in scene.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions) {
        *position = ((position.as_dvec3() + offset).as_vec3().as_dvec3() - offset).as_vec3();
    }
    scene
}

/// A closed room of 2 m with a glowing panel under its ceiling and a tilted board, turned askew.
pub fn room() -> Scene {
    in_world_space(under(level_room(), Affine3A::from_quat(askew())))
}

/// The same before it is turned: points on its walls have no error off their planes, so that much less can go wrong.
pub fn level_room() -> Scene {
    let walls = [0.3, 0.7, 0.5, 0.8, 0.6, 0.2].map(grey);
    SceneBuilder::default()
        .room(Vec3::NEG_ONE, Vec3::ONE, walls)
        .quad("lamp", Vec3::new(-0.4, 0.9, -0.3), [Vec3::X * 0.8, Vec3::Z * 0.6], glowing(0.0, 5.0))
        .quad("board", Vec3::new(-0.5, -0.3, -0.4), [Vec3::new(0.2, 0.2, 0.8), Vec3::new(0.7, 0.3, 0.1)], grey(0.4))
        .build()
}

/// The same scene with its vertices moved to where their instances place them.
pub fn in_world_space(mut scene: Scene) -> Scene {
    for instance in &mut scene.instances {
        for position in &mut scene.meshes[instance.mesh].positions {
            *position = instance.world_from_local.transform_point3(*position);
        }
        instance.world_from_local = Affine3A::IDENTITY;
    }
    scene
}

/// Points in the air of [`room`], on the grid that f32 has 10⁵ m away.
pub fn in_the_room() -> Vec<MeterPoint> {
    let grid = |point: Vec3| (point * 128.0).round() / 128.0;
    [
        (Vec3::new(0.3, -0.5, 0.2), Vec3::Y),
        (Vec3::new(-0.2, -0.6, -0.3), Vec3::new(0.6, 0.8, 0.0)),
        (Vec3::new(0.5, 0.3, -0.4), Vec3::NEG_X),
        (Vec3::new(0.1, 0.4, 0.6), Vec3::NEG_Y),
    ]
    .map(|(place, facing)| at(grid(askew() * place), askew() * facing))
    .to_vec()
}

/// A scene of lights alone.
pub fn lit_by(lights: impl IntoIterator<Item = Light>) -> Scene {
    Scene { lights: lights.into_iter().collect(), ..Scene::default() }
}

/// A rectangle of 1 cd/m² at `centre` that shines along `direction`.
pub fn rectangle(centre: Vec3, direction: Vec3, size: Vec2) -> RectLight {
    let rotation = Quat::from_rotation_arc(Vec3::NEG_Z, direction.normalize());
    RectLight {
        id: StableId::new("rectangle"),
        name: "rectangle".into(),
        world_from_local: Affine3A::from_rotation_translation(rotation, centre),
        width: size.x,
        height: size.y,
        radiance: Vec3::ONE,
        range: None,
    }
}

/// A sphere, or a point, of 1 cd.
pub fn bulb(position: Vec3, radius: f32) -> PointLight {
    let (id, name) = (StableId::new("bulb"), "bulb".into());
    PointLight { id, name, position, intensity: Vec3::ONE, radius, range: None }
}

/// A lamp at `position` that shines down into a cone, 1 cd on its axis.
pub fn spot(position: Vec3, inner_angle: f32, outer_angle: f32) -> SpotLight {
    SpotLight { bulb: bulb(position, 0.0), direction: Vec3::NEG_Y, inner_angle, outer_angle }
}

/// A sun of 1 lx, `towards` which one looks.
pub fn sun(towards: Vec3, angular_diameter: f32) -> DirectionalLight {
    let (id, name) = (StableId::new("sun"), "sun".into());
    DirectionalLight { id, name, direction: -towards, illuminance: Vec3::ONE, angular_diameter }
}

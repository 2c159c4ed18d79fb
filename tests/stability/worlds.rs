//! Whole scenes that several groups of cases use, and how a scene is moved, turned, scaled and joined with another.
//!
//! What scenes are made of is in [`crate::things`]; what is asked of them in [`crate::judge`].

use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{Light, PointLight, Scene};
use glam::{Affine3A, DVec3, Mat3, Quat, Vec3};

/// A turn after which no side of a box lies along an axis.
pub fn askew() -> Quat {
    Quat::from_axis_angle(Vec3::new(0.48, 0.6, 0.64), 1.0)
}

/// The same turn, some metres away.
pub fn askew_aside() -> Affine3A {
    Affine3A::from_rotation_translation(askew(), Vec3::new(3.1, -2.7, 5.3))
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

/// The same scene with its vertices moved to where their instances place them.
fn in_world_space(mut scene: Scene) -> Scene {
    for instance in &mut scene.instances {
        for position in &mut scene.meshes[instance.mesh].positions {
            *position = instance.world_from_local.transform_point3(*position);
        }
        instance.world_from_local = Affine3A::IDENTITY;
    }
    scene
}

/// The same scene, each of whose instances has an id of its name after this word.
pub fn renamed(mut scene: Scene, word: &str) -> Scene {
    for instance in &mut scene.instances {
        instance.id = StableId::new(format!("{word} {}", instance.name));
    }
    scene
}

/// Both scenes' meshes in one, under the sky and the lights of the first.
pub fn joined(mut scene: Scene, mut other: Scene) -> Scene {
    for instance in &mut other.instances {
        instance.mesh += scene.meshes.len();
        instance.material += scene.materials.len();
    }
    scene.meshes.append(&mut other.meshes);
    scene.materials.append(&mut other.materials);
    scene.instances.append(&mut other.instances);
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

/// A closed room of side 2 around the origin whose walls are of albedo ½ and of radiance 1, whatever loses no light
/// may stand in it: E = π everywhere.
pub fn room_of_radiance_one() -> SceneBuilder {
    SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [(); 6].map(|()| glowing(0.5, 0.5)))
}

/// A closed box of side 2 around the origin of this albedo, under a sky of this radiance [cd/m²]: it is dark inside.
pub fn dark_box(albedo: f32, sky: f32) -> Scene {
    SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [albedo; 6].map(grey)).sky(Vec3::splat(sky)).build()
}

/// A root under which that box's floor and its −x wall meet at 40°, as its ceiling and its +x wall do.
pub fn leaning() -> Affine3A {
    askew_aside() * Affine3A::from_mat3(Mat3::from_cols(Vec3::X, Vec3::new(1.2, 1.0, 0.0), Vec3::Z))
}

/// Points in the box that leans, a millimetre from its narrow edges.
pub fn near_narrow_edges() -> Vec<MeterPoint> {
    let along = [-0.9, -1.0 / 3.0, -0.332, 0.4, 0.999];
    let sides = [(Vec3::new(-0.999, -1.0, 0.0), Vec3::Y), (Vec3::new(0.999, 1.0, 0.0), Vec3::NEG_Y)];
    let point =
        |(place, facing): (Vec3, Vec3), z: f32| at(leaning().transform_point3(place.with_z(z)), askew() * facing);
    sides.into_iter().flat_map(|side| along.map(|z| point(side, z))).collect()
}

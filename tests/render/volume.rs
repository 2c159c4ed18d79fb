//! Irradiance volumes on what moves: every pixel of a white sphere against the port of Bevy's lookup, from a folder that
//! was written, loaded and applied as a game does it; with one volume within another, and a turned one.

use crate::common::volume::{Bound, look_up};
use crate::renderer::{EXPOSURE, Screen, app, show, spawn_camera};
use bevy::prelude::*;
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{Lightmap, ProbeState, Volume};
use bevy_kiln::output::{OutputFormat, write_bake};
use bevy_kiln::prelude::*;
use temp_dir::TempDir;

const SIDE: u32 = 64;
const RADIUS: f32 = 0.4;

/// From the sphere to the camera [m]: so far that the picture is nearly a parallel one.
const DISTANCE: f32 = 20.0;

/// Half floats, a mesh of triangles instead of a sphere, and 11 bits of a texel.
const TOLERANCE: f32 = 0.005;

/// A volume whose faces and places all differ.
fn volume(centre: Vec3, size: Vec3, rotation: Quat, falloff: f32, level: f32) -> Volume {
    let resolution = UVec3::new(3, 2, 4);
    let cube = |probe: u32| {
        let place = probe as f32 / 24.0;
        std::array::from_fn(|face| level * Vec3::new(0.2 + face as f32 / 4.0, 1.2 - place, 0.3 + 0.5 * place))
    };
    let count = resolution.element_product();
    Volume {
        id: StableId::new(format!("volume at {centre}")),
        centre,
        rotation,
        size,
        resolution,
        falloff,
        cubes: (0..count).map(cube).collect(),
        probes: vec![ProbeState::Measured; count as usize],
    }
}

#[test]
fn a_sphere_is_lit_as_the_port_of_the_shader_says() {
    let Some(mut app) = app() else { return };
    let turned = Quat::from_euler(EulerRot::YXZ, 0.7, 0.4, -0.3);
    let volumes = [
        volume(Vec3::ZERO, Vec3::splat(8.0), Quat::IDENTITY, 1000.0, 1.0),
        volume(Vec3::new(0.1, 0.2, -0.1), Vec3::new(2.0, 1.8, 2.2), turned, 0.0, 3.0),
    ];
    let folder = TempDir::new().unwrap();
    write_bake(&Lightmap::default(), &volumes, "sphere", folder.path(), OutputFormat::Rgba16f).unwrap();
    let (mesh, material) = {
        let world = app.world_mut();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(Sphere::new(RADIUS).mesh().ico(48).unwrap());
        let look =
            StandardMaterial { base_color: Color::WHITE, reflectance: 0.0, perceptual_roughness: 1.0, ..default() };
        (mesh, world.resource_mut::<Assets<StandardMaterial>>().add(look))
    };
    let sphere = app.world_mut().spawn((Mesh3d(mesh), MeshMaterial3d(material), Transform::default())).id();
    let fov = 2.0 * (1.2 * RADIUS / DISTANCE).atan();
    let camera = spawn_camera(app.world_mut(), [SIDE, SIDE], fov, Transform::default());

    let baked: Handle<BakedFolder> = app.world().resource::<AssetServer>().load(folder.path().join("kiln.ron"));
    let root = app.world_mut().spawn(BakedLightmaps(baked.clone())).id();
    for frame in 0.. {
        show(&mut app);
        if app.world().resource::<AssetServer>().is_loaded_with_dependencies(&baked) {
            break;
        }
        assert!(frame < 1000, "the folder does not load");
    }
    let bound: Vec<Bound> = volumes.iter().map(Bound::new).collect();
    // In the inner volume, and outside of it, in the outer one alone; seen from three sides.
    for place in [Vec3::new(0.1, 0.1, 0.0), Vec3::new(-2.5, 1.5, 2.0)] {
        for from in [Vec3::new(1.0, 0.5, 0.8), Vec3::new(-0.6, -1.0, 0.3), Vec3::new(-0.2, 0.7, -1.0)] {
            let eye = Transform::from_translation(place + DISTANCE * from.normalize()).looking_at(place, Vec3::Y);
            *app.world_mut().get_mut::<Transform>(sphere).unwrap() = Transform::from_translation(place);
            *app.world_mut().get_mut::<Transform>(camera).unwrap() = eye;
            show(&mut app);
            let seen = &app.world().resource::<Screen>().0;
            let worst = worst(seen, &bound, place, eye, fov);
            println!("at {place} from {from}: worst pixel off by {:.2} %", 100.0 * worst);
            assert!(worst < TOLERANCE, "at {place} from {from}");
            // The check itself: another place's light, or faces that are swapped, would not pass.
            let other = [Bound::new(&volumes[0])];
            assert!(place.x < -1.0 || self::worst(seen, &other, place, eye, fov) > 2.0 * TOLERANCE);
            let mut swapped = volumes.clone();
            swapped.iter_mut().flat_map(|volume| &mut volume.cubes).for_each(|cube| cube.swap(2, 3));
            let swapped: Vec<Bound> = swapped.iter().map(Bound::new).collect();
            assert!(self::worst(seen, &swapped, place, eye, fov) > 2.0 * TOLERANCE);
        }
    }
    app.world_mut().entity_mut(root).remove::<BakedLightmaps>();
    show(&mut app);
    assert!(app.world().resource::<Screen>().0.iter().all(|pixel| *pixel == Vec3::ZERO), "taken off");
}

/// The worst pixel's error over what it should be, over the sphere but for its rim.
fn worst(seen: &[Vec3], bound: &[Bound], centre: Vec3, eye: Transform, fov: f32) -> f32 {
    let mut worst = 0.0_f32;
    let mut count = 0;
    for (index, &seen) in seen.iter().enumerate() {
        let pixel = Vec2::new((index as u32 % SIDE) as f32 + 0.5, (index as u32 / SIDE) as f32 + 0.5);
        let on_plane = (pixel * 2.0 / SIDE as f32 - 1.0) * (0.5 * fov).tan();
        let direction = eye.rotation * Vec3::new(on_plane.x, -on_plane.y, -1.0).normalize();
        let nearest = (centre - eye.translation).dot(direction);
        let miss = (eye.translation + direction * nearest - centre).length();
        if miss > 0.9 * RADIUS {
            continue;
        }
        let point = eye.translation + direction * (nearest - (RADIUS * RADIUS - miss * miss).sqrt());
        let expected = look_up(bound, point, (point - centre) / RADIUS) * EXPOSURE as f32;
        worst = worst.max(((seen - expected).abs() / expected.max_element()).max_element());
        count += 1;
    }
    assert!(count > 1500, "{count} pixels");
    worst
}

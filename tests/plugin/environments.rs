//! Pictures of the sky as the scene gets them.

use super::{app, data};
use bevy::asset::RenderAssetUsages;
use bevy::light::{AtmosphereEnvironmentMapLight, EnvironmentMapLight, GeneratedEnvironmentMapLight, LightProbe};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_kiln::plugin::{Extraction, SceneSettings, extract_scene};
use bevy_kiln::scene::EnvironmentMap;
use std::f64::consts::PI;

/// A cube of `side`, each texel from its face and place.
fn cube(side: u32, texel: impl Fn(u32, u32, u32) -> Vec3) -> Image {
    let size = Extent3d { width: side, height: side, depth_or_array_layers: 6 };
    let mut bytes = Vec::new();
    for (face, row, column) in (0..6).flat_map(|f| (0..side).flat_map(move |r| (0..side).map(move |c| (f, r, c)))) {
        let colour = texel(face, row, column).extend(1.0).to_array();
        bytes.extend(colour.iter().flat_map(|channel| channel.to_le_bytes()));
    }
    Image::new(size, TextureDimension::D2, bytes, TextureFormat::Rgba32Float, RenderAssetUsages::default())
}

/// One colour per face, +X, -X, +Y, -Y, +Z, -Z.
fn six_colours() -> Image {
    cube(4, |face, _, _| Vec3::splat((face + 1) as f32))
}

fn extract(settings: &SceneSettings, spawn: impl FnOnce(&mut World)) -> Extraction {
    let mut app = app(&data(""));
    app.insert_resource(GlobalAmbientLight::NONE);
    spawn(app.world_mut());
    app.update();
    extract_scene(app.world_mut(), settings)
}

fn on_a_camera(image: Image, intensity: f32, rotation: Quat) -> EnvironmentMap {
    let extraction = extract(&SceneSettings::default(), |world| {
        let specular_map = world.resource_mut::<Assets<Image>>().add(image);
        let light = EnvironmentMapLight { specular_map, intensity, rotation, ..default() };
        world.spawn((Camera3d::default(), light));
    });
    assert_eq!(extraction.warnings, []);
    extraction.scene.environment.unwrap()
}

/// What arrives from a direction in the world.
fn seen(map: &EnvironmentMap, direction: Vec3) -> Vec3 {
    let place = EnvironmentMap::place_of(map.world_from_map.inverse() * direction.normalize());
    let pixel = |share: f32, count: u32| ((share * count as f32) as u32).min(count - 1);
    map.radiance[(pixel(place.y, map.height) * map.width + pixel(place.x, map.width)) as usize]
}

/// ∫ L dω and ∫ L ω dω, in f64: the light from all around and where it mostly comes from.
fn moments(map: &EnvironmentMap) -> (f64, glam::DVec3) {
    let (mut all, mut vector) = (0.0, glam::DVec3::ZERO);
    for (pixel, radiance) in map.radiance.iter().enumerate() {
        let (row, column) = (pixel as u32 / map.width, pixel as u32 % map.width);
        let cosine = |row: u32| (f64::from(row) * PI / f64::from(map.height)).cos();
        let area = (cosine(row) - cosine(row + 1)) * 2.0 * PI / f64::from(map.width);
        let centre = [(column as f32 + 0.5) / map.width as f32, (row as f32 + 0.5) / map.height as f32];
        let direction = EnvironmentMap::direction_of(centre.into());
        all += f64::from(radiance.x) * area;
        vector += direction.as_dvec3() * f64::from(radiance.x) * area;
    }
    (all, vector)
}

#[test]
fn a_cubes_faces_lie_where_bevy_shows_them() {
    let map = on_a_camera(six_colours(), 2.0, Quat::IDENTITY);
    // Cube maps are left-handed: Bevy negates z before it looks.
    let faces =
        [(Vec3::X, 1.0), (Vec3::NEG_X, 2.0), (Vec3::Y, 3.0), (Vec3::NEG_Y, 4.0), (Vec3::NEG_Z, 5.0), (Vec3::Z, 6.0)];
    for (direction, face) in faces {
        assert_eq!(seen(&map, direction), Vec3::splat(2.0 * face), "{direction}");
    }
    // Turned so that what was at +X comes from +Y.
    let turned = on_a_camera(six_colours(), 1.0, Quat::from_rotation_z(std::f32::consts::FRAC_PI_2));
    assert_eq!(seen(&turned, Vec3::Y), Vec3::ONE);
    assert_eq!(seen(&turned, Vec3::X), Vec3::splat(4.0));
}

#[test]
fn rows_and_columns_of_a_face_lie_where_graphics_interfaces_have_them() {
    // Top left of each face, by hand from the table in the Vulkan specification, with z negated.
    let corners = [
        (0, Vec3::new(1.0, 1.0, -1.0)),
        (1, Vec3::new(-1.0, 1.0, 1.0)),
        (2, Vec3::new(-1.0, 1.0, 1.0)),
        (3, Vec3::new(-1.0, -1.0, -1.0)),
        (4, Vec3::new(-1.0, 1.0, -1.0)),
        (5, Vec3::new(1.0, 1.0, 1.0)),
    ];
    for (lit, corner) in corners {
        let top_left =
            cube(4, |face, row, column| if (face, row, column) == (lit, 0, 0) { Vec3::ONE } else { Vec3::ZERO });
        let map = on_a_camera(top_left, 1.0, Quat::IDENTITY);
        // Well inside the texel: its middle is at three quarters of the way to the corner.
        let axis = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::Z][lit as usize];
        let middle = axis + 0.75 * (corner - axis * corner.dot(axis));
        assert!(seen(&map, middle).x > 0.9, "face {lit}: {}", seen(&map, middle));
    }
}

#[test]
fn resampling_keeps_the_light() {
    let constant = on_a_camera(cube(3, |_, _, _| Vec3::splat(7.0)), 1.0, Quat::IDENTITY);
    assert!(constant.radiance.iter().all(|&radiance| (radiance - Vec3::splat(7.0)).length() < 1e-4));
    let (all, _) = moments(&constant);
    assert!((all / (28.0 * PI) - 1.0).abs() < 1e-5, "{all}");
    // All light from one texel of 64², a sun; its solid angle by the formula for a corner of a cube's face.
    let corner = |x: f64, y: f64| (x * y).atan2((x * x + y * y + 1.0).sqrt());
    let side = 64;
    for (sun_row, sun_column) in [(31, 40), (0, 63), (12, 5)] {
        for sun_face in [0, 2, 5] {
            let sun =
                |face, row, column| if (face, row, column) == (sun_face, sun_row, sun_column) { 1e4 } else { 0.0 };
            let map = on_a_camera(cube(side, |f, r, c| Vec3::splat(sun(f, r, c))), 1.0, Quat::IDENTITY);
            let at = |texel: u32| 2.0 * f64::from(texel) / f64::from(side) - 1.0;
            let [x0, x1, y0, y1] = [at(sun_column), at(sun_column + 1), at(sun_row), at(sun_row + 1)];
            let expected = 1e4 * (corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0));
            let (all, vector) = moments(&map);
            let off = all / expected - 1.0;
            assert!(off.abs() < 0.005, "face {sun_face} at {sun_row}, {sun_column}: {off}");
            assert!(vector.length() / all > 0.999, "it comes from one place");
        }
    }
}

#[test]
fn a_picture_asked_for_takes_the_place_of_a_cameras() {
    let mut world_image = None;
    let mut app = app(&data(""));
    app.insert_resource(GlobalAmbientLight::NONE);
    let world = app.world_mut();
    let mut images = world.resource_mut::<Assets<Image>>();
    let size = Extent3d { width: 4, height: 2, depth_or_array_layers: 1 };
    let bytes = (0..32).flat_map(|number: u8| f32::from(number).to_le_bytes()).collect();
    let usage = RenderAssetUsages::default();
    let flat = Image::new(size, TextureDimension::D2, bytes, TextureFormat::Rgba32Float, usage);
    world_image.replace(images.add(flat));
    let specular_map = images.add(six_colours());
    world.spawn((
        Name::new("eye"),
        Camera3d::default(),
        EnvironmentMapLight { specular_map, intensity: 1.0, ..default() },
    ));
    app.update();
    let settings = SceneSettings { environment: world_image, ..default() };
    let Extraction { scene, warnings, .. } = extract_scene(app.world_mut(), &settings);
    let map = scene.environment.unwrap();
    assert_eq!((map.width, map.height, map.radiance[5]), (4, 2, Vec3::new(20.0, 21.0, 22.0)));
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].to_string().contains("the environment map of \"eye\" is not baked"), "{}", warnings[0]);
}

#[test]
fn what_is_filtered_at_run_time_is_read_from_its_own_picture() {
    let extraction = extract(&SceneSettings::default(), |world| {
        let environment_map = world.resource_mut::<Assets<Image>>().add(six_colours());
        let light = GeneratedEnvironmentMapLight { environment_map, intensity: 1.0, ..default() };
        world.spawn((Camera3d::default(), light));
    });
    assert_eq!(extraction.warnings, []);
    assert_eq!(seen(&extraction.scene.environment.unwrap(), Vec3::Y), Vec3::splat(3.0));
}

#[test]
fn what_is_local_made_by_shaders_or_unreadable_is_named() {
    let extraction = extract(&SceneSettings::default(), |world| {
        let mut images = world.resource_mut::<Assets<Image>>();
        let good = images.add(six_colours());
        let mut gone = six_colours();
        gone.data = None;
        let gone = images.add(gone);
        let light = |map: &Handle<Image>, intensity| {
            let (specular_map, diffuse_map) = (map.clone(), good.clone());
            EnvironmentMapLight { specular_map, diffuse_map, intensity, ..default() }
        };
        let lights = [light(&good, 1.0), light(&gone, 1.0), light(&good, 0.0), light(&good, 1.0)];
        let [local, blurred, off, nowhere] = lights;
        world.spawn((Name::new("probe"), LightProbe::default(), local));
        world.spawn((Name::new("air"), Camera3d::default(), AtmosphereEnvironmentMapLight::default()));
        world.spawn((Name::new("eye"), Camera3d::default(), blurred));
        world.spawn((Name::new("dark"), Camera3d::default(), off));
        world.spawn((Name::new("thing"), Transform::default(), nowhere));
    });
    let warnings: Vec<String> = extraction.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings.len(), 3, "{warnings:?}");
    for sentence in [
        "the local environment map of \"probe\" is not baked",
        "the light of the atmosphere of \"air\" is not baked",
        "the specular map of \"eye\" is in the render world only",
    ] {
        assert!(warnings.iter().any(|warning| warning.starts_with(sentence)), "{sentence}: {warnings:?}");
    }
    assert!(extraction.scene.environment.is_some(), "the diffuse map stands in");
}

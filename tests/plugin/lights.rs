//! Lights as Bevy has them and as the scene gets them.

use super::{app, data, glb, lit_floor, run_until_baked, small};
use bevy::light::{DirectionalLightTexture, PointLightTexture, SpotLightTexture, SunDisk};
use bevy::prelude::*;
use bevy_kiln::plugin::windowless::open_scene;
use bevy_kiln::plugin::{Extraction, RangeWindow, SceneSettings, extract_scene};
use bevy_kiln::prelude::ClearLightmaps;
use bevy_kiln::scene::{DirectionalLight as Sun, Light, PointLight as Bulb, SpotLight as Spot};
use std::f32::consts::{FRAC_PI_2, PI};

fn extract(lights: impl FnOnce(&mut World)) -> Extraction {
    let mut app = app(&data(""));
    app.insert_resource(GlobalAmbientLight::NONE);
    lights(app.world_mut());
    app.update();
    extract_scene(app.world_mut(), &SceneSettings::default())
}

fn one(extraction: &Extraction) -> &Light {
    assert_eq!(extraction.warnings, []);
    assert_eq!(extraction.scene.lights.len(), 1);
    &extraction.scene.lights[0]
}

fn near(a: Vec3, b: Vec3) {
    assert!((a - b).length() <= 1e-5 * b.length().max(1.0), "{a} is not {b}");
}

/// A place that turns, scales and moves.
fn place() -> Transform {
    Transform::from_xyz(1.0, 2.0, 3.0).looking_to(Vec3::new(1.0, -2.0, 0.5), Vec3::Y).with_scale(Vec3::splat(3.0))
}

/// Linear (1, 0.5, 0.25).
fn orange() -> Color {
    Color::linear_rgb(1.0, 0.5, 0.25)
}

#[test]
fn a_rectangular_light_has_bevys_radiance() {
    let mut app = lit_floor();
    let scene = extract_scene(app.world_mut(), &SceneSettings::default()).scene;
    let Light::Rect(light) = &scene.lights[0] else { panic!("{:?}", scene.lights) };
    // 100 lm from 1 m²: 100/π cd/m².
    assert!((light.radiance - Vec3::splat(31.830_988)).abs().max_element() < 1e-4, "{light:?}");
    assert_eq!((light.width, light.height, light.range), (1.0, 1.0, Some(20.0)));
    assert!((light.world_from_local.transform_vector3(Vec3::NEG_Z) - Vec3::NEG_Y).length() < 1e-6);
}

#[test]
fn a_point_light_spreads_its_power_over_the_sphere() {
    let light = PointLight { intensity: 800.0, color: orange(), radius: 0.1, range: 7.0, ..default() };
    let extraction = extract(|world| {
        world.spawn((Name::new("bulb"), light, place()));
    });
    let Light::Point(Bulb { name, position, intensity, radius, range, .. }) = one(&extraction) else { panic!() };
    assert_eq!((name.as_str(), *position, *radius, *range), ("bulb", Vec3::new(1.0, 2.0, 3.0), 0.1, Some(7.0)));
    near(*intensity, Vec3::new(1.0, 0.5, 0.25) * (800.0 / (4.0 * PI)));
}

#[test]
fn a_spot_light_is_a_point_light_behind_a_cone() {
    let spot = |inner_angle, outer_angle| {
        let light = SpotLight { intensity: 4.0 * PI, radius: 0.2, range: 0.2, inner_angle, outer_angle, ..default() };
        let extraction = extract(|world| {
            world.spawn((light, place()));
        });
        let Light::Spot(spot) = one(&extraction) else { panic!() };
        spot.clone()
    };
    let Spot { bulb, direction, inner_angle, outer_angle } = spot(0.3, 0.6);
    near(bulb.intensity, Vec3::ONE);
    // A radius that equals the range is a slip of the glTF loader only.
    assert_eq!((bulb.radius, bulb.range, inner_angle, outer_angle), (0.2, Some(0.2), 0.3, 0.6));
    near(direction, Vec3::new(1.0, -2.0, 0.5).normalize());
    let wide = spot(2.0, 3.0);
    assert!(wide.outer_angle < FRAC_PI_2 && wide.inner_angle < wide.outer_angle, "{wide:?}");
}

#[test]
fn a_directional_light_has_a_disc_where_it_is_asked_for() {
    let sun = |disc: Option<SunDisk>| {
        let light = DirectionalLight { illuminance: 10_000.0, color: orange(), ..default() };
        let extraction = extract(|world| {
            let mut sun = world.spawn((light, place()));
            if let Some(disc) = disc {
                sun.insert(disc);
            }
        });
        let Light::Directional(sun) = one(&extraction) else { panic!() };
        sun.clone()
    };
    let Sun { direction, illuminance, angular_diameter, .. } = sun(None);
    near(direction, Vec3::new(1.0, -2.0, 0.5).normalize());
    near(illuminance, Vec3::new(1e4, 5e3, 2.5e3));
    assert_eq!(angular_diameter, 0.0);
    assert_eq!(sun(Some(SunDisk::EARTH)).angular_diameter, SunDisk::EARTH.angular_size);
    assert_eq!(sun(Some(SunDisk::OFF)).angular_diameter, 0.0);
}

#[test]
fn hidden_lights_are_out_and_pictures_before_lights_are_named() {
    let extraction = extract(|world| {
        let image = Handle::<Image>::default();
        world.spawn((Name::new("hidden"), PointLight::default(), Visibility::Hidden));
        let cubemap_layout = bevy::camera::primitives::CubemapLayout::CrossVertical;
        world.spawn((
            Name::new("a"),
            PointLight::default(),
            PointLightTexture { image: image.clone(), cubemap_layout },
        ));
        world.spawn((Name::new("b"), SpotLight::default(), SpotLightTexture { image: image.clone() }));
        world.spawn((Name::new("c"), DirectionalLight::default(), DirectionalLightTexture { image, tiled: false }));
    });
    let names: Vec<&str> = extraction.scene.lights.iter().map(Light::name).collect();
    assert_eq!(names, ["a", "b", "c"]);
    let warnings: Vec<String> = extraction.warnings.iter().map(ToString::to_string).collect();
    let parts = ["\"hidden\" is hidden", "(PointLightTexture)", "(SpotLightTexture)", "(DirectionalLightTexture)"];
    assert_eq!(warnings.len(), parts.len(), "{warnings:?}");
    for (warning, part) in warnings.iter().zip(parts) {
        assert!(warning.contains(part), "{warning}");
    }
}

/// The lights of a file, by name: candela and lux as they stand there, and no range where there is none.
#[test]
fn what_the_gltf_loader_adds_is_taken_away_again() {
    let folder = temp_dir::TempDir::new().unwrap();
    let mut file = glb::Glb::read(&data("punctual.glb"));
    let lights = file.json["extensions"]["KHR_lights_punctual"]["lights"].as_array_mut().unwrap();
    let cone = serde_json::json!({ "innerConeAngle": 0.25, "outerConeAngle": 0.5 });
    lights.push(serde_json::json!({ "type": "spot", "name": "far", "intensity": 6.0, "spot": cone }));
    lights.push(serde_json::json!({ "type": "spot", "name": "near", "intensity": 7.0, "range": 4.0, "spot": cone }));
    for (light, name) in [(2, "far"), (3, "near")] {
        let extension = serde_json::json!({ "KHR_lights_punctual": { "light": light } });
        file.json["nodes"].as_array_mut().unwrap().push(serde_json::json!({ "name": name, "extensions": extension }));
        file.json["scenes"][0]["nodes"].as_array_mut().unwrap().push((light + 1).into());
    }
    let path = folder.path().join("lights.glb");
    file.write(&path);
    let mut app = open_scene(&path).unwrap();
    let Extraction { scene, warnings, .. } = extract_scene(app.world_mut(), &SceneSettings::default());
    assert_eq!(warnings, []);
    let find = |name: &str| scene.lights.iter().find(|light| light.name().ends_with(name)).unwrap();
    let Light::Point(point) = find("pt/pt") else { panic!() };
    near(point.intensity, Vec3::splat(5.0));
    assert_eq!((point.range, point.radius, point.position), (None, 0.0, Vec3::new(0.5, 2.0, -0.25)));
    let Light::Directional(sun) = find("sun/sun") else { panic!() };
    near(sun.illuminance, Vec3::splat(3.0));
    let Light::Spot(far) = find("far/far") else { panic!() };
    near(far.bulb.intensity, Vec3::splat(6.0));
    assert_eq!((far.bulb.range, far.bulb.radius, far.inner_angle, far.outer_angle), (None, 0.0, 0.25, 0.5));
    let Light::Spot(near_one) = find("near/near") else { panic!() };
    assert_eq!((near_one.bulb.range, near_one.bulb.radius), (Some(4.0), 0.0));
    let settings = SceneSettings { range: RangeWindow::Ignore, ..default() };
    let scene = extract_scene(app.world_mut(), &settings).scene;
    let range = |light: &Light| match light {
        Light::Spot(spot) => spot.bulb.range,
        Light::Point(bulb) => bulb.range,
        Light::Rect(rect) => rect.range,
        Light::Directional(_) => None,
    };
    assert!(scene.lights.len() == 4 && scene.lights.iter().all(|light| range(light).is_none()));
}

/// Every kind of light is kept off lightmapped meshes once it is in the lightmaps, and given back by clearing.
#[test]
fn baked_lights_are_muted_and_given_back() {
    let mut app = lit_floor();
    let world = app.world_mut();
    let lights = [
        world.spawn((Name::new("bulb"), PointLight::default(), Transform::from_xyz(0.0, 1.0, 0.0))).id(),
        world.spawn((Name::new("spot"), SpotLight::default(), Transform::from_xyz(0.0, 1.0, 0.0))).id(),
        world.spawn((Name::new("sun"), DirectionalLight::default())).id(),
        // One that its owner keeps off lightmaps anyhow.
        world.spawn((Name::new("kept off"), PointLight { affects_lightmapped_mesh_diffuse: false, ..default() })).id(),
    ];
    let flags = |world: &World| {
        lights.map(|light| {
            let light = world.entity(light);
            let point = light.get::<PointLight>().map(|light| light.affects_lightmapped_mesh_diffuse);
            let spot = light.get::<SpotLight>().map(|light| light.affects_lightmapped_mesh_diffuse);
            let sun = light.get::<DirectionalLight>().map(|light| light.affects_lightmapped_mesh_diffuse);
            point.or(spot).or(sun)
        })
    };
    let before = flags(world);
    assert_eq!(before, [Some(true), Some(true), Some(true), Some(false)]);
    app.world_mut().trigger(small());
    let baked = run_until_baked(&mut app, 1);
    assert_eq!(baked.lightmap.baked_lights.len(), 5);
    assert_eq!(flags(app.world()), [Some(false); 4]);
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    assert_eq!(flags(app.world()), before);
}

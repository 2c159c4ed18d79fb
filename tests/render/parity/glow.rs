//! What Bevy shows otherwise or does not let light anything, against closed forms: ambient light, and surfaces that
//! glow. The radiance of what glows is read off the screen: what glows there lights the room.

use super::stage::{self, Shown};
use super::verdict::compare;
use super::{direct, picture};
use crate::renderer::{EXPOSURE, Screen, app, bake, show};
use bevy::asset::RenderAssetUsages;
use bevy::image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor};
use bevy::math::Affine2;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_kiln::math::polygon_irradiance;
use bevy_kiln::prelude::*;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Middle and half the side of a level square above the hill.
const GLOWING: DVec3 = DVec3::new(0.0, 1.2, -0.6);
const GLOWING_HALF: f64 = 0.3;
const GLOW: Vec3 = Vec3::new(20.0, 15.0, 10.0);

/// Bevy shows ambient light through an approximation that takes away more than half of it, so that there is only the
/// closed form to hold it against: E = π L where nothing is in the way.
#[test]
fn ambient_light_and_what_glows_are_baked_by_their_closed_forms() {
    let Some(mut app) = app() else { return };
    stage::spawn(app.world_mut());
    let stage = stage::shown();
    let albedo = stage::pieces().map(|piece| piece.albedo);
    let ambient = GlobalAmbientLight { color: Color::linear_rgb(1.0, 0.5, 0.25), brightness: 2.0, ..default() };
    app.insert_resource(ambient);
    let scene = SceneSettings { ambient: AmbientMode::Bake, ..direct().scene };
    bake(&mut app, BakeLightmaps { scene, ..direct() });
    let expected = stage.iter().flatten().map(|at| DVec3::new(2.0, 1.0, 0.5) * albedo[at.piece] * EXPOSURE);
    let difference = compare(&picture(&app, &stage), &expected.collect::<Vec<_>>());
    println!("ambient: {difference:?}");
    difference.verdict().unwrap();
    app.world_mut().trigger(ClearLightmaps);
    app.insert_resource(GlobalAmbientLight::NONE);

    let emissive = StandardMaterial {
        base_color: Color::BLACK,
        reflectance: 0.0,
        emissive: LinearRgba::rgb(GLOW.x, GLOW.y, GLOW.z),
        ..default()
    };
    let [west, east] = lights_the_hill(&mut app, &stage, "emissive", emissive);
    for half in [west, east] {
        assert!((half / (1.2 * GLOW.as_dvec3()) - 1.0).abs().max_element() < 2e-3, "{half}");
    }
    let image = app.world_mut().resource_mut::<Assets<Image>>().add(two_colours());
    let unlit = StandardMaterial {
        unlit: true,
        base_color: Color::linear_rgb(GLOW.x, GLOW.y, GLOW.z),
        base_color_texture: Some(image),
        // Half a picture to the side, which only a picture that repeats allows.
        uv_transform: Affine2::from_translation(Vec2::new(0.5, 0.0)),
        ..default()
    };
    let [west, east] = lights_the_hill(&mut app, &stage, "unlit", unlit);
    assert!(west.x < 0.4 * east.x && east.y < 0.6 * west.y, "{west} {east}: the halves have changed places");
}

/// Hangs up a square of a material, holds what it gives to the hill against the closed form, and takes it away.
/// Returns the radiance of its western and its eastern half as the screen has it.
fn lights_the_hill(app: &mut App, stage: &[Option<Shown>], what: &str, of: StandardMaterial) -> [DVec3; 2] {
    let square = spawn_square(app.world_mut(), of);
    show(app);
    let half = 0.5 * GLOWING_HALF;
    let radiance = [-half, half].map(|x| {
        let screen = &app.world().resource::<Screen>().0;
        screen[pixel_of(GLOWING + DVec3::X * x)].as_dvec3() / EXPOSURE
    });
    bake(app, direct());
    let albedo = stage::pieces().map(|piece| piece.albedo);
    let (mut seen, mut truth) = (Vec::new(), Vec::new());
    let pixels = stage.iter().zip(&app.world().resource::<Screen>().0);
    for (at, pixel) in pixels.filter_map(|(at, pixel)| Some((at.as_ref()?, pixel))).filter(|(at, _)| !is_hidden(at)) {
        let from = |middle: f64, radiance: DVec3| {
            let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let corners =
                corners.map(|[x, z]| GLOWING + DVec3::new(middle + half * x, 0.0, GLOWING_HALF * z) - at.point);
            radiance * polygon_irradiance(&corners, at.normal)
        };
        seen.push(pixel.as_dvec3());
        truth.push((from(-half, radiance[0]) + from(half, radiance[1])) / PI * albedo[at.piece] * EXPOSURE);
    }
    let difference = compare(&seen, &truth);
    println!("{what}: {difference:?}");
    difference.verdict().unwrap_or_else(|fault| panic!("{what}: {fault}"));
    let brighter: Vec<DVec3> = seen.iter().map(|pixel| *pixel * 1.02).collect();
    assert!(compare(&brighter, &truth).verdict().is_err());
    app.world_mut().trigger(ClearLightmaps);
    app.world_mut().despawn(square);
    show(app);
    radiance
}

/// The level square, seen and glowing from both sides, which only blocks.
fn spawn_square(world: &mut World, material: StandardMaterial) -> Entity {
    let material = StandardMaterial { double_sided: true, cull_mode: None, ..material };
    let side = 2.0 * GLOWING_HALF as f32;
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Plane3d::default().mesh().size(side, side));
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
    let place = Transform::from_translation(GLOWING.as_vec3());
    world.spawn((Name::new("square"), LightBlocker, Mesh3d(mesh), MeshMaterial3d(material), place)).id()
}

/// Two texels beside each other, by the sRGB curve: reddish and greenish.
fn two_colours() -> Image {
    let size = Extent3d { width: 2, height: 1, depth_or_array_layers: 1 };
    let (format, usage) = (TextureFormat::Rgba8UnormSrgb, RenderAssetUsages::default());
    let mut image = Image::new(size, TextureDimension::D2, vec![255, 190, 150, 255, 150, 255, 190, 255], format, usage);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::nearest()
    });
    image
}

/// Whether the glowing square is before a place, or nearly so.
fn is_hidden(at: &Shown) -> bool {
    let share = (GLOWING.y - at.point.y) / (stage::eye().y - at.point.y);
    let crossing = at.point.lerp(stage::eye(), share);
    (0.0..1.0).contains(&share) && (crossing - GLOWING).abs().max_element() < 1.3 * GLOWING_HALF
}

/// The pixel that shows a point.
fn pixel_of(point: DVec3) -> usize {
    let towards = (point - stage::eye()).normalize();
    let pixels = (0..stage::HEIGHT * stage::WIDTH).map(|pixel| {
        let place = DVec2::new((pixel % stage::WIDTH) as f64, (pixel / stage::WIDTH) as f64) + 0.5;
        (stage::ray(place).dot(towards), pixel)
    });
    pixels.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, pixel)| pixel)
}

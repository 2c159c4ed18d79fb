//! One light of each kind: how it is spawned, and the irradiance that it gives by closed form, written down from the
//! physics and from Bevy's shaders, with nothing of the baker's in it.

use bevy::asset::RenderAssetUsages;
use bevy::light::EnvironmentMapLight;
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use bevy_kiln::math::polygon_irradiance;
use glam::{DQuat, DVec3};
use half::f16;
use std::f64::consts::PI;

const COLOUR: DVec3 = DVec3::new(1.0, 0.6, 0.3);

/// Power [lm] and range [m] of the lamps.
const POWER: f64 = 200.0;
const RANGE: f64 = 6.0;

const BULB: DVec3 = DVec3::new(0.4, 1.8, -0.3);
const SPOT: DVec3 = DVec3::new(-0.5, 2.2, 0.6);
const SPOT_TARGET: DVec3 = DVec3::new(0.1, 0.0, 0.0);
const CONE: [f64; 2] = [0.3, 0.9];
const TO_SUN: DVec3 = DVec3::new(0.3, 1.0, 0.4);
const LUX: f64 = 4.0;
const PANEL: DVec3 = DVec3::new(0.2, 1.6, 0.1);
const PANEL_TARGET: DVec3 = DVec3::new(0.0, 0.0, -0.2);
const PANEL_SIZE: [f64; 2] = [0.9, 0.5];

/// Texels along an edge of the sky's cube.
const SKY_SIDE: u32 = 32;

/// A kind of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Point,
    Spot,
    Directional,
    Rect,
    Environment,
}

impl Kind {
    pub const ALL: [Self; 5] = [Self::Point, Self::Spot, Self::Directional, Self::Rect, Self::Environment];

    /// Puts it into the world; what must be despawned or taken off to end it is [`Kind::remove`]'s affair.
    pub fn spawn(self, world: &mut World, camera: Entity) {
        let [r, g, b] = COLOUR.as_vec3().to_array();
        let (color, intensity, range) = (Color::linear_rgb(r, g, b), POWER as f32, RANGE as f32);
        let at = |eye: DVec3, target: DVec3| {
            Transform::from_translation(eye.as_vec3()).looking_at(target.as_vec3(), Vec3::Z)
        };
        let lamp = Name::new("lamp");
        match self {
            Self::Point => {
                let light = PointLight { color, intensity, range, ..default() };
                world.spawn((lamp, light, at(BULB, DVec3::ZERO)));
            }
            Self::Spot => {
                let [inner_angle, outer_angle] = CONE.map(|angle| angle as f32);
                let light = SpotLight { color, intensity, range, inner_angle, outer_angle, ..default() };
                world.spawn((lamp, light, at(SPOT, SPOT_TARGET)));
            }
            Self::Directional => {
                let light = DirectionalLight { color, illuminance: LUX as f32, ..default() };
                world.spawn((lamp, light, at(TO_SUN, DVec3::ZERO)));
            }
            Self::Rect => {
                let [width, height] = PANEL_SIZE.map(|side| side as f32);
                let light = RectLight { color, intensity, range, width, height };
                world.spawn((lamp, light, at(PANEL, PANEL_TARGET)));
            }
            Self::Environment => {
                let mut images = world.resource_mut::<Assets<Image>>();
                let specular_map = images.add(cube(radiance));
                let diffuse_map = images.add(cube(convolved));
                let rotation = sky_rotation().as_quat();
                let light = EnvironmentMapLight { diffuse_map, specular_map, intensity: 2.0, rotation, ..default() };
                world.entity_mut(camera).insert(light);
            }
        }
    }

    /// Takes it out of the world again.
    pub fn remove(self, world: &mut World, camera: Entity) {
        world.entity_mut(camera).remove::<EnvironmentMapLight>();
        let mut names = world.query::<(Entity, &Name)>();
        let lamp = names.iter(world).find(|(_, name)| name.as_str() == "lamp").map(|(entity, _)| entity);
        if let Some(lamp) = lamp {
            world.despawn(lamp);
        }
    }

    /// Irradiance [lx] on a surface of the hill.
    pub fn irradiance(self, point: DVec3, normal: DVec3) -> DVec3 {
        match self {
            Self::Point => bulb(BULB, point, normal),
            Self::Spot => {
                let axis = (SPOT_TARGET - SPOT).normalize();
                let [inner, outer] = CONE.map(f64::cos);
                let ramp = ((axis.dot((point - SPOT).normalize()) - outer) / (inner - outer)).clamp(0.0, 1.0);
                bulb(SPOT, point, normal) * ramp * ramp
            }
            Self::Directional => COLOUR * LUX * normal.dot(TO_SUN.normalize()).max(0.0),
            Self::Rect => {
                let radiance = COLOUR * POWER / (PI * PANEL_SIZE[0] * PANEL_SIZE[1]);
                radiance * polygon_irradiance(&panel().map(|corner| corner - point), normal) * window(PANEL, point)
            }
            Self::Environment => 2.0 * PI * convolved(sky_rotation().inverse() * normal),
        }
    }

    /// The direction from which the light comes, where Bevy's diffuse reflection asks for it: panels and skies are
    /// Lambert's there too.
    pub fn to_light(self, point: DVec3) -> Option<DVec3> {
        match self {
            Self::Point => Some((BULB - point).normalize()),
            Self::Spot => Some((SPOT - point).normalize()),
            Self::Directional => Some(TO_SUN.normalize()),
            Self::Rect | Self::Environment => None,
        }
    }

    /// A panel is mirrored in a surface even without reflectance (Bevy leaves it its Fresnel term at grazing angles),
    /// which is seen on a rough one everywhere, and on a smooth one only where the mirror image lies.
    pub fn perceptual_roughness(self) -> f32 {
        if self == Self::Rect { 0.1 } else { 0.5 }
    }
}

/// Φ/4π cd, the square of the distance, Lambert's cosine, and Bevy's window.
fn bulb(lamp: DVec3, point: DVec3, normal: DVec3) -> DVec3 {
    let way = lamp - point;
    let cosine = normal.dot(way.normalize()).max(0.0);
    COLOUR * POWER / (4.0 * PI) * cosine / way.length_squared() * window(lamp, point)
}

fn window(lamp: DVec3, point: DVec3) -> f64 {
    (1.0 - ((lamp - point).length() / RANGE).powi(4)).clamp(0.0, 1.0).powi(2)
}

/// The corners of the panel, in order.
fn panel() -> [DVec3; 4] {
    let forward = (PANEL_TARGET - PANEL).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let [x, y] = [right * PANEL_SIZE[0] / 2.0, up * PANEL_SIZE[1] / 2.0];
    [PANEL - x - y, PANEL + x - y, PANEL + x + y, PANEL - x + y]
}

fn sky_rotation() -> DQuat {
    DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.8)
}

/// A sky of spherical harmonics up to the second order, which are what a diffuse surface can tell apart.
fn radiance(d: DVec3) -> DVec3 {
    DVec3::new(1.0 + 0.5 * d.x, 1.0 + 0.4 * d.y + 0.3 * d.x * d.z, 0.7 - 0.3 * d.z + 0.2 * d.y)
}

/// The same after Lambert's cosine, divided by π: by 1, ⅔ and ¼ for the three orders (Ramamoorthi and Hanrahan 2001).
fn convolved(d: DVec3) -> DVec3 {
    let (one, two) = (2.0 / 3.0, 1.0 / 4.0);
    DVec3::new(
        1.0 + one * 0.5 * d.x,
        1.0 + one * 0.4 * d.y + two * 0.3 * d.x * d.z,
        0.7 + one * (-0.3 * d.z + 0.2 * d.y),
    )
}

/// A cube map of a function of the direction in the sky's own frame.
fn cube(colour: impl Fn(DVec3) -> DVec3) -> Image {
    let size = Extent3d { width: SKY_SIDE, height: SKY_SIDE, depth_or_array_layers: 6 };
    let place = |texel: u32| 2.0 * (f64::from(texel) + 0.5) / f64::from(SKY_SIDE) - 1.0;
    let mut bytes = Vec::new();
    for (face, row, column) in
        (0..6).flat_map(|f| (0..SKY_SIDE).flat_map(move |r| (0..SKY_SIDE).map(move |c| (f, r, c))))
    {
        let (s, t) = (place(column), place(row));
        // The faces of a cube map by the Vulkan specification.
        let in_cube = match face {
            0 => DVec3::new(1.0, -t, -s),
            1 => DVec3::new(-1.0, -t, s),
            2 => DVec3::new(s, 1.0, t),
            3 => DVec3::new(s, -1.0, -t),
            4 => DVec3::new(s, -t, 1.0),
            _ => DVec3::new(-s, -t, -1.0),
        };
        // Bevy negates z before it looks.
        let direction = DVec3::new(in_cube.x, in_cube.y, -in_cube.z).normalize();
        let [r, g, b] = colour(direction).to_array();
        bytes.extend([r, g, b, 1.0].iter().flat_map(|&channel| f16::from_f64(channel).to_le_bytes()));
    }
    let mut image =
        Image::new(size, TextureDimension::D2, bytes, TextureFormat::Rgba16Float, RenderAssetUsages::default());
    let dimension = Some(TextureViewDimension::Cube);
    image.texture_view_descriptor = Some(TextureViewDescriptor { dimension, ..default() });
    image
}

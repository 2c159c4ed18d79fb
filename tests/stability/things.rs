//! What scenes are made of: materials, bodies and lamps that several groups of cases use.
//!
//! Whole scenes are in [`crate::worlds`]; what is asked of them in [`crate::judge`].

use crate::common::scenes::SceneBuilder;
use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{
    DirectionalLight, Filter, Interior, Light, Material, PointLight, RectLight, Scattering, Scene, SpotLight, Standard,
    Texels, Texture, Wrap,
};
use glam::{Affine3A, Quat, Vec2, Vec3};

/// Glass that absorbs nothing.
pub const CLEAR: Interior = Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: f32::INFINITY };

/// A white surface that scatters in this way.
pub fn of(scattering: Scattering) -> Material {
    Material::scattering("thing", Vec3::ONE, scattering)
}

/// Bevy's material in white.
pub fn standard(standard: Standard) -> Material {
    of(Scattering::Standard(Box::new(standard)))
}

/// A white metal, which reflects all.
pub fn metal(perceptual_roughness: f32) -> Material {
    standard(Standard { metallic: 1.0, perceptual_roughness, ..Standard::default() })
}

/// A body of clear glass.
pub fn glass(ior: f32, perceptual_roughness: f32) -> Material {
    let interior = CLEAR;
    standard(Standard { specular_transmission: 1.0, perceptual_roughness, ior, interior, ..Standard::default() })
}

/// Adds a box whose sides face outwards.
pub fn with_box(mut builder: SceneBuilder, name: &str, [low, high]: [Vec3; 2], material: &Material) -> SceneBuilder {
    let size = high - low;
    let [x, y, z] = [Vec3::X * size, Vec3::Y * size, Vec3::Z * size];
    let sides = [(low, [z, y]), (low + x, [y, z]), (low, [x, z]), (low + y, [z, x]), (low, [y, x]), (low + z, [x, y])];
    for (index, (corner, edges)) in sides.into_iter().enumerate() {
        builder = builder.quad(&format!("{name} {index}"), corner, edges, material.clone());
    }
    builder
}

/// Adds a horizontal square of half a side `reach` at a height, facing up (`sign` = 1) or down (−1).
pub fn level(
    builder: SceneBuilder,
    name: &str,
    height: f32,
    [reach, sign]: [f32; 2],
    material: Material,
) -> SceneBuilder {
    let (z, x) = (2.0 * reach * Vec3::Z, 2.0 * reach * Vec3::X);
    let edges = if sign > 0.0 { [z, x] } else { [x, z] };
    builder.quad(name, Vec3::new(-reach, height, -reach), edges, material)
}

/// A sphere of triangles: an octahedron, each triangle cut in four `levels` times, facing outwards.
pub fn sphere(centre: Vec3, radius: f32, levels: u32) -> (Vec<Vec3>, Vec<u32>) {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut triangles = Vec::new();
    for (a, b) in [(x, z), (z, -x), (-x, -z), (-z, x)] {
        triangles.extend(
            [[b, a, y], [a, b, -y]]
                .map(|[a, b, c]| if (b - a).cross(c - a).dot(a + b + c) > 0.0 { [a, b, c] } else { [a, c, b] }),
        );
    }
    for _ in 0..levels {
        let cut = |&[a, b, c]: &[Vec3; 3]| {
            let [ab, bc, ca] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.iter().flat_map(cut).collect();
    }
    let positions: Vec<Vec3> = triangles.concat().into_iter().map(|vertex| centre + radius * vertex).collect();
    let indices = (0..positions.len() as u32).collect();
    (positions, indices)
}

/// A picture of these texels, row by row.
pub fn picture([width, height]: [u32; 2], texels: Vec<[f32; 4]>, wrap: Wrap, filter: Filter) -> Texture {
    Texture { name: "picture".into(), width, height, texels: Texels::Float(texels.into()), wrap: [wrap; 2], filter }
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

//! What the pictures show: the top and two sides of a hill. It is convex, so that no part shadows, reflects to or sees
//! another, and direct light is all light. Where a pixel looks is computed here, without a renderer.

use crate::renderer::spawn_camera;
use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use glam::{DVec2, DVec3};

/// Rows of 8 bytes per pixel are whole multiples of 256 bytes.
pub const WIDTH: usize = 128;
pub const HEIGHT: usize = 80;

const EYE: DVec3 = DVec3::new(0.2, 4.5, 2.2);
const TARGET: DVec3 = DVec3::new(0.0, -0.2, 0.0);
/// Whole vertical opening angle [rad].
const FOV: f64 = 0.6;

/// A flat piece of ground: its middle, half its sides, and its albedo.
#[derive(Clone, Copy)]
pub struct Piece {
    pub name: &'static str,
    middle: DVec3,
    sides: [DVec3; 2],
    pub albedo: DVec3,
}

impl Piece {
    pub fn normal(&self) -> DVec3 {
        self.sides[0].cross(self.sides[1]).normalize()
    }
}

/// A flat top, and slopes of 30° to the east and 40° to the west.
pub fn pieces() -> [Piece; 3] {
    let slope = |sign: f64, degrees: f64, name, albedo| {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let down = DVec3::new(0.75 * sign * cos, -0.75 * sin, 0.0);
        // In this order the normal points up.
        let sides = if sign > 0.0 { [down, DVec3::NEG_Z] } else { [DVec3::NEG_Z, down] };
        Piece { name, middle: DVec3::new(sign, 0.0, 0.0) + down, sides, albedo }
    };
    let top =
        Piece { name: "top", middle: DVec3::ZERO, sides: [DVec3::X, DVec3::NEG_Z], albedo: DVec3::new(0.8, 0.5, 0.25) };
    [top, slope(1.0, 30.0, "east", DVec3::new(0.3, 0.6, 0.9)), slope(-1.0, 40.0, "west", DVec3::new(1.0, 1.0, 1.0))]
}

/// What a pixel shows.
#[derive(Clone, Copy)]
pub struct Shown {
    /// Which piece.
    pub piece: usize,
    pub point: DVec3,
    pub normal: DVec3,
    /// Towards the camera.
    pub to_eye: DVec3,
}

/// Per pixel what its middle shows; `None` beside the pieces and at their edges.
pub fn shown() -> Vec<Option<Shown>> {
    let pieces = pieces();
    let at = |x: f64, y: f64| look(&pieces, ray(DVec2::new(x, y)));
    let pixels = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x as f64 + 0.5, y as f64 + 0.5)));
    pixels
        .map(|(x, y)| {
            let middle = at(x, y)?;
            let corners = [(-1.5, -1.5), (1.5, -1.5), (-1.5, 1.5), (1.5, 1.5)];
            let same = corners.iter().all(|(dx, dy)| at(x + dx, y + dy).is_some_and(|c| c.piece == middle.piece));
            same.then_some(middle)
        })
        .collect()
}

/// The direction in which a place on the screen looks.
pub fn ray(place: DVec2) -> DVec3 {
    let forward = (TARGET - EYE).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let size = DVec2::new(WIDTH as f64, HEIGHT as f64);
    let centred = (place * 2.0 - size) / size.y * (0.5 * FOV).tan();
    (forward + right * centred.x - up * centred.y).normalize()
}

/// Where the camera is.
pub fn eye() -> DVec3 {
    EYE
}

fn look(pieces: &[Piece], direction: DVec3) -> Option<Shown> {
    pieces.iter().enumerate().find_map(|(piece, of)| {
        let normal = of.normal();
        let point = EYE + direction * ((of.middle - EYE).dot(normal) / direction.dot(normal));
        let inside = of.sides.iter().all(|side| ((point - of.middle).dot(*side) / side.length_squared()).abs() <= 1.0);
        inside.then_some(Shown { piece, point, normal, to_eye: -direction })
    })
}

/// Spawns the hill, without specular reflection, and the camera, whose entity is returned.
pub fn spawn(world: &mut World) -> Entity {
    for piece in pieces() {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let positions = corners.map(|[a, b]| (piece.middle + piece.sides[0] * a + piece.sides[1] * b).as_vec3());
        let uv = corners.map(|corner: [f64; 2]| corner.map(|c| (0.5 + 0.5 * c) as f32)).to_vec();
        let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.map(|p| p.to_array()).to_vec())
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![piece.normal().as_vec3().to_array(); 4])
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uv.clone())
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_1, uv)
            .with_inserted_indices(Indices::U16(vec![0, 1, 2, 0, 2, 3]));
        let [r, g, b] = piece.albedo.as_vec3().to_array();
        let material = StandardMaterial { base_color: Color::linear_rgb(r, g, b), reflectance: 0.0, ..default() };
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
        world.spawn((Name::new(piece.name), Mesh3d(mesh), MeshMaterial3d(material)));
    }
    let place = Transform::from_translation(EYE.as_vec3()).looking_at(TARGET.as_vec3(), Vec3::Y);
    spawn_camera(world, [WIDTH as u32, HEIGHT as u32], FOV as f32, place)
}

/// Makes the whole hill equally rough.
pub fn set_roughness(world: &mut World, perceptual_roughness: f32) {
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    for (_, material) in materials.iter_mut() {
        material.perceptual_roughness = perceptual_roughness;
    }
}

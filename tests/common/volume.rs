//! What Bevy shows of irradiance volumes: a port of its shader's lookup (bevy_pbr 0.19, `irradiance_volume.wgsl` and
//! `light_probe.wgsl`), with the trilinear filter of a GPU. It reads the texture, not the bake.

use bevy_kiln::bake::Volume;
use bevy_kiln::output::VolumeTexture;
use glam::{Mat4, Vec3};

/// A volume as it is bound.
pub struct Bound {
    light_from_world: Mat4,
    falloff: f32,
    texture: VolumeTexture,
}

impl Bound {
    pub fn new(volume: &Volume) -> Self {
        Self::with_texture(volume, VolumeTexture::new(volume))
    }

    pub fn with_texture(volume: &Volume, texture: VolumeTexture) -> Self {
        let world_from_light = Mat4::from_scale_rotation_translation(volume.size, volume.rotation, volume.centre);
        Self { light_from_world: world_from_light.inverse(), falloff: volume.falloff, texture }
    }

    /// E/π at a place on a surface of a normal, and the weight of that.
    fn sample(&self, position: Vec3, normal: Vec3) -> (Vec3, f32) {
        let place = self.light_from_world.transform_point3(position);
        let weights = ((1.0 - 2.0 * place.abs()) / (2.0 * self.falloff.max(0.0001))).clamp(Vec3::ZERO, Vec3::ONE);
        let weight = weights.min_element();
        if weight == 0.0 {
            return (Vec3::ZERO, 0.0);
        }
        let size = self.texture.size.as_vec3();
        let resolution = (self.texture.size / glam::UVec3::new(1, 2, 3)).as_vec3();
        let within = ((place + 0.5) * resolution).clamp(Vec3::splat(0.5), resolution - Vec3::splat(0.5));
        let uvw = within / size;
        let negative = Vec3::select(normal.cmplt(Vec3::ZERO), Vec3::splat(0.5), Vec3::ZERO);
        let x = self.filtered(uvw + Vec3::new(0.0, negative.x, 0.0));
        let y = self.filtered(uvw + Vec3::new(0.0, negative.y, 1.0 / 3.0));
        let z = self.filtered(uvw + Vec3::new(0.0, negative.z, 2.0 / 3.0));
        let squared = normal * normal;
        (x * squared.x + y * squared.y + z * squared.z, weight)
    }

    /// Trilinear, clamped to the edge.
    fn filtered(&self, uvw: Vec3) -> Vec3 {
        let size = self.texture.size;
        let at = uvw * size.as_vec3() - 0.5;
        let (low, share) = (at.floor(), at - at.floor());
        let mut sum = Vec3::ZERO;
        for corner in 0..8 {
            let offset = Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2) as f32);
            let texel = (low + offset).clamp(Vec3::ZERO, size.as_vec3() - 1.0).as_uvec3();
            let weight = Vec3::select(offset.cmpgt(Vec3::ZERO), share, 1.0 - share).element_product();
            sum += weight * self.texture.texels[((texel.z * size.y + texel.y) * size.x + texel.x) as usize];
        }
        sum
    }
}

/// E/π at a place on a surface of a normal, from all volumes [cd/m²].
pub fn look_up(volumes: &[Bound], position: Vec3, normal: Vec3) -> Vec3 {
    let (mut sum, mut total) = (Vec3::ZERO, 0.0);
    for (value, weight) in volumes.iter().map(|volume| volume.sample(position, normal)) {
        sum += value * weight;
        total += weight;
    }
    if total == 0.0 { Vec3::ZERO } else { sum / total }
}

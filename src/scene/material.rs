//! What a surface does with light, in physical terms.

use glam::Vec3;

/// An opaque, diffuse (Lambertian) surface that may glow.
#[derive(Clone, Debug)]
pub struct Material {
    /// The name by which a person knows it.
    pub name: String,
    /// Share of the arriving light that leaves again, per channel, in [0, 1].
    pub diffuse_albedo: Vec3,
    /// Radiance that the surface gives off [cd/m²].
    pub emitted_radiance: Vec3,
    /// Whether the back gives off light too. For all else every triangle has the same two sides.
    pub double_sided: bool,
}

impl Material {
    /// A surface that does not glow.
    pub fn diffuse(name: impl Into<String>, diffuse_albedo: Vec3) -> Self {
        Self { name: name.into(), diffuse_albedo, emitted_radiance: Vec3::ZERO, double_sided: false }
    }

    /// A surface that glows from its front and reflects nothing.
    pub fn emissive(name: impl Into<String>, emitted_radiance: Vec3) -> Self {
        Self { name: name.into(), diffuse_albedo: Vec3::ZERO, emitted_radiance, double_sided: false }
    }
}

//! A surface where a ray meets it: its colour, its glow, what of the light passes straight, and how it scatters.

use super::accel::Hit;
use super::bsdf::{Bsdf, Lambert, Mirror, Phong, Refraction, Standard, StandardParameters};
use super::kernel::{LAYERED, PASSING, TEXTURED};
use super::light::{LightContext, LightSample, SourceIndex};
use super::material::Surface;
use super::tracer::{NO_TRIANGLE, Tracer};
use crate::math::Frame;
use crate::scene::{Alpha, NormalEncoding, Scattering, TextureRef};
use glam::{Vec3, Vec4};

/// A place on a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// World number of the triangle.
    pub(super) triangle: u32,
    /// Weights of its second and third vertex.
    pub(super) barycentric: [f32; 2],
}

/// What of the light that arrives is left over for what lies behind.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    /// Share that passes straight, per channel.
    pub(super) transmittance: Vec3,
    /// Share of the surface that is there to scatter.
    pub(super) presence: f32,
    /// Share of its glow that is seen.
    pub(super) glow: f32,
}

impl Hit {
    /// Where it is.
    #[inline]
    pub(super) fn place(&self) -> Place {
        Place { triangle: self.triangle, barycentric: self.barycentric }
    }
}

impl Tracer {
    #[inline]
    pub(super) fn surface(&self, triangle: u32) -> &Surface {
        &self.surfaces[self.surface_of[triangle as usize] as usize]
    }

    /// A texture's value at a place, or white.
    fn look_up(&self, surface: &Surface, texture: Option<TextureRef>, place: Place) -> Vec4 {
        let Some(texture) = texture else { return Vec4::ONE };
        let Some(decoded) = &self.textures[texture.texture] else { return Vec4::ONE };
        let uv = self.attributes.uv(texture.uv, place.triangle, place.barycentric);
        decoded.at(surface.uv_transform.transform_point2(uv))
    }

    /// Base colour and alpha at a place.
    #[inline]
    fn base_colour<const K: u32>(&self, surface: &Surface, place: Place) -> Vec4 {
        if K & TEXTURED == 0 {
            return surface.base_colour;
        }
        let colour = self.attributes.colour(place.triangle, place.barycentric);
        let colour = surface.base_colour * colour * self.look_up(surface, surface.base_colour_texture, place);
        colour.clamp(Vec4::ZERO, Vec4::ONE)
    }

    /// Share of the light that a diffuse surface reflects at a place.
    #[inline]
    pub(super) fn albedo<const K: u32>(&self, surface: &Surface, place: Place) -> Vec3 {
        match surface.scattering {
            Scattering::None => Vec3::ZERO,
            _ => self.base_colour::<K>(surface, place).truncate(),
        }
    }

    /// Radiance given off at a place on its shining side [cd/m²].
    #[inline]
    pub(super) fn glow<const K: u32>(&self, surface: &Surface, place: Place) -> Vec3 {
        if K & TEXTURED == 0 || surface.emission_texture.is_none() {
            return surface.emitted_radiance;
        }
        surface.emitted_radiance * self.look_up(surface, surface.emission_texture, place).truncate().max(Vec3::ZERO)
    }

    /// What light along the unit `direction` finds of a surface that may let it pass.
    pub(super) fn passage<const K: u32>(&self, surface: &Surface, place: Place, direction: Vec3) -> Passage {
        let colour = self.base_colour::<K>(surface, place);
        let (alpha, rgb) = (colour.w, colour.truncate());
        let (mut transmittance, presence) = match surface.alpha {
            Alpha::Opaque => (Vec3::ZERO, 1.0),
            Alpha::Mask { cutoff } if alpha < cutoff => (Vec3::ONE, 0.0),
            Alpha::Mask { .. } => (Vec3::ZERO, 1.0),
            Alpha::Blend => (Vec3::splat(1.0 - alpha), alpha),
            Alpha::Multiply => (Vec3::ONE - alpha * (Vec3::ONE - rgb), 0.0),
            Alpha::Add => (Vec3::ONE, 0.0),
        };
        if K & LAYERED != 0 && surface.is_pane && presence > 0.0 {
            let front = self.triangles[place.triangle as usize].normal;
            let side = if front.dot(direction) < 0.0 { 1.0 } else { -1.0 };
            // By the normal that reflects, so that nothing is lost or made between the two.
            let frame = self.shading_frame(surface, place, front * side, -direction, side);
            let cosine = -frame.normal.dot(direction);
            transmittance += presence * self.bsdf::<K>(surface, place, side).straight(cosine);
        }
        // What is added to the picture blocks nothing and yet glows.
        let glow = if surface.alpha == Alpha::Add { alpha } else { presence };
        Passage { transmittance, presence, glow }
    }

    /// Share of the plain glow that a sampled point of a glowing surface gives: its texture, and what of it is there.
    #[inline]
    pub(super) fn glow_share<const K: u32>(&self, sample: &LightSample, context: &LightContext) -> Vec3 {
        let SourceIndex::Emitter(emitter) = sample.source else { return Vec3::ONE };
        let triangle = self.triangle_of[emitter as usize];
        if triangle == NO_TRIANGLE {
            return Vec3::ONE;
        }
        let surface = self.surface(triangle);
        if surface.emission_texture.is_none() && !surface.passes {
            return Vec3::ONE;
        }
        let point = context.position + sample.wi * sample.distance;
        let Some(barycentric) = self.lights.get(emitter).weights_of(point) else { return Vec3::ONE };
        let (place, direction) = (Place { triangle, barycentric }, sample.wi);
        let mut share = Vec3::ONE;
        if K & TEXTURED != 0 && surface.emission_texture.is_some() {
            share = self.look_up(surface, surface.emission_texture, place).truncate().max(Vec3::ZERO);
        }
        if K & PASSING != 0 && surface.passes {
            share *= self.passage::<K>(surface, place, direction).glow;
        }
        share
    }

    /// How a surface scatters at a place. `side` is 1 before it and −1 behind it.
    pub(super) fn bsdf<const K: u32>(&self, surface: &Surface, place: Place, side: f32) -> Bsdf<'_> {
        let base_colour = self.base_colour::<K>(surface, place).truncate();
        let eta = |ior: f32| if side < 0.0 { ior.recip() } else { ior };
        match &surface.scattering {
            Scattering::None => Bsdf::None,
            Scattering::Diffuse => Bsdf::Lambert(Lambert { albedo: base_colour }),
            Scattering::Mirror => Bsdf::Mirror(Mirror { reflectance: base_colour }),
            Scattering::Refraction { ior } => Bsdf::Refraction(Refraction { tint: base_colour, eta: eta(*ior) }),
            &Scattering::Phong { specular, exponent } => {
                Bsdf::Phong(Phong { diffuse: base_colour, specular, exponent })
            }
            Scattering::Standard(standard) => {
                let of = |texture| if K & TEXTURED == 0 { Vec4::ONE } else { self.look_up(surface, texture, place) };
                let metal_and_rough = of(standard.metallic_roughness_texture);
                let parameters = StandardParameters {
                    base_colour,
                    metallic: (standard.metallic * metal_and_rough.z).clamp(0.0, 1.0),
                    perceptual_roughness: (standard.perceptual_roughness * metal_and_rough.y).clamp(0.0, 1.0),
                    reflectance: standard.reflectance,
                    specular_tint: standard.specular_tint,
                    specular_transmission: (standard.specular_transmission
                        * of(standard.specular_transmission_texture).x)
                        .clamp(0.0, 1.0),
                    eta: eta(standard.ior),
                    interior: standard.interior,
                    diffuse_transmission: (standard.diffuse_transmission * of(standard.diffuse_transmission_texture).w)
                        .clamp(0.0, 1.0),
                    clearcoat: (standard.clearcoat * of(standard.clearcoat_texture).x).clamp(0.0, 1.0),
                    clearcoat_perceptual_roughness: (standard.clearcoat_perceptual_roughness
                        * of(standard.clearcoat_roughness_texture).y)
                        .clamp(0.0, 1.0),
                };
                match &self.albedo_tables {
                    Some(tables) => Bsdf::Standard(Standard::new(&parameters, tables)),
                    None => Bsdf::Lambert(Lambert { albedo: base_colour }),
                }
            }
        }
    }

    /// The frame in which a surface scatters, around its shading normal on the side of `wo`. `geometric` is the flat
    /// normal on that side, `side` as in [`Self::bsdf`].
    pub(super) fn shading_frame(&self, surface: &Surface, place: Place, geometric: Vec3, wo: Vec3, side: f32) -> Frame {
        let normal = self.shading_normal(surface, place, geometric, side);
        // A normal that looks away from the viewer shows a side that cannot be seen; the flat one is then the truth.
        if normal.dot(wo) > 0.0 && normal.dot(geometric) > 0.0 { Frame::new(normal) } else { Frame::new(geometric) }
    }

    /// The normal of that frame, if it does not look away from who sees the surface.
    pub(super) fn shading_normal(&self, surface: &Surface, place: Place, geometric: Vec3, side: f32) -> Vec3 {
        // Which way a mesh's normals point is often wrong; which side the viewer is on is known.
        let towards_viewer = |n: Vec3| if n.dot(geometric) < 0.0 { -n } else { n };
        let smooth = self.attributes.normal(place.triangle, place.barycentric).map_or(geometric, towards_viewer);
        match surface.normal_map {
            Some(_) => self.mapped_normal(surface, place, smooth, side),
            None => smooth,
        }
    }

    /// The frame of a diffuse surface that a camera sees: around the smooth normal, as its lightmap has it.
    pub(super) fn seen_frame(&self, place: Place, geometric: Vec3, wo: Vec3) -> Frame {
        let smooth = self.attributes.normal(place.triangle, place.barycentric);
        let smooth = smooth.filter(|normal| normal.dot(geometric) > 0.0 && normal.dot(wo) > 0.0);
        Frame::new(smooth.unwrap_or(geometric))
    }

    /// The normal that a map makes of `normal`, which stands on the viewer's side.
    fn mapped_normal(&self, surface: &Surface, place: Place, normal: Vec3, side: f32) -> Vec3 {
        let Some(map) = surface.normal_map else { return normal };
        let Some((tangent, sign)) = self.attributes.tangent(place.triangle, place.barycentric) else {
            return normal;
        };
        // Gram and Schmidt: the part of the tangent that is perpendicular to the normal, as the mesh's front has it.
        let front = normal * side;
        let Some(tangent) = (tangent - front * front.dot(tangent)).try_normalize() else { return normal };
        let bitangent = sign * front.cross(tangent);
        let texel = self.look_up(surface, Some(map.texture), place).truncate() * 2.0 - 1.0;
        let (x, y) = (texel.x, texel.y);
        let derived = (1.0 - x * x - y * y).max(0.0).sqrt();
        let local = match map.encoding {
            NormalEncoding::OpenGl => texel,
            NormalEncoding::DirectX => Vec3::new(x, -y, texel.z),
            NormalEncoding::TwoChannel => Vec3::new(x, y, derived),
            NormalEncoding::TwoChannelDirectX => Vec3::new(x, -y, derived),
        };
        let mapped = tangent * local.x + bitangent * local.y + front * local.z;
        mapped.try_normalize().map_or(normal, |mapped| mapped * side)
    }
}

//! What shines from all around: the asked sky, Bevy's ambient light, and one picture of the sky, be it asked for or on
//! a camera. Light that is only local, or that only a GPU knows, is named.

mod cube;

use super::texture::{self, Unreadable};
use super::{Extraction, ExtractionWarning};
use crate::plugin::StableIds;
use crate::plugin::baking::{AmbientMode, SceneSettings};
use crate::scene::{EnvironmentMap, Texels};
use bevy::light::{AtmosphereEnvironmentMapLight, EnvironmentMapLight, GeneratedEnvironmentMapLight, LightProbe};
use bevy::prelude::*;
use bevy::render::render_resource::TextureDimension;
use cube::Cube;
use std::sync::Arc;

pub(super) fn extract(world: &mut World, settings: &SceneSettings, out: &mut Extraction) {
    out.scene.sky_radiance = settings.sky_radiance;
    if let Some(ambient) = world.get_resource::<GlobalAmbientLight>() {
        match settings.ambient {
            AmbientMode::Bake => out.scene.sky_radiance += ambient.color.to_linear().to_vec3() * ambient.brightness,
            AmbientMode::Ignore if ambient.brightness > 0.0 && ambient.affects_lightmapped_meshes => {
                out.warnings.push(ExtractionWarning::AmbientStays { brightness: ambient.brightness });
            }
            AmbientMode::Ignore => {}
        }
    }
    if let Some(image) = &settings.environment {
        let name = texture::name(image).unwrap_or_else(|| "the bake's settings".to_owned());
        let asked = Sky { images: vec![image.clone()], intensity: 1.0, rotation: Quat::IDENTITY };
        asked.read(world, &name, out);
    }
    let found = find(world);
    let mut taken: Option<Sky> = None;
    for (name, source) in found {
        let not_baked = |kind, instead| ExtractionWarning::EnvironmentNotBaked { name: name.clone(), kind, instead };
        match source {
            Source::Atmosphere => out.warnings.push(not_baked(
                "the light of the atmosphere",
                "give the sky as a picture (SceneSettings::environment) to bake it",
            )),
            Source::Local => out.warnings.push(not_baked(
                "the local environment map",
                "put it on the camera to bake it as the sky of the whole scene",
            )),
            Source::Sky(sky) if taken.as_ref() == Some(&sky) => {}
            Source::Sky(_) if settings.environment.is_some() || taken.is_some() => {
                out.warnings.push(not_baked("the environment map", "a scene has one sky, and another was given"));
            }
            Source::Sky(sky) => {
                sky.read(world, &name, out);
                taken = Some(sky);
            }
        }
    }
}

/// Light from around, as a component says it.
enum Source {
    /// A sky that shaders make.
    Atmosphere,
    /// What holds inside a box only.
    Local,
    /// A picture of the sky of the whole scene.
    Sky(Sky),
}

/// A picture of the sky.
#[derive(PartialEq)]
struct Sky {
    /// Where its radiance may be found, best first.
    images: Vec<Handle<Image>>,
    intensity: f32,
    rotation: Quat,
}

/// All of them by name. On anything but a camera or a light probe Bevy takes no notice of them.
fn find(world: &mut World) -> Vec<(String, Source)> {
    type Parts<'a> = (
        Entity,
        Option<&'a EnvironmentMapLight>,
        Option<&'a GeneratedEnvironmentMapLight>,
        Has<AtmosphereEnvironmentMapLight>,
        Has<LightProbe>,
        Has<Camera>,
    );
    let mut found = Vec::new();
    for (entity, filtered, generated, atmosphere, probe, camera) in world.query::<Parts>().iter(world) {
        // What Bevy filters at run time has its own picture, and the filtered one is on the GPU only.
        let sky = match (generated, filtered) {
            (Some(map), _) => {
                Sky { images: vec![map.environment_map.clone()], intensity: map.intensity, rotation: map.rotation }
            }
            (None, Some(map)) => Sky {
                images: vec![map.specular_map.clone(), map.diffuse_map.clone()],
                intensity: map.intensity,
                rotation: map.rotation,
            },
            (None, None) if atmosphere => Sky { images: Vec::new(), intensity: 1.0, rotation: Quat::IDENTITY },
            (None, None) => continue,
        };
        let source = match (atmosphere, probe, camera) {
            (true, ..) => Source::Atmosphere,
            _ if sky.intensity == 0.0 => continue,
            (_, true, _) => Source::Local,
            (.., true) => Source::Sky(sky),
            _ => continue,
        };
        found.push((entity, source));
    }
    let ids = StableIds::new(world);
    let named = found.into_iter().map(|(entity, source)| (ids.of(entity).as_str().to_owned(), source));
    let mut named: Vec<(String, Source)> = named.collect();
    named.sort_by(|(a, _), (b, _)| a.cmp(b));
    named
}

impl Sky {
    /// Puts the first picture that can be read into the scene. A map that is made for diffuse light stands in for
    /// the sharp one where it must; it is the same light, blurred.
    fn read(&self, world: &World, name: &str, out: &mut Extraction) {
        let mut why = None;
        for handle in &self.images {
            match texture::image(world, handle, &mut out.missed).and_then(|image| picture(&image)) {
                Ok((width, height, radiance)) => {
                    let label = texture::name(handle).unwrap_or_else(|| name.to_owned());
                    let radiance: Arc<[Vec3]> = radiance.iter().map(|&radiance| radiance * self.intensity).collect();
                    let world_from_map = self.rotation;
                    out.scene.environment =
                        Some(EnvironmentMap { name: label, width, height, radiance, world_from_map });
                    if let Some(why) = why {
                        out.warnings.push(ExtractionWarning::EnvironmentBlurred { name: name.to_owned(), why });
                    }
                    return;
                }
                Err(error) => why = why.or(Some(error)),
            }
        }
        if let Some(why) = why {
            out.warnings.push(ExtractionWarning::EnvironmentNotRead { name: name.to_owned(), why });
        }
    }
}

/// An image as an equirectangular picture: a flat one as it is, a cube resampled.
fn picture(image: &Image) -> Result<(u32, u32, Vec<Vec3>), Unreadable> {
    let descriptor = &image.texture_descriptor;
    let size = descriptor.size;
    match (descriptor.dimension, size.depth_or_array_layers) {
        (TextureDimension::D2, 1) => Ok((size.width, size.height, colours(&texture::layer(image, 0)?))),
        (TextureDimension::D2, 6) if size.width == size.height && size.width > 0 => {
            let mut texels = Vec::with_capacity(6 * size.width as usize * size.width as usize);
            for face in 0..6 {
                texels.extend(colours(&texture::layer(image, face)?));
            }
            Ok(Cube { side: size.width, texels }.equirectangular())
        }
        _ => Err(Unreadable::NotACube),
    }
}

fn colours(texels: &Texels) -> Vec<Vec3> {
    let byte = |byte: u8| f32::from(byte) / 255.0;
    let three = |[r, g, b, _]: [f32; 4]| Vec3::new(r, g, b);
    match texels {
        Texels::Float(texels) => texels.iter().map(|&texel| three(texel)).collect(),
        Texels::Linear8(texels) => texels.iter().map(|texel| three(texel.map(byte))).collect(),
        Texels::Srgb8(texels) => {
            texels.iter().map(|&[r, g, b, _]| LinearRgba::from(Srgba::rgb_u8(r, g, b)).to_vec3()).collect()
        }
    }
}

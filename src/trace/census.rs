//! What a scene calls for, counted: which effects, and by how many of its materials and lights.

use super::effects::{Effect, EffectSet};
use super::material::{called_by, is_smooth};
use super::transport::Transport;
use crate::scene::{Light, Scattering, Scene};
use glam::Vec3;
use std::collections::BTreeMap;

/// What a scene calls for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Census {
    called: EffectSet,
    counts: BTreeMap<Effect, u64>,
    materials: u64,
    sized_point_lights: u64,
    sized_suns: u64,
    smooth_materials: u64,
    sky_radiance: Vec3,
    environment_size: [u32; 2],
}

/// What reflects light on a surface whose base colour is black.
const REFLECTS_WITHOUT_COLOUR: EffectSet =
    EffectSet::NONE.with(Effect::SpecularReflection).with(Effect::Clearcoat).with(Effect::Refraction);

/// The effect that a light is a part of.
pub(crate) fn effect_of(light: &Light) -> Effect {
    match light {
        Light::Rect(_) => Effect::AreaLights,
        Light::Point(_) | Light::Spot(_) => Effect::PointLights,
        Light::Directional(_) => Effect::DirectionalLights,
    }
}

/// Which parts of a scene count.
pub(super) struct Counted<'a> {
    pub(super) scene: &'a Scene,
    /// Indices of the instances.
    pub(super) instances: &'a [usize],
    pub(super) lights: &'a [&'a Light],
    pub(super) sky_radiance: Vec3,
    pub(super) has_environment: bool,
}

impl Census {
    pub(super) fn take(counted: &Counted<'_>, transport: &Transport) -> Self {
        let mut census = Self { sky_radiance: counted.sky_radiance, ..Self::default() };
        census.take_materials(counted, transport);
        for light in counted.lights {
            census.take_light(light);
        }
        if counted.sky_radiance != Vec3::ZERO {
            census.call(Effect::ConstantSky, 1);
        }
        if let Some(map) = counted.scene.environment.as_ref().filter(|_| counted.has_environment) {
            census.environment_size = [map.width, map.height];
            census.call(Effect::EnvironmentMap, 1);
        }
        census
    }

    /// What the scene calls for.
    pub(crate) fn called(&self) -> EffectSet {
        self.called
    }

    /// How many materials, or lights, call for an effect.
    pub(crate) fn count(&self, effect: Effect) -> u64 {
        self.counts.get(&effect).copied().unwrap_or(0)
    }

    /// Materials in use.
    pub(crate) fn materials(&self) -> u64 {
        self.materials
    }

    /// Point and spot lights with a radius.
    pub(crate) fn sized_point_lights(&self) -> u64 {
        self.sized_point_lights
    }

    /// Directional lights with a disc.
    pub(crate) fn sized_suns(&self) -> u64 {
        self.sized_suns
    }

    /// Point, spot and directional lights without a size.
    pub(crate) fn unsized_lights(&self) -> u64 {
        let lights = self.count(Effect::PointLights) + self.count(Effect::DirectionalLights);
        lights - self.sized_point_lights - self.sized_suns
    }

    /// Materials that are perfectly smooth mirrors, metal or bodies of glass.
    pub(crate) fn smooth_materials(&self) -> u64 {
        self.smooth_materials
    }

    /// Radiance of the constant sky [cd/m²].
    pub(crate) fn sky_radiance(&self) -> Vec3 {
        self.sky_radiance
    }

    /// Width and height of the picture of the sky [pixels].
    pub(crate) fn environment_size(&self) -> [u32; 2] {
        self.environment_size
    }

    /// Area lights are counted by their shapes, once these are known.
    pub(super) fn count_shapes(&mut self, shapes: u64) {
        self.counts.insert(Effect::AreaLights, shapes);
    }

    fn take_materials(&mut self, counted: &Counted<'_>, transport: &Transport) {
        let mut used: BTreeMap<usize, EffectSet> = BTreeMap::new();
        for &index in counted.instances {
            let instance = &counted.scene.instances[index];
            let calls = called_by(&counted.scene.materials[instance.material], &counted.scene.meshes[instance.mesh]);
            let all = used.entry(instance.material).or_default();
            *all = all.iter().chain(calls.iter()).collect();
        }
        self.materials = used.len() as u64;
        for (&material, calls) in &used {
            for effect in calls.iter() {
                self.call(effect, 1);
            }
            let material = &counted.scene.materials[material];
            self.smooth_materials += u64::from(is_smooth(material));
            let is_black = match &material.scattering {
                Scattering::None => true,
                // The surface of glass reflects whatever its colour.
                Scattering::Refraction { .. } => false,
                Scattering::Diffuse | Scattering::Mirror => material.base_colour.truncate() == Vec3::ZERO,
                Scattering::Standard(_) | Scattering::Phong { .. } => {
                    material.base_colour.truncate() == Vec3::ZERO && !calls.has_any(REFLECTS_WITHOUT_COLOUR)
                }
            };
            if !is_black && transport.max_bounces != Some(0) {
                self.call(Effect::Interreflection, 1);
            }
        }
    }

    fn take_light(&mut self, light: &Light) {
        self.call(effect_of(light), 1);
        match light {
            Light::Rect(_) => {}
            Light::Point(light) => self.sized_point_lights += u64::from(light.radius > 0.0),
            Light::Spot(light) => self.sized_point_lights += u64::from(light.bulb.radius > 0.0),
            Light::Directional(light) => self.sized_suns += u64::from(light.angular_diameter > 0.0),
        }
    }

    fn call(&mut self, effect: Effect, count: u64) {
        self.called = self.called.with(effect);
        *self.counts.entry(effect).or_default() += count;
    }
}

//! From a scene to a [`Tracer`]: faults left out, the rest in the traced frame and in an order of its own; and of
//! that only what the plan asks for.

mod sound;
mod world;

use super::census::{Census, Counted, effect_of};
use super::effects::Effect;
use super::material::View;
use super::tracer::Tracer;
use super::transport::Transport;
use crate::scene::{Fault, Light, Scene};
use glam::Vec3;
use sound::Sound;
use world::World;

/// A compiled scene and what could not be part of it.
pub(crate) struct Compiled {
    pub(crate) tracer: Tracer,
    /// Faults of the scene; what they name is left out, or has no lightmap.
    pub(crate) faults: Vec<Fault>,
    /// What the scene calls for.
    pub(crate) census: Census,
}

/// What a scene is compiled for.
#[derive(Clone, Copy, Default)]
struct Purpose<'a> {
    has_camera: bool,
    /// Whether paths start at probes of irradiance volumes instead of at texels.
    has_probes: bool,
    /// A tracer of the same scene whose tree can be shared.
    tree_of: Option<&'a Tracer>,
}

impl Purpose<'_> {
    /// Whether the direct light of a source is drawn in real time where paths start. Bevy cannot have a rectangular light
    /// light some things and not others, so that one which lightmaps hold is off.
    fn is_drawn(self, scene: &Scene, light: &Light) -> bool {
        let is_on_in_real_time = match light {
            Light::Rect(_) => false,
            Light::Point(_) | Light::Spot(_) | Light::Directional(_) => {
                self.has_probes && !scene.off_in_real_time.contains(light.id())
            }
        };
        is_on_in_real_time || scene.indirect_only.contains(light.id())
    }
}

impl Compiled {
    /// Compiles what is sound in a scene, for the effects that it calls for and those that are forced.
    pub(crate) fn new(scene: &Scene, transport: &Transport) -> Self {
        Self::compile(scene, transport, Purpose::default())
    }

    /// The same for rays that start at a camera.
    pub(crate) fn for_camera(scene: &Scene, transport: &Transport) -> Self {
        Self::compile(scene, transport, Purpose { has_camera: true, ..Purpose::default() })
    }

    /// The same for probes of irradiance volumes.
    pub(crate) fn for_probes(scene: &Scene, transport: &Transport) -> Self {
        Self::compile(scene, transport, Purpose { has_probes: true, ..Purpose::default() })
    }

    /// The same scene for other effects, with the tree of another tracer of it.
    pub(crate) fn sharing_tree(scene: &Scene, transport: &Transport, other: &Tracer) -> Self {
        Self::compile(scene, transport, Purpose { tree_of: Some(other), ..Purpose::default() })
    }

    fn compile(scene: &Scene, transport: &Transport, purpose: Purpose<'_>) -> Self {
        let faults = scene.validate();
        let sound = Sound::new(scene, &faults);
        let mut instances: Vec<usize> = (0..scene.instances.len()).filter(|&index| sound.instances[index]).collect();
        instances.sort_by(|&a, &b| scene.instances[a].id.cmp(&scene.instances[b].id));
        let mut lights: Vec<&Light> =
            scene.lights.iter().zip(&sound.lights).filter(|(_, sound)| **sound).map(|(light, _)| light).collect();
        lights.sort_by(|a, b| a.id().cmp(b.id()));
        let sky_radiance = if sound.sky { scene.sky_radiance } else { Vec3::ZERO };
        let counted = Counted {
            scene,
            instances: &instances,
            lights: &lights,
            sky_radiance,
            has_environment: sound.environment && scene.environment.is_some(),
        };
        let mut census = Census::take(&counted, transport);
        let effects = transport.effects.apply(census.called());
        let view = View { effects, has_camera: purpose.has_camera };
        let mut world = World::new(scene, &sound, &instances, view);
        for index in instances {
            world.add_instance(scene, index, sound.lightmaps[index]);
        }
        world.move_to_traced_frame();
        world.add_emitters();
        let is_drawn = |light: &Light| purpose.is_drawn(scene, light);
        if lights.iter().any(|light| is_drawn(light)) {
            world.part_baked_sources();
        }
        for light in lights {
            if effects.has(effect_of(light)) {
                world.add_light(light, is_drawn(light));
            }
        }
        if let Some(map) =
            scene.environment.as_ref().filter(|_| sound.environment && effects.has(Effect::EnvironmentMap))
        {
            world.set_environment(map);
        }
        let sky_radiance = if effects.has(Effect::ConstantSky) { sky_radiance } else { Vec3::ZERO };
        census.count_shapes(world.shape_count());
        Self { tracer: world.into_tracer(sky_radiance, purpose.tree_of), faults, census }
    }
}

impl Tracer {
    /// Compiles what is sound in a scene, for the effects that it calls for; [`Scene::validate`] tells what is not
    /// sound.
    pub fn new(scene: &Scene) -> Self {
        Compiled::new(scene, &Transport::default()).tracer
    }
}

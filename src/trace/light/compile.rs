//! From the lights of a scene to sources. Knows their units and frames; which lights are sound is known before.

use super::distant::DistantDisc;
use super::emitter::{Cone, Emitter, EmitterShape};
use super::environment::Environment;
use super::lights::{Lights, Parts};
use crate::scene::{EnvironmentMap, Light, PointLight, RectLight, SpotLight};
use crate::trace::surface::{Placement, position_error};
use crate::trace::traced::TracedFromWorld;
use glam::Vec3;
use std::f32::consts::PI;

/// Sources as they come together. Their order is that in which they are added, and must not depend on how the scene is
/// stored.
#[derive(Clone, Debug, Default)]
pub(in crate::trace) struct Sources(Parts);

impl Sources {
    /// Adds a glowing surface, which rays meet as such; the answer is its number.
    pub(in crate::trace) fn add_emitter(&mut self, emitter: Emitter) -> u32 {
        self.0.emitters.push(emitter);
        self.0.emitters.len() as u32 - 1
    }

    /// Adds a light that is no surface. One that gives no light is left out.
    pub(in crate::trace) fn add_light(&mut self, light: &Light, traced_from_world: TracedFromWorld) {
        match light {
            Light::Rect(light) => self.add_free(rectangle(light, traced_from_world)),
            Light::Point(light) => self.add_free(bulb(light, None, traced_from_world)),
            Light::Spot(light) => self.add_free(bulb(&light.bulb, Some(cone(light)), traced_from_world)),
            Light::Directional(light) => {
                if light.illuminance != Vec3::ZERO {
                    self.0.distant.push(DistantDisc::new(light));
                }
            }
        }
    }

    /// Adds the picture of the sky.
    pub(in crate::trace) fn set_environment(&mut self, map: &EnvironmentMap) {
        self.0.environment = Environment::new(map);
    }

    /// Ready to be aimed at.
    pub(in crate::trace) fn into_lights(self) -> Lights {
        Lights::new(self.0)
    }

    fn add_free(&mut self, emitter: Emitter) {
        if emitter.strength == Vec3::ZERO {
            return;
        }
        let is_point = matches!(emitter.shape, EmitterShape::Point { .. });
        let number = self.add_emitter(emitter);
        if !is_point {
            self.0.free.push(number);
        }
    }
}

fn rectangle(light: &RectLight, traced_from_world: TracedFromWorld) -> Emitter {
    let placement = Placement::traced(&light.world_from_local, traced_from_world);
    let (x, y) = (0.5 * light.width, 0.5 * light.height);
    let corner = placement.position(Vec3::new(-x, -y, 0.0));
    // Not as differences of corners, which are rounded where they stand: far away a lamp would lose its size.
    let edges = [light.width * Vec3::X, light.height * Vec3::Y].map(|e| light.world_from_local.transform_vector3(e));
    let normal = placement.normal(Vec3::NEG_Z);
    let error = position_error([corner, corner + edges[0], corner + edges[1], corner + edges[0] + edges[1]]);
    // A lamp set flush into a ceiling must lie before it, not half behind it by rounding.
    let corner = corner + normal * error.dot(normal.abs());
    Emitter {
        shape: EmitterShape::Rectangle { corner, edges },
        normal,
        strength: light.radiance,
        mean_strength: light.radiance,
        double_sided: false,
        inverse_range: inverse_range(light.range),
        cone: None,
        error,
    }
}

fn bulb(light: &PointLight, cone: Option<Cone>, traced_from_world: TracedFromWorld) -> Emitter {
    let PointLight { position, radius, .. } = *light;
    let centre = traced_from_world.point(position);
    // So small that its radiance is no number: the same light comes from a point.
    let is_point = !(light.intensity / (PI * radius * radius)).is_finite();
    Emitter {
        shape: if is_point { EmitterShape::Point { centre } } else { EmitterShape::Sphere { centre, radius } },
        normal: Vec3::Y,
        strength: light.intensity,
        mean_strength: light.intensity,
        double_sided: false,
        inverse_range: inverse_range(light.range),
        cone,
        error: position_error([centre.abs() + Vec3::splat(radius)]),
    }
}

fn cone(light: &SpotLight) -> Cone {
    Cone {
        direction: light.direction.normalize_or(Vec3::NEG_Y),
        inner_angle: light.inner_angle,
        outer_angle: light.outer_angle,
    }
}

/// 1/range [1/m], short of what no longer can be multiplied.
fn inverse_range(range: Option<f32>) -> f32 {
    range.map_or(0.0, |range| range.recip().min(1e18))
}

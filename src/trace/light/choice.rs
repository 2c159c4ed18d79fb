//! Which source to aim at: in proportion to its power.

use super::{Emitter, LightSample};
use crate::math::Discrete;
use crate::math::luminance;
use glam::{Vec2, Vec3};

/// All sources of a scene.
#[derive(Debug, Default)]
pub(in crate::trace) struct Emitters {
    emitters: Vec<Emitter>,
    choice: Option<Discrete>,
    /// Those that block nothing, so that no ray meets them as triangles.
    free: Vec<u32>,
}

impl Emitters {
    /// Gathers sources, in an order that must not depend on how the scene is stored. `free` lists those that block
    /// nothing.
    pub(in crate::trace) fn new(emitters: Vec<Emitter>, free: Vec<u32>) -> Self {
        let power = |emitter: &Emitter| {
            let sides = if emitter.double_sided { 2.0 } else { 1.0 };
            // The mean keeps a pure blue lamp, whose luminance is small, from being starved.
            let brightness = luminance(emitter.radiance) + f64::from(emitter.radiance.element_sum()) / 3.0;
            sides * brightness * emitter.area()
        };
        let choice = Discrete::new(emitters.iter().map(power)).ok();
        Self { emitters, choice, free }
    }

    /// Whether there is nothing to aim at.
    pub(in crate::trace) fn is_empty(&self) -> bool {
        self.choice.is_none()
    }

    /// How many there are.
    pub(in crate::trace) fn len(&self) -> usize {
        self.emitters.len()
    }

    /// All sources.
    pub(in crate::trace) fn iter(&self) -> impl Iterator<Item = &Emitter> {
        self.emitters.iter()
    }

    /// A source.
    pub(in crate::trace) fn get(&self, index: u32) -> &Emitter {
        &self.emitters[index as usize]
    }

    /// One of the sources.
    pub(in crate::trace) fn choose(&self, u_choice: f32) -> Option<&Emitter> {
        Some(&self.emitters[self.choice.as_ref()?.sample(f64::from(u_choice)).index])
    }

    /// A point on one of the sources; `None` if it gives no light here.
    pub(in crate::trace) fn sample(&self, receiver: Vec3, u: Vec2, u_choice: f32) -> Option<LightSample> {
        let chosen = self.choice.as_ref()?.sample(f64::from(u_choice));
        let sample = self.emitters[chosen.index].sample(receiver, u)?;
        Some(LightSample { pdf: sample.pdf * chosen.probability as f32, ..sample })
    }

    /// Chance with which `sample` takes this source.
    #[inline]
    pub(super) fn choice_probability(&self, index: u32) -> f64 {
        self.choice.as_ref().map_or(0.0, |choice| choice.probability(index as usize))
    }

    /// Density with which `sample` finds source `index` in the unit direction `wi`, `distance` away [1/sr].
    pub(in crate::trace) fn pdf(&self, index: u32, receiver: Vec3, wi: Vec3, distance: f32) -> f32 {
        let probability = self.choice_probability(index) as f32;
        if probability == 0.0 {
            return 0.0;
        }
        probability * self.get(index).pdf(receiver, wi, distance)
    }

    /// The sources that block nothing and that the ray passes before `end`, with their distances.
    pub(in crate::trace) fn passed(
        &self,
        origin: Vec3,
        direction: Vec3,
        end: f32,
    ) -> impl Iterator<Item = (u32, f32)> + '_ {
        self.free.iter().filter_map(move |&index| {
            let distance = self.get(index).intersect(origin, direction)?;
            (distance < end).then_some((index, distance))
        })
    }
}

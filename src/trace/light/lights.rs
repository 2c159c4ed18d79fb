//! All sources of a scene: which to aim at, how densely a direction is found, what a ray meets.
//!
//! Sources infinitely far away are chosen against those in the tree by the irradiance that each can give to the
//! receiver. That says nothing of what is hidden from it (indoors, the sun mostly is), so a part of the choice goes to
//! all that can give light alike.

use super::distant::DistantDisc;
use super::environment::Environment;
use super::passed::Passable;
use super::tree::LightTree;
use super::{Emitter, EmitterShape, End, LightContext, LightSample, MetSource, SourceIndex, Way, density};
use crate::math::Discrete;
use glam::{DVec3, Vec2, Vec3};

/// Part of the choice between the tree and each source infinitely far away that does not ask for their light.
const EVEN_SHARE: f64 = 0.2;

/// All sources of a scene.
#[derive(Debug, Default)]
pub(in crate::trace) struct Lights {
    emitters: Vec<Emitter>,
    tree: Option<LightTree>,
    passable: Passable,
    distant: Vec<DistantDisc>,
    environment: Option<Environment>,
    /// Whether any source is a point or a single direction.
    has_delta: bool,
    /// By flux, or what stands for it, for walks that start at a source.
    departures: Option<Discrete>,
}

/// The parts of [`Lights`], in an order that must not depend on how the scene is stored.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub(super) emitters: Vec<Emitter>,
    /// Numbers of those that block nothing, so that no ray meets them as triangles.
    pub(super) free: Vec<u32>,
    pub(super) distant: Vec<DistantDisc>,
    pub(super) environment: Option<Environment>,
}

/// What competes at one receiver: the sum of all irradiances, and how many may give any.
struct Rivals {
    tree: f64,
    total: f64,
    count: f64,
}

impl Rivals {
    /// The chance of one that gives this irradiance.
    fn chance(&self, importance: f64) -> f64 {
        if importance <= 0.0 {
            return 0.0;
        }
        if self.count <= 1.0 {
            return 1.0;
        }
        let share = if self.total.is_finite() { importance / self.total } else { 1.0 / self.count };
        (1.0 - EVEN_SHARE) * share + EVEN_SHARE / self.count
    }
}

impl Lights {
    pub(super) fn new(parts: Parts) -> Self {
        let Parts { emitters, free, distant, environment } = parts;
        let flux = |emitter: &Emitter| emitter.peak_intensity() * if emitter.double_sided { 2.0 } else { 1.0 };
        let is_point = |emitter: &Emitter| matches!(emitter.shape, EmitterShape::Point { .. });
        Self {
            has_delta: emitters.iter().any(is_point) || distant.iter().any(DistantDisc::is_delta),
            tree: LightTree::new(&emitters),
            passable: Passable::new(&emitters, &free),
            departures: Discrete::new(emitters.iter().map(flux)).ok(),
            emitters,
            distant,
            environment,
        }
    }

    /// Whether there is nothing to aim at.
    pub(in crate::trace) fn is_empty(&self) -> bool {
        self.tree.is_none() && !self.has_distant()
    }

    /// Whether light comes from infinitely far away.
    pub(in crate::trace) fn has_distant(&self) -> bool {
        !self.distant.is_empty() || self.environment.is_some()
    }

    /// How many sources are somewhere.
    pub(in crate::trace) fn emitter_count(&self) -> usize {
        self.emitters.len()
    }

    /// A source that is somewhere.
    pub(in crate::trace) fn get(&self, index: u32) -> &Emitter {
        &self.emitters[index as usize]
    }

    /// Flux that all sources give off, per channel [lm]; `None` where a source's cannot be told.
    pub(in crate::trace) fn flux(&self) -> Option<DVec3> {
        if self.has_distant() {
            return None;
        }
        self.emitters.iter().map(Emitter::flux).sum()
    }

    /// Where and in which direction some of the light of those that are somewhere sets out.
    pub(in crate::trace) fn depart(&self, u_choice: f32, u: [f32; 4]) -> Option<(Vec3, Vec3)> {
        Some(self.emitters[self.departures.as_ref()?.sample(f64::from(u_choice)).index].depart(u))
    }

    /// A direction to one of the sources; `None` if it gives no light here.
    pub(in crate::trace) fn sample(&self, ctx: &LightContext, u: Vec2, u_choice: f32) -> Option<LightSample> {
        let mut at = f64::from(u_choice);
        if !self.has_distant() {
            return self.sample_tree(ctx, u, at, 1.0);
        }
        let rivals = self.rivals(ctx);
        let tree_chance = rivals.chance(rivals.tree);
        if at < tree_chance {
            return self.sample_tree(ctx, u, at / tree_chance, tree_chance);
        }
        at -= tree_chance;
        let mut last = None;
        for disc in &self.distant {
            let chance = rivals.chance(disc.importance(ctx));
            if chance > 0.0 {
                last = Some((disc, chance));
                if at < chance {
                    return sample_disc(disc, u, chance);
                }
            }
            at -= chance;
        }
        match (&self.environment, last) {
            (Some(environment), _) => sample_sky(environment, u, rivals.chance(environment.importance())),
            // What rounding left over.
            (None, Some((disc, chance))) => sample_disc(disc, u, chance),
            (None, None) => None,
        }
    }

    /// Density with which [`Self::sample`] finds source `emitter` in the unit direction `wi`, in which it is `distance`
    /// away [1/sr]. 0 for a delta source.
    pub(in crate::trace) fn pdf(&self, emitter: u32, ctx: &LightContext, wi: Vec3, distance: f32) -> f32 {
        let chance = self.chance(emitter, ctx);
        if chance == 0.0 {
            return 0.0;
        }
        match self.get(emitter).solid_angle(ctx.position, wi, distance) {
            Some(solid_angle) if solid_angle > 0.0 => density(chance / solid_angle),
            _ => 0.0,
        }
    }

    /// Whether any source is a point or a single direction, which no ray meets.
    pub(in crate::trace) fn has_delta(&self) -> bool {
        self.has_delta
    }

    /// Whether any source blocks nothing and has a size, so that a ray may pass it.
    #[inline]
    pub(in crate::trace) fn has_passable(&self) -> bool {
        !self.passable.is_empty()
    }

    /// The sources that block nothing and that a ray passes on a way that begins at `ctx.position`, moved off its
    /// surface, or straight before it.
    pub(in crate::trace) fn passed<'a>(
        &'a self,
        ctx: &'a LightContext,
        way: Way,
    ) -> impl Iterator<Item = MetSource> + 'a {
        let Way { origin, direction: wi, end, passed } = way;
        self.passable.candidates(origin, wi, end).filter_map(move |number| {
            let emitter = self.get(number);
            let distance = match emitter.shape {
                // Only the near side of a sphere shines; from within it, one that was passed would be met again.
                EmitterShape::Sphere { .. } => emitter.intersect(ctx.position, wi)? - passed,
                _ => emitter.intersect(origin, wi)?,
            };
            if !(0.0..end).contains(&distance) {
                return None;
            }
            let radiance = emitter.radiance_towards(ctx.position, wi);
            (radiance != Vec3::ZERO).then(|| {
                let pdf = self.pdf(number, ctx, wi, passed + distance);
                MetSource { radiance, pdf, distance }
            })
        })
    }

    /// The sources infinitely far away that a ray meets which leaves the scene in the unit direction `wi`.
    pub(in crate::trace) fn distant<'a>(
        &'a self,
        ctx: &'a LightContext,
        wi: Vec3,
    ) -> impl Iterator<Item = MetSource> + 'a {
        let discs = self.distant.iter().filter_map(move |disc| {
            let radiance = disc.radiance(wi);
            (radiance != Vec3::ZERO).then(|| {
                let chance = self.rivals(ctx).chance(disc.importance(ctx));
                MetSource { radiance, pdf: density(chance / disc.solid_angle()), distance: f32::INFINITY }
            })
        });
        let sky = self.environment.iter().filter_map(move |environment| {
            let (radiance, pdf) = environment.look(wi);
            (radiance != Vec3::ZERO).then(|| {
                let chance = self.rivals(ctx).chance(environment.importance());
                MetSource { radiance, pdf: density(chance * pdf), distance: f32::INFINITY }
            })
        });
        discs.chain(sky)
    }

    /// Radiance of the picture of the sky alone in a direction, which a camera may see [cd/m²].
    pub(in crate::trace) fn sky_picture(&self, wi: Vec3) -> Vec3 {
        self.environment.as_ref().map_or(Vec3::ZERO, |environment| environment.look(wi).0)
    }

    /// The chance with which [`Self::sample`] takes this source.
    pub(super) fn chance(&self, emitter: u32, ctx: &LightContext) -> f64 {
        let Some(tree) = &self.tree else {
            return 0.0;
        };
        if !self.has_distant() {
            return tree.probability(ctx, emitter);
        }
        let rivals = self.rivals(ctx);
        rivals.chance(rivals.tree) * tree.probability(ctx, emitter)
    }

    fn rivals(&self, ctx: &LightContext) -> Rivals {
        let tree = self.tree.as_ref().map_or(0.0, |tree| tree.importance(ctx));
        let sky = self.environment.as_ref().map_or(0.0, Environment::importance);
        let mut rivals = Rivals { tree, total: tree + sky, count: 0.0 };
        rivals.count += f64::from(u8::from(tree > 0.0)) + f64::from(u8::from(sky > 0.0));
        for disc in &self.distant {
            let importance = disc.importance(ctx);
            rivals.total += importance;
            rivals.count += f64::from(u8::from(importance > 0.0));
        }
        rivals
    }

    fn sample_tree(&self, ctx: &LightContext, u: Vec2, u_choice: f64, chance: f64) -> Option<LightSample> {
        let choice = self.tree.as_ref()?.choose(ctx, u_choice)?;
        let sample = self.get(choice.source).sample(ctx.position, u)?;
        let chance = chance * choice.probability;
        Some(LightSample {
            wi: sample.wi,
            end: sample.end,
            distance: sample.distance as f32,
            value: finite(sample.value / chance)?,
            pdf: sample.solid_angle.map(|solid_angle| density(chance / solid_angle)),
            source: SourceIndex::Emitter(choice.source),
        })
    }
}

fn sample_disc(disc: &DistantDisc, u: Vec2, chance: f64) -> Option<LightSample> {
    let sample = disc.sample(u);
    Some(LightSample {
        wi: sample.wi,
        end: End::Infinity,
        distance: f32::INFINITY,
        value: finite(sample.value / chance)?,
        pdf: sample.solid_angle.map(|solid_angle| density(chance / solid_angle)),
        source: SourceIndex::Distant,
    })
}

fn sample_sky(environment: &Environment, u: Vec2, chance: f64) -> Option<LightSample> {
    let sample = environment.sample(u)?;
    Some(LightSample {
        wi: sample.wi,
        end: End::Infinity,
        distance: f32::INFINITY,
        value: finite(sample.radiance.as_dvec3() / (sample.pdf * chance))?,
        pdf: Some(density(sample.pdf * chance)),
        source: SourceIndex::Distant,
    })
}

/// What a sample counts for, as far as it can be told in f32: light above 10³⁸ is cut, none is lost below.
fn finite(value: DVec3) -> Option<Vec3> {
    let value = value.min(DVec3::splat(f64::from(f32::MAX))).as_vec3();
    (value.is_finite() && value != Vec3::ZERO).then_some(value)
}

//! Pilots: a few texels, traced with and without each effect to tell what it costs.

use crate::bake::endless::refuse_endless_texels;
use crate::bake::sites::Site;
use crate::bake::workers::Workers;
use crate::bake::{BakeError, BakeSettings};
use crate::scene::Scene;
use crate::trace::{Compiled, Effect, Tracer};
use std::time::Instant;

/// Texels and paths of a pilot, and how often each is run.
const SHARE_TEXELS: usize = 64;
const SHARE_PATHS: u32 = 64;
const SHARE_RUNS: usize = 3;

/// A few texels that stand for all.
pub(super) struct Pilot<'a> {
    sites: &'a [Site],
    settings: &'a BakeSettings,
    workers: &'a Workers<'a>,
}

impl<'a> Pilot<'a> {
    pub(super) fn new(sites: &'a [Site], settings: &'a BakeSettings, workers: &'a Workers<'a>) -> Self {
        Self { sites, settings, workers }
    }

    /// Share of the time that each effect which is on costs: what is saved where it is forced off.
    pub(super) fn cost_shares(&self, scene: &Scene, tracer: &Tracer) -> Result<Vec<(Effect, f64)>, BakeError> {
        let without = tracer.effects().iter().map(|effect| (effect, self.without(scene, tracer, effect)));
        // A window may be all that lets light out of a white room, whose paths have no end without it.
        let ends = |tracer: &Tracer| refuse_endless_texels(scene, tracer, &self.settings.transport, self.sites).is_ok();
        let (effects, without): (Vec<Effect>, Vec<Tracer>) = without.filter(|(_, tracer)| ends(tracer)).unzip();
        let mut all = Vec::new();
        let mut rest: Vec<Vec<f64>> = vec![Vec::new(); effects.len()];
        // In turns, so that whatever else the machine does falls on all alike.
        for _ in 0..SHARE_RUNS {
            all.push(self.time(tracer)?);
            for (seconds, tracer) in rest.iter_mut().zip(&without) {
                seconds.push(self.time(tracer)?);
            }
        }
        let all = least(&all);
        let share = |seconds: &Vec<f64>| (1.0 - least(seconds) / all.max(1e-9)).clamp(0.0, 1.0);
        Ok(effects.into_iter().zip(rest.iter().map(share)).collect())
    }

    fn without(&self, scene: &Scene, tracer: &Tracer, effect: Effect) -> Tracer {
        let mut transport = self.settings.transport;
        transport.effects.off = transport.effects.off.with(effect);
        Compiled::sharing_tree(scene, &transport, tracer).tracer
    }

    /// The time that texels take which are spread evenly over all [s].
    fn time(&self, tracer: &Tracer) -> Result<f64, BakeError> {
        let step = (self.sites.len() / SHARE_TEXELS).max(1);
        let pilot: Vec<&Site> = self.sites.iter().step_by(step).collect();
        let transport = &self.settings.transport;
        let clock = Instant::now();
        self.workers.gather_quietly(&pilot, |site, cancel| site.estimate(tracer, SHARE_PATHS, transport, cancel))?;
        Ok(clock.elapsed().as_secs_f64())
    }
}

/// The least of several times: what the machine took when nothing else disturbed it.
fn least(seconds: &[f64]) -> f64 {
    seconds.iter().copied().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use crate::artefact::StableId;
    use crate::bake::{BakePlan, BakeSettings, CancelToken};
    use crate::scene::{Alpha, Indices, Instance, LightmapRequest, Material, Mesh, Scene};
    use crate::trace::Effect;
    use glam::{Affine3A, Quat, Vec2, Vec3, Vec4};
    use std::f32::consts::FRAC_PI_2;

    /// A white cube with a window in place of its ceiling.
    fn room() -> Scene {
        let square = Mesh {
            name: "square".into(),
            indices: Indices::U16(vec![0, 2, 1, 0, 3, 2]),
            positions: [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(|[x, z]| Vec3::new(x as f32, -1.0, z as f32)).to_vec(),
            uv1: Some(vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]),
            ..Mesh::default()
        };
        let white = Material::diffuse("white", Vec3::ONE);
        let pane = Material { base_colour: Vec4::new(1.0, 1.0, 1.0, 0.1), alpha: Alpha::Blend, ..white.clone() };
        let around = [0.0, 1.0, 2.0, 3.0].map(|turns| Quat::from_rotation_z(turns * FRAC_PI_2));
        let across = [-1.0, 1.0].map(|turns| Quat::from_rotation_x(turns * FRAC_PI_2));
        let side = |(index, rotation): (usize, Quat)| Instance {
            id: StableId::new(format!("side {index}")),
            name: format!("side {index}"),
            mesh: 0,
            material: usize::from(index == 2),
            world_from_local: Affine3A::from_quat(rotation),
            lightmap: (index != 2).then(LightmapRequest::default),
        };
        Scene {
            meshes: vec![square],
            materials: vec![white, pane],
            instances: around.into_iter().chain(across).enumerate().map(side).collect(),
            sky_radiance: Vec3::ONE,
            ..Scene::default()
        }
    }

    /// What lets light out of a white room has no price: without it no path ends.
    #[test]
    fn the_only_window_of_a_white_room_has_no_price() {
        let settings = BakeSettings { density: 1.0, ..BakeSettings::default() };
        let plan = BakePlan::for_scene(&room(), &settings, &(), &CancelToken::default()).unwrap();
        let of = |effect| plan.effects.iter().find(|planned| planned.effect == effect).unwrap();
        let window = of(Effect::Transparency);
        assert!(window.on && window.cost_share.is_none(), "{window:?}");
        assert!(of(Effect::ConstantSky).cost_share.is_some());
    }
}

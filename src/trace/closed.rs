//! Whether light can leave a scene, found by following it forwards from its sources, and whether it ends at all.

use super::path::Tally;
use super::sampler::{Dimensions, Sampler, Sobol};
use super::tracer::Tracer;
use super::transport::Transport;
use crate::math::{Frame, combine, square_to_cosine_hemisphere};
use glam::{Vec2, Vec3};

/// Longest walk. Between white walls it would go on for ever, and a way out is found long before.
const MAX_STEPS: u32 = 1000;

impl Tracer {
    /// Whether none of `walks` light paths from the sources leaves the scene.
    pub(crate) fn is_closed(&self, walks: u64, seed: u64) -> bool {
        let key = combine(seed, 0x636c_6f73_6564);
        !self.lights.is_empty()
            && !self.lights.has_distant()
            && (0..walks).all(|walk| self.stays_inside(&Sobol::new(key, walk)))
    }

    /// Follows a path from a source until it ends, as one from a receiver is followed: by what surfaces really do. One
    /// that nothing ends but mirrors and clear glass alone have kept, as a lamp's in a solid block of glass by total
    /// reflection, is none that a receiver could meet: the same way leads there and back.
    pub(crate) fn follow_from_source(&self, sampler: &Sobol, transport: &Transport, tally: &mut Tally) {
        let [u_choice, ..] = sampler.draw(Dimensions::Start);
        let departure = self.lights.depart(u_choice, sampler.draw(Dimensions::Light { vertex: 0 }));
        if let Some((origin, direction)) = departure {
            let mut own = Tally::default();
            self.radiance_along(origin, direction, sampler, transport, &mut own);
            tally.kept_by = own.kept_by.filter(|_| own.was_spread);
        }
    }

    fn stays_inside(&self, sampler: &Sobol) -> bool {
        let [u_choice, ..] = sampler.draw(Dimensions::Start);
        let Some((mut origin, mut direction)) =
            self.lights.depart(u_choice, sampler.draw(Dimensions::Light { vertex: 0 }))
        else {
            return false;
        };
        for step in 0..MAX_STEPS {
            let [u, v, u_survive, _] = sampler.draw(Dimensions::Scatter { vertex: step });
            let Some(hit) = self.accel.closest(origin, direction, f32::INFINITY) else {
                return false;
            };
            if u_survive >= self.diffuse_albedo(hit.triangle, hit.barycentric).max_element() {
                return true;
            }
            let normal: Vec3 = self.normal(hit.triangle);
            let side = if normal.dot(direction) > 0.0 { -normal } else { normal };
            let vertex = self.start_on_triangle(hit.triangle, hit.barycentric, side);
            origin = vertex.origin();
            direction = Frame::new(vertex.normal()).world_from_local(square_to_cosine_hemisphere(Vec2::new(u, v)));
        }
        true
    }
}

//! Light that is kept for ever: found by a few paths before all are started, so that a person is told what to change
//! instead of waiting for what has no end. Nothing is measured here.

use super::BakeError;
use super::sites::Site;
use crate::math::combine;
use crate::scene::Scene;
use crate::trace::{MAX_VERTICES, Sobol, Tally, Tracer, Transport};

/// Paths from sources, and as many from what receives.
const PROBES: u64 = 64;

/// Refuses a scene in which one of a few paths, from sources and from what receives, goes on for [`MAX_VERTICES`]. In
/// one that absorbs or lets go of light none does. `follow` follows the path of a number from a receiver.
pub(super) fn refuse_endless_paths(
    scene: &Scene,
    tracer: &Tracer,
    transport: &Transport,
    follow: impl Fn(u64, &Sobol, &mut Tally),
) -> Result<(), BakeError> {
    let [sources, receivers] = [0x6465_7061_7274, 0x6172_7269_7665].map(|kind| combine(transport.seed, kind));
    let mut tally = Tally::default();
    for probe in 0..PROBES {
        tracer.follow_from_source(&Sobol::new(sources, probe), transport, &mut tally);
        follow(probe, &Sobol::new(receivers, probe), &mut tally);
        if let Some(surface) = tally.kept_by {
            let material = scene.materials.get(surface as usize).map_or_else(String::new, |found| found.name.clone());
            return Err(BakeError::KeepsLight { material, surfaces: MAX_VERTICES });
        }
    }
    Ok(())
}

/// The same for paths from the texels of a lightmap.
pub(super) fn refuse_endless_texels(
    scene: &Scene,
    tracer: &Tracer,
    transport: &Transport,
    sites: &[Site],
) -> Result<(), BakeError> {
    refuse_endless_paths(scene, tracer, transport, |probe, sobol, tally| {
        if let Some(site) = spread(sites, probe) {
            tracer.diffuse_radiance(&site.footing.anchor, sobol, transport, tally);
        }
    })
}

/// The item at which a probe starts: evenly over the list.
pub(super) fn spread<T>(items: &[T], probe: u64) -> Option<&T> {
    items.get((probe as usize * items.len()) / PROBES as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probes_are_spread_over_the_list() {
        let items: Vec<u64> = (0..640).collect();
        assert_eq!((spread(&items, 0), spread(&items, 1), spread(&items, 63)), (Some(&0), Some(&10), Some(&630)));
        assert_eq!((spread(&[7], 63), spread::<u64>(&[], 0)), (Some(&7), None));
    }
}

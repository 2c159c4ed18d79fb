//! Rays from afar: moved along their own lines, in f64, to where the tree can take them. Why, and how exact that is,
//! stands in [`super`].

use super::{Accel, NEAR};
use glam::{DVec3, Vec3};

/// Half the side of the cube to which rays are moved, in reaches: within [`NEAR`] with room for rounding.
const CUBE: f64 = 1.25;

/// Coordinate up to which the target of a segment is used as it is, in reaches: far below where the square of its
/// distance overflows, 2³³.
const TOO_FAR: f32 = 16_777_216.0;

impl Accel {
    /// Whether a ray must be moved that starts here.
    #[inline]
    pub(super) fn is_far(&self, origin: Vec3) -> bool {
        (origin * self.scale).abs().max_element() > NEAR * self.reach
    }

    /// Whether a segment must be cut that ends here.
    #[inline]
    pub(super) fn is_too_far(&self, target: Vec3) -> bool {
        (target * self.scale).abs().max_element() > TOO_FAR * self.reach
    }

    /// Where a ray comes near the scene, and how far it has come by then [m]; `None` if it passes.
    #[cold]
    pub(super) fn come_nearer(&self, origin: Vec3, direction: Vec3) -> Option<(Vec3, f64)> {
        let (origin, direction) = (origin.as_dvec3(), direction.as_dvec3());
        let [enter, _] = self.within(origin, direction, f64::INFINITY)?;
        Some(((origin + direction * enter).as_vec3(), enter))
    }

    /// The part of a segment that lies near the scene, and how far its beginning is from `origin` [m]; `None` if there
    /// is none. An end that lies near stays what it is.
    #[cold]
    pub(super) fn part_within(&self, origin: Vec3, target: Vec3) -> Option<(Vec3, Vec3, f64)> {
        let (from, offset) = (origin.as_dvec3(), target.as_dvec3() - origin.as_dvec3());
        let [enter, leave] = self.within(from, offset, 1.0)?;
        let begin = if enter > 0.0 { (from + offset * enter).as_vec3() } else { origin };
        let end = if leave < 1.0 { (from + offset * leave).as_vec3() } else { target };
        Some((begin, end, enter * offset.length()))
    }

    /// Between which parameters in [0, `end`] a line is in the cube.
    fn within(&self, origin: DVec3, direction: DVec3, end: f64) -> Option<[f64; 2]> {
        let half = CUBE * f64::from(self.reach) / f64::from(self.scale);
        let (mut enter, mut leave) = (0.0_f64, end);
        for axis in 0..3 {
            let (from, along) = (origin[axis], direction[axis]);
            if along == 0.0 {
                if from.abs() > half {
                    return None;
                }
                continue;
            }
            let [a, b] = [-half, half].map(|side| (side - from) / along);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        (enter <= leave).then_some([enter, leave])
    }
}

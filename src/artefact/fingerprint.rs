//! What a thing was like when it was baked, in little: enough for a game to see that the bake is out of date, too
//! little to say how. What looks and places mean is the scene's owner's affair; here they are compared.

use super::mixing::Mixer;
use serde::{Deserialize, Serialize};

/// How far two places may be apart, as a share of what they are made of and at least of 1 m: what is left of exactness
/// when a place is put together from several.
const TOLERANCE: f32 = 1e-4;

/// A thing's place and look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fingerprint {
    /// From its own frame to that of the file that it is from: the columns of a 3 × 3 matrix, then the origin [m].
    pub place: [f32; 12],
    /// A hash of what its material or its light is.
    pub look: u64,
}

/// What of a thing is not as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Where it is, or how large.
    Moved,
    /// Its material or its light.
    Look,
}

impl Fingerprint {
    /// The fingerprint of a thing whose look this text says in full. The text must be the same on every machine.
    pub fn new(place: [f32; 12], look: &str) -> Self {
        let mut mixer = Mixer::default();
        mixer.add_bytes(look.as_bytes());
        Self { place, look: mixer.finish(look.len() as u64) }
    }

    /// What has changed since.
    pub fn change_to(&self, now: &Self) -> Option<Change> {
        let is_near = |(before, now): (&f32, &f32)| (before - now).abs() <= TOLERANCE * before.abs().max(1.0);
        if !self.place.iter().zip(&now.place).all(is_near) {
            return Some(Change::Moved);
        }
        (self.look != now.look).then_some(Change::Look)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 500.0, -2.0, 0.1];

    fn moved(axis: usize, by: f32) -> [f32; 12] {
        let mut place = PLACE;
        place[axis] += by;
        place
    }

    #[test]
    fn rounding_is_no_change_and_a_step_is_one() {
        let before = Fingerprint::new(PLACE, "red");
        for (axis, step, change) in [
            (11, 5e-5, None),
            (11, 2e-4, Some(Change::Moved)),
            (9, 0.04, None),
            (9, 0.06, Some(Change::Moved)),
            (0, -1e-3, Some(Change::Moved)),
            (11, f32::NAN, Some(Change::Moved)),
        ] {
            assert_eq!(before.change_to(&Fingerprint::new(moved(axis, step), "red")), change, "{axis} {step}");
        }
    }

    #[test]
    fn every_letter_of_a_look_counts() {
        let before = Fingerprint::new(PLACE, "red 0.5");
        for look in ["red 0.6", "Red 0.5", "red 0.5\0", "red 0.", ""] {
            assert_eq!(before.change_to(&Fingerprint::new(PLACE, look)), Some(Change::Look), "{look:?}");
        }
        assert_eq!(before.change_to(&Fingerprint::new(PLACE, "red 0.5")), None);
    }
}

//! The limit on an unwrap's work, and the switch that stops it.

use crate::bake::CancelToken;

/// Visits of triangles that a good unwrap may take, per triangle. Smooth meshes take 6 to 60 of them, at a million
/// triangles as at a thousand; of the bench's, the worst takes 1280 (a ball whose vertices are off by more than an edge
/// is long).
const VISITS_PER_TRIANGLE: u64 = 4000;

/// Work left to one connected part of a mesh, counted in visits of triangles, never in seconds.
pub(super) struct Work<'a> {
    left: u64,
    cancel: &'a CancelToken,
}

impl<'a> Work<'a> {
    pub(super) fn new(triangles: usize, cancel: &'a CancelToken) -> Self {
        Self { left: VISITS_PER_TRIANGLE * (triangles as u64 + 100), cancel }
    }

    /// Takes some of it; false once it is used up or the work is to stop.
    pub(super) fn takes(&mut self, visits: u64) -> bool {
        self.left = self.left.saturating_sub(visits);
        self.left > 0 && !self.cancel.is_cancelled()
    }

    /// The switch that stops it.
    pub(super) fn token(&self) -> &'a CancelToken {
        self.cancel
    }

    /// Whether some is left.
    pub(super) fn is_left(&self) -> bool {
        self.left > 0
    }

    /// Whether a person stopped it.
    pub(super) fn is_cancelled(&self) -> bool {
        self.cancel.is_cancelled()
    }
}

//! One hard case.

use crate::guard::Guard;

/// `Ok`, or a sentence that says what was seen instead.
pub type Verdict = Result<(), String>;

/// What cases have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// Where rays start, what they meet.
    Rays,
    /// Size and place of the world.
    Place,
    /// Where a receiver is, seen from a light.
    Distance,
    /// Shapes and placements of triangles.
    Triangles,
    /// Light that goes on and on.
    Energy,
    /// Lobes at their limits.
    Lobes,
    /// Pictures that come in and go out.
    Images,
    /// Random numbers.
    Samples,
}

impl Group {
    pub const ALL: [Self; 8] = [
        Self::Rays,
        Self::Place,
        Self::Distance,
        Self::Triangles,
        Self::Energy,
        Self::Lobes,
        Self::Images,
        Self::Samples,
    ];

    /// As it stands in a test's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rays => "rays",
            Self::Place => "place",
            Self::Distance => "distance",
            Self::Triangles => "triangles",
            Self::Energy => "energy",
            Self::Lobes => "lobes",
            Self::Images => "images",
            Self::Samples => "samples",
        }
    }

    /// As a heading.
    pub fn title(self) -> &'static str {
        match self {
            Self::Rays => "Rays and surfaces",
            Self::Place => "Scale and place",
            Self::Distance => "Distance and angle",
            Self::Triangles => "Triangles",
            Self::Energy => "Energy",
            Self::Lobes => "Lobes",
            Self::Images => "Images",
            Self::Samples => "Samples",
        }
    }
}

/// A hard case. Texts are parts of a table: short, without a full stop, no `|`.
pub struct Case {
    /// What it is about, as a test's name.
    pub name: &'static str,
    /// What makes it hard: the physics, or the arithmetic.
    pub hard: &'static str,
    /// What goes wrong in other bakers, or in the textbook's way.
    pub elsewhere: &'static str,
    /// What must hold here, with its tolerance and where that comes from: "within" counts four standard errors of what
    /// is measured in, "to" is of the number as it is.
    pub holds: &'static str,
    /// What in our code makes it hold.
    pub guard: &'static Guard,
    /// What happens without the guard.
    pub without: &'static str,
    /// The test.
    pub check: fn() -> Verdict,
}

impl Case {
    /// Its name as a test.
    pub fn full_name(&self, group: Group) -> String {
        format!("{}::{}", group.name(), self.name)
    }
}

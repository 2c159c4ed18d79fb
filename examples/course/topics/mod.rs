//! The course's topics, one function each.

mod convergence;
mod light;
mod paths;
mod surfaces;

use crate::Desk;

/// A topic.
pub struct Topic {
    /// The name by which a person asks for it.
    pub name: &'static str,
    /// Makes its pictures and numbers.
    pub run: fn(&Desk),
}

/// All topics, in the course's order.
pub const TOPICS: &[Topic] = &[
    Topic { name: "equation", run: light::equation },
    Topic { name: "sampling", run: paths::sampling },
    Topic { name: "frames", run: surfaces::frames },
    Topic { name: "materials", run: surfaces::materials },
    Topic { name: "caustic", run: surfaces::caustic },
    Topic { name: "direct", run: light::direct },
    Topic { name: "roulette", run: paths::roulette },
    Topic { name: "cornell", run: surfaces::cornell },
    Topic { name: "furnace", run: paths::furnace },
    Topic { name: "environment", run: light::environment },
    Topic { name: "convergence", run: convergence::convergence },
];

//! What is measured and where it is kept.

mod error;
mod lightmap;
mod progress;
mod report;
mod settings;
mod stub;
pub use stub::*;
mod atlas {
    pub(crate) const MAX_PAGE_SIZE: u32 = 8192;
}

pub use error::{BakeError, BakeWarning};
pub use lightmap::{Lightmap, Page, Placement};
pub use progress::{CancelToken, Progress, ProgressSink, Stage};
pub use report::{BakeReport, RelativeError};
pub use settings::{BakeSettings, Layout};

/// How many independently scrambled runs share the paths of each texel; their spread is its standard error.
pub const REPLICATES: u32 = 16;

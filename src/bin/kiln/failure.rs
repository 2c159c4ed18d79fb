//! Why the command did not do what it was asked, and the exit code that says so.

use bevy_kiln::bake::BakeError;
use std::process::ExitCode;

/// The exit code of a program that Ctrl-C has stopped.
pub(crate) const STOPPED: u8 = 130;

/// Why the command did not do what it was asked.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The arguments cannot be met.
    Arguments(String),
    /// It did not work out.
    Failed(String),
    /// Ctrl-C.
    Stopped,
}

impl Failure {
    pub(crate) fn failed(error: impl std::fmt::Display) -> Self {
        Self::Failed(error.to_string())
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Failed(_) => 1,
            Self::Arguments(_) => 2,
            Self::Stopped => STOPPED,
        })
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Arguments(reason) | Self::Failed(reason) => f.write_str(reason),
            Self::Stopped => f.write_str("stopped; nothing was written"),
        }
    }
}

impl From<BakeError> for Failure {
    fn from(error: BakeError) -> Self {
        match error {
            BakeError::Cancelled => Self::Stopped,
            BakeError::Settings { setting, reason } => Self::Arguments(format!("--{setting}: {reason}")),
            other => Self::failed(other),
        }
    }
}

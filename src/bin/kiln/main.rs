//! `kiln`: the plugin without a window. Reads arguments, opens the scene in an app without a GPU, writes files.
//! What it does lies in the library; here are words, numbers and exit codes.

mod args;
mod bake;
mod failure;
mod irradiance;
mod later;
mod parse;
mod plan;
mod points;
mod progress;
mod render;
mod scene;
mod study;
mod talk;

use args::{Cli, Verb};
use bevy_kiln::bake::CancelToken;
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let cancel = CancelToken::default();
    stop_on_ctrl_c(cancel.clone());
    let result = later::refuse(&cli.verb).and_then(|()| match &cli.verb {
        Verb::Bake(args) => bake::run(args, &cancel),
        Verb::Plan(args) => plan::run(args, &cancel),
        Verb::Irradiance(args) => irradiance::run(args, &cancel),
        Verb::Render(args) => render::run(args, &cancel),
        Verb::Study(args) => study::run(args, &cancel),
        Verb::Merge(_) => Ok(()),
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("kiln: {failure}");
            failure.exit_code()
        }
    }
}

/// The first Ctrl-C stops the work in good order, the second ends the program where it stands.
fn stop_on_ctrl_c(cancel: CancelToken) {
    let handler = move || {
        if cancel.is_cancelled() {
            std::process::exit(i32::from(failure::STOPPED));
        }
        cancel.cancel();
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        eprintln!("kiln: Ctrl-C will end the program at once ({error})");
    }
}

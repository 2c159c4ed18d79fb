//! The Cornell box, dark but for its lamp until it is baked: press B and look on.
//!
//! `cargo run --features cli,window --example cornell_box`. With `--screenshot FILE` it bakes, takes a picture of
//! its window and ends, for a run without a person. What it shows of the plugin is in `bake.rs` and `room.rs`; the
//! rest is a window, a camera and words on the screen.

mod args;
mod bake;
mod overlay;
mod room;
mod shoot;

use args::{Args, Call};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::window::WindowResolution;
use bevy_kiln::prelude::*;
use std::process::exit;

fn main() -> AppExit {
    let args = match Args::parse(std::env::args().skip(1)) {
        Ok(Call::Run(args)) => args,
        Ok(Call::Help) => {
            println!("{}", args::USAGE);
            return AppExit::Success;
        }
        Err(sentence) => {
            eprintln!("cornell_box: {sentence}\n\n{}", args::USAGE);
            exit(2);
        }
    };
    end_with_a_sentence();
    let engine = DefaultPlugins
        .set(AssetPlugin { file_path: asset_folder(), ..default() })
        .set(WindowPlugin { primary_window: Some(window(&args)), ..default() })
        // A picture must not be taken before everything is drawn.
        .set(RenderPlugin { synchronous_pipeline_compilation: args.screenshot.is_some(), ..default() });
    let mut app = App::new();
    app.add_plugins((engine, KilnPlugin, room::plugin, bake::plugin, overlay::plugin));
    if args.screenshot.is_some() {
        app.add_plugins(shoot::plugin);
    }
    app.insert_resource(args).run()
}

fn window(args: &Args) -> Window {
    let title = "bevy_kiln: Cornell box".to_owned();
    match args.screenshot {
        None => Window { title, resolution: WindowResolution::new(900, 900), ..default() },
        Some(_) => Window {
            title,
            // As many pixels as asked for, whatever the screen's scale.
            resolution: WindowResolution::new(args.size, args.size).with_scale_factor_override(1.0),
            resizable: false,
            ..default()
        },
    }
}

/// `cargo run` says where the package lies; started by itself, the program remembers where it was built.
fn asset_folder() -> String {
    let is_told = ["BEVY_ASSET_ROOT", "CARGO_MANIFEST_DIR"].iter().any(|name| std::env::var_os(name).is_some());
    if is_told { "assets" } else { concat!(env!("CARGO_MANIFEST_DIR"), "/assets") }.to_owned()
}

/// Bevy panics where there is no display or no graphics driver, and a panic on another thread leaves the app hanging.
fn end_with_a_sentence() {
    std::panic::set_hook(Box::new(|panic| {
        let reason = panic.payload_as_str().and_then(|text| text.lines().next()).unwrap_or("for no known reason");
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        eprintln!(
            "cornell_box: the engine stopped ({reason}; {place}). It needs a display (X11; xvfb-run makes one) and a \
             graphics driver (Vulkan; the package mesa-vulkan-drivers has one that needs no GPU)."
        );
        exit(1);
    }));
}

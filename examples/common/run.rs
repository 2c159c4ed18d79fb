//! The app: engine, window, plugin, and what is the same for every scene.

use super::args::{Args, Call, usage};
use super::stage::Stage;
use super::{bake, folder, overlay, room, shoot};
use bevy::asset::UnapprovedPathMode;
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::window::WindowResolution;
use bevy_kiln::prelude::*;
use std::process::exit;

/// Does what the command line asks for.
pub fn run(stage: Stage) -> AppExit {
    let args = match Args::parse(stage, std::env::args().skip(1)) {
        Ok(Call::Run(args)) => *args,
        Ok(Call::Help) => {
            println!("{}", usage(&stage));
            return AppExit::Success;
        }
        Err(sentence) => {
            eprintln!("{}: {sentence}\n\n{}", stage.name, usage(&stage));
            exit(2);
        }
    };
    end_with_a_sentence(stage.name);
    let engine = DefaultPlugins
        // A baked folder may lie anywhere.
        .set(AssetPlugin { file_path: asset_folder(), unapproved_path_mode: UnapprovedPathMode::Allow, ..default() })
        .set(WindowPlugin { primary_window: Some(window(&args)), ..default() })
        // A picture must not be taken before everything is drawn.
        .set(RenderPlugin { synchronous_pipeline_compilation: args.screenshot.is_some(), ..default() });
    let mut app = App::new();
    app.add_plugins((engine, KilnPlugin, room::plugin, bake::plugin, folder::plugin, overlay::plugin));
    app.add_plugins(stage.besides);
    if args.screenshot.is_some() {
        app.add_plugins(shoot::plugin);
    }
    app.insert_resource(args.filtering).insert_resource(args).run()
}

fn window(args: &Args) -> Window {
    let title = format!("bevy_kiln: {}", args.stage.name.replace('_', " "));
    let of = |[width, height]: [u32; 2]| WindowResolution::new(width, height);
    match args.screenshot {
        None => Window { title, resolution: of(args.stage.window), ..default() },
        Some(_) => Window {
            title,
            // As many pixels as asked for, whatever the screen's scale.
            resolution: of(args.size).with_scale_factor_override(1.0),
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
fn end_with_a_sentence(name: &'static str) {
    std::panic::set_hook(Box::new(move |panic| {
        let reason = panic.payload_as_str().and_then(|text| text.lines().next()).unwrap_or("for no known reason");
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        eprintln!(
            "{name}: the engine stopped ({reason}; {place}). It needs a display (X11; xvfb-run makes one) and a \
             graphics driver (Vulkan; the package mesa-vulkan-drivers has one that needs no GPU)."
        );
        exit(1);
    }));
}

//! What Bevy puts on a screen, against what the core says that it should be. Needs a renderer (Mesa's on the
//! processor will do) and a display (Xvfb will do); where there is none the tests say so and pass, but on the CI
//! machine (`CI=true`) they fail.
#![cfg(all(feature = "cli", feature = "window"))]

#[path = "../common/mod.rs"]
mod common;
mod compare;
mod example;
mod examples;
mod frames;
mod live;
mod mask;
mod overlay;
#[cfg(feature = "editor")]
mod panel;
mod parity;
mod picture;
mod pieces;
mod renderer;
mod truth;
mod volume;
mod window;
mod worn;

/// Ends a test that this machine cannot run.
fn skip(reason: &str) {
    assert!(std::env::var("CI").as_deref() != Ok("true"), "cannot run here, and CI must: {reason}");
    println!("skipped: {reason}");
}

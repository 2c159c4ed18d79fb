//! The room with one of everything that a glTF file can say.

use super::{last_json, run, text};
use std::collections::BTreeSet;

#[test]
fn a_room_with_one_of_everything_calls_for_every_effect_that_a_file_can() {
    let room = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes/room.glb");
    let output = run(&["plan", room, "--density", "2", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let json = last_json(&output);
    let effects = json["effects"].as_array().unwrap();
    let off = effects.iter().filter(|effect| effect["on"] == false);
    let off: BTreeSet<&str> = off.map(|effect| effect["effect"].as_str().unwrap()).collect();
    // A sky is for the command line to give, and translucent leaves are what Bevy's loader does not read.
    assert_eq!(off, BTreeSet::from(["constant-sky", "diffuse-transmission", "environment-map"]));
    // glTF has no size for lights, and the room has a ball of glass.
    let warnings: Vec<&str> = json["warnings"].as_array().unwrap().iter().filter_map(|line| line.as_str()).collect();
    assert!(warnings.len() == 1 && warnings[0].starts_with("lights without a size (3)"), "{warnings:?}");
}

//! Walls that meet at narrow angles, without thickness: what is dark behind them stays dark.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::rays::NO_CONSTANT;
use crate::judge::{all_dark, light_at};
use crate::things::bulb;
use crate::worlds::{askew, askew_aside, dark_box, joined, leaning, near_narrow_edges, points_under, renamed, under};
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::Light;
use glam::{Affine3A, Vec3};

const TEN_MILLIMETRES: &str = "a bias of 10 mm starts rays behind the next wall";

pub const CASES: &[Case] = &[
    Case {
        name: "a_closed_box_in_a_bright_sky",
        hard: "a sky of 1e6 cd/m² around white walls that lean; points 1 mm from edges of 40°",
        elsewhere: "leaks at edges and corners are the first of all complaints (Godot 51638 and others)",
        holds: "E = 0 exactly, which is below 1e-6 of outside",
        guard: &NO_CONSTANT,
        without: "rays start outside of the box, which is bright",
        check: in_a_bright_sky,
    },
    Case {
        name: "interpenetrating_boxes",
        hard: "two black boxes that lean, through each other, under a sky, with points 1 mm from edges of 40°",
        elsewhere: TEN_MILLIMETRES,
        holds: "E = 0 exactly at 10 points",
        guard: &NO_CONSTANT,
        without: "rays start outside of the boxes",
        check: interpenetrating,
    },
    Case {
        name: "a_leaning_sheet_between_light_and_dark",
        hard: "a floor 1 mm from where a sheet without thickness meets it at 45°",
        elsewhere: "a bias of 10 mm starts rays beyond the sheet",
        holds: "E = 0 exactly on the dark side",
        guard: &NO_CONSTANT,
        without: "light comes through the sheet",
        check: leaning_sheet,
    },
];

fn in_a_bright_sky() -> Verdict {
    all_dark(&light_at(&under(dark_box(0.9, 1e6), leaning()), &near_narrow_edges(), 1 << 8)?)
}

fn interpenetrating() -> Verdict {
    let through = Affine3A::from_rotation_translation(askew(), Vec3::new(0.7, 0.6, 0.5));
    let scene = joined(dark_box(0.0, 1.0), renamed(under(dark_box(0.0, 1.0), through), "second"));
    all_dark(&light_at(&under(scene, leaning()), &near_narrow_edges(), 1 << 10)?)
}

/// A sheet that leans against a wall parts a black box; a lamp is on the one side.
fn leaning_sheet() -> Verdict {
    let sheet = [Vec3::new(1.5, 1.5, 0.0), Vec3::Z * 4.0];
    let mut scene = SceneBuilder::default()
        .room(Vec3::NEG_ONE, Vec3::ONE, [0.0; 6].map(grey))
        .quad("sheet", Vec3::new(-0.5, -1.0, -2.0), [sheet[0] * 2.0, sheet[1]], grey(0.0))
        .build();
    scene.lights.push(Light::Point(bulb(Vec3::new(-0.6, 0.5, 0.0), 0.0)));
    let points: Vec<MeterPoint> = [-0.8, -0.2, 0.1, 0.7].map(|z| at(Vec3::new(-0.499, -1.0, z), Vec3::Y)).to_vec();
    all_dark(&light_at(&under(scene, askew_aside()), &points_under(&points, askew_aside()), 64)?)
}

//! Light that nothing absorbs: what has no steady state is refused, what leaves in the end is not.

use super::CUT;
use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, furnace, grey, lit_room};
use crate::guards::bake::ENDLESS_REFUSED;
use crate::guards::path::{LENGTH_BOUND, NO_BEST_CHANCE};
use crate::judge::{all_read, ensure, light_at};
use crate::things::of;
use bevy_kiln::bake::{
    BakeSettings, BakeWarning, CancelToken, Goal, MeterPoint, MeterSettings, PictureSettings, bake_lightmap,
    measure_irradiance, render_picture,
};
use bevy_kiln::scene::{Camera, Scattering, Scene};
use bevy_kiln::trace::Transport;
use glam::Vec3;
use std::f64::consts::PI;

const FOR_EVER: &str = "nothing absorbs and nothing leaves: light has no steady state";
const HANGS: &str = "paths that never end, or a number that only the cap on bounces decided";
const REFUSED: &str = "refused, with the material's name and what to do";
const NOT_REFUSED: &str = "paths go on to the bound and the bake ends with a number that means nothing";
const BRINGS_1: &str = "under a sky of radiance 1 every path brings 1: E = π to 1e-5, as f32 rounds";

pub const CASES: &[Case] = &[
    Case {
        name: "a_white_closed_room_is_not_measured",
        hard: FOR_EVER,
        elsewhere: HANGS,
        holds: REFUSED,
        guard: &ENDLESS_REFUSED,
        without: NOT_REFUSED,
        check: || refused(measured(&furnace(1.0), at(Vec3::ZERO, Vec3::Y))),
    },
    Case {
        name: "a_white_closed_room_is_not_baked",
        hard: FOR_EVER,
        elsewhere: HANGS,
        holds: REFUSED,
        guard: &ENDLESS_REFUSED,
        without: NOT_REFUSED,
        check: || {
            let settings = BakeSettings { goal: Goal::Samples(16), density: 0.5, ..BakeSettings::default() };
            let baked = bake_lightmap(&furnace(1.0), &settings, &(), &CancelToken::default());
            refused(baked.map(|_| ()).map_err(|error| error.to_string()))
        },
    },
    Case {
        name: "a_white_closed_room_gives_no_picture",
        hard: FOR_EVER,
        elsewhere: HANGS,
        holds: REFUSED,
        guard: &ENDLESS_REFUSED,
        without: NOT_REFUSED,
        check: || {
            let camera = Camera::look_at("eye", Vec3::ZERO, Vec3::X, 1.0);
            let transport = Transport::default();
            let settings = PictureSettings { transport, width: 2, height: 2, samples_per_pixel: 16, threads: None };
            let picture = render_picture(&furnace(1.0), &camera, &settings, &(), &CancelToken::default());
            refused(picture.map(|_| ()).map_err(|error| error.to_string()))
        },
    },
    Case {
        name: "an_albedo_next_to_1",
        hard: "ρ = 1 − 2⁻²⁴, the last number before 1: half a billion bounces",
        elsewhere: HANGS,
        holds: REFUSED,
        guard: &ENDLESS_REFUSED,
        without: NOT_REFUSED,
        check: || refused(measured(&furnace(1.0_f32.next_down()), at(Vec3::ZERO, Vec3::Y))),
    },
    Case {
        name: "white_in_one_channel",
        hard: "red is never absorbed, green and blue soon are",
        elsewhere: "a test by luminance, or by the mean albedo, sees nothing",
        holds: REFUSED,
        guard: &ENDLESS_REFUSED,
        without: NOT_REFUSED,
        check: || {
            let mut scene = furnace(0.5);
            scene.materials.iter_mut().for_each(|material| material.base_colour.x = 1.0);
            refused(measured(&scene, at(Vec3::ZERO, Vec3::Y)))
        },
    },
    Case {
        name: "a_room_of_white_mirrors",
        hard: "perfect mirrors on all sides around a lamp: no diffuse surface tells that the room is white",
        elsewhere: HANGS,
        holds: REFUSED,
        guard: &ENDLESS_REFUSED,
        without: NOT_REFUSED,
        check: || {
            let mut scene = lit_room(0.5, 1.0);
            scene.materials.iter_mut().for_each(|material| *material = of(Scattering::Mirror));
            refused(measured(&scene, at(Vec3::ONE, Vec3::Y)))
        },
    },
    Case {
        name: "a_lamp_in_a_white_box_in_the_open",
        hard: "the scene is open, but a pocket in it keeps what its lamp gives",
        elsewhere: HANGS,
        holds: REFUSED,
        guard: &ENDLESS_REFUSED,
        without: "the bake does not say that the lamp's light never ends",
        check: || {
            let mut scene = lit_room(1.0, 1.0);
            scene.sky_radiance = Vec3::ONE;
            refused(measured(&scene, at(Vec3::new(2.0, 10.0, 2.0), Vec3::Y)))
        },
    },
    Case {
        name: "a_pocket_that_no_probe_meets",
        hard: "one of 200 points lies in a white box without light: its paths meet nothing that ends them",
        elsewhere: HANGS,
        holds: "all others read π to 1e-5, as f32 rounds; there it is dark, and the 16 paths that were cut are \
                reported",
        guard: &LENGTH_BOUND,
        without: "the measurement never ends",
        check: pocket,
    },
    Case {
        name: "a_white_open_room",
        hard: "a white room without a ceiling: paths end by leaving alone",
        elsewhere: "a best chance of survival below 1 makes noise of what has none",
        holds: BRINGS_1,
        guard: &NO_BEST_CHANCE,
        without: "paths that carry all they ever did are ended, the rest weigh more",
        check: || white_room_with_a_hole(2.0),
    },
    Case {
        name: "a_white_room_with_a_small_hole",
        hard: "all light comes through a hole of 10 cm in a white room of 24 m²: 2400 bounces on the way",
        elsewhere: CUT,
        holds: BRINGS_1,
        guard: &NO_BEST_CHANCE,
        without: "next to no path gets out, with the light of all others",
        check: || white_room_with_a_hole(0.1),
    },
];

/// What comes of a measurement.
fn measured(scene: &Scene, point: MeterPoint) -> Verdict {
    let settings = MeterSettings { samples_per_point: 16, ..MeterSettings::default() };
    let measured = measure_irradiance(scene, &[point], &settings, &(), &CancelToken::default());
    measured.map(|_| ()).map_err(|error| error.to_string())
}

/// Whether a result is the refusal of light without end, which names a material.
fn refused(result: Verdict) -> Verdict {
    match result {
        Err(error)
            if error.starts_with("light goes on for more than 65536 surfaces") && error.contains("material \"") =>
        {
            Ok(())
        }
        Err(error) => Err(format!("refused, but: {error}")),
        Ok(()) => Err("not refused".into()),
    }
}

fn pocket() -> Verdict {
    let scene = SceneBuilder::default().room(Vec3::ZERO, Vec3::ONE, [1.0; 6].map(grey)).sky(Vec3::ONE).build();
    let mut points: Vec<MeterPoint> = (0..200).map(|i| at(Vec3::new(i as f32, 5.0, 0.0), Vec3::Y)).collect();
    points[1] = at(Vec3::splat(0.5), Vec3::Y);
    let settings = MeterSettings { samples_per_point: 16, ..MeterSettings::default() };
    let measured = measure_irradiance(&scene, &points, &settings, &(), &CancelToken::default());
    let measured = measured.map_err(|error| error.to_string())?;
    ensure(measured.report.warnings == [BakeWarning::Endless { paths: 16, surfaces: 65536 }], || {
        format!("{:?}", measured.report.warnings)
    })?;
    ensure(measured.readings[1].irradiance.length() == 0.0, || "light in the box".into())?;
    let others: Vec<_> = measured.readings.iter().enumerate().filter(|(i, _)| *i != 1).map(|(_, r)| *r).collect();
    all_read(&others, PI, 1e-5)
}

/// A white cube of side 2 whose ceiling has a square hole of this side, under a sky of radiance 1.
fn white_room_with_a_hole(hole: f32) -> Verdict {
    let white = || grey(1.0);
    let mut builder = SceneBuilder::default();
    builder = builder
        .quad("-x", Vec3::NEG_ONE, [2.0 * Vec3::Y, 2.0 * Vec3::Z], white())
        .quad("+x", Vec3::new(1.0, -1.0, -1.0), [2.0 * Vec3::Z, 2.0 * Vec3::Y], white())
        .quad("-y", Vec3::NEG_ONE, [2.0 * Vec3::Z, 2.0 * Vec3::X], white())
        .quad("-z", Vec3::NEG_ONE, [2.0 * Vec3::X, 2.0 * Vec3::Y], white())
        .quad("+z", Vec3::new(-1.0, -1.0, 1.0), [2.0 * Vec3::Y, 2.0 * Vec3::X], white());
    let half = 0.5 * hole;
    if half < 1.0 {
        let piece = |builder: SceneBuilder, name: &str, x: [f32; 2], z: [f32; 2]| {
            let edges = [Vec3::X * (x[1] - x[0]), Vec3::Z * (z[1] - z[0])];
            builder.quad(name, Vec3::new(x[0], 1.0, z[0]), edges, white())
        };
        builder = piece(builder, "west", [-1.0, -half], [-1.0, 1.0]);
        builder = piece(builder, "east", [half, 1.0], [-1.0, 1.0]);
        builder = piece(builder, "north", [-half, half], [-1.0, -half]);
        builder = piece(builder, "south", [-half, half], [half, 1.0]);
    }
    let scene = builder.sky(Vec3::ONE).build();
    let points = [at(Vec3::new(0.3, -1.0, 0.2), Vec3::Y), at(Vec3::new(-1.0, 0.5, 0.1), Vec3::X)];
    all_read(&light_at(&scene, &points, 128)?, PI, 1e-5)
}

//! Light that goes on and on: what is given off must be absorbed, however long the paths.

use crate::case::{Case, Verdict};
use crate::common::glb;
use crate::common::meter::{at, on_walls};
use crate::common::scenes::{SceneBuilder, furnace, glowing, grey, lit_room};
use crate::guards::bake::{ENDLESS_REFUSED, SUM_IN_F64};
use crate::guards::bsdf::{INDEX_TURNED, MORE_THAN_ONE_FACET, WHAT_THE_COAT_LEAVES};
use crate::guards::path::{
    CAP, LENGTH_BOUND, NO_BEST_CHANCE, NUMBER_DEALT_ANEW, SURVIVAL_AT_MOST_ONE, SURVIVORS_STAND_IN, WEIGHTS,
};
use crate::judge::{all_read, baked, ensure, light_at, light_by, mean_reads, reads};
use crate::things::{
    fresnel, furnace_of_one, glass, integrate, level, metal, of, room_of_radiance_one, sees, sphere, standard, with_box,
};
use bevy_kiln::bake::{
    BakeSettings, BakeWarning, CancelToken, MeterPoint, MeterSettings, PictureSettings, bake_lightmap,
    measure_irradiance, render_picture,
};
use bevy_kiln::scene::{
    Camera, Filter, Material, Scattering, Scene, Standard, Texels, Texture, TextureRef, UvChannel, Wrap,
};
use bevy_kiln::trace::{Estimator, Transport};
use glam::Vec3;
use std::f64::consts::PI;

const SERIES: &str = "the light is a series Σ ρⁿ, whose tail is the longer the whiter the walls";
const CUT: &str = "a cap on bounces (Godot 5 to 16, Unity 2 to 100) cuts the tail off";
const FOR_EVER: &str = "nothing absorbs and nothing leaves: light has no steady state";
const HANGS: &str = "paths that never end, or a number that only the cap on bounces decided";
const REFUSED: &str = "refused, with the material's name and what to do";
const NOT_REFUSED: &str = "paths go on to the bound and the bake ends with a number that means nothing";
const LOSES: &str = "a lobe that loses a few per cent at each bounce darkens a room by a multiple of that";

pub const CASES: &[Case] = &[
    Case {
        name: "albedo_0",
        hard: "nothing is scattered: every path but the first segment carries nothing",
        elsewhere: "0 / 0 in roulette",
        holds: "E = π within 0.3 %",
        guard: &WEIGHTS,
        without: "light that both samples find counts twice",
        check: || furnace_reads(0.0, 1 << 14, 3e-3),
    },
    Case {
        name: "albedo_0_5",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 0.3 %",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: "a path is divided by a chance above 1, E is too low",
        check: || furnace_reads(0.5, 1 << 12, 3e-3),
    },
    Case {
        name: "albedo_0_9",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 0.3 %",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost, E is too low",
        check: || furnace_reads(0.9, 1 << 11, 3e-3),
    },
    Case {
        name: "albedo_0_99",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 1 %, in 504 rays a path",
        guard: &NO_BEST_CHANCE,
        without: "weights grow as (1/q)ⁿ: the variance has no end",
        check: || furnace_reads(0.99, 1 << 8, 1e-2),
    },
    Case {
        name: "albedo_0_999",
        hard: SERIES,
        elsewhere: CUT,
        holds: "E = π/(1 − ρ) within 1 %; the cost, seen by surface samples, is ln(0.15)/ln ρ + 1/(1 − ρ) = 2896 rays a \
                path, of which the first 1896 live on for sure",
        guard: &NO_BEST_CHANCE,
        without: "weights grow as (1/q)ⁿ: the variance has no end",
        check: albedo_0_999,
    },
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
            let settings = BakeSettings { samples_per_texel: 16, density: 0.5, ..BakeSettings::default() };
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
        holds: "all others read π; there it is dark, and the 16 paths that were cut are reported",
        guard: &LENGTH_BOUND,
        without: "the measurement never ends",
        check: pocket,
    },
    Case {
        name: "a_white_open_room",
        hard: "a white room without a ceiling: paths end by leaving alone",
        elsewhere: "a best chance of survival below 1 makes noise of what has none",
        holds: "under a sky of radiance 1 every path brings 1: E = π within 1e-5",
        guard: &NO_BEST_CHANCE,
        without: "paths that carry all they ever did are ended, the rest weigh more",
        check: || white_room_with_a_hole(2.0),
    },
    Case {
        name: "a_white_room_with_a_small_hole",
        hard: "all light comes through a hole of 10 cm in a white room of 24 m²: 2400 bounces on the way",
        elsewhere: CUT,
        holds: "under a sky of radiance 1 every path brings 1: E = π within 1e-5",
        guard: &NO_BEST_CHANCE,
        without: "next to no path gets out, with the light of all others",
        check: || white_room_with_a_hole(0.1),
    },
    Case {
        name: "pictures_and_mirrors_on_the_walls",
        hard: "albedos from 0.05 to 0.95 that change with place and channel, and two mirrors between",
        elsewhere: "an average albedo for a wall, or mirrors that bounces do not see",
        holds: "Le(x) = 1 − ρ(x) gives radiance 1 everywhere (Szirmay-Kalos 2001): E = π within 0.5 %",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: "a path is divided by a chance above 1, E is too low",
        check: pictures_and_mirrors,
    },
    Case {
        name: "coloured_walls",
        hard: "paths that carry 0.95 of red carry 0.05 of blue: roulette knows one number for three",
        elsewhere: "roulette by luminance, which makes blue noise of what red could bear",
        holds: "Le = 1 − ρ per channel gives radiance 1: E = π within 0.5 % in each channel",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost, E is too low",
        check: coloured_walls,
    },
    Case {
        name: "mirrors_on_five_sides",
        hard: "light that no light sample finds, after dozens of reflections",
        elsewhere: "mirrors reflect only what a probe saw",
        holds: "one glowing wall is seen in every direction: E = π within 0.3 %",
        guard: &WEIGHTS,
        without: "light in mirrors is weighted as if light samples found it too",
        check: mirrors_on_five_sides,
    },
    Case {
        name: "glass_in_a_furnace",
        hard: "a body of smooth glass that takes up half of the room: radiance goes by the index squared inside",
        elsewhere: "glass that light does not pass, or that is a grey filter",
        holds: "what loses no light cannot be seen in a furnace: E = π within 0.3 %",
        guard: &INDEX_TURNED,
        without: "light is squeezed twice by n² and not let go: E is too low",
        check: || vanishes(&glass(1.5, 0.0)),
    },
    Case {
        name: "white_metal_of_roughness_0_3",
        hard: "a facet's light meets another facet: 0.7 % of it along the normal, 8 % at 80°",
        elsewhere: LOSES,
        holds: "three walls of it, three that glow: E = π within 0.3 %",
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: || metal_walls(0.3, 1 << 12),
    },
    Case {
        name: "white_metal_of_roughness_0_6",
        hard: "a facet's light meets another facet: 18 % of it along the normal",
        elsewhere: LOSES,
        holds: "three walls of it, three that glow: E = π within 0.3 %",
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: || metal_walls(0.6, 1 << 14),
    },
    Case {
        name: "white_metal_of_roughness_1",
        hard: "a facet's light meets another facet: 69 % of it along the normal",
        elsewhere: LOSES,
        holds: "three walls of it, three that glow: E = π within 0.3 %",
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: || metal_walls(1.0, 1 << 15),
    },
    Case {
        name: "rough_glass_in_a_furnace",
        hard: "facets of glass send light to other facets, from both sides",
        elsewhere: LOSES,
        holds: "E = π within 0.5 % around glass of roughness 0.6: the tables' own last digit",
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost",
        check: rough_glass,
    },
    Case {
        name: "white_plastic",
        hard: "a coat and a base that share what arrives: more than all, if the base does not know of the coat",
        elsewhere: "coat plus base: an albedo up to 1.04, and light that grows from bounce to bounce",
        holds: "under a white sky it shows its albedo in the table (docs/albedo.md), 1 within 0.2 %, at 0°, 60° and 80°",
        guard: &WHAT_THE_COAT_LEAVES,
        without: "it shows more than the sky",
        check: || shows(standard(Standard::default()), [1.0, 1.0, 1.0]),
    },
    Case {
        name: "a_clear_coat_over_white",
        hard: "two coats over a base: the upper one hides a part of the lower ones both ways",
        elsewhere: "coat plus base: an albedo above 1 at grazing angles",
        holds: "under a white sky it shows its albedo in the table (docs/albedo.md), within 0.2 %, at 0°, 60° and 80°",
        guard: &WHAT_THE_COAT_LEAVES,
        without: "it shows more than the sky",
        check: || {
            let coat = Standard { reflectance: 0.0, clearcoat: 1.0, ..Standard::default() };
            shows(standard(coat), [0.983, 0.991, 0.999])
        },
    },
    Case {
        name: "a_path_that_carries_more_than_1",
        hard: "a path that leaves a pool of glass carries n² = 2.25 times what it did, and more after reflections",
        elsewhere: "a chance of survival above 1, by which light is lost",
        holds: "in equilibrium L/n² is the same everywhere: E = n²·π at the pool's floor, within 0.5 %",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: "paths are divided by chances of up to 15, E is too low",
        check: pool,
    },
    Case {
        name: "twenty_panes",
        hard: "light between 20 panes goes up and down some thirty times",
        elsewhere: "a product of transmittances, which forgets what is reflected back down: half of the light",
        holds: "Stokes' stack (1862): T = (1 − r)/(1 + 19 r) at each angle, over a white sky within 2 %",
        guard: &NUMBER_DEALT_ANEW,
        without: "what passed the first pane passes all",
        check: || stack(StackOf::Panes),
    },
    Case {
        name: "twenty_slabs_of_glass",
        hard: "40 interfaces, each of which bends, reflects and may hold light back",
        elsewhere: CUT,
        holds: "Stokes' stack (1862): T = (1 − R)/(1 + 39 R) by Fresnel's R, over a white sky within 2 %",
        guard: &INDEX_TURNED,
        without: "light is squeezed by n² forty times over",
        check: || stack(StackOf::Slabs),
    },
    Case {
        name: "two_million_samples_do_not_drift",
        hard: "adding 0.1 to a sum of 13 000 rounds by up to 0.5 % of what is added, the same way every time",
        elsewhere: "accumulators of f32, or of half floats (Godot)",
        holds: "E = π·L within 1e-9, all that n · 2⁻⁵³ leaves",
        guard: &SUM_IN_F64,
        without: "the sum drifts",
        check: two_million_samples,
    },
    Case {
        name: "balance_of_a_white_room",
        hard: "a lamp's light is absorbed after twenty bounces on average",
        elsewhere: CUT,
        holds: "absorbed over emitted flux is 1 within 1 %, ρ = 0.95",
        guard: &SURVIVAL_AT_MOST_ONE,
        without: "light is lost on the way",
        check: || balances(&lit_room(0.95, 10.0), 0.5, 1e-2),
    },
    Case {
        name: "balance_of_the_cornell_box_closed",
        hard: "coloured walls and blocks, the box's front closed by a wall of albedo ½",
        elsewhere: CUT,
        holds: "absorbed over emitted flux is 1 within 1 %",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost",
        check: || balances(&cornell_closed(), 1.0, 1e-2),
    },
    Case {
        name: "balance_of_spheres_in_each_other",
        hard: "4096 triangles without a lightmap around a glowing sphere: both sides of all are points spread by area",
        elsewhere: "a balance of what has texels alone",
        holds: "absorbed over emitted flux is 1 within 2 %, ρ = 0.8",
        guard: &SURVIVORS_STAND_IN,
        without: "what roulette ends is lost",
        check: || balances(&spheres(), 1.0, 2e-2),
    },
    Case {
        name: "a_cap_loses_what_it_should",
        hard: "a person may ask for a cap; it must lose the tail of the series, and no more",
        elsewhere: "off by one bounce, or roulette that ends paths before the cap",
        holds: "E = π(1 − ρ⁵)/(1 − ρ) for 4 bounces, ρ = 0.8, within 0.3 %",
        guard: &CAP,
        without: "a bounce too many",
        check: cap,
    },
];

fn furnace_reads(albedo: f32, samples: u32, tolerance: f64) -> Verdict {
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    mean_reads(&light_at(&furnace(albedo), &points, samples)?, PI / (1.0 - f64::from(albedo)), tolerance)
}

fn albedo_0_999() -> Verdict {
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    let transport = Transport { estimator: Estimator::Bsdf, ..Transport::default() };
    let settings = MeterSettings { transport, samples_per_point: 176, threads: None };
    let measured = measure_irradiance(&furnace(0.999), &points, &settings, &(), &CancelToken::default());
    let measured = measured.map_err(|error| error.to_string())?;
    mean_reads(&measured.readings, PI / (1.0 - f64::from(0.999_f32)), 1e-2)?;
    let cost = measured.report.rays as f64 / measured.report.samples as f64;
    ensure((2800.0..3000.0).contains(&cost), || format!("{cost} rays a path"))
}

fn measured(scene: &Scene, point: MeterPoint) -> Verdict {
    let settings = MeterSettings { samples_per_point: 16, ..MeterSettings::default() };
    let measured = measure_irradiance(scene, &[point], &settings, &(), &CancelToken::default());
    measured.map(|_| ()).map_err(|error| error.to_string())
}

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
    let white = || grey(1.0);
    let mut scene = SceneBuilder::default()
        .room(Vec3::ZERO, Vec3::ONE, [white(), white(), white(), white(), white(), white()])
        .build();
    scene.sky_radiance = Vec3::ONE;
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

fn picture(texels: Vec<[f32; 4]>) -> Texture {
    Texture {
        name: "picture".into(),
        width: 4,
        height: 4,
        texels: Texels::Float(texels.into()),
        wrap: [Wrap::Clamp; 2],
        filter: Filter::Linear,
    }
}

fn pictures_and_mirrors() -> Verdict {
    let colour = |i: usize| {
        let value = 0.05 + 0.9 * ((i * 7) % 16) as f32 / 15.0;
        [value, value * 0.5, 1.0 - value, 1.0]
    };
    let mut scene = furnace(1.0);
    scene.textures =
        vec![picture((0..16).map(colour).collect()), picture((0..16).map(|i| colour(i).map(|c| 1.0 - c)).collect())];
    for material in &mut scene.materials {
        material.base_colour_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
        material.emission_texture = Some(TextureRef { texture: 1, uv: UvChannel::Uv1 });
    }
    scene.materials[0].scattering = Scattering::Mirror;
    scene.materials[3].scattering = Scattering::Mirror;
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    mean_reads(&light_at(&scene, &points, 1 << 11)?, PI, 5e-3)
}

fn coloured_walls() -> Verdict {
    let wall = |albedo: Vec3| Material { emitted_radiance: 1.0 - albedo, ..Material::diffuse("wall", albedo) };
    let (red, green) = (Vec3::new(0.95, 0.3, 0.05), Vec3::new(0.1, 0.9, 0.2));
    let sides = [wall(red), wall(green), wall(red), wall(red), wall(green), wall(red)];
    let scene = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, sides).build();
    furnace_of_one(&scene, 1 << 13, 5e-3)
}

fn mirrors_on_five_sides() -> Verdict {
    let mirror = || of(Scattering::Mirror);
    let sides = [mirror(), mirror(), mirror(), glowing(0.0, 1.0), mirror(), mirror()];
    let scene = SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, sides).build();
    let points = [Vec3::X, Vec3::Y, Vec3::NEG_Y].map(|normal| at(Vec3::new(0.1, 0.2, -0.3), normal));
    all_read(&light_at(&scene, &points, 1 << 14)?, PI, 3e-3)
}

fn vanishes(material: &Material) -> Verdict {
    let body = [Vec3::new(-0.8, -0.6, -0.7), Vec3::new(0.7, 0.8, 0.8)];
    let scene = with_box(room_of_radiance_one(), "thing", body, material).build();
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

fn rough_glass() -> Verdict {
    let body = [Vec3::new(-0.8, -0.6, -0.7), Vec3::new(0.7, 0.8, 0.8)];
    let scene = with_box(room_of_radiance_one(), "thing", body, &glass(1.5, 0.6)).build();
    furnace_of_one(&scene, 1 << 14, 5e-3)
}

fn metal_walls(roughness: f32, samples: u32) -> Verdict {
    let (white, lit) = (|| metal(roughness), || glowing(0.5, 0.5));
    let scene = SceneBuilder::default()
        .room(Vec3::NEG_ONE, Vec3::ONE, [white(), lit(), lit(), white(), white(), lit()])
        .build();
    furnace_of_one(&scene, samples, 3e-3)
}

/// What a flat surface shows at 0°, 60° and 80° under a white sky: by reciprocity, its albedo.
fn shows(material: Material, albedos: [f64; 3]) -> Verdict {
    let scene = level(SceneBuilder::default(), "plate", 0.0, [10.0, 1.0], material).sky(Vec3::ONE).build();
    for (degrees, albedo) in [0.0_f32, 60.0, 80.0].into_iter().zip(albedos) {
        let (sin, cos) = degrees.to_radians().sin_cos();
        sees(&scene, [Vec3::new(sin, cos, 0.0), Vec3::ZERO], 1 << 16, albedo, 2e-3)
            .map_err(|error| format!("{degrees}°: {error}"))?;
    }
    Ok(())
}

fn pool() -> Verdict {
    let [air, water] = [1.0, 2.25].map(|radiance: f32| move || glowing(0.5, 0.5 * radiance));
    let mut builder = SceneBuilder::default();
    for (name, low, wall) in [("pool", -1.0, true), ("air", 0.0, false)] {
        let material = || if wall { water() } else { air() };
        let corner = Vec3::new(-1.0, low, -1.0);
        let [x, y, z] = [2.0 * Vec3::X, Vec3::Y, 2.0 * Vec3::Z];
        for (side, start, edges) in
            [("-x", corner, [y, z]), ("+x", corner + x, [z, y]), ("-z", corner, [x, y]), ("+z", corner + z, [y, x])]
        {
            builder = builder.quad(&format!("{name} {side}"), start, edges, material());
        }
    }
    builder = level(builder, "floor", -1.0, [1.0, 1.0], water());
    builder = level(builder, "ceiling", 1.0, [1.0, -1.0], air());
    let scene = level(builder, "water", 0.0, [1.0, 1.0], of(Scattering::Refraction { ior: 1.5 })).build();
    let readings = light_at(
        &scene,
        &[at(Vec3::new(0.2, -1.0, 0.1), Vec3::Y), at(Vec3::new(0.2, 1.0, 0.1), Vec3::NEG_Y)],
        1 << 16,
    )?;
    reads(&readings[0], 2.25 * PI, 5e-3)?;
    reads(&readings[1], PI, 5e-3)
}

/// What a stack is made of.
#[derive(Clone, Copy, PartialEq)]
enum StackOf {
    Panes,
    Slabs,
}

fn stack(of_what: StackOf) -> Verdict {
    let pane = || standard(Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, ..Standard::default() });
    let mut builder = level(SceneBuilder::default(), "ground", -0.1, [2000.0, 1.0], grey(0.0));
    for number in 0..20 {
        let height = 0.1 * number as f32;
        if of_what == StackOf::Panes {
            builder = level(builder, &format!("pane {number}"), height, [2000.0, 1.0], pane());
        } else {
            let interface = || of(Scattering::Refraction { ior: 1.5 });
            builder = level(builder, &format!("top {number}"), height + 0.05, [2000.0, 1.0], interface());
            builder = level(builder, &format!("bottom {number}"), height, [2000.0, -1.0], interface());
        }
    }
    let transmitted = |cosine: f64| match of_what {
        StackOf::Panes => {
            let r = 0.04 + 0.96 * (1.0 - cosine).powi(5);
            (1.0 - r) / (1.0 + 19.0 * r)
        }
        StackOf::Slabs => {
            let r = fresnel(cosine, 1.5);
            (1.0 - r) / (1.0 + 39.0 * r)
        }
    };
    let truth = PI * integrate(|cosine| 2.0 * cosine * transmitted(cosine));
    let scene = builder.sky(Vec3::ONE).build();
    let points: Vec<MeterPoint> = (0..4).map(|i| at(Vec3::new(i as f32, -0.1, 0.3), Vec3::Y)).collect();
    mean_reads(&light_at(&scene, &points, 1 << 16)?, truth, 2e-2)
}

fn two_million_samples() -> Verdict {
    let scene = level(SceneBuilder::default(), "ground", 0.0, [1.0, 1.0], grey(0.0)).sky(Vec3::splat(0.1)).build();
    let points = [0.0, 0.5].map(|x| at(Vec3::new(x, 0.0, 0.0), Vec3::Y));
    all_read(&light_at(&scene, &points, 1 << 21)?, PI * f64::from(0.1_f32), 1e-9)
}

fn balances(scene: &Scene, density: f32, tolerance: f64) -> Verdict {
    let settings = BakeSettings { samples_per_texel: 256, density, ..BakeSettings::default() };
    let balance = baked(scene, &settings)?.report.energy_balance;
    ensure(balance.is_some_and(|balance| (balance - 1.0).abs() <= tolerance), || {
        format!("absorbed over emitted flux: {balance:?}")
    })
}

fn cornell_closed() -> Scene {
    let mut scene = glb::load("cornell");
    let positions = || scene.meshes.iter().flat_map(|mesh| mesh.positions.iter().copied());
    let low = positions().fold(Vec3::INFINITY, Vec3::min);
    let high = positions().fold(Vec3::NEG_INFINITY, Vec3::max);
    let size = high - low;
    // A box around all, against which the open front looks; the gap between is part of the closed scene.
    let shell = SceneBuilder::default().room(low - 0.01 * size, high + 0.01 * size, [0; 6].map(|_| grey(0.5))).build();
    let (meshes, materials) = (scene.meshes.len(), scene.materials.len());
    scene.instances.extend(shell.instances.into_iter().map(|mut instance| {
        instance.mesh += meshes;
        instance.material += materials;
        instance.lightmap = None;
        instance
    }));
    scene.meshes.extend(shell.meshes);
    scene.materials.extend(shell.materials);
    scene
}

fn spheres() -> Scene {
    let (inner, outer) = (sphere(Vec3::ZERO, 0.25, 3), sphere(Vec3::ZERO, 1.0, 4));
    SceneBuilder::default()
        .mesh("inner", inner.0, inner.1, None, glowing(0.0, 1.0))
        .mesh("outer", outer.0, outer.1, None, grey(0.8))
        .quad("probe", Vec3::new(0.5, -0.01, -0.01), [0.02 * Vec3::Z, 0.02 * Vec3::X], grey(0.5))
        .build()
}

fn cap() -> Verdict {
    let transport = Transport { max_bounces: Some(4), ..Transport::default() };
    let readings = light_by(&furnace(0.8), &on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), 1 << 12, transport)?;
    let albedo = f64::from(0.8_f32);
    mean_reads(&readings, PI * (1.0 - albedo.powi(5)) / (1.0 - albedo), 3e-3)
}

//! Size and place of the world: light does not know how large a scene is, where it stands or how bright it is.

use crate::case::{Case, Verdict};
use crate::common::meter::{at, on_walls};
use crate::common::scenes::{SceneBuilder, furnace, glowing, grey};
use crate::guards::light::FULL_SUMS;
use crate::guards::rays::{NO_CONSTANT, ORIGIN_MOVE, TREE_UNITS};
use crate::guards::scene::TEXELS_IN_WORLD;
use crate::judge::{agree, baked, ensure, light_at, mean_reads, same_but_for_rounding};
use crate::worlds::{
    askew, bulb, in_the_room, level_room, points_under, rectangle, room, rounded_by, spot, sun, under,
};
use bevy_kiln::bake::{BakeSettings, Lightmap, MeterReading};
use bevy_kiln::scene::{Light, Scene};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};
use std::f64::consts::PI;

const FURNACE: &str = "rays that start in a corner of a closed room lie within rounding of the next wall; no wall lies \
                       along an axis, so that every point has an error off its plane";
const FURNACE_HOLDS: &str = "E = π/(1 − ρ) within 0.3 % (ρ = 0.8), noise counted in";
const SMALL_BIAS: &str = "an absolute ray bias (Godot: 0.5 mm, Fyrox: 10 mm) starts rays behind walls: light leaks out";
const LARGE_BIAS: &str = "an absolute ray bias is lost in rounding: surfaces meet their own rays";
const ROOM: &str = "a room with a lamp and a board, askew: all lengths and all errors are scaled";
const ROOM_HOLDS: &str = "the mean texel is that of the room of 2 m within 0.5 % (the same random numbers: what differs \
                          is rounding), and that of a room along the axes within 3 % (other random numbers)";
const TURNED_HOLDS: &str = "the mean light at four points is that of the room along the axes within 2 %, four standard \
                            errors counted in";
const MOVED_HOLDS: &str = "the mean texel is that of the room whose vertices are rounded so, at home, within 0.5 %: the \
                           step moves vertices, and nothing else; and that of a room along the axes within 3 %";
const POWER: &str = "products of a lamp's light and of throughputs over twelve decades, with bounces";
const HALF_FLOATS: &str = "half-float accumulators (Godot's lm_compute.glsl) end at 65504 and lose digits below 6e-5: \
                           proposal 9884 asks to bake at 100 times the power";
const POWER_HOLDS: &str = "a millionth and a million times the power give a millionth and a million times the light, \
                           to 1e-5: the same paths, rounded";
const SELF_SHADOW: &str = "walls meet the rays that leave them";

pub const CASES: &[Case] = &[
    Case {
        name: "a_furnace_of_2_mm",
        hard: FURNACE,
        elsewhere: SMALL_BIAS,
        holds: FURNACE_HOLDS,
        guard: &TREE_UNITS,
        without: "rays from corners leave the room, E is too low",
        check: || furnace_of_scale(1e-3),
    },
    Case {
        name: "a_furnace_of_2_cm",
        hard: FURNACE,
        elsewhere: SMALL_BIAS,
        holds: FURNACE_HOLDS,
        guard: &NO_CONSTANT,
        without: "rays start behind the next wall and leave the room",
        check: || furnace_of_scale(1e-2),
    },
    Case {
        name: "a_furnace_of_200_m",
        hard: FURNACE,
        elsewhere: LARGE_BIAS,
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_of_scale(1e2),
    },
    Case {
        name: "a_furnace_of_2_km",
        hard: FURNACE,
        elsewhere: LARGE_BIAS,
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_of_scale(1e3),
    },
    Case {
        name: "a_furnace_of_20_km",
        hard: FURNACE,
        elsewhere: LARGE_BIAS,
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_of_scale(1e4),
    },
    Case {
        name: "a_room_of_2_mm",
        hard: ROOM,
        elsewhere: SMALL_BIAS,
        holds: ROOM_HOLDS,
        guard: &NO_CONSTANT,
        without: "rays start outside of the room, which is dark",
        check: || room_of_scale(1e-3),
    },
    Case {
        name: "a_room_of_2_cm",
        hard: ROOM,
        elsewhere: SMALL_BIAS,
        holds: ROOM_HOLDS,
        guard: &NO_CONSTANT,
        without: "rays start beyond the lamp and behind walls",
        check: || room_of_scale(1e-2),
    },
    Case {
        name: "a_room_of_2_km",
        hard: ROOM,
        elsewhere: LARGE_BIAS,
        holds: ROOM_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_of_scale(1e3),
    },
    Case {
        name: "a_room_of_20_km",
        hard: ROOM,
        elsewhere: LARGE_BIAS,
        holds: ROOM_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_of_scale(1e4),
    },
    Case {
        name: "a_room_1_km_away",
        hard: "f32 has steps of 61 µm there",
        elsewhere: "an offset without the coordinates' error (Ray Tracing Gems, chapter 6, with a transform) fails",
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::new(1e3, 0.0, 0.0)),
    },
    Case {
        name: "a_room_10_km_away",
        hard: "f32 has steps of 1 mm there, along one axis",
        elsewhere: "reported for the usual offset: shadow acne at a translation of 10 000",
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::new(0.0, 0.0, -1e4)),
    },
    Case {
        name: "a_room_10_km_away_on_all_axes",
        hard: "f32 has steps of 1 mm there, along every axis",
        elsewhere: "reported for the usual offset: shadow acne at a translation of 10 000",
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::splat(1e4)),
    },
    Case {
        name: "a_room_100_km_away",
        hard: "f32 has steps of 7.8 mm there: points on a wall are off by several times that along its normal",
        elsewhere: "games move the world instead (floating origin); bakers do not",
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::new(1e5, 0.0, 0.0)),
    },
    Case {
        name: "a_room_100_km_away_on_all_axes",
        hard: "f32 has steps of 7.8 mm there, along every axis",
        elsewhere: "games move the world instead (floating origin); bakers do not",
        holds: MOVED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_at(DVec3::splat(-1e5)),
    },
    Case {
        name: "a_furnace_100_km_away",
        hard: "its walls are crooked by steps of 7.8 mm, but it is closed whatever its vertices are",
        elsewhere: "a bias below the step does not leave the wall; one above it leaves the room",
        holds: FURNACE_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || furnace_at(DVec3::splat(1e5)),
    },
    Case {
        name: "a_world_turned_by_a_ten_thousandth",
        hard: "walls that lie along an axis nearly, so that coordinates differ in their last digits only",
        elsewhere: "tests with axis-aligned walls see no error off the plane",
        holds: TURNED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_turned(Quat::from_rotation_z(1e-4) * Quat::from_rotation_x(1e-4) * askew().inverse()),
    },
    Case {
        name: "a_world_turned_by_45_degrees",
        hard: "walls whose normals have two equal components: their rays run along diagonals of the tree's boxes",
        elsewhere: "a bias along the dominant axis alone is too short by √2",
        holds: TURNED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_turned(Quat::from_rotation_z(PI as f32 / 4.0) * askew().inverse()),
    },
    Case {
        name: "a_world_turned_upside_down",
        hard: "a half turn about an axis that is none of the world's: no coordinate stays",
        elsewhere: "a frame or a pole that is taken from world up (Y) changes the light",
        holds: TURNED_HOLDS,
        guard: &ORIGIN_MOVE,
        without: SELF_SHADOW,
        check: || room_turned(Quat::from_axis_angle(Vec3::new(0.8, 0.0, 0.6), 3.1)),
    },
    Case {
        name: "texels_under_a_scaled_root",
        hard: "the scale stands in the root, not in the mesh",
        elsewhere: "lightmap sizes by the mesh's own lengths: a model at scale 4 has a quarter of its texels",
        holds: "under a root of scale 4 a quad has four times the texels along each side, at scale 1e-3 the least, 2",
        guard: &TEXELS_IN_WORLD,
        without: "the number of texels is that of the mesh",
        check: || texels_of(Affine3A::from_scale(Vec3::splat(4.0)), 36 * 36).and(texels_of(small(), 2 * 2)),
    },
    Case {
        name: "texels_under_nested_scales",
        hard: "a scale on one axis within a turn within a scale on another: the quad is sheared to a parallelogram",
        elsewhere: "the length of a scale vector is taken for the stretch",
        holds: "sides get √(mean square stretch) texels each: 10 along u and 32 along v at 9 per metre",
        guard: &TEXELS_IN_WORLD,
        without: "the number of texels is that of the mesh",
        check: || texels_of(nested(), 10 * 32),
    },
    Case {
        name: "power_of_a_rectangle",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: "bright light is infinite, dim light coarse",
        check: || lamp_is_linear(&|power| Light::Rect(rectangle_of(power))),
    },
    Case {
        name: "power_of_a_bulb",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: "bright light is infinite, dim light coarse",
        check: || {
            lamp_is_linear(&|power| {
                let mut lamp = bulb(Vec3::new(0.1, 0.6, 0.2), 0.05);
                lamp.intensity *= power;
                Light::Point(lamp)
            })
        },
    },
    Case {
        name: "power_of_a_spot",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: "bright light is infinite, dim light coarse",
        check: || {
            lamp_is_linear(&|power| {
                let mut lamp = spot(Vec3::new(0.1, 0.6, 0.2), 0.2, 0.9);
                lamp.bulb.intensity *= power;
                Light::Spot(lamp)
            })
        },
    },
    Case {
        name: "power_of_a_sun",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: "bright light is infinite, dim light coarse",
        check: || {
            lamp_is_linear(&|power| {
                let mut sun = sun(Vec3::new(0.2, 0.9, 0.1).normalize(), 0.0093);
                sun.illuminance *= power;
                Light::Directional(sun)
            })
        },
    },
    Case {
        name: "power_of_a_glowing_panel",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: "bright light is infinite, dim light coarse",
        check: || {
            is_linear(&|power| {
                let panel = glowing(0.0, power);
                corner().quad("lamp", Vec3::new(-0.2, 0.6, -0.2), [Vec3::X * 0.4, Vec3::Z * 0.4], panel).build()
            })
        },
    },
    Case {
        name: "power_of_the_sky",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: "bright light is infinite, dim light coarse",
        check: || is_linear(&|power| corner().sky(Vec3::splat(power)).build()),
    },
];

fn furnace_of_scale(scale: f32) -> Verdict {
    let root = Affine3A::from_quat(askew()) * Affine3A::from_scale(Vec3::splat(scale));
    let points = points_under(&on_walls(Vec3::NEG_ONE, Vec3::ONE, 2), root);
    mean_reads(&light_at(&under(furnace(0.8), root), &points, 1 << 11)?, PI / 0.2, 3e-3)
}

fn furnace_at(offset: DVec3) -> Verdict {
    let root = Affine3A::from_rotation_translation(askew(), offset.as_vec3());
    let points = points_under(&on_walls(Vec3::splat(-0.9), Vec3::splat(0.9), 2), root);
    mean_reads(&light_at(&under(furnace(0.8), root), &points, 1 << 11)?, PI / 0.2, 3e-3)
}

fn bake_of(scene: &Scene, density: f32) -> Result<Lightmap, String> {
    baked(scene, &BakeSettings { samples_per_texel: 64, density, ..BakeSettings::default() })
}

/// How many texels there are, and the mean of red over them [cd/m²].
fn texels(lightmap: &Lightmap) -> (usize, f64) {
    let texels = lightmap.pages.iter().flat_map(|page| page.raw.iter().zip(&page.coverage));
    let texels: Vec<f64> = texels.filter(|(_, coverage)| **coverage > 0.0).map(|(raw, _)| f64::from(raw.x)).collect();
    (texels.len(), texels.iter().sum::<f64>() / texels.len() as f64)
}

/// Whether two rooms have as many texels, and these the same mean to half a per cent; and to 3 % that of the level
/// room, which has other random numbers but where points have no error off their walls.
fn same_room(here: &Scene, there: &Scene, scale: f32) -> Verdict {
    let [(_, level), (count, mean), (other_count, other_mean)] =
        [texels(&bake_of(&level_room(), 4.7)?), texels(&bake_of(here, 4.7)?), texels(&bake_of(there, 4.7 / scale)?)];
    ensure((mean / level - 1.0).abs() <= 0.03, || {
        format!("the mean texel is {mean:.5}, and {level:.5} of a level room")
    })?;
    ensure(count == other_count, || format!("{other_count} texels, not {count}"))?;
    ensure((other_mean / mean - 1.0).abs() <= 5e-3, || format!("the mean texel is {other_mean:.5}, not {mean:.5}"))
}

fn room_of_scale(scale: f32) -> Verdict {
    same_room(&room(), &under(room(), Affine3A::from_scale(Vec3::splat(scale))), scale)
}

/// The light in the room under a turn, against that in the level room.
fn room_turned(turn: Quat) -> Verdict {
    let turn = Affine3A::from_quat(turn);
    let back = Affine3A::from_quat(askew().inverse());
    let here = mean_of(&light_at(&level_room(), &points_under(&in_the_room(), back), 1 << 13)?);
    let there = mean_of(&light_at(&under(room(), turn), &points_under(&in_the_room(), turn), 1 << 13)?);
    agree(&there, &here, 0.02)
}

fn mean_of(readings: &[MeterReading]) -> MeterReading {
    let count = readings.len() as f64;
    let squares: DVec3 = readings.iter().map(|reading| reading.stderr * reading.stderr).sum();
    MeterReading {
        irradiance: readings.iter().map(|reading| reading.irradiance).sum::<DVec3>() / count,
        stderr: squares.map(f64::sqrt) / count,
        samples: readings.iter().map(|reading| reading.samples).sum(),
    }
}

/// The room moved away, against the room with its vertices rounded as they are there.
fn room_at(offset: DVec3) -> Verdict {
    let there = under(room(), Affine3A::from_translation(offset.as_vec3()));
    same_room(&rounded_by(room(), offset), &there, 1.0)
}

fn small() -> Affine3A {
    Affine3A::from_scale(Vec3::splat(1e-3))
}

fn nested() -> Affine3A {
    Affine3A::from_scale(Vec3::new(4.0, 1.0, 1.0))
        * Affine3A::from_rotation_y(PI as f32 / 6.0)
        * Affine3A::from_scale(Vec3::new(1.0, 1.0, 0.5))
}

fn texels_of(root: Affine3A, expected: usize) -> Verdict {
    let quad = SceneBuilder::default().quad("quad", Vec3::ZERO, [Vec3::Z, Vec3::X], grey(0.5)).sky(Vec3::ONE).build();
    let (count, mean) = texels(&bake_of(&under(quad, root), 9.0)?);
    ensure(count == expected, || format!("{count} texels, not {expected}"))?;
    ensure((mean - 1.0).abs() < 1e-3, || format!("the mean texel is {mean}, not 1"))
}

/// Two walls and a floor.
fn corner() -> SceneBuilder {
    SceneBuilder::default()
        .quad("floor", Vec3::NEG_ONE, [Vec3::Z * 2.0, Vec3::X * 2.0], grey(0.7))
        .quad("left", Vec3::NEG_ONE, [Vec3::Y * 2.0, Vec3::Z * 2.0], grey(0.5))
        .quad("back", Vec3::NEG_ONE, [Vec3::X * 2.0, Vec3::Y * 2.0], grey(0.3))
}

fn rectangle_of(power: f32) -> bevy_kiln::scene::RectLight {
    let mut lamp = rectangle(Vec3::new(0.0, 0.8, 0.0), Vec3::new(-0.3, -1.0, 0.0), Vec2::new(0.3, 0.5));
    lamp.radiance *= power;
    lamp
}

fn lamp_is_linear(lamp: &dyn Fn(f32) -> Light) -> Verdict {
    is_linear(&|power| {
        let mut scene = corner().build();
        scene.lights.push(lamp(power));
        scene
    })
}

/// Whether light is in proportion to power.
fn is_linear(scene: &dyn Fn(f32) -> Scene) -> Verdict {
    let points = [at(Vec3::new(-0.3, -1.0, 0.2), Vec3::Y), at(Vec3::new(-1.0, -0.4, 0.1), Vec3::X)];
    let unit = light_at(&scene(1.0), &points, 256)?;
    [1e-6_f32, 1e6].into_iter().try_for_each(|power| {
        let mut readings = light_at(&scene(power), &points, 256)?;
        for reading in &mut readings {
            reading.irradiance /= f64::from(power);
        }
        same_but_for_rounding(&readings, &unit, 1e-5)
    })
}

//! Power: a million times the light, and a millionth of it.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::light::FULL_SUMS;
use crate::judge::{light_at, same_but_for_rounding};
use crate::things::{bulb, rectangle, spot, sun};
use bevy_kiln::scene::{Light, Scene};
use glam::{Vec2, Vec3};

const POWER: &str = "products of a lamp's light and of throughputs over twelve decades, with bounces";
const HALF_FLOATS: &str = "half-float accumulators (Godot's lm_compute.glsl) end at 65504 and lose digits below 6e-5: \
                           proposal 9884 asks to bake at 100 times the power";
const POWER_HOLDS: &str = "a millionth and a million times the power give a millionth and a million times the light, \
                           to 1e-5: the same paths, rounded";

const COARSE: &str = "bright light is infinite, dim light coarse";

pub const CASES: &[Case] = &[
    Case {
        name: "power_of_a_rectangle",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: COARSE,
        check: || {
            lamp_is_linear(&|power| {
                let mut lamp = rectangle(Vec3::new(0.0, 0.8, 0.0), Vec3::new(-0.3, -1.0, 0.0), Vec2::new(0.3, 0.5));
                lamp.radiance *= power;
                Light::Rect(lamp)
            })
        },
    },
    Case {
        name: "power_of_a_bulb",
        hard: POWER,
        elsewhere: HALF_FLOATS,
        holds: POWER_HOLDS,
        guard: &FULL_SUMS,
        without: COARSE,
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
        without: COARSE,
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
        without: COARSE,
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
        without: COARSE,
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
        without: COARSE,
        check: || is_linear(&|power| corner().sky(Vec3::splat(power)).build()),
    },
];

/// Two walls and a floor.
fn corner() -> SceneBuilder {
    SceneBuilder::default()
        .quad("floor", Vec3::NEG_ONE, [Vec3::Z * 2.0, Vec3::X * 2.0], grey(0.7))
        .quad("left", Vec3::NEG_ONE, [Vec3::Y * 2.0, Vec3::Z * 2.0], grey(0.5))
        .quad("back", Vec3::NEG_ONE, [Vec3::X * 2.0, Vec3::Y * 2.0], grey(0.3))
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

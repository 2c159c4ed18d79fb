//! Indices of refraction: equal, far apart, turned around, and the angle beyond which nothing passes.

use super::UNSEEN;
use crate::case::{Case, Verdict};
use crate::common::fresnel::fresnel;
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::bsdf::{INDEX_TURNED, MATCHED, RADIANCE_BY_INDEX, TOTAL_REFLECTION};
use crate::judge::{all_read, light_at};
use crate::look::{furnace_of_one, sees, vanishes};
use crate::things::{glass, level, of, sphere, with_box};
use crate::worlds::{joined, renamed, room_of_radiance_one};
use bevy_kiln::scene::Scattering;
use glam::Vec3;
use std::f64::consts::PI;

const SQUEEZED: &str = "light is squeezed twice by n² and not let go";
const LOST: &str = "a root of a negative number: paths are lost, and said to be";
const NEGATIVE_ROOT: &str = "a root of a negative number";

pub const CASES: &[Case] = &[
    Case {
        name: "ior_1",
        hard: "rough glass of index 1: nothing is bent, and the half vector of refraction has no length",
        elsewhere: "NaN, or black",
        holds: "under a white sky every path brings 1: E = π to 1e-5, as f32 rounds",
        guard: &MATCHED,
        without: "what goes straight on is found by no lobe",
        check: || under_slab(1.0),
    },
    Case {
        name: "ior_1_0001",
        hard: "the half vector is a difference of vectors that are equal but for 1e-4",
        elsewhere: "NaN, black, or noise",
        holds: "no interface, which would reflect 2.5e-9 along the normal: E = π to 1e-5, as f32 rounds",
        guard: &MATCHED,
        without: "rounding decides the half vector",
        check: || under_slab(1.0001),
    },
    Case {
        name: "ior_0_5",
        hard: "a bubble: total reflection from outside, beyond 30°",
        elsewhere: "glass as a grey filter",
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: || vanishes(&glass(0.5, 0.0), 1 << 12, 3e-3),
    },
    Case {
        name: "ior_2_4",
        hard: "diamond: what is inside leaves within 25° of the normal alone",
        elsewhere: "glass as a grey filter",
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: || vanishes(&glass(2.4, 0.0), 1 << 12, 3e-3),
    },
    Case {
        name: "ior_100",
        hard: "radiance changes by 1e4 and back, 96 % are reflected on either way",
        elsewhere: "glass as a grey filter",
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: || vanishes(&glass(100.0, 0.0), 1 << 12, 3e-3),
    },
    Case {
        name: "below_the_critical_angle",
        hard: "1e-4 rad from where the root of Snell's law vanishes",
        elsewhere: NEGATIVE_ROOT,
        holds: "seen from below: n²(1 − F) of the sky and F of a floor of radiance 3, by Fresnel's law, within 0.03 \
                cd/m² (1 %)",
        guard: &RADIANCE_BY_INDEX,
        without: "the sky is not concentrated by n²",
        check: || critical(-1e-4, 3e-2),
    },
    Case {
        name: "at_the_critical_angle",
        hard: "the cosine behind the surface is 0, or the root of what rounding left",
        elsewhere: NEGATIVE_ROOT,
        holds: "all is reflected: a floor of radiance 3 is seen within 2 %, which 1e-7 of angle changes",
        guard: &TOTAL_REFLECTION,
        without: LOST,
        check: || critical(1e-7, 6e-2),
    },
    Case {
        name: "beyond_the_critical_angle",
        hard: "Snell's law has no solution",
        elsewhere: NEGATIVE_ROOT,
        holds: "all is reflected: a floor of radiance 3 is seen within 1e-4, as f32 rounds",
        guard: &TOTAL_REFLECTION,
        without: LOST,
        check: || critical(1e-4, 3e-4),
    },
    Case {
        name: "a_sphere_of_glass_in_a_sphere_of_glass",
        hard: "an interface knows its own two sides, and no list of what lies in what",
        elsewhere: "a stack of media that comes out of step",
        holds: "what loses no light cannot be seen in a furnace: E = π within 0.5 %",
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: nested,
    },
    Case {
        name: "glass_turned_inside_out",
        hard: "normals point inwards: the body is a bubble, the room around it glass",
        elsewhere: "light that is lost or doubled by n²",
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: inside_out,
    },
    Case {
        name: "glass_beside_glass",
        hard: "two bodies a micrometre apart: 24 interfaces, two of them within rounding's reach",
        elsewhere: "a ray that starts behind the second surface never enters the second body",
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: side_by_side,
    },
];

/// The ground under a slab of rough glass, which loses and reflects nothing.
fn under_slab(ior: f32) -> Verdict {
    let mut builder = level(SceneBuilder::default(), "ground", -1.0, [100.0, 1.0], grey(0.0));
    builder = level(builder, "top", 0.0, [100.0, 1.0], glass(ior, 0.5));
    builder = level(builder, "bottom", -0.5, [100.0, -1.0], glass(ior, 0.5));
    let scene = builder.sky(Vec3::ONE).build();
    all_read(&light_at(&scene, &[at(Vec3::new(0.1, -1.0, 0.2), Vec3::Y)], 1 << 12)?, PI, 1e-5)
}

/// From within glass of index 1.5 over a floor of radiance 3, at the critical angle and `past` it [rad]. The sky's
/// radiance is 1, the tolerance is in cd/m².
fn critical(past: f64, tolerance: f64) -> Verdict {
    let mut builder =
        level(SceneBuilder::default(), "water", 0.0, [1000.0, 1.0], of(Scattering::Refraction { ior: 1.5 }));
    builder = level(builder, "floor", -2.0, [1000.0, 1.0], glowing(0.0, 3.0));
    let scene = builder.sky(Vec3::ONE).build();
    let angle = (1.0_f64 / 1.5).asin() + past;
    let reflected = fresnel(angle.cos(), 1.0 / 1.5);
    let truth = 3.0 * reflected + 2.25 * (1.0 - reflected);
    let direction = Vec3::new(angle.sin() as f32, angle.cos() as f32, 0.0);
    sees(&scene, [Vec3::NEG_Y, Vec3::NEG_Y + direction], 1 << 12, truth, tolerance)
}

fn nested() -> Verdict {
    let (outer, inner) = (sphere(Vec3::ZERO, 0.9, 3), sphere(Vec3::new(0.1, 0.0, 0.0), 0.5, 3));
    let scene = room_of_radiance_one()
        .mesh("outer", outer.0, outer.1, None, glass(1.5, 0.0))
        .mesh("inner", inner.0, inner.1, None, glass(1.3, 0.0))
        .build();
    furnace_of_one(&scene, 1 << 12, 5e-3)
}

fn inside_out() -> Verdict {
    let sides = [(); 6].map(|()| glass(1.5, 0.0));
    let body = SceneBuilder::default().room(Vec3::new(-0.8, -0.6, -0.7), Vec3::new(0.7, 0.8, 0.8), sides).build();
    furnace_of_one(&joined(room_of_radiance_one().build(), renamed(body, "body")), 1 << 12, 3e-3)
}

fn side_by_side() -> Verdict {
    let [left, right] =
        [[-0.8, 0.0], [1e-6, 0.8]].map(|[low, high]: [f32; 2]| [Vec3::new(low, -0.7, -0.7), Vec3::new(high, 0.7, 0.7)]);
    let builder = with_box(room_of_radiance_one(), "left", left, &glass(1.5, 0.0));
    let scene = with_box(builder, "right", right, &glass(1.5, 0.0)).build();
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

//! Triangles that are too small or too thin for an absolute threshold, over a floor of 250 m.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::rays::NO_LEAST_AREA;
use crate::judge::{all_dark, light_at, reads};
use crate::things::bulb;
use bevy_kiln::artefact::StableId;
use bevy_kiln::scene::{Light, PointLight};
use glam::{DVec3, Vec3};

const INVISIBLE: &str = "Godot's lightmapper rejects det below 1e-5: such a triangle is invisible to every ray";
const SHADOW: &str = "it casts its shadow (E = 0); beside it E = I·cos/d² to 1e-5, as f32 rounds, and a lamp under the \
                      floor is not seen";

pub const CASES: &[Case] = &[
    Case {
        name: "a_triangle_of_3_mm_over_a_floor_of_250_m",
        hard: "twice its area is 9e-6 m², five decades and more below the floor's",
        elsewhere: INVISIBLE,
        holds: SHADOW,
        guard: &NO_LEAST_AREA,
        without: "there is no shadow",
        check: || shadow_of(&[Vec3::new(-1e-3, 1.0, -1e-3), Vec3::new(2e-3, 1.0, -1e-3), Vec3::new(-1e-3, 1.0, 2e-3)]),
    },
    Case {
        name: "a_triangle_of_3_um_over_a_floor_of_250_m",
        hard: "sizes over eight decades in one tree",
        elsewhere: INVISIBLE,
        holds: SHADOW,
        guard: &NO_LEAST_AREA,
        without: "there is no shadow",
        check: || shadow_of(&[Vec3::new(-1e-6, 1.0, -1e-6), Vec3::new(2e-6, 1.0, -1e-6), Vec3::new(-1e-6, 1.0, 2e-6)]),
    },
    Case {
        name: "a_needle_of_a_million_to_one",
        hard: "1 m long and 1 µm wide",
        elsewhere: INVISIBLE,
        holds: "it casts its shadow on its axis (E = 0); 10 cm beside it E = I·cos/d² to 1e-5, as f32 rounds",
        guard: &NO_LEAST_AREA,
        without: "there is no shadow",
        check: || shadow_of(&[Vec3::new(-5e-7, 1.0, -0.5), Vec3::new(5e-7, 1.0, -0.5), Vec3::new(0.0, 1.0, 0.5)]),
    },
];

/// A floor of 250 m, a point 2 m over it and a triangle between.
fn shadow_of(triangle: &[Vec3; 3]) -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-125.0, 0.0, -125.0), [Vec3::Z * 250.0, Vec3::X * 250.0], grey(0.0))
        .mesh("triangle", triangle.to_vec(), vec![0, 1, 2], None, grey(0.0))
        .build();
    scene.lights.push(Light::Point(bulb(2.0 * Vec3::Y, 0.0)));
    scene.lights.push(Light::Point(PointLight { id: StableId::new("below"), ..bulb(Vec3::NEG_Y, 0.0) }));
    // In the air: a point that is computed on a floor of 250 m is off along it by 0.1 mm.
    let places = [Vec3::ZERO, Vec3::new(0.1, 0.0, 0.0), Vec3::new(124.0, 0.0, -124.5)].map(|p| p + 0.25 * Vec3::Y);
    let readings = light_at(&scene, &places.map(|place| at(place, Vec3::Y)), 256)?;
    all_dark(&readings[..1]).map_err(|error| format!("in the shadow {error}"))?;
    places[1..].iter().zip(&readings[1..]).try_for_each(|(place, reading)| {
        reads(reading, 1.75 / (place.as_dvec3() - 2.0 * DVec3::Y).length().powi(3), 1e-5)
    })
}

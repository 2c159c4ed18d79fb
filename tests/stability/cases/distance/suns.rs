//! Suns without width, and suns so low that their rays run along the floor.

use super::GRAZING;
use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, grey};
use crate::guards::light::DELTA;
use crate::guards::rays::ORIGIN_MOVE;
use crate::judge::{light_at, light_by, reads};
use crate::things::{lit_by, sun};
use crate::worlds::{askew, under};
use bevy_kiln::scene::Light;
use bevy_kiln::trace::{Estimator, Transport};
use glam::{Affine3A, Vec3};

const BY_ALL_THREE: &str = "E = E⊥·cos to 1e-6 by each of the three estimators: f32 rounds the direction";
const NEVER_MET: &str = "the estimator of surface rays believes that its rays will meet the sun: it is dark";

pub const CASES: &[Case] = &[
    Case {
        name: "a_sun_without_width",
        hard: "a disc of no solid angle: radiance is E/0",
        elsewhere: "0/0 where the disc is looked up; a surface's rays never meet it",
        holds: BY_ALL_THREE,
        guard: &DELTA,
        without: NEVER_MET,
        check: || small_sun(0.0),
    },
    Case {
        name: "a_sun_of_a_ten_millionth",
        hard: "a disc less wide than a step between f32 directions",
        elsewhere: "rays meet it by the luck of rounding, with a radiance of 1e14",
        holds: BY_ALL_THREE,
        guard: &DELTA,
        without: NEVER_MET,
        check: || small_sun(1e-7),
    },
    Case {
        name: "a_sun_at_10_mrad",
        hard: "shadow rays leave a floor of 200 m, which lies askew, nearly along it",
        elsewhere: GRAZING,
        holds: "E = E⊥·sin of the elevation to 2⁻²²/elevation (2.4e-5) at 64 points: f32 normals and directions are \
                off by as much",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: || grazing(1e-2),
    },
    Case {
        name: "a_sun_at_100_urad",
        hard: "shadow rays leave a floor of 200 m, which lies askew, all but along it",
        elsewhere: GRAZING,
        holds: "E = E⊥·sin of the elevation to 2⁻²²/elevation (0.24 %) at 64 points: f32 normals and directions are \
                off by as much",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: || grazing(1e-4),
    },
    Case {
        name: "a_sun_at_1_urad",
        hard: "a shadow ray rises by 0.2 mm over 200 m; f32 normals are off by a tenth of the elevation",
        elsewhere: GRAZING,
        holds: "E = E⊥·sin of the elevation to 2⁻²²/elevation (24 %) at 64 points, as f32 normals and directions are \
                off: none is in shadow",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: || grazing(1e-6),
    },
];

/// A sun of next to no width, by each estimator: directions of the surface never meet it.
fn small_sun(diameter: f32) -> Verdict {
    let towards = Vec3::new(0.48, 0.6, 0.64);
    for estimator in [Estimator::Mis, Estimator::Light, Estimator::Bsdf] {
        let transport = Transport { estimator, ..Transport::default() };
        let scene = lit_by([Light::Directional(sun(towards, diameter))]);
        let readings = light_by(&scene, &[at(Vec3::ZERO, Vec3::Y)], 16, transport)?;
        reads(&readings[0], 0.6, 1e-6).map_err(|error| format!("{estimator:?}: {error}"))?;
    }
    Ok(())
}

/// A sun at an elevation over a floor of 200 m that lies askew.
fn grazing(elevation: f64) -> Verdict {
    let floor = SceneBuilder::default()
        .quad("floor", Vec3::new(-100.0, 0.0, -100.0), [Vec3::Z * 200.0, Vec3::X * 200.0], grey(0.5))
        .build();
    let mut scene = under(floor, Affine3A::from_quat(askew()));
    let [a, b, _, d] = [0, 1, 2, 3]
        .map(|v| scene.instances[0].world_from_local.matrix3.as_dmat3() * scene.meshes[0].positions[v].as_dvec3());
    let normal = (b - a).cross(d - a).normalize();
    let along = (b - a).normalize();
    let towards = along * elevation.cos() + normal * elevation.sin();
    scene.lights.push(Light::Directional(sun(towards.as_vec3(), 0.0)));
    let points: Vec<_> = (0..64)
        .map(|index| Vec3::new((index % 8) as f32 * 23.7 - 83.0, 0.0, (index / 8) as f32 * 22.3 - 81.0))
        .map(|place| at(askew() * place, askew() * Vec3::Y))
        .collect();
    let readings = light_at(&scene, &points, 16)?;
    readings.iter().try_for_each(|reading| reads(reading, elevation.sin(), 2.0_f64.powi(-22) / elevation))
}

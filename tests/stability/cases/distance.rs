//! Where a receiver is, seen from a light: near, far, on it, beside it, behind it, at a grazing angle.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey, lit_room};
use crate::guards::light::{
    BULBS, DELTA, DIMMING, HORIZON, LAMP_END, ONE_SIDED, SOLID_ANGLE, SOLID_ANGLE_EXACT, SPHERE_CONE, TWO_WAYS,
};
use crate::guards::rays::{ORIGIN_MOVE, SHADOW_LENGTH};
use crate::judge::{ensure, light_at, light_by, reads};
use crate::worlds::{askew, bulb, lit_by, rectangle, spot, sun, under};
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{MeterPoint, MeterReading};
use bevy_kiln::math::{corner_parallel_rectangle, luminance, polygon_irradiance};
use bevy_kiln::scene::{Light, PointLight, RectLight, Scene};
use bevy_kiln::trace::{Estimator, Transport};
use glam::{Affine3A, DVec3, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

const AREA_NEAR: &str = "area sampling: the variance grows as 1/d² (55.6 million samples for 2 %, 0.5 mm under Cornell's \
                         lamp)";
const NEAR_2: &str = "E = π·F (Howell B-3) within 2 %, noise counted in: no sample counts for more than radiance times \
                      solid angle, by light sampling alone";
const BULB_WITHOUT: &str = "the cone is wider than the sky, or narrower than the sphere: E is wrong";
const GRAZING: &str = "shadow terminators and acne at low suns; biases long enough to hide them detach shadows";

pub const CASES: &[Case] = &[
    Case {
        name: "a_tenth_of_a_millimetre_under_a_rectangle",
        hard: "a rectangle of 1 m fills all but 1e-4 of the view",
        elsewhere: AREA_NEAR,
        holds: NEAR_2,
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_rectangle(1e-4, 0.5, 0.02),
    },
    Case {
        name: "a_micrometre_under_a_rectangle",
        hard: "1/d² = 1e12 1/m², and the lamp's plane is 8 steps of f32 away",
        elsewhere: AREA_NEAR,
        holds: "E = π within 2 %, noise counted in; level, since f32 puts a tilted lamp of 1 m no nearer than 2 µm",
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_level_rectangle(1e-6, 0.5, 0.02),
    },
    Case {
        name: "10_km_from_a_rectangle",
        hard: "a solid angle of 1e-8 sr as a difference of angles",
        elsewhere: "the sum of four angles less 2π has an error of 5e-7 in f32 shaders",
        holds: "E = π·F (Howell B-3) within 1e-3",
        guard: &SOLID_ANGLE_EXACT,
        without: "the difference is rounding: the lamp is dark, or 50 times too bright",
        check: || under_a_rectangle(1e4, 0.5, 1e-3),
    },
    Case {
        name: "under_the_edge_of_a_rectangle",
        hard: "0.1 mm under the very edge: half the hemisphere",
        elsewhere: AREA_NEAR,
        holds: "E = π/2 (by four rectangles, Howell B-3) within 2 %, noise counted in",
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_place(Vec2::new(0.5, 0.0), 1e-4),
    },
    Case {
        name: "under_the_corner_of_a_rectangle",
        hard: "0.1 mm under the very corner: a quarter of the hemisphere",
        elsewhere: AREA_NEAR,
        holds: "E = π/4 (Howell B-3) within 2 %, noise counted in",
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_place(Vec2::new(0.5, 0.5), 1e-4),
    },
    Case {
        name: "under_a_ceiling_of_1000_km",
        hard: "a solid angle of 2π less 6e-6 sr",
        elsewhere: "area sampling finds one point in 1e11 within 1 m",
        holds: "E = π within 1 %, noise counted in",
        guard: &SOLID_ANGLE,
        without: "every sample is too far away to count: it is dark",
        check: || under_a_level_rectangle(1.0, 5e5, 0.01),
    },
    Case {
        name: "1_km_from_a_lamp_of_1_mm",
        hard: "a solid angle of 1e-12 sr",
        elsewhere: "differences of angles are good to 1e-16 in f64 and 1e-7 in f32",
        holds: "E = π·F (Howell B-3) within 1e-3: where f32 puts a lamp 1 km away it keeps its size",
        guard: &SOLID_ANGLE_EXACT,
        without: "the difference is rounding: the lamp is dark",
        check: || under_a_rectangle(1e3, 5e-4, 1e-3),
    },
    Case {
        name: "a_tenth_of_a_millimetre_under_a_glowing_panel",
        hard: "a surface that glows, askew and near: both samples and rays meet it",
        elsewhere: AREA_NEAR,
        holds: NEAR_2,
        guard: &SOLID_ANGLE,
        without: "the noise is more than the light",
        check: || under_a_panel(1e-4, 0.02),
    },
    Case {
        name: "10_km_from_a_glowing_panel",
        hard: "a shadow ray of 10 km ends within 0.6 mm of its target, on a panel whose own error is 2 µm",
        elsewhere: "an end that lies behind its lamp is blocked by it; a bias that is long enough passes what hangs before the lamp",
        holds: "E = π·F (Howell B-3) within 1e-3",
        guard: &LAMP_END,
        without: "half of the shadow rays end behind the panel, which blocks its own light: E is halved",
        check: || under_a_panel(1e4, 1e-3),
    },
    Case {
        name: "100_m_from_a_glowing_panel",
        hard: "a shadow ray of 100 m ends within 6 µm of its target, on a panel whose own error is 2 µm",
        elsewhere: "an end that lies behind its lamp is blocked by it; a bias that is long enough passes what hangs before the lamp",
        holds: "E = π·F (Howell B-3) within 1 %",
        guard: &LAMP_END,
        without: "a fifth of the light is lost",
        check: || under_a_panel(1e2, 1e-2),
    },
    Case {
        name: "a_tenth_of_a_millimetre_from_a_bulb",
        hard: "a sphere of 1 m fills all but 1.4 % of a hemisphere, a part of which is below the tilted receiver's horizon",
        elsewhere: "a sphere as a disc of πr²/d², or sampled by its area, of which most faces away",
        holds: "E is that of what is above the horizon (quadrature) within 2 %, by light sampling alone",
        guard: &SPHERE_CONE,
        without: "the cone is too narrow: less of it is below the horizon",
        check: || tilted_beside_a_bulb(1.0001),
    },
    Case {
        name: "touching_a_bulb",
        hard: "the sphere fills a hemisphere: sin of its cone is 1, cos is 0; the receiver is tilted by 60°",
        elsewhere: "√ of a negative rounding error is NaN",
        holds: "E = I·(1 + cos 60°)/2/r² within 2 %, by light sampling alone",
        guard: &SPHERE_CONE,
        without: "the cone is too narrow: less of it is below the horizon",
        check: || tilted_beside_a_bulb(1.0),
    },
    Case {
        name: "inside_a_bulb",
        hard: "no tangent cone: sin would be 2",
        elsewhere: "√(1 − 4) is NaN, or a lamp that hides in its own sphere is dark",
        holds: "a bulb shrinks until it touches the receiver, at the same intensity: E = I/d² within 2 %",
        guard: &BULBS,
        without: BULB_WITHOUT,
        check: || beside_a_bulb(1.0, 0.5, 0.02),
    },
    Case {
        name: "10_km_from_a_bulb",
        hard: "1 − cos of its cone is 5e-9: less than a step of f32 at 1",
        elsewhere: "1 − cos as a difference is 0, and a density of 1/0",
        holds: "E = I/d² within 1e-3",
        guard: &BULBS,
        without: "the cone has no width: the bulb is dark",
        check: || beside_a_bulb(1.0, 1e4, 1e-3),
    },
    Case {
        name: "a_tenth_of_a_millimetre_from_a_point",
        hard: "E = 1e8 lx of 1 cd",
        elsewhere: "engines clamp the distance at 1 cm, which takes all but a ten-thousandth",
        holds: "E = I/d² to 1e-6",
        guard: &BULBS,
        without: "E is 1e4 lx",
        check: || beside_a_bulb(0.0, 1e-4, 1e-6),
    },
    Case {
        name: "a_centimetre_less_than_the_usual_clamp",
        hard: "5 mm from a point: E = 40 000 lx of 1 cd",
        elsewhere: "engines clamp the distance at 1 cm",
        holds: "E = I/d² to 1e-6",
        guard: &BULBS,
        without: "E is a quarter",
        check: || beside_a_bulb(0.0, 5e-3, 1e-6),
    },
    Case {
        name: "a_lamp_set_into_a_ceiling",
        hard: "lamp and ceiling in one plane, askew: rounding puts the one or the other in front",
        elsewhere: "the ceiling blocks a half of the lamp at random, or the lamp is raised by hand",
        holds: "E = π·F (Howell B-3) within 1 %",
        guard: &LAMP_END,
        without: "the lamp lies behind its ceiling in part",
        check: set_into_a_ceiling,
    },
    Case {
        name: "noise_half_a_millimetre_under_a_lamp",
        hard: "a path's worth by area is radiance · cos²/d² · area: 0.5 m² over 2.5e-7 m²",
        elsewhere: "area sampling needs 55.6 million samples 0.5 mm under Cornell's lamp for 2 % (notes: bakers, C)",
        holds: "the relative variance of a path there is within 10 times that at the floor's middle, of the full estimator in a white room",
        guard: &TWO_WAYS,
        without: "relative variance grows by more than a thousand",
        check: variance,
    },
    Case {
        name: "a_sun_without_width",
        hard: "a disc of no solid angle: radiance is E/0",
        elsewhere: "0/0 where the disc is looked up; a surface's rays never meet it",
        holds: "E = E⊥·cos to 1e-6 by each of the three estimators",
        guard: &DELTA,
        without: "the estimator of surface rays believes that its rays will meet the sun: it is dark",
        check: || small_sun(0.0),
    },
    Case {
        name: "a_sun_of_a_ten_millionth",
        hard: "a disc less wide than a step between f32 directions",
        elsewhere: "rays meet it by the luck of rounding, with a radiance of 1e14",
        holds: "E = E⊥·cos to 1e-6 by each of the three estimators",
        guard: &DELTA,
        without: "the estimator of surface rays believes that its rays will meet the sun: it is dark",
        check: || small_sun(1e-7),
    },
    Case {
        name: "a_sun_that_has_half_set",
        hard: "a disc of 0.0093 rad whose middle is 2 mrad below the horizon, beside another light",
        elsewhere: "a light whose centre is below the horizon is culled",
        holds: "E is that of what is above the horizon (quadrature) within 2 %, by light sampling alone",
        guard: &HORIZON,
        without: "the sun is never chosen: it is dark",
        check: || sun_at(0.0093, -0.002),
    },
    Case {
        name: "a_sun_of_half_a_sphere",
        hard: "a disc of π rad whose middle is 40° below the horizon, beside another light",
        elsewhere: "a light whose centre is below the horizon is culled; 1 − cos² of a right angle is negative by rounding",
        holds: "E is that of what is above the horizon (quadrature) within 2 %, by light sampling alone",
        guard: &HORIZON,
        without: "the sun is never chosen: it is dark",
        check: || sun_at(std::f32::consts::PI, -0.7),
    },
    Case {
        name: "a_bulb_that_has_half_set",
        hard: "a sphere whose centre is 0.05 rad below the horizon and its rim 0.1 rad above, beside another light",
        elsewhere: "a light whose centre is below the horizon is culled",
        holds: "E is that of what is above the horizon (quadrature) within 2 %, by light sampling alone",
        guard: &HORIZON,
        without: "the bulb is never chosen: it is dark",
        check: bulb_at_the_horizon,
    },
    Case {
        name: "a_rectangle_half_below_the_horizon",
        hard: "the receiver's plane cuts the lamp, whose centre is below it, beside another light",
        elsewhere: "a light whose centre is below the horizon is culled",
        holds: "E is that of the clipped polygon (Lambert) within 2 %, by light sampling alone",
        guard: &HORIZON,
        without: "the lamp is never chosen: it is dark",
        check: rectangle_at_the_horizon,
    },
    Case {
        name: "a_sun_at_10_mrad",
        hard: "shadow rays leave a floor of 200 m, which lies askew, nearly along it",
        elsewhere: GRAZING,
        holds: "E = E⊥·sin of the elevation within 2⁻²²/elevation, what f32 normals and directions are off, at 64 points",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: || grazing(1e-2),
    },
    Case {
        name: "a_sun_at_100_urad",
        hard: "shadow rays leave a floor of 200 m, which lies askew, all but along it",
        elsewhere: GRAZING,
        holds: "E = E⊥·sin of the elevation within 2⁻²²/elevation (0.24 %) at 64 points",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: || grazing(1e-4),
    },
    Case {
        name: "a_sun_at_1_urad",
        hard: "a shadow ray rises by 0.2 mm over 200 m; f32 normals are off by a tenth of the elevation",
        elsewhere: GRAZING,
        holds: "E = E⊥·sin of the elevation within 2⁻²²/elevation (24 %) at 64 points: none is in shadow",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: || grazing(1e-6),
    },
    Case {
        name: "a_bulb_in_a_box",
        hard: "black walls 1 mm from a point, seen from 100 m: a hundred-thousandth of the way",
        elsewhere: "shadow rays are shortened by an ε (pbrt: 1e-4 of the way), which passes what hugs the lamp",
        holds: "E = 0 exactly, from four sides",
        guard: &SHADOW_LENGTH,
        without: "shadow rays end before the box",
        check: boxed,
    },
    Case {
        name: "behind_a_rectangle",
        hard: "a metre behind, and a millimetre behind its plane and beside it",
        elsewhere: "the cosine without its sign: a lamp that shines both ways",
        holds: "E = 0 exactly",
        guard: &ONE_SIDED,
        without: "the back shines",
        check: behind_a_rectangle,
    },
    Case {
        name: "behind_a_glowing_panel",
        hard: "a panel of one side, met by rays and by samples",
        elsewhere: "the cosine without its sign: a lamp that shines both ways",
        holds: "E = 0 exactly",
        guard: &ONE_SIDED,
        without: "the back shines",
        check: behind_a_panel,
    },
    Case {
        name: "in_the_plane_of_a_rectangle",
        hard: "beside a tilted lamp, 1e-7 behind its plane: cosines of either sign by rounding alone",
        elsewhere: "light at grazing angles by the cosine without its sign; 0/0 of a solid angle of 0",
        holds: "E = 0 exactly, towards it and along both normals",
        guard: &ONE_SIDED,
        without: "its back shines at a grazing angle",
        check: coplanar,
    },
    Case {
        name: "edge_on_beside_a_rectangle",
        hard: "1 mm off its edge and 1 mm below its plane, facing it: the receiver's normal is perpendicular to the lamp's",
        elsewhere: "Cornell's lamp needs 9.84 million samples by area 1 unit off its edge for 2 % (notes: bakers, C)",
        holds: "E is that of the polygon (Lambert) within 3 %, noise counted in",
        guard: &SOLID_ANGLE,
        without: "the noise is more than a tenth",
        check: edge_on,
    },
    Case {
        name: "past_a_spots_edge",
        hard: "0.01 rad beyond the outer angle",
        elsewhere: "a parabola that is not ended rises again beyond its foot",
        holds: "E = 0 exactly",
        guard: &DIMMING,
        without: "light beyond the cone",
        check: || spot_reads(0.2, 0.6, 0.61, 0.0),
    },
    Case {
        name: "within_a_spots_inner_angle",
        hard: "0.1 rad from the axis, 0.1 within the inner angle",
        elsewhere: "a parabola that is not ended goes on to rise",
        holds: "E = I/d² to 1e-5",
        guard: &DIMMING,
        without: "more light than the lamp has",
        check: || spot_reads(0.2, 0.6, 0.1, 1.0),
    },
    Case {
        name: "a_spot_of_one_angle",
        hard: "inner = outer: the smooth step has no width",
        elsewhere: "a division by 0: NaN on the edge",
        holds: "E = I/d² to 1e-5 at 1 mrad within it (Bevy's least width is 1e-4 in the cosine)",
        guard: &DIMMING,
        without: "more light than the lamp has",
        check: || spot_reads(0.5, 0.5, 0.499, 1.0),
    },
    Case {
        name: "past_a_bulbs_range",
        hard: "at the end of Bevy's window (1 − (d/range)⁴)², 0.01 % beyond it, at twice and at 10 000 times",
        elsewhere: "the square of a negative number: light grows again with distance",
        holds: "E = 0 exactly",
        guard: &DIMMING,
        without: "light beyond the range",
        check: point_range,
    },
    Case {
        name: "past_a_rectangles_range",
        hard: "the same window for a lamp with an area",
        elsewhere: "the square of a negative number: light grows again with distance",
        holds: "E = 0 exactly",
        guard: &DIMMING,
        without: "light beyond the range",
        check: rectangle_range,
    },
    Case {
        name: "a_point_10_km_from_a_tilted_floor",
        hard: "shadow rays of 10 km at 10 mrad from points with an error off their floor",
        elsewhere: GRAZING,
        holds: "E = I·cos/d² within 1e-4 at 64 points",
        guard: &ORIGIN_MOVE,
        without: "the floor shadows itself",
        check: a_far_point_over_a_floor,
    },
];

/// Straight under a square of this half side, seen full.
fn under_a_rectangle(distance: f32, half: f32, tolerance: f64) -> Verdict {
    let lamp = rectangle(askew() * Vec3::Y * distance, askew() * Vec3::NEG_Y, Vec2::splat(2.0 * half));
    let readings = by_light_at(&lit_by([Light::Rect(lamp)]), &[at(Vec3::ZERO, askew() * Vec3::Y)], 1 << 14)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(half.into(), half.into(), distance.into()), tolerance)
}

/// The same of a lamp that lies level.
fn under_a_level_rectangle(distance: f32, half: f32, tolerance: f64) -> Verdict {
    let lamp = rectangle(Vec3::Y * distance, Vec3::NEG_Y, Vec2::splat(2.0 * half));
    let readings = by_light_at(&lit_by([Light::Rect(lamp)]), &[at(Vec3::ZERO, Vec3::Y)], 1 << 14)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(half.into(), half.into(), distance.into()), tolerance)
}

/// Under the edge or the corner of a square of 1 m.
fn under_a_place(place: Vec2, distance: f32) -> Verdict {
    let lamp = rectangle(Vec3::Y * distance, Vec3::NEG_Y, Vec2::ONE);
    let point = Vec3::new(place.x, 0.0, place.y);
    let readings = by_light_at(&lit_by([Light::Rect(lamp)]), &[at(point, Vec3::Y)], 1 << 14)?;
    let part = |a: f32, b: f32| corner_parallel_rectangle(f64::from(a), f64::from(b), distance.into());
    let sides = |place: f32| [0.5 - place, 0.5 + place];
    let truth: f64 = sides(place.x).iter().flat_map(|&a| sides(place.y).map(|b| part(a, b))).sum();
    reads(&readings[0], PI * truth, 0.02)
}

/// Straight under a glowing panel of 1 m at the world's origin.
fn under_a_panel(distance: f32, tolerance: f64) -> Verdict {
    let panel = SceneBuilder::default()
        .quad("panel", Vec3::new(-0.5, 0.0, -0.5), [Vec3::X, Vec3::Z], glowing(0.0, 1.0))
        .build();
    let scene = under(panel, Affine3A::from_quat(askew()));
    let point = at(askew() * Vec3::NEG_Y * distance, askew() * Vec3::Y);
    let readings = by_light_at(&scene, &[point], 1 << 14)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(0.5, 0.5, distance.into()), tolerance)
}

/// Beside a sphere of 1 cd, or a point; a receiver inside sees it touch.
fn beside_a_bulb(radius: f32, distance: f32, tolerance: f64) -> Verdict {
    let towards = askew() * Vec3::Y;
    let readings =
        light_at(&lit_by([Light::Point(bulb(towards * distance, radius))]), &[at(Vec3::ZERO, towards)], 1 << 14)?;
    reads(&readings[0], f64::from(distance).powi(-2), tolerance)
}

/// Beside a sphere of 1 m, tilted by 60° from the way to it.
fn tilted_beside_a_bulb(distance: f32) -> Verdict {
    let elevation = 30.0_f32.to_radians();
    let place = distance * Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let reading = by_light(&lit_by([Light::Point(bulb(place, 1.0))]), 1 << 14)?;
    let half = (1.0 / f64::from(place.length()).max(1.0)).asin();
    reads(&reading, cone_above_horizon(elevation.into(), half) / PI, 0.02)
}

fn set_into_a_ceiling() -> Verdict {
    let mut room = SceneBuilder::default()
        .quad("ceiling", Vec3::new(-2.0, 1.0, -2.0), [Vec3::X * 4.0, Vec3::Z * 4.0], grey(0.0))
        .build();
    room.lights.push(Light::Rect(rectangle(Vec3::Y, Vec3::NEG_Y, Vec2::ONE)));
    let root = Affine3A::from_rotation_translation(askew(), Vec3::new(3.1, -2.7, 5.3));
    let point = at(root.transform_point3(Vec3::ZERO), askew() * Vec3::Y);
    let readings = light_at(&under(room, root), &[point], 1 << 12)?;
    reads(&readings[0], 4.0 * PI * corner_parallel_rectangle(0.5, 0.5, 1.0), 0.01)
}

/// Relative variance of a path's worth half a millimetre under the lamp of a room over that at its floor's middle.
fn variance() -> Verdict {
    let room = lit_room(0.5, 10.0);
    let relative = |point: Vec3| -> Result<f64, String> {
        let (mut mean, mut variance) = (0.0, 0.0);
        for seed in 0..256 {
            // One path for each replicate: their spread is that of single paths.
            let reading = &light_by(&room, &[at(point, Vec3::Y)], 16, Transport { seed, ..Transport::default() })?[0];
            mean += luminance(reading.irradiance) / 256.0;
            variance += luminance(reading.stderr).powi(2) * 16.0 / 256.0;
        }
        Ok(variance / (mean * mean))
    };
    let (near, far) = (relative(Vec3::new(2.0, 3.9 - 5e-4, 2.0))?, relative(Vec3::new(2.0, 0.0, 2.0))?);
    ensure(near <= 10.0 * far, || format!("relative variance of {near:.3} under the lamp and {far:.3} on the floor"))
}

/// A sun of no width, by directions of the surface alone, which never meet it.
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

/// ∫ max(0, cos) over a cone of directions about an axis at this elevation above the horizon; midpoints.
fn cone_above_horizon(elevation: f64, half_angle: f64) -> f64 {
    let (rings, spokes) = (400, 400);
    let mut sum = 0.0;
    for ring in 0..rings {
        let angle = (ring as f64 + 0.5) / rings as f64 * half_angle;
        for spoke in 0..spokes {
            let turn = (spoke as f64 + 0.5) / spokes as f64 * TAU;
            let height = angle.cos() * elevation.sin() + angle.sin() * turn.cos() * elevation.cos();
            sum += height.max(0.0) * angle.sin();
        }
    }
    sum * half_angle / rings as f64 * TAU / spokes as f64
}

/// A sun whose middle is below the horizon, beside a bulb, by light sampling alone.
fn sun_at(diameter: f32, elevation: f32) -> Verdict {
    let towards = Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let reading = by_light(&lit_by([Light::Directional(sun(towards, diameter)), dim()]), 1 << 15)?;
    let half = 0.5 * f64::from(diameter);
    let radiance = 1.0 / (PI * half.sin().powi(2));
    reads(&reading, radiance * cone_above_horizon(elevation.into(), half) + 1e-8, 0.02)
}

/// A point of a millionth of a candela, 10 m above.
fn dim() -> Light {
    let id = StableId::new("dim");
    Light::Point(PointLight { id, intensity: Vec3::splat(1e-6), ..bulb(Vec3::Y * 10.0, 0.0) })
}

fn by_light(scene: &Scene, samples: u32) -> Result<MeterReading, String> {
    Ok(by_light_at(scene, &[at(Vec3::ZERO, Vec3::Y)], samples)?[0])
}

/// The light at points by samples on lamps alone: surface rays would find a near lamp, and hide how it is sampled.
fn by_light_at(scene: &Scene, points: &[MeterPoint], samples: u32) -> Result<Vec<MeterReading>, String> {
    light_by(scene, points, samples, Transport { estimator: Estimator::Light, ..Transport::default() })
}

fn bulb_at_the_horizon() -> Verdict {
    let (radius, distance, elevation) = (0.3_f32, 2.0_f32, -0.05_f32);
    let place = distance * Vec3::new(elevation.cos(), elevation.sin(), 0.0);
    let reading = by_light(&lit_by([Light::Point(bulb(place, radius)), dim()]), 1 << 15)?;
    let radiance = 1.0 / (PI * f64::from(radius).powi(2));
    let half = f64::from(radius / distance).asin();
    reads(&reading, radiance * cone_above_horizon(elevation.into(), half) + 1e-8, 0.02)
}

fn rectangle_at_the_horizon() -> Verdict {
    let lamp = rectangle(Vec3::new(1.0, -0.1, 0.0), Vec3::NEG_X, Vec2::ONE);
    let reading = by_light(&lit_by([Light::Rect(lamp), dim()]), 1 << 14)?;
    let corners = [(-0.5, -0.6), (0.5, -0.6), (0.5, 0.4), (-0.5, 0.4)].map(|(z, y)| DVec3::new(1.0, y, z));
    reads(&reading, polygon_irradiance(&corners, DVec3::Y) + 1e-8, 0.02)
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

/// A bulb in a black box whose walls are 1 mm from it, seen from 100 m.
fn boxed() -> Verdict {
    let side = || grey(0.0);
    let near = Vec3::splat(1e-3);
    let mut scene = SceneBuilder::default().room(-near, near, [side(), side(), side(), side(), side(), side()]).build();
    scene.lights.push(Light::Point(bulb(Vec3::ZERO, 0.0)));
    let scene = under(scene, Affine3A::from_quat(askew()));
    let points =
        [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.48, 0.6, 0.64)].map(|way| at(way * 100.0, -way));
    let readings = light_at(&scene, &points, 16)?;
    dark(&readings)
}

fn dark(readings: &[MeterReading]) -> Verdict {
    readings.iter().try_for_each(|reading| {
        ensure(reading.irradiance == DVec3::ZERO, || format!("E is {}, not 0", reading.irradiance))
    })
}

fn behind_a_rectangle() -> Verdict {
    let scene = lit_by([Light::Rect(rectangle(Vec3::Y, Vec3::Y, Vec2::ONE))]);
    dark(&light_at(&scene, &[at(Vec3::ZERO, Vec3::Y), at(Vec3::new(0.9, 0.999, 0.0), Vec3::Y)], 1 << 10)?)
}

fn behind_a_panel() -> Verdict {
    let scene = SceneBuilder::default()
        .quad("panel", Vec3::new(-0.5, 1.0, -0.5), [Vec3::Z, Vec3::X], glowing(0.0, 1.0))
        .build();
    dark(&light_at(&scene, &[at(Vec3::ZERO, Vec3::Y), at(Vec3::new(0.9, 0.999, 0.0), Vec3::Y)], 1 << 10)?)
}

/// In the plane of a rectangle, beside it, towards it and along its normals.
fn coplanar() -> Verdict {
    let lamp = rectangle(Vec3::ZERO, askew() * Vec3::NEG_Y, Vec2::ONE);
    let point = askew() * Vec3::new(1.5, 1e-7, 0.1);
    let facing = [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y].map(|way| at(point, askew() * way));
    dark(&light_at(&lit_by([Light::Rect(lamp)]), &facing, 1 << 10)?)
}

/// A millimetre off the edge of a rectangle and below its plane, facing it edge-on.
fn edge_on() -> Verdict {
    let scene = lit_by([Light::Rect(rectangle(Vec3::ZERO, Vec3::NEG_Y, Vec2::ONE))]);
    let place = Vec3::new(0.501, -1e-3, 0.0);
    let readings = by_light_at(&scene, &[at(place, Vec3::NEG_X)], 1 << 14)?;
    let corners =
        [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| DVec3::new(x, 0.0, z) - place.as_dvec3());
    reads(&readings[0], polygon_irradiance(&corners, DVec3::NEG_X), 0.03)
}

/// Below a spot, at an angle from its axis: what share of its intensity is left.
fn spot_reads(inner: f32, outer: f32, angle: f32, share: f64) -> Verdict {
    let scene = lit_by([Light::Spot(spot(Vec3::ZERO, inner, outer))]);
    let way = Vec3::new(angle.sin(), -angle.cos(), 0.0);
    let readings = light_at(&scene, &[at(2.0 * way, -way)], 16)?;
    if share == 0.0 { dark(&readings) } else { reads(&readings[0], 0.25 * share, 1e-5) }
}

fn point_range() -> Verdict {
    let scene = lit_by([Light::Point(PointLight { range: Some(3.0), ..bulb(Vec3::ZERO, 0.0) })]);
    dark(&light_at(&scene, &[3.0003, 3.0, 6.0, 3e4].map(|x| at(Vec3::X * x, Vec3::NEG_X)), 16)?)
}

fn rectangle_range() -> Verdict {
    let lamp = RectLight { range: Some(3.0), ..rectangle(Vec3::ZERO, Vec3::X, Vec2::ONE) };
    dark(&light_at(&lit_by([Light::Rect(lamp)]), &[3.0003, 3.0, 6.0, 3e4].map(|x| at(Vec3::X * x, Vec3::NEG_X)), 64)?)
}

fn a_far_point_over_a_floor() -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-3.0, 0.0, -3.0), [Vec3::Z * 6.0, Vec3::X * 6.0], grey(0.5))
        .build();
    scene.lights.push(Light::Point(bulb(Vec3::new(1e4, 1e2, 0.0), 0.0)));
    let scene = under(scene, Affine3A::from_rotation_translation(askew(), Vec3::new(5.1, 7.3, -4.9)));
    let root = Affine3A::from_rotation_translation(askew(), Vec3::new(5.1, 7.3, -4.9));
    let places: Vec<Vec3> =
        (0..64).map(|i| Vec3::new((i % 8) as f32 * 0.7 - 2.5, 0.0, (i / 8) as f32 * 0.7 - 2.4)).collect();
    let points: Vec<_> = places.iter().map(|&place| at(root.transform_point3(place), askew() * Vec3::Y)).collect();
    let readings = light_at(&scene, &points, 16)?;
    places.iter().zip(&readings).try_for_each(|(place, reading)| {
        let offset = DVec3::new(1e4, 1e2, 0.0) - place.as_dvec3();
        reads(reading, offset.y / offset.length().powi(3), 1e-4)
    })
}

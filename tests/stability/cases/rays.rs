//! Where rays start, what they meet: nothing of the surface that they leave, everything of its neighbours.

use crate::case::{Case, Verdict};
use crate::common::meter::{at, by, on_walls};
use crate::common::scenes::{SceneBuilder, furnace, glowing, grey};
use crate::guards::crossings::{
    ANSWER_BELOW_THE_END, BEFORE_THE_END, BEHIND_THE_START, ERROR_BOUND, ERROR_OF_T, ERROR_PER_AXIS, EXACT_EDGES,
    FAR_ORIGINS, FAR_TARGETS, METER_ROUNDING, NEAREST_SURFACE, NO_MINUS_ZERO, PADDING, SIDE_IN_F64, TRACED_FRAME,
};
use crate::judge::{agree, all_read, baked, ensure, light_at, light_by, mean_reads};
use crate::worlds::under;
use bevy_kiln::artefact::StableId;
use bevy_kiln::bake::{BakeSettings, Goal};
use bevy_kiln::math::{combine, corner_parallel_rectangle};
use bevy_kiln::scene::{Light, PointLight};
use bevy_kiln::trace::{Estimator, Tracer};
use glam::{Affine3A, Quat, Vec3};
use std::f64::consts::PI;

pub const CASES: &[Case] = &[
    Case {
        name: "a_level_floor_at_height_0",
        hard: "points lie exactly on the plane: a distance to it is nothing but rounding, of either sign",
        elsewhere: "surfaces meet the rays that leave them: dark specks, cured by a bias that someone must choose",
        holds: "E/π = 1 to 1e-6 in each of 900 texels under a sky of 1",
        guard: &ERROR_OF_T,
        without: "rays end on the floor that they leave",
        check: level_floor,
    },
    Case {
        name: "a_turned_furnace",
        hard: "rounding differs from point to point of a tilted wall; 100 bounces multiply each loss",
        elsewhere: "a bound by trial and error, which some triangle exceeds",
        holds: "E = π/(1 − ρ) within 1.5 %, ρ = 0.99",
        guard: &ERROR_BOUND,
        without: "some rays end on the wall that they leave",
        check: || furnace_under(turn(), 0.99, 0.015),
    },
    Case {
        name: "corners_of_a_closed_furnace",
        hard: "in a corner the wall that a ray leaves and the wall that it meets are the same distance away: none",
        elsewhere: "hits nearer than an ε are dropped, or all are kept",
        holds: "E = π/(1 − ρ) within 1.5 %, ρ = 0.99",
        guard: &BEHIND_THE_START,
        without: "walls meet rays that have left them",
        check: || furnace_under(Affine3A::IDENTITY, 0.99, 0.015),
    },
    Case {
        name: "a_plate_half_a_millimetre_above_a_kilometre_of_floor",
        hard: "coordinates of 500 m and a gap of 0.5 mm: one number's rounding is 0.06 mm",
        elsewhere: "one error for all axes (1 mm here) or a constant bias: rays start above the plate",
        holds: "E below 1e-4 of the open sky's under a plate of 10 m",
        guard: &ERROR_PER_AXIS,
        without: "the sky shines through the plate",
        check: || under_a_plate(5e-4),
    },
    Case {
        name: "a_plate_a_hundredth_of_a_millimetre_above_it",
        hard: "the plate lies within the rounding of any distance that is computed there",
        elsewhere: "hits within the error of their distance are dropped, as if they were the surface left",
        holds: "E below 1e-4 of the open sky's under a plate of 10 m",
        guard: &SIDE_IN_F64,
        without: "the sky shines through the plate",
        check: || under_a_plate(1e-5),
    },
    Case {
        name: "a_lamp_is_not_in_its_own_way",
        hard: "a shadow ray ends on a lamp that is a surface itself, level at height 0, 100 m away",
        elsewhere: "the ray is shortened by an ε: what stands before the lamp is missed, or the lamp shadows itself",
        holds: "E by light samples within 0.5 % of the form factor",
        guard: &BEFORE_THE_END,
        without: "the lamp shadows itself at some points",
        check: lamp_in_its_own_way,
    },
    Case {
        name: "one_step_behind_a_wall",
        hard: "a point that is one f32 behind a wall",
        elsewhere: "the last thousandth of the way is not looked at",
        holds: "no one of 100 000 points is seen",
        guard: &ANSWER_BELOW_THE_END,
        without: "some are seen through the wall",
        check: one_step_behind,
    },
    Case {
        name: "rays_into_edges_and_corners",
        hard: "rays at vertices and edges of a closed box, where boxes of the tree are flat and meet",
        elsewhere: "rays pass between two triangles",
        holds: "no one of 100 000 rays passes",
        guard: &PADDING,
        without: "the tree misses boxes by rounding",
        check: into_corners,
    },
    Case {
        name: "rays_along_the_axes",
        hard: "directions with components 0 and −0",
        elsewhere: "0·∞ in the slab test",
        holds: "no one of 208 directions passes",
        guard: &NO_MINUS_ZERO,
        without: "rays with −0 meet nothing",
        check: along_the_axes,
    },
    Case {
        name: "needles_of_a_tenth_of_a_micrometre",
        hard: "triangles 1 m long and 1e-7 m wide, which a ray's own rounding is as wide as",
        elsewhere: "f32 edge functions are 0 on both sides",
        holds: "each needle around a ray's own line is met, as the signs of exact products say",
        guard: &EXACT_EDGES,
        without: "many are passed",
        check: needles,
    },
    Case {
        name: "a_table_at_100_km",
        hard: "the f32 grid at 1e5 m is 7.8 mm wide: points between the vertices have no place on it",
        elsewhere: "bakes drift with the distance from the origin, until light comes through tables",
        holds: "the light of home within 10 %: the vertices lie on the grid there too",
        guard: &TRACED_FRAME,
        without: "light comes through the table",
        check: far_table,
    },
    Case {
        name: "rays_from_a_thousand_kilometres",
        hard: "an origin 1e6 scenes away: products of three coordinates overflow, their rounding is larger than the scene",
        elsewhere: "f32 overflows, or the ray's rounding is larger than the scene",
        holds: "each of 1000 rays meets the box",
        guard: &FAR_ORIGINS,
        without: "some miss it",
        check: from_afar,
    },
    Case {
        name: "a_lamp_at_1e12_metres",
        hard: "a shadow ray whose length squared is 1e24 and whose blocker is 1 m away",
        elsewhere: "the end's rounding is larger than the scene",
        holds: "black in the roof's shadow, E = I/d² beside it within 1e-5",
        guard: &FAR_TARGETS,
        without: "light comes through the roof",
        check: lamp_afar,
    },
    Case {
        name: "meters_on_walls_at_100_km",
        hard: "a meter's own coordinates round to 7.8 mm there: it is beside its wall, or behind it",
        elsewhere: "it reads what is behind the wall",
        holds: "every point reads E = π/(1 − ρ) within 2 %, ρ = 0.5, on tilted walls",
        guard: &METER_ROUNDING,
        without: "those behind a wall read nothing",
        check: meters_far_away,
    },
    Case {
        name: "a_meter_in_a_gap_of_10_micrometres",
        hard: "two plates are nearer than what counts as on a surface",
        elsewhere: "the meter snaps to the other plate",
        holds: "E = π within 1.5 % from the plate above",
        guard: &NEAREST_SURFACE,
        without: "it reads the dark above the upper plate",
        check: narrow_gap,
    },
];

/// An awkward rotation.
fn turn() -> Affine3A {
    Affine3A::from_quat(Quat::from_scaled_axis(Vec3::new(0.3, -1.1, 0.7)))
}

/// A number in [0, 1) for a count.
fn unit(seed: u64, count: u64) -> f32 {
    (combine(seed, count) >> 40) as f32 / (1_u32 << 24) as f32
}

/// A point of the cube [−1, 1]³ for a count.
fn point(seed: u64, count: u64) -> Vec3 {
    Vec3::from_array([0, 1, 2].map(|axis| 2.0 * unit(combine(seed, axis), count) - 1.0))
}

fn level_floor() -> Verdict {
    let edges = [Vec3::Z * 10.0, Vec3::X * 10.0];
    let floor = SceneBuilder::default().quad("floor", Vec3::new(-5.3, 0.0, -4.1), edges, grey(0.5));
    let scene = floor.sky(Vec3::ONE).build();
    let settings = BakeSettings { goal: Goal::Samples(64), density: 3.0, ..BakeSettings::default() };
    let page = baked(&scene, &settings)?.pages.swap_remove(0);
    let texels = page.raw.iter().zip(&page.coverage).filter(|(_, coverage)| **coverage > 0.0);
    let darkest = texels.map(|(value, _)| value.x).fold(f32::INFINITY, f32::min);
    ensure((darkest - 1.0).abs() < 1e-6, || format!("a texel has E/π = {darkest}"))
}

fn furnace_under(root: Affine3A, albedo: f32, tolerance: f64) -> Verdict {
    let scene = under(furnace(albedo), root);
    // In mid-air, so that where a meter lies on a wall is of no weight.
    let points: Vec<_> = (0..48).map(|count| at(root.transform_point3(0.7 * point(2, count)), Vec3::Y)).collect();
    mean_reads(&light_by(&scene, &points, 512, by(Estimator::Bsdf))?, PI / (1.0 - f64::from(albedo)), tolerance)
}

fn under_a_plate(gap: f32) -> Verdict {
    let scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-500.0, 0.0, -500.0), [Vec3::Z * 1000.0, Vec3::X * 1000.0], grey(0.0))
        .quad("plate", Vec3::new(395.0, gap, 395.0), [Vec3::Z * 10.0, Vec3::X * 10.0], grey(0.0))
        .sky(Vec3::ONE)
        .build();
    let points: Vec<_> = (0..16)
        .map(|count| at(Vec3::new(400.0, 0.0, 400.0) + Vec3::new(3.0, 0.0, 3.0) * point(3, count), Vec3::Y))
        .collect();
    let readings = light_at(&scene, &points, 256)?;
    let brightest = readings.iter().map(|reading| reading.irradiance.x).fold(0.0, f64::max);
    ensure(readings.len() == 16 && brightest < 1e-4 * PI, || format!("E is {brightest} under the plate"))
}

fn lamp_in_its_own_way() -> Verdict {
    let scene = SceneBuilder::default()
        .quad("lamp", Vec3::new(-0.5, 0.0, -0.5), [Vec3::Z, Vec3::X], glowing(0.0, 1.0))
        .quad("ceiling", Vec3::new(-5.0, 100.0, -5.0), [Vec3::X * 10.0, Vec3::Z * 10.0], grey(0.0))
        .build();
    let truth = 4.0 * PI * corner_parallel_rectangle(0.5, 0.5, 100.0);
    let readings = light_by(&scene, &[at(Vec3::new(0.0, 100.0, 0.0), Vec3::NEG_Y)], 1 << 12, by(Estimator::Light))?;
    all_read(&readings, truth, 5e-3)
}

fn one_step_behind() -> Verdict {
    let wall =
        SceneBuilder::default().quad("wall", Vec3::new(-9.0, -9.0, 0.3), [Vec3::X * 18.0, Vec3::Y * 18.0], grey(0.5));
    let tracer = Tracer::new(&wall.build());
    let seen = (0..100_000).filter(|&count| {
        let to = (2.0 * point(4, count)).with_z(0.3_f32.next_up());
        tracer.is_visible(point(5, count).with_z(-1.0 - unit(6, count)), to)
    });
    let seen = seen.count();
    ensure(seen == 0, || format!("{seen} of 100000 are seen"))
}

fn into_corners() -> Verdict {
    let tracer = Tracer::new(&furnace(0.5));
    let passed = (0..100_000).filter(|&count| {
        let from = 0.9 * point(7, count);
        // A corner, or a point on an edge.
        let corner = point(8, count).signum();
        let target = if count % 2 == 0 { corner } else { corner.with_x(point(9, count).x) };
        tracer.closest_hit(from, (target - from).normalize()).is_none()
    });
    let passed = passed.count();
    ensure(passed == 0, || format!("{passed} of 100000 rays pass"))
}

fn along_the_axes() -> Verdict {
    let tracer = Tracer::new(&furnace(0.5));
    let components = [1.0, -1.0, 0.0, -0.0, 0.5, -0.5];
    let mut counts = [0; 2];
    for x in components {
        for y in components {
            for z in components {
                if let Some(direction) = Vec3::new(x, y, z).try_normalize() {
                    counts[0] += 1;
                    counts[1] += u32::from(tracer.closest_hit(Vec3::ZERO, direction).is_none());
                }
            }
        }
    }
    ensure(counts == [208, 0], || format!("{} of {} directions pass", counts[1], counts[0]))
}

fn needles() -> Verdict {
    let mut counts = [0; 2];
    for count in 0..4000 {
        // Around the ray's own line, so that nothing is rounded but the edge functions themselves.
        let (along, aside) = (point(10, count), 1e-7 * point(11, count));
        let corners = [-along, along + aside, along - unit(12, count) * aside].map(|corner| corner.with_z(1.0));
        let edge = |a: Vec3, b: Vec3| f64::from(a.x) * f64::from(b.y) - f64::from(a.y) * f64::from(b.x);
        let [a, b, c] = corners;
        let edges = [edge(a, b), edge(b, c), edge(c, a)];
        if edges.iter().all(|&edge| edge > 0.0) || edges.iter().all(|&edge| edge < 0.0) {
            let needle = SceneBuilder::default().mesh("needle", corners.to_vec(), vec![0, 1, 2], None, grey(0.5));
            counts[0] += 1;
            counts[1] += u32::from(Tracer::new(&needle.build()).closest_hit(Vec3::ZERO, Vec3::Z).is_none());
        }
    }
    let [rays, missed] = counts;
    ensure(rays > 200 && missed == 0, || format!("{missed} of {rays} needles are passed"))
}

fn far_table() -> Verdict {
    // On the grid of eighths, which f32 has at 1e5 m too.
    let scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-8.0, 0.0, -8.0), [Vec3::Z * 16.0, Vec3::X * 16.0], grey(0.5))
        .quad("table", Vec3::new(-0.5, 0.125, -0.5), [Vec3::Z, Vec3::X], grey(0.5))
        .sky(Vec3::ONE)
        .build();
    let points = |place: Vec3| {
        [Vec3::ZERO, Vec3::new(0.25, 0.0, 0.375), Vec3::new(-0.375, 0.0, 0.5)].map(|p| at(place + p, Vec3::Y))
    };
    let place = Vec3::splat(1e5);
    let far = under(scene.clone(), Affine3A::from_translation(place));
    // Meters at different places have different random numbers.
    let (there, home) = (light_at(&far, &points(place), 1 << 12)?, light_at(&scene, &points(Vec3::ZERO), 1 << 12)?);
    there.iter().zip(&home).try_for_each(|(there, home)| agree(there, home, 0.1))
}

fn from_afar() -> Verdict {
    let tracer = Tracer::new(&furnace(0.5));
    let missed = (0..1000).filter(|&count| {
        let aim = 0.9 * point(13, count);
        let hit = tracer.closest_hit(aim.with_x(1e6), Vec3::NEG_X);
        hit.is_none_or(|hit| (hit.distance - 999_999.0).abs() > 0.25)
    });
    let missed = missed.count();
    ensure(missed == 0, || format!("{missed} of 1000 rays miss the box"))
}

fn lamp_afar() -> Verdict {
    let mut scene = SceneBuilder::default()
        .quad("floor", Vec3::new(-2.0, 0.0, -2.0), [Vec3::Z * 4.0, Vec3::X * 4.0], grey(0.0))
        .quad("roof", Vec3::new(-0.5, 1.0, -0.5), [Vec3::Z, Vec3::X], grey(0.0))
        .build();
    scene.lights.push(Light::Point(PointLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        position: Vec3::new(0.0, 1e12, 0.0),
        radius: 0.0,
        intensity: Vec3::splat(1e24),
        range: None,
    }));
    let readings = light_at(&scene, &[at(Vec3::ZERO, Vec3::Y), at(Vec3::new(1.5, 0.0, 0.0), Vec3::Y)], 16)?;
    ensure(readings[0].irradiance.x == 0.0, || format!("E is {} under the roof", readings[0].irradiance.x))?;
    all_read(&readings[1..], 1.0, 1e-5)
}

fn meters_far_away() -> Verdict {
    let root = Affine3A::from_translation(Vec3::new(1e5, -1e5, 1e5)) * turn() * Affine3A::from_scale(Vec3::splat(2.0));
    let points: Vec<_> = on_walls(Vec3::NEG_ONE, Vec3::ONE, 4)
        .into_iter()
        .map(|point| at(root.transform_point3(point.position), root.transform_vector3(point.normal)))
        .collect();
    all_read(&light_at(&under(furnace(0.5), root), &points, 1 << 12)?, 2.0 * PI, 0.02)
}

fn narrow_gap() -> Verdict {
    let scene = SceneBuilder::default()
        .quad("low", Vec3::new(-2.0, 0.0, -2.0), [Vec3::Z * 4.0, Vec3::X * 4.0], grey(0.0))
        .quad("high", Vec3::new(-2.0, 1e-5, -2.0), [Vec3::X * 4.0, Vec3::Z * 4.0], glowing(0.0, 1.0))
        .build();
    all_read(&light_at(&scene, &[at(Vec3::new(0.3, 0.0, -0.4), Vec3::Y)], 1 << 11)?, PI, 0.015)
}

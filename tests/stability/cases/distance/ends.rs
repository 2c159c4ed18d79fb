//! Where a lamp's light ends: behind it, in its plane, beyond its cone and beyond its range.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing};
use crate::guards::light::{DIMMING, ONE_SIDED};
use crate::judge::{all_dark, light_at, reads};
use crate::things::{bulb, lit_by, rectangle, spot};
use crate::worlds::askew;
use bevy_kiln::scene::{Light, PointLight, RectLight};
use glam::{Vec2, Vec3};

const BOTH_WAYS: &str = "the cosine without its sign: a lamp that shines both ways";
const RISES_AGAIN: &str = "the square of a negative number: light grows again with distance";

pub const CASES: &[Case] = &[
    Case {
        name: "behind_a_rectangle",
        hard: "a metre behind, and a millimetre behind its plane and beside it",
        elsewhere: BOTH_WAYS,
        holds: "E = 0 exactly",
        guard: &ONE_SIDED,
        without: "the back shines",
        check: behind_a_rectangle,
    },
    Case {
        name: "behind_a_glowing_panel",
        hard: "a panel of one side, met by rays and by samples",
        elsewhere: BOTH_WAYS,
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
        name: "within_a_spots_inner_angle",
        hard: "0.1 rad from the axis, 0.1 within the inner angle",
        elsewhere: "a parabola that is not ended goes on to rise",
        holds: "E = I/d² to 1e-5: f32 rounds the way and its cosine",
        guard: &DIMMING,
        without: "more light than the lamp has",
        check: || spot_reads(0.2, 0.6, 0.1, 1.0),
    },
    Case {
        name: "a_spot_of_one_angle",
        hard: "inner = outer: the smooth step has no width",
        elsewhere: "a division by 0: NaN on the edge",
        holds: "E = I/d² to 1e-5 at 1 mrad within it: f32 rounds the way and its cosine (Bevy's least width is 1e-4 in \
                the cosine)",
        guard: &DIMMING,
        without: "more light than the lamp has",
        check: || spot_reads(0.5, 0.5, 0.499, 1.0),
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
        name: "past_a_bulbs_range",
        hard: "at the end of Bevy's window (1 − (d/range)⁴)², 0.01 % beyond it, at twice and at 10 000 times",
        elsewhere: RISES_AGAIN,
        holds: "E = 0 exactly",
        guard: &DIMMING,
        without: "light beyond the range",
        check: point_range,
    },
    Case {
        name: "past_a_rectangles_range",
        hard: "the same window for a lamp with an area",
        elsewhere: RISES_AGAIN,
        holds: "E = 0 exactly",
        guard: &DIMMING,
        without: "light beyond the range",
        check: rectangle_range,
    },
];

fn behind_a_rectangle() -> Verdict {
    let scene = lit_by([Light::Rect(rectangle(Vec3::Y, Vec3::Y, Vec2::ONE))]);
    all_dark(&light_at(&scene, &[at(Vec3::ZERO, Vec3::Y), at(Vec3::new(0.9, 0.999, 0.0), Vec3::Y)], 1 << 10)?)
}

fn behind_a_panel() -> Verdict {
    let scene = SceneBuilder::default()
        .quad("panel", Vec3::new(-0.5, 1.0, -0.5), [Vec3::Z, Vec3::X], glowing(0.0, 1.0))
        .build();
    all_dark(&light_at(&scene, &[at(Vec3::ZERO, Vec3::Y), at(Vec3::new(0.9, 0.999, 0.0), Vec3::Y)], 1 << 10)?)
}

/// In the plane of a rectangle, beside it, towards it and along its normals.
fn coplanar() -> Verdict {
    let lamp = rectangle(Vec3::ZERO, askew() * Vec3::NEG_Y, Vec2::ONE);
    let point = askew() * Vec3::new(1.5, 1e-7, 0.1);
    let facing = [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y].map(|way| at(point, askew() * way));
    all_dark(&light_at(&lit_by([Light::Rect(lamp)]), &facing, 1 << 10)?)
}

/// Below a spot, at an angle from its axis: what share of its intensity is left.
fn spot_reads(inner: f32, outer: f32, angle: f32, share: f64) -> Verdict {
    let scene = lit_by([Light::Spot(spot(Vec3::ZERO, inner, outer))]);
    let way = Vec3::new(angle.sin(), -angle.cos(), 0.0);
    let readings = light_at(&scene, &[at(2.0 * way, -way)], 16)?;
    if share == 0.0 { all_dark(&readings) } else { reads(&readings[0], 0.25 * share, 1e-5) }
}

fn point_range() -> Verdict {
    let scene = lit_by([Light::Point(PointLight { range: Some(3.0), ..bulb(Vec3::ZERO, 0.0) })]);
    all_dark(&light_at(&scene, &[3.0003, 3.0, 6.0, 3e4].map(|x| at(Vec3::X * x, Vec3::NEG_X)), 16)?)
}

fn rectangle_range() -> Verdict {
    let lamp = RectLight { range: Some(3.0), ..rectangle(Vec3::ZERO, Vec3::X, Vec2::ONE) };
    all_dark(&light_at(
        &lit_by([Light::Rect(lamp)]),
        &[3.0003, 3.0, 6.0, 3e4].map(|x| at(Vec3::X * x, Vec3::NEG_X)),
        64,
    )?)
}

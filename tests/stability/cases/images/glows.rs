//! Surfaces that glow by a picture or beyond all numbers, and surfaces that are there in part.

use super::{SPREADS, sky, under_map};
use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::bake::LIGHT_ONLY;
use crate::guards::texture::{EMISSION_IN_BOUNDS, PRESENCE, TEXTURED_GLOW};
use crate::judge::{ensure, is_refused, light_at, reads, same_but_for_rounding};
use crate::things::{level, picture};
use bevy_kiln::bake::{BakeWarning, CancelToken, MeterReading, MeterSettings, measure_irradiance};
use bevy_kiln::math::polygon_irradiance;
use bevy_kiln::scene::{Alpha, Filter, Material, Scene, TextureRef, UvChannel, Wrap};
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

pub const CASES: &[Case] = &[
    Case {
        name: "a_lamp_with_one_bright_texel",
        hard: "a texel in 1024 of a lamp's picture gives all of its light",
        elsewhere: "a lamp of the picture's mean colour",
        holds: "E is that of the texel alone, by Lambert's polygon, within 4 %",
        guard: &TEXTURED_GLOW,
        without: "the lamp shines as if its picture were white",
        check: one_bright_texel,
    },
    Case {
        name: "a_lamp_of_1e30",
        hard: "an emission whose square is no f32",
        elsewhere: "∞ in the choice of a light: all others go dark",
        holds: "refused by name; the rest is lit as if it were not there",
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || {
            let mut scene = under_map(sky([4, 2], |_, _| 1.0));
            scene.materials[0].emitted_radiance = Vec3::splat(1e30);
            is_refused(&scene, "material \"albedo 0\" has an emission of 1e30, above 1e25")
        },
    },
    Case {
        name: "an_emission_beyond_f32",
        hard: "a lamp of 1e18 times a texel of 1e38: no number holds the product",
        elsewhere: SPREADS,
        holds: "paths that meet it are left out, counted and reported; the rest of the light is π less the lamp's form \
                factor to 1 % and the share left out",
        guard: &LIGHT_ONLY,
        without: "∞ in a mean",
        check: beyond_f32,
    },
    Case {
        name: "alpha_of_0_and_1e_40",
        hard: "a surface that is not there, and one that a denormal number says is there",
        elsewhere: "division by a chance of 0",
        holds: "E is what it is without the first to 1e-6, as f32 rounds, and without the second within 1 %",
        guard: &PRESENCE,
        without: "a thousandth of all paths ends at nothing, the others weigh more",
        check: barely_there,
    },
];

/// A lamp above the ground with one texel in 32 × 32.
fn spark(texel: f32, strength: f32) -> Scene {
    let lamp = [2.0 * Vec3::X, 2.0 * Vec3::Z];
    let mut scene = SceneBuilder::default()
        .quad("ground", Vec3::new(-5.0, 0.0, -5.0), [10.0 * Vec3::Z, 10.0 * Vec3::X], grey(0.0))
        .quad("lamp", Vec3::new(-1.0, 1.0, -1.0), lamp, glowing(0.0, strength))
        .build();
    let texels: Vec<[f32; 4]> =
        (0..1024).map(|index| if index == 32 * 12 + 20 { [texel, texel, texel, 1.0] } else { [0.0; 4] }).collect();
    scene.textures = vec![picture([32, 32], texels, Wrap::Clamp, Filter::Nearest)];
    scene.materials[1].emission_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv1 });
    scene
}

fn one_bright_texel() -> Verdict {
    let scene = spark(1000.0, 1.0);
    // Column 20 of 32 along X, row 12 along Z.
    let corner = Vec3::new(-1.0 + 20.0 / 16.0, 1.0, -1.0 + 12.0 / 16.0);
    let step = 1.0 / 16.0;
    let texel = [Vec3::ZERO, step * Vec3::X, step * (Vec3::X + Vec3::Z), step * Vec3::Z].map(|offset| corner + offset);
    let point = Vec3::new(0.3, 0.0, -0.2);
    let truth = 1000.0 * polygon_irradiance(&texel.map(|corner| (corner - point).as_dvec3()), DVec3::Y).abs();
    reads(&light_at(&scene, &[at(point, Vec3::Y)], 1 << 20)?[0], truth, 4e-2)
}

fn beyond_f32() -> Verdict {
    let mut scene = spark(1e38, 1e18);
    scene.sky_radiance = Vec3::ONE;
    let point = at(Vec3::new(4.0, 0.0, -0.2), Vec3::Y);
    let settings = MeterSettings { samples_per_point: 1 << 14, ..MeterSettings::default() };
    let measured = measure_irradiance(&scene, &[point], &settings, &(), &CancelToken::default());
    let measured = measured.map_err(|error| error.to_string())?;
    let count = measured.report.warnings.iter().find_map(|warning| match warning {
        BakeWarning::NotLight { paths } => Some(*paths),
        _ => None,
    });
    ensure(count.is_some_and(|count| count > 0), || format!("{:?}", measured.report.warnings))?;
    // The sky beside the lamp, less what the paths that were left out would have brought of it.
    let lost = count.unwrap_or(0) as f64 / f64::from(1 << 14);
    let lamp = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, z]| (Vec3::new(x, 1.0, z) - point.position).as_dvec3());
    let open = PI - polygon_irradiance(&lamp, DVec3::Y).abs();
    let reading = &measured.readings[0];
    ensure(reading.irradiance.is_finite() && (reading.irradiance.x - open).abs() <= (0.01 + lost) * open, || {
        format!("E is {} of {open}, {lost} of the paths lost", reading.irradiance.x)
    })
}

/// Light on the ground under a sky, below a screen of this opacity.
fn screened(opacity: Option<f32>) -> Result<Vec<MeterReading>, String> {
    let mut builder = level(SceneBuilder::default(), "ground", 0.0, [1.0, 1.0], grey(0.5));
    if let Some(opacity) = opacity {
        let mut material = Material { alpha: Alpha::Blend, ..grey(0.5) };
        material.base_colour.w = opacity;
        builder = level(builder, "screen", 0.5, [1000.0, 1.0], material);
    }
    light_at(&builder.sky(Vec3::ONE).build(), &[at(Vec3::ZERO, Vec3::Y), at(Vec3::X * 0.5, Vec3::Y)], 1 << 12)
}

fn barely_there() -> Verdict {
    let open = screened(None)?;
    same_but_for_rounding(&screened(Some(0.0))?, &open, 1e-6)?;
    reads(&screened(Some(1e-40))?[0], open[0].irradiance.x, 1e-2)
}

//! Pictures that come in and go out: skies, textures, and what a file's format can hold.

use crate::case::{Case, Verdict};
use crate::common::meter::at;
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::bake::{LIGHT_ONLY, NO_LIGHT_REFUSED};
use crate::guards::output::{HELD_TO_FORMAT, ROUNDED_AS_SPECIFIED};
use crate::guards::texture::{
    EMISSION_IN_BOUNDS, LOOKUP_HELD, PRESENCE, SINE_INTEGRATED, SKY_BY_ITS_LIGHT, TEXTURED_GLOW,
};
use crate::judge::{baked, ensure, is_refused, light_at, reads, same_but_for_rounding};
use crate::things::{level, seen};
use bevy_kiln::bake::{BakeSettings, BakeWarning, CancelToken, MeterReading, MeterSettings, Page, measure_irradiance};
use bevy_kiln::math::polygon_irradiance;
use bevy_kiln::output::{OutputFormat, TexelFormat, texel_bytes, write_lightmap};
use bevy_kiln::scene::{Alpha, EnvironmentMap, Filter, Material, Scene, Texels, Texture, TextureRef, UvChannel, Wrap};
use glam::{DVec3, Quat, Vec2, Vec3};
use std::f64::consts::{PI, TAU};

const SPREADS: &str = "one NaN that spreads over every texel that sees the sky";
const SPAN: &str = "two triangles of one texture coordinate show one point of the picture";
const LOST_FRACTION: &str = "at 1e6 an f32 has 1/16 of a unit left, times the size nothing of a texel";
const NEXT_TEXEL: &str = "the neighbour's texel, or none";
const WRONG_TEXEL: &str = "another texel, or no number";
const FILE: &str = "the file is what a game reads, years later, on another machine";

pub const CASES: &[Case] = &[
    Case {
        name: "a_sky_with_one_pixel_of_1e7",
        hard: "nearly all light comes from one pixel in 8192, which a random direction meets once in 10 000 times",
        elsewhere: "a light map full of specks",
        holds: "its flat irradiance, L·Δφ·(sin²θ₁ − sin²θ₀)/2 and π of the rest, within 1 %",
        guard: &SKY_BY_ITS_LIGHT,
        without: "specks: the noise is far above 1 %",
        check: one_bright_pixel,
    },
    Case {
        name: "a_black_sky_is_not_baked",
        hard: "a picture that gives no light: no density can be drawn from it",
        elsewhere: "0/0 in the table of pixels",
        holds: "refused: the scene has no light",
        guard: &NO_LIGHT_REFUSED,
        without: "a black bake that looks like a fault of the baker",
        check: || {
            let mut scene = under(sky([4, 2], |_, _| 0.0));
            scene.meshes[0].uv1 = Some(vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]);
            match baked(&scene, &BakeSettings { samples_per_texel: 16, ..BakeSettings::default() }) {
                Err(error) if error.starts_with("the scene has no light") => Ok(()),
                other => Err(format!("{:?}", other.map(|lightmap| lightmap.report))),
            }
        },
    },
    Case {
        name: "a_sky_with_nan",
        hard: "one pixel is no number",
        elsewhere: SPREADS,
        holds: "refused by name, with the pixel's column and row",
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || {
            bad_pixel(
                f32::NAN,
                "environment map \"sky\" has a pixel that is negative or not a finite number (the first at column 3, row 1",
            )
        },
    },
    Case {
        name: "a_sky_with_infinity",
        hard: "a saturated pixel of a photograph, stored as ∞",
        elsewhere: SPREADS,
        holds: "refused by name, with the pixel's column and row",
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || {
            bad_pixel(
                f32::INFINITY,
                "environment map \"sky\" has a pixel that is negative or not a finite number (the first at column 3, row 1",
            )
        },
    },
    Case {
        name: "a_sky_with_a_negative_pixel",
        hard: "what sharpening leaves beside a bright edge",
        elsewhere: "a negative density, and light that is taken away",
        holds: "refused by name, with the pixel's column and row",
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || {
            bad_pixel(
                -1e-6,
                "environment map \"sky\" has a pixel that is negative or not a finite number (the first at column 3, row 1",
            )
        },
    },
    Case {
        name: "a_sky_with_a_pixel_of_1e30",
        hard: "finite, but squares and quotients of it are not",
        elsewhere: SPREADS,
        holds: "refused by name, with the pixel and the limit of 1e25 cd/m²",
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || {
            bad_pixel(
                1e30,
                "environment map \"sky\" has a pixel brighter than 1e25 cd/m², where numbers end (the first at column 3, row 1",
            )
        },
    },
    Case {
        name: "a_lamp_of_1e30",
        hard: "an emission whose square is no f32",
        elsewhere: "∞ in the choice of a light: all others go dark",
        holds: "refused by name; the rest is lit as if it were not there",
        guard: &EMISSION_IN_BOUNDS,
        without: "nothing is said",
        check: || {
            let mut scene = under(sky([4, 2], |_, _| 1.0));
            scene.materials[0].emitted_radiance = Vec3::splat(1e30);
            is_refused(&scene, "material \"albedo 0\" has an emission of 1e30, above 1e25")
        },
    },
    Case {
        name: "an_emission_beyond_f32",
        hard: "a lamp of 1e18 times a texel of 1e38: no number holds the product",
        elsewhere: SPREADS,
        holds: "paths that meet it are left out, counted and reported; the rest of the light is right within 1 %",
        guard: &LIGHT_ONLY,
        without: "∞ in a mean",
        check: beyond_f32,
    },
    Case {
        name: "a_sky_of_one_pixel",
        hard: "one pixel is the whole sphere: its middle says nothing of it",
        elsewhere: "sin θ at a pixel's middle: π/2 times the light",
        holds: "E = π·L within 0.1 %",
        guard: &SINE_INTEGRATED,
        without: "the density is not that of the directions",
        check: || horizontal(sky([1, 1], |_, _| 2.0), 2.0 * PI, 1e-3),
    },
    Case {
        name: "a_sky_of_one_column",
        hard: "rows that go round the whole sky, the first around the pole",
        elsewhere: "sin θ at a pixel's middle",
        holds: "E = π·Σ L·(sin²θ₁ − sin²θ₀) over 4 rows, within 0.1 %",
        guard: &SINE_INTEGRATED,
        without: "the density is not that of the directions",
        check: || {
            let rows = [5.0, 1.0, 3.0, 9.0];
            let map = sky([1, 8], move |_, row| rows.get(row as usize).copied().unwrap_or(0.0));
            let edge = |row: usize| (PI * row as f64 / 8.0).sin().powi(2);
            let truth = (0..4).map(|row| PI * f64::from(rows[row]) * (edge(row + 1) - edge(row))).sum::<f64>();
            horizontal(map, truth, 1e-3)
        },
    },
    Case {
        name: "a_pixel_at_the_pole",
        hard: "a pixel that is a triangle: its upper edge is a point",
        elsewhere: "sin θ at a pixel's middle, or a division by sin θ = 0",
        holds: "E = L·Δφ·sin²θ₁/2 within 0.5 %",
        guard: &SINE_INTEGRATED,
        without: "the density is not that of the directions",
        check: || {
            let map = sky([8, 4], |column, row| if (column, row) == (5, 0) { 100.0 } else { 0.0 });
            horizontal(map, 100.0 * TAU / 8.0 * 0.5 * (PI / 4.0).sin().powi(2), 5e-3)
        },
    },
    Case {
        name: "a_sun_on_the_seam",
        hard: "one half of the sun is the last pixel of a row, the other the first",
        elsewhere: "half a sun, or a line in the sky",
        holds: "both halves light a wall: L·2Δφ's quadrature within 1 %",
        guard: &SKY_BY_ITS_LIGHT,
        without: "specks: the noise is far above 1 %",
        check: sun_on_the_seam,
    },
    Case {
        name: "a_texture_of_one_texel",
        hard: "its four neighbours are itself, at coordinates from −1e6 to 1e6",
        elsewhere: NEXT_TEXEL,
        holds: "every place shows the texel, to the bit",
        guard: &LOOKUP_HELD,
        without: WRONG_TEXEL,
        check: || {
            let places = [[0.0, 0.0], [1.0, 1.0], [-0.3, 7.7], [1e6, -1e6], [f32::NAN, 0.5]];
            for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
                shows(&numbered([1, 1], wrap, Filter::Linear), &places.map(|place| (place, 1.0)), 0.0)?;
            }
            Ok(())
        },
    },
    Case {
        name: "a_texture_of_16384_by_1",
        hard: LOST_FRACTION,
        elsewhere: "a smear of a few texels",
        holds: "u = 1e6 + ¼ shows texel 4096, as ¼ does, to the bit",
        guard: &LOOKUP_HELD,
        without: WRONG_TEXEL,
        check: || {
            let numbers = numbered([16384, 1], Wrap::Repeat, Filter::Nearest);
            shows(&numbers, &[([0.25, 0.0], 4097.0), ([1e6 + 0.25, 0.5], 4097.0), ([-1e6 - 0.75, -3.0], 4097.0)], 0.0)
        },
    },
    Case {
        name: "a_texture_of_1_by_16384",
        hard: LOST_FRACTION,
        elsewhere: "a smear of a few texels",
        holds: "v = 1e6 + ¼ shows texel 4096; mirrored, 1e6 + 1¼ shows texel 12287, to the bit",
        guard: &LOOKUP_HELD,
        without: WRONG_TEXEL,
        check: || {
            let numbers = |wrap| numbered([1, 16384], wrap, Filter::Nearest);
            shows(&numbers(Wrap::Repeat), &[([0.0, 0.25], 4097.0), ([0.5, 1e6 + 0.25], 4097.0)], 0.0)?;
            shows(&numbers(Wrap::Mirror), &[([0.0, 0.25], 4097.0), ([0.5, 1e6 + 1.25], 12288.0)], 0.0)
        },
    },
    Case {
        name: "coordinates_on_the_edges_of_texels",
        hard: "0, ¼, ½ and 1 lie between two texels of four: rounding decides, and below 0 truncates the other way",
        elsewhere: NEXT_TEXEL,
        holds: "an edge belongs to the texel after it, −¼ is the last texel, and filtered edges are means, to the bit",
        guard: &LOOKUP_HELD,
        without: WRONG_TEXEL,
        check: || {
            let nearest =
                [([0.0, 0.0], 1.0), ([0.25, 0.0], 2.0), ([0.5, 0.0], 3.0), ([1.0, 0.0], 1.0), ([-0.25, 0.0], 4.0)];
            shows(&numbered([4, 1], Wrap::Repeat, Filter::Nearest), &nearest, 0.0)?;
            let linear = [([0.25, 0.0], 1.5), ([0.0, 0.0], 2.5), ([1.0, 0.0], 2.5), ([-0.125, 0.0], 4.0)];
            shows(&numbered([4, 1], Wrap::Repeat, Filter::Linear), &linear, 0.0)
        },
    },
    Case {
        name: "coordinates_that_are_no_numbers",
        hard: "NaN and ±∞ among the texture coordinates of a mesh",
        elsewhere: "a read beside the picture, or a NaN as a colour",
        holds: "they count as 0: the first texel's place, whatever the wrap and the filter",
        guard: &LOOKUP_HELD,
        without: "a NaN as a colour",
        check: || {
            for (wrap, expected) in [(Wrap::Repeat, 2.5), (Wrap::Mirror, 1.0), (Wrap::Clamp, 1.0)] {
                let places = [[f32::NAN, 0.0], [f32::INFINITY, 0.0], [f32::NEG_INFINITY, f32::NAN]];
                shows(&numbered([4, 1], wrap, Filter::Linear), &places.map(|place| (place, expected)), 0.0)?;
            }
            Ok(())
        },
    },
    Case {
        name: "coordinates_of_3e38",
        hard: "times the size they are ∞, and ∞ − ∞ is no number",
        elsewhere: "a NaN as a colour",
        holds: "clamped, they are the edge; repeated, they have no fraction left: the first texel",
        guard: &LOOKUP_HELD,
        without: "a NaN as a colour",
        check: || {
            shows(&numbered([4, 1], Wrap::Clamp, Filter::Linear), &[([3e38, 0.0], 4.0), ([-3e38, 0.0], 1.0)], 0.0)?;
            shows(&numbered([4, 1], Wrap::Repeat, Filter::Nearest), &[([3e38, 0.0], 1.0)], 0.0)
        },
    },
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
        name: "alpha_of_0_and_1e_40",
        hard: "a surface that is not there, and one that a denormal number says is there",
        elsewhere: "division by a chance of 0",
        holds: "E is to 1e-6 what it is without the first, within 1 % without the second",
        guard: &PRESENCE,
        without: "a thousandth of all paths ends at nothing, the others weigh more",
        check: || with_alpha(0.0, None).and_then(|()| nearly_without(1e-40)),
    },
    Case {
        name: "values_beyond_f16",
        hard: FILE,
        elsewhere: "∞ in the map: a white block where the sun comes in, a black one after filtering",
        holds: "1e5, 1e38 and ∞ become 65504, each texel counted",
        guard: &HELD_TO_FORMAT,
        without: "∞ in the file",
        check: || {
            let written = texel_bytes(&page(&[65504.0, 1e5, 1e38, f32::INFINITY]), TexelFormat::Rgba16f);
            let values: Vec<u16> =
                written.bytes.chunks(8).map(|texel| u16::from_le_bytes([texel[0], texel[1]])).collect();
            ensure((values == [0x7bff; 4]) && written.clamped == 3, || {
                format!("{values:x?}, {} counted", written.clamped)
            })
        },
    },
    Case {
        name: "values_beyond_rgb9e5",
        hard: FILE,
        elsewhere: "the exponent runs over into a dark colour",
        holds: "1e5, 1e38 and ∞ become 65408, each texel counted",
        guard: &HELD_TO_FORMAT,
        without: "the exponent runs over",
        check: || {
            let written = texel_bytes(&page(&[65408.0, 1e5, 1e38, f32::INFINITY]), TexelFormat::Rgb9e5);
            ensure(written.bytes == [0xff; 16] && written.clamped == 3, || format!("{written:x?}"))
        },
    },
    Case {
        name: "what_is_no_number_is_never_written",
        hard: FILE,
        elsewhere: "a NaN that a GPU's filter spreads over four texels",
        holds: "NaN, −∞ and −1 become 0 in both formats, each texel counted",
        guard: &HELD_TO_FORMAT,
        without: "NaN in the file",
        check: || {
            for format in [TexelFormat::Rgba16f, TexelFormat::Rgb9e5] {
                let written = texel_bytes(&page(&[f32::NAN, f32::NEG_INFINITY, -1.0, f32::NAN]), format);
                let colours = decoded(&written.bytes, format);
                ensure(colours == [[0.0; 3]; 4] && written.clamped == 4, || {
                    format!("{format:?}: {colours:?}, {}", written.clamped)
                })?;
            }
            Ok(())
        },
    },
    Case {
        name: "a_negative_zero_is_zero",
        hard: "−0 is what a product of a zero and a small negative number leaves, and its sign bit is no light",
        elsewhere: "a sign in a format that has one, a negative square root in a shader",
        holds: "+0 in both formats, and not counted: it is the same number",
        guard: &HELD_TO_FORMAT,
        without: "a sign bit in the file",
        check: || {
            for format in [TexelFormat::Rgba16f, TexelFormat::Rgb9e5] {
                let written = texel_bytes(&page(&[-0.0; 4]), format);
                let texel = &written.bytes[..format.bytes_per_texel()];
                let colour = if format == TexelFormat::Rgba16f { &texel[..6] } else { texel };
                ensure(colour.iter().all(|&byte| byte == 0) && written.clamped == 0, || {
                    format!("{format:?}: {texel:x?}")
                })?;
            }
            Ok(())
        },
    },
    Case {
        name: "a_black_texel_stays_black",
        hard: "a texel of no light that is covered: 0 with an alpha of 1, beside texels of 1e9",
        elsewhere: "taken for an empty one and filled from its neighbours (Godot 861), or a mean with what was clamped",
        holds: "0, 0, 0 and 1 to the bit, and what was clamped beside it is counted",
        guard: &HELD_TO_FORMAT,
        without: "its neighbours are infinite, and nobody is told",
        check: || {
            let written = texel_bytes(&page(&[0.0, 1e9, 1e9, 1e9]), TexelFormat::Rgba16f);
            let black = [0, 0, 0, 0, 0, 0, 0x00, 0x3c];
            ensure(written.bytes[..8] == black && written.clamped == 3, || {
                format!("{:x?}, {} counted", &written.bytes[..8], written.clamped)
            })
        },
    },
    Case {
        name: "a_bake_brighter_than_its_format",
        hard: "a lamp of 1e7 cd/m² that touches the wall: texels beyond any half float",
        elsewhere: "clipped without a word",
        holds: "a finite file, and a warning with the number of texels, the format and its limit",
        guard: &HELD_TO_FORMAT,
        without: "nothing is said",
        check: bright_bake,
    },
    Case {
        name: "denormals_of_f16",
        hard: "below 6.1e-5 cd/m², moonlight in a cellar, a half float has fewer and fewer digits",
        elsewhere: "flushed to 0: bands in the dark",
        holds: "2⁻²⁴ and 2⁻²⁰ are kept to the bit, 2⁻²⁶ rounds to 0",
        guard: &ROUNDED_AS_SPECIFIED,
        without: "flushed to 0",
        check: || {
            let powers = [2.0_f32.powi(-24), 2.0_f32.powi(-20), 2.0_f32.powi(-26), 2.0_f32.powi(-14)];
            let written = texel_bytes(&page(&powers), TexelFormat::Rgba16f);
            let values: Vec<f64> =
                decoded(&written.bytes, TexelFormat::Rgba16f).iter().map(|colour| colour[0]).collect();
            let expected = [powers[0], powers[1], 0.0, powers[3]].map(f64::from);
            ensure(values == expected, || format!("{values:?}"))
        },
    },
    Case {
        name: "denormals_of_rgb9e5",
        hard: "2⁻¹⁶ needs an exponent of 0, below which mantissas run out",
        elsewhere: "a negative exponent, which is read as a large one",
        holds: "2⁻²⁴ is 1 unit, half of that rounds up to 1, a quarter and f32's own denormals to 0; all within half a unit",
        guard: &ROUNDED_AS_SPECIFIED,
        without: "truncated",
        check: || {
            let powers = [2.0_f32.powi(-24), 2.0_f32.powi(-25), 2.0_f32.powi(-26), 1e-40];
            let written = texel_bytes(&page(&powers), TexelFormat::Rgb9e5);
            let units: Vec<u32> =
                written.bytes.chunks(4).map(|t| u32::from_le_bytes([t[0], t[1], t[2], t[3]]) & 0xf800_01ff).collect();
            ensure(units == [1, 1, 0, 0], || format!("{units:x?}"))
        },
    },
    Case {
        name: "a_contrast_of_1e12_in_one_texel",
        hard: "red of 1e4 beside blue of 1e-8 under one exponent of rgb9e5",
        elsewhere: "each channel truncated: darker by up to a step, 0.4 %",
        holds: "every channel within half a step of the largest one's exponent, 2⁻¹⁰ of it, at 1000 colours",
        guard: &ROUNDED_AS_SPECIFIED,
        without: "errors of up to a whole step",
        check: contrast,
    },
];

fn sky([width, height]: [u32; 2], radiance: impl Fn(u32, u32) -> f32) -> EnvironmentMap {
    let pixels = (0..width * height).map(|index| Vec3::splat(radiance(index % width, index / width)));
    EnvironmentMap { name: "sky".into(), width, height, radiance: pixels.collect(), world_from_map: Quat::IDENTITY }
}

/// A black square on the ground under a picture of the sky.
fn under(map: EnvironmentMap) -> Scene {
    let mut scene = level(SceneBuilder::default(), "ground", 0.0, [1.0, 1.0], grey(0.0)).build();
    scene.environment = Some(map);
    scene
}

fn horizontal(map: EnvironmentMap, truth: f64, tolerance: f64) -> Verdict {
    reads(&light_at(&under(map), &[at(Vec3::ZERO, Vec3::Y)], 1 << 16)?[0], truth, tolerance)
}

fn one_bright_pixel() -> Verdict {
    let map = sky([128, 64], |column, row| if (column, row) == (40, 20) { 1e7 } else { 1.0 });
    let edge = |row: f64| (PI * row / 64.0).sin().powi(2);
    let truth = PI + (1e7 - 1.0) * TAU / 128.0 * 0.5 * (edge(21.0) - edge(20.0));
    horizontal(map, truth, 1e-2)
}

fn bad_pixel(value: f32, sentence: &str) -> Verdict {
    let map = sky([4, 2], |column, row| if (column, row) == (3, 1) { value } else { 1.0 });
    is_refused(&under(map), sentence)
}

fn sun_on_the_seam() -> Verdict {
    // The seam lies towards −X; the sun in the row above the horizon.
    let map = sky([128, 64], |column, row| if row == 30 && (column == 0 || column == 127) { 1e6 } else { 0.0 });
    // ∫ sin²θ dθ ∫ cos φ dφ around −X.
    let over = |theta: f64| 0.5 * theta - 0.25 * (2.0 * theta).sin();
    let heights = over(PI * 31.0 / 64.0) - over(PI * 30.0 / 64.0);
    let truth = 1e6 * heights * 2.0 * (TAU / 128.0).sin();
    reads(&light_at(&under(map), &[at(Vec3::new(0.0, 1.0, 0.0), Vec3::NEG_X)], 1 << 14)?[0], truth, 1e-2)
}

/// Texels 1, 2, 3 and so on.
fn numbered([width, height]: [u32; 2], wrap: Wrap, filter: Filter) -> Texture {
    let texels: Vec<[f32; 4]> =
        (1..=width * height).map(|number| [number as f32, number as f32, number as f32, 1.0]).collect();
    Texture { name: "numbers".into(), width, height, texels: Texels::Float(texels.into()), wrap: [wrap; 2], filter }
}

/// Whether a picture shows these values at these places. A square that glows by the picture, all of whose corners have
/// the same texture coordinates, shows one place of it.
fn shows(texture: &Texture, places: &[([f32; 2], f32)], tolerance: f64) -> Verdict {
    for &(place, expected) in places {
        let mut scene = level(SceneBuilder::default(), "screen", 0.0, [1.0, 1.0], glowing(0.0, 1.0)).build();
        scene.textures = vec![texture.clone()];
        scene.materials[0].emission_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv0 });
        scene.meshes[0].uv0 = Some(vec![Vec2::from_array(place); 4]);
        let (radiance, _) = seen(&scene, [Vec3::new(0.1, 1.0, 0.2), Vec3::new(0.1, 0.0, 0.2)], 16)?;
        ensure((radiance.x - f64::from(expected)).abs() <= tolerance, || {
            format!("{} at {place:?}, not {expected} ({SPAN})", radiance.x)
        })?;
    }
    Ok(())
}

/// A lamp above the ground with one texel in 32 × 32.
fn spark(texel: f32, strength: f32) -> Scene {
    let lamp = [2.0 * Vec3::X, 2.0 * Vec3::Z];
    let mut scene = SceneBuilder::default()
        .quad("ground", Vec3::new(-5.0, 0.0, -5.0), [10.0 * Vec3::Z, 10.0 * Vec3::X], grey(0.0))
        .quad("lamp", Vec3::new(-1.0, 1.0, -1.0), lamp, glowing(0.0, strength))
        .build();
    let texels: Vec<[f32; 4]> =
        (0..1024).map(|index| if index == 32 * 12 + 20 { [texel, texel, texel, 1.0] } else { [0.0; 4] }).collect();
    let (wrap, filter) = ([Wrap::Clamp; 2], Filter::Nearest);
    scene.textures = vec![Texture {
        name: "spark".into(),
        width: 32,
        height: 32,
        texels: Texels::Float(texels.into()),
        wrap,
        filter,
    }];
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

fn screened(alpha: Option<(f32, Alpha)>) -> Result<Vec<MeterReading>, String> {
    let mut builder = level(SceneBuilder::default(), "ground", 0.0, [1.0, 1.0], grey(0.5));
    if let Some((opacity, alpha)) = alpha {
        let mut material = Material { alpha, ..grey(0.5) };
        material.base_colour.w = opacity;
        builder = level(builder, "screen", 0.5, [1000.0, 1.0], material);
    }
    light_at(&builder.sky(Vec3::ONE).build(), &[at(Vec3::ZERO, Vec3::Y), at(Vec3::X * 0.5, Vec3::Y)], 1 << 12)
}

/// As without it, or as an opaque one.
fn with_alpha(opacity: f32, like: Option<Alpha>) -> Verdict {
    let found = screened(Some((opacity, Alpha::Blend)))?;
    same_but_for_rounding(&found, &screened(like.map(|alpha| (1.0, alpha)))?, 1e-6)
}

fn nearly_without(opacity: f32) -> Verdict {
    let (found, without) = (screened(Some((opacity, Alpha::Blend)))?, screened(None)?);
    reads(&found[0], without[0].irradiance.x, 1e-2)
}

/// A page of four covered grey texels.
fn page(values: &[f32; 4]) -> Page {
    let radiance: Vec<Vec3> = values.iter().map(|&value| Vec3::splat(value)).collect();
    Page { width: 2, height: 2, raw: radiance.clone(), stderr: vec![Vec3::ZERO; 4], radiance, coverage: vec![1.0; 4] }
}

fn decoded(bytes: &[u8], format: TexelFormat) -> Vec<[f64; 3]> {
    let half = |bits: u16| {
        let (sign, exponent, mantissa) = (bits >> 15, i32::from(bits >> 10 & 31), f64::from(bits & 1023));
        let size = match exponent {
            0 => mantissa * 2.0_f64.powi(-24),
            31 if mantissa > 0.0 => f64::NAN,
            31 => f64::INFINITY,
            _ => (1.0 + mantissa / 1024.0) * 2.0_f64.powi(exponent - 15),
        };
        if sign == 1 { -size } else { size }
    };
    let texel = |texel: &[u8]| match format {
        TexelFormat::Rgba16f => [0, 2, 4].map(|at| half(u16::from_le_bytes([texel[at], texel[at + 1]]))),
        TexelFormat::Rgb9e5 => {
            let bits = u32::from_le_bytes([texel[0], texel[1], texel[2], texel[3]]);
            let scale = 2.0_f64.powi((bits >> 27) as i32 - 24);
            [0, 9, 18].map(|shift| f64::from(bits >> shift & 0x1ff) * scale)
        }
    };
    bytes.chunks(format.bytes_per_texel()).map(texel).collect()
}

fn bright_bake() -> Verdict {
    let scene = SceneBuilder::default()
        .quad("ground", Vec3::ZERO, [Vec3::Z, Vec3::X], grey(0.5))
        .quad("lamp", Vec3::new(0.0, 0.001, 0.0), [Vec3::X, Vec3::Z], glowing(0.0, 1e7))
        .build();
    let lightmap = baked(&scene, &BakeSettings { samples_per_texel: 16, density: 4.0, ..BakeSettings::default() })?;
    let folder = temp_dir::TempDir::new().map_err(|error| error.to_string())?;
    let written = write_lightmap(&lightmap, "bright", folder.path(), OutputFormat::Rgba16f);
    let written = written.map_err(|error| error.to_string())?;
    let is_told = |warning: &BakeWarning| matches!(warning, BakeWarning::Clamped { texels: 16.., format: "rgba16f", limit } if *limit == 65504.0);
    ensure(written.warnings.iter().any(is_told), || format!("{:?}", written.warnings))?;
    let finite = lightmap.pages.iter().all(|page| {
        let bytes = texel_bytes(page, TexelFormat::Rgba16f).bytes;
        decoded(&bytes, TexelFormat::Rgba16f).concat().iter().all(|value| value.is_finite())
    });
    ensure(finite, || "a value that is not finite was written".into())
}

fn contrast() -> Verdict {
    for index in 0..1000 {
        let red = 1e4 * (1.0 + index as f32 / 1000.0);
        let colour = Vec3::new(red, red * 1e-3 * (index as f32 + 0.5), 1e-8);
        let mut page = page(&[0.0; 4]);
        page.radiance[0] = colour;
        let bytes = texel_bytes(&page, TexelFormat::Rgb9e5).bytes;
        let back = decoded(&bytes, TexelFormat::Rgb9e5)[0];
        // A mantissa of 9 bits is at least 256: a step is at most a 256th of the largest channel.
        let step = 2.0_f64.powi((bytes[3] >> 3) as i32 - 24);
        ensure(step <= f64::from(colour.max_element()) / 255.5, || format!("a step of {step} for {colour}"))?;
        for (channel, back) in colour.to_array().into_iter().zip(back) {
            let off = (f64::from(channel) - back).abs();
            ensure(off <= 0.5 * step, || format!("{channel} is stored as {back}, a step is {step}"))?;
        }
    }
    Ok(())
}

//! What a file's format can hold, and what becomes of what it cannot.

use crate::case::{Case, Verdict};
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::output::{HELD_TO_FORMAT, ROUNDED_AS_SPECIFIED};
use crate::judge::{baked, ensure};
use bevy_kiln::bake::{BakeSettings, BakeWarning, Goal, Page};
use bevy_kiln::output::{OutputFormat, TexelFormat, texel_bytes, write_lightmap};
use glam::Vec3;

const FILE: &str = "the file is what a game reads, years later, on another machine";

pub const CASES: &[Case] = &[
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
        holds: "2⁻²⁴ is 1 unit, half of that rounds up to 1, a quarter and f32's own denormals to 0; all within half a \
                unit",
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

/// A page of four covered grey texels.
fn page(values: &[f32; 4]) -> Page {
    let radiance: Vec<Vec3> = values.iter().map(|&value| Vec3::splat(value)).collect();
    Page {
        width: 2,
        height: 2,
        raw: radiance.clone(),
        stderr: vec![Vec3::ZERO; 4],
        radiance,
        coverage: vec![1.0; 4],
        ..Page::default()
    }
}

/// Colours of a file's texels, by the formats' own definitions.
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
        TexelFormat::Bc6h => unreachable!("its texels are judged by a decoder of blocks"),
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
    let lightmap = baked(&scene, &BakeSettings { goal: Goal::Samples(16), density: 4.0, ..BakeSettings::default() })?;
    let folder = temp_dir::TempDir::new().map_err(|error| error.to_string())?;
    let written = write_lightmap(&lightmap, "bright", folder.path(), OutputFormat::Rgba16f);
    let written = written.map_err(|error| error.to_string())?;
    let is_told = |warning: &BakeWarning| match warning {
        BakeWarning::Clamped { texels, format, limit } => *texels >= 16 && *format == "rgba16f" && *limit == 65504.0,
        _ => false,
    };
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

//! Textures of odd sizes, at odd coordinates.

use crate::case::{Case, Verdict};
use crate::common::scenes::{SceneBuilder, glowing};
use crate::guards::texture::LOOKUP_HELD;
use crate::judge::ensure;
use crate::look::seen;
use crate::things::{level, picture};
use bevy_kiln::scene::{Filter, Texture, TextureRef, UvChannel, Wrap};
use glam::{Vec2, Vec3};

const LOST_FRACTION: &str = "at 1e6 an f32 has 1/16 of a unit left, times the size nothing of a texel";
const NEXT_TEXEL: &str = "the neighbour's texel, or none";
const WRONG_TEXEL: &str = "another texel, or no number";

pub const CASES: &[Case] = &[
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
                shows(&numbered([1, 1], wrap, Filter::Linear), &places.map(|place| (place, 1.0)))?;
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
            shows(&numbers, &[([0.25, 0.0], 4097.0), ([1e6 + 0.25, 0.5], 4097.0), ([-1e6 - 0.75, -3.0], 4097.0)])
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
            shows(&numbers(Wrap::Repeat), &[([0.0, 0.25], 4097.0), ([0.5, 1e6 + 0.25], 4097.0)])?;
            shows(&numbers(Wrap::Mirror), &[([0.0, 0.25], 4097.0), ([0.5, 1e6 + 1.25], 12288.0)])
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
            shows(&numbered([4, 1], Wrap::Repeat, Filter::Nearest), &nearest)?;
            let linear = [([0.25, 0.0], 1.5), ([0.0, 0.0], 2.5), ([1.0, 0.0], 2.5), ([-0.125, 0.0], 4.0)];
            shows(&numbered([4, 1], Wrap::Repeat, Filter::Linear), &linear)
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
                shows(&numbered([4, 1], wrap, Filter::Linear), &places.map(|place| (place, expected)))?;
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
            shows(&numbered([4, 1], Wrap::Clamp, Filter::Linear), &[([3e38, 0.0], 4.0), ([-3e38, 0.0], 1.0)])?;
            shows(&numbered([4, 1], Wrap::Repeat, Filter::Nearest), &[([3e38, 0.0], 1.0)])
        },
    },
];

/// Texels 1, 2, 3 and so on.
fn numbered([width, height]: [u32; 2], wrap: Wrap, filter: Filter) -> Texture {
    let texels: Vec<[f32; 4]> =
        (1..=width * height).map(|number| [number as f32, number as f32, number as f32, 1.0]).collect();
    picture([width, height], texels, wrap, filter)
}

/// Whether a picture shows these values at these places, to the bit. A square that glows by the picture, all of whose
/// corners have the same texture coordinates, shows one place of it.
fn shows(texture: &Texture, places: &[([f32; 2], f32)]) -> Verdict {
    for &(place, expected) in places {
        let mut scene = level(SceneBuilder::default(), "screen", 0.0, [1.0, 1.0], glowing(0.0, 1.0)).build();
        scene.textures = vec![texture.clone()];
        scene.materials[0].emission_texture = Some(TextureRef { texture: 0, uv: UvChannel::Uv0 });
        scene.meshes[0].uv0 = Some(vec![Vec2::from_array(place); 4]);
        let (radiance, _) = seen(&scene, [Vec3::new(0.1, 1.0, 0.2), Vec3::new(0.1, 0.0, 0.2)], 16)?;
        ensure(radiance.x == f64::from(expected), || format!("{} at {place:?}, not {expected}", radiance.x))?;
    }
    Ok(())
}

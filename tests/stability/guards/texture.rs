//! Guards of pictures that come in: textures, pictures of the sky, emission.

use crate::guard::{Edit, Guard};

pub static LOOKUP_HELD: Guard = Guard {
    name: "lookups held to the picture",
    does: "a coordinate is brought near before it meets the size, so that f32 keeps its fraction; one that is no \
           number counts as 0; an index is folded into the picture by Euclid's remainder, which is never negative",
    edits: &[
        Edit {
            file: "src/trace/texture.rs",
            text: "let coordinate = if uv[axis].is_finite() { uv[axis] } else { 0.0 };",
            instead: "let coordinate = uv[axis];",
        },
        Edit {
            file: "src/trace/texture.rs",
            text: "Wrap::Repeat => coordinate - coordinate.floor(),",
            instead: "Wrap::Repeat => coordinate,",
        },
        Edit {
            file: "src/trace/texture.rs",
            text: "Wrap::Mirror => coordinate - 2.0 * (0.5 * coordinate).floor(),",
            instead: "Wrap::Mirror => coordinate,",
        },
        Edit {
            file: "src/trace/texture.rs",
            text: "Wrap::Clamp => coordinate.clamp(-1.0, 2.0),",
            instead: "Wrap::Clamp => coordinate,",
        },
        Edit {
            file: "src/trace/texture.rs",
            text: "Wrap::Repeat => index.rem_euclid(size),",
            instead: "Wrap::Repeat => (index % size).abs(),",
        },
    ],
};

pub static SKY_BY_ITS_LIGHT: Guard = Guard {
    name: "the sky by its light",
    does: "pixels are chosen by brightness × solid angle, the sine integrated exactly over each, so that radiance over \
           density is the same everywhere (Pharr, Jakob and Humphreys 2023, § 12.5.2)",
    edits: &[
        Edit {
            file: "src/trace/light/environment.rs",
            text: "let weight = |place: UVec2| brightness(texel(map, place)) * solid_angles[place.y as usize];",
            instead: "let weight = |_: UVec2| 1.0;",
        },
        Edit {
            file: "src/trace/light/environment.rs",
            text: "        brightness(texel(&self.map, place)) * self.solid_angles[place.y as usize]\n",
            instead: "        f64::from(place.x < u32::MAX)\n",
        },
        Edit {
            file: "src/trace/light/environment.rs",
            text: "(radiance, self.table.probability(brightness(radiance)))",
            instead: "(radiance, self.table.probability(1.0 / self.solid_angles[place.y as usize]))",
        },
    ],
};

pub static SINE_INTEGRATED: Guard = Guard {
    name: "the sine over a pixel",
    does: "a pixel's solid angle is 2π/w · (cos θ₀ − cos θ₁), not 2π²/(w h) · sin θ at its middle",
    edits: &[Edit {
        file: "src/trace/light/environment.rs",
        text: "            (top - bottom) * TAU / f64::from(map.width)\n",
        instead: "            let middle = (f64::from(row) + 0.5) * PI / f64::from(map.height);\n            \
                  let _ = (top, bottom);\n            \
                  middle.sin() * PI / f64::from(map.height) * TAU / f64::from(map.width)\n",
    }],
};

pub static EMISSION_IN_BOUNDS: Guard = Guard {
    name: "emission in bounds",
    does: "what a source gives off is finite, not negative and at most 1e25, which leaves the inverse square of 1e-6 m \
           within f32; else it is left out by name",
    edits: &[
        Edit { file: "src/scene/validate.rs", text: "    if !is_radiance(emission) {\n", instead: "    if false {\n" },
        Edit {
            file: "src/scene/validate.rs",
            text: "(value > limit).then_some(FaultKind::TooBright",
            instead: "(value > f32::INFINITY).then_some(FaultKind::TooBright",
        },
        Edit {
            file: "src/scene/validate/light.rs",
            text: "position(|&radiance| !is_radiance(radiance))",
            instead: "position(|&radiance| !is_radiance(radiance) && radiance.x == 9.0)",
        },
        Edit {
            file: "src/scene/validate/light.rs",
            text: "radiance.max_element() > MAX_EMISSION)",
            instead: "radiance.max_element() > f32::INFINITY)",
        },
    ],
};

pub static PRESENCE: Guard = Guard {
    name: "what is there in part",
    does: "a surface of presence p is met with the chance p and passed with 1 − p; one that is not there at all is no \
           choice",
    edits: &[
        Edit {
            file: "src/trace/shade.rs",
            text: "Alpha::Blend => (Vec3::splat(1.0 - alpha), alpha),",
            instead: "Alpha::Blend => (Vec3::ONE, alpha),",
        },
        Edit {
            file: "src/trace/path/walk.rs",
            text: "if passage.presence > 0.0 {",
            instead: "if passage.presence >= 0.0 {",
        },
    ],
};

pub static TEXTURED_GLOW: Guard = Guard {
    name: "a glow's own texel",
    does: "a sampled point of a glowing surface gives what its texture says there",
    edits: &[Edit {
        file: "src/trace/shade.rs",
        text: "if K & TEXTURED != 0 && surface.emission_texture.is_some() {",
        instead: "if K & TEXTURED != 0 && surface.emission_texture.is_none() {",
    }],
};

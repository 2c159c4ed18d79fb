//! Angles along the surface, and shading normals that no one could see.

use crate::case::{Case, Verdict};
use crate::common::scenes::{SceneBuilder, glowing};
use crate::guards::bsdf::{FLAT_WHERE_UNSEEN, MORE_THAN_ONE_FACET, PHONG, TOTAL_REFLECTION};
use crate::look::{furnace_of_one, sees, shows_albedos};
use crate::things::{level, metal, of, picture};
use bevy_kiln::scene::{Filter, Material, NormalEncoding, NormalMap, Scattering, TextureRef, UvChannel, Wrap};
use glam::Vec3;

const OF_EXPORTERS: &str = "meshes and maps come so from exporters";
const NO_FRAME: &str = "light leaves on the wrong side, or the frame is no number";
const FLAT: &str = "the flat normal takes over: E = π within 0.3 % by a wall of perfect metal";

pub const CASES: &[Case] = &[
    Case {
        name: "metal_seen_at_89_9999_degrees",
        hard: "cosines of 1.7e-6: masking and Jacobian are quotients of what vanishes",
        elsewhere: "black or white rims",
        holds: "white metal of roughness 0.25 shows a white sky as it is, within 1 %, at 89° and at 89.9999°",
        guard: &MORE_THAN_ONE_FACET,
        without: "what met two facets is lost: 5 % at 89°, a dark rim",
        check: || along(metal(0.25), 89.0).and_then(|()| along(metal(0.25), 89.9999)),
    },
    Case {
        name: "glass_seen_at_89_9999_degrees",
        hard: "Fresnel's law at a cosine of 1.7e-6",
        elsewhere: "black or white rims",
        holds: "it mirrors all but 1e-5 of the sky: radiance 1 within 1 %, and the same from within, beyond the edge",
        guard: &TOTAL_REFLECTION,
        without: "seen from within: a root of a negative number",
        check: grazing_glass,
    },
    Case {
        name: "phong_of_exponent_0",
        hard: "the lobe is a whole hemisphere around the mirror direction, half of it below the surface at the rim",
        elsewhere: "what lies below the surface makes NaN, or light",
        holds: "under a white sky it shows its albedo in the table (docs/albedo.md), within 1 %, at 0°, 60° and 80°",
        guard: &PHONG,
        without: "0/0 below the surface",
        check: || {
            let lobe = Scattering::Phong { specular: Vec3::ONE, exponent: 0.0 };
            shows_albedos(Material::scattering("phong", Vec3::ZERO, lobe), [1.0, 0.750, 0.587], 1e-2)
        },
    },
    Case {
        name: "a_shading_normal_at_the_horizon",
        hard: "normals that lie in the surface: half of the directions are behind it",
        elsewhere: "black spots, or NaN that spreads",
        holds: FLAT,
        guard: &FLAT_WHERE_UNSEEN,
        without: NO_FRAME,
        check: || shaded(Vec3::Y, None),
    },
    Case {
        name: "a_normal_map_of_zeros",
        hard: "texels of (½, ½, ½) are a normal of no length",
        elsewhere: OF_EXPORTERS,
        holds: "the vertex normal takes over: E = π within 0.3 % by a wall of perfect metal",
        guard: &FLAT_WHERE_UNSEEN,
        without: NO_FRAME,
        check: || shaded(Vec3::X, Some([0.5, 0.5, 0.5, 1.0])),
    },
    Case {
        name: "a_normal_map_that_points_backwards",
        hard: "texels of (½, ½, 0) point into the surface",
        elsewhere: OF_EXPORTERS,
        holds: FLAT,
        guard: &FLAT_WHERE_UNSEEN,
        without: NO_FRAME,
        check: || shaded(Vec3::X, Some([0.5, 0.5, 0.0, 1.0])),
    },
];

/// Where a look at this angle begins, one metre from the middle.
fn grazing(degrees: f64, sign: f32) -> Vec3 {
    let angle = degrees.to_radians();
    Vec3::new(angle.sin() as f32, sign * angle.cos() as f32, 0.0)
}

fn along(material: Material, degrees: f64) -> Verdict {
    let scene = level(SceneBuilder::default(), "plate", 0.0, [100.0, 1.0], material).sky(Vec3::ONE).build();
    sees(&scene, [grazing(degrees, 1.0), Vec3::ZERO], 1 << 16, 1.0, 1e-2)
}

fn grazing_glass() -> Verdict {
    along(of(Scattering::Refraction { ior: 1.5 }), 89.9999)?;
    let mut builder =
        level(SceneBuilder::default(), "plate", 0.0, [100.0, 1.0], of(Scattering::Refraction { ior: 1.5 }));
    builder = level(builder, "floor", -100.0, [1e9, 1.0], glowing(0.0, 1.0));
    sees(&builder.build(), [grazing(89.9999, -1.0), Vec3::ZERO], 1 << 12, 1.0, 1e-2)
}

/// A furnace with a wall of perfect metal at −x, whose vertices have this normal and which may have a normal map of
/// one texel.
fn shaded(normal: Vec3, texel: Option<[f32; 4]>) -> Verdict {
    let lit = || glowing(0.5, 0.5);
    let mut scene =
        SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [metal(0.0), lit(), lit(), lit(), lit(), lit()]).build();
    scene.meshes[0].normals = Some(vec![normal; 4]);
    if let Some(texel) = texel {
        scene.textures = vec![picture([1, 1], vec![texel], Wrap::Clamp, Filter::Linear)];
        let texture = TextureRef { texture: 0, uv: UvChannel::Uv1 };
        scene.materials[0].normal_map = Some(NormalMap { texture, encoding: NormalEncoding::OpenGl });
    }
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

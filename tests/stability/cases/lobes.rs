//! Lobes at their limits: roughness that vanishes, indices that are equal or far apart, angles along the surface.

use crate::case::{Case, Verdict};
use crate::common::meter::{at, on_walls};
use crate::common::scenes::{SceneBuilder, glowing, grey};
use crate::guards::bsdf::{
    FLAT_WHERE_UNSEEN, INDEX_TURNED, MATCHED, MORE_THAN_ONE_FACET, PHONG, RADIANCE_BY_INDEX, SMOOTH_LIMIT,
    TOTAL_REFLECTION,
};
use crate::guards::path::{BODY_LEARNT, DIMMING};
use crate::judge::{all_read, light_at, reads, same_but_for_rounding};
use crate::things::{
    CLEAR, fresnel, furnace_of_one, glass, integrate, level, metal, of, room_of_radiance_one, sees, sphere, standard,
    with_box,
};
use bevy_kiln::scene::{
    Filter, Interior, Material, NormalEncoding, NormalMap, Scattering, Standard, Texels, Texture, TextureRef,
    UvChannel, Wrap,
};
use glam::Vec3;
use std::f64::consts::PI;

const SPIKE: &str = "the lobe is a spike of density 1/(π α²)";
const FIREFLIES: &str = "0/0, or a least roughness (0.045 in games) that blurs every mirror";
const AS_SMOOTH: &str = "a room with a small lamp reads, to the bit, what it does at roughness 0";
const NO_SPIKE: &str = "0/0, or other light than that of a mirror";
const BENDS: &str = "light changes its radiance by n² on the way in and on the way out";
const GREY_FILTER: &str = "glass as a grey filter";
const UNSEEN: &str = "what loses no light cannot be seen in a furnace: E = π within 0.3 %";
const SQUEEZED: &str = "light is squeezed twice by n² and not let go";
const OF_EXPORTERS: &str = "meshes and maps come so from exporters";
const BLACK_OR_NAN: &str = "black spots, or NaN that spreads";
const NO_FRAME: &str = "light leaves on the wrong side, or the frame is no number";

pub const CASES: &[Case] = &[
    Case {
        name: "metal_of_roughness_0",
        hard: SPIKE,
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || one_wall(metal(0.0)),
    },
    Case {
        name: "metal_of_roughness_1e_4",
        hard: SPIKE,
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(metal),
    },
    Case {
        name: "plastic_of_roughness_0",
        hard: "a spike over a diffuse base: light samples find one of the two",
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || one_wall(plastic(0.0)),
    },
    Case {
        name: "plastic_of_roughness_1e_4",
        hard: "a spike over a diffuse base: light samples find one of the two",
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(plastic),
    },
    Case {
        name: "glass_of_roughness_0",
        hard: "two spikes, and total reflection between them",
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || body(&glass(1.5, 0.0)),
    },
    Case {
        name: "glass_of_roughness_1e_4",
        hard: "two spikes, and total reflection between them",
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(|roughness| glass(1.5, roughness)),
    },
    Case {
        name: "coat_of_roughness_0",
        hard: "a spike over a spike: a clear coat over a perfect metal",
        elsewhere: FIREFLIES,
        holds: UNSEEN,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || one_wall(coated(0.0)),
    },
    Case {
        name: "coat_of_roughness_1e_4",
        hard: "a spike over a spike: a clear coat over a perfect metal",
        elsewhere: FIREFLIES,
        holds: AS_SMOOTH,
        guard: &SMOOTH_LIMIT,
        without: NO_SPIKE,
        check: || as_smooth(coated),
    },
    Case {
        name: "ior_1",
        hard: "rough glass of index 1: nothing is bent, and the half vector of refraction has no length",
        elsewhere: "NaN, or black",
        holds: "under a white sky every path brings 1: E = π within 1e-5",
        guard: &MATCHED,
        without: "what goes straight on is found by no lobe",
        check: || under_slab(1.0, 0.5, PI, 1e-5),
    },
    Case {
        name: "ior_1_0001",
        hard: "the half vector is a difference of vectors that are equal but for 1e-4",
        elsewhere: "NaN, black, or noise",
        holds: "no interface: it would reflect 2.5e-9 along the normal; E = π within 1e-5",
        guard: &MATCHED,
        without: "rounding decides the half vector",
        check: || under_slab(1.0001, 0.5, PI, 1e-5),
    },
    Case {
        name: "ior_0_5",
        hard: "a bubble: total reflection from outside, beyond 30°",
        elsewhere: GREY_FILTER,
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: || body(&glass(0.5, 0.0)),
    },
    Case {
        name: "ior_2_4",
        hard: "diamond: what is inside leaves within 25° of the normal alone",
        elsewhere: GREY_FILTER,
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: || body(&glass(2.4, 0.0)),
    },
    Case {
        name: "ior_100",
        hard: "radiance changes by 1e4 and back, 96 % are reflected on either way",
        elsewhere: GREY_FILTER,
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: || body(&glass(100.0, 0.0)),
    },
    Case {
        name: "below_the_critical_angle",
        hard: "1e-4 rad from where the root of Snell's law vanishes",
        elsewhere: "a root of a negative number",
        holds: "seen from below: n²(1 − F) of the sky and F of a floor of radiance 3, by Fresnel, within 1 %",
        guard: &RADIANCE_BY_INDEX,
        without: "the sky is not concentrated by n²",
        check: || critical(-1e-4),
    },
    Case {
        name: "at_the_critical_angle",
        hard: "the cosine behind the surface is 0, or the root of what rounding left",
        elsewhere: "a root of a negative number",
        holds: "all is reflected: a floor of radiance 3 is seen, within what 1e-7 of angle changes (2 %)",
        guard: &TOTAL_REFLECTION,
        without: "a root of a negative number: paths are lost, and said to be",
        check: || critical(1e-7),
    },
    Case {
        name: "beyond_the_critical_angle",
        hard: "Snell's law has no solution",
        elsewhere: "a root of a negative number",
        holds: "all is reflected: a floor of radiance 3 is seen, within 1e-4",
        guard: &TOTAL_REFLECTION,
        without: "a root of a negative number: paths are lost, and said to be",
        check: || critical(1e-4),
    },
    Case {
        name: "a_sphere_of_glass_in_a_sphere_of_glass",
        hard: "an interface knows its own two sides, and no list of what lies in what",
        elsewhere: "a stack of media that comes out of step",
        holds: "E = π within 0.5 % in a furnace",
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: nested,
    },
    Case {
        name: "glass_turned_inside_out",
        hard: "normals point inwards: the body is a bubble, the room around it glass",
        elsewhere: "light that is lost or doubled by n²",
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: inside_out,
    },
    Case {
        name: "glass_beside_glass",
        hard: "two bodies a micrometre apart: 24 interfaces, two of them within rounding's reach",
        elsewhere: "a ray that starts behind the second surface never enters the second body",
        holds: UNSEEN,
        guard: &INDEX_TURNED,
        without: SQUEEZED,
        check: side_by_side,
    },
    Case {
        name: "a_receiver_inside_glass",
        hard: BENDS,
        elsewhere: GREY_FILTER,
        holds: "under glass under a white sky E = π(1 − F̄), F̄ by Fresnel's law, within 1 %",
        guard: &RADIANCE_BY_INDEX,
        without: "the light that the surface concentrates is missing",
        check: || under_water(CLEAR),
    },
    Case {
        name: "attenuation_over_1e_6_m",
        hard: "exp(−∞) in two channels, and 0 · ∞ in the one that is not absorbed",
        elsewhere: "NaN, or light that underflow let through",
        holds: "red reads π(1 − F̄) within 1 %, green and blue are 0",
        guard: &BODY_LEARNT,
        without: "the way to the first surface is not dimmed",
        check: short_attenuation,
    },
    Case {
        name: "attenuation_over_1e_6_m_into_the_open",
        hard: "a body without a back: its light travels for ever, in a channel that nothing absorbs",
        elsewhere: "0 · ∞",
        holds: "through a single sheet red reads what it does without absorption within 1 %, green and blue nothing",
        guard: &DIMMING,
        without: "0 · ∞",
        check: open_body,
    },
    Case {
        name: "attenuation_over_1e_6_m_of_black",
        hard: "black has no logarithm: −ln 0 over any distance is ∞, over an infinite one it is no number",
        elsewhere: "NaN",
        holds: "black glass over 1e-6, 1e6 and ∞ m: E is a number; with 1e-6 it is dark, with ∞ clear within 1 %",
        guard: &BODY_LEARNT,
        without: "the way to the first surface is not dimmed",
        check: black_attenuation,
    },
    Case {
        name: "attenuation_over_1e6_m",
        hard: "half a metre of a way of 1e6 m: 1 − 3e-7 is left, five units in the last place",
        elsewhere: "lengths in another unit: glass that is black, or a mist",
        holds: "E = π(1 − F̄) as in clear glass, within 1 %",
        guard: &RADIANCE_BY_INDEX,
        without: "the light that the surface concentrates is missing",
        check: || under_water(Interior::Volume { attenuation_colour: Vec3::splat(0.5), attenuation_distance: 1e6 }),
    },
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
        holds: "its albedo in the table (docs/albedo.md) at 0°, 60° and 80°, within 1 %",
        guard: &PHONG,
        without: "0/0 below the surface",
        check: || phong(0.0, [1.0, 0.750, 0.587]),
    },
    Case {
        name: "a_shading_normal_at_the_horizon",
        hard: "normals that lie in the surface: half of the directions are behind it",
        elsewhere: BLACK_OR_NAN,
        holds: "the flat normal takes over: E = π within 0.3 % by a wall of perfect metal",
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
        holds: "the flat normal takes over: E = π within 0.3 % by a wall of perfect metal",
        guard: &FLAT_WHERE_UNSEEN,
        without: NO_FRAME,
        check: || shaded(Vec3::X, Some([0.5, 0.5, 0.0, 1.0])),
    },
];

fn plastic(perceptual_roughness: f32) -> Material {
    standard(Standard { perceptual_roughness, ..Standard::default() })
}

fn coated(clearcoat_perceptual_roughness: f32) -> Material {
    let metal = Standard { metallic: 1.0, perceptual_roughness: 0.0, ..Standard::default() };
    standard(Standard { clearcoat: 1.0, clearcoat_perceptual_roughness, ..metal })
}

/// A room of radiance 1, one wall of which loses no light.
fn one_wall(material: Material) -> Verdict {
    let lit = || glowing(0.5, 0.5);
    let scene =
        SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [material, lit(), lit(), lit(), lit(), lit()]).build();
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

fn body(material: &Material) -> Verdict {
    let corners = [Vec3::new(-0.8, -0.6, -0.7), Vec3::new(0.7, 0.8, 0.8)];
    let scene = with_box(room_of_radiance_one(), "thing", corners, material).build();
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

/// A material of roughness 1e-4 is to the bit what it is at 0.
fn as_smooth(material: impl Fn(f32) -> Material) -> Verdict {
    let points = on_walls(Vec3::NEG_ONE, Vec3::ONE, 2);
    let [fine, smooth] = [1e-4, 0.0].map(|roughness| {
        let corners = [Vec3::new(-0.5, -0.9, -0.5), Vec3::new(0.5, 0.1, 0.4)];
        let side = || grey(0.5);
        let builder = SceneBuilder::default()
            .room(Vec3::NEG_ONE, Vec3::ONE, [side(), side(), side(), side(), side(), side()])
            .quad("lamp", Vec3::new(-0.1, 0.99, -0.1), [0.2 * Vec3::X, 0.2 * Vec3::Z], glowing(0.0, 100.0));
        light_at(&with_box(builder, "thing", corners, &material(roughness)).build(), &points, 256)
    });
    same_but_for_rounding(&fine?, &smooth?, 1e-9)
}

/// The ground under a slab of rough glass, which loses and reflects nothing.
fn under_slab(ior: f32, roughness: f32, truth: f64, tolerance: f64) -> Verdict {
    let mut builder = level(SceneBuilder::default(), "ground", -1.0, [100.0, 1.0], grey(0.0));
    builder = level(builder, "top", 0.0, [100.0, 1.0], glass(ior, roughness));
    builder = level(builder, "bottom", -0.5, [100.0, -1.0], glass(ior, roughness));
    let scene = builder.sky(Vec3::ONE).build();
    all_read(&light_at(&scene, &[at(Vec3::new(0.1, -1.0, 0.2), Vec3::Y)], 1 << 12)?, truth, tolerance)
}

/// From within glass of index 1.5 over a floor of radiance 3, at the critical angle and `past` it [rad]. The sky's
/// radiance is 1.
fn critical(past: f64) -> Verdict {
    let mut builder =
        level(SceneBuilder::default(), "water", 0.0, [1000.0, 1.0], of(Scattering::Refraction { ior: 1.5 }));
    builder = level(builder, "floor", -2.0, [1000.0, 1.0], glowing(0.0, 3.0));
    let scene = builder.sky(Vec3::ONE).build();
    let angle = (1.0_f64 / 1.5).asin() + past;
    let reflected = fresnel(angle.cos(), 1.0 / 1.5);
    let truth = 3.0 * reflected + 2.25 * (1.0 - reflected);
    let direction = Vec3::new(angle.sin() as f32, angle.cos() as f32, 0.0);
    let tolerance = if past > 1e-6 {
        3e-4
    } else if past > 0.0 {
        6e-2
    } else {
        3e-2
    };
    sees(&scene, [Vec3::NEG_Y, Vec3::NEG_Y + direction], 1 << 12, truth, tolerance)
}

fn nested() -> Verdict {
    let (outer, inner) = (sphere(Vec3::ZERO, 0.9, 3), sphere(Vec3::new(0.1, 0.0, 0.0), 0.5, 3));
    let scene = room_of_radiance_one()
        .mesh("outer", outer.0, outer.1, None, glass(1.5, 0.0))
        .mesh("inner", inner.0, inner.1, None, glass(1.3, 0.0))
        .build();
    furnace_of_one(&scene, 1 << 12, 5e-3)
}

fn inside_out() -> Verdict {
    let glass = || glass(1.5, 0.0);
    let body = SceneBuilder::default()
        .room(Vec3::new(-0.8, -0.6, -0.7), Vec3::new(0.7, 0.8, 0.8), [(); 6].map(|()| glass()))
        .build();
    let mut scene = room_of_radiance_one().build();
    let (meshes, materials) = (scene.meshes.len(), scene.materials.len());
    scene.instances.extend(body.instances.into_iter().map(|mut instance| {
        instance.id = bevy_kiln::artefact::StableId::new(format!("body {}", instance.name));
        instance.mesh += meshes;
        instance.material += materials;
        instance
    }));
    scene.meshes.extend(body.meshes);
    scene.materials.extend(body.materials);
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

fn side_by_side() -> Verdict {
    let [left, right] =
        [[-0.8, 0.0], [1e-6, 0.8]].map(|[low, high]: [f32; 2]| [Vec3::new(low, -0.7, -0.7), Vec3::new(high, 0.7, 0.7)]);
    let builder = with_box(room_of_radiance_one(), "left", left, &glass(1.5, 0.0));
    let scene = with_box(builder, "right", right, &glass(1.5, 0.0)).build();
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

fn fresnel_average() -> f64 {
    integrate(|cosine| 2.0 * cosine * fresnel(cosine, 1.5))
}

fn water(interior: Interior) -> SceneBuilder {
    let water = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, interior, ..Standard::default() };
    let builder = level(SceneBuilder::default(), "ground", -0.5, [400.0, 1.0], grey(0.0));
    level(builder, "water", 0.0, [400.0, 1.0], standard(water)).sky(Vec3::ONE)
}

fn under_water(interior: Interior) -> Verdict {
    let reading = light_at(&water(interior).build(), &[at(Vec3::new(0.0, -0.5, 0.0), Vec3::Y)], 1 << 16)?[0];
    reads(&reading, PI * (1.0 - fresnel_average()), 1e-2)
}

/// Red passes, the rest does not.
fn red_alone(reading: &bevy_kiln::bake::MeterReading, truth: f64) -> Verdict {
    let mut red = *reading;
    red.irradiance = glam::DVec3::splat(reading.irradiance.x);
    red.stderr = glam::DVec3::splat(reading.stderr.x);
    reads(&red, truth, 1e-2)?;
    if reading.irradiance.y == 0.0 && reading.irradiance.z == 0.0 {
        Ok(())
    } else {
        Err(format!("{}", reading.irradiance))
    }
}

fn short_attenuation() -> Verdict {
    let interior = Interior::Volume { attenuation_colour: Vec3::new(1.0, 0.5, 0.0), attenuation_distance: 1e-6 };
    let reading = light_at(&water(interior).build(), &[at(Vec3::new(0.0, -0.5, 0.0), Vec3::Y)], 1 << 16)?[0];
    red_alone(&reading, PI * (1.0 - fresnel_average()))
}

/// Above a sheet of glass that faces down: what goes down enters a body that has no end.
fn open_body() -> Verdict {
    let interior = Interior::Volume { attenuation_colour: Vec3::new(1.0, 0.5, 0.0), attenuation_distance: 1e-6 };
    let glass = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, interior, ..Standard::default() };
    let scene = level(SceneBuilder::default(), "sheet", 0.0, [4000.0, 1.0], standard(glass)).sky(Vec3::ONE).build();
    let reading = light_at(&scene, &[at(Vec3::new(0.0, 1.0, 0.0), Vec3::NEG_Y)], 1 << 16)?[0];
    // What is reflected is the sky of all colours; what crosses, to 1/n² of the radiance there, that of red.
    let reflected = fresnel_average();
    let red = PI * (reflected + (1.0 - reflected) / 2.25);
    let off = (reading.irradiance.x - red).abs() + 4.0 * reading.stderr.x;
    let others = (reading.irradiance.y - PI * reflected).abs() + 4.0 * reading.stderr.y;
    if off <= 1e-2 * red && others <= 5e-2 * PI * reflected { Ok(()) } else { Err(format!("{}", reading.irradiance)) }
}

fn black_attenuation() -> Verdict {
    let black = |attenuation_distance| Interior::Volume { attenuation_colour: Vec3::ZERO, attenuation_distance };
    let point = [at(Vec3::new(0.0, -0.5, 0.0), Vec3::Y)];
    let dark = light_at(&water(black(1e-6)).build(), &point, 1 << 12)?[0];
    if dark.irradiance != glam::DVec3::ZERO {
        return Err(format!("black glass lets {} through", dark.irradiance));
    }
    light_at(&water(black(1e6)).build(), &point, 1 << 12)?;
    under_water(black(f32::INFINITY))
}

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

fn phong(exponent: f32, albedos: [f64; 3]) -> Verdict {
    let phong = Scattering::Phong { specular: Vec3::ONE, exponent };
    let material = Material::scattering("phong", Vec3::ZERO, phong);
    let scene = level(SceneBuilder::default(), "plate", 0.0, [10.0, 1.0], material).sky(Vec3::ONE).build();
    for (degrees, albedo) in [0.0_f32, 60.0, 80.0].into_iter().zip(albedos) {
        let (sin, cos) = degrees.to_radians().sin_cos();
        sees(&scene, [Vec3::new(sin, cos, 0.0), Vec3::ZERO], 1 << 16, albedo, 1e-2)
            .map_err(|error| format!("{degrees}°: {error}"))?;
    }
    Ok(())
}

/// A furnace with a wall of perfect metal at −x, whose vertices have this normal and which may have a normal map of
/// one texel.
fn shaded(normal: Vec3, texel: Option<[f32; 4]>) -> Verdict {
    let lit = || glowing(0.5, 0.5);
    let mut scene =
        SceneBuilder::default().room(Vec3::NEG_ONE, Vec3::ONE, [metal(0.0), lit(), lit(), lit(), lit(), lit()]).build();
    scene.meshes[0].normals = Some(vec![normal; 4]);
    if let Some(texel) = texel {
        scene.textures = vec![Texture {
            name: "normals".into(),
            width: 1,
            height: 1,
            texels: Texels::Float([texel].into()),
            wrap: [Wrap::Clamp; 2],
            filter: Filter::Linear,
        }];
        let texture = TextureRef { texture: 0, uv: UvChannel::Uv1 };
        scene.materials[0].normal_map = Some(NormalMap { texture, encoding: NormalEncoding::OpenGl });
    }
    furnace_of_one(&scene, 1 << 12, 3e-3)
}

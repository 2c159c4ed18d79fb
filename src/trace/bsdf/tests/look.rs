//! The matt part and its look against the whole response: never more, and all of it where nothing else is spread out.

use super::super::standard::{Standard, StandardParameters};
use super::super::{Bsdf, Density, Phong};
use super::subject::{ANGLES, TABLES, outgoing};
use crate::scene::Interior;
use glam::Vec3;

/// A material of Bevy's, pane and varnish included.
fn standard([metallic, roughness, reflectance, clear, diffuser, varnish]: [f32; 6]) -> Bsdf<'static> {
    let at = StandardParameters {
        base_colour: Vec3::new(0.7, 0.5, 0.2),
        metallic,
        perceptual_roughness: roughness,
        reflectance,
        specular_tint: Vec3::new(1.0, 0.8, 0.9),
        specular_transmission: clear,
        eta: 1.0,
        interior: Interior::ThinWalled,
        diffuse_transmission: diffuser,
        clearcoat: varnish,
        clearcoat_perceptual_roughness: roughness,
    };
    Bsdf::Standard(Standard::new(&at, &TABLES))
}

fn directions() -> impl Iterator<Item = Vec3> {
    let around = [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::new(-1.0, -1.0, 1.0), Vec3::new(1.0, 1.0, -1.0)];
    ANGLES.into_iter().flat_map(move |degrees| around.map(|side| outgoing(degrees) * side))
}

/// How far the matt part is above the whole, and below it, relative, at the most.
fn off(bsdf: &Bsdf<'_>, look: impl Fn(f32) -> Vec3) -> [f32; 2] {
    let mut off = [0.0_f32; 2];
    for wo in ANGLES.map(outgoing) {
        for wi in directions() {
            let whole = bsdf.evaluate(wo, wi);
            if whole == Vec3::ZERO {
                continue;
            }
            let share = bsdf.matt_over(whole, wi) * look(wo.z);
            off = [off[0].max((share - 1.0).max_element()), off[1].max((1.0 - share).max_element())];
        }
    }
    off
}

#[test]
fn the_matt_part_is_never_more_than_the_whole() {
    let mut count = 0;
    for metallic in [0.0, 0.5] {
        for roughness in [0.0, 0.4, 1.0] {
            for [reflectance, varnish] in [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.5, 1.0]] {
                for [clear, diffuser] in [[0.0, 0.0], [0.0, 0.4], [0.6, 0.4]] {
                    let bsdf = standard([metallic, roughness, reflectance, clear, diffuser, varnish]);
                    let Some(look) = bsdf.look() else { continue };
                    count += 1;
                    let [above, below] = off(&bsdf, |cos| look.from(cos));
                    assert!(above < 1e-5, "{bsdf:?}: {above}");
                    // Nothing else is spread out: all of it is matt, but for what a varnish and its product differ by.
                    if roughness == 0.0 && clear == 0.0 && varnish == 0.0 {
                        assert!(below < 1e-5, "{bsdf:?}: {below}");
                    }
                }
            }
        }
    }
    assert!(count > 40, "{count}");
    let phong = Bsdf::Phong(Phong { diffuse: Vec3::splat(0.5), specular: Vec3::splat(0.3), exponent: 9.0 });
    let look = phong.look().expect("something matt");
    let [above, below] = off(&phong, |cos| look.from(cos));
    assert!(above < 1e-5 && below > 0.1, "{above} {below}");
}

/// A look that is the same from everywhere, and one of a neighbouring angle.
#[test]
fn faulty_looks_are_rejected() {
    let bsdf = standard([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    let look = bsdf.look().expect("something matt");
    assert!(off(&bsdf, |_| look.from(1.0))[0] > 0.1);
    assert!(off(&bsdf, |_| look.from(0.01))[1] > 0.1);
    assert!(off(&bsdf, |cos| look.from(0.97 * cos))[1] > 1e-3);
}

#[test]
fn what_goes_in_one_direction_and_what_has_no_matt_part_is_not_matt() {
    let metal = standard([1.0, 0.4, 0.5, 0.0, 0.0, 0.0]);
    let glass = standard([0.0, 0.4, 0.5, 1.0, 0.0, 0.0]);
    assert!(metal.look().is_none() && glass.look().is_none() && Bsdf::None.look().is_none());
    let paint = standard([0.0, 0.0, 0.5, 0.0, 0.0, 0.0]);
    assert_eq!(paint.matt_over_sample(Vec3::ONE, Density::Delta, Vec3::Z), Vec3::ZERO);
}

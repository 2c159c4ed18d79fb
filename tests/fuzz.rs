//! Scenes thrown together by chance, of all that a scene may have. Their light is not known, but its laws are: it is a
//! finite number that is not negative, whatever is forced off; a furnace whose things lose nothing stays at its
//! radiance, and one whose things lose some stays below; the three estimators agree, and so do the kernel of the plan
//! and that of everything; a mirrored world is as bright. What judges by statistics rejects a planted fault besides.

mod common;

#[path = "fuzz/anything.rs"]
mod anything;

use anything::{Chance, TEXTURES, alpha, anything, lamp, material, mesh, points, put, room, texture};
use bevy_kiln::bake::MeterPoint;
use bevy_kiln::scene::{Alpha, Interior, Light, Material, Mesh, Scattering, Scene, Standard};
use bevy_kiln::trace::{Effect, EffectSet, Estimator, ForcedEffects, Transport};
use common::meter::{at, read};
use glam::{Affine3A, Vec3};
use std::f64::consts::PI;

const ESTIMATORS: [Estimator; 3] = [Estimator::Mis, Estimator::Light, Estimator::Bsdf];

/// The mean of green over all readings and its standard error, over π.
#[derive(Clone, Copy, Debug)]
struct Mean(f64, f64);

impl Mean {
    fn of(scene: &Scene, points: &[MeterPoint], samples: u32, transport: Transport) -> Self {
        let (mean, error) = common::meter::mean(&read(scene, points, samples, transport), 1);
        Self(mean / PI, error / PI)
    }

    /// By how many standard errors this one is above another.
    fn above(self, other: Self) -> f64 {
        let off = self.0 - other.0;
        // Darkness has no error.
        if off.abs() <= SLACK * self.0.max(other.0) { 0.0 } else { off / self.1.hypot(other.1) }
    }
}

/// By how much what is known may be missed: tables of albedo are no better.
const SLACK: f64 = 2e-3;

/// Standard errors beyond which two means are not the same: of 16 replicates each, so that of the hundreds of tests
/// here none is rejected by chance.
const TOO_FAR: f64 = 6.0;

/// A radiance of 1 that is known.
const ONE: Mean = Mean(1.0, 0.0);

fn forced(on: EffectSet, off: EffectSet) -> Transport {
    Transport { effects: ForcedEffects { on, off }, ..Transport::default() }
}

#[test]
fn light_is_a_number_and_not_negative() {
    for seed in 0..24 {
        let chance = &mut Chance::new(1000 + seed);
        let mut scene = anything(seed);
        for number in 0..chance.below(4) {
            let (scale, radius) = (chance.size(-20.0, 20.0), chance.size(-12.0, 0.0));
            scene.lights.push(lamp(number, scale, chance.one(&[0.0, radius]), chance));
        }
        assert_eq!(scene.validate(), []);
        let [on, off] = [0, 1].map(|_| Effect::ALL.into_iter().filter(|_| chance.says(0.15)).collect());
        let transport = Transport { estimator: chance.one(&ESTIMATORS), seed, ..forced(on, off) };
        for reading in read(&scene, &points(), 64, transport) {
            let light = reading.irradiance;
            assert!(light.is_finite() && light.min_element() >= 0.0, "seed {seed}: {reading:?}");
        }
    }
}

fn lossless(chance: &mut Chance) -> Material {
    let interior = Interior::Volume { attenuation_colour: Vec3::ONE, attenuation_distance: 1.0 };
    let paper = Standard { reflectance: 0.0, diffuse_transmission: chance.unit(), ..Standard::default() };
    let pane = Standard {
        specular_transmission: 1.0,
        perceptual_roughness: chance.one(&[0.0, 0.3, 0.8, 1.0]),
        ..Standard::default()
    };
    let glass = Standard { specular_transmission: 1.0, perceptual_roughness: 0.0, interior, ..Standard::default() };
    let varnish = Standard { metallic: 1.0, perceptual_roughness: 0.0, clearcoat: 1.0, ..Standard::default() };
    let standard = |standard| Scattering::Standard(Box::new(standard));
    let [paper, pane, glass, varnish] = [paper, pane, glass, varnish].map(standard);
    let body = Scattering::Refraction { ior: 1.5 };
    let scattering = chance.one(&[Scattering::Diffuse, Scattering::Mirror, body, paper, pane, glass, varnish]);
    Material {
        base_colour: Vec3::ONE.extend(chance.unit()),
        alpha: alpha(chance),
        ..Material::scattering("lossless", Vec3::ONE, scattering)
    }
}

/// Gives off as much as it takes of a radiance of 1.
fn balanced(material: Material) -> Material {
    let emitted_radiance = Vec3::ONE - material.base_colour.truncate();
    Material { emitted_radiance, double_sided: true, ..material }
}

/// Walls around things that lose nothing, or give off as much as they take (Szirmay-Kalos 2001): radiance 1.
#[test]
fn what_loses_nothing_keeps_a_furnace_at_its_radiance() {
    let mut seen = 0;
    for seed in 0..12 {
        let chance = &mut Chance::new(2000 + seed);
        let albedo = chance.one(&[0.0, 0.3, 0.8]);
        let mut scene = room(&balanced(Material::diffuse("wall", Vec3::splat(albedo))));
        for _ in 0..1 + chance.below(3) {
            // Colours would take light; and where smooth normals mirror light into the surface, it is lost.
            let mesh = Mesh { colours: None, normals: None, ..mesh(chance) };
            let mut material = lossless(chance);
            if chance.says(0.3) {
                let (colour, alpha) = (chance.colour(), chance.one(&[Alpha::Opaque, Alpha::Blend]));
                let scattering = chance.one(&[Scattering::Diffuse, Scattering::Mirror]);
                let base_colour = colour.extend(material.base_colour.w);
                material = balanced(Material { base_colour, scattering, alpha, ..material });
            }
            put(&mut scene, mesh, material, chance);
        }
        let transport = Transport { estimator: chance.one(&ESTIMATORS), seed, ..Transport::default() };
        let found = Mean::of(&scene, &points()[..6], 512, transport);
        assert!(found.above(ONE).abs() < TOO_FAR, "seed {seed}: {found:?}\n{:#?}", scene.materials);
        let fault = Transport { max_bounces: Some(3), ..transport };
        seen += u32::from(Mean::of(&scene, &points()[..6], 512, fault).above(ONE) < -TOO_FAR);
    }
    assert!(seen > 5, "{seen} lost bounces were seen");
}

/// Walls around anything that gives off nothing: radiance 1 at most.
#[test]
fn nothing_makes_light() {
    let mut seen = 0;
    for seed in 0..12 {
        let chance = &mut Chance::new(3000 + seed);
        let albedo = chance.one(&[0.0, 0.3, 0.8]);
        let mut scene = room(&balanced(Material::diffuse("wall", Vec3::splat(albedo))));
        scene.textures = (0..TEXTURES).map(|_| texture(chance)).collect();
        for _ in 0..1 + chance.below(4) {
            let (mesh, mut material) = (mesh(chance), material(chance));
            // Within a body light is denser: a hole in it is no hole to the outside.
            if is_body(&material.scattering) {
                material.alpha = Alpha::Opaque;
            }
            put(&mut scene, mesh, material, chance);
        }
        let transport = Transport { estimator: chance.one(&ESTIMATORS), seed, ..Transport::default() };
        let found = Mean::of(&scene, &points()[..6], 256, transport);
        assert!(found.above(ONE) < TOO_FAR, "seed {seed}: {found:?}\n{:#?}", scene.materials);
        scene.materials[..6].iter_mut().for_each(|wall| wall.emitted_radiance *= 1.1);
        seen += u32::from(Mean::of(&scene, &points()[..6], 256, transport).above(ONE) > TOO_FAR);
    }
    assert!(seen > 2, "{seen} times a tenth too much was seen");
}

fn is_body(scattering: &Scattering) -> bool {
    match scattering {
        Scattering::Refraction { .. } => true,
        Scattering::Standard(standard) => standard.interior != Interior::ThinWalled,
        _ => false,
    }
}

/// In anything, with lamps that rays meet.
#[test]
fn the_estimators_agree() {
    let mut seen = 0;
    for seed in 0..8 {
        let chance = &mut Chance::new(4000 + seed);
        let mut scene = anything(500 + seed);
        for number in 0..chance.below(3) {
            scene.lights.push(lamp(number, 1.0, 0.2 + 0.3 * chance.unit(), chance));
        }
        assert_eq!(scene.validate(), []);
        let by = |estimator: Estimator, samples, seed| {
            Mean::of(&scene, &points(), samples, Transport { estimator, seed, ..Transport::default() })
        };
        let mis = by(Estimator::Mis, 512, seed);
        for estimator in [Estimator::Light, Estimator::Bsdf] {
            let other = by(estimator, 1024, 100 * (estimator as u64 + 1) + seed);
            assert!(mis.above(other).abs() < TOO_FAR, "seed {seed}, {estimator:?}: {mis:?}, {other:?}");
            seen += u32::from(Mean(1.1 * mis.0, 1.1 * mis.1).above(other) > TOO_FAR);
        }
    }
    assert!(seen > 5, "{seen} times a tenth too much was seen");
}

/// A material with little of what it might have, so that scenes of such call for small kernels.
fn sparse(chance: &mut Chance) -> Material {
    let full = material(chance);
    let plain = Material::diffuse("plain", chance.colour());
    let [scatters, has_colours, has_alpha, has_relief] = [0.5, 0.3, 0.3, 0.2].map(|share| chance.says(share));
    let mut scattering = full.scattering.clone();
    if let Scattering::Standard(standard) = &mut scattering {
        // One of its lobes.
        let kept = chance.below(5);
        let lobes = [
            &mut standard.reflectance,
            &mut standard.metallic,
            &mut standard.specular_transmission,
            &mut standard.diffuse_transmission,
            &mut standard.clearcoat,
        ];
        lobes.into_iter().enumerate().filter(|(lobe, _)| *lobe != kept).for_each(|(_, share)| *share = 0.0);
    }
    let scatters = scatters && !matches!(scattering, Scattering::Phong { .. });
    Material {
        base_colour: if has_alpha { full.base_colour } else { plain.base_colour },
        base_colour_texture: full.base_colour_texture.filter(|_| has_colours),
        alpha: if has_alpha { full.alpha } else { Alpha::Opaque },
        normal_map: full.normal_map.filter(|_| has_relief),
        scattering: if scatters { scattering } else { plain.scattering },
        emission_texture: full.emission_texture.filter(|_| has_colours),
        ..full
    }
}

/// What a scene does not call for changes nothing but time: the same paths by the kernel of everything. (Two glowing
/// triangles may be one lamp in the one and two in the other, so that paths differ; their mean does not.)
#[test]
fn the_kernel_of_the_plan_has_all_that_a_scene_needs() {
    let all: EffectSet = Effect::ALL.into_iter().collect();
    let mut same = 0;
    for seed in 0..24 {
        let chance = &mut Chance::new(5000 + seed);
        let mut scene = anything(700 + seed);
        let thing = sparse(chance);
        let wall = if chance.says(0.5) { thing.clone() } else { Material::diffuse("wall", Vec3::splat(0.5)) };
        for (index, material) in scene.materials.iter_mut().enumerate() {
            *material = if index < 6 { wall.clone() } else { thing.clone() };
            material.emitted_radiance = Vec3::splat(if index % 3 == 1 { 1.0 } else { 0.0 });
        }
        let [planned, full] = [EffectSet::NONE, all]
            .map(|on| Mean::of(&scene, &points(), 64, Transport { seed, ..forced(on, EffectSet::NONE) }));
        same += u32::from((planned.0 - full.0).abs() <= 1e-5 * full.0);
        assert!(planned.above(full).abs() < TOO_FAR, "seed {seed}: {planned:?}, {full:?}\n{thing:#?}");
    }
    assert!(same >= 21, "{same} of 24 had the same paths");
}

/// A world seen in a mirror is as bright, relief and all.
#[test]
fn a_mirrored_world_has_the_same_light() {
    let flip = Vec3::new(-1.0, 1.0, 1.0);
    for seed in 0..8 {
        let chance = &mut Chance::new(6000 + seed);
        let mut scene = anything(900 + seed);
        scene.environment = None;
        scene.lights.extend((0..2).map(|number| lamp(number, 1.0, 0.2, chance)));
        let mut mirrored = scene.clone();
        for instance in &mut mirrored.instances {
            instance.world_from_local = Affine3A::from_scale(flip) * instance.world_from_local;
        }
        for light in &mut mirrored.lights {
            match light {
                Light::Point(bulb) => bulb.position *= flip,
                Light::Spot(spot) => {
                    spot.bulb.position *= flip;
                    spot.direction *= flip;
                }
                Light::Directional(sun) => sun.direction *= flip,
                // A rotation again, since the rectangle is its own mirror image.
                Light::Rect(lamp) => {
                    let flip = Affine3A::from_scale(flip);
                    lamp.world_from_local = flip * lamp.world_from_local * flip;
                }
            }
        }
        let points = points();
        let reflected: Vec<MeterPoint> =
            points.iter().map(|point| at(point.position * flip, point.normal * flip)).collect();
        let transport = Transport { seed, ..Transport::default() };
        let one = Mean::of(&scene, &points, 256, transport);
        let other = Mean::of(&mirrored, &reflected, 256, transport);
        assert!(one.above(other).abs() < TOO_FAR, "seed {seed}: {one:?}, {other:?}");
    }
}

//! What the first pass hands on, and what comes of faults in it.

use super::*;
use crate::artefact::StableId;
use crate::bake::sites::Sites;
use crate::bake::unwrap::LaidOut;
use crate::math::luminance;
use crate::scene::{Indices, Instance, Light, LightmapRequest, Material, Mesh, RectLight, Scene};
use crate::trace::Compiled;
use glam::{Affine3A, Quat, Vec2, Vec3};

/// Paths of each texel by which both ways are compared.
const PATHS: u32 = 256;

/// Adds a rectangle whose front is the side of `edge_u` × `edge_v`.
fn add(scene: &mut Scene, name: &str, corner: Vec3, [u, v]: [Vec3; 2]) {
    scene.instances.push(Instance {
        id: StableId::new(name),
        name: name.into(),
        mesh: scene.meshes.len(),
        material: 0,
        world_from_local: Affine3A::IDENTITY,
        lightmap: Some(LightmapRequest::default()),
    });
    scene.meshes.push(Mesh {
        name: name.into(),
        indices: Indices::U16(vec![0, 1, 2, 0, 2, 3]),
        positions: vec![corner, corner + u, corner + u + v, corner + v],
        uv1: Some(vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]),
        ..Mesh::default()
    });
}

/// Two rooms of 2 m with a wall of 5 mm between them, which stands in the middle of a texel of the floor and leaves a
/// door free; a lamp in one of them.
fn two_rooms() -> Scene {
    let mut scene = Scene { materials: vec![Material::diffuse("grey", Vec3::splat(0.6))], ..Scene::default() };
    let [x, y, z] = [Vec3::X * 4.0, Vec3::Y * 2.0, Vec3::Z * 2.0];
    add(&mut scene, "floor", Vec3::ZERO, [z, x]);
    add(&mut scene, "ceiling", y, [x, z]);
    add(&mut scene, "bright end", Vec3::ZERO, [y, z]);
    add(&mut scene, "dark end", x, [z, y]);
    add(&mut scene, "back", Vec3::ZERO, [x, y]);
    add(&mut scene, "front", z, [y, x]);
    let wall = |x: f32| Vec3::X * x;
    add(&mut scene, "wall, bright", wall(1.9), [z * 0.6, y]);
    add(&mut scene, "wall, dark", wall(1.905), [y, z * 0.6]);
    add(&mut scene, "jamb", wall(1.9) + z * 0.6, [wall(0.005), y]);
    let down = Quat::from_rotation_arc(Vec3::NEG_Z, Vec3::NEG_Y);
    scene.lights.push(Light::Rect(RectLight {
        id: StableId::new("lamp"),
        name: "lamp".into(),
        world_from_local: Affine3A::from_rotation_translation(down, Vec3::new(0.8, 1.9, 0.7)),
        width: 0.4,
        height: 0.4,
        radiance: Vec3::splat(50.0),
        range: None,
    }));
    scene
}

/// A fault that is planted in what the tracer is told.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// Twice the light.
    Doubled,
    /// The sides of the wall exchanged: who meets one reads the other.
    Backs,
    /// Texels that the wall cuts are read as the rest.
    Cut,
}

/// Luminance of each texel.
fn measured(later_bounces: LaterBounces, fault: Fault, seed: u64) -> Vec<f64> {
    let mut settings = BakeSettings { later_bounces, density: 5.0, ..BakeSettings::default() };
    settings.transport.seed = seed;
    let (cancel, scene) = (CancelToken::default(), two_rooms());
    let workers = Workers::new(None, &(), &cancel).unwrap();
    let laid_out = LaidOut::new(&scene, &settings, &workers).unwrap();
    let tracer = Compiled::new(&laid_out.scene, &settings.transport).tracer;
    let atlas = Atlas::new(&laid_out, &tracer, &settings, &cancel).unwrap();
    let sites = Sites::new(&laid_out.scene, &tracer, &atlas, &settings, &workers).unwrap().seen;
    let transport = &settings.transport;
    if later_bounces == LaterBounces::Reused {
        let place = Place { tracer: &tracer, atlas: &atlas, sites: &sites };
        let (mut estimates, _) = place.measured(FIRST_PATHS, transport, &workers).unwrap();
        if fault == Fault::Cut {
            estimates.iter_mut().for_each(|estimate| estimate.accepted = 1.0);
        }
        let mut known = place.known_light(&estimates);
        let first = |name: &str| {
            let named = |receiver: &&crate::trace::Receiver| scene.instances[receiver.instance].name == name;
            tracer.receivers().iter().find(named).unwrap().first_triangle as usize
        };
        match fault {
            Fault::None | Fault::Cut => (),
            Fault::Doubled => {
                known.grids.iter_mut().flat_map(|grid| &mut grid.cells).for_each(|cell| cell.radiance *= 2.0)
            }
            Fault::Backs => {
                let (bright, dark) = (first("wall, bright"), first("wall, dark"));
                (0..2).for_each(|triangle| known.unfolded.swap(bright + triangle, dark + triangle));
            }
        }
        tracer.learn(known);
    }
    let luminance = |site: &Site, cancel: &CancelToken| {
        site.estimate(&tracer, PATHS, transport, cancel).map(|estimate| luminance(estimate.mean))
    };
    workers.gather_quietly(&sites, luminance).unwrap()
}

/// How far the means of two lists of bakes are apart.
struct Apart {
    /// Over the mean, and its standard error.
    mean: [f64; 2],
    /// Root mean square over texels without noise, each over its value, and what that is at most by its standard error.
    per_texel: [f64; 2],
}

const SEEDS: u64 = 6;

fn bakes(later_bounces: LaterBounces, fault: Fault) -> Vec<Vec<f64>> {
    let salt = if later_bounces == LaterBounces::Traced { 100 } else { 0 };
    (0..SEEDS).map(|seed| measured(later_bounces, fault, salt + seed)).collect()
}

fn mean_and_variance(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    [mean, values.map(|value| (value - mean).powi(2)).sum::<f64>() / (count * (count - 1.0))]
}

fn apart(truth: &[Vec<f64>], other: &[Vec<f64>]) -> Apart {
    let of_all = |bakes: &[Vec<f64>]| {
        mean_and_variance(bakes.iter().map(|bake| bake.iter().sum::<f64>()).collect::<Vec<_>>().into_iter())
    };
    let [[truth_mean, truth_variance], [other_mean, other_variance]] = [of_all(truth), of_all(other)];
    let floor = 0.1 * truth_mean / truth[0].len() as f64;
    let of_texel = |texel: usize| {
        let [[a, of_a], [b, of_b]] =
            [truth, other].map(|bakes| mean_and_variance(bakes.iter().map(move |bake| bake[texel])));
        ((a - b).powi(2) - of_a - of_b) / a.max(floor).powi(2)
    };
    let [square, variance] = mean_and_variance((0..truth[0].len()).map(of_texel).collect::<Vec<_>>().into_iter());
    Apart {
        mean: [other_mean / truth_mean - 1.0, (truth_variance + other_variance).sqrt() / truth_mean],
        per_texel: [square.max(0.0).sqrt(), (square + 4.0 * variance.sqrt()).max(0.0).sqrt()],
    }
}

impl Apart {
    /// Whether the second list is biased by less than is promised.
    fn is_close(&self) -> bool {
        self.mean[0].abs() + 4.0 * self.mean[1] <= 0.01 && self.per_texel[1] <= 0.02
    }
}

#[test]
fn texels_are_light_that_is_reused_without_bias_and_faults_are_found() {
    let truth = bakes(LaterBounces::Traced, Fault::None);
    for fault in [Fault::None, Fault::Doubled, Fault::Backs, Fault::Cut] {
        let Apart { mean, per_texel } = apart(&truth, &bakes(LaterBounces::Reused, fault));
        let percent = |[a, b]: [f64; 2]| [100.0 * a, 100.0 * b];
        println!(
            "{fault:?}: mean and its error {:.3?} %, per texel and its most {:.3?} %",
            percent(mean),
            percent(per_texel)
        );
        assert_eq!(Apart { mean, per_texel }.is_close(), fault == Fault::None, "{fault:?}");
    }
}

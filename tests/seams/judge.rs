//! What must hold of a finished lightmap: how far apart the two sides of a seam are shown, found by comparing every
//! edge with every other.

use bevy_kiln::bake::{BakeSettings, CancelToken, Filtering, Goal, Lightmap, bake_lightmap};
use bevy_kiln::scene::{Indices, Mesh, Scene};
use glam::{Vec2, Vec3};
use std::num::NonZeroUsize;

/// Points compared along each piece of an edge.
const POINTS: u32 = 101;

/// The jump that nobody sees.
pub const TARGET: f32 = 0.01;

/// Two ways to look up one point.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// By object, and where on it.
    pub sides: [(usize, Vec2); 2],
}

/// Which edges are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    Smooth,
    Hard,
}

struct Edge {
    object: usize,
    ends: [Vec3; 2],
    uv: [Vec2; 2],
    normals: [Vec3; 2],
}

fn edges(scene: &Scene) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (object, instance) in scene.instances.iter().enumerate().filter(|(_, instance)| instance.lightmap.is_some()) {
        let mesh = &scene.meshes[instance.mesh];
        let uv1 = mesh.uv1.as_ref().unwrap();
        for triangle in mesh.triangles() {
            let world =
                triangle.map(|vertex| instance.world_from_local.transform_point3(mesh.positions[vertex as usize]));
            let flat = (world[1] - world[0]).cross(world[2] - world[0]).normalize();
            let normal = |vertex: u32| match &mesh.normals {
                Some(normals) => instance.world_from_local.transform_vector3(normals[vertex as usize]).normalize(),
                None => flat,
            };
            for corner in 0..3 {
                let next = (corner + 1) % 3;
                edges.push(Edge {
                    object,
                    ends: [world[corner], world[next]],
                    uv: [corner, next].map(|corner| uv1[triangle[corner] as usize]),
                    normals: [corner, next].map(|corner| normal(triangle[corner])),
                });
            }
        }
    }
    edges
}

/// The scene with the meshes that a game shows: those that were given a UV1 take it.
pub fn displayed(scene: &Scene, lightmap: &Lightmap) -> Scene {
    let mut scene = scene.clone();
    for placement in &lightmap.placements {
        let Some(laid_out) = placement.mesh.map(|mesh| &lightmap.meshes[mesh]) else { continue };
        let source = &scene.meshes[laid_out.source];
        let taken = |from: &Vec<Vec3>| laid_out.vertices.iter().map(|&vertex| from[vertex as usize]).collect();
        let mesh = Mesh {
            positions: taken(&source.positions),
            normals: source.normals.as_ref().map(taken),
            uv1: Some(laid_out.uv1.clone()),
            indices: Indices::U32(laid_out.indices.clone()),
            ..Mesh::default()
        };
        let number = scene.meshes.len();
        scene.meshes.push(mesh);
        scene.instances.iter_mut().filter(|instance| instance.id == placement.id).for_each(|i| i.mesh = number);
    }
    scene
}

/// Points on pairs of edges that lie on each other, in part or whole, and are shown by different texels.
pub fn pairs(scene: &Scene, wanted: Edges) -> Vec<Pair> {
    let edges = edges(scene);
    let mut pairs = Vec::new();
    for (number, a) in edges.iter().enumerate() {
        let along = a.ends[1] - a.ends[0];
        let place = |point: Vec3| (point - a.ends[0]).dot(along) / along.length_squared();
        let off = |point: Vec3| (point - a.ends[0] - along * place(point)).length();
        for b in &edges[number + 1..] {
            if b.ends.iter().any(|&end| off(end) > 1e-4) {
                continue;
            }
            let [from, to] = b.ends.map(place);
            let (low, high) = (from.min(to).max(0.0), from.max(to).min(1.0));
            if (high - low) * along.length() < 1e-3 {
                continue;
            }
            for point in 0..POINTS {
                let at = low + (high - low) * (point as f32 + 0.5) / POINTS as f32;
                let there = (at - from) / (to - from);
                let uv = [a.uv[0].lerp(a.uv[1], at), b.uv[0].lerp(b.uv[1], there)];
                let normals = [a.normals[0].lerp(a.normals[1], at), b.normals[0].lerp(b.normals[1], there)];
                let is_smooth = normals[0].normalize().dot(normals[1].normalize()) > 0.999;
                let is_one_chart = a.object == b.object && uv[0].distance(uv[1]) < 1e-5;
                if !is_one_chart && is_smooth == (wanted == Edges::Smooth) {
                    pairs.push(Pair { sides: [(a.object, uv[0]), (b.object, uv[1])] });
                }
            }
        }
    }
    assert!(!pairs.is_empty() || wanted == Edges::Hard, "no seams to look at");
    pairs
}

/// How a lightmap is looked up.
pub struct Look<'a> {
    pub scene: &'a Scene,
    pub lightmap: &'a Lightmap,
    pub filtering: Filtering,
    /// By how much lookups are moved: a fault [texels].
    pub shift: Vec2,
}

impl<'a> Look<'a> {
    pub fn new(scene: &'a Scene, lightmap: &'a Lightmap, filtering: Filtering) -> Self {
        Self { scene, lightmap, filtering, shift: Vec2::ZERO }
    }

    pub fn at(&self, (object, uv): (usize, Vec2)) -> Vec3 {
        let id = &self.scene.instances[object].id;
        let placement = self.lightmap.placements.iter().find(|placement| placement.id == *id).unwrap();
        let page = &self.lightmap.pages[placement.page as usize];
        let size = Vec2::from(placement.uv_max) - Vec2::from(placement.uv_min);
        let texels = size * Vec2::new(page.width as f32, page.height as f32);
        self.lightmap.sample(placement, uv + self.shift / texels, self.filtering)
    }

    /// The jump at each pair over the local value, largest first. Where both sides are darker than a fiftieth of the
    /// brightest seam that fiftieth is the local value.
    pub fn jumps(&self, pairs: &[Pair]) -> Vec<f32> {
        let looked: Vec<[Vec3; 2]> = pairs.iter().map(|pair| pair.sides.map(|side| self.at(side))).collect();
        let brightest = looked.iter().flatten().fold(0.0_f32, |most, value| most.max(value.max_element()));
        let jump = |[a, b]: &[Vec3; 2]| {
            let local = (0.5 * (*a + *b)).max_element().max(0.02 * brightest);
            if local > 0.0 { (*a - *b).abs().max_element() / local } else { 0.0 }
        };
        let mut jumps: Vec<f32> = looked.iter().map(jump).collect();
        jumps.sort_by(|a, b| b.total_cmp(a));
        jumps
    }

    /// The largest jump over the brightest that is shown at any seam.
    pub fn worst_jump_over_brightest(&self, pairs: &[Pair]) -> f32 {
        let looked = || pairs.iter().map(|pair| pair.sides.map(|side| self.at(side)));
        let brightest = looked().flatten().fold(0.0_f32, |most, value| most.max(value.max_element()));
        looked().map(|[a, b]| (a - b).abs().max_element()).fold(0.0, f32::max) / brightest
    }

    pub fn worst_jump(&self, pairs: &[Pair]) -> f32 {
        self.jumps(pairs).first().copied().unwrap_or_default()
    }
}

/// The worst jump by either filtering.
pub fn worst_jump(scene: &Scene, lightmap: &Lightmap, pairs: &[Pair]) -> f32 {
    [Filtering::Bilinear, Filtering::Bicubic]
        .into_iter()
        .map(|filtering| Look::new(scene, lightmap, filtering).worst_jump(pairs))
        .fold(0.0, f32::max)
}

pub fn settings(density: f32, samples: u32) -> BakeSettings {
    BakeSettings { density, goal: Goal::Samples(samples), ..BakeSettings::default() }
}

pub fn bake(scene: &Scene, settings: &BakeSettings) -> Lightmap {
    bake_lightmap(scene, settings, &(), &CancelToken::default()).unwrap()
}

pub fn on_threads(settings: &BakeSettings, threads: usize) -> BakeSettings {
    BakeSettings { threads: NonZeroUsize::new(threads), ..settings.clone() }
}

/// The map as a texture of shared exponents holds it (`VK_FORMAT_E5B9G9R9_UFLOAT_PACK32`).
pub fn in_shared_exponents(lightmap: &Lightmap) -> Lightmap {
    let kept = |value: Vec3| {
        let most = value.max_element();
        if most <= 0.0 {
            return value;
        }
        let step = |exponent: f32| (exponent - 9.0).exp2();
        let exponent = most.log2().floor() + 1.0;
        let exponent = if (most / step(exponent)).round() >= 512.0 { exponent + 1.0 } else { exponent };
        (value / step(exponent)).round() * step(exponent)
    };
    let mut lightmap = lightmap.clone();
    lightmap.pages.iter_mut().flat_map(|page| &mut page.radiance).for_each(|value| *value = kept(*value));
    lightmap
}

/// The map as measured, with nothing but rings of means around its charts: what a baker without repair would show.
pub fn unrepaired(lightmap: &Lightmap) -> Lightmap {
    let mut lightmap = lightmap.clone();
    for page in &mut lightmap.pages {
        let (width, height) = (page.width as usize, page.height as usize);
        let mut filled: Vec<bool> = page.coverage.iter().map(|&coverage| coverage > 0.0).collect();
        page.radiance.clone_from(&page.raw);
        for _ in 0..3 {
            let before = filled.clone();
            for texel in (0..filled.len()).filter(|&texel| !before[texel]) {
                let (x, y) = (texel % width, texel / width);
                let around = (y.saturating_sub(1)..(y + 2).min(height))
                    .flat_map(|y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| y * width + x));
                let around: Vec<usize> = around.filter(|&other| before[other]).collect();
                if !around.is_empty() {
                    page.radiance[texel] =
                        around.iter().map(|&other| page.radiance[other]).sum::<Vec3>() / around.len() as f32;
                    filled[texel] = true;
                }
            }
        }
    }
    lightmap
}

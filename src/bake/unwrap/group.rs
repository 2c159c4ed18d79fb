//! Objects of one mesh and one shape: they share charts, and those of about one size the packing as well.

use super::charts::{UnwrapMethod, charts};
use super::mesh::LaidOutMesh;
use super::pack::{Boxed, Packed, Packing};
use super::shape::Shape;
use super::surface::Surface;
use super::tight::tighten;
use crate::artefact::StableId;
use crate::bake::atlas::GUTTER;
use crate::bake::{BakeSettings, BakeWarning, CancelToken};
use crate::scene::{Instance, Mesh, Scene, Subject};

/// How much finer than the coarsest an object may be and still share its packing.
const FINER: f64 = 2.0;

/// How much finer counts as the same.
const SAME: f64 = 1.0 + 1e-3;

/// Empty texels between charts.
const GAP: u32 = 2 * GUTTER;

/// The same where finer objects share a packing: theirs do not start at a texel's border, and up to two more texels
/// are covered; three more hold the border of a block wherever it lies.
const WIDE_GAP: u32 = GAP + 5;

/// Attempts to find a density at which there is room.
const ATTEMPTS: u32 = 60;

/// Objects of one mesh and one shape.
pub(super) struct Group<'a> {
    /// Index of the mesh.
    pub(super) mesh: usize,
    pub(super) shape: Shape,
    /// By id; each with its own unit of the shape [m].
    pub(super) instances: Vec<(&'a Instance, f64)>,
}

/// A mesh, the objects that take it, and their rectangles [texels].
type Taken = (LaidOutMesh, Vec<(StableId, [u32; 2])>);

/// What became of a group.
pub(super) struct Unwrapped {
    pub(super) meshes: Vec<Taken>,
    /// Objects that no page has room for.
    pub(super) refused: Vec<StableId>,
    pub(super) warnings: Vec<BakeWarning>,
}

/// An object and the texels per unit of the shape that it asks for.
struct Wish<'a> {
    instance: &'a Instance,
    asked: f32,
    resolution: f64,
}

impl Group<'_> {
    /// Unwraps the mesh for all of them; `None` once cancelled.
    pub(super) fn unwrap(&self, scene: &Scene, settings: &BakeSettings, cancel: &CancelToken) -> Option<Unwrapped> {
        let mesh = &scene.meshes[self.mesh];
        let surface = Surface::new(mesh, &self.shape);
        let (charts, method) = charts(&surface, cancel)?;
        let charts = boxed(&surface, charts);
        let mut unwrapped = Unwrapped { meshes: Vec::new(), refused: Vec::new(), warnings: Vec::new() };
        if method == UnwrapMethod::Simple {
            unwrapped.warnings.push(BakeWarning::SimpleUnwrap {
                subject: Subject::Mesh(mesh.name.clone()),
                triangles: surface.len() as u64,
                charts: charts.len() as u64,
            });
        }
        let mut wishes = self.wishes(settings);
        while !wishes.is_empty() {
            let coarsest = wishes[0].resolution;
            let rest = wishes.split_off(wishes.partition_point(|wish| wish.resolution <= FINER * coarsest));
            let bucket =
                Bucket { mesh, surface: &surface, charts: &charts, wishes: &wishes, limit: settings.page_limit() };
            match bucket.pack(&mut unwrapped.warnings, cancel) {
                _ if cancel.is_cancelled() => return None,
                Some((laid_out, sizes)) => {
                    unwrapped.meshes.push((LaidOutMesh { source: self.mesh, method, ..laid_out }, sizes));
                }
                None => unwrapped.refused.extend(wishes.iter().map(|wish| wish.instance.id.clone())),
            }
            wishes = rest;
        }
        Some(unwrapped)
    }

    /// What each object asks for, the coarsest first.
    fn wishes(&self, settings: &BakeSettings) -> Vec<Wish<'_>> {
        let mut wishes = Vec::with_capacity(self.instances.len());
        for &(instance, unit) in &self.instances {
            let asked = instance.lightmap.and_then(|request| request.density).unwrap_or(settings.density);
            wishes.push(Wish { instance, asked, resolution: f64::from(asked) * unit });
        }
        wishes.sort_by(|a, b| a.resolution.total_cmp(&b.resolution).then(a.instance.id.cmp(&b.instance.id)));
        wishes
    }
}

/// Charts in their tightest boxes.
fn boxed(surface: &Surface, charts: Vec<super::patch::Chart>) -> Vec<Boxed> {
    let boxed = |mut chart: super::patch::Chart| {
        let size = tighten(&mut chart);
        let area = chart.triangles.iter().map(|&triangle| surface.areas[triangle as usize]).sum();
        Boxed { chart, size, area }
    };
    charts.into_iter().map(boxed).collect()
}

/// Objects that share a packing.
struct Bucket<'a> {
    mesh: &'a Mesh,
    surface: &'a Surface,
    charts: &'a [Boxed],
    /// The coarsest first.
    wishes: &'a [Wish<'a>],
    /// Largest side of a page [texels].
    limit: u32,
}

impl Bucket<'_> {
    /// The mesh with its UV1 and the rectangle of each object; `None` if no page has room for the charts, or once
    /// cancelled.
    fn pack(&self, warnings: &mut Vec<BakeWarning>, cancel: &CancelToken) -> Option<Taken> {
        let coarsest = self.wishes[0].resolution;
        let is_mixed = self.wishes.iter().any(|wish| wish.resolution > SAME * coarsest);
        let mut packing = Packing { density: coarsest, gap: if is_mixed { WIDE_GAP } else { GAP }, limit: self.limit };
        let packed = (0..ATTEMPTS).take_while(|_| !cancel.is_cancelled()).find_map(|_| {
            match Packed::new(self.charts, &packing, cancel) {
                Ok(packed) => Some(packed),
                Err(share) => {
                    packing.density *= share.clamp(1e-6, 0.97);
                    None
                }
            }
        });
        let Some(packed) = packed else {
            let refused = |wish: &Wish<'_>| BakeWarning::TooManyCharts {
                subject: Subject::Instance(wish.instance.name.clone()),
                charts: self.charts.len() as u64,
                limit: self.limit,
            };
            warnings.extend(self.wishes.iter().map(refused));
            return None;
        };
        let size = |wish: &Wish<'_>| {
            let (size, got) = self.size(&packed, &packing, wish.resolution);
            if got < wish.resolution / SAME {
                warnings.push(BakeWarning::LoweredDensity {
                    subject: Subject::Instance(wish.instance.name.clone()),
                    asked: wish.asked,
                    got: (f64::from(wish.asked) * got / wish.resolution) as f32,
                    limit: self.limit - GAP,
                });
            }
            (wish.instance.id.clone(), size)
        };
        let sizes = self.wishes.iter().map(size).collect();
        Some((LaidOutMesh::new(self.mesh, self.surface, self.charts, &packed), sizes))
    }

    /// The rectangle of an object that asks for more texels than were packed for, and what it gets.
    fn size(&self, packed: &Packed, packing: &Packing, asked: f64) -> ([u32; 2], f64) {
        let density = packing.density;
        let most = f64::from(self.limit - GAP);
        let longest = f64::from(packed.size[0].max(packed.size[1]));
        let finer = (asked / density).min(most / longest);
        // What was packed with no more than the gap of one size must stay that size, or texels of two charts meet.
        if packing.gap < WIDE_GAP || finer <= SAME {
            return (packed.size, density.min(asked));
        }
        (packed.size.map(|side| (f64::from(side) * finer * (1.0 - 1e-9)).ceil() as u32), density * finer)
    }
}

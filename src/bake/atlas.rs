//! Where each object's texels lie: pages and rectangles.
//!
//! `packed`: an object that was unwrapped has the rectangle that its charts were packed for. Of any other, the unit
//! square of UV1 gets a rectangle whose sides follow the root-mean-square stretch of its UV1 along u and v, times the
//! texel density, so that a texel is about as wide as asked wherever it lies. Every rectangle has a cell of whole
//! blocks of 4 × 4 texels to itself and starts two texels into it, so that no block that a texture format compresses
//! holds texels of two. Cells are packed under a skyline, tallest first and by id among equals, so that the same scene
//! gives the same atlas. An object too large for a page gets fewer texels per metre, and a warning.
//! `shared`: one page that every object's UV1 already addresses.

mod skyline;
mod smallest;

pub(super) use smallest::smallest;

use super::settings::Layout;
use super::unwrap::LaidOut;
use super::{BakeError, BakeSettings, BakeWarning, CancelToken};
use crate::scene::{Scene, Subject};
use crate::trace::{Receiver, Tracer};
use glam::{DVec2, Vec2};

/// Side of the blocks that texture formats compress [texels]: what every cell of an atlas is whole in.
pub(super) const BLOCK: u32 = 4;

/// Empty texels around each rectangle: what bicubic filtering reads beyond it.
pub(super) const GUTTER: u32 = 2;

/// An object's place on a page.
#[derive(Clone, Debug)]
pub(super) struct Chart<'a> {
    pub(super) receiver: &'a Receiver,
    pub(super) page: u32,
    /// Smallest corner on the page [texels].
    pub(super) origin: [u32; 2],
    /// Width and height [texels].
    pub(super) size: [u32; 2],
    /// UV1 of the mesh, in [0, 1].
    uv1: &'a [Vec2],
}

impl Chart<'_> {
    /// Corners of a triangle of the object in its rectangle [texels]. Not on its page, or the last bits of its light
    /// would go by what lies beside it.
    pub(super) fn triangle(&self, triangle: u32) -> [DVec2; 3] {
        let size = DVec2::new(self.size[0].into(), self.size[1].into());
        self.receiver.vertices[triangle as usize]
            .map(|vertex| self.uv1[vertex as usize].clamp(Vec2::ZERO, Vec2::ONE).as_dvec2() * size)
    }

    /// Number of triangles.
    pub(super) fn triangle_count(&self) -> u32 {
        self.receiver.vertices.len() as u32
    }
}

/// Pages, and each object's place on them.
#[derive(Clone, Debug)]
pub(super) struct Atlas<'a> {
    /// Width and height of each page [texels].
    pub(super) pages: Vec<[u32; 2]>,
    /// In the order of the receivers.
    pub(super) charts: Vec<Chart<'a>>,
    /// Objects that got fewer texels than they asked for.
    pub(super) warnings: Vec<BakeWarning>,
}

impl<'a> Atlas<'a> {
    /// Lays out the receivers of a scene that was laid out, which the tracer was compiled from.
    pub(super) fn new(
        laid_out: &'a LaidOut<'_>,
        tracer: &'a Tracer,
        settings: &BakeSettings,
        cancel: &CancelToken,
    ) -> Result<Self, BakeError> {
        let scene: &Scene = &laid_out.scene;
        let uv1 = |receiver: &Receiver| {
            scene.meshes[scene.instances[receiver.instance].mesh].uv1.as_deref().unwrap_or_default()
        };
        let receivers = tracer.receivers();
        let mut warnings = Vec::new();
        let (sizes, pages, places) = match settings.layout {
            Layout::Shared { size } => {
                (vec![[size; 2]; receivers.len()], vec![[size; 2]], vec![(0, [0; 2]); receivers.len()])
            }
            Layout::Packed => {
                let mut size_of = |receiver: &Receiver| {
                    let of_charts = laid_out.sizes.get(&scene.instances[receiver.instance].id);
                    of_charts.copied().unwrap_or_else(|| {
                        let kept = Kept { scene, tracer, receiver, uv1: uv1(receiver) };
                        kept.size(settings, &mut warnings)
                    })
                };
                let sizes: Vec<[u32; 2]> = receivers.iter().map(&mut size_of).collect();
                let (pages, places) = pack(&sizes, settings.page_limit(), cancel).ok_or(BakeError::Cancelled)?;
                (sizes, pages, places)
            }
        };
        let charts = receivers
            .iter()
            .zip(sizes)
            .zip(places)
            .map(|((receiver, size), (page, origin))| Chart { receiver, page, origin, size, uv1: uv1(receiver) })
            .collect();
        Ok(Self { pages, charts, warnings })
    }

    /// Share of the pages that so many covered texels are.
    pub(super) fn fill(&self, covered: usize) -> f64 {
        let area: f64 = self.pages.iter().map(|[width, height]| f64::from(*width) * f64::from(*height)).sum();
        covered as f64 / area
    }
}

/// An object that keeps its own UV1.
struct Kept<'a> {
    scene: &'a Scene,
    tracer: &'a Tracer,
    receiver: &'a Receiver,
    uv1: &'a [Vec2],
}

impl Kept<'_> {
    /// Width and height of its rectangle [texels].
    fn size(&self, settings: &BakeSettings, warnings: &mut Vec<BakeWarning>) -> [u32; 2] {
        let instance = &self.scene.instances[self.receiver.instance];
        let asked = instance.lightmap.and_then(|request| request.density).unwrap_or(settings.density);
        let exact = (self.squared_stretch() * f64::from(asked) * f64::from(asked)).map(f64::sqrt);
        if exact.is_nan() {
            return [2; 2];
        }
        let limit = settings.page_limit() - 2 * GUTTER;
        // 1e-9 against a ceiling that rounding moves to the next texel.
        let share = (f64::from(limit) * (1.0 - 1e-9) / exact.max_element()).min(1.0);
        if exact.max_element().ceil() <= f64::from(limit) {
            return exact.map(|texels| texels.ceil().max(2.0)).to_array().map(|texels| texels as u32);
        }
        let subject = Subject::Instance(instance.name.clone());
        warnings.push(BakeWarning::LoweredDensity { subject, asked, got: (f64::from(asked) * share) as f32, limit });
        (exact * share).map(|texels| texels.ceil().max(2.0)).to_array().map(|texels| texels as u32)
    }

    /// Mean over the surface of the squared length of a step of 1 along u, and along v [m²].
    fn squared_stretch(&self) -> DVec2 {
        let mut area = 0.0;
        let mut squared_stretch = DVec2::ZERO;
        for (triangle, vertices) in self.receiver.vertices.iter().enumerate() {
            let world = self.receiver.first_triangle + triangle as u32;
            let [a, b, c] = self.tracer.vertices(world).map(|vertex| vertex.as_dvec3());
            let [p, q, r] = vertices.map(|vertex| self.uv1[vertex as usize].as_dvec2());
            let determinant = (q - p).perp_dot(r - p);
            if determinant == 0.0 {
                continue;
            }
            let along_u = ((b - a) * (r.y - p.y) - (c - a) * (q.y - p.y)) / determinant;
            let along_v = ((c - a) * (q.x - p.x) - (b - a) * (r.x - p.x)) / determinant;
            let triangle_area = self.tracer.area(world);
            area += triangle_area;
            squared_stretch += triangle_area * DVec2::new(along_u.length_squared(), along_v.length_squared());
        }
        squared_stretch / area
    }
}

/// A page, and a rectangle's smallest corner on it [texels].
type Place = (u32, [u32; 2]);

/// Packs rectangles, in order of id, into as few and as small pages as a skyline allows; `None` once cancelled.
fn pack(sizes: &[[u32; 2]], limit: u32, cancel: &CancelToken) -> Option<(Vec<[u32; 2]>, Vec<Place>)> {
    let cells: Vec<[u32; 2]> = sizes.iter().map(|size| size.map(|side| (side + 2 * GUTTER).div_ceil(BLOCK))).collect();
    let mut pages = Vec::new();
    let mut places = Vec::with_capacity(sizes.len());
    for ((page, corner), cell) in smallest::paged(&cells, limit / BLOCK, cancel)?.into_iter().zip(&cells) {
        pages.resize(pages.len().max(page as usize + 1), [BLOCK; 2]);
        for axis in 0..2 {
            let end = (corner[axis] + cell[axis]) * BLOCK;
            pages[page as usize][axis] = pages[page as usize][axis].max(end);
        }
        places.push((page, corner.map(|block| block * BLOCK + GUTTER)));
    }
    Some((pages, places))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::combine;

    #[test]
    fn rectangles_keep_their_distance_and_stay_on_their_page() {
        let sizes: Vec<[u32; 2]> =
            (0..200).map(|key| [0, 1].map(|axis| 2 + (combine(key, axis) % 190) as u32)).collect();
        let (pages, places) = pack(&sizes, 4096, &CancelToken::default()).unwrap();
        assert_eq!(pages.len(), 1);
        let area: u32 = sizes.iter().map(|[width, height]| width * height).sum();
        let fill = f64::from(area) / f64::from(pages[0][0] * pages[0][1]);
        assert!(fill > 0.8, "{fill}");
        for (index, &(page, origin)) in places.iter().enumerate() {
            for axis in 0..2 {
                assert_eq!(origin[axis] % BLOCK, GUTTER);
                assert!(origin[axis] + sizes[index][axis] + GUTTER <= pages[page as usize][axis]);
            }
            for (other, &(_, other_origin)) in places.iter().enumerate().take(index) {
                let apart = (0..2).any(|axis| {
                    origin[axis] >= other_origin[axis] + sizes[other][axis] + 2 * GUTTER
                        || other_origin[axis] >= origin[axis] + sizes[index][axis] + 2 * GUTTER
                });
                assert!(apart, "{index} and {other}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_goes_to_another_page() {
        let (pages, places) = pack(&[[3000, 3000]; 3], 4096, &CancelToken::default()).unwrap();
        assert_eq!(pages.len(), 3);
        assert_eq!(places.iter().map(|(page, _)| *page).collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn cancelled_is_none() {
        let cancel = CancelToken::default();
        cancel.cancel();
        assert!(pack(&[[3000, 3000]; 3], 4096, &cancel).is_none());
    }
}

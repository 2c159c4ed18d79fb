//! Where each object's texels lie: pages and rectangles.
//!
//! `packed`: an object's unit square of UV1 gets a rectangle whose sides follow the root-mean-square stretch of its
//! UV1 along u and v, times the texel density, so that a texel is about as wide as asked wherever it lies. Rectangles
//! are packed on shelves by `etagere`, tallest first and by id among equals, so that the same scene gives the same
//! atlas. `shared`: one page that every object's UV1 already addresses.

use super::settings::Layout;
use super::{BakeError, BakeSettings, repair};
use crate::scene::Scene;
use crate::trace::{Receiver, Tracer};
use etagere::{AtlasAllocator, size2};
use glam::{DVec2, Vec2};

/// Largest page of a packed atlas [texels]: on a larger one the 16 bits per coordinate that Bevy keeps of a lightmap's
/// rectangle would be off by more than a sixteenth of a texel.
const MAX_PACKED_SIZE: u32 = 4096;

/// Empty texels around each rectangle, so that two neighbours are filled without mixing.
const GUTTER: u32 = repair::PASSES / 2;

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
}

impl<'a> Atlas<'a> {
    pub(super) fn new(scene: &'a Scene, tracer: &'a Tracer, settings: &BakeSettings) -> Result<Self, BakeError> {
        let uv1 = |receiver: &Receiver| {
            scene.meshes[scene.instances[receiver.instance].mesh].uv1.as_deref().unwrap_or_default()
        };
        let receivers = tracer.receivers();
        let sizes = match settings.layout {
            Layout::Shared { size } => vec![[size; 2]; receivers.len()],
            Layout::Packed => receivers
                .iter()
                .map(|receiver| packed_size(scene, tracer, receiver, uv1(receiver), settings.density))
                .collect::<Result<_, _>>()?,
        };
        let (pages, places) = match settings.layout {
            Layout::Shared { size } => (vec![[size; 2]], vec![(0, [0; 2]); receivers.len()]),
            Layout::Packed => pack(&sizes),
        };
        let charts = receivers
            .iter()
            .zip(sizes)
            .zip(places)
            .map(|((receiver, size), (page, origin))| Chart { receiver, page, origin, size, uv1: uv1(receiver) })
            .collect();
        Ok(Self { pages, charts })
    }
}

/// Width and height of an object's rectangle [texels].
fn packed_size(
    scene: &Scene,
    tracer: &Tracer,
    receiver: &Receiver,
    uv1: &[Vec2],
    default_density: f32,
) -> Result<[u32; 2], BakeError> {
    let instance = &scene.instances[receiver.instance];
    let density = f64::from(instance.lightmap.and_then(|request| request.density).unwrap_or(default_density));
    let mut area = 0.0;
    let mut squared_stretch = DVec2::ZERO;
    for (triangle, vertices) in receiver.vertices.iter().enumerate() {
        let world = receiver.first_triangle + triangle as u32;
        let [a, b, c] = tracer.vertices(world).map(|vertex| vertex.as_dvec3());
        let [p, q, r] = vertices.map(|vertex| uv1[vertex as usize].as_dvec2());
        let determinant = (q - p).perp_dot(r - p);
        if determinant == 0.0 {
            continue;
        }
        let along_u = ((b - a) * (r.y - p.y) - (c - a) * (q.y - p.y)) / determinant;
        let along_v = ((c - a) * (q.x - p.x) - (b - a) * (r.x - p.x)) / determinant;
        let triangle_area = tracer.area(world);
        area += triangle_area;
        squared_stretch += triangle_area * DVec2::new(along_u.length_squared(), along_v.length_squared());
    }
    let texels = (squared_stretch / area * density * density).map(f64::sqrt).map(|texels| texels.ceil().max(2.0));
    let limit = MAX_PACKED_SIZE - 2 * GUTTER;
    if texels.is_nan() || texels.max_element() > f64::from(limit) {
        return Err(BakeError::AtlasOverflow {
            name: instance.name.clone(),
            width: texels.x as u64,
            height: texels.y as u64,
            limit,
        });
    }
    Ok([texels.x as u32, texels.y as u32])
}

/// A page, and a rectangle's smallest corner on it [texels].
type Place = (u32, [u32; 2]);

/// Packs rectangles, in order of id, into as few and as small pages as shelves allow.
fn pack(sizes: &[[u32; 2]]) -> (Vec<[u32; 2]>, Vec<Place>) {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&index| (std::cmp::Reverse(sizes[index][1]), std::cmp::Reverse(sizes[index][0]), index));
    let mut pages = Vec::new();
    let mut places = vec![(0, [0; 2]); sizes.len()];
    let mut rest = order;
    while !rest.is_empty() {
        let mut side = smallest_side(rest.iter().map(|&index| sizes[index]));
        let placed = loop {
            let placed = pack_page(sizes, &rest, side);
            if placed.len() == rest.len() || side == MAX_PACKED_SIZE {
                break placed;
            }
            side = (side + side.div_ceil(16)).next_multiple_of(4).min(MAX_PACKED_SIZE);
        };
        let page = pages.len() as u32;
        let mut extent = [4, 4];
        for &(index, origin) in &placed {
            places[index] = (page, origin);
            for axis in 0..2 {
                extent[axis] = extent[axis].max((origin[axis] + sizes[index][axis] + GUTTER).next_multiple_of(4));
            }
        }
        pages.push(extent);
        rest.retain(|index| !placed.iter().any(|(done, _)| done == index));
    }
    (pages, places)
}

/// The side of a square that might just hold the rectangles [texels].
fn smallest_side(sizes: impl Iterator<Item = [u32; 2]>) -> u32 {
    let mut area = 0.0;
    let mut longest = 0;
    for size in sizes {
        let [width, height] = size.map(|extent| extent + 2 * GUTTER);
        area += f64::from(width) * f64::from(height);
        longest = longest.max(width).max(height);
    }
    (area.sqrt() as u32).max(longest).next_multiple_of(4).min(MAX_PACKED_SIZE)
}

/// Packs what fits into one square page; gives each rectangle's corner inside its gutter.
fn pack_page(sizes: &[[u32; 2]], order: &[usize], side: u32) -> Vec<(usize, [u32; 2])> {
    let mut allocator = AtlasAllocator::new(size2(side as i32, side as i32));
    let mut placed = Vec::new();
    for &index in order {
        let [width, height] = sizes[index].map(|extent| (extent + 2 * GUTTER) as i32);
        if let Some(allocation) = allocator.allocate(size2(width, height)) {
            let corner = allocation.rectangle.min;
            placed.push((index, [corner.x as u32 + GUTTER, corner.y as u32 + GUTTER]));
        }
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::combine;

    #[test]
    fn rectangles_keep_their_distance_and_stay_on_their_page() {
        let sizes: Vec<[u32; 2]> =
            (0..200).map(|key| [0, 1].map(|axis| 2 + (combine(key, axis) % 190) as u32)).collect();
        let (pages, places) = pack(&sizes);
        assert_eq!(pages.len(), 1);
        let area: u32 = sizes.iter().map(|[width, height]| width * height).sum();
        let fill = f64::from(area) / f64::from(pages[0][0] * pages[0][1]);
        assert!(fill > 0.65, "{fill}");
        for (index, &(page, origin)) in places.iter().enumerate() {
            for axis in 0..2 {
                assert!(origin[axis] >= GUTTER);
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
        let (pages, places) = pack(&[[3000, 3000]; 3]);
        assert_eq!(pages.len(), 3);
        assert_eq!(places.iter().map(|(page, _)| *page).collect::<Vec<_>>(), [0, 1, 2]);
    }
}

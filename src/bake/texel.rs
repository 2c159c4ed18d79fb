//! The covered part of one texel, and points spread over it.

use super::atlas::Chart;
use super::raster::{Fragment, MIN_COVERAGE, Polygon, triangle_area};
use crate::math::square_to_triangle;
use crate::trace::{PathStart, Receiver, Tracer};
use glam::{DVec2, Vec2, Vec3};

/// Points along each side of a texel at which its albedo is looked up.
const ALBEDO_GRID: u32 = 4;

/// How far a point that stands for others is drawn to the middle of its piece.
const FROM_BORDER: f32 = 0.15;

/// A piece of a triangle inside a texel, in weights of the triangle's second and third vertex.
#[derive(Clone, Copy, Debug)]
struct Patch {
    /// World number of the triangle.
    triangle: u32,
    /// Unit shading normals of its vertices, or zeros for a flat one, which is then its own.
    normals: [Vec3; 3],
    corner: DVec2,
    edges: [DVec2; 2],
    shape: PatchShape,
    /// Share of the texel up to and with this piece.
    share_end: f64,
    share: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PatchShape {
    Triangle,
    Parallelogram,
}

impl Patch {
    /// Weights of the second and third vertex in its middle.
    fn middle(&self) -> DVec2 {
        let share = match self.shape {
            PatchShape::Triangle => 1.0 / 3.0,
            PatchShape::Parallelogram => 0.5,
        };
        self.corner + (self.edges[0] + self.edges[1]) * share
    }
}

/// The covered part of one texel.
#[derive(Clone, Debug, Default)]
pub(super) struct Texel {
    patches: Vec<Patch>,
    /// Covered share, counting twice what is covered twice.
    pub(super) coverage: f64,
    /// Area of the covered part in the world, by the triangle's number [m²].
    pub(super) areas: Vec<(u32, f64)>,
}

impl Texel {
    /// Puts together the texel that `fragments` share, at `x`, `y` of a page.
    pub(super) fn new(tracer: &Tracer, charts: &[Chart<'_>], fragments: &[Fragment], [x, y]: [u32; 2]) -> Self {
        let mut texel = Self::default();
        for fragment in fragments {
            let chart = &charts[fragment.receiver as usize];
            texel.add(tracer, chart, fragment.triangle, [x, y]);
        }
        texel
    }

    /// Whether enough is covered to count.
    pub(super) fn is_covered(&self) -> bool {
        self.coverage >= MIN_COVERAGE
    }

    /// Texels per metre of the surface: 1 over the side of a square of what a whole texel covers [1/m]; 0 without any.
    pub(super) fn density(&self) -> f32 {
        let area: f64 = self.areas.iter().map(|(_, area)| area).sum();
        if area > 0.0 { (self.coverage / area).sqrt() as f32 } else { 0.0 }
    }

    /// Memory behind its lists [bytes].
    pub(super) fn heap_bytes(&self) -> usize {
        self.patches.capacity() * size_of::<Patch>() + self.areas.capacity() * size_of::<(u32, f64)>()
    }

    fn add(&mut self, tracer: &Tracer, chart: &Chart<'_>, triangle: u32, [x, y]: [u32; 2]) {
        let corners = chart.triangle(triangle);
        let [x, y] = [x - chart.origin[0], y - chart.origin[1]];
        let polygon = Polygon::clip(corners, x, y);
        let [a, b, c] = corners;
        let double_area = (b - a).perp_dot(c - a);
        let barycentric = |point: DVec2| {
            DVec2::new((point - a).perp_dot(c - a) / double_area, (b - a).perp_dot(point - a) / double_area)
        };
        let world = chart.receiver.first_triangle + triangle;
        let texel_area = polygon.area();
        self.areas.push((world, tracer.area(world) * texel_area / triangle_area(a, b, c)));
        let mut push = |corners: [DVec2; 3], share: f64, shape| {
            self.coverage += share;
            let corner = barycentric(corners[0]);
            self.patches.push(Patch {
                triangle: world,
                normals: shading_normals(chart.receiver, triangle),
                corner,
                edges: [barycentric(corners[1]) - corner, barycentric(corners[2]) - corner],
                shape,
                share_end: self.coverage,
                share,
            });
        };
        // A whole texel in one triangle, the common case, keeps the stratification of its square.
        if polygon.corners().len() == 4 && texel_area > 1.0 - 1e-9 {
            let low = DVec2::new(f64::from(x), f64::from(y));
            push([low, low + DVec2::X, low + DVec2::Y], texel_area, PatchShape::Parallelogram);
        } else {
            for corners in polygon.fan() {
                let share = triangle_area(corners[0], corners[1], corners[2]);
                if share > 0.0 {
                    push(corners, share, PatchShape::Triangle);
                }
            }
        }
    }

    /// A start of paths at a point of the covered part, uniform over its area in the texel.
    pub(super) fn start(&self, tracer: &Tracer, u: Vec2) -> PathStart {
        let (patch, barycentric) = self.point(u);
        tracer.start_on_smooth_triangle(patch.triangle, barycentric, patch.normals)
    }

    /// A start that stands for the places around it: the same, drawn away from the borders of the piece that it lies
    /// on, where other surfaces often meet this one.
    pub(super) fn inner_start(&self, tracer: &Tracer, u: Vec2) -> PathStart {
        let (patch, [second, third]) = self.point(u);
        let middle = patch.middle();
        let weights = Vec2::new(second, third).lerp(middle.as_vec2(), FROM_BORDER);
        tracer.start_on_smooth_triangle(patch.triangle, weights.to_array(), patch.normals)
    }

    /// Mean albedo of the covered part.
    pub(super) fn albedo(&self, tracer: &Tracer) -> Vec3 {
        let centres = (0..ALBEDO_GRID * ALBEDO_GRID).map(|cell| {
            let [x, y] = [cell % ALBEDO_GRID, cell / ALBEDO_GRID];
            Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / ALBEDO_GRID as f32
        });
        let albedo = |u| {
            let (patch, barycentric) = self.point(u);
            tracer.diffuse_albedo(patch.triangle, barycentric)
        };
        centres.map(albedo).sum::<Vec3>() / (ALBEDO_GRID * ALBEDO_GRID) as f32
    }

    /// A point of the covered part, uniform over its area in the texel: where, and at which weights of the second and
    /// third vertex.
    fn point(&self, u: Vec2) -> (&Patch, [f32; 2]) {
        let place = f64::from(u.x) * self.coverage;
        let patch =
            &self.patches[self.patches.partition_point(|patch| patch.share_end <= place).min(self.patches.len() - 1)];
        let within = (place - (patch.share_end - patch.share)) / patch.share;
        let u = Vec2::new((within as f32).clamp(0.0, 1.0 - f32::EPSILON * 0.5), u.y);
        let weights = match patch.shape {
            PatchShape::Triangle => square_to_triangle(u),
            PatchShape::Parallelogram => u,
        };
        let point = patch.corner + patch.edges[0] * f64::from(weights.x) + patch.edges[1] * f64::from(weights.y);
        let second = point.x.clamp(0.0, 1.0);
        let third = point.y.clamp(0.0, 1.0 - second);
        (patch, [second as f32, third as f32])
    }
}

fn shading_normals(receiver: &Receiver, triangle: u32) -> [Vec3; 3] {
    receiver.vertices[triangle as usize].map(|vertex| receiver.normals[vertex as usize])
}

//! What vertices carry besides their place: texture coordinates, colours, normals and tangents, in the world. Only of
//! instances whose material asks for them, and only the kinds that any material asks for.

use super::surface::Placement;
use super::tangents::tangents;
use crate::scene::{Mesh, UvChannel};
use glam::{Vec2, Vec3, Vec4};

/// A triangle without attributes.
const NONE: u32 = u32::MAX;

/// Which attributes an instance, or a whole scene, needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Needs {
    pub(super) uv0: bool,
    pub(super) uv1: bool,
    pub(super) colours: bool,
    pub(super) normals: bool,
    /// By which coordinates.
    pub(super) tangents: Option<UvChannel>,
}

impl Needs {
    pub(super) fn any(self) -> bool {
        self != Self::default()
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self {
            uv0: self.uv0 || other.uv0,
            uv1: self.uv1 || other.uv1,
            colours: self.colours || other.colours,
            normals: self.normals || other.normals,
            tangents: self.tangents.or(other.tangents),
        }
    }

    pub(super) fn coordinates(mut self, channel: UvChannel) -> Self {
        match channel {
            UvChannel::Uv0 => self.uv0 = true,
            UvChannel::Uv1 => self.uv1 = true,
        }
        self
    }
}

/// Attributes of all triangles that have any. Lists that nothing needs are empty.
#[derive(Debug, Default)]
pub(super) struct Attributes {
    /// What the scene as a whole needs.
    needs: Needs,
    /// Per triangle, its vertices in the lists below; empty if no triangle has attributes.
    corners: Vec<[u32; 3]>,
    uv: [Vec<Vec2>; 2],
    colours: Vec<Vec4>,
    /// Unit shading normals, or zero where the triangle is to be flat.
    normals: Vec<Vec3>,
    /// Unit tangents, or zero; w is the sign of the bitangent.
    tangents: Vec<Vec4>,
    vertex_count: u32,
}

impl Attributes {
    pub(super) fn new(needs: Needs) -> Self {
        Self { needs, ..Self::default() }
    }

    /// Memory that they hold [bytes].
    pub(super) fn memory_bytes(&self) -> u64 {
        let uv = (self.uv[0].len() + self.uv[1].len()) * size_of::<Vec2>();
        let vectors = (self.colours.len() + self.tangents.len()) * size_of::<Vec4>();
        let normals = self.normals.len() * size_of::<Vec3>();
        (uv + vectors + normals + self.corners.len() * size_of::<[u32; 3]>()) as u64
    }

    /// Adds an instance's triangles, given as vertices of its mesh in the order of the world's triangles.
    pub(super) fn add(&mut self, mesh: &Mesh, placement: &Placement, triangles: &[[u32; 3]], own: Needs) {
        if !self.needs.any() {
            return;
        }
        if !own.any() {
            self.corners.extend(std::iter::repeat_n([NONE; 3], triangles.len()));
            return;
        }
        let first = self.vertex_count;
        self.corners.extend(triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
        let count = mesh.positions.len();
        self.vertex_count += count as u32;
        if self.needs.uv0 {
            extend(&mut self.uv[0], mesh.uv0.as_deref(), count, Vec2::ZERO);
        }
        if self.needs.uv1 {
            extend(&mut self.uv[1], mesh.uv1.as_deref(), count, Vec2::ZERO);
        }
        if self.needs.colours {
            let colours = mesh.colours.as_deref().filter(|_| own.colours);
            extend(&mut self.colours, colours, count, Vec4::ONE);
        }
        if self.needs.normals {
            let normals = mesh.normals.as_ref().filter(|_| own.normals);
            let normals: Option<Vec<Vec3>> =
                normals.map(|normals| normals.iter().map(|&normal| placement.normal(normal)).collect());
            extend(&mut self.normals, normals.as_deref(), count, Vec3::ZERO);
        }
        if self.needs.tangents.is_some() {
            let tangents = own.tangents.map(|channel| world_tangents(mesh, placement, channel));
            extend(&mut self.tangents, tangents.as_deref(), count, Vec4::ZERO);
        }
    }

    /// Texture coordinates; zero where there are none.
    #[inline]
    pub(super) fn uv(&self, channel: UvChannel, triangle: u32, barycentric: [f32; 2]) -> Vec2 {
        let list = match channel {
            UvChannel::Uv0 => &self.uv[0],
            UvChannel::Uv1 => &self.uv[1],
        };
        self.corners_of(list, triangle).map_or(Vec2::ZERO, |[a, b, c]| mix(a, b, c, barycentric))
    }

    /// Vertex colour; white where there is none.
    #[inline]
    pub(super) fn colour(&self, triangle: u32, barycentric: [f32; 2]) -> Vec4 {
        self.corners_of(&self.colours, triangle).map_or(Vec4::ONE, |[a, b, c]| mix(a, b, c, barycentric))
    }

    /// Unit shading normal; `None` where the triangle is flat.
    #[inline]
    pub(super) fn normal(&self, triangle: u32, barycentric: [f32; 2]) -> Option<Vec3> {
        let [a, b, c] = self.corners_of(&self.normals, triangle)?;
        mix(a, b, c, barycentric).try_normalize()
    }

    /// Tangent, not yet orthogonal to anything, and the sign of the bitangent; `None` where there is none.
    #[inline]
    pub(super) fn tangent(&self, triangle: u32, barycentric: [f32; 2]) -> Option<(Vec3, f32)> {
        let [a, b, c] = self.corners_of(&self.tangents, triangle)?;
        let tangent = mix(a.truncate(), b.truncate(), c.truncate(), barycentric).try_normalize()?;
        Some((tangent, a.w))
    }

    #[inline]
    fn corners_of<T: Copy>(&self, list: &[T], triangle: u32) -> Option<[T; 3]> {
        if list.is_empty() {
            return None;
        }
        let corners = self.corners[triangle as usize];
        (corners[0] != NONE).then(|| corners.map(|vertex| list[vertex as usize]))
    }
}

#[inline]
fn mix<T>(a: T, b: T, c: T, [second, third]: [f32; 2]) -> T
where
    T: Copy + std::ops::Add<Output = T> + std::ops::Sub<Output = T> + std::ops::Mul<f32, Output = T>,
{
    // By differences, so that the error is a share of them: coordinates a million units out keep their fraction.
    a + (b - a) * second + (c - a) * third
}

fn extend<T: Copy>(list: &mut Vec<T>, values: Option<&[T]>, count: usize, default: T) {
    match values {
        Some(values) => list.extend_from_slice(values),
        None => list.extend(std::iter::repeat_n(default, count)),
    }
}

fn world_tangents(mesh: &Mesh, placement: &Placement, channel: UvChannel) -> Vec<Vec4> {
    let made;
    let local = match (&mesh.tangents, channel) {
        (Some(tangents), _) => tangents,
        (None, UvChannel::Uv0) => {
            made = tangents(mesh, mesh.uv0.as_deref());
            &made
        }
        (None, UvChannel::Uv1) => {
            made = tangents(mesh, mesh.uv1.as_deref());
            &made
        }
    };
    let sign = if placement.is_mirrored() { -1.0 } else { 1.0 };
    local.iter().map(|tangent| placement.direction(tangent.truncate()).extend(sign * tangent.w)).collect()
}

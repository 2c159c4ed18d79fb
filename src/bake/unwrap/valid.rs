//! Whether a mesh's own UV1 can carry a lightmap.
//!
//! It can if it lies in the unit square, gives every part of the surface an area of its own, and if no two triangles
//! lie over each other. Rounding is forgiven: exporters write UV1 in `f32` or in 16 bits.

use super::overlap::Overlaps;
use crate::bake::CancelToken;
use crate::scene::Mesh;
use glam::{DVec2, Vec2};
use thiserror::Error;

/// How far triangles may reach into each other, for rounding: half a step of 16 bits.
const SLACK: f64 = 0.5 / 65_536.0;

/// How far outside the unit square a coordinate may lie; it still lands on the border texel.
const OUTSIDE: f32 = 1e-4;

/// The share of a surface that may go without an area in UV1.
const BARE_SHARE: f64 = 1e-4;

/// What keeps a UV1 from carrying a lightmap. Reads as the rest of a sentence that begins with the mesh.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Uv1Fault {
    /// A coordinate that is outside the unit square or no number.
    #[error("leaves the unit square (vertex {vertex})")]
    Outside {
        /// The first such vertex.
        vertex: usize,
    },
    /// Triangles with an area whose UV1 has none.
    #[error("gives {:.1} % of the surface no area", 100.0 * share)]
    WithoutArea {
        /// Their share of the surface.
        share: f64,
    },
    /// Triangles that lie over each other.
    #[error(
        "has triangles over each other ({pairs} pairs{}, the first {} and {})",
        if *is_more { " or more" } else { "" },
        first[0],
        first[1]
    )]
    Overlaps {
        /// How many pairs were found.
        pairs: u64,
        /// Whether the search ended before all were found.
        is_more: bool,
        /// Two triangles of the mesh that lie over each other.
        first: [u32; 2],
    },
}

/// What is wrong with the UV1 of a mesh without other faults; `None` if it can be kept. Means nothing once cancelled.
pub(super) fn uv1_fault(mesh: &Mesh, uv1: &[Vec2], cancel: &CancelToken) -> Option<Uv1Fault> {
    let is_inside = |uv: &Vec2| uv.is_finite() && uv.min_element() >= -OUTSIDE && uv.max_element() <= 1.0 + OUTSIDE;
    if let Some(vertex) = uv1.iter().position(|uv| !is_inside(uv)) {
        return Some(Uv1Fault::Outside { vertex });
    }
    let mut numbers = Vec::new();
    let mut triangles: Vec<[DVec2; 3]> = Vec::new();
    let (mut area, mut bare) = (0.0, 0.0);
    for (number, vertices) in mesh.triangles().enumerate() {
        let [a, b, c] = vertices.map(|vertex| mesh.positions[vertex as usize].as_dvec3());
        let real = (b - a).cross(c - a).length();
        if real == 0.0 {
            continue;
        }
        area += real;
        let flat = vertices.map(|vertex| uv1[vertex as usize].as_dvec2());
        if (flat[1] - flat[0]).perp_dot(flat[2] - flat[0]) == 0.0 {
            bare += real;
        } else {
            numbers.push(number as u32);
            triangles.push(flat);
        }
    }
    if bare > BARE_SHARE * area {
        return Some(Uv1Fault::WithoutArea { share: bare / area });
    }
    let overlaps = Overlaps::find(&triangles, SLACK, cancel);
    if overlaps.is_empty() {
        return None;
    }
    let first = overlaps.pairs.first().map_or([0; 2], |pair| pair.map(|index| numbers[index as usize]));
    Some(Uv1Fault::Overlaps { pairs: overlaps.pairs.len() as u64, is_more: overlaps.is_cut, first })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Indices;
    use glam::Vec3;

    fn quad(uv1: [[f32; 2]; 4]) -> Option<Uv1Fault> {
        let mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
            indices: Indices::U16(vec![0, 1, 2, 0, 2, 3, 3, 3, 1]),
            ..Mesh::default()
        };
        uv1_fault(&mesh, &uv1.map(Vec2::from), &CancelToken::default())
    }

    #[test]
    fn a_plain_square_is_kept_mirrored_or_not() {
        assert_eq!(quad([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), None);
        assert_eq!(quad([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.00005, 1.0]]), None);
    }

    #[test]
    fn each_fault_is_told() {
        let outside = quad([[0.0, 0.0], [1.0, 0.0], [1.0, 1.1], [0.0, 1.0]]);
        assert_eq!(outside, Some(Uv1Fault::Outside { vertex: 2 }));
        assert_eq!(quad([[0.0, 0.0], [f32::NAN; 2], [0.0; 2], [0.0; 2]]), Some(Uv1Fault::Outside { vertex: 1 }));
        let bare = quad([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]]);
        assert_eq!(bare, Some(Uv1Fault::WithoutArea { share: 0.5 }));
        let folded = quad([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0]]);
        assert_eq!(folded, Some(Uv1Fault::Overlaps { pairs: 1, is_more: false, first: [0, 1] }));
        assert!(folded.unwrap().to_string().starts_with("has triangles over each other (1 pairs, the first 0 and 1"));
    }
}

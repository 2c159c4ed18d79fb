//! An orthonormal basis around a surface normal. Not the tangent frame of a mesh: the tangent's direction means
//! nothing here. The basis is that of Duff et al. 2017, "Building an Orthonormal Basis, Revisited".

use glam::Vec3;

/// A right-handed orthonormal basis; local Z is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local X in world space, unit length.
    pub tangent: Vec3,
    /// Local Y in world space, unit length.
    pub bitangent: Vec3,
    /// Local Z in world space, unit length.
    pub normal: Vec3,
}

impl Frame {
    /// The basis around `normal`, which has unit length. The tangent jumps only where `normal.z` changes sign; −0 is 0,
    /// since two triangles of one wall may differ in that, and are to be the same wall to a path.
    #[inline]
    pub fn new(normal: Vec3) -> Self {
        // Takes the sign from a zero.
        let (tangent, bitangent) = (normal + Vec3::ZERO).any_orthonormal_pair();
        Self { tangent, bitangent, normal }
    }

    /// The world-space components of a vector given in this frame.
    #[inline]
    pub fn world_from_local(&self, local: Vec3) -> Vec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }

    /// The components in this frame of a vector given in world space.
    #[inline]
    pub fn local_from_world(&self, world: Vec3) -> Vec3 {
        Vec3::new(self.tangent.dot(world), self.bitangent.dot(world), self.normal.dot(world))
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::Random;
    use super::*;

    #[test]
    fn the_basis_is_orthonormal_and_right_handed_for_every_normal() {
        let mut random = Random::new(1);
        let awkward = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z, Vec3::new(1e-4, -1e-4, -1.0)];
        let normals = awkward.into_iter().chain((0..10_000).map(|_| random.direction()));
        for normal in normals.map(Vec3::normalize) {
            let f = Frame::new(normal);
            assert!((f.tangent.length() - 1.0).abs() < 1e-6 && (f.bitangent.length() - 1.0).abs() < 1e-6, "{f:?}");
            assert!(f.tangent.dot(normal).abs() < 1e-6 && f.bitangent.dot(normal).abs() < 1e-6, "{f:?}");
            assert!((f.tangent.cross(f.bitangent) - normal).length() < 1e-6, "{f:?}");
        }
    }

    #[test]
    fn the_sign_of_a_zero_does_not_matter() {
        for (normal, other) in [
            (Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, -0.0, -0.0)),
            (Vec3::new(0.0, -1.0, 0.0), Vec3::new(-0.0, -1.0, -0.0)),
            (Vec3::new(0.6, 0.8, 0.0), Vec3::new(0.6, 0.8, -0.0)),
        ] {
            assert_eq!(Frame::new(normal), Frame::new(other));
        }
    }

    #[test]
    fn to_local_and_back_is_the_identity() {
        let mut random = Random::new(2);
        for _ in 0..10_000 {
            let (frame, v) = (Frame::new(random.direction()), random.direction() * 3.0);
            assert!((frame.world_from_local(frame.local_from_world(v)) - v).length() < 4e-6);
            assert!((frame.local_from_world(frame.normal) - Vec3::Z).length() < 1e-6);
        }
    }
}

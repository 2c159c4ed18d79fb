//! The shape that a mesh has in the world, without its place and its rotation: what instances can share an unwrap by.
//!
//! Of an instance's linear map M only the metric MᵀM matters to lengths on the surface. It is rounded to lengths and
//! cosines of the axes, so that instances that differ by rounding alone are the same shape, and taken apart into a
//! unit (the longest axis) and the rest. A factor of the rest (Cholesky) brings the mesh into that shape.

use glam::{Affine3A, DMat3, DVec3, Mat3, Vec3};

/// Steps of lengths and cosines: a length is off by less than a texel in 4000.
const STEPS: f64 = 4096.0;

/// Lengths of the axes over the longest, and their cosines, in steps.
pub(super) type ShapeKey = [i32; 6];

/// A mesh's shape in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Instances with one key are one shape up to size.
    pub(super) key: ShapeKey,
    /// World length of the longest axis [m]: what one unit of the shape is.
    pub(super) unit: f64,
    factor: DMat3,
}

impl Shape {
    pub(super) fn new(world_from_local: &Affine3A) -> Self {
        let matrix = Mat3::from(world_from_local.matrix3).as_dmat3();
        let axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
        let lengths = axes.map(DVec3::length);
        let unit = lengths[0].max(lengths[1]).max(lengths[2]);
        let relative = lengths.map(|length| rounded(length / unit));
        let cosines = [[0, 1], [0, 2], [1, 2]]
            .map(|[a, b]| (axes[a].dot(axes[b]) / (lengths[a] * lengths[b]) * STEPS).round() / STEPS);
        let factor = factor(relative, cosines).unwrap_or_else(|| matrix * (1.0 / unit));
        let [x, y, z] = relative.map(|length| {
            let (mantissa, exponent) = steps(length);
            mantissa as i32 * 1024 + exponent
        });
        let [a, b, c] = cosines.map(|cosine| (cosine * STEPS) as i32);
        Self { key: [x, y, z, a, b, c], unit, factor }
    }

    /// A point of the mesh in this shape [unit].
    pub(super) fn apply(&self, position: Vec3) -> DVec3 {
        self.factor * position.as_dvec3()
    }
}

/// A number as steps of its own size: mantissa in [2048, 4096] and binary exponent.
fn steps(number: f64) -> (f64, i32) {
    let exponent = ((number.to_bits() >> 52) & 0x7ff) as i32 - 1022;
    let scale = f64::from_bits(((1023 - exponent.clamp(-1000, 1000)) as u64) << 52);
    ((number * scale * STEPS).round(), exponent)
}

fn rounded(number: f64) -> f64 {
    let (mantissa, exponent) = steps(number);
    mantissa / STEPS * f64::from_bits(((1023 + exponent.clamp(-1000, 1000)) as u64) << 52)
}

/// A matrix whose columns have these lengths and cosines; `None` where rounding left no such matrix.
fn factor([x, y, z]: [f64; 3], [xy, xz, yz]: [f64; 3]) -> Option<DMat3> {
    let y_height = (1.0 - xy * xy).sqrt();
    let across = (yz - xy * xz) / y_height;
    let z_height = (1.0 - xz * xz - across * across).sqrt();
    let columns = [DVec3::X * x, DVec3::new(xy, y_height, 0.0) * y, DVec3::new(xz, across, z_height) * z];
    let is_sound = y_height > 0.01 && z_height > 0.01 && columns.iter().all(|column| column.is_finite());
    is_sound.then(|| DMat3::from_cols(columns[0], columns[1], columns[2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    #[test]
    fn rotations_and_mirrors_leave_the_shape() {
        let scale = Vec3::new(4.0, 2.5, 0.25);
        let plain = Shape::new(&Affine3A::from_scale(scale));
        assert_eq!(plain.apply(Vec3::new(1.0, 1.0, 1.0)), (scale / 4.0).as_dvec3());
        let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.3, 1.2, -2.0);
        for scale in [scale, scale * Vec3::new(-1.0, 1.0, 1.0), 3.0 * scale] {
            let turned = Shape::new(&Affine3A::from_scale_rotation_translation(scale, turn, Vec3::ONE));
            assert_eq!(turned.key, plain.key);
        }
        assert_ne!(Shape::new(&Affine3A::from_scale(Vec3::new(4.0, 2.6, 0.25))).key, plain.key);
    }

    #[test]
    fn shears_keep_lengths() {
        let shear = Affine3A::from_cols(
            Vec3::X.into(),
            Vec3::new(3.0, 1.0, 0.0).into(),
            Vec3::new(0.2, 0.1, 2.0).into(),
            Vec3::ZERO.into(),
        );
        let shape = Shape::new(&shear);
        for point in [Vec3::X, Vec3::Y, Vec3::new(1.0, -2.0, 0.5)] {
            let world = shear.transform_vector3(point).as_dvec3().length();
            assert!((shape.apply(point).length() * shape.unit / world - 1.0).abs() < 2e-3, "{point}");
        }
    }
}

//! What can be wrong with lights and with the picture of the sky.

use super::super::{DirectionalLight, EnvironmentMap, FaultKind, Light, PointLight, RectLight, SpotLight};
use super::{is_invertible, is_radiance};
use glam::Vec3;
use std::f32::consts::PI;

impl Light {
    /// What keeps this light from shining.
    pub(crate) fn faults(&self) -> Vec<FaultKind> {
        match self {
            Self::Rect(light) => rect_faults(light),
            Self::Point(light) => point_faults(light),
            Self::Spot(light) => spot_faults(light),
            Self::Directional(light) => directional_faults(light),
        }
    }
}

impl EnvironmentMap {
    /// What keeps this picture from being a sky.
    pub(crate) fn faults(&self) -> Vec<FaultKind> {
        let (width, height, count) = (self.width, self.height, self.radiance.len());
        if count == 0 || u64::from(width) * u64::from(height) != count as u64 {
            return vec![FaultKind::BadSize { width, height, count }];
        }
        let mut kinds = Vec::new();
        if let Some(index) = self.radiance.iter().position(|&radiance| !is_radiance(radiance)) {
            kinds.push(FaultKind::BadPixel { column: index % width as usize, row: index / width as usize });
        }
        // Not exactly 1: a product of rotations never is.
        if !(self.world_from_map.is_finite() && (self.world_from_map.length() - 1.0).abs() < 1e-3) {
            kinds.push(FaultKind::BadRotation);
        }
        kinds
    }
}

fn rect_faults(light: &RectLight) -> Vec<FaultKind> {
    let mut kinds = emission_faults(light.radiance);
    let is_extent = |extent: f32| extent.is_finite() && extent > 0.0;
    if !(is_extent(light.width) && is_extent(light.height)) {
        kinds.push(FaultKind::ZeroArea);
    }
    kinds.extend(range_fault(light.range));
    if !is_invertible(&light.world_from_local) {
        kinds.push(FaultKind::SingularTransform);
    }
    kinds
}

fn point_faults(light: &PointLight) -> Vec<FaultKind> {
    let mut kinds = emission_faults(light.intensity);
    if !light.position.is_finite() {
        kinds.push(FaultKind::NonFiniteLight);
    }
    if !(light.radius.is_finite() && light.radius >= 0.0) {
        kinds.push(FaultKind::BadRadius { radius: light.radius });
    }
    kinds.extend(range_fault(light.range));
    kinds
}

fn spot_faults(light: &SpotLight) -> Vec<FaultKind> {
    let mut kinds = point_faults(&light.bulb);
    kinds.extend(direction_fault(light.direction));
    let (inner, outer) = (light.inner_angle, light.outer_angle);
    // NaN is in no range.
    if !((0.0..=PI).contains(&outer) && (0.0..=outer).contains(&inner)) {
        kinds.push(FaultKind::BadCone { inner, outer });
    }
    kinds
}

fn directional_faults(light: &DirectionalLight) -> Vec<FaultKind> {
    let mut kinds = emission_faults(light.illuminance);
    kinds.extend(direction_fault(light.direction));
    if !(0.0..=PI).contains(&light.angular_diameter) {
        kinds.push(FaultKind::BadDiameter { diameter: light.angular_diameter });
    }
    kinds
}

fn emission_faults(emission: Vec3) -> Vec<FaultKind> {
    if is_radiance(emission) { Vec::new() } else { vec![FaultKind::BadEmission] }
}

fn range_fault(range: Option<f32>) -> Option<FaultKind> {
    let range = range?;
    (range.is_nan() || range <= 0.0).then_some(FaultKind::BadRange { range })
}

fn direction_fault(direction: Vec3) -> Option<FaultKind> {
    direction.try_normalize().is_none().then_some(FaultKind::BadDirection)
}

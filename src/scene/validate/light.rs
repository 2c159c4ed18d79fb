//! What can be wrong with lights and with the picture of the sky.

use super::super::{DirectionalLight, EnvironmentMap, FaultKind, Light, PointLight, RectLight, SpotLight};
use super::{MAX_EMISSION, emission_fault, is_invertible, is_radiance};
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
        let place = |index: usize| (index % width as usize, index / width as usize);
        if let Some(index) = self.radiance.iter().position(|&radiance| !is_radiance(radiance)) {
            let (column, row) = place(index);
            kinds.push(FaultKind::BadPixel { column, row });
        } else if let Some(index) = self.radiance.iter().position(|radiance| radiance.max_element() > MAX_EMISSION) {
            let (column, row) = place(index);
            kinds.push(FaultKind::TooBrightPixel { column, row, limit: MAX_EMISSION });
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
    emission_fault(emission).into_iter().collect()
}

fn range_fault(range: Option<f32>) -> Option<FaultKind> {
    let range = range?;
    (range.is_nan() || range <= 0.0).then_some(FaultKind::BadRange { range })
}

fn direction_fault(direction: Vec3) -> Option<FaultKind> {
    direction.try_normalize().is_none().then_some(FaultKind::BadDirection)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::artefact::StableId;
    use crate::scene::{Fault, Scene};
    use glam::Quat;

    fn bulb() -> PointLight {
        PointLight {
            id: StableId::new("lamp"),
            name: "lamp".into(),
            position: Vec3::ZERO,
            intensity: Vec3::ONE,
            radius: 0.1,
            range: None,
        }
    }

    fn spot() -> SpotLight {
        SpotLight { bulb: bulb(), direction: Vec3::X, inner_angle: 0.1, outer_angle: 0.5 }
    }

    fn sun() -> DirectionalLight {
        DirectionalLight {
            id: StableId::new("lamp"),
            name: "lamp".into(),
            direction: Vec3::X,
            illuminance: Vec3::ONE,
            angular_diameter: 0.01,
        }
    }

    fn sky() -> EnvironmentMap {
        EnvironmentMap {
            name: "sky".into(),
            width: 3,
            height: 2,
            radiance: vec![Vec3::ONE; 6].into(),
            world_from_map: Quat::IDENTITY,
        }
    }

    fn sentences(scene: &Scene) -> Vec<String> {
        scene.validate().iter().map(Fault::to_string).collect()
    }

    #[track_caller]
    fn assert_light(light: Light, sentence: &str) {
        let found = sentences(&Scene { lights: vec![light], ..Scene::default() });
        assert!(found.len() == 1 && found[0].starts_with(&format!("light \"lamp\" {sentence}")), "{found:?}");
    }

    #[track_caller]
    fn assert_sky(map: EnvironmentMap, sentence: &str) {
        let found = sentences(&Scene { environment: Some(map), ..Scene::default() });
        assert!(found.len() == 1 && found[0].starts_with(&format!("environment map \"sky\" {sentence}")), "{found:?}");
    }

    #[test]
    fn sound_lights_have_no_fault() {
        let dark = PointLight { intensity: Vec3::ZERO, radius: 0.0, range: Some(f32::INFINITY), ..bulb() };
        let widest = SpotLight { inner_angle: PI, outer_angle: PI, ..spot() };
        let half_the_sky = DirectionalLight { angular_diameter: PI, ..sun() };
        for light in [Light::Point(bulb()), Light::Point(dark), Light::Spot(widest), Light::Directional(half_the_sky)] {
            assert_eq!(light.faults(), []);
        }
        assert_eq!(sky().faults(), []);
    }

    #[test]
    fn each_fault_of_a_light_is_named() {
        let point = |light| Light::Point(light);
        assert_light(point(PointLight { intensity: Vec3::NEG_X, ..bulb() }), "has an emission");
        let sentence = "has an emission of 2e25, above 1e25";
        assert_light(point(PointLight { intensity: Vec3::new(0.0, 2e25, 1.0), ..bulb() }), sentence);
        assert_light(point(PointLight { position: Vec3::NAN, ..bulb() }), "has a position");
        assert_light(point(PointLight { radius: -1.0, ..bulb() }), "has a radius of -1 m");
        assert_light(point(PointLight { radius: f32::NAN, ..bulb() }), "has a radius of NaN m");
        assert_light(point(PointLight { range: Some(0.0), ..bulb() }), "has a range of 0 m");
        let spots = [
            SpotLight { inner_angle: 0.6, ..spot() },
            SpotLight { inner_angle: -0.1, ..spot() },
            SpotLight { outer_angle: 4.0, ..spot() },
            SpotLight { outer_angle: f32::NAN, ..spot() },
        ];
        for light in spots {
            assert_light(Light::Spot(light), "has a cone from");
        }
        assert_light(Light::Spot(SpotLight { direction: Vec3::ZERO, ..spot() }), "has a direction of no length");
        assert_light(Light::Directional(DirectionalLight { direction: Vec3::NAN, ..sun() }), "has a direction");
        for angular_diameter in [-0.1, 3.2, f32::NAN] {
            let sun = DirectionalLight { angular_diameter, ..sun() };
            assert_light(Light::Directional(sun), "has an angular diameter of");
        }
    }

    #[test]
    fn each_fault_of_a_picture_of_the_sky_is_named() {
        assert_sky(EnvironmentMap { width: 4, ..sky() }, "has 6 pixels for a size of 4 × 2");
        assert_sky(EnvironmentMap { width: 0, height: 0, radiance: Vec::new().into(), ..sky() }, "has 0 pixels");
        for bad in [Vec3::NAN, Vec3::INFINITY, Vec3::new(1.0, -1e-9, 1.0)] {
            let mut radiance = vec![Vec3::ONE; 6];
            (radiance[4], radiance[5]) = (bad, bad);
            let sentence = "has a pixel that is negative or not a finite number (the first at column 1, row 1";
            assert_sky(EnvironmentMap { radiance: radiance.into(), ..sky() }, sentence);
        }
        let mut radiance = vec![Vec3::splat(MAX_EMISSION); 6];
        radiance[5].y = MAX_EMISSION.next_up();
        let sentence = "has a pixel brighter than 1e25 cd/m², where numbers end (the first at column 2, row 1";
        assert_sky(EnvironmentMap { radiance: radiance.into(), ..sky() }, sentence);
        for rotation in [Quat::NAN, Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), Quat::from_xyzw(0.0, 2.0, 0.0, 0.0)] {
            assert_sky(EnvironmentMap { world_from_map: rotation, ..sky() }, "has a rotation");
        }
    }
}

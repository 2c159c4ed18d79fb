//! Which parts of a scene can be used.

use crate::scene::{Fault, FaultKind, Scene, Subject};
use std::collections::HashSet;

/// Which parts of a scene can be used.
pub(super) struct Sound {
    pub(super) instances: Vec<bool>,
    /// Per instance, whether it asks for a lightmap and can have one.
    pub(super) lightmaps: Vec<bool>,
    pub(super) textures: Vec<bool>,
    pub(super) lights: Vec<bool>,
    pub(super) sky: bool,
    pub(super) environment: bool,
}

impl Sound {
    pub(super) fn new(scene: &Scene, faults: &[Fault]) -> Self {
        let meshes: Vec<bool> = scene.meshes.iter().map(|mesh| mesh.faults().is_empty()).collect();
        let materials: Vec<bool> = scene.materials.iter().map(|material| material.faults().is_empty()).collect();
        let mut ids = HashSet::new();
        let mut instances = Vec::new();
        let mut lightmaps = Vec::new();
        for instance in &scene.instances {
            let kinds = scene.instance_faults(instance);
            let sound = ids.insert(&instance.id)
                && kinds.iter().all(FaultKind::costs_only_the_lightmap)
                && meshes.get(instance.mesh) == Some(&true)
                && materials.get(instance.material) == Some(&true);
            instances.push(sound);
            lightmaps.push(sound && instance.lightmap.is_some() && kinds.is_empty());
        }
        let mut ids = HashSet::new();
        let lights = scene.lights.iter().map(|light| ids.insert(light.id()) && light.faults().is_empty()).collect();
        let textures = scene.textures.iter().map(|texture| texture.faults().is_empty()).collect();
        let sky = !faults.iter().any(|fault| fault.subject == Subject::Sky);
        let environment = !faults.iter().any(|fault| matches!(fault.subject, Subject::Environment(_)));
        Self { instances, lightmaps, textures, lights, sky, environment }
    }
}

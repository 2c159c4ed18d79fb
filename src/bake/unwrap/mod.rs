//! A UV1 for every mesh that needs one, without asking.
//!
//! A mesh whose own UV1 lies in the unit square, without overlaps and with an area for all of the surface, keeps it
//! (`valid`). Any other is cut into charts (`surface`, `charts`, `split`, `merge`), which are laid out in the plane
//! (`flatten`, `unroll`, `relax`), turned into their tightest boxes (`tight`) and packed on the texels of the object's
//! rectangle (`pack`). What counts is the shape that the mesh has in the world (`shape`): instances of one shape share
//! charts, and those of about one size the packing as well. The work is counted in visits of triangles and limited
//! (`work`); beyond the limit each plane gets a chart, at worst each triangle (`simple`). Same mesh, same bits:
//! threads, the order of instances and the clock cannot matter. Where the texels go on pages is `atlas`'s.

mod charts;
mod flatten;
mod group;
mod merge;
mod mesh;
mod overlap;
mod pack;
mod patch;
mod relax;
mod shape;
#[cfg(test)]
#[allow(dead_code, reason = "the tests of the whole use all of it")]
#[path = "../../../tests/unwrap/shapes.rs"]
mod shapes;
mod simple;
mod split;
mod surface;
mod tight;
mod unroll;
mod valid;
mod work;

pub use charts::UnwrapMethod;
pub use mesh::LaidOutMesh;
pub use valid::Uv1Fault;

use super::workers::Workers;
use super::{BakeError, BakeSettings, BakeWarning, Layout};
#[cfg(test)]
use crate as bevy_kiln;
use crate::artefact::StableId;
use crate::scene::{Fault, FaultKind, Instance, Mesh, Scene, Subject, UvChannel};
use group::{Group, Unwrapped};
use shape::{Shape, ShapeKey};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use valid::uv1_fault;

/// A scene in which every receiver that can have one has a UV1 without overlaps, and what was done for it.
pub(super) struct LaidOut<'a> {
    /// The scene; meshes that were given a UV1 take the place of the source, or stand behind the others.
    pub(super) scene: Cow<'a, Scene>,
    /// What was unwrapped.
    pub(super) meshes: Vec<LaidOutMesh>,
    /// Objects whose mesh is one of `meshes`.
    pub(super) mesh_of: BTreeMap<StableId, usize>,
    /// Their rectangles, width and height [texels].
    pub(super) sizes: BTreeMap<StableId, [u32; 2]>,
    /// What to tell about it.
    pub(super) warnings: Vec<BakeWarning>,
    is_packed: bool,
}

impl<'a> LaidOut<'a> {
    /// Gives every receiver a UV1, for [`Layout::Packed`]; in a shared layout each keeps its own.
    pub(super) fn new(
        scene: &'a Scene,
        settings: &BakeSettings,
        workers: &Workers<'_>,
    ) -> Result<LaidOut<'a>, BakeError> {
        let mut laid_out = Self {
            scene: Cow::Borrowed(scene),
            meshes: Vec::new(),
            mesh_of: BTreeMap::new(),
            sizes: BTreeMap::new(),
            warnings: Vec::new(),
            is_packed: settings.layout == Layout::Packed,
        };
        if laid_out.is_packed {
            let receivers = receivers(scene);
            let faulty = faulty_meshes(scene, &receivers, workers)?;
            let groups = laid_out.groups(scene, &receivers, &faulty);
            let unwrapped = workers.gather_quietly(&groups, |group, cancel| group.unwrap(scene, settings, cancel))?;
            laid_out.take(scene, unwrapped);
        }
        Ok(laid_out)
    }

    /// Faults of the scene without those that the unwrap has solved or named itself.
    pub(super) fn without_solved(&self, mut faults: Vec<Fault>) -> Vec<Fault> {
        faults.retain(|fault| !(self.is_packed && fault.kind == FaultKind::MissingUv1));
        faults
    }

    /// Objects to be unwrapped, by mesh and shape; ordered by the first id of each.
    fn groups(&mut self, scene: &Scene, receivers: &[&'a Instance], faulty: &Faulty) -> Vec<Group<'a>> {
        let mut groups: Vec<Group<'a>> = Vec::new();
        let mut known: BTreeMap<(usize, ShapeKey), usize> = BTreeMap::new();
        let mut named = BTreeSet::new();
        for &instance in receivers {
            let Some(fault) = faulty.get(&instance.mesh) else {
                continue;
            };
            let mesh = &scene.meshes[instance.mesh];
            if let Some(fault) = fault {
                if looks_up_uv1(scene, instance) {
                    let subject = Subject::Instance(instance.name.clone());
                    self.warnings.push(BakeWarning::Uv1InUse { subject, fault: fault.clone() });
                    continue;
                }
                if named.insert(instance.mesh) {
                    let subject = Subject::Mesh(mesh.name.clone());
                    self.warnings.push(BakeWarning::Unwrapped { subject, fault: fault.clone() });
                }
            }
            let shape = Shape::new(&instance.world_from_local);
            let place = *known.entry((instance.mesh, shape.key)).or_insert(groups.len());
            if place == groups.len() {
                groups.push(Group { mesh: instance.mesh, shape, instances: Vec::new() });
            }
            groups[place].instances.push((instance, shape.unit));
        }
        groups
    }

    /// Puts what was unwrapped into the scene.
    fn take(&mut self, scene: &'a Scene, unwrapped: Vec<Unwrapped>) {
        let mut refused = BTreeSet::new();
        for group in unwrapped {
            self.warnings.extend(group.warnings);
            refused.extend(group.refused);
            for (mesh, objects) in group.meshes {
                for (id, size) in objects {
                    self.mesh_of.insert(id.clone(), self.meshes.len());
                    self.sizes.insert(id, size);
                }
                self.meshes.push(mesh);
            }
        }
        if !(self.meshes.is_empty() && refused.is_empty()) {
            let mut prepared = self.prepared(scene);
            let of_refused = prepared.instances.iter_mut().filter(|instance| refused.contains(&instance.id));
            of_refused.for_each(|instance| instance.lightmap = None);
            self.scene = Cow::Owned(prepared);
        }
    }

    fn prepared(&self, scene: &Scene) -> Scene {
        let replacements = self.replacements(scene);
        let still_used: BTreeSet<usize> = scene
            .instances
            .iter()
            .zip(&replacements)
            .filter(|(_, replacement)| replacement.is_none())
            .map(|(instance, _)| instance.mesh)
            .collect();
        let mut places = Vec::new();
        let mut replaced: BTreeMap<usize, Mesh> = BTreeMap::new();
        let mut behind = Vec::new();
        for mesh in &self.meshes {
            let built = mesh.build(&scene.meshes[mesh.source]);
            if still_used.contains(&mesh.source) || replaced.contains_key(&mesh.source) {
                places.push(scene.meshes.len() + behind.len());
                behind.push(built);
            } else {
                places.push(mesh.source);
                replaced.insert(mesh.source, built);
            }
        }
        let mut instances = scene.instances.clone();
        for (instance, replacement) in instances.iter_mut().zip(replacements) {
            instance.mesh = replacement.map_or(instance.mesh, |mesh| places[mesh]);
        }
        let kept = scene.meshes.iter().enumerate();
        let kept = kept.map(|(index, mesh)| replaced.remove(&index).unwrap_or_else(|| mesh.clone()));
        Scene {
            meshes: kept.chain(behind).collect(),
            instances,
            materials: scene.materials.clone(),
            indirect_only: scene.indirect_only.clone(),
            off_in_real_time: scene.off_in_real_time.clone(),
            fingerprints: scene.fingerprints.clone(),
            textures: scene.textures.clone(),
            lights: scene.lights.clone(),
            environment: scene.environment.clone(),
            cameras: scene.cameras.clone(),
            ..*scene
        }
    }

    /// Which of the new meshes each instance takes: of two with one id only the first, the other is refused.
    fn replacements(&self, scene: &Scene) -> Vec<Option<usize>> {
        let mut ids = BTreeSet::new();
        let replacement = |instance: &Instance| self.mesh_of.get(&instance.id).copied();
        scene.instances.iter().map(|instance| replacement(instance).filter(|_| ids.insert(&instance.id))).collect()
    }
}

/// What is wrong with the UV1 of the meshes that have no valid one; `None` where there is none.
type Faulty = BTreeMap<usize, Option<Uv1Fault>>;

/// Instances that ask for a lightmap and have no fault but in their UV1, by id.
fn receivers(scene: &Scene) -> Vec<&Instance> {
    let mut ids = BTreeSet::new();
    let is_sound = |kind: &FaultKind| {
        matches!(kind, FaultKind::MissingUv1 | FaultKind::Uv1OutsideUnitSquare { .. } | FaultKind::Uv1WithoutArea)
    };
    let mut receivers: Vec<&Instance> = scene
        .instances
        .iter()
        .filter(|instance| ids.insert(&instance.id))
        .filter(|instance| instance.lightmap.is_some() && scene.instance_faults(instance).iter().all(is_sound))
        .collect();
    receivers.sort_by(|a, b| a.id.cmp(&b.id));
    receivers
}

fn faulty_meshes(scene: &Scene, receivers: &[&Instance], workers: &Workers<'_>) -> Result<Faulty, BakeError> {
    let meshes: BTreeSet<usize> = receivers.iter().map(|instance| instance.mesh).collect();
    let meshes: Vec<usize> = meshes.into_iter().collect();
    let judged = workers.gather_quietly(&meshes, |&index, cancel| {
        let mesh = &scene.meshes[index];
        let judged = match &mesh.uv1 {
            _ if cancel.is_cancelled() || !mesh.faults().is_empty() => None,
            None => Some(None),
            Some(uv1) => uv1_fault(mesh, uv1, cancel).map(Some),
        };
        (!cancel.is_cancelled()).then_some(judged)
    })?;
    Ok(meshes.into_iter().zip(judged).filter_map(|(mesh, fault)| Some((mesh, fault?))).collect())
}

/// Whether an object's material looks a texture up by UV1, so that another UV1 would change what it looks like.
fn looks_up_uv1(scene: &Scene, instance: &Instance) -> bool {
    scene.materials[instance.material].textures().any(|texture| texture.uv == UvChannel::Uv1)
}

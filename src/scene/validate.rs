//! Every fault of a scene, found before anything is traced.

mod light;
mod material;

use super::{Fault, FaultKind, Instance, Mesh, Scene, Subject, Topology};
use glam::{Affine3A, Vec2, Vec3};
use std::collections::HashSet;

/// The farthest coordinate that is traced [m]: farther than the moon. Rays tell things apart that are 10⁻¹³ of the
/// scene's reach from each other, so that a single vertex at 10¹⁵ m would take the order from the walls of a room;
/// and f32 has steps of 64 m there.
const FARTHEST: f64 = 1e9;

impl Scene {
    /// Every fault in the scene, each with the name of what is at fault. Empty for a sound scene.
    pub fn validate(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut blame = |subject: Subject, kinds: Vec<FaultKind>| {
            faults.extend(kinds.into_iter().map(|kind| Fault { subject: subject.clone(), kind }));
        };
        for mesh in &self.meshes {
            blame(Subject::Mesh(mesh.name.clone()), mesh.faults());
        }
        for texture in &self.textures {
            blame(Subject::Texture(texture.name.clone()), texture.faults());
        }
        for material in &self.materials {
            let mut kinds = material.faults();
            kinds.extend(self.missing_texture(material));
            blame(Subject::Material(material.name.clone()), kinds);
        }
        let mut ids = HashSet::new();
        for instance in &self.instances {
            let mut kinds = self.instance_faults(instance);
            if !ids.insert(&instance.id) {
                kinds.push(FaultKind::DuplicateId);
            }
            blame(Subject::Instance(instance.name.clone()), kinds);
        }
        let mut ids = HashSet::new();
        for light in &self.lights {
            let mut kinds = light.faults();
            if !ids.insert(light.id()) {
                kinds.push(FaultKind::DuplicateId);
            }
            blame(Subject::Light(light.name().to_owned()), kinds);
        }
        blame(Subject::Sky, emission_fault(self.sky_radiance).into_iter().collect());
        if let Some(map) = &self.environment {
            blame(Subject::Environment(map.name.clone()), map.faults());
        }
        faults
    }

    /// The faults of one instance's own, without those of its mesh and its material.
    pub(crate) fn instance_faults(&self, instance: &Instance) -> Vec<FaultKind> {
        let mut kinds = Vec::new();
        if !is_invertible(&instance.world_from_local) {
            kinds.push(FaultKind::SingularTransform);
        }
        if instance.material >= self.materials.len() {
            kinds.push(FaultKind::MissingMaterial { index: instance.material });
        }
        let Some(mesh) = self.meshes.get(instance.mesh) else {
            kinds.push(FaultKind::MissingMesh { index: instance.mesh });
            return kinds;
        };
        kinds.extend(too_far(mesh, &instance.world_from_local));
        if let Some(request) = instance.lightmap {
            if let Some(density) = request.density
                && !(density.is_finite() && density > 0.0)
            {
                kinds.push(FaultKind::Density { density });
            }
            kinds.extend(mesh.uv1_fault());
        }
        kinds
    }
}

impl Mesh {
    /// What keeps this mesh from being traced.
    pub(crate) fn faults(&self) -> Vec<FaultKind> {
        let mut kinds = Vec::new();
        let vertex_count = self.positions.len();
        if let Some(vertex) = self.positions.iter().position(|position| !position.is_finite()) {
            kinds.push(FaultKind::NonFinitePosition { vertex });
        }
        let lengths = [
            ("normals", self.normals.as_ref().map(Vec::len)),
            ("UV0 coordinates", self.uv0.as_ref().map(Vec::len)),
            ("UV1 coordinates", self.uv1.as_ref().map(Vec::len)),
            ("colours", self.colours.as_ref().map(Vec::len)),
            ("tangents", self.tangents.as_ref().map(Vec::len)),
        ];
        for (attribute, length) in lengths {
            if let Some(count) = length.filter(|&count| count != vertex_count) {
                kinds.push(FaultKind::AttributeLength { attribute, count, vertex_count });
            }
        }
        let corners = self.corner_count();
        if self.topology == Topology::TriangleList && !corners.is_multiple_of(3) {
            kinds.push(FaultKind::IncompleteTriangle { count: corners });
        }
        let out_of_range =
            (0..corners).map(|corner| self.vertex(corner)).find(|&vertex| vertex as usize >= vertex_count);
        if let Some(index) = out_of_range {
            kinds.push(FaultKind::IndexOutOfRange { index, vertex_count });
        }
        if kinds.is_empty() && !self.triangles().any(|triangle| self.has_area(triangle)) {
            kinds.push(FaultKind::NoTriangles);
        }
        kinds
    }

    fn has_area(&self, triangle: [u32; 3]) -> bool {
        let [a, b, c] = triangle.map(|vertex| self.positions[vertex as usize].as_dvec3());
        (b - a).cross(c - a).length_squared() > 0.0
    }

    /// What keeps this mesh from having a lightmap. Asks for a mesh without other faults.
    fn uv1_fault(&self) -> Option<FaultKind> {
        let Some(uv1) = &self.uv1 else {
            return Some(FaultKind::MissingUv1);
        };
        // Exporters round; a coordinate this far outside still lands on the border texel.
        let slack = 1e-4;
        let inside = |uv: &Vec2| uv.is_finite() && uv.min_element() >= -slack && uv.max_element() <= 1.0 + slack;
        if let Some(vertex) = uv1.iter().position(|uv| !inside(uv)) {
            return Some(FaultKind::Uv1OutsideUnitSquare { vertex });
        }
        if uv1.len() != self.positions.len() || !self.faults().is_empty() {
            return None;
        }
        let has_area = |triangle: [u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| uv1[vertex as usize].as_dvec2());
            (b - a).perp_dot(c - a) != 0.0
        };
        (!self.triangles().any(has_area)).then_some(FaultKind::Uv1WithoutArea)
    }
}

/// The first vertex that a transform takes too far away. One that is no number is another fault's.
fn too_far(mesh: &Mesh, transform: &Affine3A) -> Option<FaultKind> {
    let matrix = glam::Mat3::from(transform.matrix3).as_dmat3();
    let translation = Vec3::from(transform.translation).as_dvec3();
    let distance = |position: &Vec3| (matrix * position.as_dvec3() + translation).abs().max_element();
    let distance = mesh.positions.iter().map(distance).find(|distance| distance.is_finite() && *distance > FARTHEST)?;
    Some(FaultKind::TooFar { distance, limit: FARTHEST })
}

/// The most that a source may give off [cd/m², cd or lx]. The largest `f32` is 3·10³⁸; this leaves room for the
/// radiance of the smallest sun, 3.2·10⁹ times its illuminance, and for the inverse square of a micrometre. The sun's
/// own disc has 1.6·10⁹ cd/m².
const MAX_EMISSION: f32 = 1e25;

/// What is wrong with an emission, if anything is.
fn emission_fault(emission: Vec3) -> Option<FaultKind> {
    if !is_radiance(emission) {
        return Some(FaultKind::BadEmission);
    }
    let (value, limit) = (emission.max_element(), MAX_EMISSION);
    (value > limit).then_some(FaultKind::TooBright { value, limit })
}

fn is_radiance(radiance: Vec3) -> bool {
    radiance.is_finite() && radiance.min_element() >= 0.0
}

fn is_invertible(transform: &Affine3A) -> bool {
    // In f64, so that a transform of tiny scale is not mistaken for a flat one.
    let [x, y, z] = [transform.matrix3.x_axis, transform.matrix3.y_axis, transform.matrix3.z_axis]
        .map(|axis| Vec3::from(axis).as_dvec3());
    let determinant = x.cross(y).dot(z);
    let bound = x.length() * y.length() * z.length();
    transform.is_finite() && bound > 0.0 && determinant.abs() > 1e-9 * bound
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::artefact::StableId;
    use crate::scene::{
        Filter, Indices, Light, LightmapRequest, Material, RectLight, Scattering, Standard, Texels, Texture,
        TextureRef, UvChannel,
    };

    fn sound() -> Scene {
        Scene {
            meshes: vec![Mesh {
                name: "quad".into(),
                topology: Topology::TriangleList,
                indices: Indices::U16(vec![0, 1, 2, 2, 1, 3]),
                positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y],
                normals: Some(vec![Vec3::Z; 4]),
                uv1: Some(vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE]),
                ..Mesh::default()
            }],
            materials: vec![Material::diffuse("grey", Vec3::splat(0.5))],
            instances: vec![Instance {
                id: StableId::new("wall"),
                name: "wall".into(),
                mesh: 0,
                material: 0,
                world_from_local: Affine3A::IDENTITY,
                lightmap: Some(LightmapRequest::default()),
            }],
            lights: vec![Light::Rect(RectLight {
                id: StableId::new("lamp"),
                name: "lamp".into(),
                world_from_local: Affine3A::IDENTITY,
                width: 1.0,
                height: 1.0,
                radiance: Vec3::ONE,
                range: None,
            })],
            ..Scene::default()
        }
    }

    /// Spoils a sound scene and holds its one fault against the sentence that a person should read.
    fn assert_fault(spoil: impl FnOnce(&mut Scene), sentence: &str) {
        let mut scene = sound();
        spoil(&mut scene);
        let faults: Vec<String> = scene.validate().iter().map(Fault::to_string).collect();
        assert_eq!(faults.len(), 1, "{faults:?}");
        assert!(faults[0].starts_with(sentence), "{} does not start with {sentence}", faults[0]);
    }

    #[test]
    fn a_sound_scene_has_no_fault() {
        assert_eq!(sound().validate(), []);
    }

    #[test]
    fn each_fault_is_named() {
        let rect = |scene: &mut Scene| {
            let Light::Rect(light) = &scene.lights[0] else { unreachable!("the lamp is a rectangle") };
            light.clone()
        };
        assert_fault(
            |s| s.meshes[0].positions[2].y = f32::NAN,
            "mesh \"quad\" has a position that is not a finite number (vertex 2)",
        );
        assert_fault(
            |s| s.meshes[0].positions[2].y = -3e12,
            "instance \"wall\" has a vertex 3.0e12 m from the world's origin, farther than the 1e9 m",
        );
        assert_fault(
            |s| s.instances[0].world_from_local = Affine3A::from_scale(Vec3::splat(2e9)),
            "instance \"wall\" has a vertex 2.0e9 m",
        );
        assert_fault(
            |s| s.meshes[0].indices = Indices::U32(vec![0, 1, 9]),
            "mesh \"quad\" has index 9 but only 4 vertices",
        );
        assert_fault(
            |s| s.meshes[0].indices = Indices::U32(vec![0, 1, 2, 3]),
            "mesh \"quad\" ends in the middle of a triangle",
        );
        assert_fault(|s| s.meshes[0].indices = Indices::U32(vec![]), "mesh \"quad\" has no triangle");
        assert_fault(|s| s.meshes[0].indices = Indices::U32(vec![0, 0, 1]), "mesh \"quad\" has no triangle");
        assert_fault(|s| s.meshes[0].normals = Some(vec![]), "mesh \"quad\" has 0 normals for 4 vertices");
        assert_fault(|s| s.meshes[0].uv1 = None, "instance \"wall\" has no UV1");
        assert_fault(
            |s| s.meshes[0].uv1 = Some(vec![Vec2::splat(2.0); 4]),
            "instance \"wall\" has a UV1 (TEXCOORD_1) outside",
        );
        assert_fault(
            |s| s.meshes[0].uv1 = Some(vec![Vec2::ZERO; 4]),
            "instance \"wall\" has a UV1 (TEXCOORD_1) without area",
        );
        assert_fault(
            |s| s.instances[0].lightmap = Some(LightmapRequest { density: Some(-1.0) }),
            "instance \"wall\" asks for a lightmap of -1",
        );
        assert_fault(
            |s| s.instances[0].world_from_local = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0)),
            "instance \"wall\" has a transform that cannot be inverted",
        );
        assert_fault(|s| s.instances[0].material = 7, "instance \"wall\" refers to material number 7");
        assert_fault(|s| s.instances[0].mesh = 7, "instance \"wall\" refers to mesh number 7");
        assert_fault(|s| s.instances.push(s.instances[0].clone()), "instance \"wall\" has the same id");
        for range in [0.0, -1.0, f32::NAN] {
            assert_fault(
                |s| s.lights[0] = Light::Rect(RectLight { range: Some(range), ..rect(s) }),
                "light \"lamp\" has a range of",
            );
        }
        assert_fault(|s| s.lights.push(s.lights[0].clone()), "light \"lamp\" has the same id");
        assert_fault(|s| s.materials[0].base_colour.x = 1.5, "material \"grey\" has a base colour outside 0 to 1");
        assert_fault(|s| s.materials[0].emitted_radiance.x = f32::INFINITY, "material \"grey\" has an emission");
        assert_fault(|s| s.materials[0].base_colour.w = -0.1, "material \"grey\" has a base colour outside 0 to 1");
        assert_fault(
            |s| s.materials[0].scattering = Scattering::Refraction { ior: 0.0 },
            "material \"grey\" has an index of refraction of 0, outside 0.01 to 100",
        );
        assert_fault(
            |s| {
                let standard = Standard { metallic: f32::NAN, ..Standard::default() };
                s.materials[0].scattering = Scattering::Standard(Box::new(standard));
            },
            "material \"grey\" has a metallic share of NaN",
        );
        assert_fault(
            |s| s.materials[0].scattering = Scattering::Phong { specular: Vec3::splat(0.6), exponent: 5.0 },
            "material \"grey\" has a base colour outside 0 to 1",
        );
        let reference = TextureRef { texture: 3, uv: UvChannel::Uv0 };
        assert_fault(
            |s| s.materials[0].base_colour_texture = Some(reference),
            "material \"grey\" refers to texture number 3",
        );
        let texture = |texels: &[[f32; 4]]| Texture {
            name: "wood".into(),
            width: 2,
            height: 1,
            texels: Texels::Float(texels.into()),
            wrap: Default::default(),
            filter: Filter::Linear,
        };
        assert_fault(|s| s.textures.push(texture(&[[0.0; 4]])), "texture \"wood\" says 2 × 1 texels and has 1");
        assert_fault(
            |s| s.textures.push(texture(&[[0.0; 4], [0.0, f32::NAN, 0.0, 1.0]])),
            "texture \"wood\" has a texel that is not a finite number (at 1, 0)",
        );
        assert_fault(|s| s.sky_radiance.x = -1.0, "the sky has an emission");
        assert_fault(|s| s.lights[0] = Light::Rect(RectLight { width: 0.0, ..rect(s) }), "light \"lamp\" has no area");
        assert_fault(
            |s| s.lights[0] = Light::Rect(RectLight { radiance: Vec3::NAN, ..rect(s) }),
            "light \"lamp\" has an emission",
        );
    }

    #[test]
    fn mirrored_sheared_and_tiny_transforms_are_invertible() {
        assert!(is_invertible(&Affine3A::from_scale(Vec3::new(-1e-12, 1e-12, 3e-12))));
        assert!(is_invertible(&Affine3A::from_cols(
            Vec3::X.into(),
            (5.0 * Vec3::X + Vec3::Y).into(),
            Vec3::Z.into(),
            Vec3::ONE.into()
        )));
        assert!(!is_invertible(&Affine3A::from_cols(Vec3::X.into(), Vec3::X.into(), Vec3::Z.into(), Vec3::ONE.into())));
    }
}

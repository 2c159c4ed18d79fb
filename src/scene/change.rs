//! What of two scenes differs, as far as light goes: which sources, and whether any surface. And each scene by a part of
//! its light alone, so that what a change adds and takes can be measured by itself: light adds up, and what the
//! sources that did not change send to surfaces that did not change stays as it was.
//!
//! Things are told apart by their stable ids; names do not count, nor does the order of anything.

use super::{Instance, Light, Material, Mesh, Scene, Texture, TextureRef, UvChannel};
use crate::artefact::StableId;
use glam::{Affine3A, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// What differs between two scenes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Change {
    /// Whether a surface came, went, moved or looks different.
    surfaces: bool,
    /// Lights that came, went or changed.
    lights: BTreeSet<StableId>,
    /// Surfaces that give off light, and of which that or anything else changed.
    glowing: BTreeSet<StableId>,
    /// Whether the sky changed.
    sky: bool,
}

/// All of an instance that light meets, without its names.
#[derive(PartialEq)]
struct Body<'a> {
    shape: Shape<'a>,
    world_from_local: Affine3A,
    /// Without its glow; which textures it refers to is in `pictures` alone.
    material: Material,
    pictures: Vec<Picture<'a>>,
}

/// What an instance gives off.
#[derive(PartialEq)]
struct Glow<'a> {
    radiance: Vec3,
    picture: Option<Picture<'a>>,
    is_of_both_sides: bool,
}

/// A mesh without its name.
struct Shape<'a>(&'a Mesh);

impl PartialEq for Shape<'_> {
    fn eq(&self, other: &Self) -> bool {
        let (Mesh { name: _, topology, indices, positions, normals, uv0, uv1, colours, tangents }, other) =
            (self.0, other.0);
        (topology, indices, positions, normals) == (&other.topology, &other.indices, &other.positions, &other.normals)
            && (uv0, uv1, colours, tangents) == (&other.uv0, &other.uv1, &other.colours, &other.tangents)
    }
}

/// A texture without its name, as a material uses it.
struct Picture<'a> {
    texture: &'a Texture,
    uv: UvChannel,
}

impl PartialEq for Picture<'_> {
    fn eq(&self, other: &Self) -> bool {
        let (Texture { name: _, width, height, texels, wrap, filter }, texture) = (self.texture, other.texture);
        (self.uv, width, height, wrap, filter)
            == (other.uv, &texture.width, &texture.height, &texture.wrap, &texture.filter)
            && *texels == texture.texels
    }
}

impl Change {
    /// What differs from `before` to `after`. An instance at fault counts as changed: it is not known what it is.
    pub(crate) fn between(before: &Scene, after: &Scene) -> Self {
        let mut change = Self {
            sky: before.sky_radiance != after.sky_radiance || before.environment != after.environment,
            ..Self::default()
        };
        let lights = |scene| -> BTreeMap<StableId, &Light> { by_id(scene, |s: &Scene| &s.lights, Light::id) };
        for (id, lights) in paired(lights(before), lights(after)) {
            let is_drawn = [before, after].map(|scene| scene.indirect_only.contains(&id));
            let is_same = matches!(lights, [Some(a), Some(b)] if without_name(a) == without_name(b));
            if !is_same || is_drawn[0] != is_drawn[1] {
                change.lights.insert(id);
            }
        }
        let instances = |scene| -> BTreeMap<StableId, &Instance> { by_id(scene, |s: &Scene| &s.instances, |i| &i.id) };
        for (id, [a, b]) in paired(instances(before), instances(after)) {
            let [a, b] = [a.map(|one| (before, one)), b.map(|one| (after, one))];
            let [body_a, body_b] = [a, b].map(|one| body(one?.0, one?.1));
            let [glow_a, glow_b] = [a, b].map(|one| glow(one?.0, one?.1));
            let is_same_body = body_a.is_some() && body_a == body_b;
            change.surfaces |= !is_same_body;
            if (glow_a.is_some() || glow_b.is_some()) && !(is_same_body && glow_a == glow_b) {
                change.glowing.insert(id);
            }
        }
        change
    }

    /// Whether a surface changed in any way but in what it gives off.
    pub(crate) fn is_of_surfaces(&self) -> bool {
        self.surfaces
    }

    /// Whether anything that gives light changed.
    pub(crate) fn is_of_sources(&self) -> bool {
        self.sky || !self.lights.is_empty() || !self.glowing.is_empty()
    }

    /// Either of the two scenes by the light of the sources that did not change.
    pub(crate) fn by_steady_light(&self, scene: &Scene) -> Scene {
        self.by_light(scene, false)
    }

    /// Either of the two scenes by the light of the sources that changed.
    pub(crate) fn by_changed_light(&self, scene: &Scene) -> Scene {
        self.by_light(scene, true)
    }

    fn by_light(&self, scene: &Scene, changed: bool) -> Scene {
        let mut scene = scene.clone();
        scene.lights.retain(|light| self.lights.contains(light.id()) == changed);
        if self.sky != changed {
            (scene.sky_radiance, scene.environment) = (Vec3::ZERO, None);
        }
        let mut dark: BTreeMap<usize, usize> = BTreeMap::new();
        for instance in &mut scene.instances {
            if self.glowing.contains(&instance.id) != changed {
                instance.material = *dark.entry(instance.material).or_insert_with(|| {
                    let material = without_glow(scene.materials[instance.material].clone());
                    scene.materials.push(material);
                    scene.materials.len() - 1
                });
            }
        }
        scene
    }
}

fn by_id<'a, T>(
    scene: &'a Scene,
    list: impl Fn(&'a Scene) -> &'a Vec<T>,
    id: impl Fn(&'a T) -> &'a StableId,
) -> BTreeMap<StableId, &'a T> {
    list(scene).iter().map(|one| (id(one).clone(), one)).collect()
}

/// Things of the same id, side by side.
fn paired<T: Copy>(before: BTreeMap<StableId, T>, after: BTreeMap<StableId, T>) -> BTreeMap<StableId, [Option<T>; 2]> {
    let mut pairs: BTreeMap<StableId, [Option<T>; 2]> = BTreeMap::new();
    for (side, things) in [before, after].into_iter().enumerate() {
        for (id, thing) in things {
            pairs.entry(id).or_default()[side] = Some(thing);
        }
    }
    pairs
}

fn without_name(light: &Light) -> Light {
    let mut light = light.clone();
    light.name_mut().clear();
    light
}

fn without_glow(material: Material) -> Material {
    Material { emitted_radiance: Vec3::ZERO, emission_texture: None, ..material }
}

fn body<'a>(scene: &'a Scene, instance: &Instance) -> Option<Body<'a>> {
    let mut material = without_glow(scene.materials.get(instance.material)?.clone());
    material.name.clear();
    let references = material.textures_mut();
    let references = references.into_iter().map(|reference| std::mem::take(&mut reference.texture)).collect::<Vec<_>>();
    let uvs = material.textures().map(|reference| reference.uv);
    let pictures = references.iter().zip(uvs).map(|(&texture, uv)| picture(scene, TextureRef { texture, uv }));
    let pictures = pictures.collect::<Option<_>>()?;
    let shape = Shape(scene.meshes.get(instance.mesh)?);
    Some(Body { shape, world_from_local: instance.world_from_local, material, pictures })
}

fn glow<'a>(scene: &'a Scene, instance: &Instance) -> Option<Glow<'a>> {
    let material = scene.materials.get(instance.material)?;
    (material.emitted_radiance != Vec3::ZERO).then(|| Glow {
        radiance: material.emitted_radiance,
        picture: material.emission_texture.and_then(|reference| picture(scene, reference)),
        is_of_both_sides: material.double_sided,
    })
}

fn picture(scene: &Scene, reference: TextureRef) -> Option<Picture<'_>> {
    Some(Picture { texture: scene.textures.get(reference.texture)?, uv: reference.uv })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{PointLight, Scattering, Standard, Texels};
    use std::sync::Arc;

    fn texture(level: u8) -> Texture {
        let texels = Texels::Linear8(Arc::from([[level; 4]]));
        Texture {
            name: "picture".into(),
            width: 1,
            height: 1,
            texels,
            wrap: Default::default(),
            filter: Default::default(),
        }
    }

    /// A lamp, a glowing sign with a picture and a wall, whose texture is the second.
    fn scene() -> Scene {
        let bulb = PointLight {
            id: StableId::new("bulb"),
            name: "bulb".into(),
            position: Vec3::Y,
            intensity: Vec3::ONE,
            radius: 0.0,
            range: None,
        };
        let reference = |texture| Some(TextureRef { texture, uv: UvChannel::Uv0 });
        let sign = Material { emission_texture: reference(0), ..Material::emissive("sign", Vec3::ONE) };
        let wall = Material { base_colour_texture: reference(1), ..Material::diffuse("wall", Vec3::ONE) };
        let instance = |name: &str, material| Instance {
            id: StableId::new(name),
            name: name.into(),
            mesh: 0,
            material,
            world_from_local: Affine3A::IDENTITY,
            lightmap: None,
        };
        Scene {
            meshes: vec![Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], ..Mesh::default() }],
            materials: vec![sign, wall],
            textures: vec![texture(1), texture(2)],
            instances: vec![instance("sign", 0), instance("wall", 1)],
            lights: vec![Light::Point(bulb)],
            ..Scene::default()
        }
    }

    fn after(edit: impl FnOnce(&mut Scene)) -> Change {
        let mut after = scene();
        edit(&mut after);
        Change::between(&scene(), &after)
    }

    fn ids(names: &[&str]) -> BTreeSet<StableId> {
        names.iter().map(|&name| StableId::new(name)).collect()
    }

    #[test]
    fn names_and_orders_are_no_change() {
        let change = after(|scene| {
            scene.instances.reverse();
            scene.textures.insert(0, texture(9));
            for material in &mut scene.materials {
                material.name = "other".into();
                material.textures_mut().into_iter().for_each(|reference| reference.texture += 1);
            }
            scene.meshes[0].name = "other".into();
            scene.lights[0].name_mut().push('!');
            scene.textures[1].name = "other".into();
        });
        assert_eq!(change, Change::default());
        assert!(!change.is_of_surfaces() && !change.is_of_sources());
    }

    #[test]
    fn each_change_is_seen() {
        let of_surfaces = Change { surfaces: true, ..Change::default() };
        let glowing = Change { glowing: ids(&["sign"]), ..Change::default() };
        assert_eq!(after(|scene| scene.instances[1].world_from_local.translation.x = 1.0), of_surfaces);
        assert_eq!(after(|scene| scene.materials[1].base_colour.x = 0.5), of_surfaces);
        assert_eq!(after(|scene| scene.textures[1] = texture(3)), of_surfaces);
        assert_eq!(after(|scene| scene.materials[0].emitted_radiance.x = 2.0), glowing);
        assert_eq!(after(|scene| scene.textures[0] = texture(3)), glowing);
        assert_eq!(
            after(|scene| scene.instances[0].world_from_local.translation.x = 1.0),
            Change { surfaces: true, glowing: ids(&["sign"]), ..Change::default() }
        );
        assert_eq!(
            after(|scene| {
                scene.instances.pop();
            }),
            of_surfaces
        );
        assert_eq!(after(|scene| scene.lights.clear()), Change { lights: ids(&["bulb"]), ..Change::default() });
        let bulb = StableId::new("bulb");
        let of_bulb = Change { lights: ids(&["bulb"]), ..Change::default() };
        assert_eq!(after(|scene| assert!(scene.indirect_only.insert(bulb))), of_bulb);
        assert_eq!(after(|scene| scene.sky_radiance = Vec3::ONE), Change { sky: true, ..Change::default() });
        // A texture that changes its place in the material, with nothing else.
        let standard = |at_roughness: bool| Material {
            scattering: Scattering::Standard(Box::new(Standard {
                metallic_roughness_texture: at_roughness.then_some(TextureRef { texture: 1, uv: UvChannel::Uv0 }),
                clearcoat_texture: (!at_roughness).then_some(TextureRef { texture: 1, uv: UvChannel::Uv0 }),
                ..Standard::default()
            })),
            ..Material::default()
        };
        let [a, b] = [true, false].map(|at| Scene { materials: vec![standard(at), standard(at)], ..scene() });
        assert_eq!(Change::between(&a, &a), Change::default());
        assert!(Change::between(&a, &b).is_of_surfaces());
    }

    #[test]
    fn steady_and_changed_light_together_are_all() {
        let change = Change { glowing: ids(&["sign"]), ..Change::default() };
        let [steady, changed] = [change.by_steady_light(&scene()), change.by_changed_light(&scene())];
        let glows = |scene: &Scene| -> Vec<bool> {
            scene.instances.iter().map(|one| scene.materials[one.material].emitted_radiance != Vec3::ZERO).collect()
        };
        assert_eq!((glows(&steady), steady.lights.len()), (vec![false, false], 1));
        assert_eq!((glows(&changed), changed.lights.len()), (vec![true, false], 0));
    }
}

//! The picture on the screen: a square over the whole view, drawn by the camera itself before it maps tones, so that
//! both sides of the divider go the same way from radiance to the screen.

use crate::bake::Picture;
use bevy::asset::{RenderAssetUsages, uuid_handle};
use bevy::camera::visibility::{NoFrustumCulling, RenderLayers};
use bevy::image::ImageSampler;
use bevy::light::NotShadowCaster;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, CompareFunction, Extent3d, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
    TextureDimension, TextureFormat,
};
use bevy::shader::{Shader, ShaderRef};
use half::f16;

const SHADER: Handle<Shader> = uuid_handle!("5f0c9c5e-3d1a-4d0b-8f0e-2b7c61a94e12");

/// A picture beside what it is compared with.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
pub(super) struct TruthMaterial {
    #[uniform(0)]
    pub(super) divided: Divided,
    #[texture(1)]
    #[sampler(2)]
    pub(super) picture: Handle<Image>,
}

/// Where the picture begins.
#[derive(ShaderType, Clone, Copy, Debug)]
pub(super) struct Divided {
    /// Share of the width.
    pub(super) divider: f32,
}

impl Material for TruthMaterial {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        _key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.vertex.buffers = vec![layout.0.get_layout(&[Mesh::ATTRIBUTE_POSITION.at_shader_location(0)])?];
        descriptor.primitive.cull_mode = None;
        if let Some(depth) = &mut descriptor.depth_stencil {
            depth.depth_compare = Some(CompareFunction::Always);
        }
        Ok(())
    }
}

pub(super) fn plugin(app: &mut App) {
    let shader = Shader::from_wgsl(include_str!("truth.wgsl"), "bevy_kiln/plugin/overlay/truth/truth.wgsl");
    // Where there is no renderer there is nothing to draw with.
    if let Some(mut shaders) = app.world_mut().get_resource_mut::<Assets<Shader>>() {
        // A handle with a number of its own is always valid.
        let _ = shaders.insert(&SHADER, shader);
    }
    app.add_plugins(MaterialPlugin::<TruthMaterial>::default());
}

/// Puts a picture before a camera; the entity is what takes it away again.
pub(super) fn put_up(world: &mut World, camera: Entity, picture: &Picture, divider: f32) -> Entity {
    let image = world.resource_mut::<Assets<Image>>().add(image(picture));
    let divided = Divided { divider };
    let material = world.resource_mut::<Assets<TruthMaterial>>().add(TruthMaterial { divided, picture: image });
    let mut square = Mesh::from(Rectangle::new(1.0, 1.0));
    // What is with the renderer only is not found by rays that look for what the pointer is on.
    square.asset_usage = RenderAssetUsages::RENDER_WORLD;
    let square = world.resource_mut::<Assets<Mesh>>().add(square);
    let layers = world.get::<RenderLayers>(camera).cloned().unwrap_or_default();
    let look = (Mesh3d(square), MeshMaterial3d(material), layers, NoFrustumCulling, NotShadowCaster);
    world.spawn((Name::new("kiln truth"), look)).id()
}

/// Moves the divider of a picture.
pub(super) fn divide(world: &mut World, quad: Entity, divider: f32) {
    let Some(material) = world.get::<MeshMaterial3d<TruthMaterial>>(quad).map(|material| material.0.clone()) else {
        return;
    };
    let mut materials = world.resource_mut::<Assets<TruthMaterial>>();
    if materials.get(&material).is_some_and(|material| material.divided.divider != divider)
        && let Some(mut material) = materials.get_mut(&material)
    {
        material.divided.divider = divider;
    }
}

fn image(picture: &Picture) -> Image {
    let size = Extent3d { width: picture.width, height: picture.height, depth_or_array_layers: 1 };
    let halves = picture.radiance.iter().flat_map(|radiance| radiance.extend(1.0).to_array());
    let halves = halves.map(|value| f16::from_f32(value.min(f16::MAX.to_f32())));
    let bytes = halves.flat_map(f16::to_le_bytes).collect();
    let format = TextureFormat::Rgba16Float;
    let mut image = Image::new(size, TextureDimension::D2, bytes, format, RenderAssetUsages::RENDER_WORLD);
    image.sampler = ImageSampler::linear();
    image
}

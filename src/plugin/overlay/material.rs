//! The material in which an overlay is drawn: unlit, over the surface that it stands for.

use bevy::asset::uuid_handle;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError};
use bevy::shader::{Shader, ShaderRef};

const SHADER: Handle<Shader> = uuid_handle!("0b1e5a0e-6d0c-4b7e-9a44-5a1f0c2f7f31");

/// How much nearer to the camera it is drawn than the surface below, in steps of the depth buffer.
const NEARER: i32 = 64;

/// Texels of a page on an object.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
pub(super) struct OverlayMaterial {
    #[uniform(0)]
    pub(super) place: Place,
    #[texture(1)]
    #[sampler(2)]
    pub(super) texels: Handle<Image>,
}

/// Where the object lies on its page, and what its texels are.
#[derive(ShaderType, Clone, Copy, Debug)]
pub(super) struct Place {
    /// Smallest and largest corner.
    pub(super) uv_rect: Vec4,
    /// 1 for light [cd/m²], 0 for colours.
    pub(super) is_light: u32,
}

impl Material for OverlayMaterial {
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
        _layout: &MeshVertexBufferLayoutRef,
        _key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        // Seen from both sides, since the surface below may be.
        descriptor.primitive.cull_mode = None;
        if let Some(depth) = &mut descriptor.depth_stencil {
            depth.bias.constant = NEARER;
            depth.bias.slope_scale = 1.0;
        }
        Ok(())
    }
}

pub(super) fn plugin(app: &mut App) {
    let shader = Shader::from_wgsl(include_str!("overlay.wgsl"), "bevy_kiln/plugin/overlay/overlay.wgsl");
    // Where there is no renderer there is nothing to draw with.
    if let Some(mut shaders) = app.world_mut().get_resource_mut::<Assets<Shader>>() {
        // A handle with a number of its own is always valid.
        let _ = shaders.insert(&SHADER, shader);
    }
    app.add_plugins(MaterialPlugin::<OverlayMaterial>::default());
}

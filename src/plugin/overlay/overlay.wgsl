// Texels of a bake as they are, by the second UV set: colours that say something, or light as the camera exposes it.

#import bevy_pbr::forward_io::VertexOutput
#import bevy_pbr::mesh_view_bindings::view
#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::tone_mapping
#endif

struct Overlay {
    // Smallest and largest corner of the object's rectangle on its page.
    uv_rect: vec4<f32>,
    // 1 where texels are light.
    is_light: u32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> overlay: Overlay;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var texels: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var texels_sampler: sampler;

@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4<f32> {
#ifdef VERTEX_UVS_B
    let uv = mix(overlay.uv_rect.xy, overlay.uv_rect.zw, in.uv_b);
#else
    let uv = overlay.uv_rect.xy;
#endif
    var colour = vec4(textureSample(texels, texels_sampler, uv).rgb, 1.0);
    if overlay.is_light == 1u {
        colour = vec4(colour.rgb * view.exposure, 1.0);
#ifdef TONEMAP_IN_SHADER
        colour = tone_mapping(colour, view.color_grading);
#endif
    }
    return colour;
}

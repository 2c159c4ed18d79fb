// A picture in radiance over what a camera sees, right of a divider, exposed and tone mapped as what it covers.

#import bevy_pbr::mesh_view_bindings::view
#ifdef TONEMAP_IN_SHADER
#import bevy_core_pipeline::tonemapping::tone_mapping
#endif

struct Divided {
    // Share of the width at which the picture begins.
    divider: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> divided: Divided;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var picture: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var picture_sampler: sampler;

// A square of side 1 around the origin becomes the whole of the screen, nearest of all.
@vertex
fn vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return vec4(position.xy * 2.0, 1.0, 1.0);
}

@fragment
fn fragment(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {
    let at = (place.xy - view.viewport.xy) / view.viewport.zw;
    let radiance = textureSampleLevel(picture, picture_sampler, at, 0.0).rgb;
    let from_divider = (at.x - divided.divider) * view.viewport.z;
    if from_divider < 0.0 {
        discard;
    }
    var colour = vec4(radiance * view.exposure, 1.0);
#ifdef TONEMAP_IN_SHADER
    colour = tone_mapping(colour, view.color_grading);
#endif
    // The divider itself, where it is not at the edge.
    if from_divider < 2.0 && divided.divider > 0.0 {
        colour = vec4(1.0);
    }
    return colour;
}

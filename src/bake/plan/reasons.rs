//! Why an effect is on or off, in words and numbers.

use crate::math::luminance;
use crate::trace::{Census, Effect, Tracer, Transport};
use glam::Vec3;

/// Why an effect is on or off.
pub(super) fn reason(effect: Effect, census: &Census, transport: &Transport, tracer: &Tracer) -> String {
    let called = called(effect, census, transport, tracer);
    let reason = called.clone().unwrap_or_else(|| absent(effect, transport).to_owned());
    if transport.effects.off.has(effect) {
        let price = if called.is_some() { ", so its light is missing" } else { "" };
        format!("forced off{price}; {reason}")
    } else if transport.effects.on.has(effect) && called.is_none() {
        format!("forced on; {reason}")
    } else {
        reason
    }
}

/// Why a scene calls for an effect; `None` if it does not.
fn called(effect: Effect, census: &Census, transport: &Transport, tracer: &Tracer) -> Option<String> {
    if !census.called().has(effect) {
        return None;
    }
    let count = census.count(effect);
    let materials = |what: &str| format!("{count} of {}: {what}", counted(census.materials(), "material", "materials"));
    Some(match effect {
        Effect::AreaLights => area_lights(count, tracer),
        Effect::PointLights => {
            let sized = census.sized_point_lights();
            format!("{}, {sized} with a radius", counted(count, "point or spot light", "point and spot lights"))
        }
        Effect::DirectionalLights => {
            let sized = census.sized_suns();
            format!("{}, {sized} with a disc", counted(count, "directional light", "directional lights"))
        }
        Effect::ConstantSky => format!("radiance {} cd/m²", colour(census.sky_radiance())),
        Effect::EnvironmentMap => {
            let [width, height] = census.environment_size();
            format!("{width} × {height} pixels, chosen by brightness")
        }
        Effect::Interreflection => {
            let end = transport.max_bounces.map_or_else(
                || "no cap on bounces".to_owned(),
                |cap| format!("cut after {cap} bounces, which loses light"),
            );
            format!("{}, {end}", materials("not black"))
        }
        Effect::Textures => materials("not the same all over"),
        Effect::TexturedEmission => materials("glowing by a texture"),
        Effect::NormalMaps => materials("with a normal map"),
        Effect::SpecularReflection => materials("glossy, metal or mirrors"),
        Effect::Clearcoat => materials("with a clear coat"),
        Effect::Refraction => materials("bodies of glass"),
        Effect::ClearPanes => materials("clear panes"),
        Effect::DiffuseTransmission => materials("diffuse light goes through"),
        Effect::CutOuts => materials("with holes cut by a mask"),
        Effect::Transparency => materials("transparent"),
    })
}

/// Why a scene does not call for an effect.
fn absent(effect: Effect, transport: &Transport) -> &'static str {
    match effect {
        Effect::AreaLights => "nothing glows",
        Effect::PointLights => "no point or spot light",
        Effect::DirectionalLights => "no directional light",
        Effect::ConstantSky => "no sky was given",
        Effect::EnvironmentMap => "no picture of the sky was given",
        Effect::Interreflection if transport.max_bounces == Some(0) => "direct light only was asked for",
        Effect::Interreflection => "every surface is black",
        Effect::Textures => "every material is the same all over",
        Effect::TexturedEmission => "nothing glows by a texture",
        Effect::NormalMaps => "no normal map",
        Effect::SpecularReflection => "every material is matte",
        Effect::Clearcoat => "no clear coat",
        Effect::Refraction => "no body of glass",
        Effect::ClearPanes => "no clear pane",
        Effect::DiffuseTransmission => "no material lets diffuse light through",
        Effect::CutOuts => "no mask cuts holes",
        Effect::Transparency => "no material is transparent",
    }
}

fn area_lights(count: u64, tracer: &Tracer) -> String {
    let shapes = counted(count, "glowing triangle or rectangle", "glowing triangles or rectangles");
    match tracer.area_light_flux() {
        Some(flux) => format!("{shapes}, {:.4} lm in all", luminance(flux)),
        None => shapes,
    }
}

fn counted(count: u64, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

fn colour(colour: Vec3) -> String {
    let [r, g, b] = colour.to_array();
    format!("{r}, {g}, {b}")
}

//! `StandardMaterial`, its pictures and the meshes' attributes as the scene gets them.

use super::{app, data, glb};
use bevy::asset::RenderAssetUsages;
use bevy::image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor};
use bevy::math::Affine2;
use bevy::mesh::{MeshVertexAttribute, UvChannel, VertexAttributeValues, VertexFormat};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_kiln::plugin::windowless::open_scene;
use bevy_kiln::plugin::{EmissiveUnit, Extraction, SceneSettings, extract_scene};
use bevy_kiln::scene::{
    Alpha, Filter, Interior, Material, NormalEncoding, NormalMap, Scattering, Standard, Texels, TextureRef,
    UvChannel as Uv, Wrap,
};
use serde_json::json;

/// The scene of one cube with a material.
fn extract(material: impl FnOnce(&mut Assets<Image>) -> StandardMaterial) -> Extraction {
    let mut app = app(&data(""));
    app.insert_resource(GlobalAmbientLight::NONE);
    let world = app.world_mut();
    let material = material(&mut world.resource_mut::<Assets<Image>>());
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(material);
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    world.spawn((Name::new("cube"), Mesh3d(mesh), MeshMaterial3d(material)));
    app.update();
    let settings = SceneSettings { emissive: EmissiveUnit::AsDisplayed { ev100: 0.0 }, ..default() };
    extract_scene(app.world_mut(), &settings)
}

fn one(extraction: &Extraction) -> &Material {
    assert_eq!(extraction.warnings, []);
    assert_eq!(extraction.scene.materials.len(), 1);
    &extraction.scene.materials[0]
}

fn plain(material: StandardMaterial) -> Material {
    one(&extract(|_| material)).clone()
}

fn standard(material: &Material) -> &Standard {
    let Scattering::Standard(standard) = &material.scattering else { panic!("{material:?}") };
    standard
}

fn picture(format: TextureFormat, width: u32, bytes: Vec<u8>) -> Image {
    let size = Extent3d { width, height: 1, depth_or_array_layers: 1 };
    Image::new(size, TextureDimension::D2, bytes, format, RenderAssetUsages::default())
}

#[test]
fn an_untouched_material_is_the_scenes_own_default() {
    let material = plain(StandardMaterial::default());
    assert_eq!(standard(&material), &Standard::default());
    assert_eq!((material.base_colour, material.emitted_radiance), (Vec4::ONE, Vec3::ZERO));
    assert_eq!((material.alpha, material.double_sided), (Alpha::Opaque, false));
}

#[test]
fn every_number_arrives() {
    let material = plain(StandardMaterial {
        base_color: Color::linear_rgba(0.1, 0.2, 0.3, 0.4),
        metallic: 0.25,
        perceptual_roughness: 0.75,
        reflectance: 0.35,
        specular_tint: Color::linear_rgb(0.5, 1.0, 0.0),
        specular_transmission: 0.125,
        diffuse_transmission: 0.375,
        thickness: 0.01,
        ior: 1.25,
        attenuation_color: Color::linear_rgb(0.9, 0.8, 0.7),
        attenuation_distance: 2.0,
        clearcoat: 0.6,
        clearcoat_perceptual_roughness: 0.2,
        emissive: LinearRgba::rgb(1.0, 2.0, 3.0),
        emissive_exposure_weight: 1.0,
        double_sided: true,
        uv_transform: Affine2::from_scale(Vec2::new(2.0, 3.0)),
        ..default()
    });
    let expected = Standard {
        metallic: 0.25,
        perceptual_roughness: 0.75,
        reflectance: 0.35,
        // Bevy squares it together with the reflectance.
        specular_tint: Vec3::new(0.25, 1.0, 0.0),
        specular_transmission: 0.125,
        diffuse_transmission: 0.375,
        interior: Interior::Volume { attenuation_colour: Vec3::new(0.9, 0.8, 0.7), attenuation_distance: 2.0 },
        ior: 1.25,
        clearcoat: 0.6,
        clearcoat_perceptual_roughness: 0.2,
        ..Standard::default()
    };
    assert_eq!(standard(&material), &expected);
    assert_eq!(material.base_colour, Vec4::new(0.1, 0.2, 0.3, 0.4));
    assert!((material.emitted_radiance - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-6, "exposed as the rest is");
    assert!(material.double_sided);
    assert_eq!(material.uv_transform, Affine2::from_scale(Vec2::new(2.0, 3.0)));
}

#[test]
fn alpha_modes_by_what_they_do_to_light() {
    let alpha = |alpha_mode| plain(StandardMaterial { alpha_mode, ..default() }).alpha;
    assert_eq!(alpha(AlphaMode::Opaque), Alpha::Opaque);
    assert_eq!(alpha(AlphaMode::Mask(0.3)), Alpha::Mask { cutoff: 0.3 });
    for mode in [AlphaMode::Blend, AlphaMode::Premultiplied, AlphaMode::AlphaToCoverage] {
        assert_eq!(alpha(mode), Alpha::Blend, "{mode:?}");
    }
    assert_eq!(alpha(AlphaMode::Multiply), Alpha::Multiply);
    assert_eq!(alpha(AlphaMode::Add), Alpha::Add);
    let leaf = extract(|images| StandardMaterial {
        alpha_mode: AlphaMode::AlphaToCoverage,
        base_color_texture: Some(images.add(Image::default())),
        ..default()
    });
    assert_eq!(one(&leaf).alpha, Alpha::Mask { cutoff: 0.5 }, "the shader sharpens its edge");
}

#[test]
fn an_unlit_surface_glows_as_it_is_seen_and_reflects_nothing() {
    let unlit = |alpha_mode| {
        extract(|images| StandardMaterial {
            unlit: true,
            alpha_mode,
            base_color: Color::linear_rgba(2.0, 1.0, 0.5, 0.75),
            base_color_texture: Some(images.add(Image::default())),
            metallic: 1.0,
            ..default()
        })
    };
    let extraction = unlit(AlphaMode::Opaque);
    let material = one(&extraction);
    assert_eq!(material.scattering, Scattering::None);
    // 1.2 · 2^0.
    assert!((material.emitted_radiance - 1.2 * Vec3::new(2.0, 1.0, 0.5)).length() < 1e-6, "{material:?}");
    assert!(material.emission_texture.is_some() && material.base_colour_texture.is_none());
    let extraction = unlit(AlphaMode::Blend);
    let material = one(&extraction);
    assert_eq!(material.base_colour, Vec4::new(0.0, 0.0, 0.0, 0.75));
    assert!(material.emission_texture.is_some() && material.base_colour_texture.is_some());
    let filter = unlit(AlphaMode::Multiply);
    assert_eq!(one(&filter).emitted_radiance, Vec3::ZERO, "it tints what is behind it");
}

#[test]
fn pictures_come_once_and_as_they_are_stored() {
    let extraction = extract(|images| {
        let nearest = ImageSamplerDescriptor {
            address_mode_u: ImageAddressMode::Repeat,
            address_mode_v: ImageAddressMode::MirrorRepeat,
            ..ImageSamplerDescriptor::nearest()
        };
        let mut shared = picture(TextureFormat::Rgba8UnormSrgb, 2, vec![1, 2, 3, 4, 5, 6, 7, 8]);
        shared.sampler = ImageSampler::Descriptor(nearest);
        let shared = images.add(shared);
        let _never_used = images.add(picture(TextureFormat::R8Unorm, 1, vec![0]));
        StandardMaterial {
            base_color_texture: Some(shared.clone()),
            emissive: LinearRgba::WHITE,
            emissive_texture: Some(shared),
            emissive_channel: UvChannel::Uv1,
            metallic_roughness_texture: Some(images.add(picture(TextureFormat::R8Unorm, 2, vec![9, 10]))),
            ..default()
        }
    });
    let material = one(&extraction);
    let textures = &extraction.scene.textures;
    assert_eq!(textures.len(), 2);
    assert_eq!(material.base_colour_texture, Some(TextureRef { texture: 0, uv: Uv::Uv0 }));
    assert_eq!(material.emission_texture, Some(TextureRef { texture: 0, uv: Uv::Uv1 }));
    assert_eq!(standard(material).metallic_roughness_texture, Some(TextureRef { texture: 1, uv: Uv::Uv0 }));
    let Texels::Srgb8(texels) = &textures[0].texels else { panic!() };
    assert_eq!(**texels, [[1, 2, 3, 4], [5, 6, 7, 8]]);
    assert_eq!((textures[0].width, textures[0].height), (2, 1));
    assert_eq!((textures[0].wrap, textures[0].filter), ([Wrap::Repeat, Wrap::Mirror], Filter::Nearest));
    assert_eq!((textures[1].wrap, textures[1].filter), ([Wrap::Clamp; 2], Filter::Linear), "Bevy's default");
    assert_eq!(textures[1].name, "metallic and roughness texture of cube");
}

#[test]
fn normal_maps_say_how_they_are_stored() {
    let map = |format, bytes: Vec<u8>, flip_normal_map_y| {
        let extraction = extract(|images| StandardMaterial {
            normal_map_texture: Some(images.add(picture(format, 1, bytes))),
            flip_normal_map_y,
            ..default()
        });
        let Some(NormalMap { encoding, .. }) = one(&extraction).normal_map else { panic!() };
        encoding
    };
    let three = || vec![128, 128, 255, 255];
    assert_eq!(map(TextureFormat::Rgba8Unorm, three(), false), NormalEncoding::OpenGl);
    assert_eq!(map(TextureFormat::Rgba8Unorm, three(), true), NormalEncoding::DirectX);
    assert_eq!(map(TextureFormat::Rg8Unorm, vec![128, 128], false), NormalEncoding::TwoChannel);
    assert_eq!(map(TextureFormat::Rg8Unorm, vec![128, 128], true), NormalEncoding::TwoChannelDirectX);
    assert_eq!(map(TextureFormat::Bc5RgUnorm, vec![128; 16], false), NormalEncoding::TwoChannel);
}

#[test]
fn compressed_pictures_are_unpacked_at_their_finest() {
    let extraction = extract(|images| {
        // Blocks of one colour, 5:6:5 bits: two of the picture itself, one of its mipmap.
        let colour = |low: u8, high: u8| [low, high, low, high, 0, 0, 0, 0];
        let bytes = [colour(0, 0xf8), colour(0x1f, 0), colour(0xe0, 0x07)].concat();
        let mut compressed = picture(TextureFormat::Bc1RgbaUnormSrgb, 8, bytes);
        compressed.texture_descriptor.mip_level_count = 2;
        StandardMaterial { base_color_texture: Some(images.add(compressed)), ..default() }
    });
    assert!(one(&extraction).base_colour_texture.is_some());
    let texture = &extraction.scene.textures[0];
    let Texels::Srgb8(texels) = &texture.texels else { panic!("{texture:?}") };
    assert_eq!((texture.width, texture.height), (8, 1));
    assert_eq!(**texels, [[[255, 0, 0, 255]; 4], [[0, 0, 255, 255]; 4]].concat());
}

#[test]
fn a_picture_that_cannot_be_read_is_named_once_and_left_out() {
    let extraction = extract(|images| {
        let compressed = images.add(picture(TextureFormat::Etc2Rgba8UnormSrgb, 4, vec![0; 16]));
        let gone = Image { data: None, ..default() };
        StandardMaterial {
            base_color_texture: Some(compressed.clone()),
            emissive_texture: Some(compressed),
            normal_map_texture: Some(images.add(gone)),
            metallic_roughness_texture: Some(images.reserve_handle()),
            ..default()
        }
    });
    let warnings: Vec<String> = extraction.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(warnings.len(), 3, "{warnings:?}");
    for sentence in [
        "the base colour texture of \"cube\" is Etc2Rgba8UnormSrgb, which cannot be read; give it uncompressed, or as BC1 to BC7",
        "the normal map of \"cube\" is in the render world only",
        "the metallic and roughness texture of \"cube\" is not loaded",
    ] {
        assert!(warnings.iter().any(|warning| warning.starts_with(sentence)), "{sentence}: {warnings:?}");
    }
    let material = &extraction.scene.materials[0];
    assert!(extraction.scene.textures.is_empty() && material.base_colour_texture.is_none());
    assert!(material.emission_texture.is_none() && material.normal_map.is_none());
}

#[test]
fn a_mesh_brings_all_that_a_shader_would_see() {
    let mut app = app(&data(""));
    let bytes = MeshVertexAttribute::new("Vertex_Color", 5, VertexFormat::Unorm8x4);
    assert_eq!(bytes.id, Mesh::ATTRIBUTE_COLOR.id);
    let mut mesh = Mesh::from(Rectangle::default()).with_generated_tangents().unwrap();
    mesh.insert_attribute(bytes, VertexAttributeValues::Unorm8x4(vec![[0, 51, 255, 255]; 4]));
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_1, vec![[0.25, 0.5]; 4]);
    let mesh = app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh);
    let material = app.world_mut().resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial::default());
    app.world_mut().spawn((Mesh3d(mesh), MeshMaterial3d(material)));
    app.update();
    let scene = extract_scene(app.world_mut(), &SceneSettings::default()).scene;
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.colours.as_deref(), Some(&[Vec4::new(0.0, 0.2, 1.0, 1.0); 4][..]));
    assert_eq!(mesh.uv1.as_deref(), Some(&[Vec2::new(0.25, 0.5); 4][..]));
    let (uv0, tangents) = (mesh.uv0.as_ref().unwrap(), mesh.tangents.as_ref().unwrap());
    assert!(uv0.contains(&Vec2::ZERO) && uv0.contains(&Vec2::ONE));
    // u grows to the right; v grows down, so that the bitangent of a normal map, which points up, needs a minus.
    assert!(tangents.iter().all(|tangent| (tangent.truncate() - Vec3::X).length() < 1e-5), "{tangents:?}");
    assert!(mesh.normals.as_ref().unwrap().iter().all(|normal| *normal == Vec3::Z));
}

/// A file's own pictures and extensions, through Bevy's loader.
#[test]
fn a_gltf_material_arrives_whole() {
    let folder = temp_dir::TempDir::new().unwrap();
    let mut file = glb::Glb::read(&data("punctual.glb"));
    let mut png = std::io::Cursor::new(Vec::new());
    let pixels = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 128, 255, 51]).unwrap();
    pixels.write_to(&mut png, image::ImageFormat::Png).unwrap();
    let (offset, length) = (file.buffer.len(), png.get_ref().len());
    file.buffer.extend(png.into_inner());
    file.buffer.resize(file.buffer.len().next_multiple_of(4), 0);
    file.json["buffers"][0]["byteLength"] = file.buffer.len().into();
    let views = file.json["bufferViews"].as_array_mut().unwrap();
    views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": length }));
    let view = views.len() - 1;
    file.json["images"] = json!([{ "bufferView": view, "mimeType": "image/png" }]);
    // Once without a say about edges and filters, once with one.
    file.json["samplers"] = json!([{ "magFilter": 9728, "wrapS": 33071, "wrapT": 33648 }]);
    file.json["textures"] = json!([{ "source": 0 }, { "source": 0, "sampler": 0 }]);
    let turned = json!({ "KHR_texture_transform": { "scale": [2.0, 3.0], "offset": [0.5, 0.25] } });
    file.json["materials"][0] = json!({
        "name": "floor",
        "pbrMetallicRoughness": {
            "baseColorFactor": [1.0, 0.5, 0.25, 0.5],
            "baseColorTexture": { "index": 0, "extensions": turned },
            "metallicRoughnessTexture": { "index": 1, "texCoord": 1 },
        },
        "normalTexture": { "index": 1 },
        "emissiveFactor": [1.0, 0.0, 0.5],
        "alphaMode": "MASK",
        "alphaCutoff": 0.25,
        "doubleSided": true,
        "extensions": {
            "KHR_materials_transmission": { "transmissionFactor": 0.5 },
            "KHR_materials_volume": { "thicknessFactor": 0.1, "attenuationDistance": 3.0, "attenuationColor": [1, 0.5, 0] },
            "KHR_materials_ior": { "ior": 1.33 },
            "KHR_materials_clearcoat": { "clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.1 },
            "KHR_materials_emissive_strength": { "emissiveStrength": 4.0 },
        },
    });
    let path = folder.path().join("material.glb");
    file.write(&path);
    let mut app = open_scene(&path).unwrap();
    let settings = SceneSettings { emissive: EmissiveUnit::Nits, ..default() };
    let Extraction { scene, warnings, .. } = extract_scene(app.world_mut(), &settings);
    assert_eq!(warnings, []);
    let material = &scene.materials[0];
    assert_eq!(material.base_colour, Vec4::new(1.0, 0.5, 0.25, 0.5));
    assert_eq!((material.alpha, material.double_sided), (Alpha::Mask { cutoff: 0.25 }, true));
    assert_eq!(material.emitted_radiance, Vec3::new(4.0, 0.0, 2.0));
    assert_eq!(material.uv_transform.transform_point2(Vec2::ONE), Vec2::new(2.5, 3.25));
    let standard = standard(material);
    assert_eq!((standard.metallic, standard.perceptual_roughness), (1.0, 1.0));
    assert_eq!((standard.specular_transmission, standard.ior, standard.clearcoat), (0.5, 1.33, 0.75));
    let attenuation_colour = Vec3::new(1.0, 0.5, 0.0);
    assert_eq!(standard.interior, Interior::Volume { attenuation_colour, attenuation_distance: 3.0 });
    let texture = |reference: Option<TextureRef>| &scene.textures[reference.unwrap().texture];
    let colour = texture(material.base_colour_texture);
    let Texels::Srgb8(texels) = &colour.texels else { panic!("{colour:?}") };
    assert_eq!(**texels, [[255, 0, 0, 255], [0, 128, 255, 51]]);
    assert_eq!((colour.wrap, colour.filter), ([Wrap::Repeat; 2], Filter::Linear), "glTF's defaults");
    let metal = texture(standard.metallic_roughness_texture);
    assert!(matches!(metal.texels, Texels::Linear8(_)), "{metal:?}");
    assert_eq!((metal.wrap, metal.filter), ([Wrap::Clamp, Wrap::Mirror], Filter::Nearest));
    assert_eq!(standard.metallic_roughness_texture.unwrap().uv, Uv::Uv1);
    assert_eq!(material.normal_map.unwrap().encoding, NormalEncoding::OpenGl);
    assert!(scene.meshes[0].tangents.is_some(), "the loader makes them for a normal map");
}

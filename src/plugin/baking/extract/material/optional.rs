//! Fields that a `StandardMaterial` has under some of Bevy's features only, read by their names: whether they are
//! there is up to the game, and this crate must not switch them on for it.

use crate::scene;
use bevy::mesh::UvChannel;
use bevy::prelude::*;
use bevy::reflect::structs::Struct;

/// The picture in a field, if there is such a field with a picture in it.
pub(super) fn image<'m>(material: &'m dyn Struct, field: &str) -> Option<&'m Handle<Image>> {
    material.field(field)?.try_downcast_ref::<Option<Handle<Image>>>()?.as_ref()
}

/// The coordinates that a field asks for.
pub(super) fn uv(material: &dyn Struct, field: &str) -> scene::UvChannel {
    let channel = material.field(field).and_then(|field| field.try_downcast_ref::<UvChannel>());
    channel.map_or(scene::UvChannel::Uv0, self::channel)
}

/// Bevy's coordinates in the scene's words.
pub(super) fn channel(channel: &UvChannel) -> scene::UvChannel {
    match channel {
        UvChannel::Uv0 => scene::UvChannel::Uv0,
        UvChannel::Uv1 => scene::UvChannel::Uv1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As a material looks in a game that has the feature.
    #[derive(Reflect, Default)]
    struct WithFeature {
        clearcoat_channel: UvChannel,
        clearcoat_texture: Option<Handle<Image>>,
        clearcoat_normal_texture: Option<Handle<Image>>,
    }

    #[test]
    fn a_field_is_found_by_name_where_it_is_there() {
        let some = Some(Handle::default());
        let material = WithFeature { clearcoat_channel: UvChannel::Uv1, clearcoat_texture: some, ..default() };
        assert!(image(&material, "clearcoat_texture").is_some());
        assert!(image(&material, "clearcoat_normal_texture").is_none());
        assert!(image(&material, "anisotropy_texture").is_none());
        assert!(image(&material, "clearcoat_channel").is_none(), "another type is no picture");
        assert_eq!(uv(&material, "clearcoat_channel"), scene::UvChannel::Uv1);
        assert_eq!(uv(&material, "anisotropy_channel"), scene::UvChannel::Uv0);
    }

    #[test]
    fn a_material_can_be_asked_by_name() {
        let texture = Some(Handle::default());
        let material = StandardMaterial { base_color_texture: texture, ..default() };
        assert!(image(&material, "base_color_texture").is_some() && image(&material, "depth_map").is_none());
    }
}

//! All that a shipped game needs: names, loading a baked folder, putting it on entities. Knows no tracer.

mod apply;
mod arrivals;
mod attach;
mod attribute;
mod extras;
mod filtering;
mod find;
mod fingerprint;
mod folder;
mod light_baking;
mod material;
mod mute;
mod out_of_date;
mod relay;
mod reload;
mod stable_path;
mod volume;
mod wear;

pub use apply::{AppliedLightmaps, BakedLightmaps};
pub use filtering::LightmapFiltering;
pub use folder::{BakedFolder, BakedFolderError};
pub use light_baking::LightBaking;
pub use material::BakedMaterialApp;
pub use stable_path::{KilnId, stable_id};
pub use volume::BakedVolume;

#[cfg(feature = "bake")]
pub(crate) use attach::{Shown, attach, attached, detach};
#[cfg(feature = "bake")]
pub(crate) use attribute::numbers;
#[cfg(feature = "bake")]
pub(crate) use extras::{ExtrasFault, KilnExtras, read_extras};
#[cfg(feature = "bake")]
pub(crate) use filtering::FilteredBy;
#[cfg(feature = "bake")]
pub(crate) use fingerprint::fingerprint;
#[cfg(feature = "bake")]
pub(crate) use folder::lightmap_sampler;
#[cfg(feature = "bake")]
pub(crate) use material::{FoundMaterial, find_described};
#[cfg(feature = "bake")]
pub(crate) use mute::{MutedLight, mute_light, unmute_light};
#[cfg(feature = "bake")]
pub(super) use stable_path::StableIds;
#[cfg(feature = "bake")]
pub(crate) use volume::{ShownVolume, despawn_volumes, spawn_volume};
#[cfg(feature = "bake")]
pub(crate) use wear::{SharedLayout, own_mesh};

use super::KilnSystems;
use bevy::asset::AssetApp;
use bevy::camera::visibility::VisibilitySystems;
use bevy::prelude::*;

pub(super) fn plugin(app: &mut App) {
    app.init_asset::<BakedFolder>()
        .register_asset_loader(folder::BakedFolderLoader)
        .register_type::<KilnId>()
        .register_type::<LightBaking>()
        .register_type::<BakedLightmaps>()
        .register_type::<BakedVolume>()
        .register_type::<LightmapFiltering>()
        .init_resource::<LightmapFiltering>()
        .add_observer(apply::take_off_with_component)
        .configure_sets(
            PostUpdate,
            KilnSystems::Marks.before(TransformSystems::Propagate).before(VisibilitySystems::VisibilityPropagate),
        )
        .add_systems(PostUpdate, extras::read_extras.in_set(KilnSystems::Marks))
        .add_systems(
            PreUpdate,
            (
                attach::attach_pending,
                wear::forget_copies_of_changed,
                filtering::follow_filtering.run_if(resource_exists_and_changed::<LightmapFiltering>),
                reload::heed_reloads,
                arrivals::heed_arrivals,
                apply::apply_baked_lightmaps,
            )
                .chain()
                .in_set(KilnSystems::Display),
        );
}

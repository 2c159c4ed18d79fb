//! A bake that is repeated while the game runs: folders and textures that Bevy has read again, as its watcher does when
//! files change.

use super::{AppliedLightmaps, BakedFolder, BakedLightmaps};
use bevy::prelude::*;
use std::collections::HashSet;

/// Puts folders on again that were read anew, or pages of which were: a bake that was repeated while the game runs.
pub(super) fn heed_reloads(
    mut folders: MessageReader<AssetEvent<BakedFolder>>,
    mut images: MessageReader<AssetEvent<Image>>,
    loaded: Option<Res<Assets<BakedFolder>>>,
    mut roots: Query<(&BakedLightmaps, &mut AppliedLightmaps)>,
) {
    let modified_folders: HashSet<AssetId<BakedFolder>> = folders.read().filter_map(modified).collect();
    let modified_images: HashSet<AssetId<Image>> = images.read().filter_map(modified).collect();
    if modified_folders.is_empty() && modified_images.is_empty() {
        return;
    }
    for (baked, mut applied) in &mut roots {
        let folder = loaded.as_ref().and_then(|folders| folders.get(&baked.0));
        let pages = folder.into_iter().flat_map(|folder| folder.pages.iter().chain(&folder.volumes));
        let is_modified = modified_folders.contains(&baked.0.id())
            || pages.into_iter().any(|page| modified_images.contains(&page.id()));
        if is_modified && applied.is_of(baked.0.id()) {
            applied.put_on_again();
        }
    }
}

fn modified<A: Asset>(event: &AssetEvent<A>) -> Option<AssetId<A>> {
    match event {
        AssetEvent::Modified { id } => Some(*id),
        _ => None,
    }
}

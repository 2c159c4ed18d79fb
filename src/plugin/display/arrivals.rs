//! When there is reason to look for what a folder is about: after things have come into the world, or have become such
//! as a folder may mean. In between nothing is looked for, since a folder may hold what a game never spawns.

use super::{AppliedLightmaps, KilnId, LightBaking};
use bevy::light::RectLight;
use bevy::prelude::*;

/// What makes an entity one that a folder may mean: a mesh or a light, a name, a place in a file.
type Arrived = Or<(
    Or<(Changed<Mesh3d>, Added<RectLight>, Added<PointLight>, Added<SpotLight>, Added<DirectionalLight>)>,
    Or<(Changed<Name>, Changed<KilnId>, Changed<ChildOf>, Changed<LightBaking>)>,
)>;

/// Has folders looked through again if anything has come.
pub(super) fn heed_arrivals(
    arrived: Query<(), Arrived>,
    mut meshes: MessageReader<AssetEvent<Mesh>>,
    mut materials: MessageReader<AssetEvent<StandardMaterial>>,
    mut freed: RemovedComponents<LightBaking>,
    mut roots: Query<&mut AppliedLightmaps>,
) {
    // Counted, so that all are read: what was not would be news in the next frame.
    let meshes = meshes.read().filter(|event| is_new(event)).count();
    let materials = materials.read().filter(|event| is_new(event)).count();
    let freed = freed.read().count();
    if meshes + materials + freed > 0 || !arrived.is_empty() {
        for mut applied in &mut roots {
            applied.look_again();
        }
    }
}

fn is_new<A: Asset>(event: &AssetEvent<A>) -> bool {
    matches!(event, AssetEvent::Added { .. })
}

//! A folder whose manifest has come and whose textures have not: nothing of it is shown, so that no light goes off.

use super::shipping::{bake, loaded, room, write};
use super::*;
use bevy::asset::io::{
    AssetReader, AssetReaderError, AssetSourceBuilder, AssetSourceId, PathStream, Reader, VecReader,
};
use bevy::light::PointLight;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::Poll;
use temp_dir::TempDir;

/// Files of which the textures are kept back for a while.
#[derive(Clone)]
struct LateTextures {
    folder: PathBuf,
    are_kept_back: Arc<AtomicBool>,
}

impl AssetReader for LateTextures {
    async fn read<'a>(&'a self, path: &'a Path) -> Result<impl Reader + 'a, AssetReaderError> {
        let is_texture = path.extension().is_some_and(|extension| extension == "ktx2");
        std::future::poll_fn(|context| {
            if !is_texture || !self.are_kept_back.load(Ordering::Relaxed) {
                return Poll::Ready(());
            }
            context.waker().wake_by_ref();
            Poll::Pending
        })
        .await;
        let bytes = std::fs::read(self.folder.join(path)).map_err(AssetReaderError::from)?;
        Ok(VecReader::new(bytes))
    }

    async fn read_meta<'a>(&'a self, path: &'a Path) -> Result<impl Reader + 'a, AssetReaderError> {
        Err::<VecReader, _>(AssetReaderError::NotFound(path.to_owned()))
    }

    async fn read_directory<'a>(&'a self, path: &'a Path) -> Result<Box<PathStream>, AssetReaderError> {
        Err::<Box<PathStream>, _>(AssetReaderError::NotFound(path.to_owned()))
    }

    async fn is_directory<'a>(&'a self, path: &'a Path) -> Result<bool, AssetReaderError> {
        Ok(self.folder.join(path).is_dir())
    }
}

#[test]
fn lights_shine_until_the_textures_are_there() {
    let folder = TempDir::new().unwrap();
    write(&folder, &room());
    bake(&folder, &["--density", "4"]);
    let files = LateTextures { folder: folder.path().to_owned(), are_kept_back: Arc::new(AtomicBool::new(true)) };
    let are_kept_back = files.are_kept_back.clone();
    let mut game = App::new();
    game.register_asset_source(AssetSourceId::Default, AssetSourceBuilder::new(move || Box::new(files.clone())));
    game.add_plugins(WindowlessPlugins { asset_folder: folder.path().to_owned() }).add_plugins(KilnPlugin);
    game.finish();
    game.cleanup();
    let scene = loaded(&mut game);
    let baked: Handle<BakedFolder> = game.world().resource::<AssetServer>().load("baked/kiln.ron");
    game.world_mut().spawn((scene, BakedLightmaps(baked.clone())));
    run_until(&mut game, "the scene", |world| count::<PointLight>(world) == 1);
    run_until(&mut game, "the manifest", |world| world.resource::<AssetServer>().is_loaded(&baked));
    for _ in 0..5 {
        game.update();
    }
    let power = |world: &mut World| world.query::<&PointLight>().single(world).unwrap().intensity;
    assert!(power(game.world_mut()) > 0.0, "the room would be dark");
    assert_eq!(count::<Lightmap>(game.world_mut()), 0);
    are_kept_back.store(false, Ordering::Relaxed);
    run_until(&mut game, "the lightmap", |world| count::<Lightmap>(world) == 1);
    assert_eq!((power(game.world_mut()), texels(game.world_mut()).len()), (0.0, 1));
}

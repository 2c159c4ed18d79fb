//! Irradiance volumes beside lightmaps: when they come, where they are, and that they go again.

use super::*;
use bevy::image::ImageSampler;
use bevy::light::{IrradianceVolume, LightProbe};
use temp_dir::TempDir;

/// The boxes of the volumes in the world: centre, size and probes along each axis.
fn boxes(world: &mut World) -> Vec<(Vec3, Vec3, UVec3)> {
    let mut volumes = world.query::<(&IrradianceVolume, &Transform, &LightProbe, &BakedVolume)>();
    let found: Vec<(IrradianceVolume, Transform)> =
        volumes.iter(world).map(|(volume, transform, ..)| (volume.clone(), *transform)).collect();
    let images = world.resource::<Assets<Image>>();
    let of = |(volume, transform): (IrradianceVolume, Transform)| {
        assert!(volume.intensity == 1.0 && !volume.affects_lightmapped_meshes);
        let image = images.get(&volume.voxels).expect("its texture");
        let ImageSampler::Descriptor(sampler) = &image.sampler else { panic!("the game's default sampler") };
        assert_eq!(sampler.mag_filter, bevy::image::ImageFilterMode::Linear);
        assert!(image.data.as_ref().unwrap().iter().any(|&byte| byte != 0), "black");
        let size = image.texture_descriptor.size;
        let probes = UVec3::new(size.width, size.height / 2, size.depth_or_array_layers / 3);
        (transform.translation, transform.scale, probes)
    };
    found.into_iter().map(of).collect()
}

/// The Cornell box, all of which receives, and a ball that moves.
fn with_mover() -> App {
    let mut app = cornell(&data(""));
    let mut roots = app.world_mut().query_filtered::<Entity, With<WorldAssetRoot>>();
    let root = roots.single(app.world()).unwrap();
    app.world_mut().entity_mut(root).insert(LightmapReceiver::default());
    app.world_mut()
        .run_system_once(|mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>| {
            let ball = meshes.add(Sphere::new(0.3));
            let look = MeshMaterial3d(Handle::<StandardMaterial>::default());
            commands.spawn((Name::new("ball"), Mesh3d(ball), look, Transform::from_xyz(1.5, 3.0, 1.5)));
        })
        .unwrap();
    app.update();
    app
}

#[test]
fn volumes_come_where_something_moves_and_go_with_the_lightmaps() {
    let mut app = with_mover();
    app.world_mut().trigger(small());
    let done = run_until_baked(&mut app, 1);
    let found = boxes(app.world_mut());
    assert_eq!((found.len(), done.volumes.len()), (1, 1), "{found:?}");
    let (centre, size, probes) = found[0];
    assert!((size - Vec3::new(5.56, 5.488, 5.592)).length() < 1e-3 && (centre - 0.5 * size).length() < 1e-3);
    assert_eq!(probes, done.volumes[0].resolution);

    app.world_mut().trigger(BakeLightmaps { volumes: BakeVolumes::Never, ..small() });
    run_until_baked(&mut app, 2);
    assert_eq!(boxes(app.world_mut()), []);
    app.world_mut().trigger(small());
    run_until_baked(&mut app, 3);
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    assert_eq!(boxes(app.world_mut()), []);
}

#[test]
fn where_nothing_moves_they_come_when_asked_for() {
    let mut app = cornell(&data(""));
    app.world_mut().trigger(small());
    assert!(run_until_baked(&mut app, 1).volumes.is_empty());
    assert_eq!(boxes(app.world_mut()), []);
    app.world_mut().trigger(BakeLightmaps { volumes: BakeVolumes::Always, ..small() });
    assert_eq!(run_until_baked(&mut app, 2).volumes.len(), 1);
    assert_eq!(boxes(app.world_mut()).len(), 1);
}

#[test]
fn boxes_are_placed_by_component() {
    let mut app = cornell(&data(""));
    for (name, scale) in [("whole", 4.0), ("detail", 1.0)] {
        let place = Transform::from_xyz(2.5, 4.0, 2.5).with_scale(Vec3::splat(scale));
        app.world_mut().spawn((Name::new(name), ProbeVolume { spacing: Some(0.5) }, place));
    }
    app.update();
    app.world_mut().trigger(small());
    let done = run_until_baked(&mut app, 1);
    let of =
        |index: usize| (done.volumes[index].id.as_str(), done.volumes[index].resolution, done.volumes[index].falloff);
    assert_eq!([of(0), of(1)], [("detail", UVec3::splat(2), 0.0), ("whole", UVec3::splat(8), 1000.0)]);
    assert_eq!(boxes(app.world_mut()).len(), 2);
}

#[test]
fn a_folder_brings_its_volumes_along() {
    let mut app = with_mover();
    app.world_mut().trigger(small());
    let done = run_until_baked(&mut app, 1);
    app.world_mut().trigger(ClearLightmaps);
    app.update();

    let folder = TempDir::new().unwrap();
    done.save(folder.path()).unwrap();
    let mut roots = app.world_mut().query_filtered::<Entity, With<WorldAssetRoot>>();
    let root = roots.single(app.world()).unwrap();
    let baked: Handle<BakedFolder> = app.world().resource::<AssetServer>().load(folder.path().join("kiln.ron"));
    app.world_mut().entity_mut(root).insert(BakedLightmaps(baked.clone()));
    run_until(&mut app, "the folder", |world| world.resource::<AssetServer>().is_loaded_with_dependencies(&baked));
    app.update();
    app.update();
    let found = boxes(app.world_mut());
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].2, done.volumes[0].resolution);
    app.world_mut().entity_mut(root).remove::<BakedLightmaps>();
    app.update();
    assert_eq!(boxes(app.world_mut()), []);
}

/// What a light is to real time decides whether its direct light is in the volumes.
#[test]
fn lights_that_are_off_in_real_time_are_noted() {
    let mut app = lit_floor();
    let lamp = |mode: LightBaking| (PointLight::default(), mode, Transform::from_xyz(0.0, 1.0, 0.0));
    for (name, mode) in [
        ("baked", LightBaking::Baked),
        ("mixed", LightBaking::MixedDirect),
        ("indirect", LightBaking::MixedIndirect),
        ("real time", LightBaking::RealTime),
    ] {
        app.world_mut().spawn((Name::new(name), lamp(mode)));
    }
    app.update();
    let scene = extract_scene(app.world_mut(), &SceneSettings::default()).scene;
    let ids = |set: &std::collections::BTreeSet<bevy_kiln::artefact::StableId>| {
        set.iter().map(|id| id.as_str().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(ids(&scene.off_in_real_time), ["baked"]);
    assert_eq!(ids(&scene.indirect_only), ["indirect"]);
    assert!(scene.lights.iter().all(|light| light.id().as_str() != "real time"));
}

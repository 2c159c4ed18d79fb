//! How much of each light a bake takes, and what is left of it in real time, before, after and again.

use super::*;

const MODES: [LightBaking; 4] =
    [LightBaking::Baked, LightBaking::MixedDirect, LightBaking::MixedIndirect, LightBaking::RealTime];

/// A world without any light but those that a test spawns.
fn dark(lights: impl FnOnce(&mut World)) -> App {
    let mut app = app(&data(""));
    app.insert_resource(GlobalAmbientLight::NONE);
    lights(app.world_mut());
    app.update();
    app
}

/// Which lights the baker gets, and those of them whose direct light it is to leave out.
fn extracted(app: &mut App) -> (Vec<String>, Vec<String>) {
    let Extraction { scene, warnings, .. } = extract_scene(app.world_mut(), &SceneSettings::default());
    assert_eq!(warnings, []);
    let mut lights: Vec<String> = scene.lights.iter().map(|light| light.id().as_str().to_owned()).collect();
    lights.sort();
    (lights, scene.indirect_only.iter().map(|id| id.as_str().to_owned()).collect())
}

/// Power or illuminance, and whether what has a lightmap is lit. A rectangular light always lights everything.
fn of(world: &World, light: Entity) -> (f32, bool) {
    let light = world.entity(light);
    let rect = light.get::<RectLight>().map(|light| (light.intensity, true));
    let point = light.get::<PointLight>().map(|light| (light.intensity, light.affects_lightmapped_mesh_diffuse));
    let spot = light.get::<SpotLight>().map(|light| (light.intensity, light.affects_lightmapped_mesh_diffuse));
    let sun = light.get::<DirectionalLight>().map(|l| (l.illuminance, l.affects_lightmapped_mesh_diffuse));
    rect.or(point).or(spot).or(sun).unwrap()
}

fn lamp(app: &mut App) -> Entity {
    let world = app.world_mut();
    world.query_filtered::<Entity, With<RectLight>>().single(world).unwrap()
}

/// The texels of the only lightmap there is, of an alone floor: nothing but the direct light of the lamp can be in it.
fn is_lit(app: &mut App) -> bool {
    let shown = texels(app.world_mut());
    assert_eq!(shown.len(), 1);
    // Alpha is every fourth half float.
    shown["floor"].chunks(8).any(|texel| texel[..6].iter().any(|&byte| byte != 0))
}

#[test]
fn the_baker_gets_what_each_mode_says() {
    let mut app = dark(|world| {
        for mode in MODES {
            world.spawn((Name::new(format!("{mode:?}")), PointLight::default(), mode));
        }
        world.spawn((Name::new("unmarked"), SpotLight::default()));
    });
    let (lights, indirect_only) = extracted(&mut app);
    assert_eq!(lights, ["Baked", "MixedDirect", "MixedIndirect", "unmarked"]);
    assert_eq!(indirect_only, ["MixedIndirect"]);
}

#[test]
fn the_nearest_mode_above_a_light_holds() {
    let mut app = dark(|world| {
        let level = world.spawn((Name::new("level"), Transform::default(), LightBaking::RealTime)).id();
        let room = world.spawn((Name::new("room"), Transform::default(), ChildOf(level))).id();
        let lights = (Name::new("torch"), PointLight::default(), ChildOf(room));
        world.spawn(lights);
        let stage = world.spawn((Name::new("stage"), Transform::default(), LightBaking::MixedIndirect)).id();
        world.entity_mut(stage).insert(ChildOf(level));
        world.spawn((Name::new("spot"), SpotLight::default(), ChildOf(stage)));
        world.spawn((Name::new("sun"), DirectionalLight::default(), LightBaking::Baked, ChildOf(stage)));
    });
    let (lights, indirect_only) = extracted(&mut app);
    assert_eq!(lights, ["level/stage/spot", "level/stage/sun"]);
    assert_eq!(indirect_only, ["level/stage/spot"]);
}

/// Every kind of light in every mode, after a bake and after its end.
#[test]
fn each_mode_leaves_what_it_should_in_real_time_and_clearing_gives_all_back() {
    let mut app = lit_floor();
    let world = app.world_mut();
    let mut lights = Vec::new();
    for mode in MODES {
        let place = Transform::from_xyz(0.0, 1.0, 0.0);
        let name = |kind: &str| Name::new(format!("{mode:?} {kind}"));
        lights.push((mode, true, world.spawn((name("rect"), RectLight::default(), mode, place)).id()));
        lights.push((mode, false, world.spawn((name("point"), PointLight::default(), mode, place)).id()));
        lights.push((mode, false, world.spawn((name("spot"), SpotLight::default(), mode, place)).id()));
        lights.push((mode, false, world.spawn((name("sun"), DirectionalLight::default(), mode, place)).id()));
    }
    let before: Vec<(f32, bool)> = lights.iter().map(|&(_, _, light)| of(world, light)).collect();
    assert!(before.iter().all(|&(power, lights_lightmapped)| power > 0.0 && lights_lightmapped));
    app.world_mut().trigger(small());
    let baked = run_until_baked(&mut app, 1);
    // The lamp above the floor, and the four kinds in two modes.
    assert_eq!(baked.lightmap.baked_lights.len(), 9, "{:?}", baked.lightmap.baked_lights);
    for (&(mode, is_rect, light), &(power, _)) in lights.iter().zip(&before) {
        let expected = match mode {
            LightBaking::Baked if is_rect => (0.0, true),
            LightBaking::Baked => (0.0, false),
            LightBaking::MixedDirect if is_rect => (0.0, true),
            LightBaking::MixedDirect => (power, false),
            LightBaking::MixedIndirect | LightBaking::RealTime => (power, true),
        };
        assert_eq!(of(app.world(), light), expected, "{:?}", app.world().get::<Name>(light));
    }
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    let after: Vec<(f32, bool)> = lights.iter().map(|&(_, _, light)| of(app.world(), light)).collect();
    assert_eq!(after, before);
}

/// The next bake has the last word, whatever the one before has turned down.
#[test]
fn a_mode_that_changes_holds_from_the_next_bake_on() {
    let mut app = lit_floor();
    app.insert_resource(GlobalAmbientLight::NONE);
    let lamp = lamp(&mut app);
    let power = of(app.world(), lamp).0;
    let steps = [
        (LightBaking::Baked, true, 0.0),
        (LightBaking::MixedIndirect, false, power),
        (LightBaking::MixedDirect, true, 0.0),
        (LightBaking::Baked, true, 0.0),
    ];
    for (count, (mode, is_in_lightmap, left)) in steps.into_iter().enumerate() {
        app.world_mut().entity_mut(lamp).insert(mode);
        app.world_mut().trigger(small());
        let baked = run_until_baked(&mut app, count + 1);
        assert_eq!(is_lit(&mut app), is_in_lightmap, "{mode:?}");
        assert_eq!(baked.lightmap.baked_lights.len(), usize::from(is_in_lightmap), "{mode:?}");
        assert_eq!(of(app.world(), lamp).0, left, "{mode:?}");
    }
    app.world_mut().trigger(ClearLightmaps);
    app.update();
    assert_eq!(of(app.world(), lamp), (power, true));
}

#[test]
fn baked_and_mixed_direct_differ_in_real_time_only() {
    let mut app = lit_floor();
    let lamp = lamp(&mut app);
    let mut bake = |mode: LightBaking, count: usize| {
        app.world_mut().entity_mut(lamp).insert(mode);
        app.world_mut().trigger(small());
        run_until_baked(&mut app, count);
        texels(app.world_mut())
    };
    assert_eq!(bake(LightBaking::Baked, 1), bake(LightBaking::MixedDirect, 2));
}

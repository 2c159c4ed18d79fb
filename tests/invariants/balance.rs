//! In a closed room all light that is given off is absorbed: Σ (1 − ρ) E A over all texels is the lamps' flux. Counted
//! here anew from the texels, and held against the report's own balance.

use crate::Fault;
use crate::chance::{Search, finds, holds};
use crate::judge::{Mean, settle};
use crate::sketch::{INDOORS, Kind, Shell, Sketch, sketches};
use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Lightmap, bake_lightmap};
use bevy_kiln::math::Welford;
use bevy_kiln::scene::{Instance, Scene};
use bevy_kiln::trace::Transport;
use std::f64::consts::PI;

/// Bakes under other seeds, whose spread is the balance's error: the report has none.
const SEEDS: u64 = 4;

fn bake(scene: &Scene, samples: u32, transport: Transport) -> Lightmap {
    let settings = BakeSettings { transport, goal: Goal::Samples(samples), density: 1.5, ..BakeSettings::default() };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// A clamp that nothing reaches: it spares the report's own balance, which takes longer than such a bake.
const UNREACHED: Option<f32> = Some(1e30);

/// Area of a rectangle in the world [m²].
fn area(scene: &Scene, instance: &Instance) -> f64 {
    let corners = &scene.meshes[instance.mesh].positions;
    let [a, b, d] = [0, 1, 3].map(|corner| instance.world_from_local.transform_point3(corners[corner]).as_dvec3());
    (b - a).cross(d - a).length()
}

/// Green light that the fronts of all rectangles absorb [lm].
fn absorbed(scene: &Scene, lightmap: &Lightmap) -> Mean {
    let of = |instance: &Instance| {
        let place = lightmap.placements.iter().find(|place| place.id == instance.id).unwrap();
        let page = &lightmap.pages[place.page as usize];
        let texel = |uv: [f32; 2]| [(uv[0] * page.width as f32) as usize, (uv[1] * page.height as f32) as usize];
        let ([left, top], [right, bottom]) = (texel(place.uv_min), texel(place.uv_max));
        let texels = (top..bottom).flat_map(|y| (left..right).map(move |x| y * page.width as usize + x));
        let values: Vec<[f64; 2]> = texels
            .map(|index| [page.raw[index].y, page.stderr[index].y].map(|light| f64::from(light * page.coverage[index])))
            .collect();
        let count = values.len() as f64;
        let value = values.iter().map(|[value, _]| value).sum::<f64>() / count;
        let error = values.iter().map(|[_, error]| error * error).sum::<f64>().sqrt() / count;
        let albedo = f64::from(scene.materials[instance.material].base_colour.y);
        Mean { value, error }.times(PI * (1.0 - albedo) * area(scene, instance))
    };
    scene.instances.iter().map(of).reduce(Mean::plus).unwrap()
}

fn balance(sketch: &Sketch, fault: Fault) -> Result<(), String> {
    let scene = sketch.scene();
    let emitted: f64 = sketch.lamps.iter().map(|lamp| lamp.flux()).sum();
    let emitted = if fault == Fault::OnePercent { 1.01 * emitted } else { emitted };
    let max_bounces = (fault == Fault::BounceMissing).then_some(1);
    settle(0.008, |samples| {
        let lightmap = bake(&scene, samples / 8, Transport { max_bounces, clamp: UNREACHED, ..Transport::default() });
        [absorbed(&scene, &lightmap), Mean { value: emitted, error: 0.0 }]
    })
}

/// The report's own balance is 1, by the spread over seeds.
fn reported(sketch: &Sketch) -> Result<(), String> {
    let scene = sketch.scene();
    settle(0.02, |samples| {
        let of = |seed| bake(&scene, samples / 8, Transport { seed, ..Transport::default() }).report.energy_balance;
        let balances: Option<Welford> =
            (0..SEEDS).map(of).collect::<Option<Vec<f64>>>().map(|all| all.into_iter().collect());
        // A closed room without a balance is a fault too.
        let Some(balances) = balances else {
            return [Mean { value: f64::NAN, error: 0.0 }; 2];
        };
        // Student's t with three degrees of freedom is wider than the normal law by this at four standard errors.
        let error = 2.0 * balances.standard_error();
        [Mean { value: balances.mean(), error }, Mean { value: 1.0, error: 0.0 }]
    })
}

/// Lamps without a back: what they absorb of the room's light lies on no texel of theirs.
const WITHOUT_BACK: &[Kind] = &[Kind::Panel, Kind::Spark, Kind::Bulb];

#[test]
fn what_is_given_off_is_absorbed() {
    holds(6, sketches(&[Shell::Closed], WITHOUT_BACK), |sketch| balance(sketch, Fault::None));
}

#[test]
fn the_report_has_the_same_balance() {
    holds(3, sketches(&[Shell::Closed], INDOORS), reported);
}

#[test]
fn a_missing_bounce_is_found() {
    finds(Search { cases: 4, shrinks: 0 }, sketches(&[Shell::Closed], WITHOUT_BACK), |sketch| {
        balance(sketch, Fault::BounceMissing)
    });
}

#[test]
fn one_percent_more_light_is_found() {
    finds(Search { cases: 1, shrinks: 0 }, sketches(&[Shell::Closed], WITHOUT_BACK), |sketch| {
        balance(sketch, Fault::OnePercent)
    });
}

//! One path's relative variance (variance over the square of the mean) in the empty Cornell box, half a millimetre
//! under its lamp and in the middle of its floor: of ours, and of the textbook's area light.
//!
//! Ours is a meter of one path for each of its replicates, which are scrambled independently: their spread is that of
//! single paths, and nothing of it is hidden by the evenness of a sequence. The naive one is a quadrature of its
//! second moment, since a sample of it would not find its tail.

use crate::meter::measure;
use crate::scenes::{Stage, facing};
use crate::sweep::Effort;
use bevy_kiln::bake::REPLICATES;
use bevy_kiln::math::{Welford, corner_parallel_rectangle};
use bevy_kiln::scene::{Material, Scene};
use bevy_kiln::trace::Transport;
use glam::{Affine3A, DVec3, Vec3};
use std::f64::consts::PI;

/// Meters, of as many paths as there are replicates.
const METERS: u32 = 8192;

/// Steps of the quadrature on each axis.
const STEPS: u32 = 2000;

/// Lower corner and size of the lamp [m].
const LAMP: (DVec3, DVec3) = (DVec3::new(2.13, 5.48, 2.27), DVec3::new(1.3, 0.0, 1.05));

/// Measures and prints.
pub fn print(effort: Effort) {
    let middle = LAMP.0 + 0.5 * LAMP.1;
    let scene = cornell();
    let places = [
        ("0.5 mm under the lamp", middle - DVec3::Y * 0.0005, 0.0005),
        ("the floor's middle", DVec3::new(middle.x, 0.0, middle.z), middle.y),
    ];
    println!("## line 4: relative variance of one path, variance/mean², in the empty Cornell box\n");
    println!("{:24}{:>18}{:>18}{:>22}", "", "ours, all light", "ours, direct", "area light, direct");
    let rows = places.map(|(name, position, height)| {
        let ours = [None, Some(0)].map(|cap| ours(&scene, position, cap, effort));
        let naive = area_light(height);
        println!("{name:24}{:>18.3e}{:>18.3e}{naive:>22.3e}", ours[0], ours[1]);
        [ours[0], ours[1], naive]
    });
    let [under, middle] = rows;
    let ratio = [0, 1, 2].map(|column| under[column] / middle[column]);
    println!("{:24}{:>18.3e}{:>18.3e}{:>22.3e}\n", "ratio", ratio[0], ratio[1], ratio[2]);
    let holds = |condition: bool| if condition { "holds" } else { "DOES NOT HOLD" };
    println!("Ours within 10× between the two places: {:.2}×, {}.", ratio[0], holds((0.1..=10.0).contains(&ratio[0])));
    let worse = under[2] / under[0];
    println!("The area light at least 1000× worse under the lamp: {worse:.2e}×, {}.\n", holds(worse >= 1000.0));
}

/// Relative variance of one of our paths.
fn ours(scene: &Scene, position: DVec3, max_bounces: Option<u32>, effort: Effort) -> f64 {
    let (mut means, mut variances) = (Welford::default(), Welford::default());
    let point = [facing(position, Vec3::Y)];
    for seed in 0..u64::from(effort.of(METERS)) {
        let transport = Transport { seed, max_bounces, ..Transport::default() };
        let reading = measure(scene, &point, REPLICATES, transport).readings[0];
        means.push(reading.irradiance.y);
        variances.push(reading.stderr.y.powi(2) * f64::from(REPLICATES));
    }
    variances.mean() / means.mean().powi(2)
}

/// Relative variance of cosθ·cosθ'·A/d² over uniform points of the lamp, at `height` under its middle.
fn area_light(height: f64) -> f64 {
    let [width, depth] = [LAMP.1.x, LAMP.1.z];
    let mean = 4.0 * PI * corner_parallel_rectangle(0.5 * width, 0.5 * depth, height);
    // Midpoints in t, with x = height·sinh t: as dense as the integrand is steep.
    let nodes = |half: f64| {
        let end = (half / height).asinh();
        let step = end / f64::from(STEPS);
        (0..STEPS).map(move |index| {
            let t = (f64::from(index) + 0.5) * step;
            (height * t.sinh(), height * t.cosh() * step)
        })
    };
    let columns: Vec<(f64, f64)> = nodes(0.5 * width).collect();
    let row = |(z, dz): (f64, f64)| {
        let column = |&(x, dx): &(f64, f64)| (height * height / (x * x + z * z + height * height).powi(2)).powi(2) * dx;
        dz * columns.iter().map(column).sum::<f64>()
    };
    let second_moment = width * depth * 4.0 * nodes(0.5 * depth).map(row).sum::<f64>();
    second_moment / (mean * mean) - 1.0
}

/// The Cornell box from Cornell University's measured data, 1 unit as 1 cm; empty, since its tall block shades the
/// middle of the floor in part, and the area light's variance is known in closed form only where nothing does.
fn cornell() -> Scene {
    let [x, y, z] = [Vec3::X * 5.528, Vec3::Y * 5.488, Vec3::Z * 5.592];
    let white = Material::diffuse("white", Vec3::new(0.885_809, 0.698_859, 0.666_422));
    let green = Material::diffuse("green", Vec3::new(0.105_421, 0.377_98, 0.076_425));
    let red = Material::diffuse("red", Vec3::new(0.570_068, 0.043_013_5, 0.044_370_6));
    let lamp = Material {
        emitted_radiance: Vec3::new(18.387, 13.9873, 6.75357),
        ..Material::diffuse("lamp", Vec3::splat(0.78))
    };
    let here = Affine3A::IDENTITY;
    let (corner, size) = (LAMP.0.as_vec3(), LAMP.1.as_vec3());
    Stage::default()
        .quad("floor", here, Vec3::ZERO, [z, x], white.clone())
        .quad("ceiling", here, y, [x, z], white.clone())
        .quad("back", here, z, [y, x], white.clone())
        .quad("green", here, Vec3::ZERO, [y, z], green)
        .quad("red", here, x, [z, y], red)
        .quad("lamp", here, corner, [Vec3::X * size.x, Vec3::Z * size.z], lamp)
        .build()
}

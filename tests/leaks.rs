//! Dark boxes in a bright sky: nothing of the outside light may be shown inside, however their walls are put together
//! and however large the texels are. Looked up as displayed, everywhere on what is seen from inside.

mod common;

use bevy_kiln::bake::{BakeSettings, CancelToken, Goal, Lightmap, TexelState, bake_lightmap};
use bevy_kiln::scene::{Material, Scene};
use common::display::{Lookup, displayed_triangles, shown};
use common::scenes::{SceneBuilder, grey};
use glam::{Quat, Vec2, Vec3};

/// Radiance of the sky, which is E/π of what lies open under it [cd/m²].
const OUTSIDE: f32 = 1000.0;

/// Largest share of the outside light that may be seen inside.
const LEAK: f64 = 1e-4;

/// Half the inner size of each box [m].
const HALF: Vec3 = Vec3::new(0.6, 0.5, 0.45);

/// Adds a cuboid of one mesh without a UV1, turned about the vertical axis through the origin.
fn cuboid(builder: SceneBuilder, name: &str, low: Vec3, high: Vec3, turn: Quat, material: &Material) -> SceneBuilder {
    let corner = |index: u32| {
        let picked = |axis: u32| (index >> axis & 1) as f32;
        turn * (low + (high - low) * Vec3::new(picked(0), picked(1), picked(2)))
    };
    // Four corners a side, counter-clockwise from outside.
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let positions: Vec<Vec3> = sides.iter().flatten().map(|&index| corner(index)).collect();
    let indices = (0..6).flat_map(|side| [0, 1, 2, 0, 2, 3].map(|vertex| 4 * side + vertex)).collect();
    builder.receiver(name, positions, indices, material.clone())
}

/// How the walls of a box are put together.
#[derive(Clone, Copy, Debug)]
enum Walls {
    /// One cube, its fronts inwards.
    Inwards,
    /// Six slabs that touch and do not overlap.
    Touching,
    /// Six slabs, each sunk into its neighbours and sticking out on the other side by as much.
    Overlapping { by: f32 },
    /// Six slabs that touch with their inner edges only.
    EdgeToEdge,
}

fn dark_box(walls: Walls, thickness: f32, turn: Quat) -> Scene {
    let material = grey(0.7);
    let builder = SceneBuilder::default().sky(Vec3::splat(OUTSIDE));
    if let Walls::Inwards = walls {
        let sides = || [0; 6].map(|_| material.clone());
        return builder.room(-HALF, HALF, sides()).build();
    }
    // By how much the walls across x, y and z reach beyond the inner box along the other two axes.
    let t = thickness;
    let beyond = match walls {
        Walls::Touching => [Vec3::ZERO, Vec3::new(t, 0.0, t), Vec3::new(t, 0.0, 0.0)],
        Walls::Overlapping { by } => [Vec3::splat(t + by); 3],
        Walls::EdgeToEdge | Walls::Inwards => [Vec3::ZERO; 3],
    };
    let mut builder = builder;
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let along = Vec3::AXES[axis];
        let across = (HALF + beyond[axis]) * (Vec3::ONE - along);
        for (side, sign) in [("low", -1.0), ("high", 1.0)] {
            let inner = along * sign * HALF;
            let outer = along * sign * (HALF + t);
            let (low, high) = (inner.min(outer) - across, inner.max(outer) + across);
            builder = cuboid(builder, &format!("{name} {side}"), low, high, turn, &material);
        }
    }
    builder.build()
}

/// A house without windows on open ground that runs on under its walls; they are sunk into it, and turned.
fn house_on_open_ground(thickness: f32, sunk: f32, turn: Quat) -> Scene {
    let material = grey(0.7);
    let (side, t) = (1.5, thickness);
    let corner = Vec3::new(-side, -HALF.y, -side);
    let ground = [Vec3::Z, Vec3::X].map(|edge| 2.0 * side * edge);
    let positions = vec![corner, corner + ground[0], corner + ground[0] + ground[1], corner + ground[1]];
    let mut builder = SceneBuilder::default().sky(Vec3::splat(OUTSIDE));
    builder = builder.receiver("ground", positions, vec![0, 1, 2, 0, 2, 3], material.clone());
    let low = -HALF - Vec3::Y * sunk;
    let walls = [
        ("west", Vec3::new(-HALF.x - t, low.y, -HALF.z - t), Vec3::new(-HALF.x, HALF.y, HALF.z + t)),
        ("east", Vec3::new(HALF.x, low.y, -HALF.z - t), Vec3::new(HALF.x + t, HALF.y, HALF.z + t)),
        ("north", Vec3::new(-HALF.x, low.y, -HALF.z - t), Vec3::new(HALF.x, HALF.y, -HALF.z)),
        ("south", Vec3::new(-HALF.x, low.y, HALF.z), Vec3::new(HALF.x, HALF.y, HALF.z + t)),
        ("roof", Vec3::new(-0.8, HALF.y, -0.7), Vec3::new(0.8, HALF.y + t, 0.7)),
    ];
    for (name, low, high) in walls {
        builder = cuboid(builder, name, low, high, turn, &material);
    }
    builder.build()
}

fn bake(scene: &Scene, density: f32) -> Lightmap {
    bake_with(scene, density, 16)
}

fn bake_with(scene: &Scene, density: f32, samples_per_texel: u32) -> Lightmap {
    let settings = BakeSettings { density, goal: Goal::Samples(samples_per_texel), ..BakeSettings::default() };
    bake_lightmap(scene, &settings, &(), &CancelToken::default()).unwrap()
}

/// The brightest that is shown inside the box, over the outside light, and how many places were looked at.
fn brightest_inside(scene: &Scene, lightmap: &Lightmap, turn: Quat) -> (f64, usize) {
    let mut brightest = 0.0_f64;
    let mut looked = 0;
    for placement in &lightmap.placements {
        for corners in displayed_triangles(scene, lightmap, placement) {
            let [a, b, c] = corners.map(|(position, _)| turn.inverse() * position);
            let [p, q, r] = corners.map(|(_, uv)| uv);
            let normal = (b - a).cross(c - a).normalize();
            for row in 0..=160 {
                for column in 0..=160 - row {
                    let [s, t] = [row, column].map(|step| step as f32 / 160.0);
                    let place = a + (b - a) * s + (c - a) * t;
                    // Just off the surface, so that what lies in the box's own walls counts and their backs do not.
                    let off = place + 1e-4 * normal;
                    if !(off.abs().cmplt(HALF - 1e-5).all()) {
                        continue;
                    }
                    looked += 1;
                    let uv: Vec2 = p + (q - p) * s + (r - p) * t;
                    for lookup in [Lookup::Bilinear, Lookup::Bicubic] {
                        brightest = brightest.max(shown(lightmap, placement, uv, lookup).max_element());
                    }
                }
            }
        }
    }
    (brightest / f64::from(OUTSIDE), looked)
}

/// Bakes a box and looks at its inside.
fn judge(what: &str, scene: &Scene, density: f32, turn: Quat) {
    let lightmap = bake(scene, density);
    let (leak, looked) = brightest_inside(scene, &lightmap, turn);
    println!("{what}, {density} texels/m: {leak:.1e}, {} hidden", lightmap.report.hidden);
    assert!(looked > 10_000, "only {looked} places are inside");
    assert!(leak <= LEAK, "{what}, {density} texels per metre: {leak:.1e} inside");
}

fn holds(walls: Walls, thickness: f32, densities: &[f32], degrees: f32) {
    let turn = Quat::from_rotation_y(degrees.to_radians());
    let scene = dark_box(walls, thickness, turn);
    for &density in densities {
        judge(&format!("{walls:?}, {thickness} m, {degrees}°"), &scene, density, turn);
    }
}

const DENSITIES: &[f32] = &[4.0, 16.0, 64.0];

/// The four boxes of the public test project for Godot's lightmaps (patwork/Godot-LightmapGI-Tests, test 03), after
/// their description: a cube with its normals inwards; six cubes that touch and do not overlap; six that overlap; six
/// that touch with their edges only. Slabs of 1 cm and thick ones.
#[test]
fn one_cube_with_its_fronts_inwards() {
    holds(Walls::Inwards, 0.0, DENSITIES, 0.0);
}

#[test]
fn six_slabs_that_touch() {
    holds(Walls::Touching, 0.01, DENSITIES, 0.0);
    holds(Walls::Touching, 0.5, &[4.0, 16.0], 0.0);
}

#[test]
fn six_slabs_that_overlap() {
    holds(Walls::Overlapping { by: 0.003 }, 0.01, DENSITIES, 0.0);
    holds(Walls::Overlapping { by: 0.11 }, 0.2, DENSITIES, 0.0);
    holds(Walls::Overlapping { by: 0.003 }, 0.2, &[4.0, 16.0], 0.0);
    holds(Walls::Overlapping { by: 0.0 }, 0.2, &[16.0], 31.0);
    holds(Walls::Overlapping { by: 0.11 }, 0.01, &[4.0, 16.0], 0.0);
}

#[test]
fn six_slabs_edge_to_edge() {
    holds(Walls::EdgeToEdge, 0.01, DENSITIES, 0.0);
    holds(Walls::EdgeToEdge, 0.5, &[4.0, 16.0], 0.0);
}

#[test]
fn a_house_on_open_ground() {
    for (thickness, sunk, degrees) in [(0.01, 0.0, 0.0), (0.01, 0.05, 17.0), (0.2, 0.05, 40.0)] {
        let turn = Quat::from_rotation_y(f32::to_radians(degrees));
        let scene = house_on_open_ground(thickness, sunk, turn);
        for density in [4.0, 16.0, 64.0] {
            judge(&format!("house, {thickness} m, sunk {sunk} m, {degrees}°"), &scene, density, turn);
        }
    }
}

/// The judge itself: light in what nobody sees, next to what is seen, is found.
#[test]
fn light_under_the_walls_is_found() {
    let scene = dark_box(Walls::Overlapping { by: 0.11 }, 0.2, Quat::IDENTITY);
    let mut lightmap = bake(&scene, 16.0);
    assert!(brightest_inside(&scene, &lightmap, Quat::IDENTITY).0 <= LEAK);
    for page in &mut lightmap.pages {
        for (value, state) in page.radiance.iter_mut().zip(&page.state) {
            if *state == TexelState::Hidden {
                *value = Vec3::splat(OUTSIDE);
            }
        }
    }
    assert!(brightest_inside(&scene, &lightmap, Quat::IDENTITY).0 > 100.0 * LEAK);
}

/// A wide floor with pillars that stand on it, are sunk into it, or float a hair above it: what the pillars hide is not
/// seen, and what is seen beside them is as bright as it is.
#[test]
fn floors_under_pillars_have_no_dark_edges() {
    let material = grey(0.5);
    let floor = [Vec3::Z * 4.0, Vec3::X * 4.0];
    for (lift, degrees) in [(0.0, 0.0), (-0.05, 0.0), (0.0, 20.0), (-0.3, 33.0)] {
        let turn = Quat::from_rotation_y(f32::to_radians(degrees));
        let corner = Vec3::new(-2.0, 0.0, -2.0);
        let builder = SceneBuilder::default().sky(Vec3::splat(OUTSIDE)).quad("floor", corner, floor, material.clone());
        let (low, high) = (Vec3::new(-0.37, lift, -0.21), Vec3::new(0.37, 1.5, 0.21));
        let scene = cuboid(builder, "pillar", low, high, turn, &material).build();
        for density in [4.0, 16.0] {
            let lightmap = bake_with(&scene, density, 64);
            let placement = lightmap.placements.iter().find(|placement| placement.id.as_str() == "floor").unwrap();
            let mut least = f64::INFINITY;
            for index in 0..200 * 200 {
                let [z, x] = [index / 200, index % 200].map(|step| (step as f32 + 0.5) / 200.0);
                let place = turn.inverse() * (corner + floor[0] * z + floor[1] * x);
                let is_under = place.x.abs() < 0.37 && place.z.abs() < 0.21;
                let is_near = place.x.abs() < 0.6 && place.z.abs() < 0.45;
                if is_near && !is_under {
                    for lookup in [Lookup::Bilinear, Lookup::Bicubic] {
                        least = least.min(shown(&lightmap, placement, Vec2::new(z, x), lookup).min_element());
                    }
                }
            }
            least /= f64::from(OUTSIDE);
            println!(
                "lift {lift}, {degrees}°, {density} texels/m: least {least:.3}, {} hidden",
                lightmap.report.hidden
            );
            // The pillar hides less than half of the sky; the rest is what 64 paths may miss.
            assert!(least > 0.45, "lift {lift}, {degrees}°, {density} texels per metre: {least:.3} beside the pillar");
        }
    }
}

/// Light inside bodies without absorption has no way out; nobody sees it, so it is nobody's business.
#[test]
fn white_crates_sunk_into_each_other_are_baked() {
    let white = grey(1.0);
    let builder = SceneBuilder::default().sky(Vec3::splat(OUTSIDE));
    let builder = cuboid(builder, "one", Vec3::ZERO, Vec3::ONE, Quat::IDENTITY, &white);
    let turn = Quat::from_rotation_y(0.4);
    let scene = cuboid(builder, "other", Vec3::splat(0.5), Vec3::splat(1.4), turn, &white).build();
    let lightmap = bake(&scene, 8.0);
    assert!(lightmap.report.hidden > 50, "{:?}", lightmap.report.hidden);
    assert_eq!(lightmap.report.warnings, []);
    let page = &lightmap.pages[0];
    let seen = page.coverage.iter().zip(&page.radiance).filter(|(coverage, _)| **coverage > 0.0);
    let least = seen.map(|(_, value)| value.min_element()).fold(f32::INFINITY, f32::min);
    assert!(least > 0.05 * OUTSIDE, "{least}");
}

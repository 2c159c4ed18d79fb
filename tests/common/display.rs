//! A lightmap as a GPU shows it: an independent port of Bevy's lookups (bevy_pbr 0.19, `lightmap.wgsl`), in f64.

use bevy_kiln::bake::{Lightmap, Page, Placement};
use glam::{DVec2, DVec3, Vec2};

/// How a texture is read between its texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lookup {
    Bilinear,
    Bicubic,
}

/// What is shown at a place of an object's UV1 [cd/m²].
pub fn shown(lightmap: &Lightmap, placement: &Placement, uv1: Vec2, lookup: Lookup) -> DVec3 {
    let page = &lightmap.pages[placement.page as usize];
    let corner = |uv: [f32; 2]| DVec2::from(uv.map(|coordinate| (f64::from(coordinate) * 65535.0).round() / 65535.0));
    let (low, high) = (corner(placement.uv_min), corner(placement.uv_max));
    let uv = low + uv1.as_dvec2() * (high - low);
    let texels = uv * DVec2::new(page.width.into(), page.height.into());
    match lookup {
        Lookup::Bilinear => bilinear(page, texels),
        Lookup::Bicubic => bicubic(page, texels),
    }
}

fn texel(page: &Page, x: i64, y: i64) -> DVec3 {
    let [x, y] = [x.clamp(0, i64::from(page.width) - 1), y.clamp(0, i64::from(page.height) - 1)];
    page.radiance[(y * i64::from(page.width) + x) as usize].as_dvec3()
}

/// The four texels around a place, by hand of the clamp-to-edge sampler.
fn bilinear(page: &Page, place: DVec2) -> DVec3 {
    let base = (place - 0.5).floor();
    let part = place - 0.5 - base;
    let [x, y] = [base.x as i64, base.y as i64];
    let row = |y: i64| texel(page, x, y).lerp(texel(page, x + 1, y), part.x);
    row(y).lerp(row(y + 1), part.y)
}

/// A cubic B-spline over sixteen texels.
fn bicubic(page: &Page, place: DVec2) -> DVec3 {
    let base = (place - 0.5).floor();
    let part = place - 0.5 - base;
    let weights = |t: f64| {
        let s = 1.0 - t;
        [s * s * s, 4.0 - 6.0 * t * t + 3.0 * t * t * t, 4.0 - 6.0 * s * s + 3.0 * s * s * s, t * t * t]
            .map(|w| w / 6.0)
    };
    let (columns, rows) = (weights(part.x), weights(part.y));
    let mut sum = DVec3::ZERO;
    for (dy, row) in rows.into_iter().enumerate() {
        for (dx, column) in columns.into_iter().enumerate() {
            sum += row * column * texel(page, base.x as i64 + dx as i64 - 1, base.y as i64 + dy as i64 - 1);
        }
    }
    sum
}

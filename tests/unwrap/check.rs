//! The judge of layouts: every chart is drawn into its page, texel by texel, with the border that filtering reads.

use bevy_kiln::bake::{LaidOutMesh, Placement, TexelLayout};
use bevy_kiln::scene::Scene;
use glam::{DMat3, DVec2, DVec3, Mat3};
use std::collections::BTreeMap;

/// Texels beyond a chart that bicubic filtering reads.
const BORDER: i64 = 2;

/// Below this share a texel counts as empty.
const LEAST: f64 = 1e-3;

/// What a layout is like.
#[derive(Clone, Debug, Default)]
pub struct Figures {
    pub charts: u64,
    /// Mean over the surface of the larger of length and inverse against the density, worst first axis.
    pub stretch: f64,
    /// The most for all but a thousandth of the surface.
    pub worst: f64,
    pub fill: f64,
    pub covered: u64,
}

/// An object as it lies on its page.
pub struct Drawn {
    /// By triangle: corners on the page [texels].
    pub flat: Vec<[DVec2; 3]>,
    /// By triangle: corners in the world [m].
    pub world: Vec<[DVec3; 3]>,
    /// By triangle: which chart it belongs to.
    pub chart: Vec<u32>,
}

/// Objects that were unwrapped, as they lie on their page.
pub fn drawn(scene: &Scene, layout: &TexelLayout, placement: &Placement) -> Drawn {
    let mesh: &LaidOutMesh = &layout.meshes[placement.mesh.expect("unwrapped")];
    let instance = scene.instances.iter().find(|instance| instance.id == placement.id).unwrap();
    let source = &scene.meshes[mesh.source];
    let page = layout.pages[placement.page as usize];
    let page = DVec2::new(page[0].into(), page[1].into());
    let [low, high] =
        [placement.uv_min, placement.uv_max].map(|[u, v]| (DVec2::new(u.into(), v.into()) * page).round());
    let matrix: DMat3 = Mat3::from(instance.world_from_local.matrix3).as_dmat3();
    let point = |vertex: u32| low + mesh.uv1[vertex as usize].as_dvec2() * (high - low);
    let world = |vertex: u32| matrix * source.positions[mesh.vertices[vertex as usize] as usize].as_dvec3();
    assert!(mesh.uv1.iter().all(|uv| uv.min_element() >= 0.0 && uv.max_element() <= 1.0), "{}", source.name);
    let triangles: Vec<[u32; 3]> = mesh.indices.chunks(3).map(|corners| [corners[0], corners[1], corners[2]]).collect();
    let sources: Vec<[u32; 3]> = source.triangles().collect();
    assert_eq!(triangles.len(), sources.len());
    for (triangle, source) in triangles.iter().zip(&sources) {
        assert_eq!(triangle.map(|vertex| mesh.vertices[vertex as usize]), *source, "the source's triangles");
    }
    let real: Vec<[u32; 3]> = triangles.into_iter().filter(|corners| is_real(corners.map(world))).collect();
    Drawn {
        chart: charts(mesh, &real),
        flat: real.iter().map(|corners| corners.map(point)).collect(),
        world: real.iter().map(|corners| corners.map(world)).collect(),
    }
}

fn is_real([a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a).length() > 0.0
}

/// Triangles that share a place in UV1 are of one chart.
fn charts(mesh: &LaidOutMesh, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut first: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let mut parents: Vec<u32> = (0..triangles.len() as u32).collect();
    fn root(parents: &[u32], mut of: u32) -> u32 {
        while parents[of as usize] != of {
            of = parents[of as usize];
        }
        of
    }
    for (index, corners) in triangles.iter().enumerate() {
        for &corner in corners {
            let place = mesh.uv1[corner as usize].to_array().map(f32::to_bits);
            let other = *first.entry(place).or_insert(index as u32);
            let (a, b) = (root(&parents, other), root(&parents, index as u32));
            parents[a.max(b) as usize] = a.min(b);
            parents[index] = a.min(b);
        }
    }
    (0..triangles.len() as u32).map(|index| root(&parents, index)).collect()
}

/// Judges every unwrapped object of a layout.
pub fn judge(scene: &Scene, layout: &TexelLayout, density: f64) -> Result<Figures, String> {
    let mut figures = Figures::default();
    let mut pages: Vec<Vec<Texel>> =
        layout.pages.iter().map(|[width, height]| vec![Texel::default(); (width * height) as usize]).collect();
    let mut stretches = Vec::new();
    let mut next = 1;
    for placement in &layout.placements {
        let drawn = drawn(scene, layout, placement);
        let mut ids = BTreeMap::new();
        for (index, flat) in drawn.flat.iter().enumerate() {
            let id = *ids.entry(drawn.chart[index]).or_insert_with(|| {
                next += 1;
                next - 1
            });
            draw(&mut pages[placement.page as usize], layout.pages[placement.page as usize], id, *flat)?;
            let world = drawn.world[index];
            let area = 0.5 * (world[1] - world[0]).cross(world[2] - world[0]).length();
            stretches.push((stretch(world, flat.map(|point| point / density)), area));
        }
    }
    figures.charts = next as u64 - 1;
    for (page, size) in pages.iter().zip(&layout.pages) {
        figures.covered += judge_page(page, *size)?;
    }
    let area: u64 = layout.pages.iter().map(|[width, height]| u64::from(*width) * u64::from(*height)).sum();
    figures.fill = figures.covered as f64 / area as f64;
    stretches.sort_by(|a, b| b.0.total_cmp(&a.0));
    let whole: f64 = stretches.iter().map(|stretch| stretch.1).sum();
    figures.stretch = stretches.iter().map(|(stretch, area)| stretch.min(100.0) * area).sum::<f64>() / whole;
    let mut left = 1e-3 * whole;
    let beyond = |(_, area): &&(f64, f64)| {
        left -= area;
        left <= 0.0
    };
    figures.worst = stretches.iter().find(beyond).map_or(1.0, |stretch| stretch.0);
    Ok(figures)
}

#[derive(Clone, Copy, Debug, Default)]
struct Texel {
    /// 0 for none.
    chart: u32,
    area: f64,
}

/// Adds a triangle's area to the texels that it covers.
fn draw(page: &mut [Texel], [width, height]: [u32; 2], chart: u32, flat: [DVec2; 3]) -> Result<(), String> {
    let low = flat[0].min(flat[1]).min(flat[2]);
    let high = flat[0].max(flat[1]).max(flat[2]);
    if low.min_element() < -1e-2 || high.x > f64::from(width) + 1e-2 || high.y > f64::from(height) + 1e-2 {
        return Err(format!("a triangle leaves its page: {flat:?}"));
    }
    for y in low.y.max(0.0) as u32..(high.y.ceil() as u32).min(height) {
        for x in low.x.max(0.0) as u32..(high.x.ceil() as u32).min(width) {
            let area = covered(flat, DVec2::new(x.into(), y.into()));
            if area < LEAST * LEAST {
                continue;
            }
            let texel = &mut page[(y * width + x) as usize];
            if texel.chart != chart && texel.area >= LEAST && area >= LEAST {
                return Err(format!("two charts in texel {x}, {y}"));
            }
            if texel.chart != chart && texel.area < LEAST {
                *texel = Texel { chart, area: 0.0 };
            }
            if texel.chart == chart {
                texel.area += area;
            }
            if texel.area > 1.0 + 2.0 * LEAST {
                return Err(format!("chart {chart} lies over itself in texel {x}, {y}: {}", texel.area));
            }
        }
    }
    Ok(())
}

/// Area of a triangle within the texel at a corner.
fn covered(flat: [DVec2; 3], corner: DVec2) -> f64 {
    let mut polygon = flat.map(|point| point - corner).to_vec();
    for (normal, limit) in [(DVec2::X, 0.0), (-DVec2::X, -1.0), (DVec2::Y, 0.0), (-DVec2::Y, -1.0)] {
        let mut kept = Vec::with_capacity(8);
        for index in 0..polygon.len() {
            let (from, to) = (polygon[index], polygon[(index + 1) % polygon.len()]);
            let (a, b) = (normal.dot(from) - limit, normal.dot(to) - limit);
            if a >= 0.0 {
                kept.push(from);
            }
            if (a >= 0.0) != (b >= 0.0) {
                kept.push(from.lerp(to, a / (a - b)));
            }
        }
        polygon = kept;
    }
    let twice: f64 =
        (2..polygon.len()).map(|index| (polygon[index - 1] - polygon[0]).perp_dot(polygon[index] - polygon[0])).sum();
    0.5 * twice.abs()
}

/// Borders of two charts share no texel and no block of a compressed texture. Gives the covered texels.
fn judge_page(page: &[Texel], [width, height]: [u32; 2]) -> Result<u64, String> {
    if width % 4 != 0 || height % 4 != 0 {
        return Err(format!("a page of {width} × {height} texels"));
    }
    let mut claims = vec![0_u32; page.len()];
    let mut covered = 0;
    for y in 0..i64::from(height) {
        for x in 0..i64::from(width) {
            let texel = page[(y * i64::from(width) + x) as usize];
            if texel.area < LEAST {
                continue;
            }
            covered += 1;
            for row in y - BORDER..=y + BORDER {
                for column in x - BORDER..=x + BORDER {
                    if row < 0 || column < 0 || row >= height.into() || column >= width.into() {
                        return Err(format!("the border of texel {x}, {y} leaves the page"));
                    }
                    let claim = &mut claims[(row * i64::from(width) + column) as usize];
                    if *claim != 0 && *claim != texel.chart {
                        return Err(format!("charts {claim} and {} share texel {column}, {row}", texel.chart));
                    }
                    *claim = texel.chart;
                }
            }
        }
    }
    for block in 0..width / 4 * (height / 4) {
        let [left, top] = [block % (width / 4) * 4, block / (width / 4) * 4];
        let texels = (0..16).map(|texel| claims[((top + texel / 4) * width + left + texel % 4) as usize]);
        let mut owners: Vec<u32> = texels.filter(|&claim| claim != 0).collect();
        owners.dedup();
        owners.sort_unstable();
        owners.dedup();
        if owners.len() > 1 {
            return Err(format!("the block at {left}, {top} holds charts {owners:?}"));
        }
    }
    Ok(covered)
}

/// The largest factor by which lengths change, or its inverse.
pub fn stretch(world: [DVec3; 3], flat: [DVec2; 3]) -> f64 {
    let x_axis = (world[1] - world[0]).normalize();
    let normal = (world[1] - world[0]).cross(world[2] - world[0]).normalize();
    let y_axis = normal.cross(x_axis);
    let own = [1, 2].map(|corner| world[corner] - world[0]).map(|edge| DVec2::new(edge.dot(x_axis), edge.dot(y_axis)));
    let [p, q] = own;
    let [r, s] = [flat[1] - flat[0], flat[2] - flat[0]];
    let determinant = p.perp_dot(q);
    let (u, v) = ((r * q.y - s * p.y) / determinant, (s * p.x - r * q.x) / determinant);
    let (sum, product) = (u.length_squared() + v.length_squared(), u.perp_dot(v).abs());
    let largest = (0.5 * (sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt())).sqrt();
    largest.max(largest / product)
}

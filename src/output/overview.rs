//! How a page is used, as a picture for a person: its charts, how densely texels lie on them, what is wrong with them.
//!
//! | in the picture | means |
//! |---|---|
//! | a colour from yellow over green and blue to purple | a chart, each of its own |
//! | brightness | texels per metre: in the middle for half of the page, half as bright at half of that, brighter above |
//! | stripes | inside of bodies and in the dark: declared invalid and filled in |
//! | red | charts or triangles overlap |
//! | black | no triangle covers it |

use super::png::write_rgb;
use crate::bake::{Page, TexelState};
use std::io::{self, Write};

/// Least length of the picture's longer side [pixels].
const LEAST_SIDE: u32 = 512;
/// Brightness of the page's middle density.
const MIDDLE: f32 = 0.6;
/// How bright, as a share of the chart's colour, the dark stripes are.
const STRIPE: f32 = 0.25;
/// Distance between the beginnings of two stripes [pixels].
const STRIPES: u32 = 6;
/// The hues of charts, between which none is red [turns].
const HUES: [f32; 2] = [0.12, 0.85];

/// Writes the picture, enlarged by a whole number where the page is small.
pub(super) fn write_overview(page: &Page, to: impl Write) -> io::Result<()> {
    let scale = (LEAST_SIDE / page.width.max(page.height).max(1)).max(1);
    let middle = middle_density(page);
    let (width, height) = (page.width * scale, page.height * scale);
    let mut pixels = Vec::with_capacity(3 * width as usize * height as usize);
    for y in 0..height {
        for x in 0..width {
            let texel = (y / scale) as usize * page.width as usize + (x / scale) as usize;
            pixels.extend(colour(page, texel, middle, Place { x, y }).map(|channel| (255.0 * channel + 0.5) as u8));
        }
    }
    write_rgb(width, height, pixels, to)
}

/// A pixel of the picture.
struct Place {
    x: u32,
    y: u32,
}

fn colour(page: &Page, texel: usize, middle: f32, place: Place) -> [f32; 3] {
    let chart = page.chart.get(texel).copied().unwrap_or(0);
    if chart == 0 {
        return [0.0; 3];
    }
    if page.is_overlapped.get(texel).copied().unwrap_or(false) {
        return [1.0, 0.0, 0.0];
    }
    let density = page.density.get(texel).copied().unwrap_or(0.0);
    let bright =
        if density > 0.0 && middle > 0.0 { MIDDLE * (density / middle).clamp(0.4, 1.0 / MIDDLE) } else { MIDDLE };
    let is_hidden = page.state.get(texel) == Some(&TexelState::Hidden);
    let is_striped = is_hidden && (place.x + place.y) % STRIPES < STRIPES / 2;
    hue(chart).map(|channel| channel * if is_striped { STRIPE * bright } else { bright })
}

/// The middle one of the densities of covered texels; 0 without any.
fn middle_density(page: &Page) -> f32 {
    let mut densities: Vec<f32> = page.density.iter().copied().filter(|&density| density > 0.0).collect();
    if densities.is_empty() {
        return 0.0;
    }
    let half = densities.len() / 2;
    *densities.select_nth_unstable_by(half, f32::total_cmp).1
}

/// A bright colour that is far from those of the charts numbered next to it: steps by the golden ratio, whose
/// multiples never come close to each other.
fn hue(chart: u32) -> [f32; 3] {
    // In 32 bits of a turn, so that no float rounds it differently for large numbers.
    let step = chart.wrapping_mul(0x9e37_79b9);
    let turn = HUES[0] + (HUES[1] - HUES[0]) * (step >> 8) as f32 / (1 << 24) as f32;
    // Red, green and blue stand at thirds of the turn, each full within a sixth of it and gone beyond a third.
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|at: f32| {
        let away = (turn - at).abs();
        (2.0 - 6.0 * away.min(1.0 - away)).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::super::test_pages::page;
    use super::*;

    /// The middle pixels of the texels.
    fn pixels(page: &Page) -> Vec<[u8; 3]> {
        let mut png = Vec::new();
        write_overview(page, &mut png).unwrap();
        let picture = image::load_from_memory_with_format(&png, image::ImageFormat::Png).expect("a PNG file");
        let picture = picture.as_rgb8().expect("eight bits of red, green and blue").clone();
        let scale = picture.width() / page.width;
        assert_eq!((picture.width(), picture.height()), (page.width * scale, page.height * scale));
        let places = (0..page.height).flat_map(|y| (0..page.width).map(move |x| (x, y)));
        places.map(|(x, y)| picture.get_pixel(x * scale + scale / 2, y * scale + scale / 2).0).collect()
    }

    fn covered() -> Page {
        let mut page = page(4, 2);
        page.density = vec![16.0; 8];
        page.is_overlapped = vec![false; 8];
        page
    }

    #[test]
    fn gaps_overlaps_and_charts_are_told_apart() {
        let mut page = covered();
        page.chart = vec![0, 1, 1, 2, 3, 3, 3, 3];
        page.is_overlapped[2] = true;
        let seen = pixels(&page);
        assert_eq!((seen[0], seen[2]), ([0; 3], [255, 0, 0]));
        assert!(seen[1] != seen[3] && seen[3] != seen[4] && seen[1] != seen[4]);
        assert_eq!(seen[4], seen[7]);
    }

    #[test]
    fn denser_is_brighter_and_the_middle_is_in_the_middle() {
        let mut page = covered();
        page.density = vec![8.0, 16.0, 16.0, 16.0, 16.0, 32.0, 1e9, 0.0];
        let bright: Vec<u8> = pixels(&page).iter().map(|pixel| pixel.iter().copied().max().unwrap()).collect();
        assert_eq!(bright[1], 153);
        assert_eq!(bright[0], 77);
        assert_eq!((bright[5], bright[6], bright[7]), (255, 255, 153));
    }

    #[test]
    fn hidden_texels_are_striped() {
        let mut page = covered();
        page.state[5] = TexelState::Hidden;
        let mut png = Vec::new();
        write_overview(&page, &mut png).unwrap();
        let picture = image::load_from_memory_with_format(&png, image::ImageFormat::Png).unwrap().to_rgb8();
        let scale = picture.width() / 4;
        let colours = |texel: u32| {
            let (x, y) = (texel % 4 * scale, texel / 4 * scale);
            let inside = (0..scale).flat_map(|dy| (0..scale).map(move |dx| (dx, dy)));
            inside.map(|(dx, dy)| picture.get_pixel(x + dx, y + dy).0).collect::<std::collections::BTreeSet<_>>()
        };
        assert_eq!((colours(4).len(), colours(5).len()), (1, 2));
    }

    #[test]
    fn many_charts_have_many_colours_and_none_is_red_or_dark() {
        let all: std::collections::BTreeSet<[u8; 3]> =
            (1..200).map(|chart| hue(chart).map(|channel| (255.0 * channel) as u8)).collect();
        assert!(all.len() > 150, "{}", all.len());
        for [red, green, blue] in &all {
            assert!(*green.max(blue) > 150 && red.max(green).max(blue) == &255, "{red} {green} {blue}");
        }
        for chart in 1..1000 {
            let [a, b] = [chart, chart + 1].map(hue);
            let apart: f32 = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).sum();
            assert!(apart > 0.5, "{chart}");
        }
    }

    #[test]
    fn a_page_without_layers_is_drawn_all_the_same() {
        let mut page = page(600, 3);
        page.chart.clear();
        page.state.clear();
        assert_eq!(pixels(&page), [[0; 3]; 1800]);
    }
}

//! What display maps lose where their format compresses blocks of texels: the decoded texels against those that were
//! to be stored.

use super::bc6h;
use super::format::TexelFormat;
use super::texels::stored_colours;
use crate::bake::Page;
use crate::math::luminance;
use glam::Vec3;

/// Texels darker than this share of the mean are judged by it.
const DARK: f64 = 1e-3;

/// The error of compressed display maps over covered texels: the luminance (Rec. 709) of the differences of the
/// channels, over the luminance of the texel or, where that is more, 1e-3 of the mean of all covered texels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CompressionError {
    /// Root of the mean square.
    pub rms: f64,
    /// Worst texel.
    pub worst: f64,
}

/// The errors of the pages that were stored so far.
pub(super) struct Losses {
    format: TexelFormat,
    /// Least luminance that an error is held against [cd/m²].
    floor: f64,
    squares: f64,
    count: u64,
    worst: f64,
}

impl Losses {
    /// For these pages; `None` for a format without compression.
    pub(super) fn of(pages: &[Page], format: TexelFormat) -> Option<Self> {
        match format {
            TexelFormat::Rgb9e5 | TexelFormat::Rgba16f => return None,
            TexelFormat::Bc6h => {}
        }
        let texels = pages.iter().flat_map(|page| covered(page, format));
        let (sum, count) = texels.fold((0.0, 0_u64), |(sum, count), (_, colour)| (sum + luminance(colour), count + 1));
        let floor = (DARK * sum / count.max(1) as f64).max(f64::from(f32::MIN_POSITIVE));
        Some(Self { format, floor, squares: 0.0, count: 0, worst: 0.0 })
    }

    /// Adds a page and the level that stores it.
    pub(super) fn add(&mut self, page: &Page, level: &[u8]) {
        let (page_width, width) = (page.width as usize, self.format.stored_size(page)[0]);
        let decoded = bc6h::decode(level, width);
        for (at, wanted) in covered(page, self.format) {
            let found = decoded[at / page_width * width as usize + at % page_width];
            let error = luminance((Vec3::from(found) - wanted).abs()) / luminance(wanted).max(self.floor);
            self.squares += error * error;
            self.count += 1;
            self.worst = self.worst.max(error);
        }
    }

    /// The error of all of them.
    pub(super) fn error(&self) -> CompressionError {
        CompressionError { rms: (self.squares / self.count.max(1) as f64).sqrt(), worst: self.worst }
    }
}

/// Index and storable colour of the covered texels.
fn covered(page: &Page, format: TexelFormat) -> impl Iterator<Item = (usize, Vec3)> {
    let colours = stored_colours(page, format).map(Vec3::from);
    let texels = colours.zip(&page.coverage).enumerate();
    texels.filter(|(_, (_, coverage))| **coverage > 0.0).map(|(at, (colour, _))| (at, colour))
}

#[cfg(test)]
mod tests {
    use super::super::test_pages::{page, strange_page};
    use super::super::texel_bytes;
    use super::*;

    fn error_of(pages: &[Page]) -> CompressionError {
        let mut losses = Losses::of(pages, TexelFormat::Bc6h).unwrap();
        pages.iter().for_each(|page| losses.add(page, &texel_bytes(page, TexelFormat::Bc6h).bytes));
        losses.error()
    }

    fn error_of_level(page: &Page, level: &[u8]) -> CompressionError {
        let mut losses = Losses::of(std::slice::from_ref(page), TexelFormat::Bc6h).unwrap();
        losses.add(page, level);
        losses.error()
    }

    /// A page of even light that falls off slowly.
    fn smooth_page() -> Page {
        let mut page = page(64, 32);
        for (at, colour) in page.radiance.iter_mut().enumerate() {
            let (x, y) = ((at % 64) as f32, (at / 64) as f32);
            *colour = Vec3::new(5.0, 4.0, 3.0) / (1.0 + 1e-3 * (x * x + 2.0 * y * y));
        }
        page
    }

    #[test]
    fn smooth_pages_lose_little_and_edges_more() {
        let smooth = error_of(&[smooth_page()]);
        assert!(smooth.rms > 0.0 && smooth.rms < 0.005 && smooth.worst < 0.03, "{smooth:?}");
        let mut edges = smooth_page();
        for (at, colour) in edges.radiance.iter_mut().enumerate() {
            *colour = if at * 7 % 11 < 3 { Vec3::new(9.0, 1.0, 0.1) } else { Vec3::new(0.2, 3.0, 8.0) };
            *colour *= 1.0 + (at % 5) as f32;
        }
        let edges = error_of(&[edges]);
        assert!(edges.rms > 10.0 * smooth.rms && edges.worst > edges.rms, "{edges:?}");
    }

    #[test]
    fn it_is_what_the_wrong_texel_makes_it() {
        let mut page = page(8, 4);
        page.radiance.fill(Vec3::ONE);
        page.coverage.fill(1.0);
        let level = texel_bytes(&page, TexelFormat::Bc6h).bytes;
        // One and its half are next to what blocks can hold exactly; nothing else is wrong.
        let found = bc6h::decode(&level, 8)[9];
        page.radiance[9] = Vec3::new(2.0, 1.0, 1.0);
        page.radiance[10] = Vec3::ZERO;
        let error = error_of_level(&page, &level);
        let mean = (30.0 + luminance(page.radiance[9])) / 32.0;
        let wrong = luminance((Vec3::from(found) - page.radiance[9]).abs()) / luminance(page.radiance[9]);
        let leak = luminance(Vec3::from(found)) / (1e-3 * mean);
        assert!((error.worst - leak).abs() < 1e-3 * leak, "{error:?}, {leak}");
        let rms = ((wrong * wrong + leak * leak) / 32.0_f64).sqrt();
        assert!((error.rms - rms).abs() < 1e-3 * rms, "{error:?}, {rms}");
        page.coverage[9] = 0.0;
        page.coverage[10] = 0.0;
        let error = error_of_level(&page, &level);
        assert!(error.worst < 0.01, "uncovered texels do not count: {error:?}");
    }

    #[test]
    fn odd_sizes_black_pages_and_strange_values_have_an_error_that_is_a_number() {
        let mut black = page(5, 3);
        black.radiance.fill(Vec3::ZERO);
        assert_eq!(error_of(&[black.clone()]), CompressionError { rms: 0.0, worst: 0.0 });
        assert_eq!(error_of(&[]), CompressionError::default());
        let odd = error_of(&[page(5, 3), page(1, 1), page(13, 9), black]);
        assert!(odd.worst < 0.3, "{odd:?}");
        let strange = error_of(&[strange_page()]);
        assert!(strange.rms.is_finite() && strange.worst.is_finite());
        assert!(Losses::of(&[page(4, 4)], TexelFormat::Rgb9e5).is_none());
    }
}

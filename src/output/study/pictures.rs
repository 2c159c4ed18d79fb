//! The strip of pictures: side by side, larger, with their samples beneath. All exposed alike, by the last.

use super::sheet::{Bitmap, Drawing, Drawn, Sheet, Words, bitmap};
use super::words::grouped;
use crate::math::luminance;
use crate::output::png::pixel;
use crate::output::tone::ToneCurve;
use crate::study::{PICTURE_SIZE, Strip, StudyPicture};
use plotters::prelude::DrawingBackend;

/// Pixels of the sheet between pictures, and below them for the label [pixels].
const GAP: f64 = 8.0;
const LABEL: f64 = 28.0;

/// How much larger a picture is shown on the sheet [pixels], and in the bitmap, which has half as many again.
const LARGER: f64 = 2.0;
const PIXELS: usize = 3;

/// The share of the last picture's pixels that are not clipped.
const UNCLIPPED: f64 = 0.93;

/// The strip as pixels; `None` without a picture.
pub(super) fn strip(strip: &Strip) -> Drawn<Option<Bitmap>> {
    let Some(last) = strip.pictures.last() else { return Ok(None) };
    let exposure = exposure(last);
    let mut all = bitmap(&Labels(strip))?;
    let side = PICTURE_SIZE as usize;
    for (number, picture) in strip.pictures.iter().enumerate() {
        let left = (1.5 * (GAP + number as f64 * (LARGER * f64::from(PICTURE_SIZE) + GAP))) as usize;
        let top = (1.5 * GAP) as usize;
        for (index, &radiance) in picture.radiance.iter().enumerate() {
            let colour = pixel(radiance, exposure, ToneCurve::Clip);
            let (row, column) = (index / side, index % side);
            for (y, x) in (0..PIXELS).flat_map(|y| (0..PIXELS).map(move |x| (y, x))) {
                let place = (top + row * PIXELS + y) * all.size[0] as usize + left + column * PIXELS + x;
                if let Some(target) = all.pixels.get_mut(3 * place..3 * place + 3) {
                    target.copy_from_slice(&colour);
                }
            }
        }
    }
    Ok(Some(all))
}

/// What radiance is multiplied by [m²/cd].
fn exposure(picture: &StudyPicture) -> f64 {
    let mut values: Vec<f64> = picture.radiance.iter().map(|&radiance| luminance(radiance)).collect();
    values.sort_by(f64::total_cmp);
    let white = values.get((UNCLIPPED * values.len() as f64) as usize).copied().unwrap_or(0.0);
    if white > 0.0 { 0.85 / white } else { 0.0 }
}

/// What is written below the pictures.
struct Labels<'a>(&'a Strip);

impl Drawing for Labels<'_> {
    fn size(&self) -> [f64; 2] {
        let side = LARGER * f64::from(PICTURE_SIZE);
        let count = self.0.pictures.len() as f64;
        [GAP + count * (side + GAP), GAP + side + LABEL]
    }

    fn draw<B: DrawingBackend>(&self, sheet: &Sheet<'_, B>) -> Drawn {
        let side = LARGER * f64::from(PICTURE_SIZE);
        for (number, picture) in self.0.pictures.iter().enumerate() {
            let middle = GAP + number as f64 * (side + GAP) + 0.5 * side;
            let samples = grouped(f64::from(picture.samples));
            let text = if number == 0 { format!("{samples} samples per pixel") } else { samples };
            sheet.text(text, [middle, GAP + side + 0.5 * LABEL], &Words::new(14.0).centred())?;
        }
        Ok(())
    }
}

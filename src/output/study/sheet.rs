//! A sheet to draw on, in pixels, that becomes an SVG or a PNG: the few shapes that a study's plots are made of. Knows
//! nothing of studies.
//!
//! Plotters has backends for both and no more of it is used: letters by `ab_glyph`, which needs no library of the
//! system, from fonts that come along in `assets/fonts`. Its pictures have hard edges, so they are drawn larger and
//! averaged.

use plotters::coord::Shift;
use plotters::prelude::{
    BitMapBackend, Circle, DrawingArea, DrawingBackend, FontDesc, FontFamily, FontStyle, FontTransform,
    IntoDrawingArea, PathElement, Polygon, RGBColor, SVGBackend, TextStyle, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, register_font};
use std::fmt::Display;

/// What a drawing that failed says.
pub(super) type Drawn<T = ()> = Result<T, String>;

/// Units of an SVG per pixel: its coordinates are whole numbers.
const FINE: f64 = 4.0;

/// Pixels of a PNG per pixel of the sheet, and how many times larger along each side it is drawn.
const DENSE: f64 = 1.5;
const LARGER: usize = 3;

/// By this plotters divides the sizes of letters.
const LETTERS: f64 = 1.24;

const FONT: &str = "Helvetica, Arial, 'DejaVu Sans', sans-serif";
const REGULAR: &[u8] = include_bytes!("../../../assets/fonts/DejaVuSans-subset.ttf");
const BOLD: &[u8] = include_bytes!("../../../assets/fonts/DejaVuSans-Bold-subset.ttf");

const INK: RGBColor = RGBColor(34, 34, 34);
pub(super) const QUIET: RGBColor = RGBColor(95, 95, 95);
pub(super) const GRID: RGBColor = RGBColor(228, 228, 228);
pub(super) const FRAME: RGBColor = RGBColor(140, 140, 140);

/// What can be drawn on a sheet.
pub(super) trait Drawing {
    /// Draws it.
    fn draw<B: DrawingBackend>(&self, sheet: &Sheet<'_, B>) -> Drawn;

    /// Width and height [pixels].
    fn size(&self) -> [f64; 2];
}

/// Eight bits of red, green and blue, row by row.
pub(super) struct Bitmap {
    pub(super) size: [u32; 2],
    pub(super) pixels: Vec<u8>,
}

/// A drawing as an SVG file.
pub(super) fn svg(drawing: &impl Drawing) -> Drawn<String> {
    let [width, height] = drawing.size();
    let [fine_width, fine_height] = [width, height].map(|length| (length * FINE) as u32);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (fine_width, fine_height)).into_drawing_area();
        paint(&area, drawing, FINE)?;
    }
    // The picture's own size is in pixels, whatever units it is drawn in.
    let fine = format!("width=\"{fine_width}\" height=\"{fine_height}\" viewBox");
    Ok(svg.replacen(&fine, &format!("width=\"{width}\" height=\"{height}\" viewBox"), 1))
}

/// A drawing as pixels.
pub(super) fn bitmap(drawing: &impl Drawing) -> Drawn<Bitmap> {
    let [width, height] = drawing.size().map(|length| (length * DENSE) as usize);
    let (large_width, large_height) = (width * LARGER, height * LARGER);
    let mut large = vec![255; 3 * large_width * large_height];
    {
        let backend = BitMapBackend::with_buffer(&mut large, (large_width as u32, large_height as u32));
        paint(&backend.into_drawing_area(), drawing, DENSE * LARGER as f64)?;
    }
    let mut pixels = Vec::with_capacity(3 * width * height);
    for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
        for channel in 0..3 {
            let at = |y: usize, x: usize| 3 * ((row * LARGER + y) * large_width + column * LARGER + x) + channel;
            let cells = (0..LARGER).flat_map(|y| (0..LARGER).map(move |x| (y, x)));
            let sum: usize = cells.map(|(y, x)| usize::from(large[at(y, x)])).sum();
            pixels.push((sum / (LARGER * LARGER)) as u8);
        }
    }
    Ok(Bitmap { size: [width as u32, height as u32], pixels })
}

fn paint<B: DrawingBackend>(area: &DrawingArea<B, Shift>, drawing: &impl Drawing, scale: f64) -> Drawn {
    let letters = [(FontStyle::Normal, REGULAR), (FontStyle::Bold, BOLD)];
    if letters.into_iter().any(|(style, bytes)| register_font(FONT, style, bytes).is_err()) {
        return Err("its fonts cannot be read".into());
    }
    // Opaque, so that it is legible on a dark page too.
    area.fill(&WHITE).map_err(|error| error.to_string())?;
    drawing.draw(&Sheet { area, scale, origin: [0.0; 2] })?;
    area.present().map_err(|error| error.to_string())
}

/// Where a drawing is drawn, in pixels from its own upper left corner.
pub(super) struct Sheet<'a, B: DrawingBackend> {
    area: &'a DrawingArea<B, Shift>,
    scale: f64,
    origin: [f64; 2],
}

/// How a text looks.
#[derive(Clone, Copy)]
pub(super) struct Words {
    size: f64,
    colour: RGBColor,
    weight: FontStyle,
    horizontal: HPos,
    vertical: VPos,
    turned: bool,
}

impl Words {
    /// Of a height [pixels].
    pub(super) fn new(size: f64) -> Self {
        let (horizontal, vertical) = (HPos::Left, VPos::Center);
        Self { size, colour: INK, weight: FontStyle::Normal, horizontal, vertical, turned: false }
    }

    pub(super) fn bold(self) -> Self {
        Self { weight: FontStyle::Bold, ..self }
    }

    pub(super) fn colour(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }

    pub(super) fn centred(self) -> Self {
        Self { horizontal: HPos::Center, ..self }
    }

    pub(super) fn to_the_left(self) -> Self {
        Self { horizontal: HPos::Right, ..self }
    }

    /// Read upwards.
    pub(super) fn turned(self) -> Self {
        Self { turned: true, ..self }
    }
}

/// Shape of a curve's marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    Disc,
    Square,
    Triangle,
    Diamond,
    Wedge,
}

impl<B: DrawingBackend> Sheet<'_, B> {
    /// The same with its corner elsewhere.
    pub(super) fn at(&self, x: f64, y: f64) -> Self {
        Self { area: self.area, scale: self.scale, origin: [self.origin[0] + x, self.origin[1] + y] }
    }

    fn place(&self, [x, y]: [f64; 2]) -> (i32, i32) {
        (((self.origin[0] + x) * self.scale).round() as i32, ((self.origin[1] + y) * self.scale).round() as i32)
    }

    pub(super) fn text(&self, text: impl Display, at: [f64; 2], words: &Words) -> Drawn {
        let font = FontDesc::new(FontFamily::Name(FONT), words.size * self.scale * LETTERS, words.weight);
        let turn = if words.turned { FontTransform::Rotate270 } else { FontTransform::None };
        let style =
            TextStyle::from(font.transform(turn)).color(&words.colour).pos(Pos::new(words.horizontal, words.vertical));
        self.area.draw_text(&text.to_string(), &style, self.place(at)).map_err(|error| error.to_string())
    }

    pub(super) fn line(&self, points: &[[f64; 2]], colour: RGBColor, width: f64) -> Drawn {
        let points: Vec<(i32, i32)> = points.iter().map(|&point| self.place(point)).collect();
        let stroke = colour.stroke_width((width * self.scale).round().max(1.0) as u32);
        self.area.draw(&PathElement::new(points, stroke)).map_err(|error| error.to_string())
    }

    /// A line of dashes between two points.
    pub(super) fn dashes(&self, from: [f64; 2], to: [f64; 2], colour: RGBColor) -> Drawn {
        let along = [to[0] - from[0], to[1] - from[1]];
        let count = ((along[0].abs() + along[1].abs()) / 12.0).ceil().max(1.0);
        let at = |share: f64| [from[0] + share * along[0], from[1] + share * along[1]];
        (0..count as u32)
            .map(f64::from)
            .try_for_each(|dash| self.line(&[at(dash / count), at((dash + 0.55) / count)], colour, 1.3))
    }

    pub(super) fn mark(&self, mark: Mark, at: [f64; 2], colour: RGBColor) -> Drawn {
        let around = |corners: &[[f64; 2]]| {
            let corners = corners.iter().map(|[x, y]| self.place([at[0] + x, at[1] + y]));
            let polygon = Polygon::new(corners.collect::<Vec<_>>(), colour.filled());
            self.area.draw(&polygon).map_err(|error| error.to_string())
        };
        match mark {
            Mark::Disc => {
                let disc = Circle::new(self.place(at), (3.6 * self.scale) as i32, colour.filled());
                self.area.draw(&disc).map_err(|error| error.to_string())
            }
            Mark::Square => around(&[[-3.2, -3.2], [3.2, -3.2], [3.2, 3.2], [-3.2, 3.2]]),
            Mark::Triangle => around(&[[-4.2, 3.3], [4.2, 3.3], [0.0, -4.4]]),
            Mark::Diamond => around(&[[-4.6, 0.0], [0.0, -4.6], [4.6, 0.0], [0.0, 4.6]]),
            Mark::Wedge => around(&[[-4.2, -3.3], [4.2, -3.3], [0.0, 4.4]]),
        }
    }
}

//! Draws sweeps as SVG: one by itself, or all as a grid of small panels with one legend. Both axes logarithmic; what
//! lies beyond an axis is drawn on its edge.

use crate::sweep::{Axis, Curve, Side, Sweep};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Units of the drawing per pixel: its coordinates are whole numbers.
const FINE: f64 = 4.0;

/// Size of a panel [pixels].
const PANEL: [f64; 2] = [400.0, 300.0];

/// Its margins around the plot's own square: left, top, right, bottom [pixels].
const MARGINS: [f64; 4] = [58.0, 40.0, 18.0, 50.0];

const COLUMNS: usize = 3;

/// Sizes of a panel's title, of labels, and of the axes' numbers [pixels].
const TITLE: f64 = 16.0;
const LABEL: f64 = 13.5;
const NUMBER: f64 = 12.0;

/// Height of the headline over the panels [pixels].
const HEADLINE: f64 = 78.0;

const FONT: &str = "Helvetica, Arial, 'DejaVu Sans', sans-serif";

// Blue and vermilion of Okabe and Ito's palette, which the colour-blind tell apart.
const OURS: RGBColor = RGBColor(0, 114, 178);
const NAIVE: RGBColor = RGBColor(204, 78, 0);
const INK: RGBColor = RGBColor(34, 34, 34);
const QUIET: RGBColor = RGBColor(105, 105, 105);
const GRID: RGBColor = RGBColor(230, 230, 230);
const FRAME: RGBColor = RGBColor(150, 150, 150);

/// One sweep.
pub fn one(sweep: &Sweep) -> Result<String> {
    draw(PANEL, |sheet| sheet.at(0.0, 0.0).panel(sweep))
}

/// All sweeps and the legend.
pub fn all(sweeps: &[Sweep]) -> Result<String> {
    let rows = (sweeps.len() + 1).div_ceil(COLUMNS);
    let size = [PANEL[0] * COLUMNS as f64, HEADLINE + PANEL[1] * rows as f64];
    draw(size, |sheet| {
        sheet.text("Hard cases, harder and harder", [20.0, 28.0], &Words::new(23.0).bold())?;
        let about = "Relative error of the light, measured against closed forms.";
        sheet.text(about, [20.0, 56.0], &Words::new(LABEL).colour(QUIET))?;
        let place = |index: usize| {
            sheet.at(PANEL[0] * (index % COLUMNS) as f64, HEADLINE + PANEL[1] * (index / COLUMNS) as f64)
        };
        for (index, sweep) in sweeps.iter().enumerate() {
            place(index).panel(sweep)?;
        }
        place(sweeps.len()).legend()
    })
}

/// Draws on a white sheet of so many pixels.
fn draw(size: [f64; 2], paint: impl FnOnce(&Sheet) -> Result<()>) -> Result<String> {
    let [width, height] = size.map(|length| (length * FINE) as u32);
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
        area.fill(&WHITE)?;
        paint(&Sheet { area: &area, origin: [0.0; 2] })?;
        area.present()?;
    }
    // The picture's own size is in pixels, whatever units it is drawn in.
    let fine = format!("width=\"{width}\" height=\"{height}\" viewBox");
    Ok(svg.replacen(&fine, &format!("width=\"{}\" height=\"{}\" viewBox", size[0], size[1]), 1))
}

/// A part of the drawing, in pixels from its own upper left corner.
struct Sheet<'a, 'b> {
    area: &'a DrawingArea<SVGBackend<'b>, Shift>,
    origin: [f64; 2],
}

/// How a text looks.
struct Words {
    size: f64,
    colour: RGBColor,
    weight: FontStyle,
    horizontal: HPos,
    vertical: VPos,
    turned: FontTransform,
}

impl Words {
    fn new(size: f64) -> Self {
        Self {
            size,
            colour: INK,
            weight: FontStyle::Normal,
            horizontal: HPos::Left,
            vertical: VPos::Center,
            turned: FontTransform::None,
        }
    }

    fn bold(self) -> Self {
        Self { weight: FontStyle::Bold, ..self }
    }

    fn colour(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }

    fn anchored(self, horizontal: HPos, vertical: VPos) -> Self {
        Self { horizontal, vertical, ..self }
    }
}

/// Shape of a curve's marks.
#[derive(Clone, Copy)]
enum Mark {
    Disc,
    Square,
    Triangle,
}

impl Sheet<'_, '_> {
    fn at(&self, x: f64, y: f64) -> Self {
        Self { area: self.area, origin: [self.origin[0] + x, self.origin[1] + y] }
    }

    fn whole(&self, [x, y]: [f64; 2]) -> (i32, i32) {
        (((self.origin[0] + x) * FINE).round() as i32, ((self.origin[1] + y) * FINE).round() as i32)
    }

    fn text(&self, text: &str, at: [f64; 2], words: &Words) -> Result<()> {
        // Plotters divides by 1.24.
        let font = FontDesc::new(FontFamily::Name(FONT), words.size * FINE * 1.24, words.weight);
        let style = TextStyle::from(font.transform(words.turned.clone()))
            .color(&words.colour)
            .pos(Pos::new(words.horizontal, words.vertical));
        self.area.draw_text(text, &style, self.whole(at))?;
        Ok(())
    }

    fn line(&self, points: &[[f64; 2]], colour: RGBColor, width: f64) -> Result<()> {
        let points: Vec<(i32, i32)> = points.iter().map(|&point| self.whole(point)).collect();
        self.area.draw(&PathElement::new(points, colour.stroke_width((width * FINE) as u32)))?;
        Ok(())
    }

    fn mark(&self, mark: Mark, at: [f64; 2], colour: RGBColor) -> Result<()> {
        let around = |corners: &[[f64; 2]]| {
            let corners = corners.iter().map(|[x, y]| self.whole([at[0] + x, at[1] + y]));
            Polygon::new(corners.collect::<Vec<_>>(), colour.filled())
        };
        match mark {
            Mark::Disc => self.area.draw(&Circle::new(self.whole(at), (3.4 * FINE) as i32, colour.filled()))?,
            Mark::Square => self.area.draw(&around(&[[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]]))?,
            Mark::Triangle => self.area.draw(&around(&[[-4.0, 3.2], [4.0, 3.2], [0.0, -4.2]]))?,
        }
        Ok(())
    }

    /// A sweep with its axes and its title.
    fn panel(&self, sweep: &Sweep) -> Result<()> {
        let [left, top, right, bottom] = MARGINS;
        let square = self.at(left, top);
        let size = [PANEL[0] - left - right, PANEL[1] - top - bottom];
        self.text(sweep.title, [left, 22.0], &Words::new(TITLE).bold())?;
        square.grid(sweep, size)?;
        let mut marks = [Mark::Square, Mark::Triangle].into_iter().cycle();
        // Ours last, on top.
        let (ours, naive): (Vec<&Curve>, Vec<&Curve>) = sweep.curves.iter().partition(|curve| curve.side == Side::Ours);
        for curve in naive {
            let mark = marks.next().unwrap_or(Mark::Square);
            square.curve(sweep, curve, size, (mark, NAIVE))?;
        }
        for curve in ours {
            square.curve(sweep, curve, size, (Mark::Disc, OURS))?;
        }
        Ok(())
    }

    fn grid(&self, sweep: &Sweep, size: [f64; 2]) -> Result<()> {
        let [width, height] = size;
        let (across, up) = (&sweep.difficulty, &sweep.error);
        for power in across.powers() {
            let x = width * across.share(10_f64.powi(power));
            self.line(&[[x, 0.0], [x, height]], GRID, 1.0)?;
            let words = Words::new(NUMBER).colour(QUIET).anchored(HPos::Center, VPos::Top);
            self.text(&power_of_ten(power), [x, height + 6.0], &words)?;
        }
        for power in up.powers() {
            let y = height * (1.0 - up.share(10_f64.powi(power)));
            self.line(&[[0.0, y], [width, y]], if power == 0 { FRAME } else { GRID }, 1.0)?;
            let words = Words::new(NUMBER).colour(QUIET).anchored(HPos::Right, VPos::Center);
            self.text(&power_of_ten(power), [-6.0, y], &words)?;
        }
        self.line(&[[0.0, 0.0], [0.0, height], [width, height]], FRAME, 1.25)?;
        let words = Words::new(LABEL).anchored(HPos::Center, VPos::Top);
        self.text(across.title, [0.5 * width, height + 25.0], &words)?;
        let turned =
            Words { turned: FontTransform::Rotate270, ..Words::new(LABEL).anchored(HPos::Center, VPos::Center) };
        self.text(up.title, [-46.0, 0.5 * height], &turned)
    }

    fn curve(&self, sweep: &Sweep, curve: &Curve, [width, height]: [f64; 2], look: (Mark, RGBColor)) -> Result<()> {
        let (mark, colour) = look;
        let place = |(difficulty, error): (&f64, &f64)| {
            let x = sweep.difficulty.share(*difficulty);
            // No number is worse than any.
            let y = if error.is_nan() { 1.0 } else { sweep.error.share(*error).clamp(0.0, 1.0) };
            [width * x, height * (1.0 - y)]
        };
        let points: Vec<[f64; 2]> = sweep.difficulties.iter().zip(&curve.errors).map(place).collect();
        self.line(&points, colour, 2.0)?;
        for &point in &points {
            self.mark(mark, point, colour)?;
        }
        let [x, y] = [width * curve.label[0], height * (1.0 - curve.label[1])];
        self.mark(mark, [x, y], colour)?;
        self.text(curve.name, [x + 9.0, y], &Words::new(LABEL).bold().colour(colour))
    }

    /// What the panels have in common.
    fn legend(&self) -> Result<()> {
        let left = MARGINS[0];
        self.text("How to read this", [left, 22.0], &Words::new(TITLE).bold())?;
        let lines = [
            (&[Mark::Disc][..], OURS, "bevy_kiln"),
            (&[Mark::Square, Mark::Triangle][..], NAIVE, "other bakers and textbooks"),
        ];
        for (row, (marks, colour, name)) in lines.into_iter().enumerate() {
            let y = 54.0 + 24.0 * row as f64;
            self.line(&[[left, y], [left + 40.0, y]], colour, 2.0)?;
            for (index, &mark) in marks.iter().enumerate() {
                let x = left + 40.0 * (index as f64 + 1.0) / (marks.len() as f64 + 1.0);
                self.mark(mark, [x, y], colour)?;
            }
            self.text(name, [left + 50.0, y], &Words::new(LABEL).bold().colour(colour))?;
        }
        let lines = [
            "Each panel makes one thing harder to the right;",
            "the room is hard at both ends. Both sides get",
            "the same number of samples.",
            "1 is an error as large as the light itself:",
            "all of it lost, or as much again made up.",
            "A mark on the lower edge lies below it.",
            "Where theirs does better, the tables say so.",
        ];
        for (row, line) in lines.into_iter().enumerate() {
            self.text(line, [left, 116.0 + 22.0 * row as f64], &Words::new(LABEL).colour(INK))?;
        }
        Ok(())
    }
}

impl Axis {
    /// Where a value lies, from 0 where the axis begins to 1 where it ends.
    fn share(&self, value: f64) -> f64 {
        let [from, to] = self.decades.map(f64::from);
        (value.log10() - from) / (to - from)
    }

    /// Powers of ten that are numbered.
    fn powers(&self) -> impl Iterator<Item = i32> {
        let [from, to] = self.decades;
        let (low, high, step) = (from.min(to), from.max(to), self.step);
        (low..=high).filter(move |power| power.rem_euclid(step) == 0)
    }
}

/// A power of ten as people write it.
fn power_of_ten(power: i32) -> String {
    if power == 0 {
        return "1".into();
    }
    let raised = |digit: char| match digit {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        _ => '⁹',
    };
    let power: String = power.to_string().chars().map(raised).collect();
    format!("10{power}")
}

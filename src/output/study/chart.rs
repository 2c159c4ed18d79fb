//! The plots of a study: errors of its techniques on logarithmic axes, each line labelled at its end.

use super::sheet::{Drawing, Drawn, FRAME, GRID, Mark, QUIET, Sheet, Words};
use super::words::{grouped, percent, round, time};
use crate::math::Portable;
use crate::study::{Curve, Point, Standing, Study, Technique};
use plotters::prelude::{DrawingBackend, RGBColor};

/// Size of a plot, and its margins: left, top, right, bottom [pixels].
const SIZE: [f64; 2] = [960.0, 560.0];
const MARGINS: [f64; 4] = [82.0, 78.0, 270.0, 64.0];

/// Sizes of letters [pixels].
const TITLE: f64 = 19.0;
const LABEL: f64 = 14.5;
const NUMBER: f64 = 13.5;

/// Least distance between two labels [pixels].
const APART: f64 = 19.0;

/// Which curves a plot shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Subject {
    /// Every technique that leads to the truth, and the denoiser, over processor time.
    Time,
    /// The same over paths.
    Paths,
    /// Roulette against caps on bounces, over processor time.
    Bounces,
}

impl Subject {
    pub(super) const ALL: [Self; 3] = [Self::Time, Self::Paths, Self::Bounces];

    /// Its file's name without an ending.
    pub(super) fn file(self) -> &'static str {
        match self {
            Self::Time => "error_over_time",
            Self::Paths => "error_over_paths",
            Self::Bounces => "bounces",
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Time => "What accuracy costs",
            Self::Paths => "How far paths go",
            Self::Bounces => "What a cap on bounces costs",
        }
    }

    fn shows(self, technique: Technique) -> bool {
        match self {
            Self::Time | Self::Paths => !matches!(technique, Technique::Capped(_)),
            Self::Bounces => matches!(technique, Technique::Capped(_) | Technique::Mis),
        }
    }

    /// The technique that a bake comes nearest to, of those that are shown.
    fn of_a_bake(self, study: &Study) -> Technique {
        match self {
            Self::Time | Self::Paths => study.of_a_bake(),
            Self::Bounces => Technique::Mis,
        }
    }

    fn across(self, point: &Point) -> f64 {
        match self {
            Self::Paths => f64::from(point.paths),
            Self::Time | Self::Bounces => point.cpu_seconds,
        }
    }

    fn label(self, technique: Technique) -> String {
        match (self, technique) {
            (Self::Bounces, Technique::Mis) => "roulette, no cap".into(),
            _ => technique.name(),
        }
    }
}

/// A plot of a study.
pub(super) struct Chart<'a> {
    subject: Subject,
    study: &'a Study,
    curves: Vec<&'a Curve>,
    /// Ends of both axes.
    across: [f64; 2],
    up: [f64; 2],
}

impl<'a> Chart<'a> {
    /// `None` where there is nothing to be seen.
    pub(super) fn new(subject: Subject, study: &'a Study) -> Option<Self> {
        let mut curves: Vec<&Curve> = study
            .curves
            .iter()
            .filter(|curve| subject.shows(curve.technique) && known(curve).next().is_some())
            .collect();
        // What a bake does comes last, on top.
        curves.sort_by_key(|curve| {
            (curve.technique == study.of_a_bake(), curve.technique == Technique::Mis, curve.technique)
        });
        let is_told = match subject {
            Subject::Time | Subject::Paths => !curves.is_empty(),
            Subject::Bounces => curves.iter().any(|curve| matches!(curve.technique, Technique::Capped(_))),
        };
        let points = || curves.iter().flat_map(|curve| known(curve));
        let across = ends(points().map(|point| subject.across(point)));
        let up = ends(points().map(|point| point.error));
        let (across, up) = across.zip(up)?;
        is_told.then_some(Self { subject, study, curves, across, up })
    }

    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let [width, height] = plot_size();
        let share = |[from, to]: [f64; 2], value: f64| Portable::ln(value / from) / Portable::ln(to / from);
        [width * share(self.across, point[0]), height * (1.0 - share(self.up, point[1]))]
    }
}

fn plot_size() -> [f64; 2] {
    [SIZE[0] - MARGINS[0] - MARGINS[2], SIZE[1] - MARGINS[1] - MARGINS[3]]
}

/// The points of a curve that can be trusted: those before the first that cannot.
fn known(curve: &Curve) -> impl Iterator<Item = &Point> {
    curve
        .points
        .iter()
        .take_while(|point| point.standing == Standing::Known)
        .filter(|point| point.error > 0.0 && point.cpu_seconds > 0.0)
}

/// Ends of an axis around values, with some room.
fn ends(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    (low <= high && low > 0.0).then_some([low / 1.6, high * 1.6])
}

/// 1, 2 and 5 of every power of ten between the ends of an axis.
fn ticks([from, to]: [f64; 2]) -> Vec<(f64, bool)> {
    let mut decade = 1.0;
    while decade > from {
        decade /= 10.0;
    }
    while 10.0 * decade <= from {
        decade *= 10.0;
    }
    let mut ticks = Vec::new();
    while decade <= to {
        ticks.extend([1.0, 2.0, 5.0].map(|step| (step * decade, step == 1.0)));
        decade *= 10.0;
    }
    ticks.retain(|(tick, _)| (from..=to).contains(tick));
    // Few decades are numbered in between as well.
    let is_long = ticks.iter().filter(|(_, is_decade)| *is_decade).count() > 2;
    ticks.iter().map(|&(tick, is_decade)| (tick, is_decade || !is_long)).collect()
}

/// Colour, width and mark of a line. Colours after Okabe and Ito's palette, which the colour-blind tell apart, darkened
/// where letters need it.
fn look(technique: Technique) -> (RGBColor, f64, Mark) {
    match technique {
        Technique::Mis => (RGBColor(0, 96, 160), 3.2, Mark::Disc),
        Technique::Denoised => (RGBColor(0, 122, 92), 2.4, Mark::Diamond),
        Technique::Reused => (RGBColor(90, 90, 90), 2.4, Mark::Triangle),
        Technique::Shared => (RGBColor(170, 0, 60), 3.2, Mark::Disc),
        Technique::Adaptive => (RGBColor(0, 0, 0), 2.0, Mark::Square),
        Technique::Independent => (RGBColor(150, 70, 120), 2.0, Mark::Wedge),
        // Broad, since what a bake does often lies on top.
        Technique::Light => (RGBColor(150, 104, 0), 6.0, Mark::Square),
        Technique::Naive => (RGBColor(196, 72, 0), 2.0, Mark::Triangle),
        Technique::Capped(0) => (RGBColor(196, 72, 0), 2.0, Mark::Triangle),
        Technique::Capped(1) => (RGBColor(150, 104, 0), 2.0, Mark::Square),
        Technique::Capped(2) => (RGBColor(150, 70, 120), 2.0, Mark::Wedge),
        Technique::Capped(4) => (RGBColor(0, 122, 92), 2.0, Mark::Diamond),
        Technique::Capped(_) => (RGBColor(70, 70, 70), 2.0, Mark::Square),
    }
}

impl Drawing for Chart<'_> {
    fn size(&self) -> [f64; 2] {
        SIZE
    }

    fn draw<B: DrawingBackend>(&self, sheet: &Sheet<'_, B>) -> Drawn {
        let [left, top, ..] = MARGINS;
        sheet.text(self.subject.title(), [left, 26.0], &Words::new(TITLE).bold())?;
        let conditions = &self.study.conditions;
        let about = format!(
            "{} of {} texels held against a reference of {} paths each (own error {})",
            grouped(conditions.receivers as f64),
            grouped(conditions.texels as f64),
            grouped(f64::from(self.study.reference.paths)),
            percent(self.study.reference.error)
        );
        sheet.text(about, [left, 52.0], &Words::new(NUMBER).colour(QUIET))?;
        let plot = sheet.at(left, top);
        self.grid(&plot)?;
        self.guide(&plot)?;
        for curve in &self.curves {
            self.curve(&plot, curve)?;
        }
        self.labels(&plot)
    }
}

impl Chart<'_> {
    fn grid<B: DrawingBackend>(&self, plot: &Sheet<'_, B>) -> Drawn {
        let [width, height] = plot_size();
        for (tick, is_numbered) in ticks(self.across) {
            let [x, _] = self.place([tick, self.up[0]]);
            plot.line(&[[x, 0.0], [x, height]], GRID, if is_numbered { 1.2 } else { 0.6 })?;
            if is_numbered {
                let text = match self.subject {
                    Subject::Paths => grouped(tick),
                    Subject::Time | Subject::Bounces => round(&time(tick)),
                };
                plot.text(text, [x, height + 14.0], &Words::new(NUMBER).colour(QUIET).centred())?;
            }
        }
        for (tick, is_numbered) in ticks(self.up) {
            let [_, y] = self.place([self.across[0], tick]);
            plot.line(&[[0.0, y], [width, y]], GRID, if is_numbered { 1.2 } else { 0.6 })?;
            if is_numbered {
                let text = round(&percent(tick));
                plot.text(text, [-8.0, y], &Words::new(NUMBER).colour(QUIET).to_the_left())?;
            }
        }
        plot.line(&[[0.0, 0.0], [0.0, height], [width, height]], FRAME, 1.3)?;
        let across = match self.subject {
            Subject::Paths => "paths from each texel",
            Subject::Time | Subject::Bounces => "processor time for the whole lightmap",
        };
        plot.text(across, [0.5 * width, height + 42.0], &Words::new(LABEL).centred())?;
        let up = "error: root mean square over the mean";
        plot.text(up, [-66.0, 0.5 * height], &Words::new(LABEL).centred().turned())
    }

    /// The slope of plain Monte Carlo, through the first point of what a bake does.
    fn guide<B: DrawingBackend>(&self, plot: &Sheet<'_, B>) -> Drawn {
        let Some(first) = self.curves.last().and_then(|curve| known(curve).next()) else { return Ok(()) };
        let (x, y) = (self.subject.across(first), 0.62 * first.error);
        let end = self.across[1].min(x * (y / self.up[0]) * (y / self.up[0]));
        if end <= 4.0 * x {
            return Ok(());
        }
        let at = |across: f64| self.place([across, y * (x / across).sqrt()]);
        plot.dashes(at(x), at(end), FRAME)?;
        let [left, top] = at(x);
        plot.text("slope −½", [left - 8.0, top], &Words::new(NUMBER).colour(QUIET).to_the_left())
    }

    fn curve<B: DrawingBackend>(&self, plot: &Sheet<'_, B>, curve: &Curve) -> Drawn {
        let (colour, width, mark) = look(curve.technique);
        let places: Vec<[f64; 2]> =
            known(curve).map(|point| self.place([self.subject.across(point), point.error])).collect();
        plot.line(&places, colour, width)?;
        places.iter().try_for_each(|&place| plot.mark(mark, place, colour))
    }

    /// Names beside the plot at the height of the lines' ends, moved apart where they would touch.
    fn labels<B: DrawingBackend>(&self, plot: &Sheet<'_, B>) -> Drawn {
        let [width, height] = plot_size();
        let end = |curve: &&Curve| {
            let last = known(curve).last()?;
            Some(self.place([self.subject.across(last), last.error]))
        };
        let mut ends: Vec<(&Curve, [f64; 2])> =
            self.curves.iter().filter_map(|curve| Some((*curve, end(curve)?))).collect();
        ends.sort_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
        let wanted: Vec<f64> = ends.iter().map(|(_, [_, y])| *y).collect();
        for ((curve, [x, y]), label) in ends.iter().zip(apart(&wanted, height)) {
            let (colour, _, mark) = look(curve.technique);
            plot.line(&[[x + 7.0, *y], [width + 2.0, label], [width + 10.0, label]], colour, 0.7)?;
            plot.mark(mark, [width + 15.0, label], colour)?;
            let words = Words::new(LABEL).colour(colour);
            let words = if curve.technique == self.subject.of_a_bake(self.study) { words.bold() } else { words };
            plot.text(self.subject.label(curve.technique), [width + 24.0, label], &words)?;
        }
        Ok(())
    }
}

/// Heights as near as may be to those wanted, which are in order, but no closer than labels need and not below `most`.
fn apart(wanted: &[f64], most: f64) -> Vec<f64> {
    let mut heights = wanted.to_vec();
    for index in 1..heights.len() {
        heights[index] = heights[index].max(heights[index - 1] + APART);
    }
    let mut below = most + APART;
    for height in heights.iter_mut().rev() {
        *height = height.min(below - APART);
        below = *height;
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_do_not_touch_and_stay_on_the_plot() {
        assert_eq!(apart(&[10.0, 100.0], 400.0), [10.0, 100.0]);
        assert_eq!(apart(&[10.0, 12.0, 200.0], 400.0), [10.0, 10.0 + APART, 200.0]);
        let at_the_end = apart(&[390.0, 395.0, 400.0], 400.0);
        assert_eq!(at_the_end, [400.0 - 2.0 * APART, 400.0 - APART, 400.0]);
    }

    #[test]
    fn axes_have_ticks_of_one_two_five() {
        let of = |from: f64, to: f64| ticks([from, to]);
        let near = of(0.15, 1.2);
        assert_eq!(near.len(), 3);
        assert!(near.iter().all(|(_, is_numbered)| *is_numbered));
        let far = of(0.5, 3000.0);
        assert_eq!(far.iter().filter(|(_, is_numbered)| *is_numbered).count(), 4);
    }
}

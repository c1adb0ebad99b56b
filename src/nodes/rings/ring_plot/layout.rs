//! Where the lines of a plot lie: axes, ticks, figures and the widths of the rings.

use super::drawing::{Ink, Line};
use super::letters;
use crate::value::RingSeries;
use libm::{floor, log10, pow};

/// A plot's frame: the piece in mm, and the part of it that years and widths span.
struct Frame {
    left: f64,
    right: f64,
    bottom: f64,
    top: f64,
    /// Calendar years at the left and the right end.
    years: [f64; 2],
    /// Width in mm at the top; 0 is at the bottom.
    most: f64,
    /// The height of a figure in mm.
    text: f64,
}

/// The lines of the plot of a series on a piece of this size in mm.
pub(super) fn lines(series: &RingSeries, size: [f64; 2]) -> Vec<Line> {
    let widths = series.widths();
    let frame = Frame::new(series, &widths, size);
    let mut lines = frame.level_lines();
    let point = |(year, width): (usize, &f64)| {
        frame.point(f64::from(series.first_year) + year as f64, *width)
    };
    let points: Vec<[f64; 2]> = widths.iter().enumerate().map(point).collect();
    // A single year is a dot.
    let last = points[points.len() - 1];
    lines.push(Line::new(Ink::Curve, [last, last], 0.08 * frame.text));
    let joined = points.windows(2).map(|pair| [pair[0], pair[1]]);
    lines.extend(joined.map(|ends| Line::new(Ink::Curve, ends, 0.08 * frame.text)));
    frame.add_axes(&mut lines);
    lines
}

/// 1, 2 or 5 times a power of ten: the least step with which `span` has at most `most` of them.
fn step(span: f64, most: f64) -> f64 {
    let least = span / most;
    let unit = pow(10.0, floor(log10(least)));
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * unit);
    let found = steps.into_iter().find(|step| *step >= least * (1.0 - 1e-9));
    found.unwrap_or(10.0 * unit)
}

/// The multiples of a step from `low` to `high`.
fn multiples(step: f64, [low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
    let first = -floor(-low / step);
    let count = floor(high / step + 1e-9) - first;
    (0..=count.max(-1.0) as i64).map(move |index| step * (first + index as f64))
}

/// A number without more decimals than its step has.
fn shown(number: f64, step: f64) -> String {
    let decimals = (-floor(log10(step) + 1e-9)).max(0.0) as usize;
    format!("{number:.decimals$}")
}

impl Frame {
    fn new(series: &RingSeries, widths: &[f64], [width, height]: [f64; 2]) -> Frame {
        let text = (0.028 * height).min(0.014 * width);
        let first = f64::from(series.first_year);
        // A single year has a year's room.
        let last = first + (series.years() as f64 - 1.0).max(1.0);
        Frame {
            left: 6.0 * text,
            right: width - 2.5 * text,
            bottom: 5.0 * text,
            top: height - 4.5 * text,
            years: [first, last],
            most: 1.05 * widths.iter().copied().fold(0.0, f64::max),
            text,
        }
    }

    fn point(&self, year: f64, width: f64) -> [f64; 2] {
        let [first, last] = self.years;
        [
            self.left + (self.right - self.left) * (year - first) / (last - first),
            self.bottom + (self.top - self.bottom) * width / self.most,
        ]
    }

    fn levels(&self) -> (f64, impl Iterator<Item = f64>) {
        let step = step(self.most, 7.0);
        (step, multiples(step, [0.0, self.most]))
    }

    /// Faint lines at the marked widths.
    fn level_lines(&self) -> Vec<Line> {
        let (_, levels) = self.levels();
        let line = |level: f64| {
            let [_, height] = self.point(self.years[0], level);
            let ends = [[self.left, height], [self.right, height]];
            Line::new(Ink::Faint, ends, 0.025 * self.text)
        };
        levels.skip(1).map(line).collect()
    }

    fn add_axes(&self, lines: &mut Vec<Line>) {
        let (corner, tick) = ([self.left, self.bottom], 0.5 * self.text);
        let mut draw = |from: [f64; 2], to: [f64; 2]| {
            lines.push(Line::new(Ink::Black, [from, to], 0.045 * self.text));
        };
        draw(corner, [self.right, self.bottom]);
        draw(corner, [self.left, self.top]);
        let (level_step, levels) = self.levels();
        let levels: Vec<f64> = levels.collect();
        for level in &levels {
            let [_, height] = self.point(self.years[0], *level);
            draw([self.left - tick, height], [self.left, height]);
        }
        // A year's figures are some 4 text heights wide.
        let room = ((self.right - self.left) / (6.0 * self.text)).max(1.0);
        let year_step = step(self.years[1] - self.years[0], room).max(1.0);
        let years: Vec<f64> = multiples(year_step, self.years).collect();
        for year in &years {
            let [across, _] = self.point(*year, 0.0);
            draw([across, self.bottom - tick], [across, self.bottom]);
        }
        for level in levels {
            let [_, height] = self.point(self.years[0], level);
            let label = shown(level, level_step);
            let start = self.left - 2.0 * tick - self.wide(&label);
            self.write(&label, [start, height - 0.5 * self.text], lines);
        }
        for year in years {
            let [across, _] = self.point(year, 0.0);
            let label = shown(year, year_step);
            let start = across - 0.5 * self.wide(&label);
            self.write(&label, [start, self.bottom - 2.3 * self.text], lines);
        }
        self.write(
            "ring width in mm",
            [tick, self.top + 2.0 * self.text],
            lines,
        );
        let start = self.right - self.wide("year");
        self.write("year", [start, 0.8 * self.text], lines);
    }

    /// The width of a text in mm.
    fn wide(&self, text: &str) -> f64 {
        letters::width(text) * self.text / letters::TALL
    }

    /// Writes a text whose line begins at a point.
    fn write(&self, text: &str, [x, y]: [f64; 2], lines: &mut Vec<Line>) {
        let unit = self.text / letters::TALL;
        let place = |[u, v]: [f64; 2]| [x + unit * u, y + unit * v];
        let strokes = letters::lines(text).into_iter();
        lines.extend(strokes.map(|ends| Line::new(Ink::Black, ends.map(place), 0.065 * self.text)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_ticks_their_multiples() {
        assert_eq!(step(167.0, 12.0), 20.0);
        assert_eq!(step(2.1, 7.0), 0.5);
        assert_eq!(step(7.0, 7.0), 1.0);
        let years: Vec<f64> = multiples(20.0, [1853.0, 2020.0]).collect();
        assert_eq!(
            (years[0], years[years.len() - 1], years.len()),
            (1860.0, 2020.0, 9)
        );
        assert_eq!(multiples(50.0, [1910.0, 1940.0]).count(), 0);
        assert_eq!(shown(0.5, 0.5), "0.5");
        assert_eq!(shown(1860.0, 20.0), "1860");
        assert_eq!(shown(0.025, 0.005), "0.025");
    }
}

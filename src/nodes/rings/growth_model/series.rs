//! From the growth of years to sections and heights.

use super::species::Allometry;
use crate::value::RingSeries;
use libm::{pow, sqrt};
use std::f64::consts::PI;

/// Least growth of a year, as a share of the mean: a year that forms no ring at all leaves a trace, so that every
/// year has one.
const TRACE: f64 = 0.01;

/// How a tree of mean growth gets thicker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thickening {
    /// Mean ring width in mm.
    pub ring_width: f64,
    /// 0 for rings of one width, 1 for rings of one area.
    pub slowdown: f64,
}

impl Thickening {
    /// The area S_n in mm² of the section at the end of each year, for growths that are shares of any measure.
    ///
    /// Year n adds `n^p - (n - 1)^p` times its growth, with `p = 2 - slowdown`; then all are scaled so that the last
    /// radius is that of rings of mean width.
    pub fn areas(&self, growths: &[f64]) -> Vec<f64> {
        let years = growths.len() as f64;
        let least = TRACE * growths.iter().sum::<f64>() / years;
        let power = 2.0 - self.slowdown;
        let mut area = 0.0;
        let mut before = 0.0;
        let mut areas = Vec::with_capacity(growths.len());
        for (index, growth) in growths.iter().enumerate() {
            let until = pow(index as f64 + 1.0, power);
            area += (until - before) * growth.max(least);
            before = until;
            areas.push(area);
        }
        let radius = self.ring_width * years;
        let scale = PI * radius * radius / area;
        areas.iter_mut().for_each(|area| *area *= scale);
        areas
    }

    /// The widths of the rings, in mm.
    pub fn widths(&self, growths: &[f64]) -> Vec<f64> {
        let mut before = 0.0;
        let width = |area: f64| {
            let radius = sqrt(area / PI);
            radius - std::mem::replace(&mut before, radius)
        };
        self.areas(growths).into_iter().map(width).collect()
    }
}

/// The series of a tree whose section has these areas in mm² at the end of each year.
pub fn series(first_year: i32, areas: Vec<f64>, allometry: &Allometry) -> RingSeries {
    let height = |area: &f64| {
        let diameter = 2.0 * sqrt(area / PI) / 10.0;
        1000.0 * allometry.height(diameter)
    };
    let heights = areas.iter().map(height).collect();
    RingSeries {
        first_year,
        areas,
        heights,
    }
}

/// What reserves make of growth: each year keeps a share `kept` of the year before, the first one of a mean year.
pub fn with_reserves(growths: &[f64], kept: f64) -> Vec<f64> {
    let mean = growths.iter().sum::<f64>() / growths.len() as f64;
    let next = |before: &mut f64, growth: &f64| {
        *before = (1.0 - kept) * growth + kept * *before;
        Some(*before)
    };
    growths.iter().scan(mean, next).collect()
}

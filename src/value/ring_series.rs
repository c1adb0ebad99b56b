//! Ring series: how a tree grew, year by year.

use serde::{Deserialize, Serialize};

/// The size of a tree at the end of each year of its life.
///
/// Time is counted in years of growth: ring n, counted from 1, is the wood between the times n - 1 and n, and it is
/// that of the calendar year `first_year + n - 1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RingSeries {
    /// The calendar year of the first ring.
    pub first_year: i32,
    /// Area S_n of the trunk's section in mm² at the end of each year, at the ground; rises strictly from above 0.
    pub areas: Vec<f64>,
    /// Height H_n of the tree in mm at the end of each year; rises strictly from above 0. As many as areas.
    pub heights: Vec<f64>,
}

/// Most years of a series, how far from year 0 it begins, largest area in mm² and largest height in mm.
const MOST_YEARS: usize = 100_000;
const FARTHEST_YEAR: u32 = 10_000;
const LARGEST: f64 = 1e12;

impl RingSeries {
    /// Whether it is what nodes make: finite, with at least one year, rising.
    pub fn is_sound(&self) -> bool {
        let rises = |values: &[f64]| {
            values[0] > 0.0
                && values[values.len() - 1] <= LARGEST
                && values.windows(2).all(|pair| pair[0] < pair[1])
        };
        (1..=MOST_YEARS).contains(&self.areas.len())
            && self.areas.len() == self.heights.len()
            && self.first_year.unsigned_abs() <= FARTHEST_YEAR
            && rises(&self.areas)
            && rises(&self.heights)
    }

    /// Number of rings.
    pub fn years(&self) -> usize {
        self.areas.len()
    }

    /// Radius R_n in mm at the end of each year, Shibasaki & Aoyama, eq. (1): `sqrt(S_n / pi)`.
    pub fn radii(&self) -> impl Iterator<Item = f64> {
        let areas = self.areas.iter();
        areas.map(|area| (area / std::f64::consts::PI).sqrt())
    }

    /// Widths of the rings in mm.
    pub fn widths(&self) -> Vec<f64> {
        let mut before = 0.0;
        let width = |radius: f64| radius - std::mem::replace(&mut before, radius);
        self.radii().map(width).collect()
    }

    /// The time in years at which the section's area was `area` mm²: linear in area within a year, from 0 at the
    /// pith; beyond the last ring as fast as in the last year.
    pub fn time_of_area(&self, area: f64) -> f64 {
        time_of(&self.areas, area)
    }

    /// The time in years at which the tree was `height` mm tall: linear in height within a year, from 0 at the
    /// ground; beyond the top as fast as in the last year.
    pub fn time_of_height(&self, height: f64) -> f64 {
        time_of(&self.heights, height)
    }

    /// The section's area in mm² at `time` years; the inverse of [`RingSeries::time_of_area`].
    pub fn area_at(&self, time: f64) -> f64 {
        let last = self.areas.len() - 1;
        let ring = (time.max(0.0) as usize).min(last);
        let before = if ring == 0 { 0.0 } else { self.areas[ring - 1] };
        before + (time - ring as f64) * (self.areas[ring] - before)
    }

    /// The time in years at which the wood `radius` mm from the pith grew, `height` mm above the ground.
    ///
    /// There ring n reaches to `sqrt((S_n - S_m) / pi)`, where m is the time at which the tree reached that height.
    pub fn time_at(&self, radius: f64, height: f64) -> f64 {
        let tip = self.time_of_height(height);
        self.time_of_area(self.area_at(tip) + std::f64::consts::PI * radius * radius)
    }
}

/// Where `value` lies among values that rise, linear between them, from 0; beyond the ends straight on.
fn time_of(ends: &[f64], value: f64) -> f64 {
    let ring = ends
        .partition_point(|end| *end <= value)
        .min(ends.len() - 1);
    let before = if ring == 0 { 0.0 } else { ends[ring - 1] };
    ring as f64 + (value - before) / (ends[ring] - before)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series() -> RingSeries {
        RingSeries {
            first_year: 1990,
            areas: vec![3.0, 5.0, 6.0, 10.0],
            heights: vec![2.0, 3.0, 5.0, 6.0],
        }
    }

    #[test]
    fn times_are_linear_in_area_and_go_on_beyond_the_bark() {
        let times = [
            (0.0, 0.0),
            (0.5, 0.2617993877991494),
            (1.4, 3.0393804002589984),
            (2.5, 6.408738521234051),
        ];
        for (radius, time) in times {
            let found = series().time_at(radius, 0.0);
            assert!((found - time).abs() < 1e-12, "{radius}: {found}");
        }
        assert_eq!(series().time_of_height(4.0), 2.5);
        assert_eq!(series().time_of_height(-1.0), -0.5);
    }

    #[test]
    fn higher_up_rings_begin_later_and_lie_closer_to_the_pith() {
        // The tree is 3 mm tall after 2 years: there S_m = 5 mm².
        let outside = ((10.0 - 5.0) / std::f64::consts::PI).sqrt();
        assert_eq!(series().time_at(0.0, 3.0), 2.0);
        assert!((series().time_at(outside, 3.0) - 4.0).abs() < 1e-12);
        for time in [0.0, 0.3, 1.0, 2.5, 4.0, 7.0] {
            let back = series().time_of_area(series().area_at(time));
            assert!((back - time).abs() < 1e-12);
        }
    }

    #[test]
    fn only_what_nodes_make_is_sound() {
        assert!(series().is_sound());
        let unsound: [fn(&mut RingSeries); 7] = [
            |it| it.first_year = i32::MAX,
            |it| it.areas.clear(),
            |it| it.heights.truncate(3),
            |it| it.areas[0] = 0.0,
            |it| it.areas[1] = 3.0,
            |it| it.heights[3] = f64::NAN,
            |it| it.areas[3] = f64::INFINITY,
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            let mut changed = series();
            change(&mut changed);
            assert!(!changed.is_sound(), "{number}");
        }
    }
}

//! Growth by the month: VS-Lite (Tolwinski-Ward et al. 2011), in double precision.
//!
//! A month's growth is `gE min(gT, gM)`: light, times the scarcer of warmth and moisture, each a ramp between two
//! thresholds. Light is that of the day's length and the sun's height, as a share of the year's best day; with
//! hours n of sunshine, of N hours of daylight, it is multiplied by `(0.25 + 0.5 n / N) / 0.75` (Angstrom 1924 and
//! Prescott 1940, with the coefficients of FAO-56). Moisture is a leaky bucket (Huang et al. 1996) that rain fills
//! and that evaporation (Thornthwaite 1948) empties.

use crate::value::{Climate, Month};
use libm::{acos, asin, cos, pow, sin, tan};
use std::f64::consts::PI;

/// Days of the months.
pub const DAYS: [f64; 12] = [
    31.0, 28.0, 31.0, 30.0, 31.0, 30.0, 31.0, 31.0, 30.0, 31.0, 30.0, 31.0,
];

/// Where growth begins and where it is no longer held back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// T1 and T2 in degrees Celsius.
    pub temperature: [f64; 2],
    /// M1 and M2, soil moisture as a share of volume.
    pub moisture: [f64; 2],
}

/// From 0 at the first threshold to 1 at the second.
fn ramp(value: f64, [low, high]: [f64; 2]) -> f64 {
    ((value - low) / (high - low)).clamp(0.0, 1.0)
}

/// gE: the light of each month at a latitude in degrees, as a share of that of the year's best day.
pub fn light(latitude: f64) -> [f64; 12] {
    let phi = latitude.to_radians();
    let of_day = |day: u32| {
        let sine = sin(23.5_f64.to_radians()) * sin((f64::from(day) - 80.0) * PI / 180.0);
        let delta = asin(sine);
        let half_day = acos((-tan(phi) * tan(delta)).clamp(-1.0, 1.0));
        half_day * sin(phi) * sin(delta) + cos(phi) * cos(delta) * sin(half_day)
    };
    let days: Vec<f64> = (1..=365).map(of_day).collect();
    let most = days.iter().copied().fold(0.0, f64::max);
    let mut rest = days.as_slice();
    DAYS.map(|count| {
        let (month, later) = rest.split_at(count as usize);
        rest = later;
        month.iter().sum::<f64>() / count / most
    })
}

/// Hours of daylight in the middle of each month at a latitude in degrees.
pub fn day_lengths(latitude: f64) -> [f64; 12] {
    let slope = tan(latitude.to_radians());
    let mut before = 0.0;
    DAYS.map(|count| {
        let day = before + count / 2.0;
        before += count;
        let tilt = 23.439_f64.to_radians() * cos(PI * day / 182.625);
        24.0 * acos(1.0 - (1.0 - slope * tan(tilt)).clamp(0.0, 2.0)) / PI
    })
}

/// L: how much longer than 30 days of 12 hours each month's daylight lasts at a latitude in degrees.
pub fn day_factors(latitude: f64) -> [f64; 12] {
    let mut factors = day_lengths(latitude);
    for (factor, days) in factors.iter_mut().zip(DAYS) {
        *factor *= days / 30.0 / 12.0;
    }
    factors
}

/// Thornthwaite's constants of a place: the heat index I and the exponent a.
struct Heat {
    index: f64,
    exponent: f64,
}

impl Heat {
    fn new(climate: &Climate) -> Heat {
        let temperatures = climate.months.iter().map(|month| month.temperature);
        let warm = by_month(temperatures)
            .into_iter()
            .filter(|mean| *mean > 0.0);
        let index: f64 = warm.map(|mean| pow(mean / 5.0, 1.514)).sum();
        let cubic = [0.49, 1.79e-2, -7.71e-5, 6.75e-7];
        let exponent = cubic
            .into_iter()
            .rev()
            .fold(0.0, |sum, factor| sum * index + factor);
        Heat { index, exponent }
    }

    /// Ep: evaporation of a month in mm where water is never short, for a day factor L.
    fn evaporation(&self, temperature: f64, day_factor: f64) -> f64 {
        match temperature {
            // A place without a month above 0 on average has no index: nothing evaporates.
            ..0.0 => 0.0,
            _ if self.index == 0.0 => 0.0,
            0.0..26.5 => 16.0 * day_factor * pow(10.0 * temperature / self.index, self.exponent),
            _ => -415.85 + 32.25 * temperature - 0.43 * temperature * temperature,
        }
    }
}

/// The means of values that follow each other from January on, by calendar month; whole years.
fn by_month(values: impl Iterator<Item = f64>) -> [f64; 12] {
    let (mut sums, mut count) = ([0.0; 12], 0);
    for value in values {
        sums[count % 12] += value;
        count += 1;
    }
    sums.map(|sum| sum / (count / 12) as f64)
}

/// The bucket: most, least and first moisture, and the depth of the roots in mm.
const MOST: f64 = 0.76;
const LEAST: f64 = 0.01;
const START: f64 = 0.2;
const ROOT: f64 = 1000.0;

/// What runs off and seeps away: a share a month, its division, and the exponent of what a wet soil sheds.
const ALPHA: f64 = 0.093;
const MU: f64 = 5.8;
const SHEDDING: f64 = 4.886;

/// Soil moisture M as a share of volume at the end of each month.
pub fn moisture(climate: &Climate) -> Vec<f64> {
    let heat = Heat::new(climate);
    let factors = day_factors(climate.latitude);
    let mut moisture = START;
    let next = |(index, month): (usize, &Month)| {
        let share = moisture / MOST;
        let water = moisture * ROOT;
        let evaporation = heat.evaporation(month.temperature, factors[index % 12]) * share;
        let below = ALPHA * water / (1.0 + MU);
        let run_off = month.rain * pow(share, SHEDDING) + below;
        let change = month.rain - evaporation - run_off - MU * below;
        moisture = (moisture + change / ROOT).clamp(LEAST, MOST);
        moisture
    };
    climate.months.iter().enumerate().map(next).collect()
}

/// What sunshine makes of each month's light; 1 everywhere if there is no sunshine in the climate.
///
/// A month that was not measured gets the mean of its calendar month, a calendar month that never was gets the mean
/// share of daylight of all that were.
fn sunshine(climate: &Climate) -> Vec<f64> {
    let daylight = day_lengths(climate.latitude);
    let share = |(index, month): (usize, &Month)| {
        let most = daylight[index % 12] * DAYS[index % 12];
        let hours = month.sunshine?;
        Some(if most > 0.0 {
            (hours / most).min(1.0)
        } else {
            0.0
        })
    };
    let shares: Vec<Option<f64>> = climate.months.iter().enumerate().map(share).collect();
    let Some(of_all) = mean(shares.iter().flatten()) else {
        return vec![1.0; shares.len()];
    };
    let of_month = |month: usize| mean(shares.iter().skip(month).step_by(12).flatten());
    let means: [f64; 12] = std::array::from_fn(|month| of_month(month).unwrap_or(of_all));
    let known = |(index, share): (usize, Option<f64>)| share.unwrap_or(means[index % 12]);
    let shares = shares.into_iter().enumerate().map(known);
    shares.map(|share| (0.25 + 0.5 * share) / 0.75).collect()
}

fn mean<'a>(values: impl Iterator<Item = &'a f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then_some(sum / count)
}

/// Gr: the growth of each month, from 0 to 1; with sunshine, if the climate has any and it is asked for.
pub fn growth(climate: &Climate, thresholds: &Thresholds, with_sunshine: bool) -> Vec<f64> {
    let light = light(climate.latitude);
    let sunshine = match with_sunshine {
        true => sunshine(climate),
        false => vec![1.0; climate.months.len()],
    };
    let months = climate.months.iter().zip(moisture(climate)).zip(sunshine);
    let grown = |(index, ((month, moisture), sun)): (usize, ((&Month, f64), f64))| {
        let warmth = ramp(month.temperature, thresholds.temperature);
        let moist = ramp(moisture, thresholds.moisture);
        light[index % 12] * sun * warmth.min(moist)
    };
    months.enumerate().map(grown).collect()
}

/// The first and the last month of a year's growth, 1 being January and -1 the December before. South of the equator
/// 1 is July, and a year is called after the calendar year in which it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// From -12 to 12, not 0.
    pub first: i32,
    /// Not before the first.
    pub last: i32,
}

impl Window {
    /// How many months from the January of the year, south of the equator from its July, to month `number`.
    fn offset(number: i32) -> i32 {
        if number > 0 { number - 1 } else { number }
    }

    /// The sums of the months of each year; months before the first of all count as their calendar month's mean,
    /// and years whose last month is not there are left out at the end.
    pub fn sums(self, months: &[f64], latitude: f64) -> Vec<f64> {
        let shift = if latitude < 0.0 { 6 } else { 0 };
        let [first, last] = [self.first, self.last].map(|number| Window::offset(number) + shift);
        let means = by_month(months.iter().copied());
        let value = |index: i64| match usize::try_from(index) {
            Ok(index) => months[index],
            Err(_) => means[index.rem_euclid(12) as usize],
        };
        let years = (0..months.len() as i64 / 12).map(|year| 12 * year);
        let sum = |year: i64| {
            (first..=last)
                .map(|month| value(year + i64::from(month)))
                .sum()
        };
        years
            .take_while(|year| year + i64::from(last) < months.len() as i64)
            .map(sum)
            .collect()
    }
}

//! Climates: weather, month by month.

use serde::{Deserialize, Serialize};

/// The weather of a place, month by month without a gap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Climate {
    /// Latitude of the place in degrees, north positive.
    pub latitude: f64,
    /// The calendar year of the first month, which is a January.
    pub first_year: i32,
    /// Whole years: twelve months each, from January to December.
    pub months: Vec<Month>,
}

/// The weather of one month.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Month {
    /// Mean temperature in degrees Celsius.
    pub temperature: f64,
    /// Rain in mm.
    pub rain: f64,
    /// Hours of sunshine in the month; `None` where they were not measured.
    pub sunshine: Option<f64>,
}

/// Most years of a climate.
const MOST_YEARS: usize = 10_000;

impl Climate {
    /// Whether it is what nodes make: whole years of weather that can be.
    pub fn is_sound(&self) -> bool {
        let (years, rest) = (self.months.len() / 12, self.months.len() % 12);
        self.latitude.abs() <= 90.0
            && rest == 0
            && (1..=MOST_YEARS).contains(&years)
            && self.first_year.unsigned_abs() <= MOST_YEARS as u32
            && self.months.iter().all(Month::is_sound)
    }

    /// Number of years.
    pub fn years(&self) -> usize {
        self.months.len() / 12
    }
}

impl Month {
    /// Whether such a month can be on this planet, generously.
    pub fn is_sound(&self) -> bool {
        (-100.0..=100.0).contains(&self.temperature)
            && (0.0..=20_000.0).contains(&self.rain)
            && self
                .sunshine
                .is_none_or(|hours| (0.0..=750.0).contains(&hours))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_years_of_possible_weather_are_sound() {
        let month = Month {
            temperature: 9.5,
            rain: 55.0,
            sunshine: Some(130.0),
        };
        let climate = |change: fn(&mut Climate)| {
            let mut climate = Climate {
                latitude: 51.8,
                first_year: 1853,
                months: vec![month; 24],
            };
            change(&mut climate);
            climate.is_sound()
        };
        assert!(climate(|_| {}));
        let unsound: [fn(&mut Climate); 7] = [
            |it| it.months.clear(),
            |it| it.months.truncate(13),
            |it| it.latitude = 90.5,
            |it| it.latitude = f64::NAN,
            |it| it.months[3].temperature = -300.0,
            |it| it.months[3].rain = -1.0,
            |it| it.months[3].sunshine = Some(f64::NAN),
        ];
        for (number, change) in unsound.into_iter().enumerate() {
            assert!(!climate(change), "{number}");
        }
    }
}

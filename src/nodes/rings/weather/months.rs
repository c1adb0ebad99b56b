//! Months as a file has them, and the rules that make whole years of them.

use crate::node::Failure;
use crate::nodes::cells::Fault;
use crate::value::{Climate, Month};

/// What a file says of one month.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reading {
    /// The line of the file, from 1.
    pub(super) line: u64,
    pub(super) year: i32,
    /// From 1 to 12.
    pub(super) month: i32,
    /// Mean temperature in degrees Celsius.
    pub(super) temperature: Option<f64>,
    /// Rain in mm.
    pub(super) rain: Option<f64>,
    /// Hours of sunshine.
    pub(super) sunshine: Option<f64>,
}

/// All that a file says.
#[derive(Debug, Default)]
pub(super) struct Record {
    /// Latitude in degrees, if the file states it.
    pub(super) latitude: Option<f64>,
    readings: Vec<Reading>,
    /// How many values are estimates, and how many rows are provisional.
    pub(super) estimates: usize,
    pub(super) provisional: usize,
}

impl Record {
    /// Adds a month.
    ///
    /// # Errors
    /// If there cannot be such weather.
    pub(super) fn add(&mut self, reading: Reading) -> Result<(), Fault> {
        let limits = [
            (reading.temperature, "temperature", -90.0, 60.0, "degrees"),
            (reading.rain, "rain", 0.0, 20_000.0, "mm"),
            (reading.sunshine, "sunshine", 0.0, 745.0, "hours"),
        ];
        for (value, what, low, high, unit) in limits {
            let Some(value) = value.filter(|value| !(low..=high).contains(value)) else {
                continue;
            };
            let message =
                format!("{what} of a month from {low} to {high} {unit} expected, found {value}");
            return Err(Fault::line(reading.line, &message));
        }
        self.readings.push(reading);
        Ok(())
    }
}

/// A year that a calendar has.
pub(super) fn year(number: f64) -> Option<i32> {
    whole(number, 9999)
}

/// A month of the year, from 1.
pub(super) fn month(number: f64) -> Option<i32> {
    whole(number, 12)
}

fn whole(number: f64, most: i32) -> Option<i32> {
    let fits = number.fract() == 0.0 && (1.0..=f64::from(most)).contains(&number);
    fits.then_some(number as i32)
}

/// The mean of a month's mean daily lowest and highest temperature, if both are there.
///
/// # Errors
/// If they are the wrong way round.
pub(super) fn middle(line: u64, low: Option<f64>, high: Option<f64>) -> Result<Option<f64>, Fault> {
    match low.zip(high) {
        Some((low, high)) if low > high => {
            let message = format!("the lowest temperature, {low}, is above the highest, {high}");
            Err(Fault::line(line, &message))
        }
        both => Ok(both.map(|(low, high)| (low + high) / 2.0)),
    }
}

/// What the recipe asks for.
#[derive(Debug)]
pub(super) struct Choice {
    pub(super) latitude: Option<f64>,
    pub(super) from: Option<i32>,
    pub(super) to: Option<i32>,
    pub(super) longest_gap: usize,
}

/// Whole years of weather without a gap; what was done to get them is told.
///
/// # Errors
/// What the recipe or the file lacks.
pub(super) fn climate(
    record: Record,
    choice: &Choice,
    warnings: &mut Vec<String>,
) -> Result<Climate, Failure> {
    let latitude = latitude(choice.latitude, record.latitude, warnings)?;
    tell_estimates(&record, warnings);
    let years = Years::new(record.readings).map_err(super::of_file)?;
    let mut years = years.window(choice)?.whole(warnings)?;
    years.refuse_gaps(choice.longest_gap)?;
    for (part, name) in [(TEMPERATURE, "temperature"), (RAIN, "rain")] {
        years.fill(part, name, warnings);
    }
    Ok(years.climate(latitude))
}

fn latitude(
    stated: Option<f64>,
    of_file: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<f64, Failure> {
    if let (Some(stated), Some(of_file)) = (stated, of_file)
        && (stated - of_file).abs() > 0.05
    {
        warnings.push(format!(
            "the file states the latitude {of_file:.3}, and the recipe's {stated} counts"
        ));
    }
    stated.or(of_file).ok_or_else(|| {
        let failure = Failure::new("neither the file nor the recipe states the latitude");
        failure.with_hint("set `latitude: 51.8`, in degrees, north positive")
    })
}

fn tell_estimates(record: &Record, warnings: &mut Vec<String>) {
    let mut told = vec![];
    if record.estimates > 0 {
        told.push(format!("{} values are estimates", record.estimates));
    }
    if record.provisional > 0 {
        told.push(format!("{} months are provisional", record.provisional));
    }
    if !told.is_empty() {
        let told = told.join(" and ");
        warnings.push(format!("{told} in the file; they are taken as they are"));
    }
}

/// Temperature, rain and sunshine of a month.
type Parts = [Option<f64>; 3];

const TEMPERATURE: usize = 0;
const RAIN: usize = 1;
const SUNSHINE: usize = 2;

/// Years of months, from January of the first year.
struct Years {
    first: i32,
    months: Vec<Parts>,
}

fn is_measured(month: &Parts) -> bool {
    month[TEMPERATURE].is_some() && month[RAIN].is_some()
}

impl Years {
    fn new(mut readings: Vec<Reading>) -> Result<Years, Fault> {
        readings.sort_by_key(|reading| (reading.year, reading.month, reading.line));
        let date = |reading: &Reading| (reading.year, reading.month);
        if let Some(twice) = readings
            .windows(2)
            .find(|two| date(&two[0]) == date(&two[1]))
        {
            let message = format!(
                "{} comes twice, first in line {}",
                shown(date(&twice[1])),
                twice[0].line
            );
            return Err(
                Fault::line(twice[1].line, &message).hint("a table holds one row for each month")
            );
        }
        let (Some(first), Some(last)) = (readings.first(), readings.last()) else {
            return Err(Fault::whole("the file holds no months"));
        };
        let first = first.year;
        let mut months = vec![Parts::default(); 12 * (last.year - first + 1) as usize];
        for reading in readings {
            let index = 12 * (reading.year - first) + reading.month - 1;
            months[index as usize] = [reading.temperature, reading.rain, reading.sunshine];
        }
        Ok(Years { first, months })
    }

    fn last(&self) -> i32 {
        self.first + (self.months.len() / 12) as i32 - 1
    }

    /// The year and month of a month.
    fn date(&self, index: usize) -> (i32, i32) {
        (self.first + (index / 12) as i32, (index % 12) as i32 + 1)
    }

    /// The years from `first` to `last`, both of which are there.
    fn part(&self, first: i32, last: i32) -> Years {
        let index = |year: i32| 12 * (year - self.first) as usize;
        Years {
            first,
            months: self.months[index(first)..index(last + 1)].to_vec(),
        }
    }

    fn window(self, choice: &Choice) -> Result<Years, Failure> {
        let (first, last) = (self.first, self.last());
        for (input, year) in [("from", choice.from), ("to", choice.to)] {
            if let Some(year) = year.filter(|year| !(first..=last).contains(year)) {
                let message = format!("the file has no weather of the year {year}");
                return Err(Failure::of_input(input, message)
                    .with_hint(format!("it has the years {first} to {last}")));
            }
        }
        let [from, to] = [choice.from.unwrap_or(first), choice.to.unwrap_or(last)];
        if from > to {
            let message = format!("the years end before they begin: {from} to {to}");
            return Err(Failure::of_input("to", message));
        }
        Ok(self.part(from, to))
    }

    /// Without the years at the beginning and at the end that lack something.
    fn whole(self, warnings: &mut Vec<String>) -> Result<Years, Failure> {
        let is_whole = |year: &[Parts]| year.iter().all(is_measured);
        let mut years = self.months.chunks(12);
        let Some(before) = years.position(is_whole) else {
            let message = format!(
                "no year from {} to {} has temperature and rain in all twelve months",
                self.first,
                self.last()
            );
            return Err(Failure::of_input("file", message));
        };
        let after = self.months.rchunks(12).position(is_whole).unwrap_or(0);
        let [first, last] = [self.first + before as i32, self.last() - after as i32];
        let mut tell = |from: i32, to: i32| match to - from {
            ..0 => {}
            0 => warnings.push(format!("the year {from} is not complete and is left out")),
            _ => warnings.push(format!(
                "the years {from} to {to} are not complete and are left out"
            )),
        };
        tell(self.first, first - 1);
        tell(last + 1, self.last());
        Ok(self.part(first, last))
    }

    fn refuse_gaps(&self, longest: usize) -> Result<(), Failure> {
        let mut rest = self.months.iter().enumerate();
        let mut start = 0;
        while let Some((index, month)) = rest.next() {
            if is_measured(month) {
                start = index + 1;
            } else if index + 1 - start > longest {
                let end = rest.find(|(_, month)| is_measured(month));
                let end = end.map_or(self.months.len(), |(index, _)| index);
                return Err(self.gap(start, end, longest));
            }
        }
        Ok(())
    }

    fn gap(&self, start: usize, end: usize, longest: usize) -> Failure {
        let [first, last] = [self.date(start), self.date(end - 1)];
        let message = format!(
            "no temperature or no rain from {} to {}: {} months, and {longest} are filled at most",
            shown(first),
            shown(last),
            end - start
        );
        Failure::of_input("file", message).with_hint(format!(
            "set `to: {}`, `from: {}`, or `longest_gap: {}`",
            first.0 - 1,
            last.0 + 1,
            end - start
        ))
    }

    /// Gives months that lack a part the mean of their calendar month.
    fn fill(&mut self, part: usize, name: &str, warnings: &mut Vec<String>) {
        let means = self.means(part);
        let lacking = |index: &usize| self.months[*index][part].is_none();
        let missing: Vec<usize> = (0..self.months.len()).filter(lacking).collect();
        if missing.is_empty() {
            return;
        }
        let years = (self.first, self.last());
        let first: Vec<String> = runs(&missing)
            .take(4)
            .map(|(from, to)| match from == to {
                true => shown(self.date(from)),
                false => format!("{} to {}", shown(self.date(from)), shown(self.date(to))),
            })
            .collect();
        let more = if runs(&missing).count() > first.len() {
            ", .."
        } else {
            ""
        };
        warnings.push(format!(
            "{} months have no {name} and get the mean of their calendar month of {} to {}: {}{more}",
            missing.len(),
            years.0,
            years.1,
            first.join(", ")
        ));
        for index in missing {
            self.months[index][part] = Some(means[index % 12]);
        }
    }

    /// The mean of each calendar month; the first year has all of them.
    fn means(&self, part: usize) -> [f64; 12] {
        std::array::from_fn(|month| {
            let of_month = self.months.iter().skip(month).step_by(12);
            let values = of_month.filter_map(|month| month[part]);
            let (sum, count) =
                values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
            sum / count
        })
    }

    fn climate(self, latitude: f64) -> Climate {
        let month = |parts: &Parts| Month {
            temperature: parts[TEMPERATURE].unwrap_or_default(),
            rain: parts[RAIN].unwrap_or_default(),
            sunshine: parts[SUNSHINE],
        };
        Climate {
            latitude,
            first_year: self.first,
            months: self.months.iter().map(month).collect(),
        }
    }
}

/// First and last of each run of indices that follow each other.
fn runs(indices: &[usize]) -> impl Iterator<Item = (usize, usize)> {
    indices
        .chunk_by(|a, b| a + 1 == *b)
        .map(|run| (run[0], run[run.len() - 1]))
}

/// A date as messages show it, `1976-08`.
fn shown((year, month): (i32, i32)) -> String {
    format!("{year}-{month:02}")
}

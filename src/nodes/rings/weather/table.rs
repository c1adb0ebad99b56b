//! Tables of weather in CSV: a row for each month, or a row for each year with a column for each month.
//!
//! Columns are known by the first words of their names, in any case and order: `year` or `yyyy`, `month` or `mm`, or
//! both as a `date` (`1961-01`); `temperature`, `temp`, `tmean`, `tavg` or `t`, or `tmin` and `tmax`; `rain`,
//! `rainfall`, `precip`, `precipitation`, `prcp`, `ppt` or `p`; `sun`, `sunshine` or `s`. With twelve columns each,
//! `t1` to `t12` and `p1` to `p12`, a row is a year; `s1` to `s12` may be there. Temperatures are in degrees Celsius,
//! rain in mm, sunshine in hours: columns that say otherwise (a name's last word) are refused. Other columns are not read.
//!
//! Missing are empty cells, `-`, `---`, `NA`, `NaN`, `null`, and the numbers -99, -99.9, -999, -999.9, -9999 and
//! -9999.9. Remarks behind `#` may state the latitude, and so may a column `latitude`.

use super::months::{Reading, Record, middle, month, year};
use super::place;
use crate::node::Build;
use crate::nodes::cells::{self, Fault, Row, Table};

const YEAR: &[&str] = &["year", "yyyy", "yr"];
const MONTH: &[&str] = &["month", "mm", "mon", "mo"];
const DATE: &[&str] = &["date", "time"];
const MEAN: &[&str] = &["temperature", "temp", "tmean", "tavg", "tas", "t"];
const LOW: &[&str] = &["tmin", "tasmin"];
const HIGH: &[&str] = &["tmax", "tasmax"];
const RAIN: &[&str] = &[
    "rain",
    "rainfall",
    "precip",
    "precipitation",
    "prcp",
    "ppt",
    "p",
];
const SUN: &[&str] = &["sun", "sunshine", "s"];

/// Words for units that are not ours.
const STRANGE: &[&str] = &[
    "f",
    "fahrenheit",
    "k",
    "kelvin",
    "in",
    "inch",
    "inches",
    "cm",
    "minutes",
];

/// Cells that hold nothing.
const EMPTY: &[&str] = &[
    "", "-", "--", "---", "na", "n/a", "nan", "null", "none", ".",
];
const NO_NUMBERS: &[f64] = &[
    -99.0, -99.9, -99.99, -999.0, -999.9, -999.99, -9999.0, -9999.9,
];

/// Reads a table.
///
/// # Errors
/// Missing columns, cells that are no numbers, by line and column; that the run was cancelled.
pub(super) fn read(bytes: &[u8], text: &str, build: &Build<'_>) -> Result<Record, Fault> {
    let table = cells::read(bytes, build)?;
    let mut record = Record::default();
    record.latitude = remarked_latitude(text);
    let columns = Columns { table: &table };
    if let Some(column) = columns.find(&["latitude", "lat"])? {
        record.latitude = Some(latitude(&table, &table.rows[0], column)?);
    }
    let wide = columns.by_months("t").zip(columns.by_months("p"));
    match wide {
        Some((temperature, rain)) => {
            let sun = columns.by_months("s");
            read_years(&columns, [&temperature, &rain], sun.as_deref(), &mut record)?;
        }
        None => read_months(&columns, &mut record)?,
    }
    Ok(record)
}

fn remarked_latitude(text: &str) -> Option<f64> {
    let remarks = text.split(['\n', '\r']);
    let remarks = remarks
        .map(str::trim)
        .take_while(|line| line.is_empty() || line.starts_with('#'));
    remarks.filter_map(place::latitude).last()
}

fn latitude(table: &Table<'_>, row: &Row, column: &str) -> Result<f64, Fault> {
    let degrees = table.number(row, column)?;
    match degrees.abs() <= 90.0 {
        true => Ok(degrees),
        false => Err(table.refuse(row, column, "a latitude from -90 to 90 degrees")),
    }
}

/// A row for each month.
fn read_months(columns: &Columns<'_>, record: &mut Record) -> Result<(), Fault> {
    let date = columns.date()?;
    let temperature = columns.temperature()?;
    let rain = columns.required(RAIN, "rain")?;
    let sun = columns.find(SUN)?;
    for row in &columns.table.rows {
        let (year, month) = columns.date_of(row, date)?;
        let reading = Reading {
            line: row.line,
            year,
            month,
            temperature: columns.temperature_of(row, temperature)?,
            rain: columns.value(row, rain)?,
            sunshine: sun.map_or(Ok(None), |column| columns.value(row, column))?,
        };
        record.add(reading)?;
    }
    Ok(())
}

/// A row for each year.
fn read_years(
    columns: &Columns<'_>,
    [temperature, rain]: [&[&str]; 2],
    sun: Option<&[&str]>,
    record: &mut Record,
) -> Result<(), Fault> {
    let year_column = columns.required(YEAR, "year")?;
    for row in &columns.table.rows {
        let year = columns.year(row, year_column)?;
        for month in 0..12 {
            let reading = Reading {
                line: row.line,
                year,
                month: month as i32 + 1,
                temperature: columns.value(row, temperature[month])?,
                rain: columns.value(row, rain[month])?,
                sunshine: sun.map_or(Ok(None), |sun| columns.value(row, sun[month]))?,
            };
            record.add(reading)?;
        }
    }
    Ok(())
}

/// Where a row says which month it is.
#[derive(Clone, Copy)]
enum Date<'a> {
    Parts { year: &'a str, month: &'a str },
    Whole(&'a str),
}

/// Where a row says how warm it was.
#[derive(Clone, Copy)]
enum Temperature<'a> {
    Mean(&'a str),
    Ends { low: &'a str, high: &'a str },
}

/// The columns of a table by what they are.
struct Columns<'a> {
    table: &'a Table<'a>,
}

/// The words of a column's name.
fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(|letter: char| !letter.is_alphanumeric())
        .filter(|word| !word.is_empty())
}

impl<'a> Columns<'a> {
    /// The column whose name begins with one of these words.
    fn find(&self, known: &[&str]) -> Result<Option<&'a str>, Fault> {
        let begins = |name: &&'a str| words(name).next().is_some_and(|word| known.contains(&word));
        let mut found = self.table.header().filter(begins);
        let (first, second) = (found.next(), found.next());
        if let (Some(first), Some(second)) = (first, second) {
            let message = format!(
                "the columns `{first}` and `{second}` could both be {}",
                known[0]
            );
            return Err(Fault::whole(message).hint("rename one of them"));
        }
        if let Some(name) = first
            && let Some(unit) = words(name)
                .skip(1)
                .last()
                .filter(|word| STRANGE.contains(word))
        {
            let message = format!("the column `{name}` is in another unit, `{unit}`");
            return Err(Fault::whole(message)
                .hint("temperatures are in degrees Celsius, rain in mm, sunshine in hours"));
        }
        Ok(first)
    }

    fn required(&self, known: &[&str], what: &str) -> Result<&'a str, Fault> {
        self.find(known)?.ok_or_else(|| {
            let message = format!(
                "there is no column for the {what} among {}",
                self.table.names()
            );
            Fault::whole(message).hint(format!("call it `{}`", known[0]))
        })
    }

    /// The columns `t1` to `t12` of a letter, if all are there.
    fn by_months(&self, letter: &str) -> Option<Vec<&'a str>> {
        let column = |month: i32| {
            let names = [format!("{letter}{month}"), format!("{letter}{month:02}")];
            self.table
                .header()
                .find(|name| names.iter().any(|known| known == name))
        };
        (1..=12).map(column).collect()
    }

    fn date(&self) -> Result<Date<'a>, Fault> {
        match (self.find(YEAR)?, self.find(DATE)?) {
            (None, Some(date)) => Ok(Date::Whole(date)),
            _ => Ok(Date::Parts {
                year: self.required(YEAR, "year")?,
                month: self.required(MONTH, "month")?,
            }),
        }
    }

    fn temperature(&self) -> Result<Temperature<'a>, Fault> {
        if let Some(mean) = self.find(MEAN)? {
            return Ok(Temperature::Mean(mean));
        }
        match (self.find(LOW)?, self.find(HIGH)?) {
            (Some(low), Some(high)) => Ok(Temperature::Ends { low, high }),
            _ => self.required(MEAN, "temperature").map(Temperature::Mean),
        }
    }

    fn date_of(&self, row: &Row, date: Date<'_>) -> Result<(i32, i32), Fault> {
        match date {
            Date::Parts {
                year,
                month: column,
            } => {
                let found = month(self.table.number(row, column)?);
                let refuse = || self.table.refuse(row, column, "a month from 1 to 12");
                Ok((self.year(row, year)?, found.ok_or_else(refuse)?))
            }
            Date::Whole(column) => {
                let mut parts = self
                    .table
                    .cell(row, column)
                    .split(['-', '/', '.', 'T', ' ']);
                let mut number = || parts.next()?.trim().parse::<f64>().ok();
                let found = number().and_then(year).zip(number().and_then(month));
                found.ok_or_else(|| self.table.refuse(row, column, "a date such as 1961-01"))
            }
        }
    }

    fn year(&self, row: &Row, column: &str) -> Result<i32, Fault> {
        let found = year(self.table.number(row, column)?);
        found.ok_or_else(|| self.table.refuse(row, column, "a year from 1 to 9999"))
    }

    fn temperature_of(&self, row: &Row, from: Temperature<'_>) -> Result<Option<f64>, Fault> {
        match from {
            Temperature::Mean(column) => self.value(row, column),
            Temperature::Ends { low, high } => {
                middle(row.line, self.value(row, low)?, self.value(row, high)?)
            }
        }
    }

    /// A number, unless the cell says that it is missing.
    fn value(&self, row: &Row, column: &str) -> Result<Option<f64>, Fault> {
        let cell = self.table.cell(row, column).to_lowercase();
        if EMPTY.contains(&&*cell) {
            return Ok(None);
        }
        let number = self.table.number(row, column)?;
        Ok((!NO_NUMBERS.contains(&number)).then_some(number))
    }
}

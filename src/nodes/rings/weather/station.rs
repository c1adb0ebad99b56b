//! Station files of the Met Office: columns of words under a line `yyyy mm tmax tmin af rain sun`.
//!
//! Lines before it are remarks, of which the last that states a latitude counts; a line of units may follow it. A
//! value is a number, with `*` if it is estimated and with `#` or `$` if it has a remark; `---` is a missing one. A
//! row may end early, which leaves its last columns missing, and after its columns it may say `Provisional`. Empty
//! lines, and lines that say that the site is closed, hold nothing.

use super::months::{Reading, Record, month, year};
use super::place;
use crate::node::Build;
use crate::nodes::cells::{Fault, go_on};

/// Most lines before the columns' names.
const MOST_REMARKS: usize = 100;

/// Most lines of a file.
const MOST_LINES: u64 = 1_000_000;

/// The lines of a text with their numbers, whatever their ends are.
fn lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    let end = if text.contains('\n') { '\n' } else { '\r' };
    (1..).zip(text.split(end).map(str::trim))
}

/// The number of the line with the columns' names, if this is a station file.
pub(super) fn header_line(text: &str) -> Option<u64> {
    let is_header = |line: &str| {
        let mut words = line.split_whitespace().map(str::to_lowercase);
        words.next().is_some_and(|word| word == "yyyy") && words.next().is_some_and(|it| it == "mm")
    };
    let mut first = lines(text).take(MOST_REMARKS);
    first.find_map(|(number, line)| is_header(line).then_some(number))
}

/// Reads a station file whose columns are named in line `header`.
///
/// # Errors
/// Missing columns, and rows that are none, by line and column; that the run was cancelled.
pub(super) fn read(text: &str, header: u64, build: &Build<'_>) -> Result<Record, Fault> {
    let mut record = Record::default();
    let mut columns = vec![];
    for (number, line) in lines(text) {
        go_on(build)?;
        if number > MOST_LINES {
            return Err(Fault::whole(format!("more than {MOST_LINES} lines")));
        }
        if number < header {
            record.latitude = place::latitude(line).or(record.latitude);
        } else if number == header {
            columns = named(line, number)?;
        } else if holds_months(line, number == header + 1) {
            let row = Row {
                line: number,
                columns: &columns,
                words: line.split_whitespace().collect(),
            };
            row.read(&mut record)?;
        }
    }
    Ok(record)
}

/// The names of the columns in lower case.
fn named(line: &str, number: u64) -> Result<Vec<String>, Fault> {
    let names: Vec<String> = line.split_whitespace().map(str::to_lowercase).collect();
    let missing = ["tmax", "tmin", "rain"]
        .into_iter()
        .find(|name| !names.iter().any(|found| found == name));
    match missing {
        None => Ok(names),
        Some(name) => {
            let message = format!("no column `{name}` among {}", names.join(", "));
            Err(Fault::line(number, &message))
        }
    }
}

/// Whether a line behind the columns' names is a row, or at least meant as one.
fn holds_months(line: &str, is_first: bool) -> bool {
    let starts_with_digit = line.starts_with(|letter: char| letter.is_ascii_digit());
    let is_units = is_first && !starts_with_digit;
    !(line.is_empty() || is_units || line.to_lowercase().contains("closed") && !starts_with_digit)
}

/// A row of a station file.
struct Row<'a> {
    line: u64,
    columns: &'a [String],
    words: Vec<&'a str>,
}

/// A value of a row: its number, unless it is missing, and whether it is an estimate.
type Cell = (Option<f64>, bool);

impl Row<'_> {
    fn read(&self, record: &mut Record) -> Result<(), Fault> {
        let more = self.words.get(self.columns.len()..).unwrap_or_default();
        let told =
            |word: &&&str| !["provisional", "site", "closed"].contains(&&*word.to_lowercase());
        if let Some(word) = more.iter().find(told) {
            return Err(self.refuse(self.columns.len(), "the row's end or `Provisional`", word));
        }
        let [(high, a), (low, b)] = [self.cell("tmax")?, self.cell("tmin")?];
        let [(rain, c), (sunshine, d)] = [self.cell("rain")?, self.cell("sun")?];
        record.estimates += [a, b, c, d].into_iter().filter(|it| *it).count();
        record.provisional += usize::from(!more.is_empty());
        let reading = Reading {
            line: self.line,
            year: self.date(0, "a year from 1 to 9999", year)?,
            month: self.date(1, "a month from 1 to 12", month)?,
            temperature: super::months::middle(self.line, low, high)?,
            rain,
            sunshine,
        };
        record.add(reading)
    }

    /// The year or the month.
    fn date<T>(&self, index: usize, what: &str, from: fn(f64) -> Option<T>) -> Result<T, Fault> {
        let word = self.words.get(index).copied().unwrap_or_default();
        let number = word.parse().ok().and_then(from);
        number.ok_or_else(|| self.refuse(index, what, word))
    }

    /// The value in the column `name`; missing where there is no such column or the row ends before it.
    fn cell(&self, name: &str) -> Result<Cell, Fault> {
        let Some(index) = self.columns.iter().position(|column| column == name) else {
            return Ok((None, false));
        };
        let word = self.words.get(index).copied().unwrap_or("---");
        let bare = word.trim_end_matches(['*', '#', '$', '|']);
        let is_estimate = word[bare.len()..].contains('*');
        if bare.is_empty() || bare.bytes().all(|byte| byte == b'-') {
            return Ok((None, false));
        }
        let number = bare.replacen(',', ".", 1).parse::<f64>().ok();
        match number.filter(|number| number.is_finite()) {
            Some(number) => Ok((Some(number), is_estimate)),
            None => Err(self.refuse(index, "a number or `---`", word)),
        }
    }

    fn refuse(&self, index: usize, expected: &str, found: &str) -> Fault {
        let found = match found {
            "" => "the line's end".to_owned(),
            word => format!("`{}`", word.chars().take(40).collect::<String>()),
        };
        let column = match self.columns.get(index) {
            Some(name) => format!("column {} (`{name}`)", index + 1),
            None => format!("word {}", index + 1),
        };
        Fault::line(
            self.line,
            &format!("{column}: expected {expected}, found {found}"),
        )
    }
}

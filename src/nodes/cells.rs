//! The cells of a CSV file of measurements, each with its place.

use crate::node::Build;
use csv::{ReaderBuilder, StringRecord, Trim};
use std::collections::HashMap;

/// Most rows that a file may have.
const MOST_ROWS: usize = 1_000_000;

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::nodes) struct Fault {
    /// What is wrong, and where.
    pub(in crate::nodes) message: String,
    /// What to do.
    pub(in crate::nodes) hint: Option<String>,
}

impl Fault {
    /// Something about the whole file.
    pub(in crate::nodes) fn whole(message: impl Into<String>) -> Fault {
        Fault {
            message: message.into(),
            hint: None,
        }
    }

    /// Something about a line.
    pub(in crate::nodes) fn line(line: u64, message: &str) -> Fault {
        Fault::whole(format!("line {line}: {message}"))
    }

    pub(in crate::nodes) fn hint(mut self, hint: impl Into<String>) -> Fault {
        self.hint = Some(hint.into());
        self
    }
}

/// For loops over many lines.
///
/// # Errors
/// If the run was cancelled.
pub(in crate::nodes) fn go_on(build: &Build<'_>) -> Result<(), Fault> {
    let unless_cancelled = build.go_on();
    unless_cancelled.map_err(|failure| Fault::whole(failure.message))
}

/// The unit of the lengths in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::nodes) enum LengthUnit {
    /// Millimetres.
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Metres.
    Metre,
}

impl LengthUnit {
    /// The names that recipes and files use.
    pub(in crate::nodes) const NAMES: &'static [&'static str] = &["mm", "cm", "m"];

    /// The unit called `name`.
    pub(in crate::nodes) fn from_name(name: &str) -> Option<LengthUnit> {
        let units = [
            LengthUnit::Millimetre,
            LengthUnit::Centimetre,
            LengthUnit::Metre,
        ];
        let index = LengthUnit::NAMES.iter().position(|known| *known == name)?;
        units.get(index).copied()
    }

    fn millimetres(self) -> f64 {
        match self {
            LengthUnit::Millimetre => 1.0,
            LengthUnit::Centimetre => 10.0,
            LengthUnit::Metre => 1000.0,
        }
    }
}

/// A row of cells.
#[derive(Debug)]
pub(in crate::nodes) struct Row {
    /// The line in the file, from 1.
    pub(in crate::nodes) line: u64,
    cells: StringRecord,
}

/// A file with named columns.
#[derive(Debug)]
pub(in crate::nodes) struct Table<'a> {
    columns: HashMap<String, usize>,
    header: Vec<String>,
    /// The rows in the order of the file, at least one.
    pub(in crate::nodes) rows: Vec<Row>,
    decimal_comma: bool,
    unit: Option<LengthUnit>,
    build: &'a Build<'a>,
}

/// Reads a CSV file: UTF-8 with or without a mark, columns divided by comma, semicolon or tab, any line ends.
///
/// # Errors
/// What is no text, and rows that do not fit the header.
pub(in crate::nodes) fn read<'a>(bytes: &[u8], build: &'a Build<'a>) -> Result<Table<'a>, Fault> {
    let text = text(bytes)?;
    let (unit, header_line) = remarks(text)?;
    let separator = separator(header_line);
    let mut reader = ReaderBuilder::new()
        .delimiter(separator)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .flexible(true)
        .has_headers(false)
        .from_reader(text.as_bytes());
    let mut records = reader.records();
    let first = records
        .next()
        .transpose()
        .map_err(|error| Fault::whole(error.to_string()))?;
    let header: Vec<String> = match first {
        Some(record) => record.iter().map(str::to_lowercase).collect(),
        None => return Err(Fault::whole("the file is empty").hint("it needs a header and rows")),
    };
    let mut table = Table {
        columns: columns(&header)?,
        header,
        rows: vec![],
        decimal_comma: separator != b',',
        unit,
        build,
    };
    for record in records {
        let cells = record.map_err(|error| Fault::whole(error.to_string()))?;
        let line = cells.position().map_or(0, csv::Position::line);
        table.add(Row { line, cells })?;
    }
    match table.rows.is_empty() {
        true => Err(Fault::whole("the file has a header, but no rows")),
        false => Ok(table),
    }
}

/// The text of a file: UTF-8 with or without a mark.
///
/// # Errors
/// Other encodings, and what is no text.
pub(in crate::nodes) fn text(bytes: &[u8]) -> Result<&str, Fault> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(Fault::whole("the file is UTF-16").hint("save it as UTF-8"));
    }
    let line_at = |at: usize| 1 + bytes[..at].iter().filter(|byte| **byte == b'\n').count() as u64;
    if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
        return Err(Fault::line(line_at(at), "a zero byte: this is no text"));
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = line_at(error.valid_up_to());
        Fault::line(line, "letters that are not UTF-8").hint("save it as UTF-8")
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// The unit that a remark states, and the header's line.
fn remarks(text: &str) -> Result<(Option<LengthUnit>, &str), Fault> {
    let mut unit = None;
    for (index, line) in text.split(['\n', '\r']).enumerate() {
        let Some(remark) = line.strip_prefix('#') else {
            if line.trim().is_empty() {
                continue;
            }
            return Ok((unit, line));
        };
        if let Some(name) = remark.trim().strip_prefix("unit:") {
            let found = LengthUnit::from_name(name.trim());
            let refuse = || {
                let message = format!("expected the unit mm, cm or m, found `{}`", name.trim());
                Fault::line(index as u64 + 1, &message)
            };
            unit = Some(found.ok_or_else(refuse)?);
        }
    }
    Ok((unit, ""))
}

fn separator(header: &str) -> u8 {
    let count = |mark: u8| header.bytes().filter(|byte| *byte == mark).count();
    [b';', b'\t']
        .into_iter()
        .find(|mark| count(*mark) > 0)
        .unwrap_or(b',')
}

fn columns(header: &[String]) -> Result<HashMap<String, usize>, Fault> {
    let mut columns = HashMap::new();
    for (index, name) in header.iter().enumerate() {
        if let Some(first) = columns.insert(name.clone(), index) {
            let message = format!(
                "columns {} and {} are both called `{name}`",
                first + 1,
                index + 1
            );
            return Err(Fault::whole(message).hint("rename one of them"));
        }
    }
    Ok(columns)
}

impl Table<'_> {
    fn add(&mut self, row: Row) -> Result<(), Fault> {
        go_on(self.build)?;
        if self.rows.len() == MOST_ROWS {
            let message = format!("more than {MOST_ROWS} rows");
            return Err(Fault::whole(message).hint("leave out what is finest"));
        }
        if row.cells.iter().any(|cell| cell.contains(['\n', '\r'])) {
            return Err(Fault::line(row.line, "a quotation mark that is not closed"));
        }
        let (expected, found) = (self.header.len(), row.cells.len());
        if expected != found {
            let fault = Fault::line(
                row.line,
                &format!("expected {expected} cells, found {found}"),
            );
            return Err(match self.decimal_comma {
                false => fault.hint("numbers with decimal commas need columns divided by `;`"),
                true => fault,
            });
        }
        self.rows.push(row);
        Ok(())
    }

    /// Whether there is a column of this name.
    pub(in crate::nodes) fn has(&self, column: &str) -> bool {
        self.columns.contains_key(column)
    }

    /// The names of the columns, in lower case.
    pub(in crate::nodes) fn header(&self) -> impl Iterator<Item = &str> {
        self.header.iter().map(String::as_str)
    }

    /// The names of the columns, for messages.
    pub(in crate::nodes) fn names(&self) -> String {
        self.header.join(", ")
    }

    /// How many mm one length of the file is.
    ///
    /// # Errors
    /// If neither the recipe nor the file states a unit, or both state different ones.
    pub(in crate::nodes) fn millimetres(&self, stated: Option<LengthUnit>) -> Result<f64, Fault> {
        match (stated, self.unit) {
            (Some(recipe), Some(file)) if recipe != file => {
                let name = |unit: LengthUnit| LengthUnit::NAMES[unit as usize];
                let message = format!(
                    "`unit` is {}, and the file says {}",
                    name(recipe),
                    name(file)
                );
                Err(Fault::whole(message).hint("leave `unit` out"))
            }
            (Some(unit), _) | (None, Some(unit)) => Ok(unit.millimetres()),
            (None, None) => Err(Fault::whole(
                "the file does not say in which unit its lengths are",
            )
            .hint("set `unit: m`, or begin the file with `# unit: m`")),
        }
    }

    /// The cell of a row in a column that is there.
    pub(in crate::nodes) fn cell<'r>(&self, row: &'r Row, column: &str) -> &'r str {
        let index = self.columns.get(column).copied();
        index
            .and_then(|index| row.cells.get(index))
            .unwrap_or_default()
    }

    /// A finite number.
    pub(in crate::nodes) fn number(&self, row: &Row, column: &str) -> Result<f64, Fault> {
        go_on(self.build)?;
        let cell = self.cell(row, column);
        let number = match self.decimal_comma && !cell.contains('.') {
            true => cell.replacen(',', ".", 1).parse::<f64>(),
            false => cell.parse::<f64>(),
        };
        let number = number.ok().filter(|number| number.abs() <= 1e12);
        number.ok_or_else(|| self.refuse(row, column, "a finite number"))
    }

    /// A whole number.
    pub(in crate::nodes) fn whole(&self, row: &Row, column: &str) -> Result<i64, Fault> {
        let number = self.number(row, column)?;
        match number.fract() == 0.0 {
            true => Ok(number as i64),
            false => Err(self.refuse(row, column, "a whole number")),
        }
    }

    /// Says that a cell is not what is expected.
    pub(in crate::nodes) fn refuse(&self, row: &Row, column: &str, expected: &str) -> Fault {
        let number = self.columns.get(column).map_or(0, |index| index + 1);
        let found = match self.cell(row, column) {
            "" => "an empty cell".to_owned(),
            cell => format!("`{}`", cell.chars().take(40).collect::<String>()),
        };
        let message = format!("column {number} (`{column}`): expected {expected}, found {found}");
        Fault::line(row.line, &message)
    }
}

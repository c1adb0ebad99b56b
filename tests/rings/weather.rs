//! Weather files: every dialect, every rule, every mistake.

use super::*;
use yosegi::value::Month;

/// Two years of a station, with what comes before and after.
fn station(change: impl Fn(&str) -> String) -> String {
    let mut text = "Somewhere\nLocation: 450900E 207200N, Lat 51.761 Lon -1.262, 63 metres amsl\n\
                    Estimated data is marked with a * after the value.\n\
                    yyyy  mm   tmax    tmin      af    rain     sun\n\
                    degC    degC    days      mm   hours\n"
        .to_owned();
    for year in 1990..1992 {
        for month in 1..=12 {
            let row = format!(
                "   {year}  {month}   {}.5    {}.0      4    {}.8     40.5",
                month,
                month - 3,
                60 + month
            );
            text += &change(&row);
            text.push('\n');
        }
    }
    text
}

fn plain(row: &str) -> String {
    row.to_owned()
}

/// One row replaced.
fn with(date: &str, row: &str) -> String {
    station(|found| {
        let is_meant = found.split_whitespace().take(2).eq(date.split_whitespace());
        if is_meant { row } else { found }.to_owned()
    })
}

fn told(file: impl Into<Vec<u8>>) -> String {
    read(file, &[]).unwrap_err().message
}

#[test]
fn a_station_file_gives_means_rain_and_sunshine() {
    let climate = read(station(plain), &[]).unwrap();
    assert_eq!(
        (climate.latitude, climate.first_year, climate.years()),
        (51.761, 1990, 2)
    );
    let expected = Month {
        temperature: (3.5 + 0.0) / 2.0,
        rain: 63.8,
        sunshine: Some(40.5),
    };
    assert_eq!(climate.months[2], expected);
    assert!(climate.is_sound());
}

#[test]
fn oxford_tokyo_and_a_site_are_read_whole() {
    let oxford = oxford();
    assert_eq!(
        (oxford.latitude, oxford.first_year, oxford.years()),
        (51.761, 1853, 168)
    );
    let july = &oxford.months[12 * (1976 - 1853) + 6];
    assert_eq!((july.temperature, july.rain), ((25.9 + 13.2) / 2.0, 14.3));
    assert!(oxford.months[0].sunshine.is_none() && july.sunshine.is_some());
    let tokyo = tokyo();
    assert_eq!(
        (tokyo.latitude, tokyo.first_year, tokyo.years()),
        (35.69, 1961, 56)
    );
    let june = &tokyo.months[5];
    assert_eq!((june.temperature, june.rain), (22.59, 305.5));
    let site = site();
    assert_eq!(
        (site.latitude, site.first_year, site.years()),
        (39.02, 1895, 90)
    );
    assert_eq!(
        (site.months[4].temperature, site.months[4].rain),
        (13.94, 31.73)
    );
    assert!(
        [oxford, tokyo, site]
            .iter()
            .all(|climate| climate.is_sound())
    );
}

#[test]
fn line_ends_marks_and_order_change_nothing() {
    let text = station(plain);
    let expected = read(text.clone(), &[]).unwrap();
    let (head, rows) = text.split_at(text.find("   1990").unwrap());
    let mut reversed: Vec<&str> = rows.lines().collect();
    reversed.reverse();
    let dialects = [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        format!("\u{feff}{text}"),
        text.trim_end().to_owned(),
        format!("{text}\n\nSite Closed\n"),
        format!("{head}{}", reversed.join("\n")),
        text.replace(".5", ",5")
            .replace(".8", ",8")
            .replace(".0 ", ",0 "),
        text.replace("yyyy  mm   tmax", "YYYY MM Tmax"),
        text.replace("Estimated data", "Line\nand line\nEstimated data"),
    ];
    for (number, dialect) in dialects.into_iter().enumerate() {
        assert_eq!(read(dialect, &[]).unwrap(), expected, "dialect {number}");
    }
}

#[test]
fn columns_of_a_table_are_known_by_their_names() {
    let rows = |row: fn(i32) -> String| (1..=12).map(row).collect::<Vec<_>>().join("\n");
    let plain = rows(|m| format!("2001,{m},{m}.5,{},3{m}.25", 10 * m));
    let table = |header: &str, rows: &str| {
        read(format!("# x, latitude: 33.9 S\n{header}\n{rows}"), &[]).unwrap()
    };
    let expected = table("year,month,temperature,rain,sunshine", &plain);
    assert_eq!(expected.latitude, -33.9);
    assert_eq!(expected.months[1].temperature, 2.5);
    assert_eq!(expected.months[1].sunshine, Some(32.25));
    for header in [
        "Year,Month,Tmean_C,Precip (mm),Sun_hours",
        "yyyy,mm,t,p,s",
        "yr,mo,temp,ppt,sun",
    ] {
        assert_eq!(table(header, &plain), expected, "{header}");
    }
    let semicolons = plain.replace(',', ";").replace('.', ",");
    assert_eq!(
        table("year;month;temperature;rain;sunshine", &semicolons),
        expected
    );
    let dates = rows(|m| format!("2001-{m:02}-01,{m}.5,{},3{m}.25", 10 * m));
    assert_eq!(table("date,temperature,rain,sunshine", &dates), expected);
    let ends = rows(|m| format!("2001,{m},{m}.0,{}.0,{},3{m}.25", m + 1, 10 * m));
    assert_eq!(table("year,month,tmin,tmax,rain,sunshine", &ends), expected);
    let missing = plain.replace("32.25", "NA");
    assert_eq!(
        table("year,month,temperature,rain,sunshine", &missing).months[1].sunshine,
        None
    );
}

#[test]
fn months_that_lack_something_get_the_mean_of_their_calendar_month() {
    let text = with("1990 7", "   1990  7   ---    4.0      0    ---     ---")
        .replace("1991  7   7.5", "1991  7   9.5*");
    // No year is complete but the second: the first is left out.
    let climate = read(text.clone(), &[]).unwrap();
    assert_eq!((climate.first_year, climate.years()), (1991, 1));
    assert_eq!(
        warned(text.clone(), ""),
        [
            "1 values are estimates in the file; they are taken as they are",
            "the year 1990 is not complete and is left out"
        ]
    );
    let before = text.find("   1990").unwrap();
    let earlier: String = (1..=12)
        .map(|m| format!("1989 {m} {m}.5 {m}.5 0 {m}.0 ---\n"))
        .collect();
    let text = format!("{}{earlier}{}", &text[..before], &text[before..]);
    let climate = read(text.clone(), &[]).unwrap();
    assert_eq!((climate.first_year, climate.years()), (1989, 3));
    let july = climate.months[12 + 6];
    let expected = Month {
        temperature: (7.5 + (9.5 + 4.0) / 2.0) / 2.0,
        rain: (7.0 + 67.8) / 2.0,
        sunshine: None,
    };
    assert_eq!(july, expected);
    let filled = "1 months have no temperature and get the mean of their calendar month of 1989 to 1991: 1990-07";
    assert!(warned(text, "").iter().any(|it| it == filled));
}

#[test]
fn long_gaps_are_refused_with_what_to_do() {
    let oxford = String::from_utf8(project_file("assets/weather/oxforddata.txt")).unwrap();
    let lost = |line: &&str| !(1940..1944).any(|year| line.trim().starts_with(&year.to_string()));
    let gappy: String = oxford.lines().filter(lost).collect::<Vec<_>>().join("\n");
    let failure = read(gappy.clone(), &[]).unwrap_err();
    assert_eq!(
        failure.message,
        "no temperature or no rain from 1940-01 to 1943-12: 48 months, and 36 are filled at most"
    );
    assert_eq!(
        failure.hint.unwrap(),
        "set `to: 1939`, `from: 1944`, or `longest_gap: 48`"
    );
    let later = read(gappy.clone(), &[("from", Value::Whole(1944))]).unwrap();
    assert_eq!(later.first_year, 1944);
    let filled = read(gappy.clone(), &[("longest_gap", Value::Whole(48))]).unwrap();
    assert_eq!(filled.years(), 168);
    let warnings = warned(gappy, "longest_gap: 48");
    assert!(
        warnings.iter().any(
            |it| it.starts_with("48 months have no rain") && it.ends_with("1940-01 to 1943-12")
        ),
        "{warnings:?}"
    );
}

#[test]
fn the_latitude_is_the_recipes_the_files_or_a_mistake() {
    let nowhere = station(plain).replace("Lat 51.761 Lon -1.262", "");
    // What is left is a grid reference.
    let by_grid = read(nowhere.clone(), &[]).unwrap().latitude;
    assert!((by_grid - 51.761).abs() < 0.03, "{by_grid}");
    let nowhere = nowhere.replace("450900E 207200N", "");
    let failure = read(nowhere.clone(), &[]).unwrap_err();
    assert_eq!(
        failure.message,
        "neither the file nor the recipe states the latitude"
    );
    let stated = [("latitude", Value::Number(-33.5))];
    assert_eq!(read(nowhere, &stated).unwrap().latitude, -33.5);
    assert_eq!(read(station(plain), &stated).unwrap().latitude, -33.5);
    assert_eq!(
        warned(station(plain), "latitude: -33.5"),
        ["the file states the latitude 51.761, and the recipe's -33.5 counts"]
    );
    assert_eq!(
        warned(station(plain), "latitude: 51.8"),
        Vec::<String>::new()
    );
}

#[test]
fn years_are_chosen_from_those_that_are_there() {
    let window = |from, to| {
        let given = [("from", Value::Whole(from)), ("to", Value::Whole(to))];
        read(station(plain), &given).map(|climate| (climate.first_year, climate.years()))
    };
    assert_eq!(window(1990, 1991).unwrap(), (1990, 2));
    assert_eq!(window(1991, 1991).unwrap(), (1991, 1));
    assert_eq!(
        window(1989, 1991).unwrap_err().message,
        "the file has no weather of the year 1989"
    );
    assert_eq!(
        window(1991, 1990).unwrap_err().message,
        "the years end before they begin: 1991 to 1990"
    );
}

#[test]
fn what_is_wrong_with_a_station_file_is_told_with_its_line() {
    let mistakes = [
        (
            with("1990 2", "   1990  2   x    1.0      4    60.8     40.5"),
            "line 7: column 3 (`tmax`): expected a number or `---`, found `x`",
        ),
        (
            with("1990 2", "   1990  2   9.5    1.0      4    1e999     40.5"),
            "line 7: column 6 (`rain`): expected a number or `---`, found `1e999`",
        ),
        (
            with("1990 2", "   1990  13   9.5    1.0      4    60.8     40.5"),
            "line 7: column 2 (`mm`): expected a month from 1 to 12, found `13`",
        ),
        (
            with("1990 2", "   19x0  2   9.5    1.0      4    60.8     40.5"),
            "line 7: column 1 (`yyyy`): expected a year from 1 to 9999, found `19x0`",
        ),
        (
            with("1990 2", "   1990  1   9.5    1.0      4    60.8     40.5"),
            "line 7: 1990-01 comes twice, first in line 6",
        ),
        (
            with("1990 2", "   1990  2   1.5    9.0      4    60.8     40.5"),
            "line 7: the lowest temperature, 9, is above the highest, 1.5",
        ),
        (
            with("1990 2", "   1990  2   9.5    1.0      4    -60.8     40.5"),
            "line 7: rain of a month from 0 to 20000 mm expected, found -60.8",
        ),
        (
            with(
                "1990 2",
                "   1990  2   9.5    1.0      4    60.8     4000.5",
            ),
            "line 7: sunshine of a month from 0 to 745 hours expected, found 4000.5",
        ),
        (
            with(
                "1990 2",
                "   1990  2   9.5    1.0      4    60.8     40.5 what",
            ),
            "line 7: word 8: expected the row's end or `Provisional`, found `what`",
        ),
        (
            with("1990 2", "gibberish"),
            "line 7: column 1 (`yyyy`): expected a year from 1 to 9999, found `gibberish`",
        ),
        (
            "yyyy mm tmax tmin rain\n".to_owned(),
            "the file holds no months",
        ),
        (
            "yyyy mm tmax rain\n".to_owned(),
            "line 1: no column `tmin` among yyyy, mm, tmax, rain",
        ),
    ];
    for (file, message) in mistakes {
        let file = file
            .replace("tmax tmin rain\n", "tmax tmin rain\n# Lat 1\n")
            .replace("yyyy mm tmax tmin", "Lat 1\nyyyy mm tmax tmin");
        assert_eq!(told(file), message);
    }
    let short = with("1990 2", "   1990  2   9.5");
    assert_eq!(
        read(short, &[]).unwrap().first_year,
        1991,
        "a row that ends early lacks its rest"
    );
}

#[test]
fn what_is_wrong_with_a_table_is_told_with_line_and_column() {
    let table = |header: &str, row: &str| told(format!("# lat 50\n{header}\n{row}\n"));
    let usual = "year,month,temp,rain";
    assert_eq!(told(""), "the file is empty");
    assert_eq!(
        told("year,month,temp,rain"),
        "the file has a header, but no rows"
    );
    assert_eq!(
        table(usual, "2000,1,2.5"),
        "line 3: expected 4 cells, found 3"
    );
    assert_eq!(
        table(usual, "2000,1,2.5,x"),
        "line 3: column 4 (`rain`): expected a finite number, found `x`"
    );
    assert_eq!(
        table(usual, "2000,0,2.5,1"),
        "line 3: column 2 (`month`): expected a month from 1 to 12, found `0`"
    );
    assert_eq!(
        table(usual, "2000.5,1,2.5,1"),
        "line 3: column 1 (`year`): expected a year from 1 to 9999, found `2000.5`"
    );
    assert_eq!(
        table(usual, "2000,1,2.5,1\n2000,1,2.5,1"),
        "line 4: 2000-01 comes twice, first in line 3"
    );
    assert_eq!(
        table(usual, "2000,1,2.5,1"),
        "no year from 2000 to 2000 has temperature and rain in all twelve months"
    );
    assert_eq!(
        table("year,month,temp", "2000,1,2.5"),
        "there is no column for the rain among year, month, temp"
    );
    assert_eq!(
        table("year,month,temp,tmean,rain", "2000,1,2.5,2.5,1"),
        "the columns `temp` and `tmean` could both be temperature"
    );
    assert_eq!(
        table("year,month,temp_f,rain", "2000,1,2.5,1"),
        "the column `temp_f` is in another unit, `f`"
    );
    assert_eq!(
        table("date,temp,rain", "someday,2.5,1"),
        "line 3: column 1 (`date`): expected a date such as 1961-01, found `someday`"
    );
    assert_eq!(
        table(usual, "2000,1,2.5,\"1\n2000,2,2.5,1"),
        "line 3: a quotation mark that is not closed"
    );
    assert_eq!(
        table(usual, "2000,1,2.5,1\0"),
        "line 3: a zero byte: this is no text"
    );
    assert_eq!(
        table(usual, "2000,1,-273,1"),
        "line 3: temperature of a month from -90 to 60 degrees expected, found -273"
    );
}

#[test]
fn no_file_makes_a_panic() {
    // Files cut anywhere, and with a byte changed anywhere.
    let (station, site) = (station(plain), project_file(SITE));
    for whole in [station.as_bytes(), &site[..3000]] {
        for at in (0..whole.len()).step_by(7) {
            let _ = read(&whole[..at], &[]);
            for byte in [b' ', b'-', b'9', b',', b'\n', 0xff] {
                let mut changed = whole.to_vec();
                changed[at] = byte;
                if let Ok(climate) = read(changed, &[]) {
                    assert!(climate.is_sound());
                }
            }
        }
    }
}

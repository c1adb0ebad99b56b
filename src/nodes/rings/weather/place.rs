//! Where a station is: the latitude that a line of a file states.

use super::grid;

/// The latitude in degrees that a line states: `Lat 51.761`, `latitude: 33.9 S`, or a grid reference such as
/// `450900E 207200N`.
pub(super) fn latitude(line: &str) -> Option<f64> {
    let line = line.to_lowercase();
    stated(&line).or_else(|| grid::latitude(&line))
}

fn stated(line: &str) -> Option<f64> {
    let parts = |letter: char| !(letter.is_alphanumeric() || ".-+−".contains(letter));
    let words: Vec<&str> = line.split(parts).filter(|word| !word.is_empty()).collect();
    let at = words.iter().position(|word| is_latitude(word))?;
    let number = words.get(at + 1)?.replace('−', "-");
    let (number, side) = match number.strip_suffix(['n', 's']) {
        Some(bare) => (bare.to_owned(), number.chars().last()),
        None => {
            let next = words.get(at + 2).filter(|word| ["n", "s"].contains(word));
            (number, next.and_then(|word| word.chars().next()))
        }
    };
    let degrees: f64 = number.trim_end_matches('.').parse().ok()?;
    let degrees = if side == Some('s') { -degrees } else { degrees };
    (degrees.abs() <= 90.0).then_some(degrees)
}

/// Whether a word announces a latitude.
pub(super) fn is_latitude(word: &str) -> bool {
    ["lat", "lat.", "latitude"].contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_many_kinds_state_a_latitude() {
        let lines = [
            (
                "Location: 450900E 207200N, Lat 51.761 Lon -1.262, 63 metres amsl",
                Some(51.761),
            ),
            (
                "# Tokyo (JMA station 47662), lat 35.69 lon 139.75",
                Some(35.69),
            ),
            ("latitude: -33.9", Some(-33.9)),
            ("Latitude=33.9 S", Some(-33.9)),
            ("lat. 33.9°S, lon 18.5°E", Some(-33.9)),
            ("latitude 1e400", None),
            ("latitude: 95", None),
            ("lat", None),
            ("platform 12", None),
        ];
        for (line, expected) in lines {
            assert_eq!(latitude(line), expected, "{line}");
        }
    }
}

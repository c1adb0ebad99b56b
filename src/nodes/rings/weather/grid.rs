//! Latitude from a reference to the national grid of Britain or of Ireland.
//!
//! Both grids are transverse Mercator projections. Where the meridian's arc from the true origin is as long as the
//! northing, the latitude is that of the foot; a place at the distance x from the central meridian lies lower by
//! `x² tan(latitude) / (2 R)`. On a sphere of the mean radius of those latitudes this is right to some 0.02 degrees,
//! which is more than light needs.

use libm::tan;

/// Radius in m of the sphere whose meridian fits the ellipsoid between 50 and 60 degrees north.
const RADIUS: f64 = 6_381_000.0;

/// A grid: its true origin's latitude in degrees and its coordinates in m.
struct Grid {
    latitude: f64,
    easting: f64,
    northing: f64,
}

const BRITAIN: Grid = Grid {
    latitude: 49.0,
    easting: 400_000.0,
    northing: -100_000.0,
};

const IRELAND: Grid = Grid {
    latitude: 53.5,
    easting: 200_000.0,
    northing: 250_000.0,
};

/// The latitude in degrees of a line in lower case that holds a reference such as `450900e 207200n` or `4509e 2072n`.
pub(super) fn latitude(line: &str) -> Option<f64> {
    let mut words = line.split([' ', '\t', ',', ':', ';', '(', ')']);
    let easting = words.find_map(|word| digits(word, 'e'))?;
    let northing = words.find_map(|word| digits(word, 'n'))?;
    // No easting of these islands is below 10 km, so four digits are hundreds of metres.
    let unit = if easting.len() == 4 { 100.0 } else { 1.0 };
    let metres = |digits: &str| digits.parse::<f64>().ok().map(|number| number * unit);
    let grid = if line.contains("irish") {
        IRELAND
    } else {
        BRITAIN
    };
    Some(grid.latitude_of(metres(easting)?, metres(northing)?))
}

/// Four to seven digits before a letter.
fn digits(word: &str, letter: char) -> Option<&str> {
    let digits = word.strip_suffix(letter)?;
    let plain = digits.bytes().all(|byte| byte.is_ascii_digit());
    (plain && (4..=7).contains(&digits.len())).then_some(digits)
}

impl Grid {
    fn latitude_of(&self, easting: f64, northing: f64) -> f64 {
        let across = easting - self.easting;
        let foot = self.latitude + ((northing - self.northing) / RADIUS).to_degrees();
        let lower = across * across * tan(foot.to_radians()) / (2.0 * RADIUS);
        foot - (lower / RADIUS).to_degrees()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stations_lie_where_the_met_office_says() {
        // Oxford, Lerwick, Camborne, Lowestoft and Armagh: references and latitudes of their files.
        let stations = [
            ("450900e 207200n", 51.761),
            ("4453e 11396n", 60.139),
            ("162700e 40700n", 50.218),
            ("654300e 294600n", 52.483),
            ("287800e 345800n (irish grid)", 54.352),
        ];
        for (reference, expected) in stations {
            let found = latitude(reference).unwrap();
            assert!((found - expected).abs() < 0.03, "{reference}: {found}");
        }
        assert_eq!(latitude("63 metres amsl"), None);
    }
}

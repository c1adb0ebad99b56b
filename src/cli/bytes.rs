//! Sizes in bytes, as people write and read them.

/// Units with their numbers of bytes, the smallest first.
const UNITS: [(&str, u64); 4] = [
    ("KiB", 1 << 10),
    ("MiB", 1 << 20),
    ("GiB", 1 << 30),
    ("TiB", 1 << 40),
];

/// More bytes than anything has.
const MOST: f64 = 9e15;

/// A size such as `64MiB` or `1.5 GiB`; a number alone is bytes.
///
/// # Errors
/// What a size looks like.
pub(super) fn parse(text: &str) -> Result<u64, String> {
    let mut units = UNITS.iter().copied().chain([("", 1)]);
    let found = units.find_map(|(unit, bytes)| Some((text.strip_suffix(unit)?.trim(), bytes)));
    let number = found.and_then(|(number, unit)| {
        let number: f64 = number.parse().ok()?;
        let bytes = number * unit as f64;
        (0.0..=MOST).contains(&bytes).then_some(bytes as u64)
    });
    number.ok_or_else(|| {
        format!("expected a number of bytes, for example 500000000, 64MiB or 2GiB, found `{text}`")
    })
}

/// A number of bytes, in a unit that fits it.
pub(super) fn shown(bytes: u64) -> String {
    let unit = UNITS.iter().rev().find(|(_, size)| bytes >= *size);
    match unit {
        None => format!("{bytes} bytes"),
        Some((unit, size)) => format!("{:.1} {unit}", bytes as f64 / *size as f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_numbers_with_units() {
        for (text, expected) in [
            ("0", 0),
            ("4096", 4096),
            ("64MiB", 64 << 20),
            ("1.5 GiB", 3 << 29),
            ("2KiB", 2048),
            ("1TiB", 1 << 40),
        ] {
            assert_eq!(parse(text), Ok(expected));
        }
        for wrong in ["", "MiB", "-1", "64 mb", "NaN", "inf", "1e300", "9000TiB"] {
            let problem = parse(wrong).unwrap_err();
            assert!(problem.ends_with(&format!("`{wrong}`")), "{problem}");
        }
    }

    #[test]
    fn sizes_have_a_unit_that_fits() {
        let sizes = [0, 1023, 1024, 1536 << 10, 3 << 40].map(shown);
        assert_eq!(
            sizes,
            ["0 bytes", "1023 bytes", "1.0 KiB", "1.5 MiB", "3.0 TiB"]
        );
    }
}

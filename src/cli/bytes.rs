//! Sizes in bytes, as people write them.

/// Units with their numbers of bytes, the smallest first.
const UNITS: [(&str, u64); 5] = [
    ("B", 1),
    ("KiB", 1 << 10),
    ("MiB", 1 << 20),
    ("GiB", 1 << 30),
    ("TiB", 1 << 40),
];

/// A size such as `64MiB` or `1.5 GiB`; a number alone is bytes.
///
/// # Errors
/// What a size looks like.
pub(super) fn parse(text: &str) -> Result<u64, String> {
    let expected = || format!("expected a size such as 64MiB or 2GiB, found `{text}`");
    let digits = text.trim_end_matches(|letter: char| letter.is_ascii_alphabetic());
    let unit = match &text[digits.len()..] {
        "" => "B",
        unit => unit,
    };
    let is_unit = |(name, _): &&(&str, u64)| name.eq_ignore_ascii_case(unit);
    let (_, bytes) = UNITS.iter().find(is_unit).ok_or_else(expected)?;
    let number: f64 = digits.trim().parse().map_err(|_| expected())?;
    if !number.is_finite() || number < 0.0 {
        return Err(expected());
    }
    // Saturates beyond what there is.
    Ok((number * *bytes as f64) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        let cases = [
            ("0", 0),
            ("64MiB", 64 << 20),
            ("1.5 GiB", 3 << 29),
            ("7kib", 7 << 10),
        ];
        for (text, bytes) in cases {
            assert_eq!(parse(text), Ok(bytes), "{text}");
        }
        for text in ["", "MiB", "-1", "nan", "64 MB", "1e"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}

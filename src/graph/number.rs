//! Numbers as RON writes them.

/// A number as it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Written {
    /// Without a decimal point and an exponent; `None` if it does not fit into 64 bits.
    Whole(Option<i64>),
    /// Any other; perhaps infinite or not a number.
    Real(f64),
}

impl Written {
    /// The nearest 64-bit float.
    pub(super) fn as_f64(self, text: &str) -> f64 {
        match self {
            Written::Whole(Some(number)) => number as f64,
            Written::Whole(None) => without_suffix(text).parse().unwrap_or(f64::INFINITY),
            Written::Real(number) => number,
        }
    }
}

/// Reads a number with sign, radix, underscores and suffix; `None` if it is none.
pub(super) fn read(text: &str) -> Option<Written> {
    let unsigned = text.trim_start_matches(['+', '-']);
    let negative = text.starts_with('-');
    for (prefix, radix) in [("0x", 16), ("0o", 8), ("0b", 2)] {
        if let Some(digits) = unsigned.strip_prefix(prefix) {
            return whole(&without_whole_suffix(digits), radix, negative);
        }
    }
    let plain = without_suffix(unsigned);
    if plain.bytes().all(|byte| byte.is_ascii_digit()) {
        return whole(&plain, 10, negative);
    }
    let number: f64 = plain.parse().ok()?;
    Some(Written::Real(if negative { -number } else { number }))
}

fn whole(digits: &str, radix: u32, negative: bool) -> Option<Written> {
    let is_number = !digits.is_empty() && digits.chars().all(|digit| digit.is_digit(radix));
    let signed = if negative {
        format!("-{digits}")
    } else {
        digits.to_owned()
    };
    is_number.then(|| Written::Whole(i64::from_str_radix(&signed, radix).ok()))
}

fn without_suffix(text: &str) -> String {
    let plain = text
        .strip_suffix("f32")
        .or(text.strip_suffix("f64"))
        .unwrap_or(text);
    without_whole_suffix(plain)
}

fn without_whole_suffix(text: &str) -> String {
    let suffixes = [
        "i8", "i16", "i32", "i64", "i128", "u8", "u16", "u32", "u64", "u128",
    ];
    let plain = suffixes
        .iter()
        .find_map(|suffix| text.strip_suffix(suffix))
        .unwrap_or(text);
    plain.replace('_', "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_mean_what_ron_means() {
        for text in [
            "1.5", "-2e3", "+.5", "1_000.25", "3.", "1e-999", "2.5f64", "0.1",
        ] {
            let expected: f64 = ron::from_str(text).unwrap();
            assert_eq!(read(text), Some(Written::Real(expected)), "{text}");
        }
        for text in ["12", "-7", "0xff", "0b101", "-0o17", "1_000", "5i64", "+3"] {
            let expected: i64 = ron::from_str(text).unwrap();
            assert_eq!(read(text), Some(Written::Whole(Some(expected))), "{text}");
        }
    }

    #[test]
    fn what_does_not_fit_is_known() {
        assert_eq!(read("99999999999999999999"), Some(Written::Whole(None)));
        assert_eq!(Written::Whole(None).as_f64("99999999999999999999"), 1e20);
        assert_eq!(read("1e999"), Some(Written::Real(f64::INFINITY)));
        assert_eq!(read("1.2.3"), None);
        assert_eq!(read("0x"), None);
    }
}

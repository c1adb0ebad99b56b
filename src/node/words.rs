//! Words of messages that depend on a number.

/// A count with the words for one and for another number: `1 sliver was`, `12 slivers were`.
pub(crate) fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// By how much lengths were multiplied, with the words for more and for less: `2.5 % longer and 4.8 % narrower`. What is
/// less than a step of the decimals is left out; nothing if all is.
pub(crate) fn stretched(factors: &[(f64, [&str; 2])], decimals: usize) -> String {
    let said = |(factor, [more, less]): &(f64, [&str; 2])| {
        let percent = format!("{:.decimals$}", 100.0 * (factor - 1.0).abs());
        let is_seen = percent.contains(|digit: char| ('1'..='9').contains(&digit));
        is_seen.then(|| format!("{percent} % {}", if *factor > 1.0 { more } else { less }))
    };
    let said: Vec<String> = factors.iter().filter_map(said).collect();
    said.join(" and ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_not_many() {
        let words = |count| counted(count, "sliver was", "slivers were");
        assert_eq!(
            [0, 1, 2].map(words),
            ["0 slivers were", "1 sliver was", "2 slivers were"]
        );
    }

    #[test]
    fn less_is_not_minus_more() {
        let said = |x, y| stretched(&[(x, ["longer", "shorter"]), (y, ["wider", "narrower"])], 1);
        assert_eq!(said(1.025, 0.952), "2.5 % longer and 4.8 % narrower");
        assert_eq!(said(0.5, 1.0001), "50.0 % shorter");
        assert_eq!(said(1.0, 1.0), "");
    }
}

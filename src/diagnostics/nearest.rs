//! The nearest valid names to a mistyped one.

/// Names that are compared; a recipe with more would take long.
const COMPARED: usize = 5000;
/// Letters of the longest name that is compared.
const LETTERS: usize = 60;

/// Up to three of `names`, the nearest to `wrong` first; all that are nearer than half its length.
pub fn nearest<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let length = wrong.chars().count();
    let limit = (length / 2).max(1);
    if length > LETTERS {
        return vec![];
    }
    let mut ranked: Vec<_> = names
        .into_iter()
        .take(COMPARED)
        .filter(|name| name.len().abs_diff(wrong.len()) <= 4 * limit && name.len() <= 4 * LETTERS)
        .map(|name| (distance(wrong, name), name))
        .filter(|(distance, _)| *distance <= limit)
        .collect();
    ranked.sort_unstable();
    ranked
        .into_iter()
        .take(3)
        .map(|(_, name)| name.to_owned())
        .collect()
}

/// Number of letters to insert, delete, replace or swap with a neighbour (Damerau 1964).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = vec![];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before[j - 2] + 1);
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_swap_counts_once() {
        assert_eq!(distance("filed", "field"), 1);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("growth_field", "growth_field"), 0);
    }

    #[test]
    fn the_nearest_come_first_and_the_far_not_at_all() {
        let names = ["roughness", "height", "rough", "opacity"];
        assert_eq!(nearest("roughnes", names), ["roughness", "rough"]);
        assert!(nearest("x", names).is_empty());
        assert!(nearest(&"a".repeat(1_000_000), names).is_empty());
    }
}

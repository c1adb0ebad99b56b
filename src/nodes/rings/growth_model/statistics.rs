//! What the study of tree rings measures of a series of widths: mean sensitivity and autocorrelation.

/// Years of the running mean that takes a series' slow changes away.
pub const SLOW: usize = 33;

/// Mean sensitivity: the mean of `2 |a - b| / (a + b)` of widths that follow each other; 0 for fewer than two.
pub fn mean_sensitivity(widths: &[f64]) -> f64 {
    let pairs = widths.windows(2);
    let count = pairs.len().max(1) as f64;
    let change = |pair: &[f64]| 2.0 * (pair[1] - pair[0]).abs() / (pair[1] + pair[0]);
    pairs.map(change).sum::<f64>() / count
}

/// The widths divided by the mean of the 33 around each, at the ends by as many as there are.
pub fn detrended(widths: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    sums.extend(widths.iter().scan(0.0, |sum, width| {
        *sum += width;
        Some(*sum)
    }));
    let of_year = |year: usize| {
        let [from, to] = [
            year.saturating_sub(SLOW / 2),
            (year + SLOW / 2 + 1).min(widths.len()),
        ];
        widths[year] * (to - from) as f64 / (sums[to] - sums[from])
    };
    (0..widths.len()).map(of_year).collect()
}

/// The correlation of values with those one place later; 0 for fewer than three, and where all are the same.
pub fn autocorrelation(values: &[f64]) -> f64 {
    if values.len() < 3 {
        return 0.0;
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let apart = |value: &f64| value - mean;
    let square: f64 = values.iter().map(apart).map(|it| it * it).sum();
    let product: f64 = values
        .windows(2)
        .map(|pair| apart(&pair[0]) * apart(&pair[1]))
        .sum();
    if square > 0.0 { product / square } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_short_series_are_those_by_hand() {
        assert!((mean_sensitivity(&[1.0, 3.0, 1.0]) - 1.0).abs() < 1e-15);
        assert_eq!(mean_sensitivity(&[1.0]), 0.0);
        // (-1)(1) + (1)(0) over 1 + 1 + 0.
        assert_eq!(autocorrelation(&[1.0, 3.0, 2.0]), -0.5);
        assert_eq!(autocorrelation(&[2.0; 5]), 0.0);
        let even = detrended(&[4.0; 50]);
        assert!(even.iter().all(|value| (value - 1.0).abs() < 1e-12));
        let short = detrended(&[1.0, 2.0, 3.0]);
        assert!((short[2] - 1.5).abs() < 1e-15);
    }
}

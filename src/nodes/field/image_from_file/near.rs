//! The mean over samples smaller than a pixel of the picture, which is interpolated straight.
//!
//! Such a sample sees at most three pixels a side, and the picture bends only along the lines through the centres of
//! the middle ones. Along each axis the sample counts as a box of its variance; of the product of both ways the mean
//! differs from the product of the means by their covariance. Exact for upright samples and between two centres.

use super::weights::floor;

/// Widest box, in pixels: a turned sample of this size is no wider than two of them.
const WIDEST: f32 = 0.75;

/// Three pixels a side and their weights.
pub(super) struct Near {
    /// The first of them along both axes.
    pub(super) first: [i64; 2],
    /// Row by row.
    pub(super) weights: [f32; 9],
}

impl Near {
    /// What the sample around `centre` with these sides sees, all in pixels; `None` if it is too large.
    #[inline(always)]
    pub(super) fn of(centre: [f64; 2], [across, along]: [[f64; 2]; 2]) -> Option<Near> {
        let (across, along) = (
            across.map(|part| part as f32),
            along.map(|part| part as f32),
        );
        let squares = [0, 1].map(|axis| across[axis] * across[axis] + along[axis] * along[axis]);
        // Also not where a square is infinite.
        if squares[0].max(squares[1]) > WIDEST * WIDEST {
            return None;
        }
        // A side shows every share of itself alike, with a variance of 1/12.
        let covariance = (across[0] * across[1] + along[0] * along[1]) / 12.0;
        let middle = centre.map(floor);
        let away = [0, 1].map(|axis| (centre[axis] - middle[axis] as f64) as f32 - 0.5);
        let [wide, tall] = [0, 1].map(|axis| seen(away[axis], squares[axis].sqrt()));
        let mut weights = [0.0; 9];
        for (index, weight) in weights.iter_mut().enumerate() {
            let (x, y) = (index % 3, index / 3);
            let slope = covariance * wide.slopes[x] * tall.slopes[y];
            *weight = wide.weights[x] * tall.weights[y] + slope;
        }
        let first = middle.map(|middle| middle - 1);
        Some(Near { first, weights })
    }
}

/// What a box sees of three pixels along an axis.
struct Seen {
    /// The mean is the sum of the pixels by these.
    weights: [f32; 3],
    /// The mean slope is the sum of the pixels by these.
    slopes: [f32; 3],
}

/// A box of a width, whose middle is `away` from the centre of the middle pixel.
#[inline(always)]
fn seen(away: f32, width: f32) -> Seen {
    let (start, end) = (away - 0.5 * width, away + 0.5 * width);
    // The mean of what lies beyond the centre, and how much of the box does.
    let (beyond, share) = if start >= 0.0 {
        (away, 1.0)
    } else if end <= 0.0 {
        (0.0, 0.0)
    } else {
        (end * end / (2.0 * width), end / width)
    };
    let before = beyond - away;
    Seen {
        weights: [before, 1.0 - before - beyond, beyond],
        slopes: [share - 1.0, 1.0 - 2.0 * share, share],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The weights over 400 x 400 points of the sample.
    fn brute(centre: [f64; 2], [across, along]: [[f64; 2]; 2]) -> [f64; 9] {
        let mut weights = [0.0; 9];
        let at = |index: usize| (index as f64 + 0.5) / 400.0 - 0.5;
        let hat = |x: f64| (1.0 - x.abs()).max(0.0);
        for index in 0..160_000 {
            let (a, b) = (at(index % 400), at(index / 400));
            let point = [0, 1].map(|axis| centre[axis] + a * across[axis] + b * along[axis]);
            for (index, weight) in weights.iter_mut().enumerate() {
                let (x, y) = (index % 3, index / 3);
                let first = centre.map(|part| part.floor() - 0.5);
                let away = [
                    point[0] - first[0] - x as f64,
                    point[1] - first[1] - y as f64,
                ];
                *weight += hat(away[0]) * hat(away[1]) / 160_000.0;
            }
        }
        weights
    }

    fn furthest(centre: [f64; 2], sides: [[f64; 2]; 2]) -> f64 {
        let near = Near::of(centre, sides).expect("the sample is small");
        let brute = brute(centre, sides);
        (0..9).fold(0.0, |furthest: f64, index| {
            furthest.max((f64::from(near.weights[index]) - brute[index]).abs())
        })
    }

    #[test]
    fn upright_and_inner_samples_are_exact_and_turned_ones_close() {
        for centre in [[7.5, 3.6], [-2.3, 0.05], [4.98, -1.45]] {
            for upright in [[[0.7, 0.0], [0.0, 0.3]], [[0.0, -0.4], [0.75, 0.0]]] {
                assert!(furthest(centre, upright) < 1e-5, "{centre:?} {upright:?}");
            }
            for turned in [[[0.5, 0.05], [-0.05, 0.3]], [[0.4, 0.4], [-0.2, 0.2]]] {
                let off = furthest(centre, turned);
                assert!(off < 0.01, "{centre:?} {turned:?}: {off}");
            }
        }
        assert!(furthest([3.0, 8.0], [[0.5, 0.3], [-0.1, 0.4]]) < 1e-5);
        assert!(Near::of([0.0, 0.0], [[0.8, 0.0], [0.0, 0.1]]).is_none());
    }
}

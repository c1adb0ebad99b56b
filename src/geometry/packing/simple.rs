//! Whether a ring crosses itself.

use glam::DVec2;

/// Whether no two edges of a ring cross; they may touch.
pub(super) fn is_simple(corners: &[DVec2]) -> bool {
    let count = corners.len();
    let edge = |index: usize| (corners[index], corners[(index + 1) % count]);
    let side = |a: DVec2, b: DVec2, point: DVec2| (b - a).perp_dot(point - a);
    let crosses = |one: usize, other: usize| {
        let ((a, b), (c, d)) = (edge(one), edge(other));
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
    };
    let mut pairs = (0..count).flat_map(|one| (one + 2..count).map(move |other| (one, other)));
    !pairs.any(|(one, other)| (other + 1) % count != one && crosses(one, other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bow_tie_crosses_itself_and_a_bent_ring_does_not() {
        let ring = |corners: &[(f64, f64)]| -> Vec<DVec2> {
            corners.iter().map(|corner| DVec2::from(*corner)).collect()
        };
        let bow_tie = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)];
        let bent = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 0.5), (0.0, 2.0)];
        assert!(!is_simple(&ring(&bow_tie)));
        assert!(is_simple(&ring(&bent)));
    }
}

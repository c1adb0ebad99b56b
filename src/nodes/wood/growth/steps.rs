//! Functions that are straight between knots, for columns: the tables of a ring series.

use super::heights::Heights;
use fearless_simd::prelude::*;
use fearless_simd_macros::simd;

/// A function that is straight between knots, and goes on straight beyond the first and the last one.
#[derive(Debug)]
pub(super) struct Steps {
    knots: Heights,
    by_root: bool,
    /// One before each knot, and one behind the last.
    pieces: Vec<Straight>,
}

/// `base + (x - start) slope`.
#[derive(Clone, Copy, Debug, Default)]
struct Straight {
    start: f32,
    base: f32,
    slope: f32,
}

/// The most lanes that a vector has.
const MOST_LANES: usize = 16;

impl Steps {
    /// The function through knots `[x, y]`, at least two, whose x rise strictly.
    ///
    /// A piece is counted from its knot as it is rounded, so that rounding does not move it. Pieces are found by the
    /// square roots of places if `by_root` says so: those of areas lie more evenly.
    pub(super) fn new(knots: &[[f64; 2]], by_root: bool) -> Steps {
        let starts: Vec<f32> = knots.iter().map(|[x, _]| *x as f32).collect();
        let straight = |pair: &[[f64; 2]], knot: f32| {
            let [[x, y], [next_x, next_y]] = [pair[0], pair[1]];
            let slope = (next_y - y) / (next_x - x);
            Straight {
                start: knot,
                base: (y + (f64::from(knot) - x) * slope) as f32,
                slope: slope as f32,
            }
        };
        let pairs = knots.windows(2).zip(&starts);
        let between: Vec<Straight> = pairs.map(|(pair, start)| straight(pair, *start)).collect();
        let last = knots.len() - 1;
        let behind = straight(&knots[last - 1..], starts[last]);
        let searched = |start: &f32| if by_root { start.sqrt() } else { *start };
        let searched: Vec<f32> = starts.iter().map(searched).collect();
        Steps {
            knots: Heights::new(&searched),
            by_root,
            pieces: [vec![between[0]], between, vec![behind]].concat(),
        }
    }

    /// Writes the function's values.
    #[simd]
    pub(super) fn evaluate<S: Simd>(&self, simd: S, places: &[f32], values: &mut [f32]) {
        let lanes = S::f32s::LEN;
        let mut piece = 0;
        let columns = places
            .chunks_exact(lanes)
            .zip(values.chunks_exact_mut(lanes));
        for (places, values) in columns {
            let place = S::f32s::from_slice(simd, places);
            let searched = self.searched(simd, place);
            if !self.knots.hold(simd, &(piece..=piece), searched) {
                piece = self.knots.piece(searched[0]);
            }
            if self.knots.hold(simd, &(piece..=piece), searched) {
                let Straight { start, base, slope } = self.pieces[piece];
                ((place - start) * slope + base).store_slice(values);
            } else {
                self.by_lane(simd, place, searched, values);
            }
        }
    }

    /// By what the piece of a place is found. Before the first knot the second piece is the same as the first.
    #[inline(always)]
    fn searched<S: Simd>(&self, simd: S, place: S::f32s) -> S::f32s {
        let _ = simd;
        match self.by_root {
            true => place.max(0.0).sqrt(),
            false => place,
        }
    }

    /// The same where every lane may be in another piece.
    #[inline(always)]
    fn by_lane<S: Simd>(&self, simd: S, place: S::f32s, searched: S::f32s, values: &mut [f32]) {
        let buckets = self.knots.buckets(simd, searched);
        let [mut start, mut base, mut slope] = [[0.0; MOST_LANES]; 3];
        for lane in 0..values.len() {
            let piece = self.pieces[self.knots.piece_of_lane(searched[lane], buckets[lane])];
            (start[lane], base[lane], slope[lane]) = (piece.start, piece.base, piece.slope);
        }
        let load = |column: &[f32; MOST_LANES]| S::f32s::from_slice(simd, &column[..values.len()]);
        ((place - load(&start)) * load(&slope) + load(&base)).store_slice(values);
    }
}

//! The filters of PNG: each row becomes differences that are small (PNG specification, 9).

/// How a byte is predicted from the one before it, the one above, and the one above that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Filter {
    None = 0,
    Sub = 1,
    Up = 2,
    Average = 3,
    Paeth = 4,
}

/// In the order in which equals are preferred: the cheaper to read first.
const FILTERS: [Filter; 5] = [
    Filter::Up,
    Filter::Sub,
    Filter::None,
    Filter::Average,
    Filter::Paeth,
];

/// Bytes that are looked at together when a filter is chosen.
const SAMPLE: usize = 256;
/// Of the bytes of a row, one part of so many is looked at.
const SPARSITY: usize = 4;

/// Rows with their filters in front, ready to be compressed; `above` is the row before them.
pub(super) fn filter_rows(rows: &[u8], above: &[u8], pixel_bytes: usize) -> Vec<u8> {
    let row_bytes = above.len();
    let mut filtered = vec![0; rows.len() / row_bytes * (row_bytes + 1)];
    let mut above = above;
    for (row, place) in rows
        .chunks_exact(row_bytes)
        .zip(filtered.chunks_exact_mut(row_bytes + 1))
    {
        let near = Near::new(row, above, pixel_bytes);
        let filter = near.choose();
        let (first, rest) = place
            .split_first_mut()
            .expect("a row has its filter in front");
        *first = filter as u8;
        near.filter_row(filter, rest);
        above = row;
    }
    filtered
}

/// A row without its first pixel, and its neighbours shifted to the same place.
struct Near<'a> {
    first: &'a [u8],
    first_above: &'a [u8],
    row: &'a [u8],
    left: &'a [u8],
    above: &'a [u8],
    left_above: &'a [u8],
}

impl<'a> Near<'a> {
    fn new(whole: &'a [u8], above: &'a [u8], pixel_bytes: usize) -> Near<'a> {
        let length = whole.len() - pixel_bytes;
        Near {
            first: &whole[..pixel_bytes],
            first_above: &above[..pixel_bytes],
            row: &whole[pixel_bytes..],
            left: &whole[..length],
            above: &above[pixel_bytes..],
            left_above: &above[..length],
        }
    }

    /// The filter with the least sum of magnitudes, the heuristic of the PNG specification (12.7), over
    /// evenly spaced parts of the row.
    fn choose(&self) -> Filter {
        let mut costs = [0u32; FILTERS.len()];
        let mut part = [0; SAMPLE];
        for start in (0..self.row.len()).step_by(SAMPLE * SPARSITY) {
            let end = self.row.len().min(start + SAMPLE);
            let part = &mut part[..end - start];
            for (filter, cost) in FILTERS.iter().zip(&mut costs) {
                self.filter(*filter, start, part);
                let magnitudes = part
                    .iter()
                    .map(|byte| u32::from(byte.cast_signed().unsigned_abs()));
                *cost += magnitudes.sum::<u32>();
            }
        }
        let best = (0..FILTERS.len()).min_by_key(|index| costs[*index]);
        FILTERS[best.unwrap_or(0)]
    }

    fn filter_row(&self, filter: Filter, out: &mut [u8]) {
        let (first, rest) = out.split_at_mut(self.first.len());
        for ((out, byte), above) in first.iter_mut().zip(self.first).zip(self.first_above) {
            *out = byte.wrapping_sub(match filter {
                Filter::None | Filter::Sub => 0,
                Filter::Up | Filter::Paeth => *above,
                Filter::Average => *above / 2,
            });
        }
        self.filter(filter, 0, rest);
    }

    /// Filters the bytes from `start` on that fill `out`.
    fn filter(&self, filter: Filter, start: usize, out: &mut [u8]) {
        let range = start..start + out.len();
        let [row, left, above, left_above] =
            [self.row, self.left, self.above, self.left_above].map(|all| &all[range.clone()]);
        match filter {
            Filter::None => out.copy_from_slice(row),
            Filter::Sub => differences(out, row, |at| left[at]),
            Filter::Up => differences(out, row, |at| above[at]),
            Filter::Average => differences(out, row, |at| {
                ((u16::from(left[at]) + u16::from(above[at])) / 2) as u8
            }),
            Filter::Paeth => differences(out, row, |at| paeth(left[at], above[at], left_above[at])),
        }
    }
}

#[inline(always)]
fn differences(out: &mut [u8], row: &[u8], prediction: impl Fn(usize) -> u8) {
    for (at, (out, byte)) in out.iter_mut().zip(row).enumerate() {
        *out = byte.wrapping_sub(prediction(at));
    }
}

/// The neighbour that is nearest to left + above - left above.
#[inline(always)]
fn paeth(left: u8, above: u8, left_above: u8) -> u8 {
    let [a, b, c] = [left, above, left_above].map(i16::from);
    let [to_left, to_above] = [(b - c).abs(), (a - c).abs()];
    let to_both = (a + b - 2 * c).abs();
    if to_left <= to_above && to_left <= to_both {
        left
    } else if to_above <= to_both {
        above
    } else {
        left_above
    }
}
